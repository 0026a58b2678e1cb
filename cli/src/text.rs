//! Text from users (titles, file names, cells) on its way to a terminal, a table or a page.

use std::borrow::Cow;
use std::path::Path;

/// The text on one line and without control characters: line breaks become spaces, other control characters and those that
/// reverse the direction of writing become escapes such as `\u{1b}`. Tabs stay.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unsafe) {
        return text.into();
    }
    let mut printed = String::with_capacity(text.len() + 8);
    for sign in text.chars() {
        match sign {
            '\n' | '\r' => printed.push(' '),
            _ if is_unsafe(sign) => printed.extend(sign.escape_unicode()),
            _ => printed.push(sign),
        }
    }
    printed.into()
}

/// Control characters except tabs, characters that reverse the direction of writing, and those that XML does not have.
pub fn is_unsafe(sign: char) -> bool {
    let reverses = matches!(sign, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    sign.is_control() && sign != '\t' || reverses || matches!(sign, '\u{fffe}' | '\u{ffff}')
}

/// [`printable`] for each line of a text.
pub fn printable_lines(text: &str) -> String {
    text.split('\n').map(|line| printable(line.strip_suffix('\r').unwrap_or(line))).collect::<Vec<_>>().join("\n")
}

/// A path as it is shown.
pub fn shown(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

/// A word for the command line of a shell, in quotes if it needs them.
pub fn shell_word(word: &str) -> String {
    let plain = |sign: char| sign.is_alphanumeric() || "-_./+:=@%,".contains(sign);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// The text as HTML or XML: fit for an element and for a quoted attribute.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for sign in printable_lines(text).chars() {
        match sign {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            _ => escaped.push(sign),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_sign_of_markup_and_no_control_character_survives() {
        assert_eq!(escape("<a b='1' c=\"2\">&\u{1b}"), "&lt;a b=&#39;1&#39; c=&quot;2&quot;&gt;&amp;\\u{1b}");
        assert_eq!(printable("a\r\nb\t\u{9b}\u{202e}θ"), "a  b\t\\u{9b}\\u{202e}θ");
        assert_eq!(printable_lines("a\u{7}\r\nb\n"), "a\\u{7}\nb\n");
    }

    #[test]
    fn file_names_stay_one_word() {
        let words = ["a/b-1.toml", "my scene.toml", "it's"].map(shell_word);
        assert_eq!(words, ["a/b-1.toml", "'my scene.toml'", "'it'\\''s'"]);
    }
}
