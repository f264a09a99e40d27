//! The nominal shot of a command: from the flags, then from the profile's table `[nominal]`.

use super::failure::Failure;
use super::terminal::{is_quiet, print_remark};
use crate::answers::nominal_shot::{FieldError, NominalRequest, ShotNote};
use crate::present::shot_note_text::shot_note_text;
use crate::shooter::{Nominal, NominalVariable, Profile};
use clap::Args;

/// The flags of a nominal shot. Each overrides the profile's `[nominal]` table.
#[derive(Args, Debug, Default)]
pub(crate) struct NominalOptions {
    /// Speed of the release, such as '23.5 ft/s'.
    #[arg(long, allow_hyphen_values = true)]
    speed: Option<String>,
    /// Pitch angle of the release, such as '52 deg'.
    #[arg(long, allow_hyphen_values = true)]
    pitch: Option<String>,
    /// Direction of the release, from the court's long axis: the court angle towards the hoop's
    /// centre, greater to the left of it [default: the profile's, else the centre].
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
    /// What is asked about.
    pub(crate) fn request(&self) -> NominalRequest {
        NominalRequest {
            speed: self.speed.clone(),
            pitch: self.pitch.clone(),
            polar: self.polar.clone(),
            aim: self.aim.clone(),
            backspin: self.backspin.clone(),
            rifle_spin: self.rifle_spin.clone(),
            side_spin: self.side_spin.clone(),
        }
    }

    /// The nominal shot.
    pub(crate) fn resolve(&self, profile: &Profile) -> Result<Nominal, Failure> {
        self.request()
            .resolve(profile)
            .map_err(|errors| of_flags(&errors))
    }

    /// The nominal shot with a value (SI) that is given in place of the one of the flags.
    pub(crate) fn resolve_with(
        &self,
        profile: &Profile,
        given: (NominalVariable, f64),
    ) -> Result<Nominal, Failure> {
        let request = self.request();
        let resolved = request.resolve_with(profile, Some(given));
        resolved.map_err(|errors| of_flags(&errors))
    }

    /// Whether a flag gives anything, or the profile the speed or the pitch angle.
    pub(crate) fn is_given(&self, profile: &Profile) -> bool {
        let by_profile = |variable| profile.nominal_overrides().get(variable).is_some();
        self.request().is_given()
            || by_profile(NominalVariable::Speed)
            || by_profile(NominalVariable::Pitch)
    }
}

/// The fields of a request are flags here.
pub(crate) fn of_flags(errors: &[FieldError]) -> Failure {
    let lines = errors
        .iter()
        .map(|FieldError { field, message }| format!("--{}: {message}", field.replace('_', "-")));
    Failure::usage(lines.collect::<Vec<_>>().join("\n"))
}

/// Prints notes on shots, once each.
pub(crate) fn print_notes(notes: impl IntoIterator<Item = ShotNote>) {
    if is_quiet() {
        return;
    }
    let mut printed: Vec<ShotNote> = Vec::new();
    for note in notes {
        if !printed.contains(&note) {
            print_remark(&format!("warning: {}", shot_note_text(&note)));
            printed.push(note);
        }
    }
}
