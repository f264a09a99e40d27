//! The answer of `fit` for people.

use super::fit_note_text::{fit_note_text, p_value};
use crate::answers::fit::FitSource;
use crate::fitting::{
    CENTRE_DEPTH_M, DrawProbabilities, ShooterFit, VALUE_NAMES, WARNING_LEVEL, values_at_height,
};
use crate::measured_shots::source::Source;
use crate::store::parameters::{parameters, value_units};
use crate::units::{DEGREE_RAD, FOOT_M, UnitSystem};

/// A share of the draws as a chance: no count of draws shows 0 or 100 %.
pub(super) fn chance(share: f64) -> String {
    match share {
        share if share < 0.01 => "under 1 %".to_owned(),
        share if share > 0.99 => "over 99 %".to_owned(),
        share => format!("{:.0} %", 100.0 * share),
    }
}

/// A probability as a percentage.
#[must_use]
pub fn percent(p: f64) -> String {
    format!("{:.1} %", 100.0 * p)
}

/// `P 65.2 %, 95 % 59.3 to 71.1 % (numerics ± 0.1)`.
#[must_use]
pub fn probability_text(probabilities: &DrawProbabilities) -> String {
    let p = probabilities.interval();
    format!(
        "P {}, 95 %: {:.1} to {:.1} % (numerics ± {:.2})",
        percent(p.mean),
        100.0 * p.low,
        100.0 * p.high,
        100.0 * probabilities.numerical_standard_error()
    )
}

/// The answer.
#[must_use]
pub fn fit_text(fit: &ShooterFit, source: &FitSource<'_>, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let posterior = &fit.posterior;
    let name = if fit.name.is_empty() {
        "the shooter"
    } else {
        &fit.name
    };
    let mut text = format!(
        "{name}: {} {}, tracker {} ({}), physics {}\n",
        posterior.shots,
        source.kind.name(),
        source.tracker.0,
        source.tracker.1,
        source.physics
    );
    if source.kind == Source::Landings {
        let (unit, size) = units.short_length();
        text += &format!(
            "depth   counted from the front of the ring: {:.1} {unit} is its centre\n",
            CENTRE_DEPTH_M / size
        );
    }
    for (index, (place, p)) in fit.places.iter().zip(&fit.probabilities).enumerate() {
        let name = &source.place_names[index];
        let number = match (fit.places.len(), name.as_str()) {
            (1, "") => String::new(),
            (1, name) => format!("{name}, "),
            (_, "") => format!("place {}, ", index + 1),
            (_, name) => format!("place {}, {name}, ", index + 1),
        };
        text += &format!(
            "{number}{}, released at {:.2} {long}: the usual shot has {}\n",
            place.location.in_words(units),
            place.release_height_m / metre,
            probability_text(p)
        );
        if source.kind == Source::Trajectories {
            text += &at_another_height(fit, index, units);
        }
    }
    if let Some(residuals) = &fit.residuals {
        text += &format!(
            "flights {} of {} used; their points lie {:.2} times as far from the fitted flights as the tracker's noise puts them (chi-square {:.0}, expected {:.0})\n",
            posterior.shots,
            posterior.shots + source.rejected.len(),
            residuals.ratio(),
            residuals.chi_square,
            residuals.expected
        );
    }
    let makes = &fit.makes;
    if makes.labelled > 0 {
        let share = &makes.share;
        text += &format!(
            "made    {} of {}: {}, 95 %: {:.1} to {:.1} %; expected from these shots: {:.1} ± {:.1} makes{}\n",
            makes.made,
            makes.labelled,
            percent(share.share),
            100.0 * share.low,
            100.0 * share.high,
            makes.expected,
            makes.expected_sd,
            makes
                .made_z()
                .map_or_else(String::new, |z| format!(" (z {z:+.1})"))
        );
        if fit.places.len() > 1 {
            for place in 0..fit.places.len() {
                let makes = makes.at_place(place);
                if makes.labelled == 0 {
                    continue;
                }
                text += &format!(
                    "        place {}: {} of {}, expected {:.1} ± {:.1}\n",
                    place + 1,
                    makes.made,
                    makes.labelled,
                    makes.expected,
                    makes.expected_sd
                );
            }
        }
        if makes.labelled < posterior.shots {
            text += &format!(
                "        {} of the {} shots have no result\n",
                posterior.shots - makes.labelled,
                posterior.shots
            );
        }
        let auc = makes
            .area_under_curve
            .map_or_else(|| "-".to_owned(), |auc| format!("{auc:.2}"));
        let calibration = makes.calibration_z.map_or_else(String::new, |z| {
            format!(", calibration z {z:+.1} (above 3: too sure)")
        });
        let swishes = match makes.swishes {
            (0, _) => "no shot was predicted to be a swish".to_owned(),
            (all, made) => format!("{made} of {all} predicted swishes went in"),
        };
        text += &format!(
            "chances Brier {:.3} ({:.3} for the share of makes alone), log loss {:.3} ({:.3}), area under the curve {auc}{calibration}; {swishes}\n",
            makes.brier, makes.losses_of_share[0], makes.log_loss, makes.losses_of_share[1]
        );
    }
    let of_value = value_units(units);
    for difference in source.differences {
        let (unit, size) = of_value[difference.value];
        text += &format!(
            "column  {} says {:+.2} \u{b1} {:.2} {unit} more {} than the landings give under {} ({} shots)\n",
            difference.column,
            difference.mean / size,
            difference.standard_error / size,
            VALUE_NAMES[difference.value],
            source.physics,
            difference.shots
        );
    }
    text += &format!(
        "\n{:<24} {:>9} {:>9} {:>9}  {:<5} {}\n",
        "", "mean", "2.5 %", "97.5 %", "unit", "source"
    );
    for parameter in parameters(posterior, source.kind.name()) {
        let parameter = parameter.in_results(units);
        let interval = &parameter.interval;
        text += &format!(
            "{:<24} {:>9.3} {:>9.3} {:>9.3}  {:<5} {}\n",
            parameter.name,
            interval.mean,
            interval.low,
            interval.high,
            parameter.unit.name(),
            parameter.source
        );
    }
    text += &format!(
        "\n{} draws, kept from chains with R-hat {:.3} and an effective sample size of {:.0}; weight of the prior (the population): {:.0} % (speed), {:.0} % (pitch), {:.0} % (polar)\n",
        posterior.draws.len(),
        posterior.r_hat,
        posterior.effective_sample_size,
        100.0 * posterior.prior_weights[0],
        100.0 * posterior.prior_weights[1],
        100.0 * posterior.prior_weights[2]
    );
    text += &tests_text(fit);
    text += "The intervals hold what these shots do not tell. They leave out the physics of this gym: see `bankshot physics`.";
    text += &of_constant_error(fit, source, units);
    for note in &fit.notes {
        text += &format!("warning: {}\n", fit_note_text(note));
    }
    text
}

