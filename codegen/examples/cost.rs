//! What generating costs: `cargo run --release -p rocking-codegen --example cost -- N` prints one line of CSV,
//! `blocks,modes,linkages,step_programs,force_programs,generation_seconds,bytes,lines`, for columns of up to N blocks.

use rocking_codegen::{catalogue, emit};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let blocks: usize = std::env::args().nth(1).ok_or("how many blocks?")?.parse()?;
    let start = Instant::now();
    let catalogue = catalogue(blocks)?;
    let text = emit::module(&catalogue);
    let seconds = start.elapsed().as_secs_f64();
    let modes = (3u64.pow(blocks as u32) - 1) / 2;
    let (linkages, steps, forces) =
        (catalogue.linkages.len(), catalogue.accelerations[0].len(), catalogue.forces.len());
    println!("{blocks},{modes},{linkages},{steps},{forces},{seconds:.2},{},{}", text.len(), text.lines().count());
    Ok(())
}
