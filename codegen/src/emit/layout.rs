//! Comments and lines of the emitted text.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::HashSet;

/// Longest line of a comment, in characters without its indentation. Indentation adds up to 16 characters.
const COMMENT_WIDTH: usize = 104;

/// Marks a doc attribute that is printed as an ordinary comment (`//`), because `quote` drops ordinary comments.
const ORDINARY: &str = "~";

/// `/// …`, a line for each line of the text, long lines wrapped.
pub fn doc(text: &str) -> TokenStream {
    attributes(text, "")
}

/// `// …` before a statement.
pub fn remark(text: &str) -> TokenStream {
    attributes(text, ORDINARY)
}

fn attributes(text: &str, mark: &str) -> TokenStream {
    let lines = text.lines().flat_map(wrapped).map(|line| format!("{mark} {line}").trim_end().to_string());
    quote! { #(#[doc = #lines])* }
}

/// Text that stands before the first item, as comments.
pub fn heading(text: &str) -> String {
    text.lines().flat_map(wrapped).map(|line| format!("// {line}").trim_end().to_string() + "\n").collect()
}

/// Lines of at most [`COMMENT_WIDTH`] characters, broken at spaces; continuations of list items and formulas are indented.
fn wrapped(line: &str) -> Vec<String> {
    let indent = if line.starts_with(['-', '[']) { "  " } else { "" };
    let mut lines = vec![String::new()];
    for word in line.split_whitespace() {
        let is_blank = lines.last().is_none_or(|last| last.trim().is_empty());
        let length = lines.last().map_or(0, |last| last.chars().count()) + 1 + word.chars().count();
        if !is_blank && length > COMMENT_WIDTH {
            lines.push(format!("{indent}{word}"));
        } else if let Some(last) = lines.last_mut() {
            last.push_str(if is_blank { "" } else { " " });
            last.push_str(word);
        }
    }
    lines
}

/// Items as text.
pub fn format(tokens: TokenStream) -> String {
    let file = syn::parse2(tokens).expect("the emitted tokens are a Rust file: emission builds items only");
    let text = prettyplease::unparse(&file).replace(&format!("///{ORDINARY}"), "//");
    text.lines()
        .map(|line| if line == "}" || line == "};" { format!("{line}\n\n") } else { format!("{line}\n") })
        .collect()
}

/// A count or an index, without the type suffix `usize` that `quote` would add.
pub fn count(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// `let [cos_1, _, cos_3] = value;`. Names that the body does not read become `_`; nothing where it reads none of them.
pub fn unpack(names: &[String], value: &TokenStream, read: &HashSet<&str>) -> TokenStream {
    let is_read = |name: &String| read.contains(name.as_str());
    if !names.iter().any(is_read) {
        return TokenStream::new();
    }
    let names = names.iter().map(|name| format_ident!("{}", if is_read(name) { name } else { "_" }));
    quote! { let [#(#names),*] = #value; }
}

/// The words of emitted text: names, keywords and numbers.
pub fn words_of(text: &str) -> HashSet<&str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').collect()
}
