//! Tables on the screen, and the figures of record: `peers.csv` beside the crate's manifest.

use crate::common;
use crate::contest::{OURS, Point};
use std::fmt::Write;

/// Errors at which the fastest of both sides are compared `[s]`, `[rad]`, where a scene has no others.
pub const LEVELS: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// Whose points are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Ours,
    Peers,
}

/// Prints a scene's table: each peer beside the fastest of ours that errs no more, then the fastest of both sides at the errors
/// `levels`. Ratios are a peer's time over ours.
pub fn print(points: &[Point], levels: &[f64]) {
    let Some(first) = points.first() else { return };
    println!("\n{}", first.scene);
    let mut peers = points.iter().filter(|point| side(point) == Side::Peers).peekable();
    if peers.peek().is_some() {
        println!(
            "{:<44} {:>8} {:>10}   {:<24} {:>10} {:>7}",
            "", "error", "time", "ours at that error", "time", "ratio"
        );
    }
    for peer in peers {
        let name = format!("{}, {}", peer.program, setting(peer));
        print!("{name:<44} {:>8.1e} {:>10}   ", peer.error, reading(peer.time));
        match fastest(points, peer.error, Side::Ours) {
            Some(own) => println!("{:<24} {:>10} {:>7.2}", setting(own), reading(own.time), peer.time / own.time),
            None => println!("not reached"),
        }
    }
    for &level in levels {
        let [own, peer] = [Side::Ours, Side::Peers].map(|side| fastest(points, level, side));
        let told = |point: Option<&Point>| match point {
            Some(point) => format!("{}, {}, {}", reading(point.time), point.program, setting(point)),
            None => "none".into(),
        };
        let ratio = own.zip(peer).map_or(String::new(), |(own, peer)| format!("{:.2}", peer.time / own.time));
        println!("fastest at {level:.0e}:   {:<34} {:<58} {ratio:>6}", told(own), told(peer));
    }
}

fn setting(point: &Point) -> String {
    format!("{} {:e}", point.method, point.setting)
}

fn side(point: &Point) -> Side {
    if point.program == OURS { Side::Ours } else { Side::Peers }
}

/// The fastest of a side that errs no more than `level`.
fn fastest(points: &[Point], level: f64, of: Side) -> Option<&Point> {
    let able = points.iter().filter(|point| side(point) == of && point.error <= level);
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

/// Writes the file of record. `ratio` is a peer's time over that of the fastest of ours that errs no more.
pub fn write(points: &[Point]) -> std::io::Result<()> {
    let circumstances = common::circumstances();
    let mut csv = format!("scene,program,method,rtol_or_step,error,time_us,ratio,{}\n", common::CIRCUMSTANCES);
    for point in points {
        let Point { scene, program, method, setting, error, time } = point;
        let in_scene: Vec<Point> = points.iter().filter(|other| other.scene == *scene).cloned().collect();
        let own = fastest(&in_scene, *error, Side::Ours).filter(|_| side(point) == Side::Peers);
        let ratio = own.map_or(String::new(), |own| format!("{:.3}", time / own.time));
        let time = time * 1e6;
        let _ =
            writeln!(csv, "\"{scene}\",{program},{method},{setting:e},{error:.3e},{time:.3},{ratio},{circumstances}");
    }
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("peers.csv");
    std::fs::write(&path, csv)?;
    println!("\nwrote benches/peers/peers.csv");
    Ok(())
}
