//! Linear complementarity problems, by Lemke's method: `w = M z + q` with `w >= 0`, `z >= 0` and `w · z = 0`
//! (Cottle, Pang & Stone, The Linear Complementarity Problem, 1992, section 4.4).

use std::cmp::Ordering;

/// Largest number of pivots per unknown. A method that needs more has failed.
const PIVOTS_PER_UNKNOWN: usize = 20;

/// An entry is a pivot only if it exceeds this share of the largest entry of the entering column.
const PIVOT_SHARE: f64 = 1e-11;

/// The artificial variable counts as zero up to this share of the largest entry of `q`.
const LEVEL_SHARE: f64 = 1e-13;

/// Sizes of the changes of `q` that decide ties between rows, as shares of its largest entry: none at first. Contacts above each other are often exactly
/// critical, and rounding would decide ties.
const PERTURBATIONS: [f64; 3] = [0.0, 1e-11, 1e-9];

/// Largest violation of the three conditions by a solution, as a share of the largest entry of `q`.
const SOLVED: f64 = 1e-8;

/// Solves `w = M z + q` for `z`, with `M` given row by row. `None` if the method fails: after too many pivots, on a ray, or with numbers that solve
/// nothing. For the matrices of contact problems without given slips, a ray means that there is no solution.
pub fn lemke(m: &[f64], q: &[f64]) -> Option<Vec<f64>> {
    if q.iter().all(|value| *value >= 0.0) {
        return Some(vec![0.0; q.len()]);
    }
    let most = largest(q);
    let solution = |share: f64| pivoted(m, q, share * most).filter(|z| violation(m, q, z) <= SOLVED * most);
    PERTURBATIONS.into_iter().find_map(solution)
}

/// Largest violation of `w >= 0`, `z >= 0` and `w · z = 0`.
fn violation(m: &[f64], q: &[f64], z: &[f64]) -> f64 {
    let rows = m.chunks_exact(q.len()).zip(q);
    let w = rows.map(|(row, q)| q + row.iter().zip(z).map(|(m, z)| m * z).sum::<f64>());
    w.zip(z).fold(0.0, |most, (w, z)| most.max(w.min(*z).abs()))
}

/// The solution by pivots; what decides ties is `perturbation` times the number of a row, on top of `q`.
fn pivoted(m: &[f64], q: &[f64], perturbation: f64) -> Option<Vec<f64>> {
    let size = q.len();
    let mut tableau = Tableau::new(m, q, perturbation);
    // The artificial variable enters where q is lowest; its column is -1 throughout.
    let level = |row: &usize| tableau.at(*row, tableau.deciding());
    let mut leaving = (0..size).min_by(|a, b| level(a).total_cmp(&level(b)))?;
    let mut entering = tableau.artificial();
    for _ in 0..PIVOTS_PER_UNKNOWN * size {
        let left = tableau.exchange(leaving, entering);
        if left == tableau.artificial() {
            return Some(tableau.solution());
        }
        // The complement of the variable that has left enters.
        entering = if left < size { left + size } else { left - size };
        leaving = match tableau.leaving(entering) {
            Some(row) => row,
            // If the artificial variable is zero to rounding, the ray begins at a solution.
            None => return (tableau.artificial_level() <= LEVEL_SHARE * largest(q)).then(|| tableau.solution()),
        };
    }
    None
}

