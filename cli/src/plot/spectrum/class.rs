//! Outcomes as figures distinguish them.

use rocking::Fate;

/// The outcome of a point as the figure distinguishes it, from the least to the most violent; points without a result last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    NoUplift,
    /// Blocks slid, and nothing rocked.
    Slides,
    Rocks,
    /// The column overturned, and impacts were not counted: the sweep asked only for the outcome.
    Overturns,
    /// The column overturned after three impacts or more.
    AfterMore,
    AfterTwo,
    AfterOne,
    /// The column overturned without an impact.
    AtOnce,
    /// A block lost its support.
    Collapses,
    /// Companions of the run do not determine its outcome.
    NotDetermined,
    /// The point has no result, or no motion follows from the laws of contact.
    Error,
}

impl Class {
    /// All classes, in the order of the enum.
    pub const ALL: [Class; 11] = [
        Class::NoUplift,
        Class::Slides,
        Class::Rocks,
        Class::Overturns,
        Class::AfterMore,
        Class::AfterTwo,
        Class::AfterOne,
        Class::AtOnce,
        Class::Collapses,
        Class::NotDetermined,
        Class::Error,
    ];

    /// Fill and name. Fills are Okabe and Ito's hues on a scale of lightness, the darker the more violent: 100, 87, 72, 58, 41 and 12 of 100. The name of a
    /// class that overturns goes on from the word.
    fn look(self) -> [&'static str; 2] {
        match self {
            Class::NoUplift => ["#ffffff", "no uplift"],
            Class::Slides => ["#e9efdc", "slides and stands"],
            Class::Rocks => ["#cfdde9", "rocks and stands"],
            Class::Overturns => ["#0065a0", "(impacts not counted)"],
            Class::AfterMore => ["#e6a52c", "after 3 impacts or more"],
            Class::AfterTwo => ["#dd6a12", "after 2 impacts"],
            Class::AfterOne => ["#0065a0", "after 1 impact"],
            Class::AtOnce => ["#1f1b2e", "without impact"],
            Class::Collapses => ["#7a1f3d", "collapses: a block slides off"],
            Class::NotDetermined => ["#f4edc9", "not determined (hatched)"],
            Class::Error => ["#f3d6e4", "no result (hatched)"],
        }
    }

    /// Colour of its cells.
    pub fn fill(self) -> &'static str {
        self.look()[0]
    }

    /// Name in the legend.
    pub fn name(self) -> &'static str {
        self.look()[1]
    }

    /// The class of a row; `impacts` are `None` where they are not counted.
    pub fn of(fate: Fate, impacts: Option<u64>) -> Class {
        match (fate, impacts) {
            (Fate::NoUplift, _) => Class::NoUplift,
            (Fate::Slides, _) => Class::Slides,
            (Fate::Collapses, _) => Class::Collapses,
            (Fate::Rocks, _) => Class::Rocks,
            (Fate::Overturns, None) => Class::Overturns,
            (Fate::Overturns, Some(0)) => Class::AtOnce,
            (Fate::Overturns, Some(1)) => Class::AfterOne,
            (Fate::Overturns, Some(2)) => Class::AfterTwo,
            (Fate::Overturns, Some(_)) => Class::AfterMore,
            (Fate::NotDetermined, _) => Class::NotDetermined,
            _ => Class::Error,
        }
    }

    /// Whether it is known what becomes of the column.
    pub fn has_answer(self) -> bool {
        !matches!(self, Class::NotDetermined | Class::Error)
    }

    /// Whether the column overturned or collapsed.
    pub fn is_lost(self) -> bool {
        self.overturns() || self == Class::Collapses
    }

    /// Whether the column overturned.
    pub fn overturns(self) -> bool {
        matches!(self, Class::Overturns | Class::AfterMore | Class::AfterTwo | Class::AfterOne | Class::AtOnce)
    }
}
