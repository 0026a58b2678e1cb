//! `rocking check`: the content of a scene, a sweep or a study, and its consequences before anything is run.

mod contacts;
mod scene;
mod study;
mod sweep;

use crate::commands::inputs;
use crate::error::Failure;
use rocking::scene_file::FileKind;
use std::path::Path;

/// Prints what a scene, a sweep or a study says, and what follows from it.
pub fn check(path: &Path, as_json: bool) -> Result<(), Failure> {
    let text = inputs::text(path)?;
    let kind = FileKind::of(&text);
    if path == Path::new("-") && kind != FileKind::Scene {
        let problem =
            "standard input takes scenes only, as a sweep or a study names other files; give the name of its file";
        return Err(Failure::Input(path.into(), problem.into()));
    }
    match kind {
        FileKind::Sweep => sweep::check(path, as_json),
        FileKind::Study => study::check(path, as_json),
        FileKind::Scene => scene::check(path, &text, as_json),
    }
}
