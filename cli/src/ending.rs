//! How a run ends, as the terminal and the report put it into words.

use rocking::{Column, Response, StopReason};

/// The endings that are told apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// A block reached the overturning angle.
    Overturned {
        /// Whether that angle is below the balance of the stack that begins with the block: it may have returned.
        is_below_balance: bool,
    },
    /// It is certain that the column overturns.
    CertainToFall,
    /// A block lost its support.
    Collapsed,
    /// No motion follows from the laws of contact.
    Undetermined,
    /// `t_end` comes with the column past its balance, or with the energy to get there.
    MayBeFalling,
    /// `t_end` comes before the end of the ground motion.
    GroundStillMoves,
    /// Nothing starts the column.
    NeverStarted,
    /// The column comes to rest.
    AtRest,
    /// It is certain that the column does not overturn.
    CertainToStand,
    /// The column stands at `t_end`.
    Standing {
        /// What it does then; `None` where nothing moves any more.
        still: Option<&'static str>,
    },
}

impl Ending {
    /// The ending of a run of this column with this overturning angle `[rad]`.
    pub fn of(response: &Response, column: &Column, overturn_angle: f64) -> Ending {
        match response.status {
            StopReason::Overturned => {
                Ending::Overturned { is_below_balance: response.ends_below_balance(column, overturn_angle) }
            }
            StopReason::Falls => Ending::CertainToFall,
            StopReason::Collapsed => Ending::Collapsed,
            StopReason::Undetermined => Ending::Undetermined,
            StopReason::Stands => Ending::CertainToStand,
            _ if response.may_overturn => Ending::MayBeFalling,
            _ if response.cuts_ground_motion() => Ending::GroundStillMoves,
            StopReason::AtRest if response.events.is_empty() => Ending::NeverStarted,
            StopReason::AtRest => Ending::AtRest,
            _ => Ending::Standing { still: still_moves(response) },
        }
    }
}

/// What the column of a run that stands at `t_end` does then; `None` where nothing moves any more.
fn still_moves(response: &Response) -> Option<&'static str> {
    // Patterns change at events only: rows may end long before the run.
    let last = response.events.last().map(|event| &event.after).or(response.samples.last().map(|row| &row.pattern));
    let is_closed = last.is_some_and(|pattern| pattern.dof() == 0);
    match response.slides_on {
        true => Some("sliding or flying"),
        false => (!is_closed).then_some("rocking"),
    }
}
