//! What changed between two sessions of a shooter, as text.

use crate::answers::sessions::{Decision, SessionAnswer, SessionChange, quantile_among};
use crate::fitting::{Interval, ProbabilityChange, change_of_share};
use crate::present::layout::{Side, TextAnswer, TextTable};
use crate::present::words::{difference_interval, difference_per_100, likely, of_100, subject};
use crate::shooter::Profile;
use crate::units::with_decimals;

impl SessionChange {
    /// The value in words.
    #[must_use]
    pub fn in_words(&self) -> &str {
        quantity_in_words(&self.name)
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

/// The verdict, then a line for each value. The sessions are before and after.
#[must_use]
pub fn session_changes_text(
    profile: &Profile,
    sessions: &[SessionAnswer; 2],
    changes: &[SessionChange],
    causes: &ProbabilityChange,
) -> TextAnswer {
    let tested = changes.len() - 1;
    let text = Changes { changes, tested };
    let mut answer = text.answer();
    answer.extend(counted(sessions));
    let labelled = [("before", &sessions[0]), ("after", &sessions[1])];
    TextAnswer {
        answer,
        subject: subject(profile, profile.output().units),
        labelled: labelled
            .map(|(label, session)| (label, session_in_words(session)))
            .into(),
        table: Some(text.table()),
        notes: text.notes(),
        details: text.details(causes),
    }
}

fn session_in_words(session: &SessionAnswer) -> String {
    let made = match session.with_result {
        0 => String::new(),
        of => format!(
            ", {} of {of} went in ({:.0} %)",
            session.made,
            100.0 * session.made as f64 / of as f64
        ),
    };
    format!("{}, {} shots{made}", session.name, session.shots)
}

/// What counting alone shows.
fn counted(sessions: &[SessionAnswer; 2]) -> Option<String> {
    let [before, after] = sessions.each_ref().map(|s| (s.made, s.with_result));
    if before.1 == 0 || after.1 == 0 {
        return None;
    }
    let percent = |(made, of): (usize, usize)| 100.0 * made as f64 / of as f64;
    let change = change_of_share(before, after);
    let [by, low, high] =
        [change.share, change.low, change.high].map(|share| with_decimals(100.0 * share, 0));
    Some(format!(
        "Counting makes alone: {:.0} % before, {:.0} % after (change {by:+.0}, 95 % interval {low:+.0} to {high:+.0}).",
        percent(before),
        percent(after)
    ))
}

struct Changes<'a> {
    changes: &'a [SessionChange],
    /// How many values were compared beside P.
    tested: usize,
}

impl Changes<'_> {
    fn others(&self) -> impl Iterator<Item = &SessionChange> {
        self.changes
            .iter()
            .filter(|change| change.name != "probability")
    }

    /// What became of the makes, and which values changed.
    fn answer(&self) -> Vec<String> {
        let mut answer = Vec::new();
        if let Some(p) = self
            .changes
            .iter()
            .find(|change| change.name == "probability")
        {
            let change = p.comparison.change;
            let interval = difference_interval(change.low, change.high);
            let [before, after] =
                [&p.comparison.before, &p.comparison.after].map(|p| of_100(p.mean));
            answer.push(match p.is_decided() {
                true => format!(
                    "Changed: {before} of 100 before, {after} after (95 % interval of the change {interval})."
                ),
                false => format!(
                    "No change shown: {before} of 100 before, {after} after (95 % interval of the change {interval})."
                ),
            });
            if p.is_at_the_limit(self.tested) {
                answer.push("That is at the limit; another --seed can turn it.".to_owned());
            }
        }
        answer.extend(self.values());
        answer
    }

    /// Which values changed, or may have.
    fn values(&self) -> Vec<String> {
        let decided = self.others().filter(|change| change.is_decided());
        let (certain, possible): (Vec<_>, Vec<_>) =
            decided.partition(|change| change.is_certain_among(self.tested));
        let words = |changes: &[&SessionChange]| {
            let words = changes.iter().map(|change| change.before_and_after());
            words.collect::<Vec<_>>().join("; ")
        };
        let mut sentences = Vec::new();
        if !certain.is_empty() {
            sentences.push(format!("Changed: {}.", words(&certain)));
        }
        if !possible.is_empty() {
            sentences.push(format!("May have changed: {}.", words(&possible)));
        }
        if certain.is_empty() && possible.is_empty() {
            sentences.push(format!(
                "None of the {} values compared shows a change (correlations without one are not listed).",
                self.tested
            ));
        }
        sentences
    }

