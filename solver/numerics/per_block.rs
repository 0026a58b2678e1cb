//! Lists with one entry per block, interface or link.
//!
//! Contact problems are many and small, and most columns have few blocks: the code that handles them is compiled for each [`Size`], where
//! loops have known lengths and nothing is allocated.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use smallvec::SmallVec;
use std::fmt;
use std::ops::{Deref, DerefMut};

/// Largest length of a list that allocates nothing. A larger limit would take more of the stack for every list.
const INLINE_LENGTH: usize = 6;

/// A list with at most one entry per block, interface or link, base first: a slice that owns its entries, without allocation for
/// columns of up to six blocks. A copy of a short list copies its storage as it is, without a loop.
pub struct PerBlock<T: Copy>(Storage<T>);

#[derive(Clone)]
enum Storage<T: Copy> {
    /// The first `length` entries are valid; the rest is padding, copies of one of them.
    Inline { entries: [T; INLINE_LENGTH], length: InlineLength },
    /// An empty list, or a long one.
    Heap(Vec<T>),
}

/// Number of entries of a short list. The compiler knows its range: slices of the entries need no check.
#[derive(Clone, Copy)]
enum InlineLength {
    One = 1,
    Two,
    Three,
    Four,
    Five,
    Six,
}

impl InlineLength {
    /// `None` for an empty list and for a long one.
    #[inline(always)]
    fn of(length: usize) -> Option<InlineLength> {
        match length {
            1 => Some(InlineLength::One),
            2 => Some(InlineLength::Two),
            3 => Some(InlineLength::Three),
            4 => Some(InlineLength::Four),
            5 => Some(InlineLength::Five),
            INLINE_LENGTH => Some(InlineLength::Six),
            _ => None,
        }
    }
}

impl<T: Copy> PerBlock<T> {
    /// An empty list.
    #[inline]
    pub fn new() -> PerBlock<T> {
        PerBlock(Storage::Heap(Vec::new()))
    }

    /// A list of `length` equal entries.
    #[inline]
    pub fn filled(entry: T, length: usize) -> PerBlock<T> {
        PerBlock(match InlineLength::of(length) {
            Some(length) => Storage::Inline { entries: [entry; INLINE_LENGTH], length },
            None => Storage::Heap(vec![entry; length]),
        })
    }

    /// A copy of a slice.
    #[inline]
    pub fn from_slice(entries: &[T]) -> PerBlock<T> {
        PerBlock(match InlineLength::of(entries.len()) {
            // A copy of known length, without a loop.
            Some(length) => {
                let last = entries.len() - 1;
                Storage::Inline { entries: std::array::from_fn(|index| entries[index.min(last)]), length }
            }
            None => Storage::Heap(entries.to_vec()),
        })
    }

    /// Appends an entry.
    pub fn push(&mut self, entry: T) {
        match &mut self.0 {
            Storage::Inline { entries, length } => match InlineLength::of(*length as usize + 1) {
                Some(longer) => {
                    entries[*length as usize] = entry;
                    *length = longer;
                }
                None => {
                    let mut entries = entries.to_vec();
                    entries.push(entry);
                    self.0 = Storage::Heap(entries);
                }
            },
            Storage::Heap(entries) if entries.is_empty() => *self = PerBlock::filled(entry, 1),
            Storage::Heap(entries) => entries.push(entry),
        }
    }

    /// Removes all entries.
    pub fn clear(&mut self) {
        *self = PerBlock::new();
    }
}

impl<T: Copy> Clone for PerBlock<T> {
    #[inline]
    fn clone(&self) -> PerBlock<T> {
        PerBlock(self.0.clone())
    }

    #[inline]
    fn clone_from(&mut self, other: &PerBlock<T>) {
        match (&mut self.0, &other.0) {
            (Storage::Inline { entries, length }, Storage::Inline { entries: others, length: other_length }) => {
                (*entries, *length) = (*others, *other_length);
            }
            (Storage::Heap(entries), Storage::Heap(others)) => entries.clone_from(others),
            (storage, other) => *storage = other.clone(),
        }
    }
}

impl<T: Copy> Default for PerBlock<T> {
    fn default() -> PerBlock<T> {
        PerBlock::new()
    }
}

