//! How far the run can be trusted, in the sentence of the outcome and a paragraph below it.

use crate::text::escape;
use rocking::run_folder::Results;
use rocking::trust::Trust;
use std::fmt::Write as _;

/// Whether companions show that the verdict is not determined.
fn is_open(results: &Results) -> bool {
    results.trust.as_ref().is_some_and(Trust::is_open)
}

/// Class and words of the outcome. If the verdict is not determined, the words say so, beside the outcome of this run.
pub fn qualified(results: &Results, class: &'static str, words: String) -> (&'static str, String) {
    if !is_open(results) {
        return (class, words);
    }
    let plain = words.replace("<strong>", "").replace("</strong>", "").replacen("The column", "the column", 1);
    let likely = if results.trust.as_ref().is_some_and(|trust| trust.likely) { ", but likely" } else { "" };
    ("undetermined", format!("The verdict is <strong>not determined</strong>{likely}. In this run {plain}"))
}

/// A paragraph on what the companions say, or that there are none.
pub fn paragraph(results: &Results) -> String {
    let Some(trust) = &results.trust else {
        return "<p>Trust: whether slightly different inputs give another verdict was not examined (<code>rocking run --trust</code>).</p>\n".into();
    };
    let mut text = format!("<p>Trust: {}.", escape(&trust.sentence()));
    if is_open(results) && !trust.reaches_the_end() {
        let _ = write!(
            text,
            " Companions are the same scene at a tighter tolerance, and with excitation and sizes (and coefficients of friction) changed by 1e-9 and 1e-6, which \
             is less than anybody can know. Once they part, each moves in its own way, and the scene does not decide which of these motions it is."
        );
    }
    text.push_str("</p>\n");
    text
}
