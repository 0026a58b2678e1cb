//! Derives the equations of motion of columns of up to N blocks and writes them to `OUT_DIR`. N is `ROCKING_MAX_BLOCKS` if that has a value, else
//! the largest enabled feature of `blocks-6` to `blocks-8`, else five.

use std::path::PathBuf;

const DEFAULT_MAX_BLOCKS: usize = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=ROCKING_MAX_BLOCKS");
    println!("cargo::rerun-if-env-changed=ROCKING_DUMP_DIR");
    // Tests that compare with the independent runs in `../shared` are reported as ignored where that folder does not exist.
    println!("cargo::rustc-check-cfg=cfg(has_shared)");
    if std::path::Path::new("../shared").is_dir() {
        println!("cargo::rustc-cfg=has_shared");
    }
    let has_feature = |blocks: &usize| std::env::var_os(format!("CARGO_FEATURE_BLOCKS_{blocks}")).is_some();
    let max_blocks = match std::env::var("ROCKING_MAX_BLOCKS").as_deref().map(str::trim) {
        Ok("") | Err(_) => (6..=8).rev().find(has_feature).unwrap_or(DEFAULT_MAX_BLOCKS),
        Ok(text) => text.parse().map_err(|_| format!("ROCKING_MAX_BLOCKS = `{text}`: give a number, 1 to 12"))?,
    };
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let dump = std::env::var_os("ROCKING_DUMP_DIR").map(PathBuf::from);
    dump.iter().try_for_each(std::fs::create_dir_all)?;
    for (name, text) in rocking_codegen::modules(max_blocks).map_err(|error| error.to_string())? {
        let dumped = dump.iter().map(|folder| folder.join(format!("{name}_{max_blocks}.rs")));
        dumped.chain([out.join(format!("{name}.rs"))]).try_for_each(|file| std::fs::write(file, &text))?;
    }
    Ok(())
}
