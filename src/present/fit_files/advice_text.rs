//! The answer of `advise` for people.

use super::change_in_words::{ChangeWords, first_change_in_words, landing_in_words};
use super::fit_text::{chance, percent};
use crate::best_shot::{BestShot, Limit};
use crate::fitting::{
    Advice, AdviceStep, AdviceSteps, Cause, Interval, SpinSource, Support, TrainingGain, values_of,
    wilson_interval,
};
use crate::shooter::ShotKind;
use crate::store::parameters::value_units;
use crate::units::{UnitSystem, with_decimals};

/// Points of P with their interval: `2.1 points (95 %: 0.4 to 3.9)`.
fn points(interval: &Interval) -> String {
    let [mean, low, high] =
        [interval.mean, interval.low, interval.high].map(|p| with_decimals(100.0 * p, 1));
    format!("{mean:+.1} points (95 %: {low:+.1} to {high:+.1})")
}

/// What to change, in words.
fn advised_in_words(words: &ChangeWords, advice: &Advice, steps: &AdviceSteps) -> String {
    let p = advice.usual_probability.mean;
    let changes = words.of_releases(&advice.usual, &steps.advised);
    let gain = &steps.gain;
    let mut text = format!(
        "With the same scatter you can make {:.0} %, {:.1} points more (95 %: {:+.0} to {:+.0}): {changes}.",
        100.0 * (p + gain.mean),
        100.0 * gain.mean,
        100.0 * gain.low,
        100.0 * gain.high
    );
    text += &first_change_in_words(advice, steps);
    text + "\n"
}

/// How many more shots would make a step sure, in a sentence; empty where none is open, or they
/// would be too many.
pub(super) fn more_shots_in_words(advice: &Advice) -> String {
    /// More than this many times the shots is no plan.
    const MOST_TIMES: f64 = 10.0;
    let steps = advice.steps.iter().flat_map(|steps| &steps.steps);
    let after = steps.filter_map(|step| step.sure_after(advice.shots));
    let more = after.fold(f64::INFINITY, f64::min) - advice.shots as f64;
    if !(more > 0.0 && more < MOST_TIMES * advice.shots as f64) {
        return String::new();
    }
    format!(
        " About {:.0} more shots would make a step sure, if it gains what it seems to.",
        libm::ceil(more / 10.0) * 10.0
    )
}

/// The changes at the limit of what the shots show, in a sentence; empty where there is none.
pub(super) fn at_the_limit_in_words(words: &ChangeWords, advice: &Advice) -> String {
    let Some(steps) = &advice.steps else {
        return String::new();
    };
    let mut from = advice.usual;
    let mut changes = Vec::new();
    // A suggested angle comes with a speed of its own.
    let mut all = steps.steps.iter();
    let has_angle = all.any(|step| step.cause == Cause::PITCH && step.is_sure());
    for step in &steps.steps {
        let is_told = has_angle && step.cause == Cause::SPEED;
        if step.support == Support::AtTheLimit && !is_told {
            changes.push(format!(
                "{} ({:+.1})",
                words.of_step(step, &from),
                100.0 * step.gain.mean
            ));
        } else if step.is_sure() {
            from = step.release;
        }
    }
    if changes.is_empty() {
        return String::new();
    }
    format!(
        "At the limit of what these shots show: {}.",
        changes.join("; ")
    )
}

/// The other kind of shot, in a sentence, where it is surely better and by a shot in 100.
fn other_kind_in_words(advice: &Advice) -> String {
    const SURE: f64 = 0.9;
    const WORTH_IT: f64 = 0.01;
    let Some(kinds) = &advice.kinds else {
        return String::new();
    };
    let [direct, bank] = kinds.probabilities;
    let (words, sure, gain, [own, other]) = match advice.kind {
        ShotKind::Direct => (
            "Or bank it: the best bank shot",
            kinds.bank_is_better,
            kinds.difference.mean,
            [direct, bank],
        ),
        ShotKind::Bank => (
            "Or shoot it direct: the best direct shot",
            1.0 - kinds.bank_is_better,
            -kinds.difference.mean,
            [bank, direct],
        ),
    };
    if sure < SURE || gain < WORTH_IT {
        return String::new();
    }
    format!(
        "{words} makes {:.0} %, the best {} one {:.0} % (by these shots {} is better with a chance of {}).\n",
        100.0 * other.mean,
        advice.kind.name(),
        100.0 * own.mean,
        advice.kind.other().name(),
        chance(sure)
    )
}

