//! The answer of `advise`, for people and for programs.

use super::fit_json::interval_json;
use super::fit_text::percent;
use super::parameters::value_units;
use crate::best_shot::{BestShot, Limit};
use crate::fitting::{
    Advice, AdviceStep, AdviceSteps, Cause, Interval, Landing, SAME_SPEED_M_S, SpinSource,
    TrainingGain, Values, values_of, wilson_interval,
};
use crate::output::json_object::{number, object};
use crate::shooter::{Location, ShotKind};
use crate::units::{DEGREE_RAD, UnitSystem};
use serde_json::Value;

/// Points of P with their interval: `2.1 points (95 %: 0.4 to 3.9)`.
fn points(interval: &Interval) -> String {
    // Rounded first, and 0 added: no negative zero.
    let [mean, low, high] =
        [interval.mean, interval.low, interval.high].map(|p| libm::round(1000.0 * p) / 10.0 + 0.0);
    format!("{mean:+.1} points (95 %: {low:+.1} to {high:+.1})")
}

/// Words for the change of one value.
struct ChangeWords {
    units: UnitSystem,
    court_angle_rad: f64,
}

impl ChangeWords {
    /// A change of one value in a coach's words.
    fn of_value(&self, cause: Cause, from: f64, to: f64) -> String {
        let (unit, size) = value_units(self.units)[cause.0];
        let difference = ((to - from) / size).abs();
        let decimals = match cause {
            Cause::SPEED => 2,
            Cause::PITCH | Cause::AIM => 1,
            _ => 2,
        };
        let amount = format!("{difference:.decimals$} {unit}");
        let is_nothing = cause == Cause::SPEED && (to - from).abs() < SAME_SPEED_M_S;
        if is_nothing || amount.chars().all(|c| !('1'..='9').contains(&c)) {
            return format!(
                "keep {}",
                ["the speed", "the angle", "the aim", "the backspin"][cause.0]
            );
        }
        let grows = to > from;
        match cause {
            Cause::SPEED if grows => format!("throw {amount} harder"),
            Cause::SPEED => format!("throw {amount} softer"),
            Cause::PITCH if grows => format!("release {amount} steeper"),
            Cause::PITCH => format!("release {amount} flatter"),
            // The polar angle is that of the way back: a greater one points to the shooter's left.
            Cause::AIM if grows => format!("aim {amount} more to the left"),
            Cause::AIM => format!("aim {amount} more to the right"),
            _ if grows => format!("give {amount} more backspin"),
            _ => format!("give {amount} less backspin"),
        }
    }

    /// A step in a coach's words: the angle with the speed that goes with it.
    fn of_step(&self, step: &AdviceStep, from: &Values) -> String {
        let i = step.cause.0;
        let mut text = self.of_value(step.cause, from[i], step.release[i]);
        if step.cause == Cause::PITCH {
            let speed = self.of_value(Cause::SPEED, from[0], step.release[0]);
            let speed = speed.trim_start_matches("throw ");
            text += &format!(", {}", speed.replace("keep the", "with about the same"));
        }
        text
    }

    /// All differences between two releases, the two that belong together first.
    fn of_releases(&self, from: &Values, to: &Values) -> String {
        let changes: Vec<String> = [Cause::PITCH, Cause::SPEED, Cause::AIM, Cause::BACKSPIN]
            .into_iter()
            .filter(|cause| from[cause.0] != to[cause.0])
            .map(|cause| self.of_value(cause, from[cause.0], to[cause.0]))
            .collect();
        match changes.split_last() {
            Some((last, [])) => last.clone(),
            Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
            None => String::new(),
        }
    }

    /// Where a ball falls, as a line of the answer: what a gym sensor shows.
    fn landing(&self, title: &str, landing: &Landing) -> String {
        let (unit, size) = self.units.short_length();
        let right = landing.right_m / size;
        let side = if right < 0.0 { "left" } else { "right" };
        format!(
            "{title:<12} entry {:.1} deg, depth {:.1} {unit}, {:.1} {unit} to the {side}\n",
            landing.entry_angle_rad / DEGREE_RAD,
            landing.depth_m / size,
            right.abs()
        )
    }

