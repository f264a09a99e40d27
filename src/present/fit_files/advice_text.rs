//! The answer of `advise` in text.

use super::change_in_words::{ChangeWords, first_change_in_words, landing_in_words};
use super::fit_note_text::{WHAT_TO_CHECK, contradiction};
use crate::best_shot::{BestShot, Limit};
use crate::fitting::{
    Advice, AdviceStep, AdviceSteps, Cause, Contradiction, Interval, Landing, Place, SpinSource,
    Support, TrainingGain, Values, landing_of, values_of,
};
use crate::present::layout::{Side, TextAnswer, TextTable, paragraph, paragraphs};
use crate::present::words::{
    capitalised, difference_interval, difference_per_100, interval_of_100, likely, of_100, per_100,
    simulation_error, subject,
};
use crate::shooter::{Profile, ShotKind};
use crate::store::parameters::value_units;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// From this probability on the data support that one kind of shot is better.
const SUPPORTED: f64 = 0.9;
/// A difference of less than this decides nothing.
const WORTH_IT: f64 = 0.01;

/// How many more shots would support a step, if its gain is what it seems to be.
pub(super) fn more_shots(advice: &Advice) -> Option<f64> {
    /// More than this many times the shots is no plan.
    const MOST_TIMES: f64 = 10.0;
    let steps = advice.steps.iter().flat_map(|steps| &steps.steps);
    let after = steps.filter_map(|step| step.sure_after(advice.shots));
    let more = after.fold(f64::INFINITY, f64::min) - advice.shots as f64;
    let is_plan = more > 0.0 && more < MOST_TIMES * advice.shots as f64;
    is_plan.then(|| libm::ceil(more / 10.0) * 10.0)
}

/// The changes at the limit of what the shots support, with what they add.
pub(super) fn at_the_limit(words: &ChangeWords, advice: &Advice) -> Vec<String> {
    let Some(steps) = &advice.steps else {
        return Vec::new();
    };
    let mut from = advice.usual;
    let mut changes = Vec::new();
    // A suggested angle comes with a speed of its own.
    let mut all = steps.steps.iter();
    let has_angle = all.any(|step| step.cause == Cause::PITCH && step.is_sure());
    for step in &steps.steps {
        let is_named = has_angle && step.cause == Cause::SPEED;
        if step.support == Support::AtTheLimit && !is_named {
            let change = words.of_step(step, &from);
            changes.push(format!("{change} ({})", difference_per_100(step.gain.mean)));
        } else if step.is_sure() {
            from = step.release;
        }
    }
    changes
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

/// What a shooter scatters in.
pub(super) fn scatter_in_words(cause: Cause) -> &'static str {
    ["speed", "angle", "direction", "backspin"][cause.0]
}

/// The advice for a player at a place.
#[derive(Clone, Copy, Debug)]
pub struct PlayerAdvice<'a> {
    /// The player's profile at the place.
    pub profile: &'a Profile,
    /// The advice.
    pub advice: &'a Advice,
    /// Makes and shots with a result.
    pub observed: (usize, usize),
    /// How the makes contradict the measured shots.
    pub doubt: Option<Contradiction>,
    /// The units of the text.
    pub units: UnitSystem,
}

