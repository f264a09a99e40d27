//! The nominal shot of a question: from what is given, then from the profile's table `[nominal]`.

use crate::shooter::{Nominal, NominalVariable, Profile};
use crate::units;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Greatest speed of a release, m/s.
const MAX_SPEED_M_S: f64 = 1000.0;
/// Greatest spin of a release, rad/s.
const MAX_SPIN_RAD_S: f64 = 10_000.0;

/// What is wrong with a field of a request.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{field}: {message}")]
pub struct FieldError {
    /// The field, such as `rifle_spin`.
    pub field: &'static str,
    /// What is wrong, and what to write.
    pub message: String,
}

/// A nominal shot as it is asked about: quantities with their units, such as `24.3 ft/s`. What is
/// not given comes from the profile.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NominalRequest {
    /// The speed of the release.
    pub speed: Option<String>,
    /// The release angle, above the horizontal.
    pub pitch: Option<String>,
    /// The direction, from the court's long axis; else that towards the hoop's centre.
    pub polar: Option<String>,
    /// The direction, from the line to the hoop's centre, in place of `polar`.
    pub aim: Option<String>,
    /// The backspin; else the profile's `max_backspin`.
    pub backspin: Option<String>,
    /// The spin about the horizontal direction of the shot; else none.
    pub rifle_spin: Option<String>,
    /// The spin about the vertical; else none.
    pub side_spin: Option<String>,
}

/// What is doubtful about a nominal shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "code", rename_all = "snake_case")]
pub enum ShotNote {
    /// Nobody gave the backspin, though the profile allows some.
    BackspinNotGiven {
        /// The profile's `max_backspin`, which is used.
        backspin_rad_s: f64,
    },
    /// The ball is so fast that board and ring cannot stop it.
    MayPassThrough {
        /// Up to this speed they can.
        most_m_s: f64,
    },
    /// A value is beyond the limits that searches keep to.
    BeyondSearch {
        /// `speed` or `pitch`.
        of: NominalVariable,
        /// How it is beyond them, in words.
        how: String,
    },
    /// The backspin is more than the shooter gives.
    BeyondBackspin {
        /// The profile's `max_backspin`.
        most_rad_s: f64,
    },
    /// Without errors the shot touches nothing and misses.
    TouchesNothing {
        /// Its polar angle.
        polar_rad: f64,
        /// That towards the hoop's centre.
        towards_rad: f64,
    },
}

impl NominalRequest {
    /// What is given of a variable.
    #[must_use]
    pub fn given(&self, variable: NominalVariable) -> Option<&str> {
        let text = match variable {
            NominalVariable::Speed => &self.speed,
            NominalVariable::Pitch => &self.pitch,
            NominalVariable::Polar => &self.polar,
            NominalVariable::Backspin => &self.backspin,
            NominalVariable::RifleSpin => &self.rifle_spin,
            NominalVariable::SideSpin => &self.side_spin,
        };
        text.as_deref()
    }

    /// Whether anything is given.
    #[must_use]
    pub fn is_given(&self) -> bool {
        *self != Self::default()
    }

    /// The nominal shot.
    ///
    /// # Errors
    /// Every value that is missing, no quantity, or not possible.
    pub fn resolve(&self, profile: &Profile) -> Result<Nominal, Vec<FieldError>> {
        self.resolve_with(profile, None)
    }

    /// The nominal shot with a value (SI) in place of the one that is given.
    ///
    /// # Errors
    /// See [`Self::resolve`].
    pub fn resolve_with(
        &self,
        profile: &Profile,
        given: Option<(NominalVariable, f64)>,
    ) -> Result<Nominal, Vec<FieldError>> {
        let mut nominal = Nominal::default();
        let mut errors = Vec::new();
        for variable in NominalVariable::ALL {
            let value = match given {
                Some((of, value)) if of == variable => match allowed(variable, value) {
                    None => Ok(value),
                    Some(allowed) => Err(FieldError {
                        field: variable.name(),
                        message: format!("must be {allowed}"),
                    }),
                },
                _ => self.value(variable, profile),
            };
            match value {
                Ok(value) => *nominal.get_mut(variable) = value,
                Err(error) => errors.push(error),
            }
        }
        match errors.is_empty() {
            true => Ok(nominal),
            false => Err(errors),
        }
    }