/// That a constant error of the tracker is in no interval, and what one of the size of its noise
/// would do where releases were measured.
fn of_constant_error(fit: &ShooterFit, source: &FitSource<'_>, units: UnitSystem) -> String {
    let errors = source.constant_errors(fit);
    if errors.is_empty() {
        return " They leave out a constant error of the tracker too.\n".to_owned();
    }
    let has_z = errors.iter().any(|error| error.made_z.is_some());
    let mut text = " They leave out a constant error of the tracker too. If it reads a value of all shots too high or too low by one standard deviation of its noise, so many of 100 usual shots go in".to_owned();
    text += match has_z {
        true => {
            ", and the makes differ from what is then expected by z of their standard deviations (beyond 3 they speak against it):\n"
        }
        false => ":\n",
    };
    for pair in errors.chunks(2) {
        let (unit, size) = value_units(units)[pair[0].value];
        let decimals = if pair[0].value == 0 { 3 } else { 2 };
        text += &format!(
            "  {:<5} {:>5.decimals$} {unit:<4}",
            VALUE_NAMES[pair[0].value],
            pair[0].by / size
        );
        for error in pair {
            let side = if error.by > 0.0 { "high" } else { "low" };
            let z = error
                .made_z
                .map_or_else(String::new, |z| format!(" (z {z:+.1})"));
            text += &format!("   too {side} {:>3.0}{z}", 100.0 * error.probability);
        }
        text += "\n";
    }
    text
}

/// The tests of the shots in one sentence, whether they warn or not.
#[must_use]
pub fn tests_text(fit: &ShooterFit) -> String {
    let all = fit.trends.iter().flat_map(|trend| {
        [
            Some(("drift", trend.drift_p)),
            Some(("a shot like the one before", trend.serial_p)),
            trend.sessions_p.map(|p| ("unequal sessions", p)),
            trend
                .spreads_p
                .map(|p| ("unequal scatter of the sessions", p)),
        ]
        .map(|test| test.map(|(what, p)| (what, trend.of.name(), p)))
    });
    let all: Vec<_> = all.flatten().collect();
    let least = all.iter().min_by(|a, b| a.2.total_cmp(&b.2));
    let order = least.map_or_else(String::new, |(what, name, p)| {
        format!(
            "; least p of {} tests of the order of the shots: {} ({what} of {name})",
            all.len(),
            p_value(*p)
        )
    });
    format!(
        "Tests: normal releases (Mardia) skewness {}, kurtosis {}{order}. Each warns below {WARNING_LEVEL}.\n",
        p_value(fit.shape.skewness_p),
        p_value(fit.shape.kurtosis_p)
    )
}

/// What the means rest on where balls were tracked: on the height at which the release is taken,
/// which the tracks tell only roughly.
fn at_another_height(fit: &ShooterFit, place: usize, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let by_m = match units {
        UnitSystem::Imperial => 0.1 * FOOT_M,
        UnitSystem::Metric => 0.03,
    };
    let (at, usual) = (&fit.places[place], &fit.typical.means[place]);
    let simulator = fit.profiles[place].simulator();
    let higher = values_at_height(simulator, at, usual, at.release_height_m + by_m);
    higher.map_or_else(String::new, |higher| {
        format!(
            "        speed and pitch are those at that height: {:.2} {long} higher they are {:.2} {long}/s less and {:.1} deg less; P hardly depends on it\n",
            by_m / metre,
            (usual[0] - higher[0]) / metre,
            (usual[1] - higher[1]) / DEGREE_RAD
        )
    })
}
