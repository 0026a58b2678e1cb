//! What is in a figure: its texts and its paths.

use roxmltree::Document;

/// The texts of a figure in the order of the document.
pub fn words(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).expect("XML");
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts
        .map(|node| node.descendants().filter(|part| part.is_text()).filter_map(|part| part.text()).collect())
        .collect()
}

/// The parts of a path: where each begins and the corners that follow.
pub fn parts(path: &str) -> Vec<Vec<[f64; 2]>> {
    let point = |text: &str| {
        let numbers: Vec<f64> = text.split_whitespace().map(|number| number.parse().expect("a number")).collect();
        [numbers[0], numbers[1]]
    };
    let parts = path.split('M').filter(|part| !part.is_empty());
    parts.map(|part| part.trim_end_matches('Z').split('L').map(point).collect()).collect()
}
