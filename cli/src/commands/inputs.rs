//! Scene and sweep files as commands read them: regular files up to a size.

use crate::error::{Failure, at};
use crate::files::{self, LARGEST_SCENE};
use rocking::Scene;
use std::path::Path;

/// Refuses a device, a pipe, and a file that is too large. What is not there at all, the library reports.
pub fn check(path: &Path) -> Result<(), Failure> {
    if path.exists() { files::check(path, LARGEST_SCENE).map_err(at(Failure::Input, path)) } else { Ok(()) }
}

/// The text of a scene or a sweep.
pub fn text(path: &Path) -> Result<String, Failure> {
    check(path)?;
    rocking::scene_file::text(path).map_err(Failure::scene)
}

/// A scene.
pub fn scene(path: &Path) -> Result<Scene, Failure> {
    Scene::from_toml(&text(path)?, path).map_err(Failure::scene)
}
