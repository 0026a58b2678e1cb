//! Tables on the screen, and the figures of record: `peers.csv` beside the crate's manifest.

use crate::common;
use crate::contest::{OURS, Point};
use std::fmt::Write;

/// Errors at which the fastest of both sides are compared `[s]`, `[rad]`.
const LEVELS: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// Prints a scene's table: each peer beside the fastest of ours that errs no more.
pub fn print(points: &[Point], levels: &[f64]) {
    let Some(first) = points.first() else { return };
    println!("\n{}", first.scene);
    println!(
        "{:<48} {:>9} {:>10}   {:<26} {:>10} {:>7}",
        "peer", "error", "time", "ours at that error", "time", "ratio"
    );
    for peer in points.iter().filter(|point| point.program != OURS) {
        let name = format!("{}, {}, {:.0e}", peer.program, peer.method, peer.setting);
        print!("{name:<48} {:>9.1e} {:>10}   ", peer.error, reading(peer.time));
        match fastest(points, peer.error, true) {
            Some(own) => println!("{:<26} {:>10} {:>7.2}", setting(own), reading(own.time), peer.time / own.time),
            None => println!("not reached"),
        }
    }
    println!("fastest at an error:");
    for &level in levels {
        let [own, peer] = [true, false].map(|ours| fastest(points, level, ours));
        let told = |point: Option<&Point>| match point {
            Some(point) => format!("{} {} {}", reading(point.time), point.program, setting(point)),
            None => "not reached".into(),
        };
        let ratio = own.zip(peer).map(|(own, peer)| format!("{:.2}", peer.time / own.time));
        println!("    {level:.0e}   {:<40} {:<60} {:>6}", told(own), told(peer), ratio.unwrap_or_default());
    }
}

/// As [`print`], at the errors that most scenes are compared at.
pub fn print_at_levels(points: &[Point]) {
    print(points, &LEVELS);
}

fn setting(point: &Point) -> String {
    format!("{} {:.0e}", point.method, point.setting)
}

/// The fastest of ours, or of the peers, that errs no more than `level`.
fn fastest(points: &[Point], level: f64, ours: bool) -> Option<&Point> {
    let able = points.iter().filter(|point| (point.program == OURS) == ours && point.error <= level);
    able.min_by(|a, b| a.time.total_cmp(&b.time))
}

/// A time as one reads it.
pub fn reading(seconds: f64) -> String {
    match seconds {
        s if s < 1e-3 => format!("{:.2} µs", s * 1e6),
        s if s < 1.0 => format!("{:.2} ms", s * 1e3),
        s => format!("{s:.2} s"),
    }
}

/// Writes the file of record.
pub fn write(points: &[Point]) -> std::io::Result<()> {
    let circumstances = common::circumstances();
    let mut csv = format!("scene,program,method,rtol_or_step,error,time_us,{}\n", common::CIRCUMSTANCES);
    for Point { scene, program, method, setting, error, time } in points {
        let time = time * 1e6;
        let _ = writeln!(csv, "\"{scene}\",{program},{method},{setting:e},{error:.3e},{time:.3},{circumstances}");
    }
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("peers.csv");
    std::fs::write(&path, csv)?;
    println!("\nwrote benches/peers/peers.csv");
    Ok(())
}
