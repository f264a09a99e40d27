//! The best shots of tables: of places, and of release angles.

use super::json::{Answer, Provenance};
use crate::best_shot::{
    InterpolationCheck, NotCleanShot, ShotAtPitch, ShotTable, TableKind, TableShot,
};
use crate::fitting::AngleOverDraws;
use crate::shooter::{Profile, ShotKind};
use serde::Serialize;

/// What is known of a shot of a table.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ShotValues {
    /// Its speed.
    pub speed_m_s: Option<f64>,
    /// Above the horizontal.
    pub pitch_rad: Option<f64>,
    /// From the line to the hoop's centre, positive to the shooter's left.
    pub aim_rad: Option<f64>,
    /// Its backspin.
    pub backspin_rad_s: Option<f64>,
    /// When it first falls to the height of the hoop, as if there were no ring.
    pub time_s: Option<f64>,
    /// At which angle it does.
    pub entry_rad: Option<f64>,
    /// P.
    pub probability: Option<f64>,
    /// Its numerical standard error.
    pub standard_error: Option<f64>,
    /// How much slower it may be, all else exact, until it first misses.
    pub speed_tolerance_below_m_s: Option<f64>,
    /// How much faster.
    pub speed_tolerance_above_m_s: Option<f64>,
    /// How much flatter.
    pub pitch_tolerance_below_rad: Option<f64>,
    /// How much steeper.
    pub pitch_tolerance_above_rad: Option<f64>,
    /// P of the other kind there, from climbs alone.
    pub other_kind_probability: Option<f64>,
    /// The share of the makes that touch the board before the ring.
    pub makes_off_board_first: Option<f64>,
    /// Where the ball's centre meets the board: to the right, facing it.
    pub board_aim_across_short_m: Option<f64>,
    /// Height above the hoop of the ball's centre at the board.
    pub board_aim_above_hoop_short_m: Option<f64>,
}

impl From<&TableShot> for ShotValues {
    fn from(shot: &TableShot) -> Self {
        let [[slower, faster], [flatter, steeper]] = shot.tolerances;
        Self {
            speed_m_s: Some(shot.nominal.speed_m_s),
            pitch_rad: Some(shot.nominal.pitch_rad),
            aim_rad: Some(shot.aim_rad),
            backspin_rad_s: Some(shot.nominal.backspin_rad_s),
            time_s: shot.time_s,
            entry_rad: shot.entry_rad,
            probability: Some(shot.probability),
            standard_error: Some(shot.standard_error),
            speed_tolerance_below_m_s: Some(slower),
            speed_tolerance_above_m_s: Some(faster),
            pitch_tolerance_below_rad: Some(flatter),
            pitch_tolerance_above_rad: Some(steeper),
            other_kind_probability: shot.other_kind,
            makes_off_board_first: Some(shot.banked),
            board_aim_across_short_m: shot.board_aim_m.map(|aim| aim.0),
            board_aim_above_hoop_short_m: shot.board_aim_m.map(|aim| aim.1),
        }
    }
}

impl ShotValues {
    /// Those of the most probable shot where no clean one goes in.
    fn of_not_clean(shot: &NotCleanShot, profile: &Profile) -> Self {
        Self {
            speed_m_s: Some(shot.nominal.speed_m_s),
            aim_rad: Some(shot.nominal.polar_rad - profile.location().angle_rad),
            backspin_rad_s: Some(shot.nominal.backspin_rad_s),
            probability: Some(shot.probability),
            ..Self::default()
        }
    }
}

/// The best shot at a place of a table.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaceRow {
    /// From how far.
    pub distance_m: f64,
    /// From the court's long axis.
    pub court_angle_rad: f64,
    /// Its kind.
    pub kind: Option<ShotKind>,
    /// Whether there is one.
    pub has_shot: bool,
    /// How it goes in without scatter.
    pub error_free_kind: Option<&'static str>,
    /// Whether the place was added for the interpolation.
    pub is_added: bool,
    /// The shot.
    #[serde(flatten)]
    pub shot: ShotValues,
}

/// The rows of a table, angle by angle.
#[must_use]
pub fn place_rows(table: &ShotTable) -> Vec<PlaceRow> {
    let nodes = (0..table.angles_rad.len())
        .flat_map(|angle| (0..table.distances_m.len()).map(move |distance| (angle, distance)));
    let row = |(angle, distance): (usize, usize)| {
        let shot = table.at(angle, distance);
        let (distance_m, court_angle_rad) = (table.distances_m[distance], table.angles_rad[angle]);
        PlaceRow {
            distance_m,
            court_angle_rad,
            kind: shot.map(|shot| shot.kind),
            has_shot: shot.is_some(),
            error_free_kind: shot.map(|shot| shot.outcome.name()),
            is_added: table.added_distances_m.contains(&distance_m)
                || table.added_angles_rad.contains(&court_angle_rad),
            shot: shot.map(ShotValues::from).unwrap_or_default(),
        }
    };
    nodes.map(row).collect()
}

