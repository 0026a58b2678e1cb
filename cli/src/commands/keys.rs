//! `rocking keys`: the reference of all keys of scenes, sweeps and studies, and their JSON schema.

use crate::error::Failure;
use crate::keys::{Kind, list};
use crate::terminal::{json, print};
use std::fmt::Write as _;

/// Prints the keys of a kind of file, or of all; or the schema of one.
pub fn keys(kind: Option<Kind>, schema: bool) -> Result<(), Failure> {
    if schema {
        return json(&kind.unwrap_or(Kind::Scene).schema());
    }
    let mut text = String::new();
    for own in kind.map_or(Kind::ALL.to_vec(), |kind| vec![kind]) {
        let what = match own {
            Kind::Scene => "Scene files (rocking run)",
            Kind::Sweep => "Sweep files (rocking sweep)",
            Kind::Study => "Study files (rocking ida)",
        };
        let separator = if text.is_empty() { "" } else { "\n" };
        let _ = write!(text, "{separator}{what}\n{}\n\n{}", "=".repeat(what.len()), list(own));
    }
    print(&text)
}
