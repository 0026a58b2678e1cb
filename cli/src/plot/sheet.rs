//! The sheet of paper: what is drawn on it, and how that becomes SVG and PNG. The only file that knows `kuva`.
//!
//! `kuva` draws frames, ticks, grids and text. It writes all outputs from one list of primitives, so that they show the same. For PNGs
//! `kuva` has a font of its own; SVGs name a font family. [`super::curve`] thins, clips and dashes curves before `kuva` gets them. SVGs
//! therefore need no identifiers, which could clash where several SVGs stand on one page.

use super::axis::Axis;
use super::curve::{self, Frame, Point};
use super::paper::{Paper, Picture};
use super::style::{self, Stroke};
use crate::text::{escape, printable};
use kuva::RasterBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::axis::add_axes_and_grid;
use kuva::render::layout::{ComputedLayout, Layout, TickFormat};
use kuva::render::render::{PathData, Primitive, Scene};
use std::fmt::Write as _;
use std::sync::Arc;

/// Room for numbers and labels left of panels `[px]`.
pub const LEFT: f64 = 78.0;
/// Room right of panels `[px]`.
pub const RIGHT: f64 = 18.0;
/// Smallest width of panels that stand beside one another `[px]`.
const NARROWEST: f64 = 140.0;
/// Pixels of a PNG per pixel of the sheet: 366 dots per inch on the usual 15 cm.
const PNG_SCALE: f32 = 3.0;

/// A sheet: what is drawn later lies on top.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Title, for those who cannot see the sheet.
    pub title: String,
    paper: Paper,
    /// `[px]`
    pub width: f64,
    /// `[px]`
    pub height: f64,
    /// Primitives in the order of drawing.
    drawn: Vec<Primitive>,
    /// Curves of data in panels, as points on paper `[px]`. Names of marked lines are placed clear of these curves.
    data: Vec<Vec<Point>>,
    /// Patches under texts on paper. Names of marked lines are placed clear of these as well.
    patches: Vec<Frame>,
}

/// A figure: its name, its caption, its SVG document, and the sheet that it was drawn from.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name without extension, e.g. `time-history`.
    pub name: &'static str,
    /// Content in a sentence, for the reader of a report.
    pub caption: String,
    /// The document.
    pub svg: String,
    sheet: Sheet,
}

impl Figure {
    /// A sheet with its name and its caption.
    pub fn new(name: &'static str, caption: String, sheet: Sheet) -> Figure {
        Figure { name, svg: sheet.svg(&caption), caption, sheet }
    }

    /// Content of a file: the SVG itself, a PNG with three pixels per pixel of the SVG, or a PDF.
    ///
    /// # Errors
    /// What could not be drawn, in words.
    pub fn bytes(&self, picture: Picture) -> Result<Vec<u8>, String> {
        match picture {
            Picture::Svg => Ok(self.svg.clone().into_bytes()),
            Picture::Png => Ok(self.sheet.png()),
            #[cfg(feature = "pdf")]
            Picture::Pdf => self.sheet.pdf(),
        }
    }
}

/// Point of a text that is placed at a given position: left end, middle or right end.
pub use kuva::render::render::TextAnchor as Anchor;

/// A frame with axes.
#[derive(Clone, Debug)]
pub struct Panel {
    pub frame: Frame,
    pub x: Axis,
    /// `None` for a strip: its height has no meaning.
    pub y: Option<Axis>,
}

impl Panel {
    /// Position of a pair of values on paper.
    pub fn place(&self, [x, y]: Point) -> Point {
        let up = self.y.as_ref().map_or(0.0, |axis| axis.share(y));
        [self.place_x(x), self.frame.bottom() - self.frame.height * up]
    }

    /// Position of a value along the horizontal axis `[px]`.
    pub fn place_x(&self, x: f64) -> f64 {
        self.frame.left + self.frame.width * self.x.share(x)
    }

    /// Whether the upward axis reaches a value.
    pub fn reaches(&self, y: f64) -> bool {
        self.y.as_ref().is_some_and(|axis| (0.0..=1.0).contains(&axis.share(y)))
    }
}

