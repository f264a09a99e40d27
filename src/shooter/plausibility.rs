//! Values that a profile may have, but that no player is known to have.

use super::profile::Profile;
use super::release_variable::NominalVariable;
use crate::model::{Preset, SolidId};
use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD, UnitSystem};

/// The speed that the scatter of speeds is looked at, m/s: that of a free throw.
const USUAL_SPEED_M_S: f64 = 7.4;

/// Balls below this mass are no basketballs of any size, g.
const LIGHTEST_BASKETBALL_G: f64 = 300.0;

/// A value that no player is known to have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Implausible {
    /// Its key in a profile.
    pub key: &'static str,
    /// Why, in words.
    pub why: String,
}

impl std::fmt::Display for Implausible {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "{}: {}", self.key, self.why)
    }
}

/// What is implausible about a profile, each as a sentence; nothing for a profile of a player.
///
/// Measured scatters are 0.15 to 0.45 ft/s and 0.8 to 2.7 deg; the limits here are three times and
/// more that. The heights of release and the distances are those of people on a court.
#[must_use]
pub fn implausible_values(profile: &Profile) -> Vec<Implausible> {
    let shooter = profile.shooter();
    let errors = &shooter.dispersion;
    let feet = |length_m: f64| length_m / FOOT_M;
    let speed_sd =
        errors.c10_m_s + USUAL_SPEED_M_S * (errors.c11 + USUAL_SPEED_M_S * errors.c12_s_m);
    let distance_m = profile.location().distance_m;
    let units = profile.output().units;
    let (physics, nominal) = (profile.physics(), profile.nominal_overrides());
    let mut found = Vec::new();
    let mut say = |is_odd: bool, key: &'static str, why: String| {
        if is_odd {
            found.push(Implausible { key, why });
        }
    };
    let height = feet(shooter.release_height_m);
    say(
        !(1.5..=9.5).contains(&height),
        "shooter.release_height",
        match units {
            UnitSystem::Imperial => {
                format!("a release {height:.1} ft above the floor; players release at 5 to 9 ft")
            }
            UnitSystem::Metric => format!(
                "a release {:.3} m above the floor; players release at 1.5 to 2.7 m",
                shooter.release_height_m
            ),
        },
    );
    say(
        feet(speed_sd) > 1.5,
        "shooter.errors",
        match units {
            UnitSystem::Imperial => format!(
                "speeds scatter by {:.1} ft/s (one standard deviation); players by 0.15 to 0.45 ft/s",
                feet(speed_sd)
            ),
            UnitSystem::Metric => format!(
                "speeds scatter by {speed_sd:.2} m/s (one standard deviation); players by 0.05 to 0.14 m/s"
            ),
        },
    );
    for (key, angle_rad) in [
        ("shooter.errors.c20 (pitch)", errors.c20_rad),
        ("shooter.errors.c30 (polar)", errors.c30_rad),
    ] {
        let angle = angle_rad / DEGREE_RAD;
        say(
            angle > 6.0,
            key,
            format!(
                "angles scatter by {angle:.1} deg (one standard deviation); players by 0.8 to 2.7 deg"
            ),
        );
    }
    let spin_sd = errors.c40_rad_s / REV_RAD;
    say(
        spin_sd > 1.5,
        "shooter.errors.c40 (backspin)",
        format!(
            "spins scatter by {spin_sd:.1} rev/s (one standard deviation); players by about 0.3 rev/s"
        ),
    );
    let most_spin = shooter.max_backspin_rad_s / REV_RAD;
    say(
        most_spin > 6.0,
        "shooter.max_backspin",
        format!("{most_spin:.1} rev/s; players reach 2 to 3 rev/s"),
    );
    say(
        feet(distance_m) > 35.0,
        "location",
        match units {
            UnitSystem::Imperial => format!(
                "{:.0} ft from the hoop; three-point shots are from 20 to 30 ft, half a court is 42 ft",
                feet(distance_m)
            ),
            UnitSystem::Metric => format!(
                "{distance_m:.1} m from the hoop; three-point shots are from 6 to 9 m, half a court is 13 m"
            ),
        },
    );
    if let Some(pitch_rad) = nominal.pitch_rad {
        let pitch = pitch_rad / DEGREE_RAD;
        say(
            !(20.0..=80.0).contains(&pitch),
            "nominal.pitch",
            format!("{pitch:.1} deg above the horizontal; players release at 35 to 65 deg"),
        );
    }
    let mass_g = 1000.0 * physics.ball_mass_kg;
    let of_basketballs = Preset::named("ncaa").map(|preset| preset.physics());
    say(
        mass_g < LIGHTEST_BASKETBALL_G
            && of_basketballs.is_some_and(|usual| {
                [SolidId::Board, SolidId::Ring].into_iter().all(|solid| {
                    let difference = usual.restitution_on(solid) - physics.restitution_on(solid);
                    libm::fabs(difference) < 0.001
                })
            }),
        "physics.ball_mass",
        format!(
            "a ball of {mass_g:.0} g with the bounce of a basketball (board_restitution {:.2}, hoop_restitution {:.2}); give both, from a drop test: the square root of bounce height over drop height; and inertia_ratio, 0.4 for a solid ball",
            physics.restitution_on(SolidId::Board),
            physics.restitution_on(SolidId::Ring)
        ),
    );
    found
}

/// What to write where `[nominal]` gives some values, but no speed, and the search chooses them all
/// the same: they were probably meant to be fixed. (With a speed they are a shot to look at.) Those
/// that are `fixed` in another way are left out.
#[must_use]
pub fn nominal_values_not_fixed(profile: &Profile, fixed: &[NominalVariable]) -> Option<String> {
    let given = profile.nominal_overrides();
    let choice = profile.search().choice;
    let searched =
        |variable: &NominalVariable| choice.includes(*variable) && !fixed.contains(variable);
    let names = |variables: &[NominalVariable], quote: &str, before: &str| {
        let names = variables.iter().map(|variable| variable.name());
        let names = names.map(|name| format!("{quote}{before}{name}{quote}"));
        names.collect::<Vec<_>>().join(", ")
    };
    let not_fixed: Vec<NominalVariable> = NominalVariable::SEARCHABLE
        .into_iter()
        .filter(|variable| given.get(*variable).is_some() && searched(variable))
        .collect();
    if not_fixed.is_empty() || given.get(NominalVariable::Speed).is_some() {
        return None;
    }
    let left = NominalVariable::SEARCHABLE.into_iter().filter(searched);
    let left = left.filter(|variable| !not_fixed.contains(variable));
    Some(format!(
        "{}: given, but the search chooses {}; to keep what is given, write choose = [{}] in [search]",
        names(&not_fixed, "", "nominal."),
        if not_fixed.len() > 1 { "them" } else { "it" },
        names(&left.collect::<Vec<_>>(), "\"", "")
    ))
}
