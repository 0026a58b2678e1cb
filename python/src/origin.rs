//! Where a scene comes from.

use rocking::run_folder::SceneText;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Name of a scene that no file has.
const NO_FILE: &str = "<scene>";

/// File and text from which a scene was read: reports name the file and show the text.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Origin {
    pub file: PathBuf,
    pub text: String,
}

impl Origin {
    /// What a folder and a report say of the scene. The file is named only if it has this text: a changed scene is not that of the file.
    pub fn scene_text(&self) -> SceneText {
        let is_of_file = rocking::scene_file::text(&self.file).is_ok_and(|text| text == self.text);
        SceneText { file: if is_of_file { self.file.clone() } else { NO_FILE.into() }, text: self.text.clone() }
    }
}
