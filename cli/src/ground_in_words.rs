//! Ground motion in words, from its description as the library serialises it (in `summary.json`).
//!
//! Amplitude and frequency, which most motions have, are put into words; every other number of a description is listed under its own name. A new kind
//! of motion is called by its name in scene files, unless it has another one here.

use crate::number::significant;
use serde_json::{Map, Value};
use std::f64::consts::TAU;

/// One component of the ground motion in words. `peak` is the largest acceleration in the run `[m/s²]`.
/// It is stated if it is above zero and the description has neither amplitude nor peak.
pub fn words(motion: &Value, gravity: f64, peak: f64) -> String {
    let Value::Object(description) = motion else {
        return "none".into();
    };
    let kind = description.get("kind").and_then(Value::as_str).unwrap_or("motion");
    let name = match kind {
        "sine-pulse" => "one-sine pulse".into(),
        "cosine-pulse" => "one-cosine pulse".into(),
        "half-sine" => "half-sine pulse".into(),
        "type-c" => "type C pulse".into(),
        "ricker" => "Ricker wavelet".into(),
        "antisymmetric-ricker" => "antisymmetric Ricker wavelet".into(),
        "mavroeidis-papageorgiou" => "pulse of Mavroeidis and Papageorgiou".into(),
        "gabor" => "Gabor wavelet".into(),
        "rectangular" => "rectangular pulse".into(),
        "double-rectangular" => "double rectangular pulse".into(),
        "sine-burst" => "harmonic motion that ends".into(),
        "harmonic" => "harmonic motion".into(),
        kind => kind.replace('-', " "),
    };
    if let Some(terms) = description.get("terms").and_then(Value::as_array) {
        let terms: Vec<String> = terms.iter().map(|term| words(term, gravity, 0.0)).collect();
        let peak = if peak > 0.0 { format!("; peak {}", acceleration(peak, gravity)) } else { String::new() };
        return format!("sum of {}{peak}", terms.join(", and "));
    }
    let mut parts: Vec<String> = Vec::new();
    if kind == "record" {
        parts.extend(record(description));
    }
    for (key, value) in description.iter().filter(|(key, _)| !is_covered(kind, key)) {
        parts.extend(parameter(key, value, gravity));
    }
    let has_size = description.contains_key("amplitude") || description.contains_key("peak");
    if !has_size && peak > 0.0 {
        parts.push(format!("peak {}", acceleration(peak, gravity)));
    }
    if parts.is_empty() { name } else { format!("{name}: {}", parts.join("; ")) }
}

fn acceleration(value: f64, gravity: f64) -> String {
    format!("{} m/s² = {} g", significant(value, 5), significant(value / gravity, 4))
}

/// Keys of a record that [`record`] covers.
const OF_A_RECORD: [&str; 7] = ["samples", "dt", "duration", "file", "title", "station", "component"];

/// Whether other code describes a key: `kind` always, and for a record the keys [`OF_A_RECORD`].
fn is_covered(kind: &str, key: &str) -> bool {
    key == "kind" || (kind == "record" && OF_A_RECORD.contains(&key))
}

/// Origin of a record, as far as it is known, and its sampling.
fn record(description: &Map<String, Value>) -> Vec<String> {
    let mut parts = Vec::new();
    for (key, before) in [("title", ""), ("station", "station "), ("component", "component "), ("file", "file ")] {
        let text = description.get(key).and_then(Value::as_str).unwrap_or_default();
        if !text.is_empty() {
            parts.push(format!("{before}{text}"));
        }
    }
    let number = |key: &str| description.get(key).and_then(Value::as_f64);
    match (number("samples"), number("dt")) {
        (Some(samples), Some(dt)) => parts.push(format!(
            "{samples} samples every {} s, {} s long",
            significant(dt, 6),
            significant((samples - 1.0).max(0.0) * dt, 5)
        )),
        (Some(samples), None) => parts.push(format!("{samples} samples")),
        _ => {}
    }
    parts
}

/// A parameter in words; `None` for a value without effect (start 0, phase 0, scale 1) and for null.
fn parameter(key: &str, value: &Value, gravity: f64) -> Option<String> {
    let number = value.as_f64();
    Some(match (key, number) {
        ("start" | "phase", Some(0.0)) | ("scale", Some(1.0)) => return None,
        (_, None) if value.is_null() => return None,
        ("amplitude" | "peak", Some(size)) => format!("{key} {}", acceleration(size, gravity)),
        ("scale", Some(scale)) => format!("scaled by {}", significant(scale, 5)),
        ("omega", Some(omega)) => format!(
            "ω = {} rad/s, frequency {} Hz, period {} s",
            significant(omega, 5),
            significant(omega / TAU, 4),
            significant(TAU / omega, 4)
        ),
        ("start", Some(start)) => format!("from t = {} s on", significant(start, 6)),
        ("velocity", Some(velocity)) => format!("velocity {} m/s", significant(velocity, 5)),
        ("duration", Some(duration)) => format!("lasting {} s", significant(duration, 6)),
        ("gamma", Some(gamma)) => format!("γ = {}", significant(gamma, 5)),
        ("cycles", Some(cycles)) => format!("n = {cycles}"),
        ("phase", Some(phase)) => format!("phase {} rad", significant(phase, 5)),
        (key, Some(number)) => format!("{} = {}", key.replace('_', " "), significant(number, 6)),
        (key, None) => {
            let text = match value {
                Value::String(text) => text.clone(),
                Value::Array(list) if list.len() > LONG_LIST => format!("{} numbers", list.len()),
                other => other.to_string(),
            };
            format!("{}: {text}", key.replace('_', " "))
        }
    })
}

/// Longer lists are counted, not printed.
const LONG_LIST: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn motions_are_given_in_both_units_and_unknown_ones_by_their_parameters() {
        let pulse = json!({"kind": "sine-pulse", "amplitude": 4.905, "omega": TAU, "start": 0.0});
        let expected = "one-sine pulse: amplitude 4.905 m/s² = 0.5 g; ω = 6.2832 rad/s, frequency 1 Hz, period 1 s";
        assert_eq!(words(&pulse, 9.81, 1.0), expected);
        let record = json!({"kind": "record", "samples": 2001, "dt": 0.01, "duration": 20.0, "start": 1.5, "scale": 1.0, "peak": 4.905,
            "file": "a<b", "title": "Friuli", "station": "", "component": "0"});
        let expected = "record: Friuli; component 0; file a<b; 2001 samples every 0.01 s, 20 s long; peak 4.905 m/s² = 0.5 g; from t = 1.5 s on";
        assert_eq!(words(&record, 9.81, 4.8), expected);
        let unknown = json!({"kind": "near-fault", "v_peak": 1.25, "name": "<b>", "list": vec![0.0; 9], "none": null});
        assert_eq!(words(&unknown, 9.81, 0.0), "near fault: list: 9 numbers; name: <b>; v peak = 1.25");
        assert_eq!(words(&Value::Null, 9.81, 0.0), "none");
        let sum = json!({"kind": "sum", "terms": [pulse, {"kind": "rectangular", "amplitude": 0.981, "start": 2.0, "duration": 0.5}]});
        let expected = "sum of one-sine pulse: amplitude 4.905 m/s² = 0.5 g; ω = 6.2832 rad/s, frequency 1 Hz, period 1 s, and \
            rectangular pulse: amplitude 0.981 m/s² = 0.1 g; lasting 0.5 s; from t = 2 s on";
        assert_eq!(words(&sum, 9.81, 0.0), expected);
        assert_eq!(words(&sum, 9.81, 9.81), format!("{expected}; peak 9.81 m/s² = 1 g"));
    }
}
