//! Questions as data, for other programs: what is asked goes in, the answer for programs comes out.
//!
//! ```
//! use bankshot::answers::requests::Request;
//! use bankshot::probability::Silent;
//!
//! let toml = std::fs::read_to_string("configs/free_throw.toml")?;
//! let request: Request = serde_json::from_value(serde_json::json!({
//!     "question": "probability",
//!     "profile": { "toml": toml, "units": "metric" },
//!     "shot": { "speed": "24.4 ft/s", "pitch": "52 deg", "backspin": "3 rev/s" },
//!     "effort": { "target": 0.01 },
//! }))?;
//! let answered = request.answer(&Silent)?;
//! assert_eq!(answered.document["answer"], "probability");
//! assert!(answered.document["nominal"]["speed_m_s"].as_f64().unwrap() > 7.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::best_shots::{BestShotsAnswer, BestShotsDraft};
use super::checks::{CheckAnswer, Checked};
use super::json::{Provenance, document, in_si, in_units};
use super::nominal_shot::{FieldError, NominalRequest, ShotNote, notes_of_shot};
use super::probability::Effort;
use super::rebounds::{self, ReboundsAnswer};
use super::swarm::SwarmAnswer;
use super::trace::{TraceAnswer, points};
use crate::analysis::rebounds::find_rebounds;
use crate::best_shot::{self, BestShotError, DraftShot};
use crate::config::{ConfigError, parse_profile};
use crate::dynamics::StateError;
use crate::probability::Progress;
use crate::search_space::{PlanError, TablePlan};
use crate::shooter::{
    NominalVariable, Profile, ProfileError, implausible_values, nominal_values_not_fixed,
};
use crate::store::fit::{Fit, SHOTS, shot_over_draws};
use crate::units::{DEGREE_RAD, UnitSystem, rounded};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A profile as it is asked about.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProfileRequest {
    /// The text of the profile.
    pub toml: String,
    /// What to call it in messages.
    #[serde(default)]
    pub origin: String,
    /// The units of the answer; else those of the profile.
    #[serde(default)]
    pub units: Option<UnitSystem>,
    /// The distance from the hoop's centre, such as `12 ft`; else that of the profile.
    #[serde(default)]
    pub distance: Option<String>,
    /// The angle on the court; else that of the profile.
    #[serde(default)]
    pub angle: Option<String>,
    /// The preset of the physics, such as `ncaa`; else the physics of the profile.
    #[serde(default)]
    pub physics: Option<String>,
}

/// A question about a profile.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "question", rename_all = "snake_case", deny_unknown_fields)]
pub enum Request {
    /// Whether the profile is valid.
    Check {
        /// The profile.
        profile: ProfileRequest,
    },
    /// The best direct and the best bank shot.
    BestShots {
        /// The profile.
        profile: ProfileRequest,
    },
    /// P of a nominal shot.
    Probability {
        /// The profile.
        profile: ProfileRequest,
        /// The shot.
        #[serde(default)]
        shot: NominalRequest,
        /// How P is computed.
        #[serde(default)]
        effort: Effort,
        /// The height at which a rebound is within reach: with it, the answer says where the
        /// misses come down.
        #[serde(default)]
        reach: Option<String>,
    },
    /// The path of a nominal shot without errors.
    Trace {
        /// The profile.
        profile: ProfileRequest,
        /// The shot.
        #[serde(default)]
        shot: NominalRequest,
    },
    /// The paths of some simulated shots, each with its own errors.
    Swarm {
        /// The profile.
        profile: ProfileRequest,
        /// The shot.
        #[serde(default)]
        shot: NominalRequest,
        /// How many shots, at most [`MAX_SWARM`].
        shots: usize,
    },
}

/// What should be said beside an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// Of the profile, in words.
    Profile(String),
    /// Of the shot.
    Shot(ShotNote),
    /// The wanted standard error was not reached.
    Imprecise,
}

/// An answer for programs.
#[derive(Clone, Debug, PartialEq)]
pub struct Answered {
    /// The answer: see [`document`]. That of `trace` has the points of the path in `path`.
    pub document: Value,
    /// What should be said.
    pub notes: Vec<Note>,
}

