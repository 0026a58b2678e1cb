//! Times of the rows of a response: multiples of an interval, or a list.

/// Times of the rows of a response `[s]`, ascending, each found by its number from zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowTimes<'a> {
    /// Multiples of an interval, from zero to the end of the run `[s]`.
    Every {
        /// The interval.
        dt: f64,
        /// The end.
        end: f64,
    },
    /// The listed times; an empty list means no rows.
    At(&'a [f64]),
}

impl RowTimes<'_> {
    /// No rows.
    pub const NONE: RowTimes<'static> = RowTimes::At(&[]);

    /// The time of a row `[s]`; `None` after the last row.
    ///
    /// ```
    /// use rocking::RowTimes;
    /// assert_eq!(RowTimes::Every { dt: 0.25, end: 0.5 }.get(2), Some(0.5));
    /// assert_eq!(RowTimes::At(&[0.1, 0.3]).get(1), Some(0.3));
    /// assert_eq!(RowTimes::NONE.get(0), None);
    /// ```
    #[inline]
    pub fn get(self, row: usize) -> Option<f64> {
        match self {
            RowTimes::Every { dt, end } => Some(row as f64 * dt).filter(|t| *t <= last(end)),
            RowTimes::At(times) => times.get(row).copied(),
        }
    }

    /// Number of rows of a run that lasts to its end, dimensionless. An `f64`, since a short interval may give more rows than integers hold.
    pub fn count(self) -> f64 {
        match self {
            RowTimes::Every { dt, end } => ((last(end) / dt).floor() + 1.0).max(0.0),
            RowTimes::At(times) => times.len() as f64,
        }
    }

    /// Whether there is no row.
    pub fn is_none(self) -> bool {
        self.get(0).is_none()
    }
}

/// The latest time of a row of a run that ends at `end` `[s]`: a little later than `end`, so that rounding of `row · dt` does not lose the last row.
pub(crate) fn last(end: f64) -> f64 {
    end * (1.0 + 4.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_that_ends_before_its_start_has_no_rows() {
        let times = RowTimes::Every { dt: 1.0, end: -1.0 };
        assert_eq!((times.count(), times.get(0)), (0.0, None));
    }

    #[test]
    fn the_last_row_is_not_lost_to_rounding() {
        // 3 · 0.1 is 0.30000000000000004.
        let rows = RowTimes::Every { dt: 0.1, end: 0.3 };
        assert_eq!((rows.count(), rows.get(3), rows.get(4)), (4.0, Some(3.0 * 0.1), None));
    }

    #[test]
    fn the_count_is_that_of_the_times() {
        for rows in [RowTimes::Every { dt: 0.3, end: 1.0 }, RowTimes::At(&[0.0, 0.1, 0.7]), RowTimes::NONE] {
            assert_eq!(rows.count(), (0..).map_while(|row| rows.get(row)).count() as f64, "{rows:?}");
            assert_eq!(rows.is_none(), rows.count() == 0.0);
        }
    }
}
