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

/// Keys that only a sweep has.
const OF_SWEEPS: [&str; 3] = ["axes", "ask", "combine"];

/// Keys that only a study has.
const OF_STUDIES: [&str; 3] = ["levels", "measure", "records"];

impl FileKind {
    /// The kind of a text, by keys that the other kinds do not have. A text that is no TOML counts as a scene.
    ///
    /// ```
    /// use rocking::scene_file::FileKind;
    /// assert_eq!(FileKind::of("scene = \"base.toml\"\n[axes]\neta = [0.9, 1.0]\n"), FileKind::Sweep);
    /// assert_eq!(FileKind::of("scene = \"base.toml\"\nmeasure = \"pgv\"\n"), FileKind::Study);
    /// assert_eq!(FileKind::of("[column]\nblocks = 3\n"), FileKind::Scene);
    /// // A sweep whose axes are still missing.
    /// assert_eq!(FileKind::of("scene = \"base.toml\"\n"), FileKind::Sweep);
    /// ```
    pub fn of(text: &str) -> FileKind {
        Table::parse(text).map_or(FileKind::Scene, |root| FileKind::of_root(&root))
    }

    /// The command for a file that is of another kind than this one, as a remedy. `None` for a file of this kind, and where nothing tells its kind.
    pub(crate) fn remedy_for_another(self, root: &Table) -> Option<&'static str> {
        match FileKind::of_root(root) {
            found if found == self => None,
            FileKind::Sweep if self == FileKind::Study && !has_one(root, &OF_SWEEPS) => None,
            FileKind::Sweep => Some("this is a sweep file: give it to `rocking sweep`"),
            FileKind::Study => Some("this is the file of a study: give it to `rocking ida`"),
            FileKind::Scene if root.has("block") || root.has("column") => {
                Some("this is a scene: give it to `rocking run`")
            }
            FileKind::Scene => None,
        }
    }

    fn of_root(root: &Table) -> FileKind {
        if has_one(root, &OF_SWEEPS) {
            FileKind::Sweep
        } else if has_one(root, &OF_STUDIES) {
            FileKind::Study
        } else if root.has("scene") {
            // Not complete: most likely a sweep without its axes.
            FileKind::Sweep
        } else {
            FileKind::Scene
        }
    }
}

fn has_one(root: &Table, keys: &[&str]) -> bool {
    keys.iter().any(|key| root.has(key))
}
