//! The work-precision figure as SVG: error against time, a panel per scene, logarithmic axes that all panels share.
//!
//! Colours are those of Okabe & Ito, told apart by the colour-blind; methods differ in their markers too. Generated equations
//! are solid, generic ones dashed and hollow.

use crate::sweep::{Code, METHODS, Point};
use crate::tables::curve;
use rocking::Method;
use std::fmt::Write;

/// How a method is drawn.
struct Style {
    name: &'static str,
    colour: &'static str,
    /// Corners of its marker; none for a circle.
    marker: &'static [[f64; 2]],
}

fn style(method: Method) -> Style {
    let style = |name, colour, marker| Style { name, colour, marker };
    match method {
        Method::Dop853 => style("DOP853", "#0072B2", &[]),
        Method::DormandPrince54 => {
            style("Dormand-Prince 5(4)", "#E69F00", &[[-2.7, -2.7], [2.7, -2.7], [2.7, 2.7], [-2.7, 2.7]])
        }
        Method::Taylor => style("Taylor series", "#D55E00", &[[0.0, -3.8], [3.5, 2.5], [-3.5, 2.5]]),
        Method::KuttaMerson => style("Kutta-Merson 4", "#009E73", &[[0.0, -3.8], [3.8, 0.0], [0.0, 3.8], [-3.8, 0.0]]),
        Method::RungeKutta4 => style("Runge-Kutta 4, fixed steps", "#CC79A7", &[[0.0, 3.8], [3.5, -2.5], [-3.5, -2.5]]),
        other => unreachable!("{} is not compared", other.name()),
    }
}

const COLUMNS: usize = 4;
const PANEL: [f64; 2] = [236.0, 220.0];
/// Room left of the first panel and above each.
const MARGIN: [f64; 2] = [58.0, 30.0];
const GAP: [f64; 2] = [16.0, 36.0];

/// Errors shown, as powers of ten: rounding to hopeless. What lies outside is drawn on the edge.
const ERRORS: [f64; 2] = [-15.0, -2.0];

struct Axes {
    times: [f64; 2],
    corner: [f64; 2],
}

impl Axes {
    fn x(&self, time: f64) -> f64 {
        self.corner[0] + PANEL[0] * (time.log10() - self.times[0]) / (self.times[1] - self.times[0])
    }

    fn y(&self, error: f64) -> f64 {
        let digits = error.log10().clamp(ERRORS[0], ERRORS[1]);
        self.corner[1] + PANEL[1] * (ERRORS[1] - digits) / (ERRORS[1] - ERRORS[0])
    }
}

fn marker(svg: &mut String, method: Method, code: Code, [x, y]: [f64; 2]) {
    let Style { colour, marker, .. } = style(method);
    let fill = if code == Code::Generated { colour } else { "#ffffff" };
    let paint = format!("fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.2\"");
    let _ = if marker.is_empty() {
        writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" {paint}/>")
    } else {
        let corners: Vec<String> = marker.iter().map(|[u, v]| format!("{:.1},{:.1}", x + u, y + v)).collect();
        writeln!(svg, "<polygon points=\"{}\" {paint}/>", corners.join(" "))
    };
}

fn line(svg: &mut String, method: Method, code: Code, points: &[[f64; 2]]) {
    if points.is_empty() {
        return;
    }
    let places: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let dashes = if code == Code::Generic { " stroke-dasharray=\"4 3\"" } else { "" };
    let (colour, places) = (style(method).colour, places.join(" "));
    let _ =
        writeln!(svg, "<polyline points=\"{places}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.4\"{dashes}/>");
    points.iter().for_each(|place| marker(svg, method, code, *place));
}

fn text(svg: &mut String, [x, y]: [f64; 2], anchor: &str, text: &str) {
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>");
}

/// A time as one reads it.
fn reading(digits: i32) -> String {
    match digits {
        6.. => format!("{} s", 10i64.pow(digits as u32 - 6)),
        3.. => format!("{} ms", 10i64.pow(digits as u32 - 3)),
        0.. => format!("{} µs", 10i64.pow(digits as u32)),
        _ => format!("1e{digits} µs"),
    }
}

