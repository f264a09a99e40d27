//! What changed between two sessions of a shooter, as text.

use crate::answers::sessions::{Decision, SessionAnswer, SessionChange, quantile_among};
use crate::fitting::{Interval, ProbabilityChange, change_of_share};
use crate::units::with_decimals;

impl SessionChange {
    /// The name in the table; of a correlation `r speed-pitch`.
    fn label(&self) -> String {
        match self.name.strip_prefix("corr_") {
            // As short as the longest name of another value.
            Some(pair) => format!("r {}", pair.replace('_', "-").replace("backspin", "spin")),
            None => self.name.clone(),
        }
    }

    /// The value in words.
    #[must_use]
    pub fn in_words(&self) -> &str {
        match self.name.as_str() {
            "P" => "the chance of a shot",
            "polar_mean" => "the direction, positive to the left",
            name => quantity_in_words(name),
        }
    }

    /// The words for a growing and a falling value.
    fn directions(&self) -> [&'static str; 2] {
        match self.name.as_str() {
            // Positive to the shooter's left.
            "polar_mean" => ["left", "right"],
            _ => ["rose", "fell"],
        }
    }

    /// The direction of the change, and the probability of this direction.
    fn direction(&self) -> (&'static str, f64) {
        let [grew, fell] = self.directions();
        let probability = self.comparison.grew;
        if probability >= 0.5 {
            (grew, probability)
        } else {
            (fell, 1.0 - probability)
        }
    }

    /// Decimals that show two digits of the change's uncertainty, at most three.
    #[must_use]
    pub fn decimals(&self) -> usize {
        let sd = self.comparison.change.sd / self.size;
        if sd > 0.0 {
            (1.0 - libm::floor(libm::log10(sd))).clamp(0.0, 3.0) as usize
        } else {
            3
        }
    }
}

/// In points, without a decimal.
fn in_points(change: f64) -> f64 {
    with_decimals(100.0 * change, 0)
}

/// In points, rounded to tenths.
fn tenths(change: f64) -> f64 {
    with_decimals(100.0 * change, 1)
}

/// A change of P: `+3.1 points (95 %: -1.2 to +7.4)`.
fn points(change: &Interval) -> String {
    let [mean, low, high] = [change.mean, change.low, change.high].map(tenths);
    format!("{mean:+.1} points (95 %: {low:+.1} to {high:+.1})")
}

/// The same in a list: `+3.1 (-1.2 to +7.4)`.
fn without_level(change: &Interval) -> String {
    let [mean, low, high] = [change.mean, change.low, change.high].map(tenths);
    format!("{mean:+.1} ({low:+.1} to {high:+.1})")
}

