//! Correlated coordinates: a Gaussian copula. Nataf (1962); Liu & Der Kiureghian (1986), Probab. Eng. Mech. 1.
//!
//! Independent coordinates `u` become normal scores `z = Φ⁻¹(u)`, then correlated scores `L z` with `L Lᵀ` the matrix of correlations, then
//! coordinates `Φ(L z)`. Correlations are those of the scores: without bounds, those of normal values and of the logarithms of lognormal values.

use statrs::distribution::{ContinuousCDF, Normal};

/// Lower triangle `L`, by rows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Copula(Vec<Vec<f64>>);

/// Smallest square of a diagonal entry of `L`. Below it, the axis is determined by the axes before it.
const LEAST_PIVOT: f64 = 1e-12;

impl Copula {
    /// Copula of `axes` axes; each pair is two axes and their correlation. `None` if the matrix of correlations is not positive definite.
    pub fn new(axes: usize, pairs: &[(usize, usize, f64)]) -> Option<Copula> {
        let mut matrix = vec![vec![0.0; axes]; axes];
        (0..axes).for_each(|axis| matrix[axis][axis] = 1.0);
        for &(a, b, correlation) in pairs {
            (matrix[a][b], matrix[b][a]) = (correlation, correlation);
        }
        // Cholesky's factor.
        let mut factor = vec![Vec::with_capacity(axes); axes];
        for row in 0..axes {
            for column in 0..=row {
                let (left, right): (&[f64], &[f64]) = (&factor[row], &factor[column]);
                let known: f64 = left.iter().zip(right).take(column).map(|(a, b)| a * b).sum();
                let rest = matrix[row][column] - known;
                let entry = match row == column {
                    true if rest < LEAST_PIVOT => return None,
                    true => rest.sqrt(),
                    false => rest / factor[column][column],
                };
                factor[row].push(entry);
            }
        }
        Some(Copula(factor))
    }

    /// Correlated coordinates from the independent coordinates `units`; all are above zero and below one.
    pub fn correlated(&self, units: &[f64]) -> Vec<f64> {
        let normal = Normal::standard();
        let scores: Vec<f64> = units.iter().map(|unit| normal.inverse_cdf(*unit)).collect();
        let correlated = |(row, unit): (&Vec<f64>, &f64)| match row.split_last() {
            // An axis without correlation to the axes before it keeps its coordinate to the last bit.
            Some((_, others)) if others.iter().all(|entry| *entry == 0.0) => *unit,
            _ => {
                let score: f64 = row.iter().zip(&scores).map(|(entry, score)| entry * score).sum();
                normal.cdf(score).clamp(f64::EPSILON, 1.0 - f64::EPSILON)
            }
        };
        self.0.iter().zip(units).map(correlated).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_have_the_correlations_asked_for() {
        let pairs = [(0, 1, 0.6), (1, 2, -0.3), (0, 3, 0.2)];
        let copula = Copula::new(4, &pairs).expect("correlations");
        let normal = Normal::standard();
        // A grid of the unit cube: means of products of scores.
        let steps = 12;
        let unit = |step: usize| (step as f64 + 0.5) / steps as f64;
        let (mut sums, mut count) = ([[0.0; 4]; 4], 0.0);
        for place in 0..steps * steps * steps * steps {
            let steps_of =
                [place % steps, place / steps % steps, place / steps / steps % steps, place / steps / steps / steps];
            let units = copula.correlated(&steps_of.map(unit));
            let scores: Vec<f64> = units.iter().map(|unit| normal.inverse_cdf(*unit)).collect();
            for (a, row) in sums.iter_mut().enumerate() {
                for (b, sum) in row.iter_mut().enumerate() {
                    *sum += scores[a] * scores[b];
                }
            }
            count += 1.0;
        }
        let variance = sums[0][0] / count;
        for (a, row) in sums.iter().enumerate() {
            for (b, sum) in row.iter().enumerate().take(a) {
                let wanted = pairs.iter().find(|(x, y, _)| (*x, *y) == (b, a)).map_or(0.0, |pair| pair.2);
                let found = sum / count / variance;
                assert!((found - wanted).abs() < 1e-6, "{a} and {b}: {found}");
            }
        }
    }

    #[test]
    fn correlations_that_exclude_each_other_are_none() {
        // Two that follow a third cannot oppose each other.
        assert_eq!(Copula::new(3, &[(0, 1, 0.9), (0, 2, 0.9), (1, 2, -0.9)]), None);
        assert_eq!(Copula::new(2, &[(0, 1, 1.0)]), None);
        assert!(Copula::new(3, &[]).is_some_and(|free| free.correlated(&[0.1, 0.2, 0.3]) == [0.1, 0.2, 0.3]));
    }
}
