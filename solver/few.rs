//! Short lists: one entry per block, link or interface.
//!
//! Contact problems are many and small, and most columns have few blocks: what handles them is compiled for each [`Size`], where
//! loops have known lengths and nothing is allocated.

use smallvec::SmallVec;
use std::ops::{Deref, DerefMut};

/// Lists of up to this length allocate nothing. More costs every list its room on the stack.
const FEW: usize = 6;

/// A list as long as the column has blocks, links or interfaces, or shorter.
pub type Few<T> = SmallVec<[T; FEW]>;

/// A table of blocks or links against links, row by row.
pub type Square<T> = SmallVec<[T; FEW * FEW]>;

/// How many blocks a column has: known when compiled, or not.
pub trait Size: Copy {
    /// One entry per block or interface, or per link, those that there are not left at what they were filled with.
    type List<T: Copy>: Deref<Target = [T]> + DerefMut + Clone;
    /// Rows of blocks or links against columns of links.
    type Table<T: Copy>: Deref<Target = [T]> + DerefMut + Clone;

    /// Number of blocks.
    fn blocks(self) -> usize;

    /// Columns of a table, and links that loops run over, where so many move: all that there could be where that number is known, so
    /// that there is nothing to branch on.
    fn links(self, moving: usize) -> usize;

    /// A list with an entry per block.
    fn list<T: Copy>(self, fill: T) -> Self::List<T>;

    /// A table with a row per block and this number of columns.
    fn table<T: Copy>(self, columns: usize, fill: T) -> Self::Table<T>;

    /// A list with the first entries of another one, one per block.
    #[inline(always)]
    fn copied<T: Copy>(self, entries: &[T]) -> Self::List<T> {
        let mut list = self.list(entries[0]);
        list.copy_from_slice(&entries[..self.blocks()]);
        list
    }

    /// A list made entry by entry.
    #[inline(always)]
    fn list_of<T: Copy + Default>(self, entry: impl Fn(usize) -> T) -> Self::List<T> {
        let mut list = self.list(T::default());
        for (index, place) in list[..self.blocks()].iter_mut().enumerate() {
            *place = entry(index);
        }
        list
    }
}

/// A number of blocks known when compiled.
#[derive(Clone, Copy, Debug)]
pub struct Known<const N: usize>;

/// Any number of blocks.
#[derive(Clone, Copy, Debug)]
pub struct Any(pub usize);

/// An array as a list.
#[derive(Clone, Copy, Debug)]
pub struct Array<T, const N: usize>([T; N]);

/// An array of arrays as a table.
#[derive(Clone, Copy, Debug)]
pub struct Grid<T, const N: usize>([[T; N]; N]);

impl<T, const N: usize> Deref for Array<T, N> {
    type Target = [T];
    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T, const N: usize> DerefMut for Array<T, N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

impl<T, const N: usize> Deref for Grid<T, N> {
    type Target = [T];
    #[inline(always)]
    fn deref(&self) -> &[T] {
        self.0.as_flattened()
    }
}

impl<T, const N: usize> DerefMut for Grid<T, N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        self.0.as_flattened_mut()
    }
}

impl<const N: usize> Size for Known<N> {
    type List<T: Copy> = Array<T, N>;
    type Table<T: Copy> = Grid<T, N>;

    #[inline(always)]
    fn blocks(self) -> usize {
        N
    }

    #[inline(always)]
    fn links(self, _: usize) -> usize {
        N
    }

    #[inline(always)]
    fn list<T: Copy>(self, fill: T) -> Array<T, N> {
        Array([fill; N])
    }

    #[inline(always)]
    fn table<T: Copy>(self, _: usize, fill: T) -> Grid<T, N> {
        Grid([[fill; N]; N])
    }
}

impl Size for Any {
    type List<T: Copy> = Few<T>;
    type Table<T: Copy> = Square<T>;

    fn blocks(self) -> usize {
        self.0
    }

    fn links(self, moving: usize) -> usize {
        moving
    }

    fn list<T: Copy>(self, fill: T) -> Few<T> {
        Few::from_elem(fill, self.0)
    }

    fn table<T: Copy>(self, columns: usize, fill: T) -> Square<T> {
        Square::from_elem(fill, self.0 * columns)
    }
}

/// An expression with the size of a column of so many blocks: compiled for up to five of them, and for any.
macro_rules! for_size {
    ($blocks:expr, $size:ident => $body:expr) => {
        match $blocks {
            1 => for_size!(@known 1, $size => $body),
            2 => for_size!(@known 2, $size => $body),
            3 => for_size!(@known 3, $size => $body),
            4 => for_size!(@known 4, $size => $body),
            5 => for_size!(@known 5, $size => $body),
            blocks => {
                let $size = $crate::few::Any(blocks);
                $body
            }
        }
    };
    (@known $n:literal, $size:ident => $body:expr) => {{
        let $size = $crate::few::Known::<$n>;
        $body
    }};
}
pub(crate) use for_size;
