//! Cells of equal class as polygons. The order of painting is such that no polygon needs a hole.
//!
//! Cells that share an edge and a class make a region. The whole inside of its outer edge is filled; regions within it are painted
//! over it later. Regions of equal nesting depth do not overlap; those of one class are painted together, a polygon each. Where two
//! of equal depth meet at an edge, a gap of rounding can therefore show only the region around both.

use std::collections::BTreeMap;

/// A corner of cells: columns from the left, rows from the bottom.
pub type Corner = [usize; 2];

/// Regions of one class that do not overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer<C> {
    /// Class of the regions.
    pub class: C,
    /// Outer edge of each region: its corners, anticlockwise.
    pub outlines: Vec<Vec<Corner>>,
}

/// Right, up, left, down.
const STEPS: [[isize; 2]; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// The layers in the order in which they are painted. `cells` has one row after the other, the lowest first.
pub fn layers<C: Copy + PartialEq>(cells: &[C], columns: usize) -> Vec<Layer<C>> {
    let rows = cells.len() / columns;
    let (region_of, first_cells) = regions(cells, columns);
    let mut outlines: Vec<(usize, Vec<Corner>, Vec<usize>)> = Vec::new();
    for (region, first) in first_cells.iter().enumerate() {
        let outline = outline(&region_of, [columns, rows], region, *first);
        let inside = inside(&outline, columns);
        outlines.push((*first, outline, inside));
    }
    // A region that holds another one has more cells inside.
    outlines.sort_by_key(|(first, _, inside)| (usize::MAX - inside.len(), *first));
    let mut depth_at = vec![0usize; cells.len()];
    let mut layers: BTreeMap<(usize, usize), Layer<C>> = BTreeMap::new();
    for (first, outline, inside) in outlines {
        let depth = depth_at[first];
        inside.into_iter().for_each(|cell| depth_at[cell] = depth + 1);
        let class = cells[first];
        let same = layers.range((depth, 0)..(depth + 1, 0)).find(|(_, layer)| layer.class == class).map(|(at, _)| *at);
        let at = same.unwrap_or((depth, layers.len()));
        layers.entry(at).or_insert_with(|| Layer { class, outlines: Vec::new() }).outlines.push(outline);
    }
    layers.into_values().collect()
}

/// Region of each cell, and first cell of each region: the leftmost cell of the region's lowest row.
fn regions<C: Copy + PartialEq>(cells: &[C], columns: usize) -> (Vec<usize>, Vec<usize>) {
    let mut region_of = vec![usize::MAX; cells.len()];
    let mut first_cells = Vec::new();
    for first in 0..cells.len() {
        if region_of[first] != usize::MAX {
            continue;
        }
        let mut due = vec![first];
        region_of[first] = first_cells.len();
        while let Some(cell) = due.pop() {
            let column = cell % columns;
            let neighbours = [
                (column > 0).then(|| cell - 1),
                (column + 1 < columns).then_some(cell + 1),
                cell.checked_sub(columns),
                Some(cell + columns).filter(|above| *above < cells.len()),
            ];
            for neighbour in neighbours.into_iter().flatten() {
                if region_of[neighbour] == usize::MAX && cells[neighbour] == cells[first] {
                    region_of[neighbour] = first_cells.len();
                    due.push(neighbour);
                }
            }
        }
        first_cells.push(first);
    }
    (region_of, first_cells)
}

/// The outer edge of a region, anticlockwise from the lower left corner of its first cell. Cells that share a corner only are
/// apart.
fn outline(region_of: &[usize], [columns, rows]: [usize; 2], region: usize, first: usize) -> Vec<Corner> {
    let start = [first % columns, first / columns];
    let is_inside = |[x, y]: Corner, [right, up]: [isize; 2]| {
        let cell = [x.checked_add_signed(right), y.checked_add_signed(up)];
        matches!(cell, [Some(x), Some(y)] if x < columns && y < rows && region_of[y * columns + x] == region)
    };
    // The cells ahead of a corner in the direction of each step: left and right.
    let ahead = [[[0, 0], [0, -1]], [[-1, 0], [0, 0]], [[-1, -1], [-1, 0]], [[0, -1], [-1, -1]]];
    let mut corners = vec![start];
    let (mut at, mut step) = (start, 0);
    loop {
        at = [0, 1].map(|axis| at[axis].checked_add_signed(STEPS[step][axis]).expect("an edge of the grid at most"));
        if at == start {
            return corners;
        }
        let [left, right] = ahead[step].map(|cell| is_inside(at, cell));
        // The region stays on the left. No cell ahead on the left: the edge turns left (a cell ahead on the right touches at the corner only). Cells ahead on
        // both sides: it turns right.
        let turned = match (left, right) {
            (false, _) => (step + 1) % 4,
            (true, true) => (step + 3) % 4,
            (true, false) => step,
        };
        if turned != step {
            corners.push(at);
            step = turned;
        }
    }
}

/// The cells inside an outline.
fn inside(outline: &[Corner], columns: usize) -> Vec<usize> {
    let mut crossings: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let ends = outline.iter().zip(outline.iter().cycle().skip(1));
    for (from, to) in ends.filter(|(from, to)| from[0] == to[0]) {
        (from[1].min(to[1])..from[1].max(to[1])).for_each(|row| crossings.entry(row).or_default().push(from[0]));
    }
    let mut cells = Vec::new();
    for (row, mut places) in crossings {
        places.sort_unstable();
        places.chunks_exact(2).for_each(|pair| cells.extend((pair[0]..pair[1]).map(|column| row * columns + column)));
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The class of each cell after all layers are painted.
    fn painted(layers: &[Layer<u8>], count: usize, columns: usize) -> Vec<Option<u8>> {
        let mut cells = vec![None; count];
        for layer in layers {
            let mut fresh = vec![true; count];
            for cell in layer.outlines.iter().flat_map(|outline| inside(outline, columns)) {
                assert!(std::mem::take(&mut fresh[cell]), "polygons of a layer do not overlap");
                cells[cell] = Some(layer.class);
            }
        }
        cells
    }

    #[test]
    fn a_ring_is_painted_before_what_it_holds() {
        let cells = [1, 1, 1, 1, 0, 1, 1, 1, 1u8];
        let layers = layers(&cells, 3);
        let square = |low: usize, high: usize| vec![[low, low], [high, low], [high, high], [low, high]];
        assert_eq!(layers[0], Layer { class: 1, outlines: vec![square(0, 3)] });
        assert_eq!(layers[1..], [Layer { class: 0, outlines: vec![square(1, 2)] }]);
    }

    #[test]
    fn what_is_painted_is_what_was_given() {
        let mut seed = 1u64;
        for round in 0..300 {
            let (columns, rows, classes) = (1 + round % 13, 1 + round % 7, 2 + round as u64 % 4);
            let mut random = || {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                ((seed >> 33) % classes) as u8
            };
            let cells: Vec<u8> = (0..columns * rows).map(|_| random()).collect();
            let shown = painted(&layers(&cells, columns), cells.len(), columns);
            assert!(
                cells.iter().zip(&shown).all(|(cell, shown)| *shown == Some(*cell)),
                "{cells:?}, {columns} columns"
            );
        }
    }
}