/// The verdict in words, then the table. The sessions are before and after.
#[must_use]
pub fn session_changes_text(
    sessions: &[SessionAnswer; 2],
    changes: &[SessionChange],
    causes: &ProbabilityChange,
    tested: usize,
) -> String {
    let makes = sessions
        .each_ref()
        .map(|session| (session.made, session.with_result));
    let chances = changes.iter().find(|change| change.name == "P");
    let chances = chances.map(|p| [p.comparison.before, p.comparison.after]);
    let [before, after] = [0, 1].map(|i| {
        let session = &sessions[i];
        let makes = match makes[i] {
            (_, 0) => String::new(),
            (made, of) => {
                let percent = 100.0 * made as f64 / of as f64;
                format!(", {made} of {of} made: {percent:.0} %")
            }
        };
        let chance = chances.map_or_else(String::new, |chances| {
            let Interval {
                mean, low, high, ..
            } = chances[i].scaled(100.0);
            format!("; the chance is {mean:.0} %, 95 %: {low:.0} to {high:.0}")
        });
        format!("{} ({} shots{makes}{chance})", session.name, session.shots)
    });
    let mut text = verdict(changes, tested);
    text += &format!(
        "Of the change of the chance, the scatter makes {}, and the usual release (the means) {}. What the scatter does depends on the usual release: {} at the old one, {} at the new one; the first number is the mean of both. Of the usual release the new speed alone, all else as before, makes {}, the new angle alone {}, the new direction alone {}; these need not add up, as each does something else beside the others.\n",
        points(&causes.by_scatter),
        points(&causes.by_means),
        points(&causes.by_scatter_first_and_last[0]),
        points(&causes.by_scatter_first_and_last[1]),
        points(&causes.by_mean_alone[0]),
        without_level(&causes.by_mean_alone[1]),
        without_level(&causes.by_mean_alone[2])
    );
    if let [first @ (made, 1..), second @ (made_then, 1..)] = makes {
        let percent = |made: usize, of: usize| 100.0 * made as f64 / of as f64;
        let change = change_of_share(first, second);
        let [by, low, high] = [change.share, change.low, change.high].map(in_points);
        text += &format!(
            "Luck at the ring is not in this chance; the makes themselves went from {:.0} to {:.0} %, {by:+.0} points (95 %: {low:+.0} to {high:+.0}).\n",
            percent(made, first.1),
            percent(made_then, second.1)
        );
    }
    text += &format!(
        "\nbefore  {before}\nafter   {after}\n\n{:<13} {:>7} {:>7} {:>7} {:>17} {:<5} {:<10} {:>7}\n",
        "", "before", "after", "change", "95 %", "unit", "direction", "decide"
    );
    for change in changes {
        text += &line(change, tested);
    }
    let ratios = changes.iter().filter_map(|change| {
        let ratio = change.ratio?;
        let name = change.name.trim_end_matches("_sd");
        Some(format!(
            "{name} {:.2} (95 %: {:.2} to {:.2})",
            ratio.mean, ratio.low, ratio.high
        ))
    });
    let ratios: Vec<String> = ratios.collect();
    if !ratios.is_empty() {
        text += &format!("\nScatter after over before: {}.\n", ratios.join(", "));
    }
    text += "\n\
        r          a correlation\n\
        direction  the chance that it changed this way at all; 50 % says nothing\n\
        decide     about how many shots a session would decide a change of this size; for the values below P with room for chance, as several are looked at (--planned names those that count). yes: decided now. -: less than its own uncertainty, so its size says nothing (`bankshot design` says what a change of 5 or 10 points takes)\n\
        The intervals leave out the physics of this gym and a constant error of the tracker, which are the same in both sessions: with others (`bankshot fit --physics`, an offset in --map) the change can be another too.\n";
    text
}

/// Two or three sentences: what became of P, which other values changed, and which may have.
fn verdict(changes: &[SessionChange], tested: usize) -> String {
    let mut text = String::new();
    if let Some(p) = changes.iter().find(|change| change.name == "P") {
        let change = p.comparison.change.scaled(1.0 / p.size);
        let (direction, probability) = p.direction();
        let points = change.mean.abs();
        let unit = if points.round() == 1.0 {
            "point"
        } else {
            "points"
        };
        let interval = format!("95 %: {:+.0} to {:+.0}", change.low, change.high);
        text += &if p.is_decided() {
            format!("The chance of a shot {direction} by {points:.0} {unit} ({interval}).\n")
        } else {
            let sure = 100.0 * probability;
            if points.round() == 0.0 {
                return format!(
                    "These shots do not show that the chance of a shot changed ({interval}).\n"
                ) + &values_in_words(changes, tested);
            }
            format!(
                "These shots do not show that the chance of a shot changed. The best estimate is that it \
                 {direction} by {points:.0} {unit} ({interval}); the chance that it {direction} at all is {sure:.0} %.\n"
            )
        };
        if p.is_at_the_limit(tested) {
            text += "That is at the limit of the 95 % level: other draws (--seed) can turn it.\n";
        }
    }
    text + &values_in_words(changes, tested)
}

