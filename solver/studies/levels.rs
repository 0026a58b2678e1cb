//! Levels of intensity that are the same but for rounding: tables that are put together, and measures of scaled records, give `0.3` and
//! `0.30000000000000004`.

/// Largest difference of two levels that are one, relative to the lower one: beyond what any arithmetic rounds, below what a table of levels tells apart.
const SAME: f64 = 1e-9;

/// Whether two levels, the lower one first, are the same but for rounding.
pub fn is_same_level(lower: f64, level: f64) -> bool {
    level - lower <= SAME * lower
}

/// The levels that differ by more than rounding, from the lowest up; each stands for those just above it.
pub fn distinct_levels(levels: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut levels: Vec<f64> = levels.collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|level, lower| is_same_level(*lower, *level));
    levels
}

/// Place of a level among the distinct ones, to which it belongs.
pub fn place_of_level(distinct: &[f64], level: f64) -> usize {
    distinct.partition_point(|lower| *lower <= level).saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_that_differ_by_rounding_are_one() {
        let levels = [0.1 + 0.2, 0.3, 0.3 * (1.0 + 1e-8), 0.1, 3.0];
        let distinct = distinct_levels(levels.into_iter());
        assert_eq!(distinct, [0.1, 0.3, 0.3 * (1.0 + 1e-8), 3.0]);
        assert_eq!(levels.map(|level| place_of_level(&distinct, level)), [1, 1, 2, 0, 3]);
    }
}
