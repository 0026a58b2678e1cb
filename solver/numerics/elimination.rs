//! Small systems of linear equations whose matrix is not symmetric: elimination with partial pivoting. [`eliminate`] serves one system of known size,
//! whose rows may be of very different sizes, [`Factors`] several systems with the same matrix.

use smallvec::SmallVec;

/// Size of a matrix up to which its storage is inline.
const USUAL_SIZE: usize = 6;

/// `x` of `matrix · x = loads`, and whether the determinant is above zero; `None` if a pivot vanishes or the solution is not finite. Pivots are the largest entries relative to their rows (scaled
/// partial pivoting): the row of a light block has small entries, and keeps its digits.
#[inline]
pub fn eliminate<const SIZE: usize>(
    mut matrix: [[f64; SIZE]; SIZE],
    mut loads: [f64; SIZE],
) -> Option<([f64; SIZE], bool)> {
    let mut is_positive = true;
    let mut scales = matrix.map(|row| 1.0 / row.iter().fold(0.0f64, |most, entry| most.max(entry.abs())));
    for column in 0..SIZE {
        let mut pivot = column;
        for row in column + 1..SIZE {
            if matrix[row][column].abs() * scales[row] > matrix[pivot][column].abs() * scales[pivot] {
                pivot = row;
            }
        }
        matrix.swap(pivot, column);
        loads.swap(pivot, column);
        scales.swap(pivot, column);
        if matrix[column][column] == 0.0 {
            return None;
        }
        is_positive ^= (pivot != column) ^ (matrix[column][column] < 0.0);
        let inverse = 1.0 / matrix[column][column];
        let (own, load) = (matrix[column], loads[column]);
        for row in column + 1..SIZE {
            let factor = matrix[row][column] * inverse;
            for (entry, own) in matrix[row].iter_mut().zip(&own).skip(column + 1) {
                *entry -= factor * own;
            }
            loads[row] -= factor * load;
        }
    }
    for row in (0..SIZE).rev() {
        for column in row + 1..SIZE {
            loads[row] -= matrix[row][column] * loads[column];
        }
        loads[row] /= matrix[row][row];
    }
    loads.iter().all(|value| value.is_finite()).then_some((loads, is_positive))
}

/// A matrix, and its factors once it is factorised.
#[derive(Clone, Debug)]
pub struct Factors {
    size: usize,
    /// Entries row by row. Once factorised: multipliers below the diagonal, the upper factor on and above it.
    entries: SmallVec<[f64; USUAL_SIZE * USUAL_SIZE]>,
    /// Per column: the row of its pivot, which is swapped with the row of the column's index.
    pivots: SmallVec<[usize; USUAL_SIZE]>,
}

impl Factors {
    /// Storage for a matrix with so many rows and columns.
    pub fn with_size(size: usize) -> Factors {
        Factors { size, entries: SmallVec::from_elem(0.0, size * size), pivots: SmallVec::from_elem(0, size) }
    }

    /// An entry of the matrix, to be written before it is factorised.
    pub fn entry(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.entries[row * self.size + column]
    }

    /// Factorises the matrix; `None` where a pivot vanishes or is not finite.
    pub fn factorise(&mut self) -> Option<()> {
        let (size, a) = (self.size, self.entries.as_mut_slice());
        for column in 0..size {
            let mut pivot = column;
            for row in column + 1..size {
                if a[row * size + column].abs() >= a[pivot * size + column].abs() {
                    pivot = row;
                }
            }
            self.pivots[column] = pivot;
            let value = a[pivot * size + column];
            if value == 0.0 || !value.is_finite() {
                return None;
            }
            if pivot != column {
                (0..size).for_each(|k| a.swap(pivot * size + k, column * size + k));
            }
            let (above, below) = a.split_at_mut((column + 1) * size);
            let own = &above[column * size + column + 1..];
            for row in below.chunks_exact_mut(size) {
                let factor = row[column] / value;
                row[column] = factor;
                if factor != 0.0 {
                    row[column + 1..].iter_mut().zip(own).for_each(|(entry, own)| *entry -= factor * own);
                }
            }
        }
        Some(())
    }

    /// Whether the determinant is above zero. The matrix must be factorised.
    pub fn is_positive(&self) -> bool {
        let swaps = self.pivots.iter().enumerate().filter(|(column, pivot)| column != *pivot).count();
        let negative = (0..self.size).filter(|k| self.entries[k * self.size + k] < 0.0).count();
        (swaps + negative).is_multiple_of(2)
    }

    /// Replaces loads by the solution. The matrix must be factorised.
    pub fn solve(&self, loads: &mut [f64]) {
        let (size, a) = (self.size, self.entries.as_slice());
        for (column, pivot) in self.pivots.iter().enumerate() {
            loads.swap(column, *pivot);
        }
        for row in 1..size {
            let (known, left) = loads.split_at_mut(row);
            let factors = &a[row * size..][..row];
            left[0] = factors.iter().zip(&*known).fold(left[0], |left, (factor, known)| left - factor * known);
        }
        for row in (0..size).rev() {
            let factors = &a[row * size..][..size];
            let known: f64 = factors[row + 1..].iter().zip(&loads[row + 1..size]).map(|(factor, x)| factor * x).sum();
            loads[row] = (loads[row] - known) / factors[row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_needs_pivoting_is_solved() {
        let matrix = [[0.0, 2.0, 1.0], [1.0, 1.0, 1.0], [4.0, -2.0, 3.0]];
        let x = [0.5, -3.0, 2.0];
        let loads = matrix.map(|row| row.iter().zip(&x).map(|(a, b)| a * b).sum());
        let (solution, is_positive) = eliminate(matrix, loads).expect("regular");
        assert!(!is_positive, "the determinant is -4");
        assert!(solution.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14), "{solution:?}");
        let mut factors = Factors::with_size(3);
        for (row, entries) in matrix.iter().enumerate() {
            entries.iter().enumerate().for_each(|(column, entry)| *factors.entry(row, column) = *entry);
        }
        factors.factorise().expect("regular");
        let mut solution = loads;
        factors.solve(&mut solution);
        assert!(solution.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14), "{solution:?}");
    }

    #[test]
    fn the_sign_of_the_determinant_counts_swaps() {
        let of = |matrix: [[f64; 2]; 2]| {
            let mut factors = Factors::with_size(2);
            (0..4).for_each(|k| *factors.entry(k / 2, k % 2) = matrix[k / 2][k % 2]);
            factors.factorise().expect("regular");
            let (_, is_positive) = eliminate(matrix, [1.0, 1.0]).expect("regular");
            assert_eq!(is_positive, factors.is_positive());
            is_positive
        };
        assert!(of([[2.0, 1.0], [1.0, 2.0]]) && of([[0.0, -1.0], [1.0, 0.0]]) && of([[-2.0, 1.0], [1.0, -2.0]]));
        assert!(!of([[0.0, 1.0], [1.0, 0.0]]) && !of([[1.0, 2.0], [2.0, 1.0]]));
    }

    #[test]
    fn dependent_rows_have_no_solution() {
        assert_eq!(eliminate([[1.0, 2.0], [2.0, 4.0]], [1.0, 2.0]), None);
        assert_eq!(eliminate([[f64::NAN]], [1.0]), None);
        let mut factors = Factors::with_size(2);
        (0..4).for_each(|k| *factors.entry(k / 2, k % 2) = [1.0, 2.0, 2.0, 4.0][k]);
        assert_eq!(factors.factorise(), None);
    }
}
