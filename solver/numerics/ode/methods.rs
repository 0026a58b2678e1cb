//! The list of methods. An explicit method is a file with its [`Tableau`] in `tableaus/`, declared there, and one line of the list here.

use super::explicit::{ErrorEstimate, Tableau};
use super::tableaus::{
    dop853::DOP853, dormand_prince54::DORMAND_PRINCE54, kutta_merson::KUTTA_MERSON, runge_kutta4::RUNGE_KUTTA4,
};
use serde::{Deserialize, Serialize};

/// Declares [`Method`] and [`Method::tableau`] from the list of explicit methods: doc, name in scene files, tableau.
macro_rules! methods {
    ($($(#[$doc:meta])* $method:ident, $name:literal, $tableau:ident;)*) => {
        /// Integration method.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        #[non_exhaustive]
        pub enum Method {
            /// The default. Costs least by the work-precision benchmark: Taylor series, closed forms of free swings, and multi-sample steps over
            /// the record of one block.
            #[default]
            Auto,
            $($(#[$doc])* #[serde(rename = $name)] $method,)*
            /// Taylor series of an order that follows from the tolerance and the number of free angles.
            Taylor,
        }

        impl Method {
            /// All methods.
            pub const ALL: &'static [Method] = &[Method::Auto, $(Method::$method,)* Method::Taylor];

            /// The name of the method in a scene file.
            pub fn name(self) -> &'static str {
                match self {
                    Method::Auto => "auto",
                    $(Method::$method => $name,)*
                    Method::Taylor => "taylor",
                }
            }

            /// Coefficients of an explicit method; `None` for a Taylor series.
            pub(crate) fn tableau(self) -> Option<&'static Tableau> {
                match self {
                    $(Method::$method => Some(&$tableau),)*
                    Method::Auto | Method::Taylor => None,
                }
            }
        }
    };
}

methods! {
    /// Order 8(5,3), dense output of order 7.
    Dop853, "dop853", DOP853;
    /// Dormand & Prince 5(4), for comparison. Under records and at tolerances above 1e-5 its run time comes close to that of Taylor series.
    DormandPrince54, "dormand-prince54", DORMAND_PRINCE54;
    /// Merson's method of order 4, the paper's, for comparison.
    KuttaMerson, "kutta-merson", KUTTA_MERSON;
    /// The classic method of order 4 with steps of fixed length, for comparison; the tolerances have no effect.
    RungeKutta4, "rk4", RUNGE_KUTTA4;
}

impl Method {
    /// Whether the method chooses the length of its steps by the tolerances.
    pub fn has_step_control(self) -> bool {
        self.tableau().is_none_or(|tableau| !matches!(tableau.error, ErrorEstimate::None))
    }

    /// The method that takes the steps: [`Method::Auto`] takes them by Taylor series, where no closed form or multi-sample step applies.
    pub fn stepper(self) -> Method {
        if self == Method::Auto { Method::Taylor } else { self }
    }

    /// Methods with step control of order 5 and more, which tests and benchmarks compare. [`Method::Auto`] is left out: it steps by one of them.
    pub const ACCURATE: [Method; 3] = [Method::Dop853, Method::DormandPrince54, Method::Taylor];

    /// The method of this name; `dopri5` and `rk45` are other names of `dormand-prince54`.
    pub fn parse(name: &str) -> Option<Method> {
        let name = if ["dopri5", "rk45", "RK45"].contains(&name) { "dormand-prince54" } else { name };
        Method::ALL.iter().copied().find(|method| method.name() == name)
    }
}