    /// A release as a line of the answer.
    fn release(&self, title: &str, values: &Values) -> String {
        let units = value_units(self.units);
        let aim = (values[2] - self.court_angle_rad) / units[2].1;
        // No negative zero.
        let aim = libm::round(10.0 * aim) / 10.0 + 0.0;
        format!(
            "{title:<12} speed {:.2} {}, pitch {:.1} deg, aim {:+.1} deg, backspin {:.2} rev/s\n",
            values[0] / units[0].1,
            units[0].0,
            values[1] / units[1].1,
            aim,
            values[3] / units[3].1
        )
    }
}

/// The changes that are advised, in words: "release 2.1 deg steeper and throw 0.30 ft/s harder".
#[must_use]
pub fn changes_in_words(advice: &Advice, court_angle_rad: f64, units: UnitSystem) -> String {
    let words = ChangeWords {
        units,
        court_angle_rad,
    };
    advice.steps.as_ref().map_or_else(String::new, |steps| {
        words.of_releases(&advice.usual, &steps.advised)
    })
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

/// Which of speed and angle to change first, in a sentence with a space before it; empty where they
/// do not change together.
fn first_change_in_words(advice: &Advice, steps: &AdviceSteps) -> String {
    /// A difference of P from which on one is named first: what P itself is known to.
    const MATTERS: f64 = 0.05;
    let by_m_s = (steps.advised[0] - advice.usual[0]).abs();
    let Some([speed, pitch]) = steps.alone.filter(|_| by_m_s >= SAME_SPEED_M_S) else {
        return String::new();
    };
    let p = advice.usual_probability.mean;
    let [of_speed, of_pitch] = [speed, pitch].map(|gain| 100.0 * (p + gain.mean));
    let both =
        format!("the new speed alone makes {of_speed:.0} %, the new angle alone {of_pitch:.0} %");
    if speed.mean < 0.0 && pitch.mean < 0.0
        || speed.mean.min(pitch.mean) < 0.0 && speed.mean.max(pitch.mean) <= 0.5 * steps.gain.mean
    {
        return format!(" Change speed and angle together: {both}.");
    }
    match speed.mean - pitch.mean {
        _ if pitch.mean < 0.0 => format!(" Begin with the speed: {both}."),
        _ if speed.mean < 0.0 => format!(" Begin with the angle: {both}."),
        more if more > MATTERS => format!(" Begin with the speed: {both}."),
        more if more < -MATTERS => format!(" Begin with the angle: {both}."),
        _ => format!(" Begin with either: {both}."),
    }
}

/// How many more shots would make a step sure, in a sentence; empty where none is open, or they
/// would be too many.
fn more_shots_in_words(advice: &Advice) -> String {
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
        "{words} makes {:.0} %, the best {} one {:.0} % (by these shots {} is better with a chance of {:.0} %).\n",
        100.0 * other.mean,
        advice.kind.name(),
        100.0 * own.mean,
        advice.kind.other().name(),
        100.0 * sure
    )
}

/// Where the sentences do not advise the other kind of shot: how it compares. Empty where they do,
/// or where one kind cannot be made.
#[must_use]
pub fn other_kind_not_advised(advice: &Advice) -> String {
    let Some(kinds) = &advice.kinds else {
        return String::new();
    };
    if !other_kind_in_words(advice).is_empty() {
        return String::new();
    }
    let [direct, bank] = kinds.probabilities.map(|p| 100.0 * p.mean);
    let sure = 100.0 * kinds.bank_is_better;
    format!(
        "Bank or direct: the best bank shot makes {bank:.0} %, the best direct one {direct:.0} % (by these shots bank is better with a chance of {sure:.0} %).\n"
    )
}

