//! Mean period of a record from its Fourier amplitudes `C_i` at the frequencies `f_i`.
//!
//! `T_m = Σ C_i² / f_i / Σ C_i²` over 0.25 Hz ≤ f_i ≤ 20 Hz. The samples are padded with zeros so that neighbouring frequencies are at most
//! 0.05 Hz apart. Rathje, Abrahamson and Bray (1998), "Simplified frequency content estimates of earthquake ground motions", J. Geotech. 124,
//! 150-159; Rathje et al. (2004), Earthquake Spectra 20, 119-144.

use crate::record::Record;
use std::f64::consts::TAU;

/// Lowest and highest frequency of the sums `[Hz]`.
const BAND: [f64; 2] = [0.25, 20.0];

/// Largest distance of neighbouring frequencies `[Hz]`.
const LARGEST_STEP: f64 = 0.05;

/// Largest padded length per sample of the record, before it is rounded up to a power of two. Only records shorter than 0.3 ms reach it: they
/// are far shorter than any period of the band.
const MOST_PADDING: usize = 1 << 16;

impl Record {
    /// Mean period `[s]`; none for a record of zeros, and if no frequency of the transform lies in the band.
    pub(crate) fn mean_period(&self) -> Option<f64> {
        let (samples, dt) = (self.accel(), self.dt());
        let padded = (1.0 / (LARGEST_STEP * dt)).min((samples.len() * MOST_PADDING) as f64) as usize;
        let size = samples.len().max(padded).next_power_of_two();
        let step = 1.0 / (size as f64 * dt);
        // A band without a frequency needs no transform.
        if step > BAND[1] || 0.5 / dt < BAND[0] {
            return None;
        }
        let scale = self.peak().max(f64::MIN_POSITIVE);
        let mut values: Vec<[f64; 2]> = samples.iter().map(|a| [a / scale, 0.0]).collect();
        values.resize(size, [0.0; 2]);
        transform(&mut values);
        let (mut sum, mut weighted) = (0.0, 0.0);
        for (index, [re, im]) in values.iter().enumerate().take(size / 2 + 1).skip(1) {
            let frequency = index as f64 * step;
            if (BAND[0]..=BAND[1]).contains(&frequency) {
                let square = re * re + im * im;
                (sum, weighted) = (sum + square, weighted + square / frequency);
            }
        }
        (sum > 0.0).then(|| weighted / sum)
    }
}

/// Discrete Fourier transform in place, `X_k = Σ x_j e^(-2πi jk/n)`. The length is a power of two. Cooley and Tukey (1965).
fn transform(values: &mut [[f64; 2]]) {
    let size = values.len();
    let bits = size.trailing_zeros();
    for index in 0..size {
        let mirrored = if bits == 0 { index } else { index.reverse_bits() >> (usize::BITS - bits) };
        if index < mirrored {
            values.swap(index, mirrored);
        }
    }
    let mut half = 1;
    while half < size {
        let turns: Vec<(f64, f64)> = (0..half).map(|k| libm::sincos(-TAU * k as f64 / (2 * half) as f64)).collect();
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((a, b), (sin, cos)) in low.iter_mut().zip(high).zip(&turns) {
                let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_sum_that_defines_it() {
        for size in [1, 2, 8, 64] {
            let values: Vec<[f64; 2]> = (0..size).map(|j| [f64::from(j * j % 7) - 3.0, f64::from(j % 3)]).collect();
            let mut found = values.clone();
            transform(&mut found);
            for (k, found) in found.iter().enumerate() {
                let term = |(j, [re, im]): (usize, &[f64; 2])| {
                    let (sin, cos) = (-TAU * (j * k) as f64 / f64::from(size)).sin_cos();
                    [re * cos - im * sin, re * sin + im * cos]
                };
                let sum = values.iter().enumerate().map(term).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
                assert!((found[0] - sum[0]).hypot(found[1] - sum[1]) < 1e-11, "{size} {k}");
            }
        }
    }

    /// A sine of many whole periods has one frequency.
    #[test]
    fn a_sine_has_its_own_period() {
        for period in [0.1, 0.32, 1.0, 3.2] {
            let accel = (0..8192).map(|k| (TAU * f64::from(k) * 0.01 / period).sin()).collect();
            let found = Record::new(accel, 0.01, 0.0).expect("valid").mean_period();
            // Leakage: the spectrum of a sine that lasts 80 s is 1/80 Hz wide.
            assert!(found.is_some_and(|found| (found / period - 1.0).abs() < 0.02), "{period}: {found:?}");
        }
    }

    /// Half a second of 5 Hz: 50 samples at 0.01 s, and 2000 intervals are 1/0.05 s.
    #[test]
    fn a_short_record_has_the_mean_period_of_its_padded_self() {
        let short: Vec<f64> = (0..50).map(|k| (TAU * 5.0 * f64::from(k) * 0.01).sin()).collect();
        let mut padded = short.clone();
        padded.resize(2048, 0.0);
        let [short, padded] = [short, padded].map(|accel| Record::new(accel, 0.01, 0.0).expect("valid").mean_period());
        assert!(short.is_some() && short == padded, "{short:?} and {padded:?}");
    }

    #[test]
    fn records_outside_the_band_have_no_mean_period() {
        for dt in [1e-100, 1e-12, 10.0, 1e6] {
            assert_eq!(Record::new(vec![1.0, -1.0, 2.0], dt, 0.0).expect("valid").mean_period(), None, "{dt}");
        }
        assert_eq!(Record::new(vec![0.0; 9], 0.01, 0.0).expect("valid").mean_period(), None);
    }
}
