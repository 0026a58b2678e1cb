//! Random numbers that are the same on every machine.

use rand_pcg::Pcg64Mcg;

/// Hash of a number, in which each bit depends on all bits of the number: the finalizer of SplitMix64 (Steele, Lea & Flood 2014).
pub fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A generator of its own for each seed and stream. Its first state is a hash: states that are small multiples of one another stay so, and their numbers are
/// not independent.
pub fn generator(seed: u64, stream: u64) -> Pcg64Mcg {
    let high = mixed(seed ^ mixed(stream));
    Pcg64Mcg::new(u128::from(high) << 64 | u128::from(mixed(high)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_pcg::rand_core::Rng;

    /// Of pairs of numbers from two streams, a hundredth has both in the lowest, or both in the highest, tenth.
    #[test]
    fn streams_are_independent() {
        let pairs = 50_000;
        let (expected, deviation) = (pairs as f64 * 0.01, (pairs as f64 * 0.01 * 0.99).sqrt());
        for seed in [0, 1, 2, u64::MAX] {
            for [first, second] in [[0, 1], [0, 2], [1, 2], [1, 3], [2, 5], [999, 1000]] {
                let mut generators = [first, second].map(|stream| generator(seed, stream));
                let tenth = u64::MAX / 10;
                let (mut low, mut high) = (0, 0);
                for _ in 0..pairs {
                    let [x, y] = generators.each_mut().map(Rng::next_u64);
                    low += i32::from(x < tenth && y < tenth);
                    high += i32::from(x > u64::MAX - tenth && y > u64::MAX - tenth);
                }
                for found in [low, high] {
                    let deviations = (f64::from(found) - expected) / deviation;
                    assert!(deviations.abs() < 4.5, "seed {seed}, streams {first} and {second}: {found}");
                }
            }
        }
    }

    #[test]
    fn no_two_streams_are_the_same() {
        for seed in [0, 1, 7] {
            let mut firsts: Vec<u64> = (0..10_000).map(|stream| generator(seed, stream).next_u64()).collect();
            firsts.sort_unstable();
            firsts.dedup();
            assert_eq!(firsts.len(), 10_000);
        }
    }
}
