//! Optima that are followed from one profile to another: to the next place, pitch angle or physics.
//!
//! A search from scratch begins with a coarse table of everything the shooter can intend. Where a
//! neighbour's local optima are known, climbs from these lead to the same tops in a part of the
//! time. An optimum that is born in between is caught by full searches on both sides of it.

use crate::analysis::aim_past_hoop::centre_speed_m_s;
use crate::shooter::{Nominal, NominalVariable, Profile};

/// Where the climbs of a search start.
#[derive(Clone, Copy)]
pub(super) enum Starts<'a> {
    /// At the best shots of a coarse table.
    Table,
    /// At the local optima of neighbours. A kind that none of them is of is searched in the table.
    Optima(&'a [Nominal]),
}

impl<'a> Starts<'a> {
    /// The optima of neighbours, if there are any.
    pub(super) fn of(optima: &'a [Nominal]) -> Self {
        match optima {
            [] => Self::Table,
            _ => Self::Optima(optima),
        }
    }
}

/// A shot of one profile as a start in another: with its direction from the line to the hoop, and
/// with its difference from the speed through the hoop's centre. What the other does not search is
/// as it has it.
pub(super) fn carried(from: &Profile, to: &Profile, shot: &Nominal) -> Nominal {
    let choice = to.search().choice;
    let mut nominal = *shot;
    nominal.polar_rad += to.location().angle_rad - from.location().angle_rad;
    for variable in NominalVariable::ALL {
        if let Some(fixed) = to.nominal_overrides().get(variable)
            && !choice.includes(variable)
        {
            *nominal.get_mut(variable) = fixed;
        }
    }
    if choice.includes(NominalVariable::Speed) {
        let speeds =
            centre_speed_m_s(from, shot.pitch_rad).zip(centre_speed_m_s(to, nominal.pitch_rad));
        if let Some((there_m_s, here_m_s)) = speeds {
            nominal.speed_m_s += here_m_s - there_m_s;
        }
    }
    nominal
}
