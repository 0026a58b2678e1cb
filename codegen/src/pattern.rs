//! Interface states, patterns, modes and rigid links: the combinatorics of rocking, as plain data.
//!
//! A column of `N` blocks has `N` interfaces, counted from the base. Each is closed or open on one of its
//! corners, so there are `3^N` patterns: one at rest, the others in mirror pairs, `(3^N - 1)/2` modes
//! (docs/book/model.md, section 2). This file lists and labels them; it knows no lengths, masses or equations.
//!
//! ```text
//!     s = +1: pivots on the right corner      s = -1: on the left corner
//!            ______                              ______
//!           /     /   θ > 0 is clockwise         \     \
//!          /_____/                                \_____\
//!     ____________.___                          ___.____________
//! ```

mod label;

pub use label::{ModeLabel, ModeNumber};

use smallvec::{SmallVec, smallvec};
use std::fmt;
use std::ops::{Deref, DerefMut};

/// State of one interface: the sign of the relative rotation `φ_i = θ_i - θ_{i-1}`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Interface {
    /// Open, pivoting on its right corner: `φ_i > 0`.
    Right,
    /// Closed: both blocks move as one.
    Closed,
    /// Open, pivoting on its left corner: `φ_i < 0`.
    Left,
}

impl Interface {
    /// The states in the order in which modes are numbered: `+1, 0, -1`.
    pub const ORDER: [Interface; 3] = [Interface::Right, Interface::Closed, Interface::Left];

    /// `+1`, `0` or `-1`.
    #[inline]
    pub fn sign(self) -> i8 {
        match self {
            Interface::Right => 1,
            Interface::Closed => 0,
            Interface::Left => -1,
        }
    }

    /// The state with the sign of `value`; zero is closed.
    #[inline]
    pub fn from_sign(value: i8) -> Interface {
        match value.signum() {
            1 => Interface::Right,
            0 => Interface::Closed,
            _ => Interface::Left,
        }
    }

    /// Whether the interface pivots on a corner.
    #[inline]
    pub fn is_open(self) -> bool {
        self != Interface::Closed
    }

    /// The state seen in a mirror.
    #[inline]
    pub fn mirror(self) -> Interface {
        Interface::from_sign(-self.sign())
    }
}

/// States of all interfaces of a column, base first; length `N`.
#[derive(Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Pattern(pub States);

// With a derived `Clone`, `clone_from` would not reuse the storage of the list.
impl Clone for Pattern {
    #[inline]
    fn clone(&self) -> Pattern {
        Pattern(self.0.clone())
    }

    fn clone_from(&mut self, other: &Pattern) {
        self.0.clone_from(&other.0);
    }
}

/// Owned list of interface states, which derefs to a slice. Up to 16 states need no allocation: patterns change with every impact.
#[derive(PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct States(SmallVec<[Interface; 16]>);

// Copies the states as one slice; the `Clone` of the list copies them one by one.
impl Clone for States {
    #[inline]
    fn clone(&self) -> States {
        States(SmallVec::from_slice(&self.0))
    }

    fn clone_from(&mut self, other: &States) {
        self.0.clear();
        self.0.extend_from_slice(&other.0);
    }
}

impl fmt::Debug for States {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Deref for States {
    type Target = [Interface];
    #[inline(always)]
    fn deref(&self) -> &[Interface] {
        &self.0
    }
}

impl DerefMut for States {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [Interface] {
        &mut self.0
    }
}

impl FromIterator<Interface> for States {
    #[inline]
    fn from_iter<I: IntoIterator<Item = Interface>>(states: I) -> States {
        States(states.into_iter().collect())
    }
}

impl<'l> IntoIterator for &'l States {
    type Item = &'l Interface;
    type IntoIter = std::slice::Iter<'l, Interface>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Pattern {
    /// The pattern at rest: every interface closed.
    pub fn rest(blocks: usize) -> Pattern {
        Pattern(States(smallvec![Interface::Closed; blocks]))
    }

    /// The pattern with these signs, base first.
    pub fn from_signs(signs: &[i8]) -> Pattern {
        Pattern(signs.iter().map(|&sign| Interface::from_sign(sign)).collect())
    }

    /// The pattern with these states, base first.
    #[inline]
    pub fn from_states(states: &[Interface]) -> Pattern {
        Pattern(States(SmallVec::from_slice(states)))
    }

    /// `+1`, `0`, `-1` per interface, base first.
    pub fn signs(&self) -> Vec<i8> {
        self.0.iter().map(|interface| interface.sign()).collect()
    }

    /// The pattern seen in a mirror.
    pub fn mirror(&self) -> Pattern {
        Pattern(self.0.iter().map(|interface| interface.mirror()).collect())
    }

    /// Reads `(+,0,-)`, as [`Pattern`] is displayed; `None` for anything else.
    pub fn parse(text: &str) -> Option<Pattern> {
        let signs = text.strip_prefix('(')?.strip_suffix(')')?.split(',');
        let state = |sign: &str| match sign {
            "+" => Some(Interface::Right),
            "0" => Some(Interface::Closed),
            "-" => Some(Interface::Left),
            _ => None,
        };
        signs.map(state).collect::<Option<_>>().map(Pattern)
    }

    /// Index of the lowest open interface, `None` at rest.
    #[inline]
    pub fn lowest_open(&self) -> Option<usize> {
        self.0.iter().position(|interface| interface.is_open())
    }

    /// Whether the pattern is the mirror image of the one that labels the mode: the lowest open interface is open on its left.
    #[inline]
    pub fn is_mirrored(&self) -> bool {
        self.lowest_open().is_some_and(|lowest| self.0[lowest] == Interface::Left)
    }

