//! Axes: range, ticks at round numbers, and how those numbers are written.

/// One axis of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit, with the power of ten of its numbers.
    pub label: String,
    /// Values at both ends of the axis, the smaller first.
    pub range: [f64; 2],
    /// Distance between ticks: 1, 2 or 5 times a power of ten.
    pub step: f64,
    /// Power of ten that the numbers are multiples of: zero unless they would be long.
    pub power: i32,
    /// Whether the ticks have numbers. Of panels above one another that share this axis, only the lowest one has numbers.
    pub numbers: bool,
}

/// Margin beyond the values, as a share of their range.
const ROOM: f64 = 0.06;

/// Half the range of an axis around values that are all zero; the whole range of an empty axis. Numbers at its ticks are short.
const STILL: f64 = 0.1;

/// Values up to this are drawn as zeros, in the unit of the axis: angles over slenderness, forces over weights, J and cm that small are rounding.
const ROUNDING: f64 = 1e-12;

/// Smallest reach of an axis from its middle, as a share of the middle: with less, numbers at ticks have more digits than there is room for.
const LEAST_REACH: f64 = 1e-4;

/// A range not above this counts as empty: the step between its ticks would leave the range of doubles.
const SHORTEST: f64 = 1e-290;

impl Axis {
    /// Axis from `range[0]` to `range[1]` with at least `ticks` ticks. A range that is empty or not finite is one of `STILL`: no step divides it.
    pub fn over(label: &str, range: [f64; 2], ticks: usize) -> Axis {
        let length = range[1] - range[0];
        let low = if range[0].is_finite() { range[0] } else { 0.0 };
        let range = if length > SHORTEST && length.is_finite() { range } else { [low, low + STILL] };
        let (step, largest) = (step(range, ticks), range[0].abs().max(range[1].abs()));
        let power = if is_plain(largest, step) { 0 } else { largest.log10().floor() as i32 };
        Axis { label: in_powers(label, power), range, step, power, numbers: true }
    }

    /// Axis over all finite `values`, with a margin at both ends. Around zero if all values are zero but for rounding, or there are none.
    pub fn around(label: &str, values: impl IntoIterator<Item = f64>, ticks: usize) -> Axis {
        let [low, high] = span(values);
        let middle = 0.5 * (low + high);
        let is_zero = low.abs().max(high.abs()) <= ROUNDING;
        let reach = (0.5 * (high - low) * (1.0 + 2.0 * ROOM)).max(LEAST_REACH * middle.abs());
        let reach = if is_zero { STILL } else { reach };
        Axis::over(label, [middle - reach, middle + reach], ticks)
    }

    /// The axis without numbers.
    pub fn unnumbered(&self) -> Axis {
        Axis { numbers: false, ..self.clone() }
    }

    /// The number at a tick.
    pub fn number(&self, value: f64) -> String {
        let unit = 10f64.powi(self.power);
        number(value / unit, self.step / unit)
    }

    /// Position of a value along the axis, from 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.range[0]) / (self.range[1] - self.range[0])
    }
}

/// The smallest and the largest of finite values; zeros where there are none.
pub fn span(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let values = values.into_iter().filter(|value| value.is_finite());
    values.map(|value| [value, value]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).unwrap_or_default()
}

/// Step between ticks: the largest value of 1, 2 or 5 times a power of ten with at least `ticks` multiples in the range.
fn step(range: [f64; 2], ticks: usize) -> f64 {
    let power = (range[1] - range[0]).log10().ceil() as i32;
    // Rounding must not lose the tick at an end.
    let inside = |step: f64| (range[1] / step + 1e-9).floor() - (range[0] / step - 1e-9).ceil() + 1.0;
    let steps = (0..).flat_map(|lower| [5.0, 2.0, 1.0].map(|digit| digit * 10f64.powi(power - lower)));
    steps.into_iter().find(|step| inside(*step) >= ticks as f64).expect("steps grow smaller")
}

/// Smallest step whose numbers are all written without a power of ten. From `100 / SMALL` on, numbers have a power of ten again.
const SMALL: f64 = 1e-4;

/// Smallest number that is written without a power of ten whatever its step.
const PLAIN: f64 = 1e-3;

/// The number at a tick: as many decimals as the step has, a true minus, no `-0`; small and large numbers as a multiple of their own power of ten.
pub fn number(value: f64, step: f64) -> String {
    // Numbers of a damaged folder may be at the ends of the range of doubles.
    let step = step.max(f64::MIN_POSITIVE);
    if !value.is_finite() {
        return value.to_string();
    }
    // Rounding beside a tick at zero is smaller than the step by far.
    if value.abs() < 1e-6 * step {
        return "0".into();
    }
    let power = step.log10().floor() as i32;
    let text = if is_plain(value, step) {
        format!("{:.*}", usize::try_from(-power).unwrap_or(0), value.abs())
    } else {
        scientific(value.abs(), usize::try_from(value.abs().log10().floor() as i32 - power).unwrap_or(0))
    };
    format!("{}{text}", if value < 0.0 { "−" } else { "" })
}

/// A number above zero with a power of ten, and up to so many digits behind the point: `1.46×10⁶`.
fn scientific(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$e}");
    let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
    format!("{digits}×10{}", superscript(power))
}

/// Whether a number is written without a power of ten.
fn is_plain(value: f64, step: f64) -> bool {
    (SMALL..100.0 / SMALL).contains(&step) || step < SMALL && value.abs() >= PLAIN
}

