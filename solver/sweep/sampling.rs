//! Samples of the unit cube, one coordinate per distributed axis: independent, by Latin hypercube, or by a Sobol sequence. Each sample is computed
//! without the others, and the same seed gives the same samples on every machine.

use crate::names::named;
use crate::numerics::random::{generator, mixed};
use rand_pcg::rand_core::Rng;

/// Method by which the samples of distributed axes are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SamplingMethod {
    /// Independent random samples.
    Plain,
    /// Each coordinate has as many equal intervals as there are samples, and one sample in each. McKay, Beckman & Conover (1979), Technometrics 21.
    #[default]
    LatinHypercube,
    /// A Sobol sequence with Owen's scrambling, seeded. Burley (2020), JCGT 9(4). At most 65,536 samples; powers of two are best.
    Sobol,
}

named!(SamplingMethod: Plain = "plain", LatinHypercube = "latin-hypercube", Sobol = "sobol");

/// Samples of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sampling {
    pub samples: u32,
    pub method: SamplingMethod,
    pub seed: u64,
}

/// Longest Sobol sequence, a limit of the crate `sobol_burley`.
pub(super) const LONGEST_SOBOL: u32 = 1 << 16;

/// Largest number of dimensions of a Sobol sequence, one for each distributed axis: a limit of `sobol_burley`.
pub(super) const MOST_DIMENSIONS: usize = sobol_burley::NUM_DIMENSIONS as usize;

impl Sampling {
    /// Coordinate of a sample, above zero and below one; samples and dimensions from zero.
    pub fn unit(&self, sample: u32, dimension: usize) -> f64 {
        let jitter = self.random(sample, dimension);
        let count = f64::from(self.samples);
        let value = match self.method {
            SamplingMethod::Plain => jitter,
            SamplingMethod::LatinHypercube => {
                let stratum = permuted(sample, self.samples, self.seed ^ mixed(dimension as u64 + 1));
                (f64::from(stratum) + jitter) / count
            }
            SamplingMethod::Sobol => {
                let seed = mixed(self.seed) as u32;
                // The sequence has single precision: the place within an interval of 2^-24 is random.
                f64::from(sobol_burley::sample(sample, dimension as u32, seed)) + jitter * 2f64.powi(-24)
            }
        };
        value.clamp(f64::EPSILON, 1.0 - f64::EPSILON)
    }

    /// A random number of its own for each sample and dimension, 0 to below 1.
    fn random(&self, sample: u32, dimension: usize) -> f64 {
        let mut generator = generator(self.seed, dimension as u64);
        generator.advance(u128::from(sample));
        (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Rounds of the Feistel network. Four make a permutation that looks random (Luby & Rackoff 1988); two more because the halves are short.
const ROUNDS: u64 = 6;

/// Image of a number below `count` in a random permutation of these numbers. A Feistel network permutes the numbers below a power of four that is at
/// least `count`; it is applied until the result is below `count` (Black & Rogaway 2002).
fn permuted(number: u32, count: u32, seed: u64) -> u32 {
    let bits = (64 - u64::from(count.max(2) - 1).leading_zeros()).div_ceil(2);
    let mask = (1u64 << bits) - 1;
    let mut place = u64::from(number);
    loop {
        for round in 0..ROUNDS {
            let (left, right) = (place >> bits, place & mask);
            place = right << bits | (left ^ mixed(seed ^ mixed(right << 8 | round))) & mask;
        }
        if place < u64::from(count) {
            return place as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_permutation_takes_each_place_once() {
        for (count, seed) in [(1, 0), (2, 1), (3, 2), (17, 3), (1000, 4), (65_537, 5)] {
            let mut places: Vec<u32> = (0..count).map(|number| permuted(number, count, seed)).collect();
            places.sort_unstable();
            assert!(places.into_iter().eq(0..count), "{count}");
        }
        assert_ne!(
            (0..100).map(|number| permuted(number, 100, 1)).collect::<Vec<_>>(),
            (0..100).map(|number| permuted(number, 100, 2)).collect::<Vec<_>>()
        );
    }

    /// Means of `x`, `x²` and `x y` over the unit square: 1/2, 1/3, 1/4, within four standard errors of the method.
    #[test]
    fn means_over_the_unit_square_are_met() {
        let samples = 4096;
        // Variances of plain samples: 1/3 - 1/4, 1/5 - 1/9, 1/9 - 1/16.
        let plain = [1.0 / 12.0, 4.0 / 45.0, 7.0 / 144.0].map(f64::sqrt);
        // With one sample in each of `n` intervals, `x` and `x²` vary within theirs alone: by 1/n and 2x/n over √12, the mean of 4x² is 4/3. Of `x y`
        // remains the product of the deviations from both means.
        let [x, square] = [1.0f64, 4.0 / 3.0].map(|mean| (mean / 12.0).sqrt() / f64::from(samples));
        let hypercube = [x, square, 1.0 / 12.0];
        // A Sobol sequence has one sample in each of 64 × 64 squares as well: `x y` varies within its square, the mean of x² + y² is 2/3.
        let sobol = [x, square, (2.0f64 / 3.0 / 12.0).sqrt() / 64.0];
        for (method, deviations) in [
            (SamplingMethod::Plain, plain),
            (SamplingMethod::LatinHypercube, hypercube),
            (SamplingMethod::Sobol, sobol),
        ] {
            let sampling = Sampling { samples, method, seed: 7 };
            let mut sums = [0.0; 3];
            for sample in 0..samples {
                let [x, y] = [0, 1].map(|dimension| sampling.unit(sample, dimension));
                assert!(x > 0.0 && x < 1.0);
                sums = [sums[0] + x, sums[1] + x * x, sums[2] + x * y];
            }
            for ((sum, exact), deviation) in sums.iter().zip([1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0]).zip(deviations) {
                let (found, error) = (sum / f64::from(samples), 4.0 * deviation / f64::from(samples).sqrt());
                assert!((found - exact).abs() < error, "{}: {found} and {exact}, allowed {error:e}", method.name());
            }
        }
    }

    #[test]
    fn a_latin_hypercube_has_a_sample_in_each_interval() {
        let sampling = Sampling { samples: 100, method: SamplingMethod::LatinHypercube, seed: 3 };
        for dimension in 0..4 {
            let mut intervals: Vec<u32> =
                (0..100).map(|sample| (100.0 * sampling.unit(sample, dimension)) as u32).collect();
            intervals.sort_unstable();
            assert!(intervals.into_iter().eq(0..100));
        }
    }

    #[test]
    fn seeds_and_dimensions_differ() {
        for method in [SamplingMethod::Plain, SamplingMethod::LatinHypercube, SamplingMethod::Sobol] {
            let of = |seed: u64, dimension: usize| -> Vec<f64> {
                (0..8).map(|sample| Sampling { samples: 8, method, seed }.unit(sample, dimension)).collect()
            };
            assert!(of(1, 0) != of(2, 0) && of(1, 0) != of(1, 1) && of(1, 0) == of(1, 0), "{}", method.name());
        }
    }
}