    fn verdict(&self, change: &SessionChange) -> &'static str {
        match (change.decision(self.tested), change.is_decided()) {
            (Decision::Made, _) => "changed",
            (_, true) => "may have changed",
            _ => "not shown",
        }
    }

    fn table(&self) -> TextTable {
        let mut table = TextTable::new(&[
            ("", "", Side::Left),
            ("before", "", Side::Right),
            ("after", "", Side::Right),
            ("change", "", Side::Right),
            ("95 % interval", "", Side::Left),
            ("verdict", "", Side::Left),
        ]);
        let is_shown = |change: &&SessionChange| {
            // Correlations seldom change a decision.
            !change.name.starts_with("corr_") || change.is_decided()
        };
        for change in self.changes.iter().filter(is_shown) {
            let mut cells = self.cells(change);
            cells.push(self.verdict(change).to_owned());
            table.add(cells);
        }
        table
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let decided = self.others().filter(|change| change.is_decided());
        let possible: Vec<&SessionChange> = decided
            .filter(|change| !change.is_certain_among(self.tested))
            .collect();
        if !possible.is_empty() {
            notes.push(format!(
                "With {1} values compared, {0:.0} of 100 comparisons show at least one \"may have changed\" by chance alone.",
                100.0 * (1.0 - libm::pow(0.95, self.tested as f64)),
                self.tested
            ));
        }
        let needed = possible
            .iter()
            .filter_map(|change| match change.decision(self.tested) {
                Decision::Needs(shots) => Some(format!(
                    "{} for {}",
                    two_digits(shots),
                    quantity_in_words(&change.name)
                )),
                _ => None,
            });
        let needed: Vec<String> = needed.collect();
        if !needed.is_empty() {
            notes.push(format!(
                "Shots to measure in each session to decide: {}.",
                needed.join(", ")
            ));
        }
        notes.push(
            "The intervals count form of the day: 0.3 of the scatter (assumed). Ring and sensor are taken to be the same in both sessions."
                .to_owned(),
        );
        notes
    }

    /// The cells of a change. A scatter without the row of its average names its value.
    fn cells(&self, change: &SessionChange) -> Vec<String> {
        let mut cells = change.cells();
        if let Some(value) = change.name.strip_suffix("_sd") {
            let mean = format!("{value}_mean");
            if !self.changes.iter().any(|other| other.name == mean) {
                cells[0] = format!("{} scatter", short_name(&mean));
            }
        }
        cells
    }

    fn details(&self, causes: &ProbabilityChange) -> String {
        let change = |interval: &Interval| {
            format!(
                "{} ({})",
                difference_per_100(interval.mean),
                difference_interval(interval.low, interval.high)
            )
        };
        let [first, last] = causes.by_scatter_first_and_last.each_ref().map(change);
        let [speed, pitch, polar] = causes.by_mean_alone.each_ref().map(change);
        let mut text = format!(
            "The change of makes per 100 has two parts:\n  scatter            {} ({first} with the old average release, {last} with the new one)\n  average release    {}\n    speed alone      {speed}\n    angle alone      {pitch}\n    direction alone  {polar}\n",
            change(&causes.by_scatter),
            change(&causes.by_means)
        );
        text += "The values alone do not add up, because their effects depend on each other.\n\n";
        let mut table = TextTable::new(&[
            ("all values", "", Side::Left),
            ("before", "", Side::Right),
            ("after", "", Side::Right),
            ("change", "", Side::Right),
            ("95 % interval", "", Side::Left),
            ("direction", "", Side::Left),
            ("to decide", "", Side::Right),
        ]);
        for change in self.changes {
            let (direction, probability) = change.direction();
            let mut cells = self.cells(change);
            cells.push(format!("{direction} {}", likely(probability)));
            cells.push(match change.decision(self.tested) {
                Decision::Made => "decided".to_owned(),
                Decision::Needs(shots) => two_digits(shots),
                Decision::Unknown => "-".to_owned(),
            });
            table.add(cells);
        }
        text += &table.text();
        text += "direction: probability that the true change has this sign. to decide: shots per\nsession needed to confirm a change of this size (-: smaller than its uncertainty).\n";
        for change in self.changes {
            if let Some(ratio) = &change.ratio {
                text += &format!(
                    "{}, after over before: {:.2} ({:.2} to {:.2})\n",
                    quantity_in_words(&change.name),
                    ratio.mean,
                    ratio.low,
                    ratio.high
                );
            }
            if change.name != "probability" && change.is_at_the_limit(self.tested) {
                let (z, _) = change.comparison.standard_errors();
                text += &format!(
                    "{}: at the limit ({z:.2} standard errors, {:.2} count as changed); another --seed can turn it\n",
                    quantity_in_words(&change.name),
                    quantile_among(self.tested)
                );
            }
        }
        text
    }
}

