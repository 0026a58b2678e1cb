//! SVG documents as parts of a page: without prologue, and with ids that are the figure's own.

/// The document's root element with every id, and every reference to one, preceded by `name-`.
pub fn inline(name: &str, svg: &str) -> String {
    let root = svg.find("<svg").map_or(svg, |start| &svg[start..]);
    let mut text = root.trim_end().to_string();
    for reference in [" id=\"", "url(#", "href=\"#"] {
        text = text.replace(reference, &format!("{reference}{name}-"));
    }
    text
}
