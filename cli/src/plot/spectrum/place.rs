//! A panel of a figure of a sweep: positions, ticks, numbers, labels.

use super::outline::Corner;
use super::scale::Scale;
use crate::plot::curve::{Frame, Point};
use crate::plot::sheet::{Anchor, Sheet, text_width};
use crate::plot::style::{self, Stroke};

/// Room for a title above a panel, for numbers below it, and between panels `[px]`.
pub const TITLE: f64 = 24.0;
pub const NUMBERS: f64 = 26.0;
pub const GAP: f64 = 14.0;
const TICK: f64 = 4.0;
/// Bound of the overhang of a number beyond the left end of its axis, if another panel stands on the left `[px]`.
const BESIDE: f64 = 2.0;

const GRID: Stroke = Stroke::solid(style::FAINT, 0.9);

/// Number of lines with different colours. Further lines repeat the colours with other dashes.
const LINES: usize = 7;

/// The line of a curve, counted from zero. From the eighth curve on, colours are repeated with other dashes.
pub fn line(number: usize) -> Stroke {
    Stroke { color: style::line(number).color, ..style::line(number + number / LINES) }
}

/// A panel on paper.
pub struct Place<'g> {
    pub frame: Frame,
    pub x: &'g Scale,
    pub y: &'g Scale,
    /// Name of the upper edge; empty if it has none.
    pub top_name: &'static str,
}

impl Place<'_> {
    /// Point on paper `[px]` at these shares of the axes, from 0 to 1.
    pub fn at(&self, [x, y]: Point) -> Point {
        [self.frame.left + self.frame.width * x, self.frame.bottom() - self.frame.height * y]
    }

    pub fn corner(&self, [column, row]: Corner) -> Point {
        self.at([self.x.edges[column], self.y.edges[row]])
    }

    /// Draws frame, ticks and, as `numbers` says for `[x, y]`, numbers. A panel without numbers upwards is taken to have a panel on its left.
    pub fn axes(&self, sheet: &mut Sheet, numbers: [bool; 2]) {
        sheet.outline(&self.frame);
        for (value, text) in self.x_ticks() {
            let [x, y] = self.at([self.x.share(value), 0.0]);
            sheet.line([x, y], [x, y + TICK], &style::THIN);
            // The numbers of neighbours must not run together.
            let is_beside = numbers[1] || x - 0.5 * text_width(&text, style::NUMBER) > self.frame.left - BESIDE;
            if numbers[0] && is_beside {
                // A long number at the right end stays on the paper.
                let x = x.min(sheet.width - 0.5 * text_width(&text, style::NUMBER));
                sheet.words([x, y + TICK + 14.0], &text, style::NUMBER, Anchor::Middle);
            }
        }
        // A strip has one cell upwards, and nothing to number.
        let upwards = if self.y.values.len() > 1 { self.y_ticks() } else { Vec::new() };
        for (value, text) in upwards {
            let [x, y] = self.at([0.0, self.y.share(value)]);
            sheet.line([x - TICK, y], [x, y], &style::THIN);
            // The name of the upper edge takes the place of a number beside it.
            let is_free = self.top_name.is_empty() || y - self.frame.top > f64::from(style::NUMBER);
            if numbers[1] && is_free {
                sheet.words([x - TICK - 4.0, y + 4.5], &text, style::NUMBER, Anchor::End);
            }
        }
        if numbers[1] {
            sheet.words([self.frame.left - TICK - 4.0, self.frame.top + 4.5], self.top_name, style::NOTE, Anchor::End);
        }
    }

    /// The label of the upward axis, left of its numbers.
    pub fn label_upwards(&self, sheet: &mut Sheet, text: String) {
        let widths = self.y_ticks().into_iter().map(|(_, number)| text_width(&number, style::NUMBER));
        let right = self.frame.left - TICK - 14.0 - widths.fold(0.0, f64::max);
        let at = [right.max(16.0), self.frame.top + 0.5 * self.frame.height];
        sheet.words_upwards(at, &text, style::LABEL, Anchor::Middle);
    }

    /// As many ticks as have room for their numbers beside one another.
    fn x_ticks(&self) -> Vec<(f64, String)> {
        let most = (self.frame.width / 48.0).clamp(2.0, 6.0) as usize;
        let fits = |ticks: &Vec<(f64, String)>| {
            ticks.windows(2).all(|pair| {
                let [left, right] = [0, 1].map(|tick| text_width(&pair[tick].1, style::NUMBER));
                let apart = self.frame.width * (self.x.share(pair[1].0) - self.x.share(pair[0].0)).abs();
                apart > 0.5 * (left + right)
            })
        };
        let fewer = (1..=most).rev().map(|count| self.x.ticks(count));
        fewer.into_iter().find(fits).unwrap_or_default()
    }

    fn y_ticks(&self) -> Vec<(f64, String)> {
        self.y.ticks((self.frame.height / 50.0).clamp(2.0, 6.0) as usize)
    }

    /// Lines of the grid.
    pub fn grid(&self, sheet: &mut Sheet) {
        for (value, _) in self.x_ticks() {
            let x = self.x.share(value);
            sheet.line(self.at([x, 0.0]), self.at([x, 1.0]), &GRID);
        }
        for (value, _) in self.y_ticks() {
            let y = self.y.share(value);
            sheet.line(self.at([0.0, y]), self.at([1.0, y]), &GRID);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::paper::Paper;
    use crate::plot::sheet::Figure;

    /// The upper edge is at 1.42, and 1.4 is a tick five pixels below it.
    #[test]
    fn the_name_of_the_upper_edge_takes_the_place_of_a_number() {
        let drawn = |top_name: &'static str| {
            let [x, y] = [Scale::over("", vec![0.0, 1.0]), Scale::over("", vec![0.0, 1.42])];
            let frame = Frame { left: 80.0, top: 20.0, width: 400.0, height: 380.0 };
            let mut sheet = Sheet::new("a panel", &Paper::default());
            Place { frame, x: &x, y: &y, top_name }.axes(&mut sheet, [true, true]);
            Figure::new("panel", String::new(), sheet).svg
        };
        let [without, with] = ["", "lost"].map(drawn);
        assert!(without.contains(">1.4<") && with.contains(">1.2<"), "{without}");
        assert!(with.contains(">lost<") && !with.contains(">1.4<"), "{with}");
    }
}
