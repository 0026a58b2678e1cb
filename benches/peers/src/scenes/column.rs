//! Three blocks under the paper's pulse of 3 αg, 10 s, with all openings and impacts.
//!
//! No peer runs it: none of them has a contact law for several interfaces.

use super::{PAPER, bare, exact, ours};
use crate::contest::{Point, contest};
use crate::report;
use rocking::{Column, Motion, Restitution, Scene};

/// Times ours.
pub fn run() -> Vec<Point> {
    let [half_width, half_height, eta, amplitude, omega] = PAPER;
    let mut scene = Scene::new(Column::equal_blocks(3, half_width, half_height, 2700.0, 9.81).expect("a valid column"));
    scene.restitution = Restitution::Eta(eta);
    scene.excitation.horizontal = Some(Motion::SinePulse { amplitude, omega, start: 0.0 });
    let scene = bare(scene, 10.0);
    let points = contest("three blocks, pulse", &exact(&scene), &ours(&scene));
    report::print(&points, &report::LEVELS);
    points
}
