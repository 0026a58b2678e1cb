//! What the points say: error reached against tolerance asked, and the fastest way to a given error.

use crate::sweep::{Code, METHODS, Point};
use rocking::Method;

/// Rounding counts for more than the tolerance below this one.
const TIGHTEST_COMPARED: f64 = 1e-11;

fn scenes(points: &[Point]) -> Vec<&'static str> {
    let mut names: Vec<&'static str> = points.iter().map(|point| point.scene).collect();
    names.dedup();
    names
}

/// Points of one curve, loose to tight.
pub fn curve<'a>(points: &'a [Point], scene: &str, method: Method, code: Code) -> Vec<&'a Point> {
    points.iter().filter(|p| p.scene == scene && p.method == method && p.code == code).collect()
}

/// Error over tolerance as CSV, and printed: the worst over all tolerances, and the smallest error reached.
pub fn tolerance(points: &[Point], columns: &str, circumstances: &str) -> String {
    let mut csv = format!("scene,method,rtol,angle_error_rad,ratio,{columns}\n");
    println!(
        "\nerror reached / tolerance asked: worst over rtol >= {TIGHTEST_COMPARED:e} (where); smallest error [rad]"
    );
    for scene in scenes(points) {
        let mut line = format!("{scene:<33}");
        for method in Method::ACCURATE {
            let curve = curve(points, scene, method, Code::Generated);
            for p in &curve {
                let ratio = p.angle_error / p.setting;
                let (name, error) = (method.name(), p.angle_error);
                csv.push_str(&format!("\"{scene}\",{name},{:e},{error:.3e},{ratio:.3e},{circumstances}\n", p.setting));
            }
            let ratio = |p: &Point| p.angle_error / p.setting;
            let compared = curve.iter().filter(|p| p.setting >= 0.99 * TIGHTEST_COMPARED);
            let worst = compared.max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
            let least = curve.iter().fold(f64::INFINITY, |least, p| least.min(p.angle_error));
            if let Some(worst) = worst {
                let (ratio, setting) = (ratio(worst), worst.setting);
                line.push_str(&format!("  {} {ratio:.2} ({setting:.0e}) {least:.0e}", method.name()));
            }
        }
        println!("{line}");
    }
    csv
}

/// Time to an error of at most `level`: between two tolerances on a straight line in logarithms. A curve that errs more again
/// at a tighter tolerance has the larger error at the looser ones too: luck is not counted. Where the loosest one is better
/// than asked already, its time.
pub fn time_to(curve: &[&Point], level: f64) -> Option<f64> {
    let mut errors: Vec<f64> = curve.iter().map(|point| point.angle_error).collect();
    for place in (1..errors.len()).rev() {
        errors[place - 1] = errors[place - 1].max(errors[place]);
    }
    let place = errors.iter().position(|error| *error <= level)?;
    let (loose, tight) = (place.saturating_sub(1), place);
    let share = (errors[loose] / level).ln() / (errors[loose] / errors[tight]).ln();
    if !share.is_finite() {
        return Some(curve[tight].best);
    }
    Some(curve[loose].best * (curve[tight].best / curve[loose].best).powf(share))
}

/// Prints, per scene and error, which method on generated equations is fastest, its time, and how much longer DOP853 takes on
/// generic ones.
pub fn fastest(points: &[Point]) {
    println!(
        "\nfastest way to an error [rad] on generated equations: method, time [µs], times faster than DOP853 on generic ones"
    );
    for scene in scenes(points) {
        println!("{scene}");
        for digits in 4..=12 {
            let level = 10f64.powi(-digits);
            let time = |method, code| time_to(&curve(points, scene, method, code), level);
            let best = METHODS.into_iter().filter_map(|method| Some((method, time(method, Code::Generated)?)));
            let best = best.min_by(|a, b| a.1.total_cmp(&b.1));
            match (best, time(Method::Dop853, Code::Generic)) {
                (Some((method, own)), Some(generic)) => {
                    println!("    {level:.0e}  {:<16} {own:>9.1}  {:>5.1}", method.name(), generic / own);
                }
                (Some((method, own)), None) => println!("    {level:.0e}  {:<16} {own:>9.1}      -", method.name()),
                (None, _) => println!("    {level:.0e}  not reached"),
            }
        }
    }
}