/// Key of a legend entry: the look of the line or area whose name stands beside it.
#[derive(Clone, Debug)]
pub enum Key {
    /// A line.
    Line(Stroke),
    /// An area with a frame.
    Fill(&'static str),
    /// No mark: words only.
    None,
}

/// Width of a sentence, as a share of the estimate of [`text_width`]. The estimate is for names and numbers, which are wider.
const PROSE: f64 = 0.92;

/// Lengths in a legend `[px]`.
const LEGEND_LINE: f64 = 21.0;
const KEY_WIDTH: f64 = 34.0;
const FILL_WIDTH: f64 = 18.0;
const KEY_GAP: f64 = 7.0;
const ENTRY_GAP: f64 = 20.0;

impl Sheet {
    /// An empty sheet.
    pub fn new(title: &str, paper: &Paper) -> Sheet {
        Sheet {
            title: title.into(),
            paper: *paper,
            width: paper.width(),
            height: 0.0,
            drawn: Vec::new(),
            data: Vec::new(),
            patches: Vec::new(),
        }
    }

    /// A panel over the width of the sheet.
    pub fn wide(&self, top: f64, height: f64, x: Axis, y: Option<Axis>) -> Panel {
        Panel { frame: Frame { left: LEFT, top, width: self.width - LEFT - RIGHT, height }, x, y }
    }

    /// A panel over the width of the sheet, drawn with its axes; the label of the vertical one reads upwards.
    pub fn panel(&mut self, top: f64, height: f64, x: Axis, y: Axis) -> Panel {
        let panel = self.wide(top, height, x, Some(y));
        self.axes(&panel);
        self.label_upwards(&panel);
        panel
    }

    /// Largest number of panels that have room beside one another.
    pub fn most_columns(&self) -> usize {
        ((self.width - LEFT - RIGHT) / NARROWEST).floor().max(1.0) as usize
    }

    /// Frame, ticks and numbers of a panel.
    pub fn axes(&mut self, Panel { frame, x, y }: &Panel) {
        // Rounding must not lose the tick at an end.
        let widened = |axis: &Axis| [axis.range[0] - 1e-9 * axis.step, axis.range[1] + 1e-9 * axis.step];
        let (x_range, y_range) = (widened(x), y.as_ref().map_or([0.0, 1.0], widened));
        // Margins fix the position of the frame. The layout ends at the bottom of the frame, because the height of the sheet is not yet known.
        let mut layout = Layout::new((x_range[0], x_range[1]), (y_range[0], y_range[1]))
            .with_width(self.width)
            .with_height(frame.bottom())
            .with_force_margins(frame.left, self.width - frame.right())
            .with_force_margins_y(frame.top, 0.0)
            .with_x_axis_min(x_range[0])
            .with_x_axis_max(x_range[1])
            .with_y_axis_min(y_range[0])
            .with_y_axis_max(y_range[1])
            .with_x_tick_step(x.step)
            .with_y_tick_step(y.as_ref().map_or(1.0, |axis| axis.step))
            .with_x_tick_format(numbers(x, every(x, frame.width)))
            .with_tick_size(style::NUMBER)
            .with_tick_length(4.0)
            .with_show_grid(y.is_some())
            .with_box_axes();
        layout.theme.grid_color = style::FAINT.into();
        layout.theme.axis_color = style::INK.into();
        layout.theme.tick_color = style::INK.into();
        layout.suppress_y_ticks = y.is_none();
        if let Some(axis) = y {
            layout = layout.with_y_tick_format(numbers(axis, 1));
        }
        let mut scene = Scene::new(self.width, frame.bottom());
        add_axes_and_grid(&mut scene, &ComputedLayout::from_layout(&layout), &layout);
        let unlabelled = |drawn: &Primitive| matches!(drawn, Primitive::Text { content, .. } if content.is_empty());
        let width = self.width;
        self.drawn
            .extend(scene.elements.into_iter().filter(|drawn| !unlabelled(drawn)).map(|drawn| inside(drawn, width)));
    }