impl<T: Copy> Deref for PerBlock<T> {
    type Target = [T];
    #[inline(always)]
    fn deref(&self) -> &[T] {
        match &self.0 {
            Storage::Inline { entries, length } => &entries[..*length as usize],
            Storage::Heap(entries) => entries,
        }
    }
}

impl<T: Copy> DerefMut for PerBlock<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        match &mut self.0 {
            Storage::Inline { entries, length } => &mut entries[..*length as usize],
            Storage::Heap(entries) => entries,
        }
    }
}

impl<T: Copy + fmt::Debug> fmt::Debug for PerBlock<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<T: Copy + PartialEq> PartialEq for PerBlock<T> {
    fn eq(&self, other: &PerBlock<T>) -> bool {
        **self == **other
    }
}

impl<T: Copy + Serialize> Serialize for PerBlock<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self[..].serialize(serializer)
    }
}

impl<'de, T: Copy + Deserialize<'de>> Deserialize<'de> for PerBlock<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<PerBlock<T>, D::Error> {
        Vec::deserialize(deserializer).map(|entries| PerBlock::from_slice(&entries))
    }
}

impl<T: Copy> FromIterator<T> for PerBlock<T> {
    fn from_iter<I: IntoIterator<Item = T>>(entries: I) -> PerBlock<T> {
        let mut entries = entries.into_iter();
        let Some(first) = entries.next() else { return PerBlock::new() };
        let (mut list, mut length) = ([first; INLINE_LENGTH], 1);
        while let Some(entry) = entries.next() {
            if length == INLINE_LENGTH {
                return PerBlock(Storage::Heap(list.into_iter().chain([entry]).chain(entries).collect()));
            }
            list[length] = entry;
            length += 1;
        }
        let length = InlineLength::of(length).expect("one to six entries");
        PerBlock(Storage::Inline { entries: list, length })
    }
}

impl<'l, T: Copy> IntoIterator for &'l PerBlock<T> {
    type Item = &'l T;
    type IntoIter = std::slice::Iter<'l, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// The largest magnitude of some entries.
#[inline(always)]
pub(crate) fn largest(entries: &[f64]) -> f64 {
    entries.iter().fold(0.0, |largest, entry| if entry.abs() > largest { entry.abs() } else { largest })
}

/// A table with a row per block or link and a column per link, row by row.
#[derive(Clone, Debug)]
pub struct Square<T>(SmallVec<[T; INLINE_LENGTH * INLINE_LENGTH]>);

impl<T> Deref for Square<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> DerefMut for Square<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

/// How many blocks a column has: known when compiled, or not.
pub trait Size: Copy {
    /// A list with one entry per block, interface or link. Entries of links that do not exist keep their fill value.
    type List<T: Copy>: Deref<Target = [T]> + DerefMut + Clone;
    /// A table with a row per block or link and a column per link.
    type Table<T: Copy>: Deref<Target = [T]> + DerefMut + Clone;

    /// Number of blocks.
    fn blocks(self) -> usize;

    /// Number of links that loops run over, which is also the number of columns of a table. It is `moving`, the number of links that move. A size
    /// known at compile time returns its number of blocks instead, so that no loop branches on `moving`.
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
    type List<T: Copy> = PerBlock<T>;
    type Table<T: Copy> = Square<T>;

    fn blocks(self) -> usize {
        self.0
    }

    fn links(self, moving: usize) -> usize {
        moving
    }

    fn list<T: Copy>(self, fill: T) -> PerBlock<T> {
        PerBlock::filled(fill, self.0)
    }

    fn table<T: Copy>(self, columns: usize, fill: T) -> Square<T> {
        Square(SmallVec::from_elem(fill, self.0 * columns))
    }
}

/// Evaluates an expression with the size of a column of this many blocks: compiled for each number up to five, and once for any number.
macro_rules! for_size {
    ($blocks:expr, $size:ident => $body:expr) => {
        match $blocks {
            1 => for_size!(@known 1, $size => $body),
            2 => for_size!(@known 2, $size => $body),
            3 => for_size!(@known 3, $size => $body),
            4 => for_size!(@known 4, $size => $body),
            5 => for_size!(@known 5, $size => $body),
            blocks => {
                let $size = $crate::numerics::per_block::Any(blocks);
                $body
            }
        }
    };
    (@known $n:literal, $size:ident => $body:expr) => {{
        let $size = $crate::numerics::per_block::Known::<$n>;
        $body
    }};
}
pub(crate) use for_size;
