//! What a TOML file describes.

use super::table::Table;

/// What a TOML file describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A scene: `rocking run`.
    Scene,
    /// A sweep over a base scene: `rocking sweep`.
    Sweep,
    /// An incremental dynamic analysis: `rocking ida`.
    Study,
}

impl FileKind {
    /// The kind of a text, by keys that the other kinds do not have. A text that is no TOML counts as a scene.
    ///
    /// ```
    /// use rocking::scene_file::FileKind;
    /// assert_eq!(FileKind::of("scene = \"base.toml\"\n[axes]\neta = [0.9, 1.0]\n"), FileKind::Sweep);
    /// assert_eq!(FileKind::of("scene = \"base.toml\"\nmeasure = \"pgv\"\n"), FileKind::Study);
    /// assert_eq!(FileKind::of("[column]\nblocks = 3\n"), FileKind::Scene);
    /// ```
    pub fn of(text: &str) -> FileKind {
        Table::parse(text).map_or(FileKind::Scene, |root| FileKind::of_root(&root))
    }

    /// The command for a file that is of another kind than this one, as a remedy. `None` for a file of this kind, and where nothing tells its kind.
    pub(crate) fn remedy_for_another(self, root: &Table) -> Option<&'static str> {
        match FileKind::of_root(root) {
            found if found == self => None,
            FileKind::Sweep => Some("this is a sweep file: give it to `rocking sweep`"),
            FileKind::Study => Some("this is the file of a study: give it to `rocking ida`"),
            FileKind::Scene if root.has("block") || root.has("column") => {
                Some("this is a scene: give it to `rocking run`")
            }
            FileKind::Scene => None,
        }
    }

    fn of_root(root: &Table) -> FileKind {
        let has_one = |keys: &[&str]| keys.iter().any(|key| root.has(key));
        if has_one(&["axes", "ask", "combine"]) {
            FileKind::Sweep
        } else if has_one(&["levels", "measure", "records"]) {
            FileKind::Study
        } else {
            FileKind::Scene
        }
    }
}