    /// The label of the upward axis, left of the numbers of the leftmost panel.
    pub fn label_upwards(&mut self, panel: &Panel) {
        let Some(axis) = &panel.y else { return };
        let at = [panel.frame.left - LEFT + 16.0, panel.frame.top + 0.5 * panel.frame.height];
        self.words_upwards(at, &axis.label, style::LABEL, Anchor::Middle);
    }

    /// The label of the horizontal axis, below the numbers. Returns the lower end of the label `[px]`.
    pub fn label_below(&mut self, panel: &Panel) -> f64 {
        let at = [panel.frame.left + 0.5 * panel.frame.width, panel.frame.bottom() + 38.0];
        self.words(at, &panel.x.label, style::LABEL, Anchor::Middle);
        at[1] + 6.0
    }

    /// Draws polylines in a panel, cut at the frame of the panel. `runs` are the polylines, with points on paper `[px]`.
    pub fn lines(&mut self, panel: &Panel, runs: &[Vec<Point>], stroke: &Stroke) {
        let inside: Vec<_> = runs.iter().flat_map(|run| curve::clip(run, &panel.frame)).collect();
        self.runs(&inside.iter().flat_map(|run| curve::dash(run, stroke.dashes)).collect::<Vec<_>>(), stroke);
        self.data.extend(inside);
    }

    /// Whether no curve of data and no other text on paper is in a frame, and the frame is on the sheet.
    pub fn is_free(&self, frame: &Frame) -> bool {
        let is_beside = |patch: &Frame| {
            patch.left >= frame.right()
                || patch.right() <= frame.left
                || patch.top >= frame.bottom()
                || patch.bottom() <= frame.top
        };
        let is_on_sheet = frame.left >= 0.0 && frame.right() <= self.width;
        is_on_sheet
            && self.patches.iter().all(is_beside)
            && self.data.iter().all(|run| curve::clip(run, frame).is_empty())
    }

    /// A history in a panel: values over time, thinned to what the width can show.
    pub fn history(&mut self, panel: &Panel, points: &[Point], stroke: &Stroke) {
        self.interrupted_history(panel, &[points], stroke);
    }

    /// A history with gaps between its parts.
    pub fn interrupted_history(&mut self, panel: &Panel, parts: &[impl AsRef<[Point]>], stroke: &Stroke) {
        let runs = parts.iter().map(|points| {
            let placed: Vec<Point> = points.as_ref().iter().map(|point| panel.place(*point)).collect();
            curve::straighten(&curve::thin_along_x(&placed))
        });
        self.lines(panel, &runs.collect::<Vec<_>>(), stroke);
    }

    /// A line across a panel at a value of the upward axis, if the axis reaches this value.
    pub fn level(&mut self, panel: &Panel, value: f64, stroke: &Stroke) {
        if panel.reaches(value) {
            let y = panel.place([panel.x.range[0], value])[1];
            self.line([panel.frame.left, y], [panel.frame.right(), y], stroke);
        }
    }

    /// A line anywhere.
    pub fn line(&mut self, from: Point, to: Point, stroke: &Stroke) {
        self.runs(&curve::dash(&[from, to], stroke.dashes), stroke);
    }

    /// Filled polygons.
    pub fn areas(&mut self, areas: Vec<Vec<Point>>, fill: &'static str) {
        self.drawn.push(path(&areas, Some(fill), None));
    }

    /// A translucent filled polygon; `opacity` from 0 to 1.
    pub fn veil(&mut self, corners: Vec<Point>, fill: &'static str, opacity: f64) {
        let mut veil = path(&[corners], Some(fill), None);
        if let Primitive::Path(path) = &mut veil {
            path.opacity = Some(opacity);
        }
        self.drawn.push(veil);
    }

    /// A filled polygon with an edge.
    pub fn shape(&mut self, corners: Vec<Point>, fill: &'static str, edge: &Stroke) {
        self.drawn.push(path(&[corners], Some(fill), Some(edge)));
    }

