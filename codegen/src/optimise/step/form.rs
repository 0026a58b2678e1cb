//! The forms that a step-time program can take. The generator writes them all, counts, and keeps the cheapest.

use std::fmt;

/// Which factorisation of the accelerations a program evaluates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Form {
    /// How two links are coupled.
    pub coupling: Coupling,
    /// How the rates' terms are added up.
    pub rates: Rates,
    /// How gravity and ground motion enter the first equation.
    pub weight: Weight,
    /// What the scene constants are measured in.
    pub units: Units,
}

/// How the coupling of two links depends on their angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Coupling {
    /// Scalar product of the lower link's lever and the upper link's first moment, both turned into the ground's axes.
    TurnedVectors,
    /// Linear in sine and cosine of the difference of the two angles.
    AngleDifferences,
}

/// How the terms with squared rates are added up.
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
    /// The lowest link's moment of inertia and gravity are one. Where gravity is a scene constant.
    UnitInertiaAndGravity,
}

impl Form {
    /// All forms, in the order in which equals are preferred.
    pub fn all() -> impl Iterator<Item = Form> {
        let couplings = [Coupling::TurnedVectors, Coupling::AngleDifferences];
        couplings.into_iter().flat_map(|coupling| {
            [Rates::Pairs, Rates::SharedSums].into_iter().flat_map(move |rates| {
                [Weight::TurnedVector, Weight::PerAngle].into_iter().flat_map(move |weight| {
                    [Units::Si, Units::UnitInertia, Units::UnitInertiaAndGravity].map(|units| Form {
                        coupling,
                        rates,
                        weight,
                        units,
                    })
                })
            })
        })
    }
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let coupling = match self.coupling {
            Coupling::TurnedVectors => "turned vectors",
            Coupling::AngleDifferences => "angle differences",
        };
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
        write!(f, "{coupling}, {rates}, {weight}, {units}")
    }
}
