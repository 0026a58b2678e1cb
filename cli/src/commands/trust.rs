//! Companions of a run: whether it is followed, and what is printed of it.

use crate::arguments;
use rocking::trust::{Follow, Trust, Verdict, follow_run};
use rocking::{Response, Scene, SolveError};

/// Runs that took longer are followed only where that is asked for `[s]`: their companions take half a minute and more.
const LONGEST_FOLLOWED: f64 = 5.0;

/// What came of the question how far a run can be trusted.
#[derive(Debug)]
pub enum Followed {
    /// Not asked.
    No,
    /// The run took so long `[s]` that it was not.
    TooLong(f64),
    /// By companions.
    By(Box<Trust>),
}

impl Followed {
    /// Follows a run that took so many seconds, unless that is not wanted.
    pub fn of(
        asked: &arguments::Run,
        scene: &Scene,
        response: &Response,
        seconds: f64,
    ) -> Result<Followed, SolveError> {
        match seconds > LONGEST_FOLLOWED && !asked.trust {
            _ if asked.no_trust => Ok(Followed::No),
            true => Ok(Followed::TooLong(seconds)),
            false => follow_run(scene, response, Follow::default()).map(|trust| Followed::By(Box::new(trust))),
        }
    }

    /// What companions say.
    pub fn trust(&self) -> Option<&Trust> {
        match self {
            Followed::By(trust) => Some(trust),
            _ => None,
        }
    }

    /// Words before the outcome of a run that is not determined. What follows from the laws of contact, or does not, is told by the run itself.
    pub fn lead(&self) -> &'static str {
        let is_open = self.trust().is_some_and(|trust| !trust.determined && trust.verdict != Verdict::Undetermined);
        if is_open { "not determined; this run " } else { "" }
    }

    /// A line, or none.
    pub fn line(&self) -> String {
        match self {
            Followed::No => String::new(),
            Followed::TooLong(seconds) => {
                format!(
                    "trust: not examined, as the run took {seconds:.0} s; `--trust` takes ten to thirty times as long\n"
                )
            }
            Followed::By(trust) => format!("trust: {}\n", trust.sentence()),
        }
    }
}