/// Where the sentences do not advise the other kind of shot: how it compares. Empty where they do,
/// or where one kind cannot be made.
fn other_kind_not_advised(advice: &Advice) -> String {
    let Some(kinds) = &advice.kinds else {
        return String::new();
    };
    if !other_kind_in_words(advice).is_empty() {
        return String::new();
    }
    let [direct, bank] = kinds.probabilities.map(|p| 100.0 * p.mean);
    let sure = chance(kinds.bank_is_better);
    format!(
        "Bank or direct: the best bank shot makes {bank:.0} %, the best direct one {direct:.0} % (by these shots bank is better with a chance of {sure}).\n"
    )
}

/// The scatter that costs most, and what costs about as much.
pub(super) fn most_worth_training(training: &[TrainingGain]) -> Vec<&TrainingGain> {
    /// What gains this fraction of the largest gain is about as good.
    const AS_GOOD: f64 = 0.85;
    let most = training.first().map_or(0.0, |first| first.gain.mean);
    let all = training.iter();
    all.filter(|other| other.gain.mean >= AS_GOOD * most)
        .collect()
}

/// What to train, in a sentence: the scatter that costs most, and what costs about as much.
fn training_in_words(training: &[TrainingGain]) -> String {
    let as_good = most_worth_training(training);
    if as_good.is_empty() {
        return String::new();
    }
    let names: Vec<&str> = as_good.iter().map(|t| scatter_in_words(t.cause)).collect();
    let gains: Vec<String> = as_good
        .iter()
        .map(|t| format!("{:.1}", 100.0 * t.gain.mean))
        .collect();
    if names.len() == 1 {
        format!(
            "What to train: {}. 10 % less scatter there gains {} points.\n",
            names[0], gains[0]
        )
    } else {
        format!(
            "What to train: {}; it hardly matters which. 10 % less scatter in one gains {} points.\n",
            names.join(", or "),
            gains.join(" or ")
        )
    }
}

/// What a shooter scatters in.
pub(super) fn scatter_in_words(cause: Cause) -> &'static str {
    ["speed", "release angle", "left and right", "backspin"][cause.0]
}

/// What makes were observed: made and shots.
pub type Observed = Option<(usize, usize)>;

/// Advice of a model that disagrees with the count of makes by more standard errors is not to be
/// followed; about 1 of 400 tests by luck.
pub(super) const MOST_DISAGREEMENT: f64 = 3.0;

/// By how many of its standard errors the share of makes differs from P of the usual shot.
pub(super) fn disagreement(p: &Interval, made: usize, shots: usize) -> f64 {
    let count = wilson_interval(made, shots);
    let error = libm::hypot(0.25 * (count.high - count.low), p.sd);
    libm::fabs(count.share - p.mean) / error
}

/// The answer for people: a few sentences, then the figures.
#[must_use]
pub fn advice_text(
    name: &str,
    advice: &Advice,
    observed: Observed,
    court_angle_rad: f64,
    units: UnitSystem,
) -> String {
    let words = ChangeWords {
        units,
        court_angle_rad,
    };
    let parts = [
        sentences(name, advice, observed, &words),
        shots_in_figures(advice, &words),
        steps_in_figures(advice, &words),
        backspin_in_words(advice, units),
        training_in_figures(advice),
        kinds_in_figures(advice),
        "\nThe intervals hold what these shots do not tell. They leave out the physics of this gym: see `bankshot physics`.\n".to_owned(),
    ];
    parts.concat()
}

/// The answer for the player: the sentences, where the ball should come down, and bank or direct.
#[must_use]
pub fn brief_advice_text(
    name: &str,
    advice: &Advice,
    observed: Observed,
    court_angle_rad: f64,
    units: UnitSystem,
) -> String {
    let text = player_advice_text(name, advice, observed, court_angle_rad, units);
    text + &other_kind_not_advised(advice)
}