fn panel(svg: &mut String, axes: &Axes, name: &str, points: &[Point], is_left: bool, is_lowest: bool) {
    let [left, top] = axes.corner;
    let (right, bottom) = (left + PANEL[0], top + PANEL[1]);
    let _ = writeln!(svg, "<text x=\"{left:.1}\" y=\"{:.1}\" font-weight=\"bold\">{name}</text>", top - 8.0);
    for digits in axes.times[0].ceil() as i32..=axes.times[1].floor() as i32 {
        let x = axes.x(10f64.powi(digits));
        let _ = writeln!(svg, "<path d=\"M{x:.1} {top:.1}V{bottom:.1}\" stroke=\"#dddddd\" stroke-width=\"0.8\"/>");
        if is_lowest {
            text(svg, [x, bottom + 15.0], "middle", &reading(digits));
        }
    }
    for digits in (ERRORS[0] as i32..=ERRORS[1] as i32).filter(|digits| digits % 2 == 0) {
        let y = axes.y(10f64.powi(digits));
        let _ = writeln!(svg, "<path d=\"M{left:.1} {y:.1}H{right:.1}\" stroke=\"#dddddd\" stroke-width=\"0.8\"/>");
        if is_left && digits % 4 == 0 {
            text(svg, [left - 6.0, y + 4.0], "end", &format!("1e{digits}"));
        }
    }
    let _ = writeln!(
        svg,
        "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#666666\"/>",
        PANEL[0], PANEL[1]
    );
    for code in [Code::Generic, Code::Generated] {
        for method in METHODS {
            let curve = curve(points, name, method, code);
            let places = curve.iter().filter(|p| p.angle_error.is_finite());
            let places: Vec<[f64; 2]> = places.map(|p| [axes.x(p.best), axes.y(p.angle_error.max(1e-300))]).collect();
            line(svg, method, code, &places);
        }
    }
}

fn legend(svg: &mut String, [left, top]: [f64; 2]) {
    let entries = METHODS.map(|method| (method, Code::Generated, style(method).name));
    let codes = [
        (Method::Dop853, Code::Generated, "solid: generated equations"),
        (Method::Dop853, Code::Generic, "dashed: generic equations"),
    ];
    for (row, (method, code, name)) in entries.into_iter().chain(codes).enumerate() {
        let y = top + 16.0 + 22.0 * row as f64 + if row >= METHODS.len() { 10.0 } else { 0.0 };
        line(svg, method, code, &[[left + 12.0, y], [left + 42.0, y]]);
        text(svg, [left + 52.0, y + 4.0], "start", name);
    }
}

/// The figure.
pub fn draw(points: &[Point]) -> String {
    let mut names: Vec<&'static str> = points.iter().map(|point| point.scene).collect();
    names.dedup();
    let cells = names.len() + 1;
    let (columns, rows) = (COLUMNS.min(cells), cells.div_ceil(COLUMNS));
    let corner = |cell: usize| {
        let (column, row) = ((cell % COLUMNS) as f64, (cell / COLUMNS) as f64);
        [MARGIN[0] + column * (PANEL[0] + GAP[0]), MARGIN[1] + row * (PANEL[1] + GAP[1])]
    };
    let times = points.iter().map(|point| point.best.log10());
    let (low, high) = times.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
    // A few pixels of room for the markers.
    let times = [low - 0.08, high + 0.08];
    let width = MARGIN[0] + columns as f64 * (PANEL[0] + GAP[0]);
    let height = MARGIN[1] + rows as f64 * (PANEL[1] + GAP[1]) + 14.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"#222222\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for (cell, name) in names.iter().enumerate() {
        let axes = Axes { times, corner: corner(cell) };
        // The cell below is empty, or the legend's.
        let is_lowest = cell + COLUMNS >= names.len();
        panel(&mut svg, &axes, name, points, cell % COLUMNS == 0, is_lowest);
    }
    legend(&mut svg, corner(names.len()));
    let middle = MARGIN[1] + 0.5 * (height - MARGIN[1] - GAP[1]);
    let _ = writeln!(
        svg,
        "<text x=\"14\" y=\"{middle}\" transform=\"rotate(-90 14 {middle})\" text-anchor=\"middle\">largest error of an \
         angle [rad]</text>"
    );
    text(&mut svg, [0.5 * (width + MARGIN[0]), height - 8.0], "middle", "time of a run");
    svg.push_str("</svg>\n");
    svg
}
