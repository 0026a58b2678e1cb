//! Labels of modes: `k.j`, numbers of any size.

use super::{Interface, Pattern};
use std::fmt;

/// The name `k.j` of a mode: `k` its lowest open interface, `j` the number of the states above it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ModeLabel {
    /// Lowest open interface, from 1.
    pub lowest: usize,
    /// Number among the `3^(N-k)` states of the interfaces above.
    pub number: ModeNumber,
}

impl ModeLabel {
    /// The label `k.j` of a text; `None` if the text is not two whole numbers above zero joined by a point.
    pub fn parse(text: &str) -> Option<ModeLabel> {
        let (lowest, number) = text.split_once('.').filter(|(lowest, _)| !lowest.starts_with('+'))?;
        let label = ModeLabel { lowest: lowest.parse().ok()?, number: ModeNumber::parse(number)? };
        (label.lowest > 0).then_some(label)
    }

    /// The independent pattern with this label in a column of `blocks` blocks; `None` if there is no such mode.
    ///
    /// # Panics
    /// For more than 120 blocks.
    pub fn pattern(self, blocks: usize) -> Option<Pattern> {
        if self.lowest == 0 || self.lowest > blocks {
            return None;
        }
        let mut states = Pattern::rest(blocks).0;
        states[self.lowest - 1] = Interface::Right;
        for (place, state) in states[self.lowest..].iter_mut().rev().enumerate() {
            *state = self.number.state(place);
        }
        let pattern = Pattern(states);
        (pattern.mode()?.0 == self).then_some(pattern)
    }
}

impl fmt::Display for ModeLabel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.lowest, self.number)
    }
}

/// Number of a mode among those with the same lowest open interface, from 1. It needs more than 64 bits where more than 40 interfaces are above.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ModeNumber {
    /// The number less one, a digit from 0 to 2 for each interface: in groups of [`DIGITS`] digits, the most significant group first.
    groups: [u64; GROUPS],
}

/// Digits of base three in a group: as many as fit into 64 bits.
const DIGITS: usize = 40;

/// `3^DIGITS`
const BASE: u64 = 3u64.pow(DIGITS as u32);

/// Groups of a number.
const GROUPS: usize = 3;

/// Power of ten by which a number is divided to be written in decimals.
const DECIMALS: u64 = 1_000_000_000_000_000_000;

impl ModeNumber {
    /// Number of interfaces whose modes have numbers.
    pub(super) const MOST_INTERFACES: usize = GROUPS * DIGITS;

    /// A number; `None` for zero.
    pub fn new(number: u64) -> Option<ModeNumber> {
        let rank = number.checked_sub(1)?;
        Some(ModeNumber { groups: [0, rank / BASE, rank % BASE] })
    }

    /// The number of these states, base first: open on the right, closed, open on the left count 0, 1, 2.
    #[inline]
    pub(super) fn of(states: impl ExactSizeIterator<Item = Interface>) -> ModeNumber {
        let (mut groups, count) = ([0; GROUPS], states.len());
        for (index, state) in states.enumerate() {
            let group = &mut groups[GROUPS - 1 - (count - 1 - index) / DIGITS];
            *group = 3 * *group + (1 - i64::from(state.sign())) as u64;
        }
        ModeNumber { groups }
    }

    /// State of the interface at a place, counted from the top interface of the column.
    fn state(self, place: usize) -> Interface {
        let group = (GROUPS - 1).checked_sub(place / DIGITS).map_or(0, |group| self.groups[group]);
        Interface::ORDER[(group / 3u64.pow((place % DIGITS) as u32) % 3) as usize]
    }

    /// Reads a whole number; `None` for zero, for text that is no number, and for more than 120 interfaces.
    fn parse(text: &str) -> Option<ModeNumber> {
        if text.is_empty() || !text.bytes().all(|digit| digit.is_ascii_digit()) {
            return None;
        }
        let mut groups = [0; GROUPS];
        for digit in text.bytes() {
            let mut carry = u128::from(digit - b'0');
            for group in groups.iter_mut().rev() {
                let sum = 10 * u128::from(*group) + carry;
                (*group, carry) = ((sum % u128::from(BASE)) as u64, sum / u128::from(BASE));
            }
            if carry > 0 {
                return None;
            }
        }
        // One less: what is borrowed comes from the next group that is not zero.
        for group in groups.iter_mut().rev() {
            match group.checked_sub(1) {
                Some(less) => {
                    *group = less;
                    return Some(ModeNumber { groups });
                }
                None => *group = BASE - 1,
            }
        }
        None
    }
}

impl fmt::Display for ModeNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut groups = self.groups;
        for group in groups.iter_mut().rev() {
            *group = (*group + 1) % BASE;
            if *group > 0 {
                break;
            }
        }
        // Remainders of the division by a power of ten are the decimals, the least significant ones first.
        let mut parts = Vec::new();
        loop {
            let mut remainder = 0;
            for group in &mut groups {
                let dividend = remainder * u128::from(BASE) + u128::from(*group);
                (*group, remainder) = ((dividend / u128::from(DECIMALS)) as u64, dividend % u128::from(DECIMALS));
            }
            parts.push(remainder);
            if groups == [0; GROUPS] {
                break;
            }
        }
        let mut parts = parts.into_iter().rev();
        write!(f, "{}", parts.next().unwrap_or_default())?;
        parts.try_for_each(|part| write!(f, "{part:018}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of the all-right to the all-left pattern, by Python's whole numbers.
    #[test]
    fn numbers_of_a_hundred_blocks_are_exact() {
        let signs = |above: i8| Pattern::from_signs(&[vec![1], vec![above; 99]].concat());
        let label = |pattern: &Pattern| pattern.mode().expect("it is open").0;
        assert_eq!(label(&signs(1)).to_string(), "1.1");
        assert_eq!(label(&signs(-1)).to_string(), "1.171792506910670443678820376588540424234035840667");
        assert_eq!(label(&signs(0)).to_string(), "1.85896253455335221839410188294270212117017920334");
        for pattern in [signs(1), signs(-1), signs(0)] {
            let read = ModeLabel::parse(&label(&pattern).to_string()).expect("a label");
            assert_eq!((read, read.pattern(100)), (label(&pattern), Some(pattern)));
        }
        // 60 blocks that lean as one.
        let leaning = Pattern::from_signs(&[vec![1], vec![0; 59]].concat());
        assert_eq!(label(&leaning).to_string(), "1.7065193045869367252382405534");
    }

    #[test]
    fn a_number_beyond_those_of_a_column_has_no_pattern() {
        assert!(ModeLabel::parse("1.9").is_some_and(|label| label.pattern(3).is_some()));
        assert!(ModeLabel::parse("1.10").is_some_and(|label| label.pattern(3).is_none()));
        assert!(
            ["1.0", "0.1", "1.", "1.-1", "1.+1", "+1.1", ".1", "1"].iter().all(|text| ModeLabel::parse(text).is_none())
        );
        assert_eq!(ModeLabel::parse(&format!("1.{}", "9".repeat(60))), None);
    }
}