/// The same without a word of a kind of shot that is not advised.
#[must_use]
pub fn player_advice_text(
    name: &str,
    advice: &Advice,
    observed: Observed,
    court_angle_rad: f64,
    units: UnitSystem,
) -> String {
    let words = ChangeWords {
        units,
        court_angle_rad,
    };
    let changes_spin = |steps: &AdviceSteps| steps.is_changed[Cause::BACKSPIN.0];
    let is_at_limit = uses_all_backspin(advice) && advice.steps.as_ref().is_some_and(changes_spin);
    let limit = match is_at_limit {
        true => "That backspin is max_backspin of the profile, which is assumed.\n",
        false => "",
    };
    [
        &sentences(name, advice, observed, &words),
        limit,
        &landing_in_words(advice, units),
    ]
    .concat()
}

/// What to tell the player: how many go in, what to change, and what to train.
fn sentences(name: &str, advice: &Advice, observed: Observed, words: &ChangeWords) -> String {
    let name = if name.is_empty() { "You" } else { name };
    let p = &advice.usual_probability;
    let counted = observed.filter(|(_, shots)| *shots > 0);
    let disagreement = counted.map_or(0.0, |(made, shots)| disagreement(p, made, shots));
    let seen = counted.map_or_else(String::new, |(made, shots)| {
        let but = if disagreement < 2.0 {
            String::new()
        } else {
            format!(
                ", {:.0} %: the count and the model disagree",
                100.0 * made as f64 / shots as f64
            )
        };
        format!("; {made} of {shots} went in{but}")
    });
    let mut text = if disagreement < MOST_DISAGREEMENT {
        String::new()
    } else {
        "Do not act on this yet: the makes and the measured shots do not belong together. Look at the place, the height of the release, what depth is counted from, left and right, the physics, and how a make was recorded.\n".to_owned()
    };
    text += &format!(
        "{name}: now {:.0} % of such shots go in (95 %: {:.0} to {:.0} %{seen}).\n",
        100.0 * p.mean,
        100.0 * p.low,
        100.0 * p.high
    );
    text += &release_in_words(advice, words);
    let at_the_limit = at_the_limit_in_words(words, advice);
    if !at_the_limit.is_empty() {
        text += &at_the_limit;
        text.push('\n');
    }
    text += &other_kind_in_words(advice);
    text += &training_in_words(&advice.training);
    text
}

/// Whether and how to change the release.
fn release_in_words(advice: &Advice, words: &ChangeWords) -> String {
    let sure = advice.steps.as_ref();
    let sure = sure.filter(|steps| steps.steps.iter().any(AdviceStep::is_sure));
    match (&advice.gain, sure) {
        (_, Some(steps)) => advised_in_words(words, advice, steps),
        (Some(gain), None) if gain.low > 0.0 && gain.mean > 0.005 => format!(
            "The best shot gains {:.1} points (95 %: {:+.1} to {:+.1}), but no step towards it is sure, so none is advised: keep your release.{}\n",
            100.0 * gain.mean,
            100.0 * gain.low,
            100.0 * gain.high,
            more_shots_in_words(advice)
        ),
        (Some(gain), None) if gain.mean > 0.005 => format!(
            "Another release may gain {:.1} points, but these shots cannot tell it from luck: measure more before you change anything.{}\n",
            100.0 * gain.mean,
            more_shots_in_words(advice)
        ),
        (Some(_), None) => "Keep your release: no other one is worth a change.\n".to_owned(),
        (None, None) => "No clean shot of this kind was found from here.\n".to_owned(),
    }
}

