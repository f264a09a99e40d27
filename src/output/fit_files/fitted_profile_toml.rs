//! `profile.toml`: the fitted profile, each value with what is known of it.

use super::fit_json::FitSource;
use super::parameters::{parameters, value_units};
use crate::fitting::{ShooterFit, SpinSource, VALUE_NAMES};
use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD, UnitSystem};

/// The text of the profile at the first place. `physics` is the text of its `[physics]` table.
#[must_use]
pub fn fitted_profile_toml(fit: &ShooterFit, source: &FitSource<'_>, physics: &str) -> String {
    let listed = parameters(&fit.posterior, source.kind, UnitSystem::Imperial);
    let comment = |name: &str| {
        let found = listed.iter().find(|parameter| parameter.name == name);
        found.map_or_else(String::new, |parameter| {
            let interval = &parameter.interval;
            let unit = if parameter.unit.is_empty() {
                String::new()
            } else {
                format!(" {}", parameter.unit)
            };
            format!(
                "# {}: {:.3}{unit}, 95 % {:.3} to {:.3}, {}",
                parameter.name, interval.mean, interval.low, interval.high, parameter.source
            )
        })
    };
    let place = &fit.places[0];
    let shooter = fit.profiles[0].shooter();
    let errors = &shooter.dispersion;
    let mut text = String::new();
    let mut line = |words: String| {
        text += &words;
        text.push('\n');
    };
    line(format!(
        "# Fitted by `bankshot fit` to {} {} of {}.",
        fit.posterior.shots,
        source.kind,
        quoted(&source.file)
    ));
    line(format!(
        "# Tracker: {} (its noise is {}). Physics: {}. The profile holds for this physics.",
        source.tracker.0, source.tracker.1, source.physics
    ));
    line("# An error is the root mean square over all draws; its interval and its source are beside it.".to_owned());
    if fit.places.len() > 1 {
        line(format!(
            "# The location, the usual shot and `speed` are those of the first of {} places.",
            fit.places.len()
        ));
    }
    for warning in &fit.warnings {
        line(format!("# Warning: {warning}."));
    }
    line(String::new());
    line("[shooter]".to_owned());
    line(format!("name = {}", quoted(&fit.name)));
    line(format!(
        "release_height = \"{:.4} ft\"",
        place.release_height_m / FOOT_M
    ));
    line(format!(
        "max_backspin = \"{:.3} rev/s\"  # assumed; a search for the best shot goes up to it",
        shooter.max_backspin_rad_s / REV_RAD
    ));
    line(String::new());
    line("[shooter.errors]".to_owned());
    let has_growth = fit.posterior.growth_terms > 0;
    let of_speed = comment("speed_sd");
    line(format!(
        "speed = \"{:.5} ft/s\"  {}",
        errors.c10_m_s / FOOT_M,
        if has_growth {
            format!(
                "# c10; with c11 and c12 {}",
                of_speed.trim_start_matches("# ")
            )
        } else {
            of_speed
        }
    ));
    if has_growth {
        line(format!("c11 = {:.6}", errors.c11));
        line(format!("c12 = \"{:.7} s/ft\"", errors.c12_s_m * FOOT_M));
    }
    line(format!(
        "pitch = \"{:.5} deg\"  {}",
        errors.c20_rad / DEGREE_RAD,
        comment("pitch_sd")
    ));
    line(format!(
        "polar = \"{:.5} deg\"  {}",
        errors.c30_rad / DEGREE_RAD,
        comment("polar_sd")
    ));
    line(format!(
        "backspin = \"{:.5} rev/s\"  {}",
        errors.c40_rad_s / REV_RAD,
        comment("backspin_sd")
    ));
    line(String::new());
    line("[shooter.correlation]".to_owned());
    let values = if fit.posterior.spin == SpinSource::Measured {
        4
    } else {
        3
    };
    for (j, second) in VALUE_NAMES.iter().enumerate().take(values) {
        for (i, first) in VALUE_NAMES.iter().enumerate().take(j) {
            let pair = format!("{first}_{second}");
            line(format!(
                "{pair} = {:.4}  {}",
                fit.typical.correlation[(i, j)],
                comment(&format!("corr_{pair}"))
            ));
        }
    }
    line(String::new());
    line("[location]".to_owned());
    line(format!(
        "distance = \"{:.4} ft\"",
        place.location.distance_m / FOOT_M
    ));
    line(format!(
        "angle = \"{:.4} deg\"",
        place.location.angle_rad / DEGREE_RAD
    ));
    line(String::new());
    line("# The usual shot. A search for the best shot does not look at it.".to_owned());
    line("[nominal]".to_owned());
    let units_of = value_units(UnitSystem::Imperial);
    for (i, name) in VALUE_NAMES.iter().enumerate() {
        let (unit, size) = units_of[i];
        let value = fit.typical.means[0][i];
        line(format!(
            "{name} = \"{:.4} {unit}\"  {}",
            value / size,
            comment(&format!("{name}_mean"))
        ));
    }
    line(String::new());
    line(physics.trim().to_owned());
    text
}

/// A text as a TOML string.
fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
