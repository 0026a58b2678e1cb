//! Small systems of linear equations whose matrix is not symmetric: elimination with partial pivoting.

/// `x` of `matrix · x = loads`; `None` where a pivot vanishes or a number is not finite.
#[inline]
pub fn eliminate<const SIZE: usize>(mut matrix: [[f64; SIZE]; SIZE], mut loads: [f64; SIZE]) -> Option<[f64; SIZE]> {
    for column in 0..SIZE {
        let mut pivot = column;
        for row in column + 1..SIZE {
            if matrix[row][column].abs() > matrix[pivot][column].abs() {
                pivot = row;
            }
        }
        matrix.swap(pivot, column);
        loads.swap(pivot, column);
        if matrix[column][column] == 0.0 {
            return None;
        }
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
    loads.iter().all(|value| value.is_finite()).then_some(loads)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_needs_pivoting_is_solved() {
        let matrix = [[0.0, 2.0, 1.0], [1.0, 1.0, 1.0], [4.0, -2.0, 3.0]];
        let x = [0.5, -3.0, 2.0];
        let loads = matrix.map(|row| row.iter().zip(&x).map(|(a, b)| a * b).sum());
        let solution = eliminate(matrix, loads).expect("regular");
        assert!(solution.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-14), "{solution:?}");
    }

    #[test]
    fn dependent_rows_have_no_solution() {
        assert_eq!(eliminate([[1.0, 2.0], [2.0, 4.0]], [1.0, 2.0]), None);
        assert_eq!(eliminate([[f64::NAN]], [1.0]), None);
    }
}
