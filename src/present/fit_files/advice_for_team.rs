//! Advice in the few words of a poster and of a row of a table.

use super::advice_text::{at_the_limit, more_shots, most_worth_training, scatter_in_words};
use super::change_in_words::{
    ChangeWords, FirstChange, first_change, first_change_in_words, gains_alone, landing_in_words,
    likelier_beginning,
};
use crate::fitting::{Advice, AdviceStep, AdviceSteps};
use crate::units::UnitSystem;

/// The steps of advice if one of them is supported, and the makes do not contradict the measured
/// shots.
fn steps_to_follow(advice: &Advice, is_doubted: bool) -> Option<&AdviceSteps> {
    let steps = advice.steps.as_ref()?;
    let is_sure = steps.steps.iter().any(AdviceStep::is_sure);
    (is_sure && !is_doubted).then_some(steps)
}

/// Advice in a row of a table.
#[derive(Clone, Debug)]
pub struct ShortAdvice {
    /// How many of 100 usual shots go in, with the interval: `34 (27 to 42)`.
    pub usual: String,
    /// How many of 100 then go in, with the interval; empty where nothing is to be changed.
    pub advised: String,
    /// What to change, and what to begin with.
    pub change: String,
    /// The scatter that costs most.
    pub training: String,
}

/// Advice in a row of a table.
#[must_use]
pub fn short_advice(
    advice: &Advice,
    is_doubted: bool,
    court_angle_rad: f64,
    units: UnitSystem,
) -> ShortAdvice {
    let p = advice.usual_probability;
    let words = ChangeWords {
        units,
        court_angle_rad,
    };
    let change = match steps_to_follow(advice, is_doubted) {
        _ if is_doubted => "nothing yet: the makes contradict the measured shots".to_owned(),
        None => {
            let limit = at_the_limit(&words, advice);
            let limit = match limit.is_empty() {
                true => String::new(),
                false => format!(" At the limit: {}.", limit.join("; ")),
            };
            let more = more_shots(advice).map_or_else(String::new, |more| {
                format!(" About {more:.0} more shots could settle it.")
            });
            format!("nothing yet: the data support no change.{limit}{more}")
        }
        Some(steps) => {
            let first = gains_alone(advice, steps).map_or_else(String::new, |alone| {
                let (name, chance) = likelier_beginning(&alone);
                match first_change(steps) {
                    FirstChange::Speed => format!("; start with the speed ({chance})"),
                    FirstChange::Pitch => format!("; start with the angle ({chance})"),
                    FirstChange::Either => {
                        format!("; start with either, more likely the {name} ({chance})")
                    }
                    FirstChange::Both => "; speed and angle together".to_owned(),
                }
            });
            words.of_releases(&advice.usual, &steps.advised) + &first
        }
    };
    let training = most_worth_training(&advice.training).into_iter();
    let training: Vec<&str> = training
        .map(|training| scatter_in_words(training.cause))
        .collect();
    let steps = steps_to_follow(advice, is_doubted);
    ShortAdvice {
        advised: steps.map_or_else(
            || advised_in_doubt(advice, is_doubted),
            |steps| {
                let of_advised = advice.advised_probability;
                format!(
                    "{:.0} ({:.0} to {:.0})",
                    100.0 * (p.mean + steps.gain.mean),
                    100.0 * of_advised.low,
                    100.0 * of_advised.high
                )
            },
        ),
        usual: format!(
            "{:.0} ({:.0} to {:.0})",
            100.0 * p.mean,
            100.0 * p.low,
            100.0 * p.high
        ),
        change,
        training: training.join(", or "),
    }
}

/// What the best release makes where no step towards it is sure: `91 ?`; empty where it gains
/// nothing.
fn advised_in_doubt(advice: &Advice, is_doubted: bool) -> String {
    /// Less than this gain in P is none.
    const WORTH_IT: f64 = 0.005;
    let gain = advice.gain.filter(|gain| gain.mean > WORTH_IT);
    let gain = gain.filter(|_| !is_doubted);
    gain.map_or_else(String::new, |gain| {
        format!(
            "{:.0} ?",
            100.0 * (advice.usual_probability.mean + gain.mean)
        )
    })
}

/// What a poster says of a player's own shots: how many go in, what to change, and what the player
/// then sees; or that the makes contradict the measured shots.
#[must_use]
pub fn advice_for_poster(
    advice: &Advice,
    is_doubted: bool,
    (from, court_angle_rad): (&str, f64),
    units: UnitSystem,
) -> String {
    let p = advice.usual_probability;
    let Some(steps) = steps_to_follow(advice, is_doubted) else {
        return match is_doubted {
            true => "No advice for your own shot yet: your makes contradict the measured shots."
                .to_owned(),
            false => format!(
                "Your shot, {from}: now {:.0} of 100 go in. Keep it: the data support no change.",
                100.0 * p.mean
            ),
        };
    };
    let words = ChangeWords {
        units,
        court_angle_rad,
    };
    let mut text = format!(
        "Your shot, {from}: now {:.0} of 100 go in; {:.0} can if you {}.",
        100.0 * p.mean,
        100.0 * (p.mean + steps.gain.mean),
        words.of_releases(&advice.usual, &steps.advised)
    );
    let more = [
        landing_in_words(advice, units),
        first_change_in_words(advice, steps),
    ];
    for sentence in more.into_iter().flatten() {
        text += &format!(" {sentence}");
    }
    text
}
