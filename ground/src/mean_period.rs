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

/// Longest transform of a record that is padded (64 MB). Amplitudes of a record with shorter intervals, below 5 µs, are summed frequency by frequency: its
/// padding would fill the memory.
const LONGEST_PADDED: usize = 1 << 22;

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
        let is_transformed = size <= LONGEST_PADDED || padded <= samples.len();
        if is_transformed {
            values.resize(size, [0.0; 2]);
            transform(&mut values);
        }
        let (mut sum, mut weighted) = (0.0, 0.0);
        for index in 1..=size / 2 {
            let frequency = index as f64 * step;
            if frequency > BAND[1] {
                break;
            }
            if frequency >= BAND[0] {
                let [re, im] = if is_transformed { values[index] } else { coefficient(&values, index, size) };
                let square = re * re + im * im;
                (sum, weighted) = (sum + square, weighted + square / frequency);
            }
        }
        (sum > 0.0).then(|| weighted / sum)
    }
}

/// Number `k` of the discrete Fourier transform of values that zeros pad to a length, `X_k = Σ x_j e^(-2πi jk/n)`.
fn coefficient(values: &[[f64; 2]], k: usize, length: usize) -> [f64; 2] {
    let turned = |[re, im]: [f64; 2], (sin, cos): (f64, f64)| [re * cos - im * sin, re * sin + im * cos];
    let turn = libm::sincos(-TAU * k as f64 / length as f64);
    let ([mut re, mut im], mut phase) = ([0.0, 0.0], [1.0, 0.0]);
    for &value in values {
        let term = turned(value, (phase[1], phase[0]));
        (re, im) = (re + term[0], im + term[1]);
        phase = turned(phase, turn);
    }
    [re, im]
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

    /// A wave of 20 Hz for a tenth of a second in steps of 1 µs would be padded to half a gigabyte; in steps of 100 µs it has nearly the same mean period.
    #[test]
    fn short_intervals_take_no_more_memory() {
        let wave = |dt: f64, count: u32| {
            let accel = (0..count).map(|k| (TAU * 20.0 * f64::from(k) * dt).sin()).collect();
            Record::new(accel, dt, 0.0).expect("valid").mean_period().expect("in the band")
        };
        let (fine, coarse) = (wave(1e-6, 100_001), wave(1e-4, 1001));
        assert!((fine / coarse - 1.0).abs() < 1e-3, "{fine} and {coarse}");
        let values: Vec<[f64; 2]> = (0..40).map(|j| [f64::from(j * j % 7) - 3.0, 0.0]).collect();
        let mut padded = values.clone();
        padded.resize(64, [0.0; 2]);
        transform(&mut padded);
        for (k, expected) in padded.iter().enumerate() {
            let found = coefficient(&values, k, 64);
            assert!((found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-11, "{k}");
        }
    }

    #[test]
    fn records_outside_the_band_have_no_mean_period() {
        for dt in [1e-100, 1e-12, 10.0, 1e6] {
            assert_eq!(Record::new(vec![1.0, -1.0, 2.0], dt, 0.0).expect("valid").mean_period(), None, "{dt}");
        }
        assert_eq!(Record::new(vec![0.0; 9], 0.01, 0.0).expect("valid").mean_period(), None);
    }
}