    /// Lines as one path, neither cut nor dashed.
    pub fn runs(&mut self, runs: &[Vec<Point>], stroke: &Stroke) {
        self.drawn.push(path(runs, None, Some(stroke)));
    }

    /// A pivot: a dark dot in a light ring.
    pub fn dot(&mut self, [x, y]: Point, color: &str) {
        self.drawn.push(Primitive::Circle {
            cx: tidy(x),
            cy: tidy(y),
            r: 2.8,
            fill: color.into(),
            fill_opacity: None,
            stroke: Some(style::REST_FILL.into()),
            stroke_width: Some(0.8),
        });
    }

    /// Begins a group of marks with a name.
    pub fn begin_group(&mut self, name: &str) {
        let title = Some(printable(name).into());
        self.drawn.push(Primitive::GroupStart { transform: None, title, extra_attrs: None });
    }

    /// Ends a group of marks.
    pub fn end_group(&mut self) {
        self.drawn.push(Primitive::GroupEnd);
    }

    /// Text. `at` is the point of its base line that `anchor` names: left end, middle or right end.
    pub fn words(&mut self, at: Point, text: &str, size: u32, anchor: Anchor) {
        self.text(at, text, size, anchor, None, false);
    }

    /// Text in bold type.
    pub fn bold_words(&mut self, at: Point, text: &str, size: u32, anchor: Anchor) {
        self.text(at, text, size, anchor, None, true);
    }

    /// Text upwards.
    pub fn words_upwards(&mut self, at: Point, text: &str, size: u32, anchor: Anchor) {
        self.text(at, text, size, anchor, Some(-90.0), false);
    }

    fn text(&mut self, [x, y]: Point, text: &str, size: u32, anchor: Anchor, rotate: Option<f64>, bold: bool) {
        // A dollar would begin a formula.
        let content = printable(text).replace('$', "\\$");
        self.drawn.push(Primitive::Text { x: tidy(x), y: tidy(y), content, size, anchor, rotate, bold, color: None });
    }

    /// Text on a white patch, so that it is legible where lines run.
    pub fn words_on_paper(&mut self, at: Point, text: &str, size: u32, anchor: Anchor) {
        self.patch(patch(at, text, size, anchor));
        self.words(at, text, size, anchor);
    }

    /// Upward text on a white patch.
    pub fn words_up_on_paper(&mut self, at: Point, text: &str, size: u32, anchor: Anchor) {
        self.patch(patch_upwards(at, text, size, anchor));
        self.words_upwards(at, text, size, anchor);
    }

    fn patch(&mut self, frame: Frame) {
        self.areas(vec![corners(&frame)], style::REST_FILL);
        self.patches.push(frame);
    }

    /// A legend from `top` down, over the width of the panels. An entry wider than the panels is broken into lines, beside which no other entry
    /// stands. Returns the lower end of the legend `[px]`.
    pub fn legend(&mut self, top: f64, entries: &[(Key, String)]) -> f64 {
        let (mut x, mut y) = (LEFT, top + 15.0);
        for (key, name) in entries {
            let (room, share) = match key {
                Key::Line(_) => (KEY_WIDTH + KEY_GAP, 1.0),
                Key::Fill(_) => (FILL_WIDTH + KEY_GAP, 1.0),
                Key::None => (0.0, PROSE),
            };
            let lines = broken(name, style::NOTE, (self.width - RIGHT - LEFT - room) / share);
            let width = room + lines.iter().map(|line| text_width(line, style::NOTE)).fold(0.0, f64::max);
            if x > LEFT && (lines.len() > 1 || x + width > self.width - RIGHT) {
                (x, y) = (LEFT, y + LEGEND_LINE);
            }
            self.key([x, y], key);
            for (place, line) in lines.iter().enumerate() {
                y += if place > 0 { LEGEND_LINE } else { 0.0 };
                self.words([x + room, y], line, style::NOTE, Anchor::Start);
            }
            x = if lines.len() > 1 { self.width } else { x + width + ENTRY_GAP };
        }
        y + 6.0
    }

