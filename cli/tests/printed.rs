//! What is printed for terminals, scripts and shells: no control characters, JSON of finite numbers, completions and manual pages.

use crate::common::scenes::SCENE;
use crate::common::{Folder, project};

#[test]
fn control_characters_reach_no_terminal() {
    let title = SCENE.replace("one block", "red \\u001b[31m, \\u009b, \\u202e and\\nnext <b>");
    let folder = Folder::with("scene.toml", &title);
    let name = "a\u{1b}[31mb.toml";
    folder.write(name, &title);
    folder.write("bad\u{7}.toml", "title = \"\u{1b}[31m\"\n");
    folder.write("c\u{1b}.AT2", "1\n");
    folder.make_folder("records\u{1b}");
    for arguments in [
        &["run", name, "--out", "o\u{1b}"][..],
        &["run", name, "--json"],
        &["check", name],
        &["check", name, "--json"],
        &["run", "bad\u{7}.toml"],
        &["run", "none\u{1b}.toml"],
        &["record", "c\u{1b}.AT2"],
        &["record", "records\u{1b}"],
        &["plot", "o\u{1b}"],
        &["report", "o\u{1b}", "--out", "r\u{1b}.html"],
        &["init", "i\u{1b}.toml"],
        &["thresholds", "bad\u{7}.toml"],
        &["modes", "--blocks", "1", "--svg", "m\u{1b}.svg"],
    ] {
        let output = folder.rocking(arguments);
        for text in [output.stdout, output.stderr] {
            let text = String::from_utf8(text).expect("text");
            let is_safe = |sign: char| !sign.is_control() && sign != '\u{202e}' || sign == '\n';
            assert!(text.chars().all(is_safe), "{arguments:?}: {text:?}");
        }
    }
    let told = folder.succeeds(&["run", name]);
    assert!(told.starts_with("red \\u{1b}[31m, \\u{9b}, \\u{202e} and next <b>\n"), "{told}");
    let summary = folder.answers(&["run", name, "--json"]);
    assert_eq!(summary["title"], "red \u{1b}[31m, \u{9b}, \u{202e} and\nnext <b>", "JSON has the text itself");
    let page = folder.read("r\u{1b}.html");
    assert!(page.contains("red \\u{1b}[31m, \\u{9b}, \\u{202e} and\nnext &lt;b&gt;"));
    assert!(page.chars().filter(|sign| *sign != '\n' && *sign != '\t').all(|sign| !sign.is_control()));
}

#[test]
fn a_number_that_is_not_finite_is_a_word_in_json() {
    // The lowest contact parts with a force along it.
    let folder = Folder::new();
    folder.succeeds(&["run", &project("scenes/paper-1-block-6.32.toml")]);
    assert_eq!(folder.summary()["friction_demand"][0], "infinite");
    folder.succeeds("report out");
    let page = folder.page();
    // It parts in the fall, which does not count.
    assert!(!page.contains("no friction coefficient is enough") && page.contains("point of no return"));
    // As earlier versions wrote it.
    let old = folder.read("out/summary.json").replace("\"infinite\"", "null");
    folder.write("out/summary.json", old);
    folder.succeeds("report out --out old.html");
    assert_eq!(folder.read("old.html"), page);
}

#[test]
fn scripts_read_json() {
    let folder = Folder::new();
    let summary = folder.answers(&["run", &project("scenes/paper-1-block-6.32.toml"), "--out", "out", "--json"]);
    assert_eq!(summary["status"], "overturned");
    let thresholds = folder.answers(&["thresholds", &project("scenes/paper-3-blocks-3.00.toml"), "--json"]);
    assert_eq!(thresholds.as_array().map(Vec::len), Some(3));
    let modes = folder.answers("modes --blocks 3 --json");
    assert_eq!(modes.as_array().map(Vec::len), Some(13));
    assert_eq!(modes[12]["pattern"], "(0,0,+)");
}

#[test]
fn shells_and_man_know_the_commands() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = folder.succeeds(&format!("completions {shell}"));
        assert!(script.contains("thresholds"), "{shell}");
    }
    assert!(folder.succeeds("man").contains(".TH rocking"));
    folder.succeeds("man --out man");
    let page = folder.read("man/rocking-run.1");
    assert!(page.contains("summary.json"), "{page}");
}
