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
    // As text: of an error, Cargo prints the name of its kind.
    let baked = rocking_codegen::generate_baked(&column).map_err(|error| error.to_string())?;
    std::fs::write(out.join("column.rs"), baked)?;
    let six_blocks = rocking_codegen::generate(6).map_err(|error| error.to_string())?;
    std::fs::write(out.join("six_blocks.rs"), six_blocks)?;
    Ok(())
}