/// A label whose unit is so many times as large.
fn in_powers(label: &str, power: i32) -> String {
    let factor = format!("10{}", superscript(&power.to_string()));
    match label.strip_suffix(']').and_then(|label| label.rsplit_once('[')) {
        _ if power == 0 => label.into(),
        Some((name, unit)) => format!("{name}[{factor} {unit}]"),
        None => format!("{label} [{factor}]"),
    }
}

fn superscript(power: &str) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |sign: char| sign.to_digit(10).map_or('⁻', |digit| digits[digit as usize]);
    power.chars().map(raised).collect()
}

/// A whole number below the line, as in θ₁.
pub fn subscript(number: usize) -> String {
    let lowered = |sign: char| sign.to_digit(10).and_then(|digit| char::from_u32(0x2080 + digit)).unwrap_or(sign);
    number.to_string().chars().map(lowered).collect()
}

/// A number in a text, with a true minus: three significant digits without trailing decimal zeros, and from 1e-3 to 1e5 all digits before the
/// point.
pub fn brief(value: f64) -> String {
    let size = value.abs();
    if !value.is_finite() {
        return value.to_string();
    }
    let text = if size < f64::MIN_POSITIVE {
        "0".into()
    } else if (1e-3..1e5).contains(&size) {
        let decimals = (2 - size.log10().floor() as i32).clamp(0, 5) as usize;
        let text = format!("{size:.decimals$}");
        if decimals > 0 { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
    } else {
        scientific(size, 2)
    };
    format!("{}{text}", if value < 0.0 { "−" } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A friction coefficient of zero and a run without friction demand once made an axis whose step was sought for ever.
    #[test]
    fn an_empty_range_is_widened() {
        let axis = Axis::over("", [0.0, 0.0], 4);
        assert_eq!((axis.range, axis.step), ([0.0, STILL], 0.02));
        assert_eq!(Axis::over("", [0.0, 5e-324], 4), axis);
        assert_eq!(Axis::over("", [0.0, f64::INFINITY], 4), axis);
        assert_eq!(Axis::over("", [f64::NEG_INFINITY, f64::NAN], 4), axis);
    }

    #[test]
    fn ticks_are_at_round_numbers() {
        let cases = [([0.0, 10.0], 6, 2.0), ([0.0, 25.0], 6, 5.0), ([-0.19, 0.19], 3, 0.1), ([0.0, 0.3], 4, 0.1)];
        for (range, ticks, expected) in cases {
            assert!((step(range, ticks) / expected - 1.0).abs() < 1e-12, "{range:?} {}", step(range, ticks));
        }
    }

    #[test]
    fn numbers_have_the_decimals_of_their_step_and_a_true_minus() {
        let cases = [(-0.5, 0.5), (-1e-17, 0.1), (1.0, 0.2), (0.05, 0.05), (250.0, 50.0), (-2e-6, 1e-6)];
        let texts = cases.map(|(value, step)| number(value, step));
        assert_eq!(texts, ["−0.5", "0", "1.0", "0.05", "250", "−2×10⁻⁶"]);
        assert_eq!(
            [0.7841977, -0.25, 12.0, 0.0, 58.42, 1e-6, 1.458e6, -1.548e-5].map(brief),
            ["0.784", "−0.25", "12", "0", "58.4", "1×10⁻⁶", "1.46×10⁶", "−1.55×10⁻⁵"]
        );
        // The value decides on the power of ten, not the step.
        assert_eq!([5e-324, f64::INFINITY, 1e308].map(brief), ["0", "inf", "1×10³⁰⁸"]);
        let cases = [(0.90001, 5e-6), (1e-4, 2e-5), (-1.2e-4, 2e-5), (8e-5, 2e-5), (3e6, 1e6), (0.0, 1e6)];
        let texts = cases.map(|(value, step)| number(value, step));
        assert_eq!(texts, ["0.900010", "1×10⁻⁴", "−1.2×10⁻⁴", "8×10⁻⁵", "3×10⁶", "0"]);
    }

    /// Numbers as long as −1.2×10⁻⁴ once lay on the label of their axis.
    #[test]
    fn small_and_large_axes_have_their_power_of_ten_in_the_label() {
        let told = |label: &str, range: [f64; 2]| {
            let axis = Axis::over(label, range, 4);
            (axis.label.clone(), axis.number(range[0]), axis.number(3.0 * axis.step))
        };
        let expected =
            |label: &str, first: &str, third: &str| (label.to_string(), first.to_string(), third.to_string());
        assert_eq!(told("Angles θᵢ/αᵢ", [-1.2e-4, 0.0]), expected("Angles θᵢ/αᵢ [10⁻⁴]", "−1.2", "0.6"));
        assert_eq!(told("Time [s]", [0.0, 1e-6]), expected("Time [10⁻⁶ s]", "0", "0.6"));
        assert_eq!(told("Arc [m]", [0.0, 8e6]), expected("Arc [10⁶ m]", "0", "6"));
        assert_eq!(told("Slide [mm]", [0.0, 0.3]), expected("Slide [mm]", "0", "0.3"));
    }

    #[test]
    fn an_axis_without_values_has_a_range() {
        for values in [&[][..], &[0.0, 0.0], &[-7e-17, 7e-17]] {
            let axis = Axis::around("", values.iter().copied(), 3);
            assert!((axis.range[1] - 0.1).abs() < 1e-9 && (axis.share(0.0) - 0.5).abs() < 1e-9);
        }
    }
}
