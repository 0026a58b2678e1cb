//! `rocking check`: the content of a scene, a sweep or a study, and its consequences before anything is run.

mod scene;
mod study;
mod sweep;

use crate::commands::inputs;
use crate::error::Failure;
use rocking::scene_file::FileKind;
use std::path::Path;

/// Reads a scene, a sweep or a study and explains it.
pub fn check(path: &Path, as_json: bool) -> Result<(), Failure> {
    let text = inputs::text(path)?;
    match FileKind::of(&text) {
        FileKind::Sweep => sweep::check(path, as_json),
        FileKind::Study => study::check(path, as_json),
        FileKind::Scene => scene::check(path, &text, as_json),
    }
}