    /// The key of a legend entry whose name has its base line at `y`.
    fn key(&mut self, [x, y]: Point, key: &Key) {
        match key {
            Key::Line(stroke) => self.line([x, y - 4.5], [x + KEY_WIDTH, y - 4.5], stroke),
            Key::Fill(fill) => {
                let swatch = Frame { left: x, top: y - 11.0, width: FILL_WIDTH, height: 13.0 };
                self.areas(vec![corners(&swatch)], fill);
                self.outline(&swatch);
            }
            Key::None => {}
        }
    }

    /// The edge of a frame.
    pub fn outline(&mut self, frame: &Frame) {
        let mut run = corners(frame);
        run.push(run[0]);
        self.runs(&[run], &style::THIN);
    }

    /// The document, with a caption for those who cannot see it.
    pub fn svg(&self, caption: &str) -> String {
        let body = self.elements(true);
        let (width, height, [title, caption]) = (self.width, self.height, [&self.title, caption].map(escape));
        // If the paper has a given width, lengths are in millimetres.
        let [across, down] = match self.paper.width_mm {
            None => [width.to_string(), height.to_string()],
            Some(millimetres) => [millimetres, millimetres * height / width].map(|length| format!("{length:.2}mm")),
        };
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{across}\" height=\"{down}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\" style=\"max-width:100%;height:auto\" \
             font-family=\"Helvetica, Arial, sans-serif\" fill=\"{}\">\n  <desc>{caption}</desc>{body}",
            style::INK
        )
    }

