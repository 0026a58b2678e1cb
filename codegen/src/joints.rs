//! States of interfaces with friction, as plain data: ten of each interface (docs/book/model.md, section 13).
//!
//! ```text
//! 0   0>  0<         closed: sticks, slides to the right, to the left
//! +   +>  +<         on the right corner: the same
//! -   ->  -<         on the left corner: the same
//! f                  free
//! ```
//!
//! A corner that slides is a corner of the upper block, on the face below. With `u` after the state (`+>u`), the upper face slides on a corner
//! of the block below, with other equations. Combinations of states are written like patterns, base first: `(+>,0<,f)`.

use crate::pattern::{Interface, Linkage, Pattern};
use std::fmt;

/// How a contact resists sliding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Slip {
    /// No relative motion along the face.
    Sticks,
    /// The upper block moves to the right along the face.
    Right,
    /// The upper block moves to the left.
    Left,
}

/// The face along which a corner slides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Carrier {
    /// The upper block's corner slides on the face below.
    Lower,
    /// The upper face slides on the corner of the block below.
    Upper,
}

/// State of an interface with friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Joint {
    /// In contact: closed, or open on a corner.
    Contact(Interface, Slip, Carrier),
    /// In flight.
    Free,
}

impl Joint {
    /// The ten states, in the order of their notation above.
    pub fn all() -> Vec<Joint> {
        let interfaces = [Interface::Closed, Interface::Right, Interface::Left].into_iter();
        let contact = |interface| {
            [Slip::Sticks, Slip::Right, Slip::Left].map(|slip| Joint::Contact(interface, slip, Carrier::Lower))
        };
        interfaces.flat_map(contact).chain([Joint::Free]).collect()
    }

    /// Whether the interface has a free angle: true unless it is closed.
    pub fn has_angle(self) -> bool {
        !matches!(self, Joint::Contact(Interface::Closed, ..))
    }

    /// Number of free translations: none if the interface sticks, one if it slides, two in flight.
    pub fn translations(self) -> usize {
        match self {
            Joint::Contact(_, Slip::Sticks, _) => 0,
            Joint::Contact(..) => 1,
            Joint::Free => 2,
        }
    }

    fn parse(text: &str) -> Option<Joint> {
        if text == "f" {
            return Some(Joint::Free);
        }
        let (text, carrier) = match text.strip_suffix('u') {
            Some(rest) => (rest, Carrier::Upper),
            None => (text, Carrier::Lower),
        };
        let (text, slip) = match (text.strip_suffix('>'), text.strip_suffix('<')) {
            (Some(rest), _) => (rest, Slip::Right),
            (_, Some(rest)) => (rest, Slip::Left),
            _ => (text, Slip::Sticks),
        };
        let interface = match text {
            "+" => Interface::Right,
            "0" => Interface::Closed,
            "-" => Interface::Left,
            _ => return None,
        };
        // The suffix `u` is valid only after a corner that slides: in other states the carrying face makes no difference.
        let is_plain = carrier == Carrier::Lower || (interface.is_open() && slip != Slip::Sticks);
        is_plain.then_some(Joint::Contact(interface, slip, carrier))
    }
}

impl fmt::Display for Joint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Joint::Contact(interface, slip, carrier) = self else { return f.write_str("f") };
        let sign = ["-", "0", "+"][(interface.sign() + 1) as usize];
        let slip = match slip {
            Slip::Sticks => "",
            Slip::Right => ">",
            Slip::Left => "<",
        };
        write!(f, "{sign}{slip}{}", if *carrier == Carrier::Upper { "u" } else { "" })
    }
}

/// Why a text is no combination of states.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointsError {
    /// No list in parentheses.
    NoList,
    /// An entry that is no state: its number from 1, and its text.
    NoState(usize, String),
    /// The ground has no corner for the upper face to slide on.
    CornerOfTheGround,
}

impl fmt::Display for JointsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const STATES: &str = "states are 0, 0>, 0<, +, +>, +<, -, ->, -< and f; u after a corner that slides (+>u) is for an upper face on the corner below";
        match self {
            JointsError::NoList => {
                write!(f, "write a list of states in parentheses, base first, like \"(+>,0)\"; {STATES}")
            }
            JointsError::NoState(number, text) => write!(f, "`{text}` is no state of interface {number}; {STATES}"),
            JointsError::CornerOfTheGround => {
                write!(f, "the ground has no corner for interface 1 to slide on; leave the u out")
            }
        }
    }
}

impl std::error::Error for JointsError {}

/// States of all interfaces of a column, base first.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Joints(pub Vec<Joint>);

