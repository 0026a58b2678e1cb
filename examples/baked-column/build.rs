//! Calls the generator twice: for one column with its sizes as literals, and for any column of up to six blocks.

use rocking_codegen::bake::{BakedBlock, BakedColumn};
use std::path::PathBuf;

include!("src/sizes.rs");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/sizes.rs");
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let blocks = BLOCKS.map(|(half_width, half_height)| BakedBlock::rectangle(half_width, half_height, DENSITY));
    let column = BakedColumn { gravity: GRAVITY, blocks: blocks.to_vec() };
    std::fs::write(out.join("column.rs"), rocking_codegen::generate_baked(&column)?)?;
    std::fs::write(out.join("six_blocks.rs"), rocking_codegen::generate(6)?)?;
    Ok(())
}
