//! The range of the angles of a run and its companions, over time.

use crate::response::Response;
use std::fmt::Write as _;

/// Smallest and largest angle of each block in all runs. A run that has ended counts with its last angles.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Band {
    /// Times `[s]`, ascending.
    pub t: Vec<f64>,
    /// Smallest angles `[rad]`, per time and block, base first.
    pub low: Vec<Vec<f64>>,
    /// Largest angles `[rad]`, per time and block, base first.
    pub high: Vec<Vec<f64>>,
}

impl Band {
    /// Band of runs with rows at the same times, up to the end of the longest run. A shorter run keeps its last angles to the end.
    pub(super) fn of<'a>(runs: impl Iterator<Item = &'a Response> + Clone, blocks: usize) -> Band {
        let longest = runs.clone().max_by_key(|run| run.samples.len());
        let t: Vec<f64> = longest.iter().flat_map(|run| &run.samples).map(|row| row.t).collect();
        let mut band = Band {
            low: vec![vec![f64::INFINITY; blocks]; t.len()],
            high: vec![vec![f64::NEG_INFINITY; blocks]; t.len()],
            t,
        };
        for run in runs {
            let Some(last) = run.samples.len().checked_sub(1) else { continue };
            for (place, (low, high)) in band.low.iter_mut().zip(&mut band.high).enumerate() {
                for (block, angle) in run.samples[place.min(last)].theta.iter().enumerate() {
                    low[block] = low[block].min(*angle);
                    high[block] = high[block].max(*angle);
                }
            }
        }
        band
    }

    /// Whether the band has no times.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// The band as a CSV table: `t, low_1.., high_1..`, a row per time; numbers read back to the same bits.
    pub fn to_csv(&self) -> String {
        let blocks = self.low.first().map_or(0, Vec::len);
        let names =
            ["low", "high"].map(|name| (1..=blocks).map(|block| format!(",{name}_{block}")).collect::<String>());
        let mut text = format!("t{}\n", names.concat());
        for ((t, low), high) in self.t.iter().zip(&self.low).zip(&self.high) {
            let _ = write!(text, "{t:?}");
            for angle in low.iter().chain(high) {
                let _ = write!(text, ",{angle:?}");
            }
            text.push('\n');
        }
        text
    }

    /// Reads what [`Band::to_csv`] writes for so many blocks.
    ///
    /// # Errors
    /// The number of the first faulty line, from 1: numbers are missing, too many or not finite, or the time is not after the line above.
    pub fn from_csv(text: &str, blocks: usize) -> Result<Band, usize> {
        let mut band = Band::default();
        for (place, row) in text.lines().enumerate().skip(1) {
            let numbers: Option<Vec<f64>> =
                row.split(',').map(|cell| cell.parse().ok().filter(|number: &f64| number.is_finite())).collect();
            let numbers = numbers.filter(|numbers| numbers.len() == 1 + 2 * blocks).ok_or(place + 1)?;
            if band.t.last().is_some_and(|last| *last >= numbers[0]) {
                return Err(place + 1);
            }
            band.t.push(numbers[0]);
            band.low.push(numbers[1..=blocks].to_vec());
            band.high.push(numbers[blocks + 1..].to_vec());
        }
        Ok(band)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_reads_back_and_a_damaged_one_is_refused_with_its_line() {
        let band = Band {
            t: vec![0.0, 0.1],
            low: vec![vec![0.0, -1.0 / 3.0], vec![-1e-300, 0.0]],
            high: vec![vec![0.1, 0.2], vec![0.3, 1e9]],
        };
        let text = band.to_csv();
        assert!(text.starts_with("t,low_1,low_2,high_1,high_2\n"), "{text}");
        assert_eq!(Band::from_csv(&text, 2), Ok(band));
        assert_eq!(Band::from_csv(&text, 3), Err(2));
        assert_eq!(Band::from_csv(&text.replace("0.1,-1", "0.0,-1"), 2), Err(3));
        assert_eq!(Band::from_csv(&text.replace(",0.3,", ",NaN,"), 2), Err(3));
    }
}
