//! Where a scene comes from.

use rocking::run_folder::SceneText;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// File and text from which a scene was read: reports name the file and show the text.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Origin {
    pub file: PathBuf,
    pub text: String,
}

impl Origin {
    pub fn scene_text(&self) -> SceneText {
        SceneText { file: self.file.clone(), text: self.text.clone() }
    }
}
