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

#[test]
fn output_is_the_same_on_every_run() {
    assert_eq!(rocking_codegen::generate(4), rocking_codegen::generate(4));
}

#[test]
fn sizes_out_of_range_are_refused_with_the_remedy() {
    for blocks in [0, rocking_codegen::LARGEST + 1] {
        let error = rocking_codegen::generate(blocks).expect_err("out of range").to_string();
        assert!(error.contains("ROCKING_MAX_BLOCKS") && error.contains("from 1 to 12"), "{error}");
    }
}
