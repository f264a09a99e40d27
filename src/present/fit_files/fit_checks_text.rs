//! The checks of a fit in words.

use crate::fitting::{PriorOf, PriorSensitivity, Shape, ShapeScore, ShooterFit};
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
        PriorOf::Aim => "how near the best shot players aim",
        PriorOf::Scatter => "the scatter of players",
    }
}

fn sensitivities(fit: &ShooterFit) -> Vec<PriorSensitivity> {
    PriorSensitivity::of(&fit.posterior.priors, &fit.probabilities[0].of_draws)
}

/// A sentence where an assumption decides.
pub(super) fn rests_on_priors(fit: &ShooterFit) -> String {
    let p = fit.probabilities[0].interval().mean;
    let change = |one: &PriorSensitivity| one.greatest_change(p);
    let strongest = sensitivities(fit)
        .into_iter()
        .filter(|one| change(one) >= WORTH_A_WORD)
        .max_by(|a, b| change(a).total_cmp(&change(b)));
    strongest.map_or_else(String::new, |one| {
        format!(
            " If what is assumed of {} counted half as much, {} of 100 would go in; if twice as much, {}.",
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
                if one.pareto_k > LARGEST_K {
                    " (a hint)"
                } else {
                    ""
                }
            )
        })
        .collect();
    if !priors.is_empty() {
        paragraphs.push(format!(
            "Makes per 100 if an assumption counted half as much or twice as much: {}.",
            priors.join("; ")
        ));
    }
    let bins = fit.predictive.bins().count();
    if bins > 0 {
        let outside = fit.predictive.bins();
        let outside = outside.filter(|bin| !bin.is_as_predicted()).count();
        paragraphs.push(format!(
            "The same shots simulated from the fit (plots/predicted): of {bins} numbers by depth, by left and right, and of makes by depth, {outside} lie outside nine in ten of the simulations; by chance about {:.0} would.",
            0.1 * bins as f64
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
pub(super) fn shapes_text(shapes: &[ShapeScore]) -> Option<String> {
    let others = shapes.iter().filter(|score| score.shape != Shape::Normal);
    let listed: Vec<String> = others
        .clone()
        .map(|score| {
            format!(
                "{} {:+.1} \u{b1} {:.1}{}",
                shape_name(score.shape),
                score.better_than_normal,
                score.standard_error,
                if score.pareto_k > LARGEST_K {
                    " (a hint)"
                } else {
                    ""
                }
            )
        })
        .collect();
    if listed.is_empty() {
        return None;
    }
    let best = others
        .filter(|score| score.better_than_normal > CLEARLY * score.standard_error)
        .max_by(|a, b| a.better_than_normal.total_cmp(&b.better_than_normal));
    let verdict = match best.map(|score| score.shape) {
        Some(Shape::HeavierTails) => "Heavier tails predict better: fit with --tails student.",
        Some(Shape::Skewed) => {
            "Skewed releases predict better, but a fit has symmetric ones: take the makes with care."
        }
        _ => "Neither predicts clearly better than normal releases.",
    };
    Some(format!(
        "Each shot predicted from the others, as a score above that of normal releases with its standard error: {}. {verdict}",
        list(&listed)
    ))
}
