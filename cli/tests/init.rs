//! `rocking init`: a new scene is valid, runs, and replaces nothing unasked.

use crate::common::{Folder, assert_has};

#[test]
fn a_new_scene_is_valid_and_runs_for_any_number_of_blocks() {
    let folder = Folder::new();
    for blocks in 1..=7 {
        let name = format!("{blocks}.toml");
        let said = folder.succeeds(&format!("init {name} --blocks {blocks}"));
        assert!(said.contains(&format!("rocking check {name}")), "{said}");
        let check = folder.succeeds(&format!("check {name}"));
        assert_has(&check, &["a valid scene", &format!("column of {blocks} block(s): 3.1200 m tall")]);
        let ran = folder.succeeds(&format!("run {name} --out out"));
        assert!(ran.contains("impact(s)"), "{ran}");
    }
}

#[test]
fn a_scene_is_not_written_over_unless_asked() {
    let folder = Folder::with("scene.toml", "mine");
    folder.refused("init", &["--force"]);
    assert_eq!(folder.read("scene.toml"), "mine");
    folder.refused("init -", &["not to standard output"]);
    folder.succeeds("init --force");
    folder.succeeds("check scene.toml");
}

#[test]
fn a_new_scene_names_the_record_it_was_given() {
    let folder = Folder::new();
    folder.copy("scenes/records/synthetic.AT2", "records/own \"1\".AT2");
    folder.succeeds(&["init", "--record", "records/own \"1\".AT2"]);
    let check = folder.succeeds("check scene.toml");
    assert_has(&check, &["horizontal ground motion: record", "PGA 0.4500 g"]);
    folder.refused("init other.toml --record none.AT2", &[]);
    assert!(!folder.has("other.toml"));
}
