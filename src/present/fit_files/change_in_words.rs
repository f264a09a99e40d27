//! The changes of a release in a coach's words.

use crate::fitting::{Advice, AdviceStep, AdviceSteps, AloneGains, Cause, SAME_SPEED_M_S, Values};
use crate::present::words::{likely, of_100};
use crate::store::parameters::value_units;
use crate::units::{DEGREE_RAD, UnitSystem, with_decimals};

/// Words for the change of one value.
pub(super) struct ChangeWords {
    pub(super) units: UnitSystem,
    pub(super) court_angle_rad: f64,
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
                ["the speed", "the angle", "the direction", "the backspin"][cause.0]
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
    pub(super) fn of_step(&self, step: &AdviceStep, from: &Values) -> String {
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
    pub(super) fn of_releases(&self, from: &Values, to: &Values) -> String {
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

    /// A release as a line of the answer.
    pub(super) fn release(&self, title: &str, values: &Values) -> String {
        let units = value_units(self.units);
        let aim = with_decimals((values[2] - self.court_angle_rad) / units[2].1, 1);
        format!(
            "  {title:<12} speed {:.2} {}, angle {:.1} deg, direction {:+.1} deg, backspin {:.2} rev/s\n",
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

/// Which of speed and angle to change first, in a sentence; `None` where they do not change
/// together.
pub(super) fn first_change_in_words(advice: &Advice, steps: &AdviceSteps) -> Option<String> {
    let alone = gains_alone(advice, steps)?;
    let p = advice.usual_probability.mean;
    let [of_speed, of_pitch] = [alone.speed, alone.pitch].map(|gain| of_100(p + gain.mean));
    let both = format!("the new speed alone makes {of_speed}, the new angle alone {of_pitch}");
    let (name, chance) = likelier_beginning(&alone);
    let chance = format!("probability that starting with the {name} is better: {chance}");
    Some(match first_change(steps) {
        FirstChange::Both => format!("Change both together: {both}."),
        FirstChange::Speed => format!("Start with the speed: {both} ({chance})."),
        FirstChange::Pitch => format!("Start with the angle: {both} ({chance})."),
        FirstChange::Either => format!("Start with either: {both} ({chance})."),
    })
}

/// What speed and angle gain alone; `None` where they do not both change.
pub(super) fn gains_alone(advice: &Advice, steps: &AdviceSteps) -> Option<AloneGains> {
    let by_m_s = (steps.advised[0] - advice.usual[0]).abs();
    steps.alone.filter(|_| by_m_s >= SAME_SPEED_M_S)
}

/// What is more likely to be the better start, and the probability that it is.
pub(super) fn likelier_beginning(alone: &AloneGains) -> (&'static str, String) {
    let (name, share) = match alone.speed_is_better {
        share if share >= 0.5 => ("speed", share),
        share => ("angle", 1.0 - share),
    };
    (name, likely(share))
}

/// What to change first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FirstChange {
    Speed,
    Pitch,
    /// One alone is about as good as the other, or the draws leave open which is better.
    Either,
    /// One alone loses.
    Both,
}

/// What to change first where speed and angle change together.
pub(super) fn first_change(steps: &AdviceSteps) -> FirstChange {
    /// The least difference of P that counts.
    const MATTERS: f64 = 0.01;
    /// The share of the draws from which on one is surely better.
    const SURE: f64 = 0.9;
    let Some(alone) = steps.alone else {
        return FirstChange::Either;
    };
    let [speed, pitch] = [alone.speed.mean, alone.pitch.mean];
    let (least, most) = (speed.min(pitch), speed.max(pitch));
    if most < 0.0 || least < 0.0 && most <= 0.5 * steps.gain.mean {
        return FirstChange::Both;
    }
    match alone.speed_is_better {
        share if share >= SURE && speed - pitch >= MATTERS => FirstChange::Speed,
        share if 1.0 - share >= SURE && pitch - speed >= MATTERS => FirstChange::Pitch,
        _ if pitch < 0.0 => FirstChange::Speed,
        _ if speed < 0.0 => FirstChange::Pitch,
        _ => FirstChange::Either,
    }
}

/// How the ball comes down with the suggested release, compared with now, in a sentence; `None`
/// where nobody would see a difference.
#[must_use]
pub fn landing_in_words(advice: &Advice, units: UnitSystem) -> Option<String> {
    /// Less than this cannot be seen, m.
    const SEEN_M: f64 = 0.012;
    let [usual, advised] = advice.landings.as_ref()?;
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
    let [now, then] =
        [usual, advised].map(|landing| format!("{:.0}", landing.entry_angle_rad / DEGREE_RAD));
    let steeper = match advised.entry_angle_rad > usual.entry_angle_rad {
        true => "steeper",
        false => "flatter",
    };
    let angle = (now != then).then(|| format!("{steeper} (at {then} deg instead of {now})"));
    let parts: Vec<String> = moves.into_iter().flatten().chain(angle).collect();
    (!parts.is_empty()).then(|| {
        format!(
            "The ball should then come down {}.",
            crate::present::words::list(&parts)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::Interval;

    /// What to begin with: it must be better by a shot in 100 and in 90 of 100 draws.
    #[test]
    fn contract_the_first_change_is_sure() {
        let interval = |mean: f64| Interval {
            mean,
            sd: 0.01,
            low: mean - 0.02,
            high: mean + 0.02,
        };
        let first = |speed: f64, pitch: f64, speed_is_better: f64| {
            first_change(&AdviceSteps {
                steps: Vec::new(),
                advised: [0.0; 4],
                is_changed: [true, true, false, false],
                gain: interval(0.3),
                alone: Some(AloneGains {
                    speed: interval(speed),
                    pitch: interval(pitch),
                    speed_is_better,
                }),
            })
        };
        assert_eq!(first(0.2, 0.1, 0.95), FirstChange::Speed);
        assert_eq!(first(0.1, 0.2, 0.05), FirstChange::Pitch);
        assert_eq!(first(0.2, 0.1, 0.85), FirstChange::Either);
        assert_eq!(first(0.105, 0.1, 0.99), FirstChange::Either);
        assert_eq!(first(0.2, -0.1, 0.99), FirstChange::Speed);
        assert_eq!(first(0.1, -0.1, 0.99), FirstChange::Both);
        assert_eq!(first(-0.1, -0.2, 0.99), FirstChange::Both);
    }
}