    fn value(&self, variable: NominalVariable, profile: &Profile) -> Result<f64, FieldError> {
        let error = |field, message| FieldError { field, message };
        let parse = |field, text: &str| {
            units::parse(text, variable.dimension()).map_err(|e| error(field, e.to_string()))
        };
        if let (NominalVariable::Polar, Some(aim)) = (variable, &self.aim) {
            return Ok(profile.location().angle_rad + parse("aim", aim)?);
        }
        let field = variable.name();
        if let Some(text) = self.given(variable) {
            let value = parse(field, text)?;
            return match allowed(variable, value) {
                None => Ok(value),
                Some(allowed) => Err(error(field, format!("must be {allowed}, not '{text}'"))),
            };
        }
        let default = match variable {
            NominalVariable::Speed | NominalVariable::Pitch => None,
            NominalVariable::Polar => Some(profile.location().angle_rad),
            NominalVariable::Backspin => Some(profile.shooter().max_backspin_rad_s),
            NominalVariable::RifleSpin | NominalVariable::SideSpin => Some(0.0),
        };
        let own = profile.nominal_overrides().get(variable);
        own.or(default).ok_or_else(|| {
            error(
                field,
                format!(
                    "is missing: give it, or set {field} in the profile's [nominal] table; `bankshot best` finds a good shot"
                ),
            )
        })
    }

    /// What is doubtful about what is given and left out.
    #[must_use]
    pub fn notes(&self, profile: &Profile, nominal: &Nominal) -> Vec<ShotNote> {
        let mut notes = Vec::new();
        let backspin_rad_s = nominal.backspin_rad_s;
        let is_given =
            self.backspin.is_some() || profile.nominal_overrides().backspin_rad_s.is_some();
        if !is_given && backspin_rad_s > 0.0 {
            notes.push(ShotNote::BackspinNotGiven { backspin_rad_s });
        }
        let most_m_s = profile.physics().max_contact_speed_m_s();
        if nominal.speed_m_s > most_m_s {
            notes.push(ShotNote::MayPassThrough { most_m_s });
        }
        notes
    }
}

/// What is doubtful about a shot of a profile, whoever gave it.
#[must_use]
pub fn notes_of_shot(profile: &Profile, nominal: &Nominal) -> Vec<ShotNote> {
    let search = &profile.settings().search;
    let beyond = [
        (
            NominalVariable::Speed,
            search.speed_beyond_limit(nominal.speed_m_s),
        ),
        (
            NominalVariable::Pitch,
            search.pitch_beyond_limits(nominal.pitch_rad),
        ),
    ];
    let beyond = beyond
        .into_iter()
        .filter_map(|(of, how)| Some(ShotNote::BeyondSearch { of, how: how? }));
    let mut notes: Vec<ShotNote> = beyond.collect();
    let most_rad_s = profile.shooter().max_backspin_rad_s;
    if nominal.backspin_rad_s > most_rad_s + 1e-9 {
        notes.push(ShotNote::BeyondBackspin { most_rad_s });
    }
    let outcome = profile.simulator().simulate(&profile.release(nominal));
    let touches_nothing =
        outcome.is_ok_and(|outcome| !outcome.verdict.made && outcome.verdict.contacts.count() == 0);
    if touches_nothing {
        notes.push(ShotNote::TouchesNothing {
            polar_rad: nominal.polar_rad,
            towards_rad: profile.location().angle_rad,
        });
    }
    notes
}

/// The allowed values, if `value` is not one of them.
fn allowed(variable: NominalVariable, value: f64) -> Option<&'static str> {
    match variable {
        NominalVariable::Speed => {
            (!(0.0..=MAX_SPEED_M_S).contains(&value)).then_some("from 0 to 1000 m/s")
        }
        NominalVariable::Pitch => (!(value.abs() <= FRAC_PI_2)).then_some("from -90 to 90 deg"),
        NominalVariable::Polar => (!(value.abs() <= TAU)).then_some("from -360 to 360 deg"),
        NominalVariable::Backspin | NominalVariable::RifleSpin | NominalVariable::SideSpin => {
            (!(value.abs() <= MAX_SPIN_RAD_S)).then_some("within 10000 rad/s")
        }
    }
}