impl PlayerAdvice<'_> {
    fn words(&self) -> ChangeWords {
        ChangeWords {
            units: self.units,
            court_angle_rad: self.profile.location().angle_rad,
        }
    }

    /// The whole answer.
    #[must_use]
    pub fn text(&self) -> TextAnswer {
        if self.doubt.is_some() {
            return TextAnswer {
                answer: self.answer(),
                subject: subject(self.profile, self.units),
                ..TextAnswer::default()
            };
        }
        let mut notes: Vec<String> = self.kind_in_words().into_iter().collect();
        notes.extend(self.not_suggested());
        notes.extend(self.spin_in_words());
        notes.push(
            "The intervals leave out what another board, ball or air would change (`bankshot physics`).".to_owned(),
        );
        TextAnswer {
            answer: self.answer(),
            subject: subject(self.profile, self.units),
            table: Some(self.table()),
            notes,
            details: self.details(),
            ..TextAnswer::default()
        }
    }

    /// What to tell the player.
    #[must_use]
    pub fn brief(&self) -> String {
        let mut sentences = self.answer();
        if self.doubt.is_none() {
            sentences.extend(self.spin_at_limit());
            sentences.extend(self.kind_in_words());
        }
        paragraphs(&sentences)
    }

    /// The advice without the kind of shot that is not suggested.
    #[must_use]
    pub fn for_player(&self) -> String {
        match self.doubt.is_none() && self.other_kind().is_none() {
            true => {
                let mut sentences = self.answer();
                sentences.extend(self.spin_at_limit());
                paragraphs(&sentences)
            }
            false => self.brief(),
        }
    }

    /// How many of 100 go in now, with the interval.
    #[must_use]
    pub fn now(&self) -> String {
        let p = &self.advice.usual_probability;
        format!(
            "{} of 100 ({})",
            of_100(p.mean),
            interval_of_100(p.low, p.high)
        )
    }

    /// What the supported change gains, as a probability; 0 where none is supported.
    #[must_use]
    pub fn supported_gain(&self) -> f64 {
        let steps = self.supported().filter(|_| self.doubt.is_none());
        steps.map_or(0.0, |steps| steps.gain.mean)
    }

    /// The other kind of shot, where it is clearly better: what it makes.
    #[must_use]
    pub fn better_kind(&self) -> Option<String> {
        self.other_kind().filter(|_| self.doubt.is_none())?;
        self.kind_in_words()
    }

    /// What to change, what that adds, what to change first, how the ball comes down, and what to
    /// train.
    fn answer(&self) -> Vec<String> {
        if let Some(doubt) = &self.doubt {
            return vec![
                format!("No advice yet: {}.", contradiction(doubt)),
                WHAT_TO_CHECK.to_owned(),
            ];
        }
        let mut answer = self.release();
        answer.extend(self.training());
        answer
    }

    /// Whether and how to change the release.
    fn release(&self) -> Vec<String> {
        let (advice, p) = (self.advice, &self.advice.usual_probability);
        let now = format!(
            "Now {} of 100 go in (95 % interval {}).",
            of_100(p.mean),
            interval_of_100(p.low, p.high)
        );
        if let Some(steps) = self.supported() {
            let changes = self.words().of_releases(&advice.usual, &steps.advised);
            let gain = &steps.gain;
            let mut sentences = vec![
                format!(
                    "{}: {} of 100 instead of {}.",
                    capitalised(&changes),
                    of_100(p.mean + gain.mean),
                    of_100(p.mean)
                ),
                format!(
                    "Gain: {} per 100 (95 % interval {} to {}), with the same scatter.",
                    per_100(gain.mean),
                    per_100(gain.low),
                    per_100(gain.high)
                ),
            ];
            sentences.extend(landing_in_words(advice, self.units));
            sentences.extend(first_change_in_words(advice, steps));
            return sentences;
        }
        let more = more_shots(advice).map_or_else(String::new, |more| {
            format!(" About {more:.0} more shots could settle it.")
        });
        let why = match &advice.gain {
            Some(gain) if gain.low > 0.0 && gain.mean > 0.005 => format!(
                "Keep your release for now: another one adds {} per 100 (95 % interval {}), but the data support no single step.{more}",
                per_100(gain.mean),
                difference_interval(gain.low, gain.high)
            ),
            Some(gain) if gain.mean > 0.005 => format!(
                "Keep your release for now: another one may add {} per 100, but that may be luck.{more}",
                per_100(gain.mean)
            ),
            Some(_) => "Keep your release: no other one is worth a change.".to_owned(),
            None => "No exact shot of this kind goes in from here.".to_owned(),
        };
        vec![why, now]
    }

    /// The steps, if one of them is supported.
    fn supported(&self) -> Option<&AdviceSteps> {
        let steps = self.advice.steps.as_ref()?;
        steps.steps.iter().any(AdviceStep::is_sure).then_some(steps)
    }

    /// What to train: the scatter that costs most, and what costs about as much.
    pub(super) fn training(&self) -> Option<String> {
        let as_good = most_worth_training(&self.advice.training);
        let (first, others) = as_good.split_first()?;
        let start = match self.supported() {
            Some(_) => "Then train",
            None => "Train",
        };
        let gain = |of: &TrainingGain| per_100(of.gain.mean);
        Some(match others {
            [] => format!(
                "{start} the {}: 10 % less scatter there adds {} per 100 (95 % interval {} to {}).",
                scatter_in_words(first.cause),
                gain(first),
                per_100(first.gain.low),
                per_100(first.gain.high)
            ),
            others => {
                let names: Vec<&str> = as_good
                    .iter()
                    .map(|of| scatter_in_words(of.cause))
                    .collect();
                let gains: Vec<String> = std::iter::once(first)
                    .chain(others)
                    .map(|of| gain(of))
                    .collect();
                format!(
                    "{start} the {}: 10 % less scatter in one adds {} per 100.",
                    names.join(" or the "),
                    gains.join(" or ")
                )
            }
        })
    }

    /// The other kind of shot, where the data support that it is better and by a shot in 100: its
    /// probability of being better.
    fn other_kind(&self) -> Option<f64> {
        let kinds = self.advice.kinds.as_ref()?;
        let (better, gain) = match self.advice.kind {
            ShotKind::Direct => (kinds.bank_is_better, kinds.difference.mean),
            ShotKind::Bank => (1.0 - kinds.bank_is_better, -kinds.difference.mean),
        };
        (better >= SUPPORTED && gain >= WORTH_IT).then_some(better)
    }

    /// Bank or direct.
    fn kind_in_words(&self) -> Option<String> {
        let kinds = self.advice.kinds.as_ref()?;
        let [direct, bank] = kinds.probabilities.map(|p| of_100(p.mean));
        let (own, other) = match self.advice.kind {
            ShotKind::Direct => (direct, bank),
            ShotKind::Bank => (bank, direct),
        };
        let [own_name, other_name] =
            [self.advice.kind, self.advice.kind.other()].map(ShotKind::name);
        let own_is_better = match self.advice.kind {
            ShotKind::Direct => 1.0 - kinds.bank_is_better,
            ShotKind::Bank => kinds.bank_is_better,
        };
        Some(match self.other_kind() {
            Some(better) => format!(
                "{} instead: the best {other_name} shot makes {other}, the best {own_name} shot {own} (probability that {other_name} is better: {}).",
                match self.advice.kind {
                    ShotKind::Direct => "Bank it",
                    ShotKind::Bank => "Shoot direct",
                },
                likely(better)
            ),
            None if own_is_better >= SUPPORTED => format!(
                "{}, not {other_name}: the best {other_name} shot makes {other}.",
                capitalised(own_name)
            ),
            None => format!(
                "Bank or direct is not clear yet: the best {own_name} shot makes {own}, the best {other_name} shot {other} (probability that {own_name} is better: {}).",
                likely(own_is_better)
            ),
        })
    }

    /// The step that is nearest to being supported, and those at the limit.
    fn not_suggested(&self) -> Vec<String> {
        let words = self.words();
        let limit = at_the_limit(&words, self.advice);
        let mut notes = Vec::new();
        if !limit.is_empty() {
            notes.push(format!(
                "Not certain yet (makes per 100 in brackets): {}.",
                limit.join("; ")
            ));
        }
        let mut from = self.advice.usual;
        let steps = self.advice.steps.iter().flat_map(|steps| &steps.steps);
        let mut open = Vec::new();
        for step in steps {
            if step.is_sure() {
                from = step.release;
            } else if step.support != Support::AtTheLimit && step.gain.mean >= 0.005 {
                open.push(format!(
                    "{}, {} ({})",
                    words.of_step(step, &from),
                    difference_per_100(step.gain.mean),
                    difference_interval(step.gain.low, step.gain.high)
                ));
            }
        }
        if !open.is_empty() {
            notes.push(format!("Not suggested, may be luck: {}.", open.join("; ")));
        }
        notes
    }

    /// What is assumed of the backspin.
    fn spin_in_words(&self) -> Option<String> {
        let advice = self.advice;
        let spin = advice.usual[3] / value_units(self.units)[3].1;
        (advice.spin != SpinSource::Measured).then(|| {
            format!(
                "Backspin was not measured: {spin:.1} rev/s is {} and kept.",
                advice.spin.name()
            )
        })
    }

    /// That a suggested backspin is the most that the profile allows.
    fn spin_at_limit(&self) -> Option<String> {
        let changes = self.advice.steps.as_ref()?.is_changed[Cause::BACKSPIN.0];
        (changes && uses_all_backspin(self.advice))
            .then(|| "That backspin is max_backspin in the profile, which is assumed.".to_owned())
    }

    /// The current, the suggested and the best shot: where the ball comes down, then the release.
    fn table(&self) -> TextTable {
        let (long, metre) = self.units.length();
        let (short, _) = self.units.short_length();
        let speed_unit = format!("{long}/s");
        let mut table = TextTable::new(&[
            ("", "", Side::Left),
            ("entry", "deg", Side::Right),
            ("depth", short, Side::Right),
            ("left/right", short, Side::Left),
            ("speed", &speed_unit, Side::Right),
            ("angle", "deg", Side::Right),
            ("makes", "per 100", Side::Right),
            ("95 %", "interval", Side::Left),
        ]);
        let advice = self.advice;
        let mut add = |name: String, release: &Values, p: &Interval| {
            let landing = self.landing(release);
            let [entry, depth, side] = self.landing_cells(landing.as_ref());
            table.add([
                name,
                entry,
                depth,
                side,
                format!("{:.2}", release[0] / metre),
                format!("{:.1}", release[1] / DEGREE_RAD),
                per_100(p.mean),
                format!("{} to {}", per_100(p.low), per_100(p.high)),
            ]);
        };
        add(
            "current".to_owned(),
            &advice.usual,
            &advice.usual_probability,
        );
        if let Some(steps) = self.supported() {
            add(
                "suggested".to_owned(),
                &steps.advised,
                &advice.advised_probability,
            );
        }
        if let Some((best, p)) = advice.best.as_ref().zip(advice.best_probability) {
            let name = format!("best {}", advice.kind.name());
            add(name, &values_of(&best.nominal), &p);
        }
        table
    }

    /// Where a direct shot comes down.
    fn landing(&self, release: &Values) -> Option<Landing> {
        let is_direct = self.advice.kind == ShotKind::Direct;
        let place = Place {
            location: self.profile.location(),
            release_height_m: self.profile.shooter().release_height_m,
        };
        is_direct
            .then(|| landing_of(self.profile.simulator(), &place, release))
            .flatten()
    }

    fn landing_cells(&self, landing: Option<&Landing>) -> [String; 3] {
        let (_, size) = self.units.short_length();
        let Some(landing) = landing else {
            return ["-", "-", "-"].map(str::to_owned);
        };
        let right = landing.right_m / size;
        let side = match right.abs() < 0.05 {
            true => "centre".to_owned(),
            false if right < 0.0 => format!("{:.1} left", -right),
            false => format!("{right:.1} right"),
        };
        [
            format!("{:.1}", landing.entry_angle_rad / DEGREE_RAD),
            format!("{:.1}", landing.depth_m / size),
            side,
        ]
    }

    fn details(&self) -> String {
        let advice = self.advice;
        let mut text = self.steps();
        let shot = match self.supported() {
            Some(_) => "suggested",
            None => "current",
        };
        text += &format!("10 % less scatter, at the {shot} shot\n");
        for training in &advice.training {
            text += &format!(
                "  {:<12} {} ({})\n",
                scatter_in_words(training.cause),
                difference_per_100(training.gain.mean),
                difference_interval(training.gain.low, training.gain.high)
            );
        }
        if let Some(kinds) = &advice.kinds {
            let [direct, bank] = kinds.probabilities;
            text += &paragraph(&format!(
                "Bank less direct: {} ({}); best bank shot {}, best direct shot {}; probability that bank is better {}.",
                difference_per_100(kinds.difference.mean),
                difference_interval(kinds.difference.low, kinds.difference.high),
                per_100(bank.mean),
                per_100(direct.mean),
                likely(kinds.bank_is_better)
            ));
        }
        if let Some(gain) = &advice.gain {
            text += &paragraph(&format!(
                "Best {} shot less current shot: {} ({}); probability that the best one is better {}.",
                advice.kind.name(),
                difference_per_100(gain.mean),
                difference_interval(gain.low, gain.high),
                likely(advice.gain_is_positive)
            ));
        }
        let (made, shots) = self.observed;
        if shots > 0 {
            text += &format!("Counted: {made} of {shots} went in.\n");
        }
        let words = self.words();
        text += &words.release("current", &advice.usual);
        if let Some(steps) = &advice.steps {
            text += &words.release("suggested", &steps.advised);
        }
        if let Some(best) = &advice.best {
            text += &words.release("best", &values_of(&best.nominal));
        }
        if uses_all_backspin(advice) {
            let spin = self.profile.shooter().max_backspin_rad_s / REV_RAD;
            text += &format!("The best shot has max_backspin ({spin:.1} rev/s, assumed).\n");
        }
        text += "current: as measured. suggested: only the changes the data support. best: the\noptimum for this kind of shot. depth: from the front of the ring, at rim height,\nfor an exact release (scatter in the angle makes the average shot shorter).\n";
        text + &format!(
            "Simulation error of the current shot: {} per 100.\n",
            simulation_error(advice.numerical_standard_error)
        )
    }

    /// Each step from the current to the best shot with its gain.
    fn steps(&self) -> String {
        let Some(steps) = &self.advice.steps else {
            return String::new();
        };
        let words = self.words();
        let mut text = "Step by step; each gain is on top of the supported steps above it. Brackets: not\nsuggested, because the gain is below 0.5 per 100 or could be luck.\n".to_owned();
        let mut from = self.advice.usual;
        for step in &steps.steps {
            let mut what = words.of_step(step, &from);
            if step.is_sure() {
                from = step.release;
            } else {
                what = format!("({what})");
            }
            text += &format!(
                "  {what:<44} {} ({})\n",
                difference_per_100(step.gain.mean),
                difference_interval(step.gain.low, step.gain.high)
            );
        }
        text
    }
}

/// Whether the best shot uses all the backspin that is allowed.
fn uses_all_backspin(advice: &Advice) -> bool {
    let is_at_limit = |best: &BestShot| best.at_limits.contains(&Limit::MaxBackspin);
    advice.best.as_ref().is_some_and(is_at_limit)
}
