//! Scenes and sweeps as commands read them: from a file, or from standard input.

use crate::error::{Failure, at};
use rocking::Scene;
use rocking::ground::LARGEST_FILE;
use std::io::Read as _;
use std::path::Path;

/// Path that stands for standard input.
const STANDARD_INPUT: &str = "-";

/// The text of a scene or a sweep; of standard input where the path is `-`.
pub fn text(path: &Path) -> Result<String, Failure> {
    if path == Path::new(STANDARD_INPUT) {
        return standard_input().map_err(at(Failure::Input, path));
    }
    rocking::scene_file::text(path).map_err(Failure::scene)
}

/// The text of standard input, up to the size of a scene.
fn standard_input() -> std::io::Result<String> {
    let refused = |problem: &str| Err(std::io::Error::new(std::io::ErrorKind::InvalidInput, problem));
    let mut bytes = Vec::new();
    std::io::stdin().take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return refused("standard input has more than 64 MiB, which no scene has");
    }
    String::from_utf8(bytes).or_else(|_| refused("standard input is not UTF-8 text"))
}

/// A scene.
pub fn scene(path: &Path) -> Result<Scene, Failure> {
    Scene::from_toml(&text(path)?, path).map_err(Failure::scene)
}
