//! Companions of a run: whether they are run, and what is printed of their result.

use crate::arguments;
use rocking::trust::{Trust, TrustOptions, follow_run};
use rocking::{Response, Scene, SolveError};

/// Longest computing time of a run that is followed without `--trust` `[s]`. Companions of a longer run take half a minute and more.
const LONGEST_FOLLOWED: f64 = 5.0;

/// Result of following a run by companions.
#[derive(Debug)]
pub enum Followed {
    /// Not followed, because of `--no-trust`.
    No,
    /// Not followed, because the run took so long `[s]`.
    TooLong(f64),
    /// Followed by companions, with what they say.
    By(Box<Trust>),
}

impl Followed {
    /// Follows a run that took `seconds`. Not with `--no-trust`, nor after more than [`LONGEST_FOLLOWED`] without `--trust`.
    pub fn of(
        request: &arguments::Run,
        scene: &Scene,
        response: &Response,
        seconds: f64,
    ) -> Result<Followed, SolveError> {
        match seconds > LONGEST_FOLLOWED && !request.trust {
            _ if request.no_trust => Ok(Followed::No),
            true => Ok(Followed::TooLong(seconds)),
            false => follow_run(scene, response, TrustOptions::default()).map(|trust| Followed::By(Box::new(trust))),
        }
    }

    /// What companions say.
    pub fn trust(&self) -> Option<&Trust> {
        match self {
            Followed::By(trust) => Some(trust),
            _ => None,
        }
    }

    /// Words before the outcome of a run whose verdict is not determined; otherwise empty.
    pub fn lead(&self) -> &'static str {
        self.trust().map_or("", Trust::lead)
    }

    /// The line on trust; empty with `--no-trust`.
    pub fn line(&self) -> String {
        match self {
            Followed::No => String::new(),
            Followed::TooLong(seconds) => {
                format!("trust: not examined, as the run took {seconds:.0} s; `--trust` takes 7 to 73 times as long\n")
            }
            Followed::By(trust) => format!("trust: {}\n", trust.sentence()),
        }
    }
}
