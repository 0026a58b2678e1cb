//! Parts of a page: JSON in a script, lists, and a template's places filled in one pass.

/// JSON as the content of a script element, which ends at `</` and nowhere else.
pub fn script(json: &str) -> String {
    // Within JSON these signs stand in strings only.
    json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

/// The template with `{{name}}` replaced by the part of that name. Inserted parts are not searched for further places: a scene may
/// contain `{{css}}`.
///
/// # Panics
/// If the template names a part that is missing, or does not close a place.
pub fn fill(template: &str, parts: &[(&str, String)]) -> String {
    let mut pieces = template.split("{{");
    let mut text = pieces.next().unwrap_or_default().to_string();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").expect("places of the template are closed");
        let part = parts.iter().find(|(part, _)| *part == name).expect("parts of the template are there");
        text.push_str(&part.1);
        text.push_str(rest);
    }
    text
}

/// A list of names and values; values are HTML.
pub fn definitions(rows: &[(&str, String)]) -> String {
    let rows = rows.iter().map(|(name, value)| format!("<div><dt>{name}</dt><dd>{value}</dd></div>\n"));
    format!("<dl>\n{}</dl>\n", rows.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_script_ends_within_its_json() {
        assert_eq!(script("[\"</script>\"]"), "[\"\\u003c/script>\"]");
    }

    #[test]
    fn a_part_is_not_searched_for_places() {
        assert_eq!(fill("<{{a}}|{{b}}>", &[("b", "x".into()), ("a", "{{b}}".into())]), "<{{b}}|x>");
    }
}