/// Where the advised release should land, against the usual one, in a sentence: what a player sees.
/// Empty where that is the same.
#[must_use]
pub fn landing_in_words(advice: &Advice, units: UnitSystem) -> String {
    /// Less than this cannot be seen, m.
    const SEEN_M: f64 = 0.012;
    let Some([usual, advised]) = &advice.landings else {
        return String::new();
    };
    let (unit, size) = units.short_length();
    let deeper_m = advised.depth_m - usual.depth_m;
    let right_m = advised.right_m - usual.right_m;
    let moved = |by_m: f64, [more, less]: [&str; 2]| {
        let way = if by_m > 0.0 { more } else { less };
        (by_m.abs() > SEEN_M).then(|| format!("{:.1} {unit} {way}", by_m.abs() / size))
    };
    let moves = [
        moved(deeper_m, ["deeper", "shorter"]),
        moved(right_m, ["further right", "further left"]),
    ];
    let moves: Vec<String> = moves.into_iter().flatten().collect();
    let [now, then] =
        [usual, advised].map(|landing| format!("{:.0}", landing.entry_angle_rad / DEGREE_RAD));
    if moves.is_empty() && now == then {
        return String::new();
    }
    let now = if now == then {
        "as now".to_owned()
    } else {
        format!("now {now}")
    };
    if moves.is_empty() {
        return format!(
            "It should then come down where it does, at an entry angle of {then} deg ({now}).\n"
        );
    }
    format!(
        "It should then come down {} (entry angle {then} deg, {now}).\n",
        moves.join(" and ")
    )
}

/// What to train, in a sentence: the scatter that costs most, and what costs about as much.
fn training_in_words(training: &[TrainingGain]) -> String {
    /// What gains this fraction of the largest gain is about as good.
    const AS_GOOD: f64 = 0.85;
    let Some(first) = training.first() else {
        return String::new();
    };
    let as_good: Vec<&TrainingGain> = training
        .iter()
        .filter(|other| other.gain.mean >= AS_GOOD * first.gain.mean)
        .collect();
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
fn scatter_in_words(cause: Cause) -> &'static str {
    ["speed", "release angle", "left and right", "backspin"][cause.0]
}

/// What makes were observed: made and shots.
pub type Observed = Option<(usize, usize)>;

/// Advice of a model that disagrees with the count of makes by more standard errors is not to be
/// followed; about 1 of 400 tests by luck.
const MOST_DISAGREEMENT: f64 = 3.0;

/// By how many of its standard errors the share of makes differs from P of the usual shot.
fn disagreement(p: &Interval, made: usize, shots: usize) -> f64 {
    let count = wilson_interval(made, shots);
    let error = libm::hypot(0.25 * (count.high - count.low), p.sd);
    libm::fabs(count.share - p.mean) / error
}