impl SessionChange {
    /// Name, before, after, change and its interval.
    fn cells(&self) -> Vec<String> {
        let comparison = &self.comparison;
        let decimals = self.decimals();
        let by = comparison.change.scaled(1.0 / self.size);
        let unit = match self.unit {
            // Those of a scatter stand in the line above.
            _ if self.name.ends_with("_sd") => String::new(),
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        let name = match self.name.as_str() {
            "probability" => "makes per 100".to_owned(),
            name => format!("{}{unit}", short_name(name)),
        };
        vec![
            name,
            format!("{:.decimals$}", comparison.before.mean / self.size + 0.0),
            format!("{:.decimals$}", comparison.after.mean / self.size + 0.0),
            format!("{:+.decimals$}", by.mean),
            format!("{:+.decimals$} to {:+.decimals$}", by.low, by.high),
        ]
    }

    /// `scatter of the angle, 1.1 to 1.5 deg`.
    fn before_and_after(&self) -> String {
        let decimals = self.decimals();
        let [before, after] = [&self.comparison.before, &self.comparison.after]
            .map(|interval| format!("{:.decimals$}", interval.mean / self.size + 0.0));
        let text = format!(
            "{} (from {before} to {after} {})",
            quantity_in_words(&self.name),
            self.unit
        );
        text.trim_end().to_owned()
    }
}

/// A value in a cell.
fn short_name(name: &str) -> &str {
    match name {
        "speed_mean" => "speed",
        "pitch_mean" => "angle",
        "polar_mean" => "direction",
        "backspin_mean" => "backspin",
        "speed_sd" => "  scatter",
        "pitch_sd" => "  scatter",
        "polar_sd" => "  scatter",
        "backspin_sd" => "  scatter",
        other => quantity_in_words(other),
    }
}

/// A value in a sentence.
fn quantity_in_words(name: &str) -> &str {
    match name {
        "probability" => "makes per 100",
        "speed_mean" => "the speed",
        "pitch_mean" => "the angle",
        "polar_mean" => "the direction",
        "backspin_mean" => "the backspin",
        "speed_sd" => "the scatter of the speed",
        "pitch_sd" => "the scatter of the angle",
        "polar_sd" => "the scatter of the direction",
        "backspin_sd" => "the scatter of the backspin",
        "corr_speed_backspin" => "correlation speed, backspin",
        "corr_pitch_backspin" => "correlation angle, backspin",
        "corr_polar_backspin" => "correlation direction, backspin",
        "corr_speed_pitch" => "correlation speed, angle",
        "corr_speed_polar" => "correlation speed, direction",
        "corr_pitch_polar" => "correlation angle, direction",
        other => other,
    }
}

/// A number of shots with two digits: it is as noisy as the change that it rests on.
pub fn two_digits(shots: f64) -> String {
    let unit = libm::exp10(libm::floor(libm::log10(shots.max(1.0))) - 1.0).max(1.0);
    format!("{:.0}", (shots / unit).ceil() * unit)
}
