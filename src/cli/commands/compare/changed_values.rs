//! What changed between two fitted sessions.

use super::fitted_sessions::Session;
use crate::answers::sessions::{Decision, SessionChange};
use crate::cli::failure::Failure;
use crate::fitting::{
    Interval, ProbabilityChange, SessionComparison, SpinSource, VALUE_NAMES, compare_probabilities,
    compare_sessions, probability_change,
};
use crate::plots::session_changes::{ChangeCause, ChangedValue};
use crate::store::parameters::value_units;
use crate::units::UnitSystem;

/// Shots that the causes of the change of P are computed with.
const SHOTS: usize = 65_536;

/// P and the planned ones of all changes; all if none are named.
pub(super) fn planned(
    all: Vec<SessionChange>,
    names: &[String],
) -> Result<Vec<SessionChange>, Failure> {
    if names.is_empty() {
        return Ok(all);
    }
    let known = |name: &String| {
        all.iter()
            .any(|change| change.name == *name && *name != "probability")
    };
    if let Some(unknown) = names.iter().find(|name| !known(name)) {
        let others = all.iter().filter(|change| change.name != "probability");
        let allowed: Vec<&str> = others.map(|change| change.name.as_str()).collect();
        return Err(Failure::usage(format!(
            "--planned: \"{unknown}\" is no value of these sessions; write some of {}",
            allowed.join(", ")
        )));
    }
    let is_kept =
        |change: &SessionChange| change.name == "probability" || names.contains(&change.name);
    Ok(all.into_iter().filter(is_kept).collect())
}

/// P, mean and standard deviation of each value, and the correlations.
pub(super) fn changes(sessions: &[Session; 2], units: UnitSystem) -> Vec<SessionChange> {
    let [before, after] = sessions;
    let posteriors = [&before.posterior, &after.posterior];
    let shots = posteriors.map(|posterior| posterior.shots);
    let mut changes = vec![SessionChange {
        name: "probability".to_owned(),
        unit: "%",
        size: 0.01,
        comparison: compare_probabilities([&before.probabilities, &after.probabilities], shots),
        ratio: None,
    }];
    let is_spin_measured = posteriors
        .iter()
        .all(|posterior| posterior.spin == SpinSource::Measured);
    for (i, (unit, size)) in value_units(units).into_iter().enumerate() {
        let is_spin = i == VALUE_NAMES.len() - 1;
        // A spin that was not measured in both sessions tells nothing of a change.
        if is_spin && !is_spin_measured {
            continue;
        }
        let mut add = |what: &str, comparison: SessionComparison, ratio: Option<Interval>| {
            changes.push(SessionChange {
                ratio,
                name: format!("{}_{what}", VALUE_NAMES[i]),
                unit,
                size,
                comparison,
            });
        };
        add(
            "mean",
            compare_sessions(posteriors, |draw| draw.means[before.place][i]),
            None,
        );
        let log = compare_sessions(posteriors, |draw| libm::log(draw.sds[i])).change;
        let ratio = Interval {
            mean: libm::exp(log.mean),
            sd: libm::exp(log.mean) * log.sd,
            low: libm::exp(log.low),
            high: libm::exp(log.high),
        };
        let sd = compare_sessions(posteriors, |draw| draw.sds[i]);
        add("sd", sd, Some(ratio));
    }
    for (a, b) in [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)] {
        if b == VALUE_NAMES.len() - 1 && !is_spin_measured {
            continue;
        }
        changes.push(SessionChange {
            name: format!("corr_{}_{}", VALUE_NAMES[a], VALUE_NAMES[b]),
            unit: "",
            size: 1.0,
            comparison: compare_sessions(posteriors, |draw| draw.correlation[(a, b)]),
            ratio: None,
        });
    }
    changes
}

/// What the change of P comes from.
pub(super) fn causes([before, after]: &[Session; 2]) -> ProbabilityChange {
    probability_change(
        &before.profile,
        [&before.posterior, &after.posterior],
        before.place,
        [&before.probabilities, &after.probabilities],
        SHOTS,
    )
}

/// The values for the plot.
pub(super) fn values_to_draw(changes: &[SessionChange]) -> Vec<ChangedValue> {
    let value = |change: &SessionChange| {
        let [before, after, by] = [
            &change.comparison.before,
            &change.comparison.after,
            &change.comparison.change,
        ]
        .map(|interval| interval.scaled(1.0 / change.size));
        ChangedValue {
            name: change.in_words().to_owned(),
            unit: match change.name.as_str() {
                "probability" => "per 100",
                _ => change.unit,
            },
            decimals: change.decimals(),
            before,
            after,
            change: by,
            is_decided: change.decision(changes.len() - 1) == Decision::Made,
        }
    };
    changes.iter().map(value).collect()
}

/// The causes of the change of P for the plot.
pub(super) fn causes_to_draw(causes: &ProbabilityChange) -> Vec<ChangeCause> {
    let [old, new] = &causes.by_scatter_first_and_last;
    let [speed, pitch, polar] = &causes.by_mean_alone;
    let named = [
        ("the scatter, mean of both:", &causes.by_scatter),
        ("at the release before", old),
        ("at the release after", new),
        ("the mean release", &causes.by_means),
        ("the speed alone", speed),
        ("the release angle alone", pitch),
        ("the direction alone", polar),
    ];
    let cause = |(name, points): (&'static str, &Interval)| ChangeCause {
        name,
        points: points.scaled(100.0),
    };
    named.map(cause).into()
}