/// The usual, the advised and the best shot.
fn shots_in_figures(advice: &Advice, words: &ChangeWords) -> String {
    let p = &advice.usual_probability;
    let mut text = format!(
        "\nP of the usual shot  {} (95 %: {:.1} to {:.1} %, numerics ± {:.2})\n",
        percent(p.mean),
        100.0 * p.low,
        100.0 * p.high,
        100.0 * advice.numerical_standard_error
    );
    let (Some(best), Some(probability), Some(gain)) =
        (&advice.best, &advice.best_probability, &advice.gain)
    else {
        return text;
    };
    let is_changed = |steps: &&AdviceSteps| steps.is_changed.contains(&true);
    if let Some(steps) = advice.steps.as_ref().filter(is_changed) {
        let p = &advice.advised_probability;
        text += &format!(
            "gain of the advised shot  {}, P {} (95 %: {:.1} to {:.1} %)\n",
            points(&steps.gain),
            percent(p.mean),
            100.0 * p.low,
            100.0 * p.high
        );
    }
    text += &format!(
        "gain of the best {} shot  {}, P {} (95 %: {:.1} to {:.1} %); better in {:.0} % of the draws\n",
        advice.kind.name(),
        points(gain),
        percent(probability.mean),
        100.0 * probability.low,
        100.0 * probability.high,
        100.0 * advice.gain_is_positive
    );
    text += "usual shot: as measured; advised shot: with the changes that are sure; best shot: the best of its kind\n";
    text += &words.release("usual shot", &advice.usual);
    if let Some(steps) = &advice.steps {
        text += &words.release("advised shot", &steps.advised);
    }
    text += &words.release("best shot", &values_of(&best.nominal));
    if let Some([usual, advised]) = &advice.landings {
        text += "at the height of the hoop; depth from the front of the ring; of the release alone: the mean depth of all shots is less, as scatter in the angle shortens them\n";
        text += &words.landing("usual shot", usual);
        text += &words.landing("advised shot", advised);
    }
    text
}

/// Each step from the usual to the best shot with its gain.
fn steps_in_figures(advice: &Advice, words: &ChangeWords) -> String {
    let Some(steps) = &advice.steps else {
        return String::new();
    };
    let mut text = "\nstep by step: speed, angle with a speed of its own, aim, backspin; each on top of the supported ones before".to_owned();
    if !steps.steps.iter().all(AdviceStep::is_sure) {
        text += " (in brackets: less than half a point, not surely above 0, or to a side that is not sure, so not advised";
        let speed_then_angle = steps.steps.windows(2).any(|pair| {
            let causes = [pair[0].cause, pair[1].cause];
            causes == [Cause::SPEED, Cause::PITCH] && !pair[0].is_sure() && pair[1].is_sure()
        });
        if speed_then_angle {
            text += " alone; the new angle comes with a speed of its own";
        }
        text += ")";
    }
    text += "\n";
    let mut from = advice.usual;
    for step in &steps.steps {
        let mut what = words.of_step(step, &from);
        if step.is_sure() {
            from = step.release;
        } else {
            what = format!("({what})");
        }
        text += &format!("  {what:<42} {}\n", points(&step.gain));
    }
    text
}

/// What is assumed of the backspin.
fn backspin_in_words(advice: &Advice, units: UnitSystem) -> String {
    let mut text = String::new();
    if uses_all_backspin(advice) {
        text += "  The best shot uses all the backspin allowed: max_backspin of the profile, assumed.\n";
    }
    if advice.spin != SpinSource::Measured {
        text += &format!(
            "  The backspin was not measured: {:.1} rev/s is {}. Advice keeps it; `best` and `team` do where `choose` in the profile leaves it out.\n",
            advice.usual[3] / value_units(units)[3].1,
            advice.spin.name()
        );
    }
    text
}

/// What less scatter of each value gains.
fn training_in_figures(advice: &Advice) -> String {
    let steps = advice.steps.as_ref();
    let shot = match steps.is_some_and(|steps| steps.is_changed.contains(&true)) {
        true => "advised",
        false => "usual",
    };
    let mut text = format!("\n10 % less scatter, at the {shot} shot\n");
    for training in &advice.training {
        text += &format!(
            "  {:<38} {}\n",
            scatter_in_words(training.cause),
            points(&training.gain)
        );
    }
    text
}

/// The best bank shot against the best direct one.
fn kinds_in_figures(advice: &Advice) -> String {
    let Some(kinds) = &advice.kinds else {
        return String::new();
    };
    let [direct, bank] = kinds.probabilities;
    format!(
        "\nbank against direct: {} against {}, {}; bank is better in {:.0} % of the draws\n",
        percent(bank.mean),
        percent(direct.mean),
        points(&kinds.difference),
        100.0 * kinds.bank_is_better
    )
}

/// Whether the best shot uses all the backspin that is allowed.
fn uses_all_backspin(advice: &Advice) -> bool {
    let is_at_limit = |best: &BestShot| best.at_limits.contains(&Limit::MaxBackspin);
    advice.best.as_ref().is_some_and(is_at_limit)
}
