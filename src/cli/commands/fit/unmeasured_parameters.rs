//! `--free`: what the shots say of a parameter that was not measured.

use crate::cli::failure::Failure;
use crate::cli::measured_shots_flags::MeasuredFile;
use crate::fitting::{FittedShooter, ShooterFit, SpinSource, UnseenParameter, likelihood_curve};
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::model::{Preset, SolidId};
use crate::probability::Progress;
use crate::store::free_parameters::{CurvePoint, FreeParameter};
use crate::units::{REV_RAD, rounded};

/// Refuses names that `--free` does not know.
pub(super) fn check_names(free: &[String]) -> Result<(), Failure> {
    for name in free {
        if !is_drag(name) && UnseenParameter::named(name).is_none() {
            return Err(Failure::usage(format!(
                "--free {name}: must be backspin, hoop_restitution or drag_coefficient"
            )));
        }
    }
    Ok(())
}

/// Refuses a parameter that these shots cannot determine, before anything is written.
pub(super) fn check_shots(
    free: &[String],
    shots: &ShooterShots,
    fit: &ShooterFit,
) -> Result<(), Failure> {
    let (made, labelled) = (fit.makes.made, fit.makes.labelled);
    for name in free {
        if is_drag(name) {
            if shots.tracks.is_empty() {
                return Err(Failure::usage(
                    "--free drag_coefficient: needs trajectories",
                ));
            }
        } else if labelled == 0 || made == 0 || made == labelled {
            return Err(Failure::usage(format!(
                "--free {name}: needs shots that were made and shots that were missed; {made} of {labelled} with a result were made"
            )));
        }
    }
    Ok(())
}

/// What the shots say of a parameter that was not measured.
pub(super) struct UnmeasuredParameter {
    pub(super) text: String,
    pub(super) found: FreeParameter,
}

/// What `--free` found, as data.
pub(super) fn found_values(free: &[UnmeasuredParameter]) -> Vec<FreeParameter> {
    let found = free.iter().map(|parameter| &parameter.found);
    found.cloned().collect()
}

/// What the shots of one or more shooters say of a parameter that was not measured, and how to use
/// it.
pub(super) fn estimate(
    name: &str,
    file: &MeasuredFile,
    shooters: &[(&ShooterShots, &ShooterFit)],
    progress: &dyn Progress,
) -> Result<UnmeasuredParameter, Failure> {
    let Some(parameter) = UnseenParameter::named(name) else {
        let shots: Vec<&ShooterShots> = shooters.iter().map(|(shots, _)| *shots).collect();
        return Ok(drag(file, &shots, progress));
    };
    let labelled: usize = shooters.iter().map(|(_, fit)| fit.makes.labelled).sum();
    let is_measured = |shots: &ShooterShots| shots.spin == SpinSource::Measured;
    let fitted: Vec<FittedShooter<'_>> = shooters
        .iter()
        .map(|(shots, fit)| FittedShooter {
            profiles: &fit.profiles,
            shots: &shots.shots,
            typical: &fit.typical,
            measured_values: shots.spin.measured_values(),
        })
        .collect();
    let curve = likelihood_curve(parameter, &fitted, progress)?;
    let is_measured = shooters.iter().any(|(shots, _)| is_measured(shots));
    let (unit, size) = match parameter {
        UnseenParameter::Backspin => (" rev/s", REV_RAD),
        UnseenParameter::HoopRestitution => ("", 1.0),
    };
    let best = curve.best / size;
    let (fitted_with, use_it) = match parameter {
        UnseenParameter::Backspin => (
            shooters.first().map_or_else(String::new, |(_, fit)| {
                format!(
                    "the fit's mean is {:.2} rev/s",
                    fit.typical.means[0][3] / REV_RAD
                )
            }),
            format!(
                "This fit did not use it. To use it, fit again with --backspin '{best:.2} rev/s'; \
                 that takes the value as exact.\n"
            ),
        ),
        UnseenParameter::HoopRestitution => (
            format!(
                "the physics {} has {:.2}",
                file.physics_name,
                file.physics.restitution_on(SolidId::Ring)
            ),
            physics_with(file, &format!("hoop_restitution = {best:.2}"))
                + "`bankshot team` and `bankshot physics` use the interval of these fits; nothing has to be fitted or swept again.\n",
        ),
    };
    let [low, high] = curve.interval.map(|end| end / size);
    let ends = [curve.points.first(), curve.points.last()];
    let is_at_end = ends.iter().flatten().any(|(end, _)| *end == curve.best);
    let mut text = format!(
        "{name}  {best:.2}{unit} (95 % interval {low:.2} to {high:.2}), estimated from the results of {labelled} shots{}{}; {fitted_with}\n",
        match shooters.len() {
            1 => String::new(),
            all => format!(" of {all} shooters together"),
        },
        if curve.is_decided {
            ""
        } else if is_at_end {
            "; the most likely value is at an end of the range, so something else is wrong: check distance, release height, air, tracker, and how makes were recorded"
        } else {
            "; the interval reaches the end of the range tried, so the value may lie beyond it"
        }
    );
    let usual = parameter.usual_range();
    let is_usual = (usual.0..=usual.1).contains(&curve.best);
    if curve.is_decided && !is_usual {
        text += &format!(
            "Published values are {:.2} to {:.2}{unit}. Something else is probably wrong: check distance, release height, air, tracker, and how makes were recorded.\n",
            usual.0 / size,
            usual.1 / size
        );
    }
    let tells_nothing = low <= usual.0 / size && high >= usual.1 / size;
    if curve.is_decided && tells_nothing {
        text += &format!(
            "The interval covers all published values ({:.2} to {:.2}{unit}), so these shots add nothing to them.\n",
            usual.0 / size,
            usual.1 / size
        );
    }
    for (value, logarithm) in &curve.points {
        text += &format!(
            "  {:>7.3}{unit}  log-likelihood {logarithm:>8.2}\n",
            value / size
        );
    }
    if curve.is_decided
        && is_usual
        && !tells_nothing
        && !(parameter == UnseenParameter::Backspin && is_measured)
    {
        text += &use_it;
    }
    let points = curve.points.iter().map(|(value, logarithm)| CurvePoint {
        value: rounded(value / size),
        log_likelihood: rounded(*logarithm),
    });
    let found = FreeParameter {
        name: name.to_owned(),
        unit: unit.trim().to_owned(),
        best: Some(rounded(best)),
        low: Some(rounded(low)),
        high: Some(rounded(high)),
        is_decided: curve.is_decided,
        is_usual: Some(is_usual),
        tells_more_than_sources: Some(curve.is_decided && !tells_nothing),
        curve: Some(points.collect()),
    };
    Ok(UnmeasuredParameter { text, found })
}

