//! The nominal shot of a command: from the flags, then from the profile's table `[nominal]`.

use super::failure::Failure;
use crate::shooter::{Nominal, NominalVariable, Profile};
use crate::units::{self, DEGREE_RAD, REV_RAD};
use clap::Args;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Greatest speed of a release, m/s.
const MAX_SPEED_M_S: f64 = 1000.0;
/// Greatest spin of a release, rad/s.
const MAX_SPIN_RAD_S: f64 = 10_000.0;

/// The flags of a nominal shot. Each overrides the profile's `[nominal]` table.
#[derive(Args, Debug, Default)]
pub(crate) struct NominalOptions {
    /// Speed of the release, such as '23.5 ft/s'.
    #[arg(long, allow_hyphen_values = true)]
    speed: Option<String>,
    /// Pitch angle of the release, such as '52 deg'.
    #[arg(long, allow_hyphen_values = true)]
    pitch: Option<String>,
    /// Polar angle of the release, from the court's long axis like the court angle [default: the
    /// profile's, else that towards the hoop's centre].
    #[arg(long, allow_hyphen_values = true)]
    polar: Option<String>,
    /// Instead of --polar: the angle of the release from the line to the hoop's centre, such as
    /// '0.3 deg'.
    #[arg(long, allow_hyphen_values = true, conflicts_with = "polar")]
    aim: Option<String>,
    /// Backspin [default: the profile's, else its max_backspin].
    #[arg(long, allow_hyphen_values = true)]
    backspin: Option<String>,
    /// Spin about the horizontal direction of the shot [default: the profile's, else none].
    #[arg(long, allow_hyphen_values = true)]
    rifle_spin: Option<String>,
    /// Spin about the vertical [default: the profile's, else none].
    #[arg(long, allow_hyphen_values = true)]
    side_spin: Option<String>,
}

impl NominalOptions {
    fn flag(&self, variable: NominalVariable) -> (&'static str, Option<&str>) {
        let (name, text) = match variable {
            NominalVariable::Speed => ("speed", &self.speed),
            NominalVariable::Pitch => ("pitch", &self.pitch),
            NominalVariable::Polar => ("polar", &self.polar),
            NominalVariable::Backspin => ("backspin", &self.backspin),
            NominalVariable::RifleSpin => ("rifle-spin", &self.rifle_spin),
            NominalVariable::SideSpin => ("side-spin", &self.side_spin),
        };
        (name, text.as_deref())
    }

    /// The nominal shot.
    pub(crate) fn resolve(&self, profile: &Profile) -> Result<Nominal, Failure> {
        self.resolve_with(profile, None)
    }

