//! A run as one HTML file that needs nothing else: outcome, validity, animation, figures, inputs, provenance.
//!
//! The page is the template `page.html` with its places filled: texts from the modules below, `page.css`, the files of `player/`, and
//! the frames of the run as JSON for the player. The same folder gives the same bytes: the page has no time of day and no path of the
//! folder. All that the page says of a run stands in [`Results`]; no motion is computed here.

mod outcome;
mod trust;
mod validity;

mod inputs;
mod provenance;

mod frames;

mod html;
mod number;

use crate::plot;
use crate::text::escape;
use rocking::run_folder::Results;

/// The page of a run.
pub fn page(results: &Results) -> String {
    let figures = plot::figures(results, &plot::Paper::default());
    // A scene without a title has the name of its file.
    let file = results.scene.file.file_name().map(|name| name.to_string_lossy());
    let title = if results.title.is_empty() { file.as_deref().unwrap_or("A run of rocking") } else { &results.title };
    let parts = [
        ("title", escape(title)),
        ("version", escape(&results.version)),
        ("file", escape(&results.scene.file.display().to_string())),
        ("outcome", outcome::sentence(results)),
        ("verdict", validity::verdict(results)),
        ("tiles", outcome::tiles(results)),
        ("peaks", outcome::peaks(results)),
        ("impacts", outcome::impacts(results)),
        ("modes", outcome::modes(results)),
        ("validity", validity::details(results)),
        ("readout", readout(results)),
        ("player-notes", frames::notes(results)),
        ("figures", figures.iter().map(|each| embedded(each.name, &each.caption, &each.svg)).collect()),
        ("inputs", inputs::inputs(results)),
        ("provenance", provenance::provenance(results)),
        ("css", include_str!("page.css").into()),
        ("run", frames::json(results)),
        ("js", PLAYER.join("\n")),
    ];
    html::fill(include_str!("page.html"), &parts)
}

/// Files of the player, in their order. Together they are one JavaScript module of the page.
const PLAYER: [&str; 4] = [
    include_str!("player/state.js"),
    include_str!("player/stage.js"),
    include_str!("player/strip.js"),
    include_str!("player/controls.js"),
];

/// Fields in which the player writes each block's angle, top block first.
fn readout(results: &Results) -> String {
    let row = |block: usize| {
        let name = escape(&results.block_name(block - 1));
        format!(
            "<li><svg class=\"swatch\" viewBox=\"0 0 22 10\" aria-hidden=\"true\"><path d=\"M1 5H21\"/></svg>\
             <span>block {name}</span> <output data-block=\"{block}\"></output></li>\n"
        )
    };
    (1..=results.column.len()).rev().map(row).collect()
}

/// A figure of the page with its caption.
fn embedded(name: &str, caption: &str, svg: &str) -> String {
    let caption = escape(caption);
    format!(
        "<figure id=\"figure-{name}\">\n<div class=\"paper\" tabindex=\"0\" role=\"group\" aria-label=\"{caption}\">{svg}</div>\n\
         <figcaption>{caption}</figcaption>\n</figure>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_embedded_with_their_captions() {
        let text = embedded("one", "a < b", "<svg></svg>");
        assert!(text.starts_with("<figure id=\"figure-one\">") && text.ends_with("</figure>\n"), "{text}");
        assert!(
            text.contains("<figcaption>a &lt; b</figcaption>") && text.contains("aria-label=\"a &lt; b\""),
            "{text}"
        );
    }
}
