//! Panels: parts of a stretch so short that contact forces are parabolas over them.

use crate::mechanics::dynamics::ContactForce;
use crate::numerics::per_block::PerBlock;

/// Number of parts into which a panel that is too long is divided: what parabolas leave out falls with the third power.
pub(crate) const PARTS: usize = 16;

/// Contact forces over a part of a stretch.
pub(crate) struct Panel<'a> {
    /// At start, middle and end.
    pub forces: [&'a [ContactForce]; 3],
    /// Whether forces are monotonic from start to end: their extremes are then at the ends.
    pub is_monotonic: bool,
    /// Whether the panel can be divided: one that is monotonic cannot, nor can a part of another.
    pub is_divisible: bool,
    /// Time of a place, 0 to 1 from start to end `[s]`; evaluated on demand.
    pub time: &'a dyn Fn(f64) -> f64,
    /// How often the motion passes the panel: a swing goes out and comes back.
    pub weight: f64,
}

/// What becomes of a panel that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reading {
    /// It has been read.
    Taken,
    /// It is too long for parabolas, and has not been read: its parts are shown in its place, if it is divisible.
    TooLong,
}

/// The contact forces of a motion on the way from panel to panel. Places are counted in panels from the start of the motion.
pub(super) struct Panels<F, T> {
    /// Forces at the end of the last panel that was read, at first those at the place 0.
    start: PerBlock<ContactForce>,
    middle: PerBlock<ContactForce>,
    end: PerBlock<ContactForce>,
    weight: f64,
    /// Writes the forces at a place over its argument.
    forces_at: F,
    /// Time of a place `[s]`.
    time: T,
}

impl<F: FnMut(f64, &mut [ContactForce]), T: Fn(f64) -> f64> Panels<F, T> {
    /// The panels of a motion that begins with the forces `start` and is passed `weight` times.
    #[inline(always)]
    pub fn new(start: PerBlock<ContactForce>, weight: f64, forces_at: F, time: T) -> Panels<F, T> {
        Panels { middle: start.clone(), end: start.clone(), start, weight, forces_at, time }
    }

    /// Shows `note` this number of panels, and the parts of those that are too long.
    #[inline(always)]
    pub fn show(mut self, count: usize, note: &mut dyn FnMut(&Panel) -> Reading) {
        for panel in 0..count {
            let from = panel as f64;
            if self.show_one(from, 1.0, true, note) == Reading::TooLong {
                let length = 1.0 / PARTS as f64;
                for part in 0..PARTS {
                    self.show_one(from + part as f64 * length, length, false, note);
                }
            }
        }
    }

    #[inline(always)]
    fn show_one(
        &mut self,
        from: f64,
        length: f64,
        is_divisible: bool,
        note: &mut dyn FnMut(&Panel) -> Reading,
    ) -> Reading {
        (self.forces_at)(from + 0.5 * length, &mut self.middle);
        (self.forces_at)(from + length, &mut self.end);
        let forces = [&self.start[..], &self.middle[..], &self.end[..]];
        let time = |place: f64| (self.time)(from + place * length);
        let reading = note(&Panel { forces, is_monotonic: false, is_divisible, time: &time, weight: self.weight });
        if reading == Reading::Taken || !is_divisible {
            self.start.copy_from_slice(&self.end);
        }
        reading
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three panels of a force that falls by one a panel; the second is too long.
    #[test]
    fn parts_stand_in_the_place_of_a_panel_that_is_too_long() {
        let force = |place: f64| ContactForce { normal: 3.0 - place, tangential: 0.0, moment: 0.0 };
        let mut evaluated = 0;
        let forces_at = |place: f64, forces: &mut [ContactForce]| {
            evaluated += 1;
            forces.fill(force(place));
        };
        let mut taken: Vec<[f64; 2]> = Vec::new();
        let start = PerBlock::filled(force(0.0), 2);
        Panels::new(start, 1.0, forces_at, |place| 10.0 + 2.0 * place).show(3, &mut |panel| {
            let times = [0.0, 0.5, 1.0].map(|place| (panel.time)(place));
            for (forces, t) in panel.forces.iter().zip(times) {
                assert_eq!((forces.len(), forces[1].normal), (2, 3.0 - 0.5 * (t - 10.0)));
            }
            if panel.is_divisible && times[0] == 12.0 {
                return Reading::TooLong;
            }
            taken.push([times[0], times[2]]);
            Reading::Taken
        });
        assert_eq!(taken.len(), 2 + PARTS);
        assert_eq!(
            [taken[0], taken[1], taken[PARTS], taken[PARTS + 1]],
            [[10.0, 12.0], [12.0, 12.125], [13.875, 14.0], [14.0, 16.0]]
        );
        assert!(taken.windows(2).all(|pair| pair[0][1] == pair[1][0]));
        assert_eq!(evaluated, 2 * (3 + PARTS));
    }
}
