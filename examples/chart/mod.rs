//! Curves over two axes as SVG, and files written whole or not at all.
//!
//! Colours are those of Okabe & Ito, told apart by the colour-blind; curves differ in their dashes too.

#![allow(dead_code, reason = "each example takes what it needs")]

use std::fmt::Write;
use std::path::Path;

/// An axis.
pub struct Axis {
    /// What it shows, with its unit.
    pub label: &'static str,
    /// First and last value.
    pub range: [f64; 2],
    /// Where numbers stand.
    pub ticks: Vec<f64>,
    /// Whether equal distances are equal ratios.
    pub is_logarithmic: bool,
}

impl Axis {
    /// A linear axis with numbers at multiples of `tick`.
    pub fn linear(label: &'static str, range: [f64; 2], tick: f64) -> Axis {
        let [first, last] = range.map(|end| end / tick);
        let ticks = (first - 1e-9).ceil() as i64..=(last + 1e-9).floor() as i64;
        Axis { label, range, ticks: ticks.map(|index| index as f64 * tick).collect(), is_logarithmic: false }
    }

    /// A logarithmic axis with these numbers.
    pub fn logarithmic(label: &'static str, range: [f64; 2], ticks: Vec<f64>) -> Axis {
        Axis { label, range, ticks, is_logarithmic: true }
    }

    /// Place of a value, 0 to 1.
    fn share(&self, value: f64) -> f64 {
        let [at, first, last] =
            [value, self.range[0], self.range[1]].map(|v| if self.is_logarithmic { v.ln() } else { v });
        (at - first) / (last - first)
    }
}

/// A curve.
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Points; one that is not finite interrupts the line.
    pub points: Vec<[f64; 2]>,
    /// Whether points are marked.
    pub is_marked: bool,
    /// Points of their own, drawn small and pale in the curve's colour.
    pub specks: Vec<[f64; 2]>,
}

const COLOURS: [&str; 5] = ["#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7"];
const DASHES: [&str; 5] = ["none", "none", "7 3", "2 2", "9 3 2 3"];

/// Size of the frame, and room on its left, above, and right and below `[pixels]`.
const FRAME: [f64; 2] = [620.0, 380.0];
const ROOM: [f64; 4] = [64.0, 16.0, 150.0, 52.0];

/// The figure.
pub fn draw(x: &Axis, y: &Axis, curves: &[Curve]) -> String {
    let (width, height) = (ROOM[0] + FRAME[0] + ROOM[2], ROOM[1] + FRAME[1] + ROOM[3]);
    let place = |[u, v]: [f64; 2]| [ROOM[0] + FRAME[0] * x.share(u), ROOM[1] + FRAME[1] * (1.0 - y.share(v))];
    let (left, top) = (ROOM[0], ROOM[1]);
    let (right, bottom) = (left + FRAME[0], top + FRAME[1]);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"#222222\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    let text = |svg: &mut String, [x, y]: [f64; 2], anchor: &str, text: &str| {
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>");
    };
    for tick in &x.ticks {
        let [at, _] = place([*tick, y.range[0]]);
        let _ = writeln!(svg, "<path d=\"M{at:.1} {top:.1}V{bottom:.1}\" stroke=\"#dddddd\" stroke-width=\"0.8\"/>");
        text(&mut svg, [at, bottom + 16.0], "middle", &number(*tick));
    }
    for tick in &y.ticks {
        let [_, at] = place([x.range[0], *tick]);
        let _ = writeln!(svg, "<path d=\"M{left:.1} {at:.1}H{right:.1}\" stroke=\"#dddddd\" stroke-width=\"0.8\"/>");
        text(&mut svg, [left - 7.0, at + 4.0], "end", &number(*tick));
    }
    for (index, curve) in curves.iter().enumerate() {
        let (colour, dashes) = (COLOURS[index % COLOURS.len()], DASHES[index % DASHES.len()]);
        for speck in &curve.specks {
            let [u, v] = place(*speck);
            let _ = writeln!(svg, "<circle cx=\"{u:.1}\" cy=\"{v:.1}\" r=\"1.1\" fill=\"{colour}\" opacity=\"0.45\"/>");
        }
        for part in curve.points.split(|point| !point[1].is_finite()).filter(|part| !part.is_empty()) {
            let places: Vec<String> =
                part.iter().map(|point| place(*point)).map(|[u, v]| format!("{u:.1},{v:.1}")).collect();
            let _ = writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-dasharray=\"{dashes}\"/>",
                places.join(" ")
            );
            for [u, v] in part.iter().map(|point| place(*point)).filter(|_| curve.is_marked || part.len() == 1) {
                let _ = writeln!(svg, "<circle cx=\"{u:.1}\" cy=\"{v:.1}\" r=\"2.8\" fill=\"{colour}\"/>");
            }
        }
        let row = top + 14.0 + 20.0 * index as f64;
        let _ = writeln!(
            svg,
            "<path d=\"M{:.1} {row:.1}h28\" stroke=\"{colour}\" stroke-width=\"1.6\" stroke-dasharray=\"{dashes}\"/>",
            right + 12.0
        );
        text(&mut svg, [right + 46.0, row + 4.0], "start", &curve.name);
    }
    let _ = writeln!(
        svg,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#666666\"/>",
        FRAME[0], FRAME[1]
    );
    text(&mut svg, [0.5 * (left + right), height - 12.0], "middle", x.label);
    let middle = 0.5 * (top + bottom);
    let _ = writeln!(
        svg,
        "<text x=\"16\" y=\"{middle}\" transform=\"rotate(-90 16 {middle})\" text-anchor=\"middle\">{}</text>",
        y.label
    );
    svg.push_str("</svg>\n");
    svg
}

/// A tick without the rounding of its product.
fn number(tick: f64) -> String {
    format!("{}", (tick * 1e6).round() / 1e6)
}

/// Writes a file under another name first, so that it is there whole or not at all.
///
/// # Errors
/// Those of the file system.
pub fn write(path: &Path, text: &str) -> std::io::Result<()> {
    let draft = path.with_extension("part");
    std::fs::write(&draft, text)?;
    std::fs::rename(&draft, path)?;
    println!("wrote {}", path.display());
    Ok(())
}
