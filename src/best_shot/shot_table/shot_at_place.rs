//! The best shot of a table at one place.

use super::interpolation_check::CheckError;
use super::lookup::TableShot;
use crate::analysis::sensitivity::{self, SensitivityTopics};
use crate::best_shot::followed::Starts;
use crate::best_shot::found_shots::{BestShotError, NoShot};
use crate::best_shot::search::{FoundBesideOtherKind, find_beside_other_kind};
use crate::dynamics::{Event, EventKind, Outcome};
use crate::model::SolidId;
use crate::probability::{Estimate, Progress, Pulse, Silent};
use crate::search_space::PlanError;
use crate::shooter::{Nominal, NominalVariable, Profile, ProfileError, ShotKind};

const WINDOWS: SensitivityTopics = SensitivityTopics {
    windows: true,
    ..SensitivityTopics::NONE
};

/// Why there is no table.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ShotTableError {
    /// A value or a place is not possible.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The search is too large.
    #[error(transparent)]
    Search(#[from] BestShotError),
    /// A table of the better kind has one angle.
    #[error("a table of the better kind needs one court angle")]
    SeveralAngles,
}

impl From<CheckError> for ShotTableError {
    fn from(error: CheckError) -> Self {
        match error {
            CheckError::Profile(error) => Self::Profile(error),
            CheckError::Search(error) => Self::Search(error),
        }
    }
}

/// What is found at one place.
pub(crate) struct FoundAtPlace {
    /// The best shot of the kind, if there is a clean one.
    pub(crate) shot: Result<TableShot, NoShot>,
    /// Local optima of both kinds, to start from at places nearby.
    pub(crate) optima: Vec<Nominal>,
}

/// The best shot of a kind.
pub(crate) fn best(
    (profile, starts): (&Profile, Starts),
    kind: ShotKind,
    progress: &dyn Progress,
) -> Result<FoundAtPlace, BestShotError> {
    let FoundBesideOtherKind {
        shot,
        other_kind,
        optima,
    } = match find_beside_other_kind((profile, starts), kind, &Pulse(progress)) {
        Ok(found) => found,
        Err(BestShotError::Plan(PlanError::OutOfReach { .. })) => {
            return Ok(FoundAtPlace {
                shot: Err(NoShot::Impossible(kind)),
                optima: Vec::new(),
            });
        }
        Err(error) => return Err(error),
    };
    let shot = shot.map(|shot| TableShot {
        other_kind: other_kind.map(|estimate| estimate.probability),
        ..table_shot(
            (profile, kind),
            &shot.nominal,
            &shot.estimate,
            &shot.outcome,
        )
    });
    Ok(FoundAtPlace { shot, optima })
}

/// A shot of a table, without P of the other kind.
pub(super) fn table_shot(
    (here, kind): (&Profile, ShotKind),
    nominal: &Nominal,
    estimate: &Estimate,
    outcome: &Outcome,
) -> TableShot {
    let windows = sensitivity::analyse(here, nominal, WINDOWS, &Silent).windows;
    let tolerances = [NominalVariable::Speed, NominalVariable::Pitch].map(|variable| {
        let ends = windows.iter().find(|window| window.variable == variable);
        let here = nominal.get(variable);
        ends.and_then(|window| window.ends)
            .map_or([0.0; 2], |(low, high)| [here - low, high - here])
    });
    let (time_s, entry_rad) = fall_to_hoop(here, nominal).unzip();
    TableShot {
        kind,
        nominal: *nominal,
        aim_rad: nominal.polar_rad - here.location().angle_rad,
        probability: estimate.probability,
        standard_error: estimate.standard_error,
        banked: estimate.shares.banked() / estimate.probability.max(f64::MIN_POSITIVE),
        outcome: outcome.kind,
        time_s,
        entry_rad,
        tolerances,
        other_kind: None,
        board_aim_m: outcome
            .board_point_m
            .filter(|_| kind == ShotKind::Bank)
            .map(|point| (point.1, point.2)),
    }
}

/// When an error-free shot first falls to the height of the hoop, s, and its angle below the
/// horizontal then, rad. The ring is left out: times after bounces off it would jump from place to
/// place. A shot that meets the board first is followed from where it leaves it. `None` for one
/// that would fall behind the board.
fn fall_to_hoop(here: &Profile, nominal: &Nominal) -> Option<(f64, f64)> {
    let simulator = here.simulator();
    let release = here.release(nominal);
    let (start, before_s) = if simulator.first_touch(&release) == Some(SolidId::Board) {
        let trace = simulator.trace(&release, f64::INFINITY).ok()?;
        let parts = |event: &&Event| matches!(event.kind, EventKind::Part { .. });
        let part = trace.events.iter().find(parts)?;
        (part.state, part.time_s)
    } else {
        (release.state(), 0.0)
    };
    let (state, fall_s) = simulator.undisturbed_fall_to_hoop(&start)?;
    // Beyond the face of the board it cannot fall: a shot from near by that hits the ring on its
    // way up.
    if state.position_m.x < -here.physics().board_distance_m {
        return None;
    }
    let v = state.velocity_m_s;
    let entry_rad = libm::atan2(-v.z, libm::hypot(v.x, v.y));
    Some((before_s + fall_s, entry_rad))
}