    /// Number of open interfaces: the degrees of freedom of the mode.
    #[inline]
    pub fn dof(&self) -> usize {
        self.0.iter().filter(|interface| interface.is_open()).count()
    }

    /// Which interfaces are open, whatever the side.
    pub fn linkage(&self) -> Linkage {
        Linkage { open: self.0.iter().map(|interface| interface.is_open()).collect() }
    }

    /// Mode `k.j` of docs/book/model.md, section 2, and whether this pattern is its mirror image; `None` at rest.
    ///
    /// ```
    /// use rocking_codegen::pattern::Pattern;
    /// let (label, mirrored) = Pattern::from_signs(&[-1, 0, 0]).mode().unwrap();
    /// assert_eq!((label.to_string().as_str(), mirrored), ("1.5", true));
    /// ```
    ///
    /// # Panics
    /// For more than 120 interfaces.
    #[inline]
    pub fn mode(&self) -> Option<(ModeLabel, bool)> {
        assert!(self.0.len() <= ModeNumber::MOST_INTERFACES, "{} interfaces", self.0.len());
        let lowest = self.lowest_open()?;
        let mirrored = self.is_mirrored();
        let above = self.0[lowest + 1..].iter();
        let above = above.map(|interface| if mirrored { interface.mirror() } else { *interface });
        Some((ModeLabel { lowest: lowest + 1, number: ModeNumber::of(above) }, mirrored))
    }
}

/// `(+,0,-)`, base first.
impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let signs: Vec<&str> = self.0.iter().map(|state| ["-", "0", "+"][(state.sign() + 1) as usize]).collect();
        write!(f, "({})", signs.join(","))
    }
}

/// The `(3^N - 1)/2` independent modes in the order of their labels, lazily: `N = 20` costs nothing until read.
///
/// # Panics
/// When read, for more than 120 blocks.
pub fn modes(blocks: usize) -> impl Iterator<Item = (ModeLabel, Pattern)> {
    (1..=blocks).flat_map(move |lowest| {
        let count = 3u64.saturating_pow((blocks - lowest) as u32);
        (1..=count).filter_map(move |number| {
            let label = ModeLabel { lowest, number: ModeNumber::new(number)? };
            Some((label, label.pattern(blocks)?))
        })
    })
}

/// Which interfaces are open, whatever the side. A column of `N` blocks has `2^N - 1` linkages that can move.
///
/// The side enters the equations of motion only through the pivot offsets `p_i = s_i c_i`, which are data.
/// All patterns of one linkage, mirror images among them, therefore share one derivation.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Linkage {
    /// Per interface, base first: is it open?
    pub open: Vec<bool>,
}

impl Linkage {
    /// The linkage whose interface `i` (from zero) is open where bit `i` of `mask` is set.
    ///
    /// # Panics
    /// If there are more blocks than bits.
    pub fn from_mask(blocks: usize, mask: usize) -> Linkage {
        assert!(blocks <= usize::BITS as usize, "{blocks} blocks");
        Linkage { open: (0..blocks).map(|interface| mask >> interface & 1 == 1).collect() }
    }

    /// Number of blocks of the column.
    pub fn blocks(&self) -> usize {
        self.open.len()
    }

    /// Degrees of freedom: the number of open interfaces.
    pub fn dof(&self) -> usize {
        self.open.iter().filter(|&&open| open).count()
    }

    /// The rigid link that each block belongs to, base first: 0 moves with the ground, `a` has the free angle `a`.
    pub fn link_of_block(&self) -> Vec<usize> {
        let mut link = 0;
        self.open
            .iter()
            .map(|&open| {
                link += usize::from(open);
                link
            })
            .collect()
    }
}

/// The moving linkages of a column: masks `1 .. 2^N`, in order.
///
/// # Panics
/// If there are as many blocks as bits, or more.
pub fn linkages(blocks: usize) -> impl Iterator<Item = Linkage> {
    assert!(blocks < usize::BITS as usize, "{blocks} blocks");
    (1..1usize << blocks).map(move |mask| Linkage::from_mask(blocks, mask))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_half_of_three_to_the_n_less_one_modes() {
        let counts: Vec<usize> = (1..=8).map(|blocks| modes(blocks).count()).collect();
        assert_eq!(counts, [1, 4, 13, 40, 121, 364, 1093, 3280]);
    }

    #[test]
    fn labels_follow_the_paper() {
        let named = |text: &str| ModeLabel::parse(text).and_then(|label| label.pattern(3)).map(|p| p.to_string());
        assert_eq!(named("1.5").as_deref(), Some("(+,0,0)"));
        assert_eq!(named("2.2").as_deref(), Some("(0,+,0)"));
        assert_eq!(named("3.1").as_deref(), Some("(0,0,+)"));
        assert_eq!(named("1.1").as_deref(), Some("(+,+,+)"));
        assert_eq!(named("3.2"), None);
        assert_eq!(named("4.1"), None);
    }

    #[test]
    fn label_and_pattern_are_inverse_and_a_mirror_keeps_the_label() {
        for (label, pattern) in modes(5) {
            assert_eq!(pattern.mode(), Some((label, false)));
            assert_eq!(pattern.mirror().mode(), Some((label, true)));
            assert_eq!(pattern.mirror().mirror(), pattern);
            assert_eq!(Pattern::parse(&pattern.to_string()), Some(pattern));
        }
    }

    #[test]
    fn closed_interfaces_join_blocks_to_links() {
        assert_eq!(Linkage::from_mask(5, 0b01010).link_of_block(), [0, 1, 1, 2, 2]);
        assert_eq!(linkages(4).map(|linkage| linkage.dof()).sum::<usize>(), 4 * 8);
    }
}