impl Joints {
    /// Reads `(+>,0,f)`, as [`Joints`] are displayed.
    ///
    /// ```
    /// use rocking_codegen::joints::Joints;
    /// let joints = Joints::parse("(+>, 0<, f)").unwrap();
    /// assert_eq!((joints.angles(), joints.translations()), (2, 4));
    /// assert!(Joints::parse("(+,up)").unwrap_err().to_string().starts_with("`up` is no state of interface 2"));
    /// ```
    ///
    /// # Errors
    /// [`JointsError`] if the text is no list, an entry is no state, or interface 1 slides on a corner of the ground.
    pub fn parse(text: &str) -> Result<Joints, JointsError> {
        // Figures have the minus sign of typography.
        let text = &text.replace('−', "-");
        let list = text.trim().strip_prefix('(').and_then(|text| text.strip_suffix(')')).ok_or(JointsError::NoList)?;
        let entry = |(index, text): (usize, &str)| {
            Joint::parse(text.trim()).ok_or_else(|| JointsError::NoState(index + 1, text.trim().into()))
        };
        let joints: Vec<Joint> = list.split(',').enumerate().map(entry).collect::<Result<_, _>>()?;
        match joints[0] {
            Joint::Contact(_, _, Carrier::Upper) => Err(JointsError::CornerOfTheGround),
            _ => Ok(Joints(joints)),
        }
    }

    /// Free angles.
    pub fn angles(&self) -> usize {
        self.0.iter().filter(|joint| joint.has_angle()).count()
    }

    /// Free translations.
    pub fn translations(&self) -> usize {
        self.0.iter().map(|joint| joint.translations()).sum()
    }

    /// Pattern of the column if all interfaces stick; `None` if one slides or flies.
    pub fn pattern(&self) -> Option<Pattern> {
        let state = |joint: &Joint| match joint {
            Joint::Contact(interface, Slip::Sticks, _) => Some(*interface),
            _ => None,
        };
        let states: Vec<Interface> = self.0.iter().map(state).collect::<Option<_>>()?;
        Some(Pattern::from_states(&states))
    }

    /// Linkage in which the interfaces with a free angle are open.
    pub fn linkage(&self) -> Linkage {
        Linkage { open: self.0.iter().map(|joint| joint.has_angle()).collect() }
    }
}

impl fmt::Display for Joints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let states: Vec<String> = self.0.iter().map(Joint::to_string).collect();
        write!(f, "({})", states.join(","))
    }
}

/// Number of combinations of states by free angles and translations, `[angles][translations]`; `10^N` combinations in all for `N = blocks`. Numbers
/// beyond `u64`, which only columns of more than 20 blocks have, are `u64::MAX`.
pub fn combinations(blocks: usize) -> Vec<Vec<u64>> {
    let mut counts = vec![vec![0; 2 * blocks + 1]; blocks + 1];
    counts[0][0] = 1;
    for _ in 0..blocks {
        let before = std::mem::replace(&mut counts, vec![vec![0; 2 * blocks + 1]; blocks + 1]);
        for joint in Joint::all() {
            for (angles, row) in before.iter().enumerate() {
                for (translations, count) in row.iter().enumerate().filter(|(_, count)| **count > 0) {
                    let own: &mut u64 =
                        &mut counts[angles + usize::from(joint.has_angle())][translations + joint.translations()];
                    *own = own.saturating_add(*count);
                }
            }
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moving::occurs;

    #[test]
    fn an_interface_has_ten_states_which_read_back() {
        let all = Joint::all();
        assert_eq!(all.len(), 10);
        for first in &all {
            for second in &all {
                let joints = Joints(vec![*first, *second]);
                assert_eq!(Joints::parse(&joints.to_string()), Ok(joints));
            }
        }
        assert_eq!(Joints::parse("(−,−<)"), Joints::parse("(-,-<)"));
        assert_eq!(Joints::parse("(0,-<u)").map(|joints| joints.to_string()).as_deref(), Ok("(0,-<u)"));
    }

    #[test]
    fn texts_that_are_no_states_are_refused() {
        for (text, place) in [("(0u)", 1), ("(+u)", 1), ("(+,)", 2), ("(0,>)", 2), ("(f>)", 1), ("()", 1), ("(+>>)", 1)]
        {
            assert!(matches!(Joints::parse(text), Err(JointsError::NoState(at, _)) if at == place), "{text}");
        }
        assert_eq!(Joints::parse("+>,0"), Err(JointsError::NoList));
        assert_eq!(Joints::parse("(+>u)"), Err(JointsError::CornerOfTheGround));
    }

    #[test]
    fn all_combinations_are_counted_once_and_have_their_program() {
        for blocks in 1..=5 {
            let counts = combinations(blocks);
            assert_eq!(counts.iter().flatten().sum::<u64>(), 10u64.pow(blocks as u32));
            for (angles, row) in counts.iter().enumerate() {
                for (translations, count) in row.iter().enumerate() {
                    assert_eq!(*count > 0, occurs(blocks, angles, translations), "{angles}, {translations}");
                }
            }
        }
        // One block: sticks, slides (2), pivots (2), pivots and slides (4), flies.
        assert_eq!(combinations(1), [[1, 2, 0], [2, 4, 1]]);
    }
}
