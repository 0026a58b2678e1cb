//! The forms of a step-time program. The generator writes all of them, counts their operations, and keeps the cheapest.
//!
//! Every form couples two links by the scalar product of turned vectors: with sines and cosines of differences of angles instead,
//! every program from one to twelve free angles has more operations.

use std::fmt;

/// A factorisation of the accelerations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Form {
    /// How the terms with squared rates are summed.
    pub rates: Rates,
    /// How gravity and ground motion enter the first equation.
    pub weight: Weight,
    /// Units of the scene constants.
    pub units: Units,
}

/// How the terms with squared rates are summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rates {
    /// One coefficient per pair of links.
    Pairs,
    /// Centripetal accelerations summed once up the column, centripetal forces once down.
    SharedSums,
}

/// How gravity and ground motion enter the equation of the lowest link, whose first moment nothing else needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Weight {
    /// As the scalar product with the turned first moment.
    TurnedVector,
    /// One coefficient for the cosine, one for the sine.
    PerAngle,
}

/// Units of the scene constants. The result, in rad/s², does not depend on them, but constants that are one vanish.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Units {
    /// Metre, kilogram, second.
    Si,
    /// The lowest link's moment of inertia is one.
    UnitInertia,
    /// The lowest link's moment of inertia and gravity are one. Only where gravity is a scene constant: for horizontal ground motion.
    UnitInertiaAndGravity,
}

impl Form {
    /// All forms. Of equally cheap ones, the earlier is preferred.
    pub fn all() -> impl Iterator<Item = Form> {
        [Rates::Pairs, Rates::SharedSums].into_iter().flat_map(|rates| {
            [Weight::TurnedVector, Weight::PerAngle].into_iter().flat_map(move |weight| {
                [Units::Si, Units::UnitInertia, Units::UnitInertiaAndGravity].map(|units| Form { rates, weight, units })
            })
        })
    }
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rates = match self.rates {
            Rates::Pairs => "rates by pairs",
            Rates::SharedSums => "rates in shared sums",
        };
        let weight = match self.weight {
            Weight::TurnedVector => "weight by vector",
            Weight::PerAngle => "weight by angle",
        };
        let units = match self.units {
            Units::Si => "SI",
            Units::UnitInertia => "unit inertia",
            Units::UnitInertiaAndGravity => "unit inertia and gravity",
        };
        write!(f, "{rates}, {weight}, {units}")
    }
}
