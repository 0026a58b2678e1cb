//! Standard output and standard error; what is written there has no control characters of users' text.

use crate::error::Failure;
use crate::text::{is_unsafe, printable, printable_lines};
use rocking::json::Explicit;
use serde::Serialize;
use std::io::Write as _;

/// Prints text. A reader that has seen enough and closes the pipe is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(printable_lines(text).as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::StandardOutput(error.to_string())),
        _ => Ok(()),
    }
}

/// Prints a value as JSON, for scripts.
pub fn json(value: &impl Serialize) -> Result<(), Failure> {
    let text =
        serde_json::to_string_pretty(&Explicit(value)).map_err(|error| Failure::StandardOutput(error.to_string()))?;
    json_text(&text)
}

/// Prints JSON. Characters that a terminal could obey are printed as escapes of JSON, which read back as the same text.
pub fn json_text(text: &str) -> Result<(), Failure> {
    let escape =
        |sign: char| if is_unsafe(sign) && sign != '\n' { format!("\\u{:04x}", sign as u32) } else { sign.into() };
    print(&(text.chars().map(escape).collect::<String>() + "\n"))
}

/// Writes a line to standard error. Where it cannot be written, nobody can be told, and the command goes on.
pub fn complain(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Prints each warning as a line on standard error.
pub fn warn(warnings: &[String]) {
    for warning in warnings {
        complain(&format!("warning: {}", printable(warning)));
    }
}

/// Largest number of warnings that [`warn_of_some`] prints.
const MOST_WARNINGS: usize = 10;

/// Prints the first warnings of many as lines on standard error, and how many others there are.
pub fn warn_of_some(warnings: &[String]) {
    let (first, others) = warnings.split_at(warnings.len().min(MOST_WARNINGS));
    warn(first);
    if !others.is_empty() {
        complain(&format!("warning: and {} more", others.len()));
    }
}
