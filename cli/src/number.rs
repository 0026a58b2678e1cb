//! Numbers for readers: significant digits, no trailing zeros.

/// The number with `digits` significant digits; with a power of ten (`1e9`) if the rounded magnitude is below 1e-4 or at least 1e7. `inf` and `NaN`
/// as they are.
pub fn significant(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits - 1);
    let exponent = rounded.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        _ if value == 0.0 => "0".into(),
        _ if !value.is_finite() => value.to_string(),
        Some(exponent @ -4..=6) => {
            // The rounded value is read back: 1234.5 with three digits is 1230.
            let value: f64 = rounded.parse().unwrap_or(value);
            trimmed(&format!("{value:.*}", (digits as i32 - 1 - exponent).max(0) as usize))
        }
        _ => {
            let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
            format!("{}e{exponent}", trimmed(mantissa))
        }
    }
}

/// A number with up to `digits` decimals, without trailing zeros; never `-0`.
pub fn fixed(value: f64, digits: usize) -> String {
    let text = trimmed(&format!("{value:.digits$}"));
    if text == "-0" { "0".into() } else { text }
}

/// Lists of numbers with their names and units, those of zeros left out; `None` if all are zero.
pub fn state(lists: &[(&str, &[f64], &str)]) -> Option<String> {
    let numbers = |list: &[f64]| list.iter().map(|value| significant(*value, 5)).collect::<Vec<_>>().join(", ");
    let moved = lists.iter().filter(|(_, list, _)| list.iter().any(|value| *value != 0.0));
    let parts: Vec<String> = moved.map(|(name, list, unit)| format!("{name} = {} {unit}", numbers(list))).collect();
    (!parts.is_empty()).then(|| format!("{}, base first", parts.join("; ")))
}

/// A share of one in percent. At most one decimal below 9.95 % in magnitude and between 99 and 100 %, otherwise none.
/// A share just above zero is `< 0.1 %`, a share just below one is `> 99.9 %`.
pub fn percent(share: f64) -> String {
    match share * 100.0 {
        percent if percent > 0.0 && percent < 0.1 => "< 0.1 %".into(),
        percent if percent > 99.9 && percent < 100.0 => "> 99.9 %".into(),
        percent if percent.abs() < 9.95 || (percent > 99.0 && percent < 100.0) => format!("{} %", fixed(percent, 1)),
        percent => format!("{percent:.0} %"),
    }
}

/// The text of an angle `[rad]` in degrees.
pub fn degrees(angle: f64) -> String {
    format!("{}°", significant(angle.to_degrees(), 3))
}

/// A count with its noun, given in singular and plural.
pub fn counted(count: usize, [one, many]: [&str; 2]) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn trimmed(text: &str) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text.into() }
}

/// Width of a block in m with `digits` significant digits; widths of base and top if these differ.
pub fn widths(block: &rocking::Block, digits: usize) -> String {
    let [bottom, top] = [block.bottom_half_width, block.top_half_width].map(|half| significant(2.0 * half, digits));
    if bottom == top { bottom } else { format!("{bottom} to {top}") }
}

/// Coefficients of friction in words.
pub fn coefficients(friction: &rocking::Friction) -> String {
    let list = |values: &[f64]| values.iter().map(|value| significant(*value, 4)).collect::<Vec<_>>().join(", ");
    let order = if friction.fixed.len().max(friction.kinetic.len()) > 1 { ", base first" } else { "" };
    match friction.fixed == friction.kinetic {
        true => format!("{}{order}", list(&friction.fixed)),
        false => format!("static {}, kinetic {}{order}", list(&friction.fixed), list(&friction.kinetic)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_asked_for() {
        let texts = [0.1, 1.0 / 3.0, 1e-300, -0.0, -std::f64::consts::PI, 9.996, 1234.5, 123456.0, 1e9, 0.00012345]
            .map(|value| significant(value, 3));
        assert_eq!(texts, ["0.1", "0.333", "1e-300", "0", "-3.14", "10", "1230", "123000", "1e9", "0.000123"]);
        assert_eq!([0.1, -1e-12, 1.0 / 3.0, 2.0].map(|value| fixed(value, 10)), ["0.1", "0", "0.3333333333", "2"]);
        let texts = [0.0, 4e-5, 0.004, -0.0213, 0.0997, 0.95, 0.996, 0.9999, 1.0, 1.234].map(percent);
        let expected = ["0 %", "< 0.1 %", "0.4 %", "-2.1 %", "10 %", "95 %", "99.6 %", "> 99.9 %", "100 %", "123 %"];
        assert_eq!(texts, expected);
    }
}
