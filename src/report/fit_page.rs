//! The page of a fitted shooter.

use super::html_table::{HtmlTable, format_cell};
use super::page::Page;
use super::page_data::Scene;
use super::shot_in_words::ReportShot;
use crate::answers::fit::FitSource;
use crate::fitting::{ShooterFit, SpinSource, nominal_of};
use crate::measured_shots::source::Source;
use crate::model::league_courts::League;
use crate::plots::shot_with_probability::PlottedShot;
use crate::plots::svg::Plot;
use crate::present::fit_files::fit_note_text::fit_note_text;
use crate::present::fit_files::fit_text::tests_text;
use crate::shooter::ShotKind;
use crate::store::parameters::parameters;
use crate::units::UnitSystem;

/// Makes the page of a fit, with its plots.
#[must_use]
pub fn fit_page(
    fit: &ShooterFit,
    source: &FitSource<'_>,
    plots: Vec<Plot>,
    units: UnitSystem,
) -> Page {
    let profile = &fit.profiles[0];
    let nominal = nominal_of(&fit.typical.means[0]);
    let p = fit.probabilities[0].interval();
    let usual = ReportShot {
        place: 0,
        location: profile.location(),
        shot: PlottedShot {
            kind: ShotKind::of(profile, &nominal),
            nominal,
            probability: p.mean,
            // The caption gives the interval of the draws in words, not a numerical error.
            standard_error: 0.0,
        },
        mirror_of: None,
    };
    Page {
        title: profile.shooter().name.clone(),
        answer: answer(fit, source, units),
        shots: vec![usual],
        first_place: 0,
        other_shooter: None,
        scene: Scene {
            simulator: profile.simulator().clone(),
            court: League::Ncaa.court(),
            height_above_hoop_m: profile.height_above_hoop_m(),
            units,
        },
        tables: [
            Some(parameter_table(fit, source.kind.name(), units)),
            prediction_table(fit),
        ]
        .into_iter()
        .flatten()
        .collect(),
        plots,
        footer: format!(
            "{}, physics {}. bankshot {} ({}), profile {}.",
            match source.kind {
                Source::Makes => format!("Counted in {}", source.file),
                _ => format!(
                    "Measured in {}; tracker {} (its noise is {})",
                    source.file, source.tracker.0, source.tracker.1
                ),
            },
            source.physics,
            env!("CARGO_PKG_VERSION"),
            env!("BANKSHOT_COMMIT"),
            &profile.hash()[..12]
        ),
    }
}

fn answer(fit: &ShooterFit, source: &FitSource<'_>, units: UnitSystem) -> String {
    let makes = &fit.makes;
    let is_counted = source.kind == Source::Makes;
    let seen = if is_counted {
        format!(" {} of {} went in.", makes.made, makes.labelled)
    } else if makes.labelled > 0 {
        format!(
            " {} of {} went in; {:.1} \u{b1} {:.1} were expected from these shots.",
            makes.made, makes.labelled, makes.expected, makes.expected_sd
        )
    } else {
        String::new()
    };
    let notes = fit.notes.iter();
    let warnings: Vec<String> = notes
        .map(|note| format!(" Warning: {}.", fit_note_text(note)))
        .collect();
    let places = fit.places.iter().zip(&fit.probabilities);
    let chances: Vec<String> = places
        .map(|(place, probabilities)| {
            let p = probabilities.interval();
            format!(
                "{}: {:.1} of 100 shots go in (95 % interval {:.1} to {:.1})",
                place.location.in_words(units),
                100.0 * p.mean,
                100.0 * p.low,
                100.0 * p.high,
            )
        })
        .collect();
    format!(
        "{}, estimated from {} {}.{seen}{}",
        chances.join("; "),
        fit.posterior.shots,
        match is_counted {
            true => "counted shots",
            false => source.kind.name(),
        },
        warnings.concat()
    )
}

/// How well the chances of the measured shots foretell which went in; `None` with too few results
/// for a bin.
fn prediction_table(fit: &ShooterFit) -> Option<HtmlTable> {
    let makes = &fit.makes;
    // Of counts alone the chances come from the results themselves.
    if makes.bins.is_empty() || fit.posterior.spin == SpinSource::NothingMeasured {
        return None;
    }
    let [brier_of_share, log_loss_of_share] = makes.losses_of_share;
    let calibration = makes.calibration_z.map_or_else(String::new, |z| {
        format!("Spiegelhalter's z {z:+.1}: about 0 \u{b1} 1 if the chances are right, above 3 if they are too extreme.")
    });
    let bins = makes.bins.iter().map(|bin| {
        let observed = &bin.observed;
        let cells = [
            format_cell(bin.predicted, 3),
            format_cell(observed.share, 3),
            format_cell(observed.low, 3),
            format_cell(observed.high, 3),
            bin.shots.to_string(),
        ];
        (None, cells.to_vec())
    });
    Some(HtmlTable {
        caption: "Predicted against observed".to_owned(),
        note: format!(
            "The chance is that of each ball as it was measured, so this tests the physics and the sensor, not the next shot. Brier score \
             {:.3} (0 is perfect; the share of makes for every shot has {brier_of_share:.3}), log loss {:.3} ({log_loss_of_share:.3}), area under the curve {}. \
             {}",
            makes.brier,
            makes.log_loss,
            makes
                .area_under_curve
                .map_or_else(|| "-".to_owned(), |auc| format!("{auc:.2}")),
            calibration,
        ),
        columns: ["predicted", "went in", "2.5 %", "97.5 %", "shots"]
            .map(str::to_owned)
            .to_vec(),
        rows: bins.collect(),
        is_detail: false,
    })
}

fn parameter_table(fit: &ShooterFit, kind: &str, units: UnitSystem) -> HtmlTable {
    let columns = ["parameter", "unit", "mean", "2.5 %", "97.5 %", "source"];
    HtmlTable {
        caption: "What was fitted".to_owned(),
        note: match fit.posterior.spin {
            SpinSource::NothingMeasured => String::new(),
            _ => tests_text(fit),
        },
        columns: columns.map(str::to_owned).to_vec(),
        rows: parameters(&fit.posterior, kind)
            .into_iter()
            .map(|parameter| {
                let parameter = parameter.in_results(units);
                let interval = parameter.interval;
                let [mean, low, high] =
                    [interval.mean, interval.low, interval.high].map(|value| format_cell(value, 3));
                let cells = [
                    parameter.name,
                    parameter.unit.name().to_owned(),
                    mean,
                    low,
                    high,
                    parameter.source.to_owned(),
                ];
                (None, cells.to_vec())
            })
            .collect(),
        is_detail: false,
    }
}
