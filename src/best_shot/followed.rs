//! Optima that are followed from one profile to another: to the next place, pitch angle or physics.
//!
//! A search from scratch begins with a coarse table of everything the shooter can intend. Where a
//! neighbour's local optima are known, climbs from these lead to the same tops in a part of the
//! time. An optimum that is born in between is caught by full searches on both sides of it.

use crate::analysis::aim_past_hoop::centre_speed_m_s;
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};

/// Speeds beside a carried shot that are tried, m/s: steps, and the most to each side.
const BORDER_STEP_M_S: f64 = 0.005;
/// See [`BORDER_STEP_M_S`].
const MOST_BORDER_STEPS: i32 = 20;

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
/// as it has it. A shot stays of its kind: the best one often lies at the border to the other kind,
/// and where the border has passed it, the nearest speed of its kind is taken.
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
        let kind = ShotKind::of(from, shot);
        let is_of_kind = |by: &f64| {
            let speed_m_s = nominal.speed_m_s + by;
            ShotKind::of(to, &nominal.with(NominalVariable::Speed, speed_m_s)) == kind
        };
        let mut beside = (0..=MOST_BORDER_STEPS)
            .flat_map(|step| [-step, step])
            .map(|step| f64::from(step) * BORDER_STEP_M_S);
        nominal.speed_m_s += beside.find(is_of_kind).unwrap_or(0.0);
    }
    nominal
}

#[cfg(test)]
mod tests {
    use super::carried;
    use crate::shooter::{
        Location, Nominal, Profile, ProfileSettings, ReleaseDispersion, Shooter, ShotKind,
    };

    fn launcher(distance_m: f64) -> Profile {
        let settings = ProfileSettings::new(Shooter {
            name: "launcher".to_owned(),
            release_height_m: 1.2,
            max_backspin_rad_s: 20.0,
            max_side_spin_rad_s: 0.0,
            dispersion: ReleaseDispersion::NONE,
        });
        let location = Location {
            distance_m,
            angle_rad: 0.0,
        };
        settings.at(location).unwrap()
    }

    /// The fastest direct and the slowest bank shot, from 2.6 m at 65 degrees.
    #[test]
    fn contract_shots_at_the_border_stay_of_their_kind() {
        let from = launcher(2.6);
        let at = |speed_m_s| Nominal {
            speed_m_s,
            pitch_rad: 65.0_f64.to_radians(),
            backspin_rad_s: 6.0,
            ..Nominal::default()
        };
        let kind_of = |speed_m_s: &f64| ShotKind::of(&from, &at(*speed_m_s));
        let (mut direct, mut bank) = (7.4, 7.8);
        assert_eq!([direct, bank].map(|s| kind_of(&s)), ShotKind::ALL);
        for _ in 0..30 {
            let middle = 0.5 * (direct + bank);
            match kind_of(&middle) {
                ShotKind::Direct => direct = middle,
                ShotKind::Bank => bank = middle,
            }
        }
        for millimetres in -200..=200_i32 {
            let to = launcher(2.6 + 0.001 * f64::from(millimetres));
            for (kind, speed) in [(ShotKind::Direct, direct), (ShotKind::Bank, bank)] {
                let there = carried(&from, &to, &at(speed));
                assert_eq!(ShotKind::of(&to, &there), kind, "{millimetres} mm");
            }
        }
    }
}
