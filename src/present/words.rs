//! The words of the glossary: one name for each quantity, in every text.

use crate::model::{PRESETS, Preset, SolidId};
use crate::shooter::{Location, NominalVariable, Profile, ReleaseVariable, ShotKind};
use crate::units::{UnitSystem, with_decimals};

/// How many of 100 go in, as a whole number: `78`, `more than 99`.
#[must_use]
pub fn of_100(probability: f64) -> String {
    match probability {
        p if p >= 0.995 => "more than 99".to_owned(),
        p if p > 0.0 && p < 0.005 => "fewer than 1".to_owned(),
        p => format!("{:.0}", 100.0 * p),
    }
}

/// The text with a capital at its beginning.
#[must_use]
pub fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    let first = characters
        .next()
        .map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + characters.as_str()
}

/// A number in groups of three digits.
#[must_use]
pub fn with_commas(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number per 100 with one decimal: `78.1`.
#[must_use]
pub fn per_100(probability: f64) -> String {
    format!("{:.1}", with_decimals(100.0 * probability, 1))
}

/// A difference per 100 with its sign and one decimal: `+3.9`.
#[must_use]
pub fn difference_per_100(difference: f64) -> String {
    format!("{:+.1}", with_decimals(100.0 * difference, 1))
}

/// The ends of an interval per 100, whole: `65 to 76`.
#[must_use]
pub fn interval_of_100(low: f64, high: f64) -> String {
    format!("{:.0} to {:.0}", 100.0 * low, 100.0 * high)
}

/// The ends of an interval of a difference per 100, one decimal: `+4.2 to +9.4`.
#[must_use]
pub fn difference_interval(low: f64, high: f64) -> String {
    format!(
        "{} to {}",
        difference_per_100(low),
        difference_per_100(high)
    )
}

/// A probability as a percentage that is never 0 or 100: `below 1 %`, `84 %`, `above 99 %`.
#[must_use]
pub fn likely(probability: f64) -> String {
    match probability {
        p if p < 0.01 => "below 1 %".to_owned(),
        p if p > 0.99 => "above 99 %".to_owned(),
        p => format!("{:.0} %", 100.0 * p),
    }
}

/// The name of a variable of the release in text.
#[must_use]
pub fn variable_name(variable: ReleaseVariable) -> &'static str {
    match variable {
        ReleaseVariable::Speed => "speed",
        ReleaseVariable::Pitch => "angle",
        ReleaseVariable::Polar => "direction",
        ReleaseVariable::Backspin => "backspin",
        ReleaseVariable::RifleSpin => "rifle spin",
        ReleaseVariable::SideSpin => "side spin",
        ReleaseVariable::Distance => "distance",
        ReleaseVariable::CourtAngle => "court angle",
        ReleaseVariable::Height => "release height",
    }
}

/// Name of a nominal value.
#[must_use]
pub fn nominal_name(variable: NominalVariable) -> &'static str {
    match variable {
        NominalVariable::Speed => "speed",
        NominalVariable::Pitch => "angle",
        NominalVariable::Polar => "direction",
        NominalVariable::Backspin => "backspin",
        NominalVariable::RifleSpin => "rifle spin",
        NominalVariable::SideSpin => "side spin",
    }
}

/// What a player does with a kind of shot: `Bank it`.
#[must_use]
pub fn do_it(kind: ShotKind) -> &'static str {
    match kind {
        ShotKind::Direct => "Shoot direct",
        ShotKind::Bank => "Bank it",
    }
}

/// `a, b and c`.
#[must_use]
pub fn list(words: &[String]) -> String {
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
        None => String::new(),
    }
}

/// The physics by its name; of a preset with another ring, as fits have it, with the ring.
#[must_use]
pub fn physics_name(profile: &Profile) -> String {
    let physics = profile.physics();
    match Preset::of(physics).map(|preset| preset.name) {
        Some("paper") => return "paper (no air, a ring of wire; not a real gym)".to_owned(),
        Some(name) => return name.to_owned(),
        None => {}
    }
    // A fitted ring has three decimals.
    let ring = (1000.0 * physics.restitution_on(SolidId::Ring)).round() / 1000.0;
    let with_own_ring = PRESETS.iter().find(|preset| {
        let mut other = preset.physics();
        other.set_restitution_on(SolidId::Ring, ring).is_ok() && other == *physics
    });
    match with_own_ring {
        Some(preset) => {
            format!("{}, ring restitution {ring:.2}", preset.name)
        }
        None => "the profile's own".to_owned(),
    }
}

/// Who, where, and under which physics.
#[must_use]
pub fn subject(profile: &Profile, units: UnitSystem) -> String {
    subject_at(profile, &profile.location(), units)
}

/// As [`subject`], at another place.
#[must_use]
pub fn subject_at(profile: &Profile, place: &Location, units: UnitSystem) -> String {
    let place = place.in_words(units);
    let who = match profile.shooter().name.as_str() {
        "" => String::new(),
        name => format!("{name}: "),
    };
    format!("{who}{place}. Physics: {}.", physics_name(profile))
}

/// The changes of the scatter, as they were typed.
#[must_use]
pub fn scatter_note(scatter: &[String]) -> Option<String> {
    let flags = scatter.iter().map(|text| format!("--scatter '{text}'"));
    let flags: Vec<String> = flags.collect();
    (!flags.is_empty()).then(|| format!("The scatter was changed: {}.", flags.join(" ")))
}

/// What the numbers leave out: the profile as it is, or the fit whose shots are counted in.
#[must_use]
pub fn taken_as_exact(has_draws: bool) -> &'static str {
    match has_draws {
        true => "This assumes a standard ring.",
        false => "This assumes that your scatter is right and the ring is standard.",
    }
}

/// A simulation error per 100, with as many decimals as it needs.
#[must_use]
pub fn simulation_error(standard_error: f64) -> String {
    format!(
        "{:.*}",
        error_decimals(standard_error),
        100.0 * standard_error
    )
}

/// A number per 100 with the decimals of its simulation error.
#[must_use]
pub fn per_100_with_error(probability: f64, standard_error: f64) -> String {
    let decimals = error_decimals(standard_error);
    format!(
        "{:.decimals$}",
        with_decimals(100.0 * probability, decimals as i32)
    )
}

/// Decimals that show the first digit of an error per 100.
fn error_decimals(standard_error: f64) -> usize {
    /// More digits are never known.
    const MOST: usize = 8;
    let error = 100.0 * standard_error;
    // Rounded up to the next decimal: 0.095 is 0.1.
    (1..MOST)
        .find(|decimals| error >= 0.95 * libm::pow(10.0, -(*decimals as f64)))
        .unwrap_or(1)
}
