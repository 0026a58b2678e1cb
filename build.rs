//! Derives the equations of motion of columns of up to `ROCKING_MAX_BLOCKS` blocks and writes them to `OUT_DIR`.

use std::path::PathBuf;

/// A cold release build with five blocks stays far below a minute on two cores.
const DEFAULT_MAX_BLOCKS: usize = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=ROCKING_MAX_BLOCKS");
    let max_blocks = match std::env::var("ROCKING_MAX_BLOCKS") {
        Ok(text) => text.trim().parse().map_err(|_| format!("ROCKING_MAX_BLOCKS = `{text}` is not a whole number"))?,
        Err(_) => DEFAULT_MAX_BLOCKS,
    };
    let text = rocking_codegen::generate(max_blocks)?;
    let out = PathBuf::from(std::env::var("OUT_DIR")?).join("equations.rs");
    std::fs::write(out, text)?;
    Ok(())
}