/// Which of the other values changed.
fn values_in_words(changes: &[SessionChange], tested: usize) -> String {
    let others = changes.iter().filter(|change| change.name != "P");
    let in_words = |change: &&SessionChange| {
        let by = change.comparison.change.scaled(1.0 / change.size);
        let (direction, _) = change.direction();
        let decimals = change.decimals();
        let amount = format!("{:.decimals$} {}", by.mean.abs(), change.unit);
        let amount = amount.trim_end();
        match change.name.as_str() {
            "polar_mean" => format!("the aim moved {amount} to the {direction}"),
            name => format!("{} {direction} by {amount}", quantity_in_words(name)),
        }
    };
    let decided = others.filter(|change| change.is_decided());
    let (certain, possible): (Vec<_>, Vec<_>) =
        decided.partition(|change| change.is_certain_among(tested));
    let list = |changes: &[&SessionChange]| {
        let words: Vec<String> = changes.iter().map(in_words).collect();
        words.join(", ")
    };
    if certain.is_empty() && possible.is_empty() {
        return "None of the compared values of the release changed by more than its uncertainty.\n"
            .to_owned();
    }
    let mut text = String::new();
    if !certain.is_empty() {
        text += &format!("Changed: {}.\n", list(&certain));
    }
    let at_limit: Vec<String> = certain
        .iter()
        .chain(&possible)
        .filter(|change| change.is_at_the_limit(tested))
        .map(|change| {
            let (z, _) = change.comparison.standard_errors();
            format!("{} ({z:.2})", quantity_in_words(&change.name))
        })
        .collect();
    if !possible.is_empty() {
        text += &format!(
            "May have changed: {}. ({} own 95 % interval leaves out zero. But of {} values that stay the same, one or more seem to change in {:.0} of 100 comparisons.)\n",
            list(&possible),
            if possible.len() == 1 { "Its" } else { "Their" },
            tested,
            100.0 * (1.0 - libm::pow(0.95, tested as f64))
        );
    }
    if !at_limit.is_empty() {
        text += &format!(
            "At the limit between the two: {}. {:.2} standard errors count as changed, and other draws (--seed) can turn this: report the interval, not the verdict.\n",
            at_limit.join(", "),
            quantile_among(tested)
        );
    }
    text
}

/// A value of the table in a coach's words.
fn quantity_in_words(name: &str) -> &str {
    match name {
        "speed_mean" => "the speed",
        "pitch_mean" => "the release angle",
        "backspin_mean" => "the backspin",
        "speed_sd" => "the scatter in speed",
        "pitch_sd" => "the scatter in the release angle",
        "polar_sd" => "the scatter to left and right",
        "backspin_sd" => "the scatter in backspin",
        "corr_speed_backspin" => "the correlation of speed and backspin",
        "corr_pitch_backspin" => "the correlation of angle and backspin",
        "corr_polar_backspin" => "the correlation of direction and backspin",
        "corr_speed_pitch" => "the correlation of speed and angle",
        "corr_speed_polar" => "the correlation of speed and direction",
        "corr_pitch_polar" => "the correlation of angle and direction",
        other => other,
    }
}

/// `tested` is how many values were looked at beside P.
fn line(change: &SessionChange, tested: usize) -> String {
    let (direction, probability) = change.direction();
    let comparison = &change.comparison;
    let decide = match change.decision(tested) {
        Decision::Made => "yes".to_owned(),
        Decision::Needs(shots) => two_digits(shots),
        Decision::Unknown => "-".to_owned(),
    };
    let decimals = change.decimals();
    let by = comparison.change.scaled(1.0 / change.size);
    let line = format!(
        "{:<13} {:>7.decimals$} {:>7.decimals$} {:>+7.decimals$} {:>7.decimals$} to {:>6.decimals$} {:<5} {direction:<5} {:>3} % {decide:>6}",
        change.label(),
        comparison.before.mean / change.size,
        comparison.after.mean / change.size,
        by.mean,
        by.low,
        by.high,
        change.unit,
        at_most_two_digits(100.0 * probability),
    );
    format!("{}\n", line.trim_end())
}

/// A percentage, `>99` where it would be rounded to 100.
fn at_most_two_digits(percent: f64) -> String {
    if percent >= 99.5 {
        ">99".to_owned()
    } else {
        format!("{percent:.0}")
    }
}

/// A number of shots with two digits: it is as noisy as the change that it rests on.
pub fn two_digits(shots: f64) -> String {
    let unit = libm::exp10(libm::floor(libm::log10(shots.max(1.0))) - 1.0).max(1.0);
    format!("{:.0}", (shots / unit).ceil() * unit)
}
