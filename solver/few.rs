//! Short lists: one entry per block, link or interface, on the stack where there are few of them.

use smallvec::SmallVec;

/// Columns of up to this many blocks allocate nothing in contact problems. More costs every short list its room on the stack.
const FEW: usize = 6;

/// A list as long as the column has blocks, links or interfaces.
pub type Few<T> = SmallVec<[T; FEW]>;

/// A table of blocks or links against links, row by row.
pub type Square<T> = SmallVec<[T; FEW * FEW]>;
