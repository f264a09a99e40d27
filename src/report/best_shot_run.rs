//! The files of a `best` run, read back for its page.

use super::report_error::ReportError;
use super::shot_in_words::{ReportShot, most_probable};
use crate::best_shot::ShotKind;
use crate::config::parse_profile;
use crate::plots::shot_with_probability::PlottedShot;
use crate::shooter::{Nominal, Profile};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use serde_json::Value;
use std::f64::consts::PI;

/// Name of the profile in the folder of a run.
pub const PROFILE_FILE: &str = "profile.toml";
/// Name of the best shots in the folder of a run.
pub const BEST_SHOTS_FILE: &str = "best_shots.json";
/// Name of the probability curves in the folder of a run.
pub const CURVES_FILE: &str = "curves.csv";
/// Name of the sensitivity in the folder of a run.
pub const SENSITIVITY_FILE: &str = "sensitivity.csv";

/// The texts of the files of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunTexts {
    /// [`PROFILE_FILE`].
    pub profile: String,
    /// [`BEST_SHOTS_FILE`].
    pub best_shots: String,
    /// [`CURVES_FILE`], if there is one.
    pub curves: Option<String>,
    /// [`SENSITIVITY_FILE`], if there is one.
    pub sensitivity: Option<String>,
}

/// A `best` run.
#[derive(Clone, Debug)]
pub struct BestShotRun {
    /// The profile, in the units of the run.
    pub(super) profile: Profile,
    /// The best shots.
    pub(super) shots: Vec<ReportShot>,
    /// Where the better shot is aimed; the end of a sentence, empty if not known.
    pub(super) aim: String,
    /// The rows of the curves, the header first; empty if there is no file.
    pub(super) curves: Vec<Vec<String>>,
    /// The rows of the sensitivity, the header first; empty if there is no file.
    pub(super) sensitivity: Vec<Vec<String>>,
}

impl BestShotRun {
    /// Parses the files of a run. `origin` names the profile in messages.
    ///
    /// # Errors
    /// The profile is not valid, or a file is neither JSON nor CSV.
    pub fn parse(texts: &RunTexts, origin: &str) -> Result<Self, ReportError> {
        let profile = parse_profile(&texts.profile, origin)?;
        let best: Value =
            serde_json::from_str(&texts.best_shots).map_err(|error| ReportError::File {
                file: BEST_SHOTS_FILE,
                message: error.to_string(),
            })?;
        // The command line can choose other units than the profile's.
        let units = if best.get("distance_m").is_some() {
            UnitSystem::Metric
        } else {
            UnitSystem::Imperial
        };
        let profile = profile.with(|settings| settings.output.units = units)?;
        check_records(&best)?;
        let shots = read_shots(&profile, &best);
        check_shots(&shots)?;
        Ok(Self {
            aim: describe_aim(&profile, &best, &shots),
            shots,
            profile,
            curves: csv_rows(CURVES_FILE, texts.curves.as_deref())?,
            sensitivity: csv_rows(SENSITIVITY_FILE, texts.sensitivity.as_deref())?,
        })
    }
}

fn read_shots(profile: &Profile, best: &Value) -> Vec<ReportShot> {
    let (long, unit_m) = profile.output().units.length();
    ShotKind::ALL
        .into_iter()
        .filter_map(|kind| {
            let record = best.get(kind.name())?;
            let value = |name: &str| record.get(name).and_then(Value::as_f64);
            let shot = PlottedShot {
                kind,
                nominal: Nominal {
                    speed_m_s: value(&format!("speed_{long}_s"))? * unit_m,
                    pitch_rad: value("pitch_deg")? * DEGREE_RAD,
                    polar_rad: value("polar_deg")? * DEGREE_RAD,
                    backspin_rad_s: value("backspin_rev_s")? * REV_RAD,
                    side_spin_rad_s: value("side_spin_rev_s").unwrap_or(0.0) * REV_RAD,
                    // No search chooses the rifle spin, so the file does not have it.
                    rifle_spin_rad_s: profile.fixed_nominal().rifle_spin_rad_s,
                },
                probability: value("probability")?,
                standard_error: value("standard_error")?,
            };
            Some(ReportShot {
                place: 0,
                location: profile.location(),
                shot,
                mirror_of: None,
            })
        })
        .collect()
}

/// Refuses a shot whose probability is no number: it would be left out in silence.
fn check_records(best: &Value) -> Result<(), ReportError> {
    for kind in ShotKind::ALL {
        let record = best.get(kind.name());
        let is_shot = record.is_some_and(|record| record.get("pitch_deg").is_some());
        let probability = record.and_then(|record| record.get("probability")?.as_f64());
        if is_shot && probability.is_none() {
            return Err(ReportError::File {
                file: BEST_SHOTS_FILE,
                message: format!("{}.probability must be a number", kind.name()),
            });
        }
    }
    Ok(())
}

/// Refuses values that no run writes: the file was edited.
fn check_shots(shots: &[ReportShot]) -> Result<(), ReportError> {
    for ReportShot { shot, .. } in shots {
        let nominal = &shot.nominal;
        let checks = [
            ("probability", (0.0..=1.0).contains(&shot.probability)),
            ("standard_error", (0.0..=1.0).contains(&shot.standard_error)),
            ("speed", (0.0..=500.0).contains(&nominal.speed_m_s)),
            ("pitch", nominal.pitch_rad.abs() <= PI),
            ("polar", nominal.polar_rad.abs() <= PI),
            ("backspin", nominal.backspin_rad_s.abs() <= 1e4),
            ("side_spin", nominal.side_spin_rad_s.abs() <= 1e4),
        ];
        if let Some((name, _)) = checks.into_iter().find(|(_, holds)| !holds) {
            return Err(ReportError::File {
                file: BEST_SHOTS_FILE,
                message: format!(
                    "{}.{name} is out of range; the file was changed, run `best` again",
                    shot.kind.name()
                ),
            });
        }
    }
    Ok(())
}

/// Where the better shot is aimed.
fn describe_aim(profile: &Profile, best: &Value, shots: &[ReportShot]) -> String {
    let (short, _) = profile.output().units.short_length();
    let Some(better) = most_probable(shots) else {
        return String::new();
    };
    let record = &best[better.shot.kind.name()];
    let value = |name: String| record.get(name).and_then(Value::as_f64);
    let above = value(format!("board_aim_above_hoop_{short}"));
    let across = value(format!("board_aim_across_{short}"));
    let past = value(format!("aim_past_centre_{short}"));
    match (better.shot.kind, above.zip(across), past) {
        (ShotKind::Bank, Some((above, across)), _) => {
            let side = if across > 0.0 { "right" } else { "left" };
            format!(
                "; the ball's centre meets the board {above:.0} {short} above the ring and {:.0} {short} to the {side} of its middle line, facing the board",
                across.abs()
            )
        }
        (_, _, Some(past)) => {
            let side = if past < 0.0 { "short of" } else { "past" };
            format!(
                "; the path passes the ring's plane {:.1} {short} {side} its centre",
                past.abs()
            )
        }
        _ => String::new(),
    }
}

/// The rows of a CSV file, the header first; none if there is no file.
fn csv_rows(file: &'static str, text: Option<&str>) -> Result<Vec<Vec<String>>, ReportError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(text.unwrap_or_default().as_bytes());
    reader
        .records()
        .map(|record| Ok(record?.iter().map(str::to_owned).collect()))
        .collect::<Result<_, csv::Error>>()
        .map_err(|error| ReportError::File {
            file,
            message: error.to_string(),
        })
}
