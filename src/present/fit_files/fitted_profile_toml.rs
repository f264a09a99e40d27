//! `profile.toml`: the fitted profile, each value with what is known of it.

use super::fit_note_text::fit_note_text;
use crate::answers::fit::FitSource;
use crate::escape::toml_string;
use crate::fitting::{PlaceScatter, ShooterFit, SpinSource, VALUE_NAMES};
use crate::store::parameters::{Parameter, mean_name, parameters, value_units};
use crate::units::{DEGREE_RAD, REV_RAD, UnitName, UnitSystem};

/// The text of the profile at a place, by its index. `physics` is the text of its `[physics]`
/// table.
#[must_use]
pub fn fitted_profile_toml(
    fit: &ShooterFit,
    place_index: usize,
    source: &FitSource<'_>,
    physics: &str,
    units: UnitSystem,
) -> String {
    let (long, metre) = units.length();
    let listed = parameters(&fit.posterior, source.kind.name()).into_iter();
    let listed: Vec<Parameter> = listed.map(|found| found.in_results(units)).collect();
    let has_several_places = fit.places.len() > 1;
    let comment = |name: &str| {
        let found = listed.iter().find(|parameter| parameter.name == name);
        found.map_or_else(String::new, |parameter| {
            let interval = &parameter.interval;
            let unit = if parameter.unit == UnitName::None {
                String::new()
            } else {
                format!(" {}", parameter.unit.name())
            };
            format!(
                "# {}: {:.3}{unit}, 95 % {:.3} to {:.3}, {}",
                parameter.name, interval.mean, interval.low, interval.high, parameter.source
            )
        })
    };
    let place = &fit.places[place_index];
    let shooter = fit.profiles[place_index].shooter();
    let errors = &shooter.dispersion;
    let mut text = String::new();
    let mut line = |words: String| {
        text += &words;
        text.push('\n');
    };
    line(format!(
        "# Fitted by `bankshot fit` to {} {} of {}.",
        fit.posterior.shots,
        source.kind.name(),
        toml_string(&source.file)
    ));
    line(format!(
        "# Tracker: {} (noise {}). Physics: {}. The profile is valid for this physics only.",
        source.tracker.0, source.tracker.1, source.physics
    ));
    line("# Each error is the root mean square over the fit's draws, with its 95 % interval and source.".to_owned());
    if has_several_places {
        line(format!(
            "# The location, the current shot and `speed` are for place {} of {}{}.",
            place_index + 1,
            fit.places.len(),
            match source.place_names[place_index].as_str() {
                "" => String::new(),
                name => format!(", {}", toml_string(name)),
            }
        ));
    }
    for note in &fit.notes {
        line(format!("# Warning: {}.", fit_note_text(note)));
    }
    line(String::new());
    line("[shooter]".to_owned());
    line(format!("name = {}", toml_string(&fit.name)));
    line(format!(
        "release_height = \"{:.4} {long}\"",
        place.release_height_m / metre
    ));
    line(format!(
        "max_backspin = \"{:.3} rev/s\"  # assumed; a search that chooses the backspin goes up to it",
        shooter.max_backspin_rad_s / REV_RAD
    ));
    line(String::new());
    line("[shooter.errors]".to_owned());
    let has_growth = fit.posterior.growth_terms > 0;
    let of_speed = comment("speed_sd");
    line(format!(
        "speed = \"{:.5} {long}/s\"  {}",
        errors.c10_m_s / metre,
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
        line(format!("c12 = \"{:.7} s/{long}\"", errors.c12_s_m * metre));
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
    let scatter = &fit.place_scatter[place_index];
    if *scatter != PlaceScatter::default() {
        line(format!(
            "# The places of release scatter by {:.4} {long} in distance, {:.3} deg in court angle and {:.4} {long}",
            scatter.distance_m / metre,
            scatter.court_angle_rad / DEGREE_RAD,
            scatter.height_m / metre
        ));
        line("# in height. What that does to the landing is in the errors above, since each shot keeps its landing; as".to_owned());
        line("# errors of distance, court_angle and height it would count twice.".to_owned());
    }
    line(String::new());
    line("[shooter.correlation]".to_owned());
    let values = fit.posterior.spin.measured_values();
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
        "distance = \"{:.4} {long}\"",
        place.location.distance_m / metre
    ));
    line(format!(
        "angle = \"{:.4} deg\"",
        place.location.angle_rad / DEGREE_RAD
    ));
    line(String::new());
    let keeps_backspin = fit.posterior.spin != SpinSource::Measured;
    if keeps_backspin {
        line("[search]".to_owned());
        line("# The backspin was not measured, so a search keeps the value below. With \"backspin\" in".to_owned());
        line("# the list it tries others, up to max_backspin.".to_owned());
        line("choose = [\"speed\", \"pitch\", \"polar\"]".to_owned());
        line(String::new());
    }
    line(format!(
        "# The current shot. A search for the best shot {}.",
        if keeps_backspin {
            "uses its backspin only"
        } else {
            "does not use it"
        }
    ));
    line("[nominal]".to_owned());
    let units_of = value_units(units);
    for (i, name) in VALUE_NAMES.iter().enumerate() {
        let (unit, size) = units_of[i];
        let value = fit.typical.means[place_index][i];
        line(format!(
            "{name} = \"{:.4} {unit}\"  {}",
            value / size,
            comment(&mean_name(place_index, name))
        ));
    }
    if units == UnitSystem::Metric {
        line("\n[output]\nunits = \"metric\"".to_owned());
    }
    line(String::new());
    line(physics.trim().to_owned());
    text
}
