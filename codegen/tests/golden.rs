//! What is emitted for one and two blocks, to the letter. A golden shows change, not truth; `BLESS=1 cargo test` renews it.

use std::path::PathBuf;

#[test]
fn emitted_code_for_small_columns_is_as_reviewed() {
    for blocks in [1, 2] {
        let emitted = rocking_codegen::generate(blocks).expect("a valid size");
        let name = format!("tests/golden/equations_{blocks}.txt");
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name);
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&path, &emitted).expect("the golden can be written");
        }
        let golden = std::fs::read_to_string(&path).expect("the golden is there; BLESS=1 makes it");
        assert!(golden == emitted, "{} differs from what is emitted; see with BLESS=1 and git diff", path.display());
    }
}

/// Every hash map has a seed of its own, and each thread starts from another; the goldens compare between processes.
#[test]
fn output_is_the_same_on_every_run() {
    let runs: Vec<_> = (0..3).map(|_| std::thread::spawn(|| rocking_codegen::generate(4))).collect();
    let here = rocking_codegen::generate(4);
    for run in runs {
        assert_eq!(run.join().expect("no panic"), here);
    }
}

/// From wherever the generator is called: a process in another folder writes the same bytes.
#[test]
fn output_does_not_depend_on_the_folder() {
    const FILE: &str = "ROCKING_GENERATED_TEXT";
    if let Some(path) = std::env::var_os(FILE) {
        std::fs::write(path, rocking_codegen::generate(3).expect("a valid size")).expect("the folder can be written");
        return;
    }
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("from_another_folder.rs");
    let status = std::process::Command::new(std::env::current_exe().expect("this test"))
        .args(["--exact", "output_does_not_depend_on_the_folder"])
        .env(FILE, &path)
        .current_dir(std::env::temp_dir())
        .status()
        .expect("this test can be run again");
    assert!(status.success());
    let there = std::fs::read_to_string(&path).expect("the other process wrote it");
    assert_eq!(Ok(there), rocking_codegen::generate(3));
}

#[test]
fn sizes_out_of_range_are_refused_with_the_remedy() {
    for blocks in [0, rocking_codegen::LARGEST + 1] {
        let error = rocking_codegen::generate(blocks).expect_err("out of range").to_string();
        assert!(error.contains("ROCKING_MAX_BLOCKS") && error.contains("from 1 to 12"), "{error}");
    }
}