/// What a poster says of a player's own shots: how many go in, what to change, and what the player
/// then sees; empty where no change is sure, or the makes and the measured shots do not belong
/// together.
#[must_use]
pub fn advice_for_poster(
    advice: &Advice,
    observed: Observed,
    (from, court_angle_rad): (&str, f64),
    units: UnitSystem,
) -> String {
    let sure = advice.steps.as_ref();
    let sure = sure.filter(|steps| steps.steps.iter().any(AdviceStep::is_sure));
    let p = advice.usual_probability;
    let is_doubted = observed.is_some_and(|(made, shots)| {
        shots > 0 && disagreement(&p, made, shots) >= MOST_DISAGREEMENT
    });
    let Some(steps) = sure.filter(|_| !is_doubted) else {
        return String::new();
    };
    let words = ChangeWords {
        units,
        court_angle_rad,
    };
    format!(
        "Your shot, {from}: now {:.0} of 100 go in, {:.0} can: {}.{} {}",
        100.0 * p.mean,
        100.0 * (p.mean + steps.gain.mean),
        words.of_releases(&advice.usual, &steps.advised),
        first_change_in_words(advice, steps),
        landing_in_words(advice, units).trim_end()
    )
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
    let words = ChangeWords {
        units,
        court_angle_rad,
    };
    let sure = advice.steps.as_ref();
    let sure = sure.filter(|steps| steps.steps.iter().any(AdviceStep::is_sure));
    match (&advice.gain, sure) {
        (_, Some(steps)) => text += &advised_in_words(&words, advice, steps),
        (Some(gain), None) if gain.low > 0.0 && gain.mean > 0.005 => {
            text += &format!(
                "The best shot gains {:.1} points (95 %: {:+.1} to {:+.1}), but no step towards it is sure, so none is advised: keep your release.{}\n",
                100.0 * gain.mean,
                100.0 * gain.low,
                100.0 * gain.high,
                more_shots_in_words(advice)
            );
        }
        (Some(gain), None) if gain.mean > 0.005 => {
            text += &format!(
                "Another release may gain {:.1} points, but these shots cannot tell it from luck: measure more before you change anything.{}\n",
                100.0 * gain.mean,
                more_shots_in_words(advice)
            );
        }
        (Some(_), None) => text += "Keep your release: no other one is worth a change.\n",
        (None, None) => text += "No clean shot of this kind was found from here.\n",
    }
    text += &other_kind_in_words(advice);
    text += &training_in_words(&advice.training);
    text += &format!(
        "\nP of the usual shot  {} (95 %: {:.1} to {:.1} %, numerics ± {:.2})\n",
        percent(p.mean),
        100.0 * p.low,
        100.0 * p.high,
        100.0 * advice.numerical_standard_error
    );
    if let (Some(best), Some(probability), Some(gain)) =
        (&advice.best, &advice.best_probability, &advice.gain)
    {
        if let Some(steps) = &advice.steps {
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
    }
    if let Some(steps) = &advice.steps {
        text += "\nstep by step, each on top of those before";
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
            let what = words.of_step(step, &from);
            let what = if step.is_sure() {
                what
            } else {
                format!("({what})")
            };
            text += &format!("  {what:<42} {}\n", points(&step.gain));
            from = step.release;
        }
    }
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
    let is_changed = advice
        .steps
        .as_ref()
        .is_some_and(|steps| steps.is_changed.contains(&true));
    text += if is_changed {
        "\n10 % less scatter, at the advised shot\n"
    } else {
        "\n10 % less scatter, at the usual shot\n"
    };
    for training in &advice.training {
        text += &format!(
            "  {:<38} {}\n",
            scatter_in_words(training.cause),
            points(&training.gain)
        );
    }
    if let Some(kinds) = &advice.kinds {
        let [direct, bank] = kinds.probabilities;
        text += &format!(
            "\nbank against direct: {} against {}, {}; bank is better in {:.0} % of the draws\n",
            percent(bank.mean),
            percent(direct.mean),
            points(&kinds.difference),
            100.0 * kinds.bank_is_better
        );
    }
    text += "\nThe intervals hold what these shots do not tell. They leave out the physics of this gym: see `bankshot physics`.\n";
    text
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
    let text = advice_text(name, advice, observed, court_angle_rad, units);
    // The sentences end with an empty line.
    let first = text
        .split_once("\n\n")
        .map_or(text.as_str(), |(first, _)| first);
    let landing = landing_in_words(advice, units);
    let changes_spin = |steps: &AdviceSteps| steps.is_changed[Cause::BACKSPIN.0];
    let is_at_limit = uses_all_backspin(advice) && advice.steps.as_ref().is_some_and(changes_spin);
    let limit = if is_at_limit {
        "That backspin is max_backspin of the profile, which is assumed.\n"
    } else {
        ""
    };
    format!(
        "{first}\n{limit}{landing}{}",
        other_kind_not_advised(advice)
    )
}

/// Whether the best shot uses all the backspin that is allowed.
fn uses_all_backspin(advice: &Advice) -> bool {
    let is_at_limit = |best: &BestShot| best.at_limits.contains(&Limit::MaxBackspin);
    advice.best.as_ref().is_some_and(is_at_limit)
}

