//! The digest by which a table is known to be of these inputs: its name as long as it grows, and a file beside the table of a shard.

use rocking::run_folder::Digest;
use std::path::{Path, PathBuf};

/// Digest of everything that determines the rows of a table, the version of the program included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableDigest(Digest);

impl TableDigest {
    /// The digest of this version of the program.
    pub fn new() -> TableDigest {
        let mut digest = TableDigest(Digest::default());
        digest.add(env!("CARGO_PKG_VERSION").as_bytes());
        digest
    }

    /// The digest as a number.
    pub fn number(self) -> u64 {
        self.0.number()
    }

    /// Adds bytes, and a zero byte that ends them.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.add(bytes);
        self.0.add(b"\0");
    }
}

impl std::fmt::Display for TableDigest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

/// The file beside a shard's table that holds the digest of the sweep.
pub fn digest_file(table: &Path) -> PathBuf {
    let mut name = table.file_name().unwrap_or_default().to_os_string();
    name.push(".digest");
    table.with_file_name(name)
}

/// Whether a text is that of a digest.
pub fn is_digest(text: &str) -> bool {
    !text.trim().is_empty() && text.trim().bytes().all(|byte| byte.is_ascii_hexdigit())
}