/// What interpolation costs at a place between those of a table.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct InterpolationAnswer {
    /// From how far.
    pub distance_m: f64,
    /// From the court's long axis.
    pub court_angle_rad: f64,
    /// P of the interpolated shot.
    pub interpolated_probability: f64,
    /// P that is interpolated itself.
    pub looked_up_probability: f64,
    /// P of the best shot there.
    pub best_probability: Option<f64>,
}

impl From<&InterpolationCheck> for InterpolationAnswer {
    fn from(check: &InterpolationCheck) -> Self {
        Self {
            distance_m: check.location.distance_m,
            court_angle_rad: check.location.angle_rad,
            interpolated_probability: check.interpolated,
            looked_up_probability: check.looked_up,
            best_probability: check.best,
        }
    }
}

/// A table of the best shots from several places.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TableAnswer {
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Who shoots, in words.
    pub shooter: String,
    /// Ball, hoop and air, in words.
    pub physics: String,
    /// `direct`, `bank` or `best`.
    pub kind: &'static str,
    /// The shots.
    pub shots: Vec<PlaceRow>,
    /// What interpolation costs.
    pub checks: Vec<InterpolationAnswer>,
    /// The greatest loss of P by interpolation.
    pub greatest_loss: Option<f64>,
    /// The greatest error of an interpolated P.
    pub greatest_error: Option<f64>,
    /// What a reader must know, in words.
    pub notes: Vec<String>,
}

/// What a table says of itself in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableWords {
    /// Who shoots.
    pub shooter: String,
    /// Ball, hoop and air.
    pub physics: String,
    /// What a reader must know.
    pub notes: Vec<String>,
}

impl TableAnswer {
    /// A table and its words.
    #[must_use]
    pub fn new(table: &ShotTable, profile: &Profile, words: TableWords) -> Self {
        Self {
            provenance: Provenance::of(profile),
            shooter: words.shooter,
            physics: words.physics,
            kind: table.kind.name(),
            shots: place_rows(table),
            checks: table.checks.iter().map(InterpolationAnswer::from).collect(),
            greatest_loss: table.costliest().map(InterpolationCheck::loss),
            greatest_error: table.most_wrong().map(|check| check.error().abs()),
            notes: words.notes,
        }
    }
}

/// The best shot at a release angle.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PitchRow {
    /// From how far, where there are several distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_m: Option<f64>,
    /// Its kind; of the most probable shot where no clean one goes in.
    pub kind: Option<ShotKind>,
    /// Whether a clean one goes in.
    pub has_shot: bool,
    /// How it goes in; `misses` for a most probable shot that misses without errors.
    pub error_free_kind: Option<&'static str>,
    /// The shot.
    #[serde(flatten)]
    pub shot: ShotValues,
    /// P over the draws of a fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_draws: Option<Option<AngleOverDraws>>,
}

impl PitchRow {
    fn new(row: &ShotAtPitch, profile: &Profile) -> Self {
        let not_clean = row.not_clean.as_ref();
        let values = match (&row.shot, not_clean) {
            (Some(shot), _) => shot.into(),
            (None, Some(shot)) => ShotValues::of_not_clean(shot, profile),
            (None, None) => ShotValues::default(),
        };
        let clean = row.shot.as_ref();
        Self {
            distance_m: None,
            kind: clean
                .map(|shot| shot.kind)
                .or(not_clean.map(|shot| shot.kind)),
            has_shot: clean.is_some(),
            error_free_kind: clean
                .map(|shot| shot.outcome.name())
                .or(not_clean.map(|_| "misses")),
            shot: ShotValues {
                pitch_rad: Some(row.pitch_rad),
                ..values
            },
            over_draws: None,
        }
    }
}

/// The best shots at several release angles from one place.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PitchCurveAnswer {
    /// From how far, where there are several distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_m: Option<f64>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Ball, hoop and air, in words.
    pub physics: String,
    /// `direct`, `bank` or `best`.
    pub kind: &'static str,
    /// The shots.
    pub shots: Vec<PitchRow>,
}

impl PitchCurveAnswer {
    /// The shots at some angles, with P over the draws of a fit for each or for none of them.
    #[must_use]
    pub fn new(
        rows: &[ShotAtPitch],
        over_draws: &[Option<AngleOverDraws>],
        kind: TableKind,
        profile: &Profile,
        physics: String,
    ) -> Self {
        let row = |(i, row): (usize, &ShotAtPitch)| PitchRow {
            over_draws: over_draws.get(i).copied(),
            ..PitchRow::new(row, profile)
        };
        Self {
            distance_m: None,
            provenance: Provenance::of(profile),
            physics,
            kind: kind.name(),
            shots: rows.iter().enumerate().map(row).collect(),
        }
    }

    /// One of several distances.
    #[must_use]
    pub fn from_distance(mut self, distance_m: f64) -> Self {
        self.distance_m = Some(distance_m);
        for row in &mut self.shots {
            row.distance_m = Some(distance_m);
        }
        self
    }
}

impl Answer for TableAnswer {
    const NAME: &'static str = "table";
}

impl Answer for PitchCurveAnswer {
    const NAME: &'static str = "pitch_curve";
}