/// The answer for programs.
#[must_use]
pub fn advice_json(
    name: &str,
    location: &Location,
    advice: &Advice,
    observed: Observed,
    units: UnitSystem,
) -> Value {
    let units_of = value_units(units);
    let values = |values: [f64; 4]| {
        let named = ["speed", "pitch", "polar", "backspin"]
            .iter()
            .zip(units_of)
            .zip(values);
        object(
            named
                .map(|((name, (unit, size)), value)| {
                    (
                        format!("{name}_{}", unit.replace('/', "_")),
                        number(value / size),
                    )
                })
                .collect(),
        )
    };
    let interval = |value: &Interval| object(interval_json(value));
    let optional = |value: &Option<Interval>| value.as_ref().map_or(Value::Null, interval);
    let named = |name: &str, value: Value| (name.to_owned(), value);
    let kinds = advice.kinds.as_ref().map_or(Value::Null, |kinds| {
        let of = |kind: ShotKind| interval(&kinds.probabilities[kind as usize]);
        object(vec![
            named("direct", of(ShotKind::Direct)),
            named("bank", of(ShotKind::Bank)),
            named("bank_less_direct", interval(&kinds.difference)),
            named("bank_is_better", number(kinds.bank_is_better)),
        ])
    });
    let causes = advice.steps.iter().flat_map(|steps| &steps.steps);
    let causes = causes.map(|step| {
        let mut record = vec![named("cause", step.cause.name().into())];
        record.extend(interval_json(&step.gain));
        record.push(named("release", values(step.release)));
        object(record)
    });
    let of_steps =
        |get: &dyn Fn(&AdviceSteps) -> Value| advice.steps.as_ref().map_or(Value::Null, get);
    let alone = of_steps(&|steps| {
        steps.alone.as_ref().map_or(Value::Null, |[speed, pitch]| {
            object(vec![
                named("speed", interval(speed)),
                named("pitch", interval(pitch)),
            ])
        })
    });
    let training = advice.training.iter().map(|training| {
        let mut record = vec![named("less_scatter_of", training.cause.name().into())];
        record.extend(interval_json(&training.gain));
        object(record)
    });
    let observed = observed.map_or(Value::Null, |(made, shots)| {
        object(vec![
            named("shots", shots.into()),
            named("made", made.into()),
        ])
    });
    let (short, inch) = units.short_length();
    let landing = |landing: &Landing| {
        object(vec![
            named(
                "entry_angle_deg",
                number(landing.entry_angle_rad / DEGREE_RAD),
            ),
            named(&format!("depth_{short}"), number(landing.depth_m / inch)),
            named(
                &format!("left_right_{short}"),
                number(landing.right_m / inch),
            ),
        ])
    };
    let landings = advice
        .landings
        .as_ref()
        .map_or(Value::Null, |[usual, advised]| {
            object(vec![
                named("usual", landing(usual)),
                named("advised", landing(advised)),
            ])
        });
    let (long, metre) = units.length();
    object(vec![
        named("shooter", name.into()),
        named(
            &format!("distance_{long}"),
            // Converted to SI units and back: without what that cost in the last digits.
            number((location.distance_m / metre * 1e9).round() / 1e9),
        ),
        named("court_angle_deg", number(location.angle_rad / DEGREE_RAD)),
        named("kind", advice.kind.name().into()),
        named("usual", values(advice.usual)),
        named("usual_probability", interval(&advice.usual_probability)),
        named(
            "numerical_standard_error",
            number(advice.numerical_standard_error),
        ),
        named("observed", observed),
        named(
            "best",
            advice
                .best
                .as_ref()
                .map_or(Value::Null, |best| values(values_of(&best.nominal))),
        ),
        named("best_probability", optional(&advice.best_probability)),
        named(
            "advised_probability",
            optional(&Some(advice.advised_probability)),
        ),
        named("gain", optional(&advice.gain)),
        named("gain_is_positive", number(advice.gain_is_positive)),
        named("causes", causes.collect()),
        named("advised", of_steps(&|steps| values(steps.advised))),
        named("advised_gain", of_steps(&|steps| interval(&steps.gain))),
        named("advised_alone", alone),
        named("training", training.collect()),
        named("landings", landings),
        named("bank_or_direct", kinds),
    ])
}