fn largest(q: &[f64]) -> f64 {
    q.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Rows of `[w | z | z_0 | q with ties decided | q]`, with the basic variable of each row.
struct Tableau {
    size: usize,
    width: usize,
    rows: Vec<f64>,
    basis: Vec<usize>,
}

impl Tableau {
    /// `w - M z - z_0 = q`
    fn new(m: &[f64], q: &[f64], perturbation: f64) -> Tableau {
        let size = q.len();
        let width = 2 * size + 3;
        let mut rows = vec![0.0; size * width];
        for row in 0..size {
            let own = &mut rows[row * width..(row + 1) * width];
            own[row] = 1.0;
            for column in 0..size {
                own[size + column] = -m[row * size + column];
            }
            own[2 * size] = -1.0;
            (own[2 * size + 1], own[2 * size + 2]) = (q[row] + perturbation * (row + 1) as f64, q[row]);
        }
        Tableau { size, width, rows, basis: (0..size).collect() }
    }

    fn artificial(&self) -> usize {
        2 * self.size
    }

    /// Column of the right-hand sides that decide which variable leaves.
    fn deciding(&self) -> usize {
        2 * self.size + 1
    }

    /// Column of the right-hand sides themselves.
    fn values(&self) -> usize {
        2 * self.size + 2
    }

    /// Value of the artificial variable.
    fn artificial_level(&self) -> f64 {
        let row = self.basis.iter().position(|variable| *variable == self.artificial());
        row.map_or(0.0, |row| self.at(row, self.values()))
    }

    fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row * self.width + column]
    }

    /// Makes a variable basic in a row. Returns the variable that was basic there before.
    fn exchange(&mut self, row: usize, entering: usize) -> usize {
        let (width, pivot) = (self.width, self.at(row, entering));
        self.rows[row * width..(row + 1) * width].iter_mut().for_each(|entry| *entry /= pivot);
        let own = self.rows[row * width..(row + 1) * width].to_vec();
        for (other, entries) in self.rows.chunks_exact_mut(width).enumerate().filter(|(other, _)| *other != row) {
            debug_assert_ne!(other, row);
            let factor = entries[entering];
            if factor != 0.0 {
                entries.iter_mut().zip(&own).for_each(|(entry, own)| *entry -= factor * own);
            }
        }
        std::mem::replace(&mut self.basis[row], entering)
    }

    /// Row that limits an entering variable. Ties go to the artificial variable, then are decided lexicographically. `None` if no row limits it.
    fn leaving(&self, entering: usize) -> Option<usize> {
        let largest = (0..self.size).fold(0.0f64, |most, row| most.max(self.at(row, entering).abs()));
        let is_pivot = |row: &usize| self.at(*row, entering) > PIVOT_SHARE * largest;
        let ratio = |row: usize, column: usize| self.at(row, column) / self.at(row, entering);
        let compare = |a: &usize, b: &usize| {
            let right = ratio(*a, self.deciding()).total_cmp(&ratio(*b, self.deciding()));
            let is_artificial = |row: usize| self.basis[row] == self.artificial();
            let by_column = |column: usize| ratio(*a, column).total_cmp(&ratio(*b, column));
            let lexicographic = || (0..self.size).map(by_column).find(|order| order.is_ne());
            right
                .then(is_artificial(*b).cmp(&is_artificial(*a)))
                .then_with(|| lexicographic().unwrap_or(Ordering::Equal))
        };
        (0..self.size).filter(is_pivot).min_by(compare)
    }

    fn solution(&self) -> Vec<f64> {
        let mut z = vec![0.0; self.size];
        for (row, &variable) in self.basis.iter().enumerate() {
            if (self.size..2 * self.size).contains(&variable) {
                z[variable - self.size] = self.at(row, self.values()).max(0.0);
            }
        }
        z
    }
}

#[cfg(test)]
mod tests {
    use super::{lemke, violation};

    #[test]
    fn positive_definite_problems_are_solved() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for size in 1..20 {
            let a: Vec<f64> = (0..size * size).map(|_| random()).collect();
            let q: Vec<f64> = (0..size).map(|_| random()).collect();
            let product = |i: usize, j: usize| (0..size).map(|k| a[i * size + k] * a[j * size + k]).sum::<f64>();
            let m: Vec<f64> = (0..size * size)
                .map(|at| product(at / size, at % size) + if at % (size + 1) == 0 { 0.1 } else { 0.0 })
                .collect();
            let z = lemke(&m, &q).expect("a positive definite problem has a solution");
            assert!(violation(&m, &q, &z) < 1e-10, "{size}");
        }
    }

    #[test]
    fn a_problem_without_solution_ends_on_a_ray() {
        assert_eq!(lemke(&[-1.0], &[-1.0]), None);
        assert_eq!(lemke(&[1.0], &[-2.0]), Some(vec![2.0]));
    }
}
