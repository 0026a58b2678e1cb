//! Studies and sweeps print the warnings of their records, as runs do: each once, and not with `--quiet`.

use crate::common::Folder;

const COLUMN: &str = "[column]\nblocks = 1\nhalf_width = 0.2\nhalf_height = 1.0\n";

/// A folder with a scene and `count` records that state no unit.
fn folder(count: usize) -> Folder {
    let folder = Folder::new();
    for number in 1..=count {
        let text = "Station X\nNPTS= 8, DT= .05\n0 .1 .2 -.1\n-.2 .1 0 0\n";
        folder.write(&format!("records/GM_{number}.AT2"), text);
    }
    let record = "[excitation.horizontal]\nkind = \"record\"\nfile = \"records/GM_1.AT2\"\n";
    folder.write("scene.toml", format!("{COLUMN}{record}"));
    folder.write("study.toml", "scene = \"scene.toml\"\nmeasure = \"pga_g\"\nlevels = [0.2, 0.3]\ntrust = false\n[records]\nfolder = \"records\"\n");
    folder.write("sweep.toml", "scene = \"scene.toml\"\n[axes]\nhalf_width = [0.2, 0.3]\n");
    folder
}

/// The warnings of a command that succeeds.
fn warnings(folder: &Folder, command: &str) -> Vec<String> {
    folder.says(command).1.lines().filter(|line| line.starts_with("warning:")).map(str::to_string).collect()
}

#[test]
fn studies_and_sweeps_print_the_warnings_of_their_records_once() {
    let folder = folder(12);
    for arguments in ["check sweep.toml", "sweep sweep.toml --out a.csv"] {
        let found = warnings(&folder, arguments);
        assert!(found.len() == 1 && found[0].contains("records/GM_1.AT2: the header states no unit"), "{found:?}");
    }
    for arguments in ["check study.toml", "ida study.toml --out b.csv"] {
        let found = warnings(&folder, arguments);
        assert!(found.len() == 11 && found[10] == "warning: and 2 more", "{found:?}");
        assert!(found[0].contains("GM_1.AT2") && found[1].contains("GM_2.AT2"), "{found:?}");
    }
    assert_eq!(warnings(&folder, "ida study.toml --out c.csv --quiet"), [""; 0]);
    assert_eq!(warnings(&folder, "sweep sweep.toml --out d.csv --quiet"), [""; 0]);
}

#[test]
fn a_shard_warns_of_its_own_records() {
    let folder = folder(3);
    folder.write(
        "sweep.toml",
        "scene = \"scene.toml\"\n[axes]\n\"excitation.horizontal.file\" = { folder = \"records\" }\n",
    );
    for number in 1..=3 {
        let found = warnings(&folder, &format!("sweep sweep.toml --shard {number}/3"));
        assert!(found.len() == 1 && found[0].contains(&format!("GM_{number}.AT2")), "{number}: {found:?}");
    }
}
