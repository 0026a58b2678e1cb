//! Numbers of a page: those of [`crate::number`], with a minus as wide as the plus.

/// As [`crate::number::significant`].
pub fn significant(value: f64, digits: usize) -> String {
    typeset(crate::number::significant(value, digits))
}

/// As [`crate::number::fixed`].
pub fn fixed(value: f64, digits: usize) -> String {
    typeset(crate::number::fixed(value, digits))
}

/// As [`crate::number::percent`].
pub fn percent(share: f64) -> String {
    typeset(crate::number::percent(share))
}

/// As [`crate::number::degrees`].
pub fn degrees(angle: f64) -> String {
    typeset(crate::number::degrees(angle))
}

/// The sign of a number; an exponent stays as programs read it.
fn typeset(number: String) -> String {
    match number.strip_prefix('-') {
        Some(digits) => format!("\u{2212}{digits}"),
        None => number,
    }
}

/// A text with such a minus before its numbers.
pub fn with_minus(text: &str) -> String {
    let mut parts = text.split(" -");
    let mut typeset = String::from(parts.next().unwrap_or_default());
    for part in parts {
        typeset.push_str(if part.starts_with(|sign: char| sign.is_ascii_digit()) { " \u{2212}" } else { " -" });
        typeset.push_str(part);
    }
    typeset
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_true_minus_and_exponents_and_options_do_not() {
        assert_eq!([significant(-1.5e-9, 2), fixed(-0.25, 2), percent(-0.02)], ["−1.5e-9", "−0.25", "−2 %"]);
        assert_eq!(with_minus("falls to -0.4 N - see --trust"), "falls to −0.4 N - see --trust");
    }
}