    /// The nominal shot with a value (SI) that is given in place of the one of the flags.
    pub(crate) fn resolve_with(
        &self,
        profile: &Profile,
        given: Option<(NominalVariable, f64)>,
    ) -> Result<Nominal, Failure> {
        let mut nominal = Nominal::default();
        let mut errors = Vec::new();
        for variable in NominalVariable::ALL {
            let value = match given {
                Some((of, value)) if of == variable => match allowed(variable, value) {
                    None => Ok(value),
                    Some(allowed) => Err(format!("the {} must be {allowed}", variable.name())),
                },
                _ => self.value(variable, profile),
            };
            match value {
                Ok(value) => *nominal.get_mut(variable) = value,
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() {
            Ok(nominal)
        } else {
            Err(Failure::usage(errors.join("\n")))
        }
    }

    /// Whether a flag gives anything.
    pub(crate) fn has_flags(&self) -> bool {
        let by_flag = |variable| self.flag(variable).1.is_some();
        self.aim.is_some() || NominalVariable::ALL.into_iter().any(by_flag)
    }

    /// Whether a flag gives anything, or the profile the speed or the pitch angle.
    pub(crate) fn is_given(&self, profile: &Profile) -> bool {
        let by_profile = |variable| profile.nominal_overrides().get(variable).is_some();
        self.has_flags() || by_profile(NominalVariable::Speed) || by_profile(NominalVariable::Pitch)
    }

    /// Warnings: the error-free shot touches nothing and misses, which is seldom meant; it is
    /// beyond the limits that searches keep to.
    pub(crate) fn warnings(profile: &Profile, nominal: &Nominal) -> Vec<String> {
        let mut warnings = Vec::new();
        let search = &profile.settings().search;
        for (name, beyond) in [
            ("speed", search.speed_beyond_limit(nominal.speed_m_s)),
            ("pitch", search.pitch_beyond_limits(nominal.pitch_rad)),
        ] {
            warnings.extend(beyond.map(|words| {
                format!("warning: the {name} {words}: no search would give this shot")
            }));
        }
        let most = profile.shooter().max_backspin_rad_s;
        if nominal.backspin_rad_s > most + 1e-9 {
            warnings.push(format!(
                "warning: the backspin is more than shooter.max_backspin ({:.3} rev/s): no search would give this shot",
                most / REV_RAD
            ));
        }
        let start = profile.release(nominal);
        let missed = profile
            .simulator()
            .simulate(&start)
            .is_ok_and(|outcome| !outcome.verdict.made && outcome.verdict.contacts.count() == 0);
        if missed {
            let towards_deg = profile.location().angle_rad / DEGREE_RAD;
            let polar_deg = nominal.polar_rad / DEGREE_RAD;
            let mut text =
                "warning: without errors this shot touches nothing and misses.".to_owned();
            if (polar_deg - towards_deg).abs() > 0.005 {
                text += &format!(
                    " Its polar angle is {polar_deg:.2} deg; that towards the hoop's centre is {towards_deg:.2} deg (--aim gives the angle from there)."
                );
            }
            warnings.push(text);
        }
        warnings
    }

    /// Warnings about what the flags give and leave out: nobody gave the backspin, though the
    /// profile allows some; a ball so fast that the board cannot stop it.
    pub(crate) fn warnings_of_flags(&self, profile: &Profile, nominal: &Nominal) -> Vec<String> {
        let mut warnings = Vec::new();
        let spin = nominal.backspin_rad_s;
        let is_given =
            self.backspin.is_some() || profile.nominal_overrides().backspin_rad_s.is_some();
        if !is_given && spin > 0.0 {
            warnings.push(format!(
                "warning: the backspin is not given: {:.3} rev/s, the profile's max_backspin, is used; give another with --backspin",
                spin / REV_RAD
            ));
        }
        let most = profile.physics().max_contact_speed_m_s();
        if nominal.speed_m_s > most {
            warnings.push(format!(
                "warning: above {most:.1} m/s board and ring cannot stop this ball: it may pass through them"
            ));
        }
        warnings
    }

    fn value(&self, variable: NominalVariable, profile: &Profile) -> Result<f64, String> {
        if let (NominalVariable::Polar, Some(aim)) = (variable, &self.aim) {
            let aim_rad = units::parse(aim, variable.dimension())
                .map_err(|error| format!("--aim: {error}"))?;
            return Ok(profile.location().angle_rad + aim_rad);
        }
        let (flag, text) = self.flag(variable);
        if let Some(text) = text {
            let value = units::parse(text, variable.dimension())
                .map_err(|error| format!("--{flag}: {error}"))?;
            return match allowed(variable, value) {
                None => Ok(value),
                Some(allowed) => Err(format!("--{flag}: must be {allowed}, not '{text}'")),
            };
        }
        let default = match variable {
            NominalVariable::Speed | NominalVariable::Pitch => None,
            NominalVariable::Polar => Some(profile.location().angle_rad),
            NominalVariable::Backspin => Some(profile.shooter().max_backspin_rad_s),
            NominalVariable::RifleSpin | NominalVariable::SideSpin => Some(0.0),
        };
        profile
            .nominal_overrides()
            .get(variable)
            .or(default)
            .ok_or_else(|| {
                format!(
                    "--{flag} is missing; give it, or {flag} in the profile's [nominal] table (`bankshot best` finds a shot)"
                )
            })
    }
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