    /// An SVG without background, to be set in a line of text of a page. `attributes` are those of the root element.
    pub fn inline(&self, attributes: &str) -> String {
        let (width, height) = (self.width, self.height);
        let body = self.elements(false);
        format!("<svg {attributes} width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">{body}")
    }

    /// Content and end tag of the root, on white `paper` or none. The start tag of `kuva` is cut off: it lacks the view box that lets sheets scale.
    fn elements(&self, paper: bool) -> String {
        let mut scene = self.scene();
        scene.background_color = scene.background_color.filter(|_| paper);
        let drawn = SvgBackend::new().with_pretty(paper).render_scene(&scene);
        drawn.split_once('>').map_or_else(String::new, |(_, body)| body.into())
    }

    /// The sheet as a PNG file.
    pub fn png(&self) -> Vec<u8> {
        RasterBackend::new().with_scale(PNG_SCALE).render_scene(&self.scene()).expect("a sheet has a size")
    }

    /// The sheet as a PDF page of its size on paper, text as text.
    #[cfg(feature = "pdf")]
    pub fn pdf(&self) -> Result<Vec<u8>, String> {
        let points = self.paper.points_per_px();
        let page = kuva::PageSize::points(points * self.width, points * self.height);
        let mut scene = self.scene();
        // The font that comes with `kuva` has all signs; a font of this machine may lack some.
        scene.font_family = Some("DejaVu Sans".into());
        kuva::PdfBackend::new().with_page_size(page).render_scenes(&[scene])
    }

    fn scene(&self) -> Scene {
        let mut scene = Scene::new(self.width, self.height);
        scene.text_color = Some(style::INK.into());
        scene.add(Primitive::GroupStart {
            transform: None,
            title: None,
            extra_attrs: Some("stroke-linecap=\"round\" stroke-linejoin=\"round\"".into()),
        });
        scene.elements.extend(self.drawn.iter().cloned());
        scene.add(Primitive::GroupEnd);
        scene
    }
}

/// A number at a tick, moved to the left as far as it reaches beyond the sheet.
fn inside(drawn: Primitive, width: f64) -> Primitive {
    match drawn {
        Primitive::Text { x, y, content, size, anchor: Anchor::Middle, rotate: None, bold, color } => {
            let x = x.min(width - 1.0 - 0.5 * text_width(&content, size));
            Primitive::Text { x, y, content, size, anchor: Anchor::Middle, rotate: None, bold, color }
        }
        other => other,
    }
}

/// The numbers at the ticks of an axis, at those that are multiples of so many steps.
fn numbers(axis: &Axis, every: u32) -> TickFormat {
    let axis = axis.clone();
    // Counted from zero, or from the first tick of an axis that begins above it.
    let first = if axis.range[0] > 0.0 { (axis.range[0] / axis.step - 1e-9).ceil() } else { 0.0 };
    TickFormat::Custom(Arc::new(move |value| {
        let steps = (value / axis.step).round() - first;
        if axis.numbers && steps % f64::from(every) == 0.0 { axis.number(value) } else { String::new() }
    }))
}

/// Room between two numbers of an axis `[px]`.
const BETWEEN_NUMBERS: f64 = 5.0;

/// Of how many ticks one has a number, so that the numbers of an axis of this width do not run into one another `[px]`.
fn every(axis: &Axis, width: f64) -> u32 {
    let [low, high] = axis.range;
    let widest = [low, high].map(|end| text_width(&axis.number((end / axis.step).round() * axis.step), style::NUMBER));
    let needed = widest[0].max(widest[1]) + BETWEEN_NUMBERS;
    let apart = width * axis.step / (high - low);
    [1, 2, 5, 10].into_iter().find(|every| f64::from(*every) * apart >= needed).unwrap_or(20)
}

/// The corners of a frame.
pub fn corners(frame: &Frame) -> Vec<Point> {
    let (right, bottom) = (frame.right(), frame.bottom());
    vec![[frame.left, frame.top], [right, frame.top], [right, bottom], [frame.left, bottom]]
}

fn path(runs: &[Vec<Point>], fill: Option<&str>, stroke: Option<&Stroke>) -> Primitive {
    let mut d = String::new();
    for run in runs {
        for (place, [x, y]) in run.iter().enumerate() {
            let command = if place == 0 { "M" } else { "L" };
            let _ = write!(d, "{command}{} {}", tidy(*x), tidy(*y));
        }
        d.push_str(if fill.is_some() { "Z" } else { "" });
    }
    Primitive::Path(Box::new(PathData {
        d,
        fill: fill.map(Into::into),
        stroke: stroke.map_or("none", |stroke| stroke.color).into(),
        stroke_width: stroke.map_or(0.0, |stroke| stroke.width),
        opacity: None,
        stroke_dasharray: None,
    }))
}

/// A coordinate to a hundredth, no `-0`.
fn tidy(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

/// The patch under a text on paper.
pub fn patch(at: Point, text: &str, size: u32, anchor: Anchor) -> Frame {
    let width = text_width(text, size);
    let (left, size) = (at[0] - 3.0 - behind(anchor, width), f64::from(size));
    Frame { left, top: at[1] - size, width: width + 6.0, height: size + 4.0 }
}

/// The patch under an upward text on paper. No letter rises by a whole size: the patch leaves a line free that the text stands close beside.
pub fn patch_upwards(at: Point, text: &str, size: u32, anchor: Anchor) -> Frame {
    let height = text_width(text, size);
    let (top, size) = (at[1] - height - 3.0 + behind(anchor, height), f64::from(size));
    Frame { left: at[0] - size + 1.0, top, width: size + 3.0, height: height + 6.0 }
}

/// Width of the part of a text before its anchor `[px]`; `width` is that of the whole.
fn behind(anchor: Anchor, width: f64) -> f64 {
    match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * width,
        Anchor::End => width,
    }
}

/// A text cut to at most `width` `[px]`, with an ellipsis at its end if it is cut.
pub fn shortened(text: &str, size: u32, width: f64) -> String {
    let mut kept = text.to_string();
    while text_width(&kept, size) > width {
        // Before and after the sign that goes there may be an ellipsis: of the last cut, and of a name cut before.
        kept.truncate(kept.trim_end_matches('…').len());
        kept.pop();
        kept.truncate(kept.trim_end_matches('…').len());
        kept.push('…');
    }
    kept
}

/// A list of settings, `name = value, name = value`, cut to at most `width` `[px]`: names first, the longest one first, as the values tell one list
/// from another.
pub fn shortened_settings(settings: &str, size: u32, width: f64) -> String {
    let mut parts: Vec<(&str, String)> = settings
        .split(", ")
        .map(|setting| match setting.split_once(" = ") {
            Some((name, value)) => (name, format!(" = {value}")),
            None => ("", setting.into()),
        })
        .collect();
    let mut cut = vec![false; parts.len()];
    let written = |parts: &[(&str, String)], cut: &[bool]| {
        let setting = |((name, value), is_cut): (&(&str, String), &bool)| {
            format!("{name}{}{value}", if *is_cut { "…" } else { "" })
        };
        parts.iter().zip(cut).map(setting).collect::<Vec<String>>().join(", ")
    };
    loop {
        let text = written(&parts, &cut);
        let longest = (0..parts.len()).max_by_key(|part| parts[*part].0.chars().count());
        match longest.filter(|part| parts[*part].0.chars().count() > 1) {
            Some(part) if text_width(&text, size) > width => {
                let name = &mut parts[part].0;
                let end = name.char_indices().next_back().map_or(0, |(end, _)| end);
                *name = name[..end].trim_end();
                cut[part] = true;
            }
            _ => return shortened(&text, size, width),
        }
    }
}

/// Breaks a text into lines of at most `width` `[px]`. A single word may be wider.
fn broken(text: &str, size: u32, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.into()),
        }
    }
    lines
}

