//! The checks of a fit in words.

use crate::fitting::{Contradiction, PriorOf, PriorSensitivity, Shape, ShapeScore, ShooterFit};
use crate::present::words::{list, of_100, per_100};

/// A change of P from which on a prior is named in the answer.
const WORTH_A_WORD: f64 = 0.02;
/// Weights of a greater shape give no more than a hint.
const LARGEST_K: f64 = 0.7;
/// A shape predicts better from so many standard errors on.
const CLEARLY: f64 = 2.0;

fn prior_name(prior: PriorOf) -> &'static str {
    match prior {
        PriorOf::Ring => "the ring's bounce",
        PriorOf::Backspin => "the backspin",
        PriorOf::ConstantError => "a constant error of the sensor",
        PriorOf::Aim => "how near their best shot players aim",
        PriorOf::Scatter => "how much players scatter",
        PriorOf::Direction => "the direction, which was not measured",
    }
}

fn uncertain(pareto_k: f64) -> &'static str {
    match pareto_k > LARGEST_K {
        true => " (uncertain)",
        false => "",
    }
}

fn sensitivities(fit: &ShooterFit) -> Vec<PriorSensitivity> {
    PriorSensitivity::of(&fit.posterior.priors, &fit.probabilities[0].of_draws)
}

/// A sentence where an assumption decides about the number of the answer: P of one place, over the
/// whole session.
pub(super) fn rests_on_priors(fit: &ShooterFit) -> String {
    let is_doubted = Contradiction::of_fit(&fit.notes, fit.makes.labelled).is_some();
    if is_doubted || fit.places.len() > 1 || fit.at_the_end[0].is_some() {
        return String::new();
    }
    let p = fit.probabilities[0].interval().mean;
    let change = |one: &PriorSensitivity| one.greatest_change(p);
    let strongest = sensitivities(fit)
        .into_iter()
        .filter(|one| change(one) >= WORTH_A_WORD)
        .max_by(|a, b| change(a).total_cmp(&change(b)));
    strongest.map_or_else(String::new, |one| {
        format!(
            " With half as much trust in what is assumed of {}, {} of 100 would go in; with twice as much, {}.",
            prior_name(one.prior),
            of_100(one.probability_if_half_as_strong),
            of_100(one.probability_if_twice_as_strong)
        )
    })
}

/// The checks, paragraph by paragraph.
pub(super) fn fit_checks_text(fit: &ShooterFit) -> Vec<String> {
    let mut paragraphs = Vec::new();
    let priors: Vec<String> = sensitivities(fit)
        .iter()
        .map(|one| {
            format!(
                "{} {} or {}{}",
                prior_name(one.prior),
                per_100(one.probability_if_half_as_strong),
                per_100(one.probability_if_twice_as_strong),
                uncertain(one.pareto_k)
            )
        })
        .collect();
    if !priors.is_empty() {
        let from = match fit.places.len() {
            1 => "",
            _ => " from the first place",
        };
        paragraphs.push(format!(
            "Makes per 100{from} with half as much, or twice as much, trust in an assumption: {}.",
            priors.join("; ")
        ));
    }
    let bins = fit.predictive.bins().count();
    if bins > 0 {
        let outside = fit.predictive.bins();
        let outside = outside.filter(|bin| !bin.is_as_predicted()).count();
        paragraphs.push(format!(
            "The same shots simulated from the fit (plots/predicted): of {bins} numbers by depth, by left and right, and of makes by depth, {outside} lie outside nine in ten of the simulations. Of a fit that is right, fewer than one in ten do."
        ));
    }
    paragraphs
}

fn shape_name(shape: Shape) -> &'static str {
    match shape {
        Shape::Normal => "normal releases",
        Shape::HeavierTails => "heavier tails",
        Shape::Skewed => "skewed releases",
    }
}

/// How well the shapes predict; `None` where they were not compared.
#[must_use]
pub fn shapes_text(fit: &ShooterFit) -> Option<String> {
    let others = fit.shapes.iter();
    let others = others.filter(|score| score.shape != Shape::Normal);
    let listed: Vec<String> = others
        .clone()
        .map(|score| {
            format!(
                "{} {:+.1} \u{b1} {:.1}{}",
                shape_name(score.shape),
                score.better_than_normal,
                score.standard_error,
                uncertain(score.pareto_k)
            )
        })
        .collect();
    if listed.is_empty() {
        return None;
    }
    let is_better = |score: &&ShapeScore| {
        score.pareto_k <= LARGEST_K && score.better_than_normal > CLEARLY * score.standard_error
    };
    let best = others
        .filter(is_better)
        .max_by(|a, b| a.better_than_normal.total_cmp(&b.better_than_normal));
    let verdict = match best.map(|score| score.shape) {
        Some(Shape::HeavierTails) if fit.typical.tail_weight > 0.0 => {
            "Heavier tails predict better, and this fit has them."
        }
        Some(Shape::HeavierTails) => "Heavier tails predict better: fit with --tails student.",
        Some(Shape::Skewed) => {
            "Skewed releases predict better, but a fit has symmetric ones: take the makes with care."
        }
        _ => "Neither predicts clearly better than normal releases.",
    };
    Some(format!(
        "Each shot was predicted from the others. Score above that of normal releases, with its standard error: {}. {verdict}",
        list(&listed)
    ))
}