/// Whether a name is that of the drag, which flights tell without a profile.
pub(super) fn is_drag(name: &str) -> bool {
    name == DRAG
}

const DRAG: &str = "drag_coefficient";

/// The drag coefficient by the flights of shooters.
pub(super) fn drag(
    file: &MeasuredFile,
    shooters: &[&ShooterShots],
    progress: &dyn Progress,
) -> UnmeasuredParameter {
    let own = file.physics.air.drag_coefficient;
    let none = FreeParameter {
        name: DRAG.to_owned(),
        unit: String::new(),
        best: None,
        low: None,
        high: None,
        is_decided: false,
        is_usual: None,
        tells_more_than_sources: None,
        curve: None,
    };
    let Some(found) = file.drag_of_flights(shooters, progress) else {
        return UnmeasuredParameter {
            text: "drag_coefficient  these flights cannot tell\n".to_owned(),
            found: none,
        };
    };
    let (best, [low, high]) = (found.best, found.interval);
    let agreement = if (low..=high).contains(&own) {
        "which these flights do not contradict"
    } else {
        "outside of that"
    };
    UnmeasuredParameter {
        text: format!(
            "drag_coefficient  {best:.3} (95 %: {low:.3} to {high:.3}) from {} flights; the physics {} has {own:.3}, {agreement}\n{}",
            found.flights,
            file.physics_name,
            physics_with(file, &format!("drag_coefficient = {best:.3}"))
        ),
        found: FreeParameter {
            best: Some(best),
            low: Some(low),
            high: Some(high),
            is_decided: true,
            ..none
        },
    }
}

/// How the fit is made with another constant of the physics.
fn physics_with(file: &MeasuredFile, line: &str) -> String {
    if Preset::named(&file.physics_name).is_some() {
        format!(
            "This fit did not use it. To use it, write a file with these lines, and fit again with --physics FILE:\n  [physics]\n  preset = \"{}\"\n  {line}\n",
            file.physics_name
        )
    } else {
        format!(
            "This fit did not use it. To use it, write {line} into [physics] of {}, and fit again.\n",
            file.physics_name
        )
    }
}