/// Why a question has no answer.
#[derive(Debug, thiserror::Error)]
pub enum RequestError {
    /// The profile is not valid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The profile cannot be as it is asked for.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// Fields that are wrong.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Fields(Vec<FieldError>),
    /// The search cannot be planned.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The search cannot be made.
    #[error(transparent)]
    Search(#[from] BestShotError),
    /// The release is none.
    #[error(transparent)]
    State(#[from] StateError),
}

impl ProfileRequest {
    /// The text of the profile with the changes that are asked for.
    ///
    /// # Errors
    /// The text is no TOML, or has another value where a table should be.
    pub fn text(&self) -> Result<String, RequestError> {
        self.text_with(&NominalRequest::default())
    }

    /// The text with the changes that are asked for, and a shot in its table `[nominal]`.
    ///
    /// # Errors
    /// As [`Self::text`], and a shot that is wrong.
    pub fn text_with(&self, shot: &NominalRequest) -> Result<String, RequestError> {
        let changes = [
            ("location", "distance", &self.distance),
            ("location", "angle", &self.angle),
            ("physics", "preset", &self.physics),
        ];
        let is_unchanged = changes.iter().all(|(.., value)| value.is_none());
        if is_unchanged && !shot.is_given() {
            return Ok(self.toml.clone());
        }
        // The text as it is must be right first, so that a message is about what the user wrote.
        parse_profile(&self.toml, &self.origin)?;
        let unreadable = |error: toml_edit::TomlError| FieldError {
            field: "toml",
            message: error.to_string(),
        };
        let mut document: toml_edit::DocumentMut =
            (self.toml.parse()).map_err(|error| RequestError::Fields(vec![unreadable(error)]))?;
        if self.physics.is_some() {
            document.remove("physics");
        }
        for (table, key, value) in changes {
            let Some(value) = value else { continue };
            let item = document.entry(table).or_insert_with(toml_edit::table);
            if let Some(table) = item.as_table_like_mut() {
                table.insert(key, toml_edit::value(value.as_str()));
            }
        }
        let text = document.to_string();
        if !shot.is_given() {
            return Ok(text);
        }
        if let Some(units) = self.units {
            let output = document.entry("output").or_insert_with(toml_edit::table);
            output["units"] = toml_edit::value(in_si(&units).as_str().unwrap_or_default());
        }
        // As it is written; the direction from the court's long axis, which a profile has.
        let profile = parse_profile(&text, &self.origin)?;
        let nominal = shot.resolve(&profile).map_err(RequestError::Fields)?;
        let mut table = toml_edit::Table::new();
        for variable in NominalVariable::ALL {
            let value = match (variable, shot.given(variable)) {
                (_, Some(given)) => given.to_owned(),
                (NominalVariable::Polar, None) => {
                    format!("{} deg", rounded(nominal.polar_rad / DEGREE_RAD))
                }
                _ => continue,
            };
            table.insert(variable.name(), toml_edit::value(value));
        }
        document.insert("nominal", toml_edit::Item::Table(table));
        Ok(document.to_string())
    }

    /// The profile, and what should be said of it.
    fn read(&self) -> Result<(Profile, Vec<Note>), RequestError> {
        let mut profile = parse_profile(&self.text()?, &self.origin)?;
        if let Some(units) = self.units {
            profile = profile.with(|settings| settings.output.units = units)?;
        }
        let implausible = implausible_values(&profile).into_iter();
        let notes = implausible.map(|value| value.to_string());
        let notes = notes.chain(nominal_values_not_fixed(&profile, &[]));
        let notes = notes.map(Note::Profile).collect();
        Ok((profile, notes))
    }
}

impl Request {
    /// The answer.
    ///
    /// # Errors
    /// What is asked is wrong or not possible.
    pub fn answer(&self, progress: &dyn Progress) -> Result<Answered, RequestError> {
        self.answer_with_drafts(None, progress, &|_| ())
    }

    /// The answer. Before it, `draft` gets what is known early: of [`Self::BestShots`] the kind,
    /// the shot and P to 0.01 or so of each kind, in a fraction of the time; of
    /// [`Self::Probability`] the whole answer from [`DRAFT_SHOTS`], unless an effort was asked for.
    /// With the fit that the profile is of, the probability of a shot has its uncertainty.
    ///
    /// # Errors
    /// What is asked is wrong or not possible.
    pub fn answer_with_drafts(
        &self,
        fit: Option<&Fit>,
        progress: &dyn Progress,
        draft: &(dyn Fn(Value) + Sync),
    ) -> Result<Answered, RequestError> {
        match self {
            Self::Check { profile } => check(profile),
            Self::BestShots { profile } => {
                let (profile, notes) = profile.read()?;
                let units = profile.output().units;
                let early = |shots: &[DraftShot]| {
                    let answer = BestShotsDraft {
                        shots: shots.to_vec(),
                        provenance: Provenance::of(&profile),
                    };
                    draft(document(&answer, units));
                };
                let best = best_shot::find_with_draft(&profile, progress, &early)?;
                let answer = BestShotsAnswer::new(&profile, &best);
                let document = document(&answer, units);
                Ok(Answered { document, notes })
            }
            Self::Swarm {
                profile,
                shot,
                shots,
            } => swarm(profile, shot, *shots),
            Self::Probability {
                profile,
                shot,
                effort,
                reach,
            } => {
                if *effort == Effort::default() {
                    let rough = Effort {
                        budget: Some(DRAFT_SHOTS),
                        ..Effort::default()
                    };
                    draft(probability(profile, shot, &rough, None, (None, progress))?.document);
                }
                probability(profile, shot, effort, reach.as_deref(), (fit, progress))
            }
            Self::Trace { profile, shot } => trace(profile, shot),
        }
    }
}

fn check(request: &ProfileRequest) -> Result<Answered, RequestError> {
    let (profile, notes) = request.read()?;
    TablePlan::for_search(&profile)?;
    let answer = CheckAnswer {
        file: request.origin.clone(),
        is_valid: true,
        errors: Vec::new(),
        checked: Some(Checked::profile(&profile)),
        provenance: Some(Provenance::of(&profile)),
    };
    let document = document(&answer, profile.output().units);
    Ok(Answered { document, notes })
}

fn probability(
    profile: &ProfileRequest,
    shot: &NominalRequest,
    effort: &Effort,
    reach: Option<&str>,
    (fit, progress): (Option<&Fit>, &dyn Progress),
) -> Result<Answered, RequestError> {
    let (profile, mut notes) = profile.read()?;
    let nominal = shot.resolve(&profile).map_err(RequestError::Fields)?;
    let faulty = |error| RequestError::Fields(vec![error]);
    effort.check(&profile).map_err(faulty)?;
    let of_request = shot.notes(&profile, &nominal).into_iter();
    let of_shot = of_request.chain(notes_of_shot(&profile, &nominal));
    notes.extend(of_shot.map(Note::Shot));
    let reach_m = reach.map(rebounds::reach).transpose();
    let reach_m = reach_m.map_err(|message| {
        faulty(FieldError {
            field: "reach",
            message,
        })
    })?;
    let has_only_backspin = nominal.side_spin_rad_s == 0.0 && nominal.rifle_spin_rad_s == 0.0;
    let draws = fit
        .filter(|_| has_only_backspin)
        .map(|fit| shot_over_draws(&fit.posterior.draws, &profile, &nominal, SHOTS));
    let (mut answer, _) = effort.probability(&profile, &nominal, draws.as_ref(), progress)?;
    if let Some(reach_m) = reach_m.filter(|_| !effort.method.is_grid()) {
        let found = find_rebounds(&profile, &nominal, answer.provenance.seed, reach_m);
        answer.rebounds = Some(ReboundsAnswer::new(&profile, &found, reach_m));
    }
    if answer.target_met == Some(false) {
        notes.push(Note::Imprecise);
    }
    let document = document(&answer, profile.output().units);
    Ok(Answered { document, notes })
}

/// Simulated shots of the early answer about a shot: its standard error is 0.002 to 0.005.
pub const DRAFT_SHOTS: u64 = 4096;

/// Most shots of a swarm.
pub const MAX_SWARM: usize = 200;

fn swarm(
    profile: &ProfileRequest,
    shot: &NominalRequest,
    shots: usize,
) -> Result<Answered, RequestError> {
    let (profile, _) = profile.read()?;
    let nominal = shot.resolve(&profile).map_err(RequestError::Fields)?;
    if !(1..=MAX_SWARM).contains(&shots) {
        return Err(RequestError::Fields(vec![FieldError {
            field: "shots",
            message: format!("must be from 1 to {MAX_SWARM}"),
        }]));
    }
    let answer = SwarmAnswer::simulate(&profile, &nominal, shots)?;
    let document = document(&answer, profile.output().units);
    Ok(Answered {
        document,
        notes: Vec::new(),
    })
}

/// Spacing of the points of a path in flight, s.
pub const INTERVAL_S: f64 = 0.005;

fn trace(profile: &ProfileRequest, shot: &NominalRequest) -> Result<Answered, RequestError> {
    let (profile, mut notes) = profile.read()?;
    let nominal = shot.resolve(&profile).map_err(RequestError::Fields)?;
    notes.extend(shot.notes(&profile, &nominal).into_iter().map(Note::Shot));
    let release = profile.release(&nominal);
    let trace = profile.simulator().trace(&release, INTERVAL_S)?;
    let units = profile.output().units;
    let mut document = document(&TraceAnswer::new(&profile, &trace), units);
    document["path"] = in_units(&points(&trace), units);
    Ok(Answered { document, notes })
}