/// Estimated width of a text `[px]`, for the font of the PNGs, which is wider than most.
pub fn text_width(text: &str, size: u32) -> f64 {
    let em = |sign: char| match sign {
        'i' | 'l' | 'j' | '.' | ',' | ':' | ';' | '|' | '\'' | '₁' | ' ' => 0.34,
        'm' | 'w' | 'M' | 'W' | '%' | '−' => 0.92,
        'A'..='Z' => 0.7,
        _ => 0.62,
    };
    f64::from(size) * text.chars().map(em).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_cut_with_one_ellipsis() {
        let text = "θ₃, block 3 (the second drum…)";
        let whole = text_width(text, style::NOTE);
        assert_eq!(shortened(text, style::NOTE, whole), text);
        assert_eq!(shortened(text, style::NOTE, whole - 1.0), "θ₃, block 3 (the second drum…");
        assert_eq!(shortened(text, style::NOTE, whole - 20.0), "θ₃, block 3 (the second dru…");
    }

    /// Titles of panels differ in their values: of four panels each was called "Friction coeffici…".
    #[test]
    fn settings_keep_their_values_as_long_as_there_is_room() {
        let text = "Friction coefficient = 0.3, Density of block 2 = 2000, north.csv";
        let whole = text_width(text, style::LABEL);
        let cut = |share: f64| shortened_settings(text, style::LABEL, share * whole);
        assert_eq!(cut(1.0), text);
        assert_eq!(cut(0.75), "Friction c… = 0.3, Density o… = 2000, north.csv");
        assert_eq!(cut(0.4), "F… = 0.3, D… = 2000, nor…");
        assert_eq!(cut(0.5), "Fr… = 0.3, D… = 2000, north.csv");
    }

    #[test]
    fn long_entries_of_legends_stay_on_the_paper() {
        let names = (0..30).map(|place| format!("1.{place}00000")).collect::<Vec<_>>().join(", ");
        for key in [Key::Fill(style::OTHER_FILL), Key::Line(style::THIN), Key::None] {
            let mut sheet = Sheet::new("", &Paper::default());
            let entries = [(Key::None, "before".to_string()), (key, names.clone()), (Key::None, "after".to_string())];
            sheet.legend(0.0, &entries);
            let ends = sheet.drawn.iter().filter_map(|drawn| match drawn {
                Primitive::Text { x, content, size, .. } => Some(x + PROSE * text_width(content, *size)),
                _ => None,
            });
            let ends: Vec<f64> = ends.collect();
            assert!(ends.len() > 4 && ends.iter().all(|end| *end <= sheet.width - RIGHT), "{ends:?}");
        }
    }
}
