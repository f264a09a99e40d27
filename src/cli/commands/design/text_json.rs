//! What tests of each size tell, for people and for programs.

use super::against::Against;
use super::changes::{
    MOST_SHOTS, least_change, shots_for, shots_for_changes, shots_for_changes_answer,
};
use super::designed_tests::{DesignedTests, Target};
use super::options::DesignOptions;
use crate::answers::json::Provenance;
use crate::answers::sample_size::{FirstSessionAnswer, SampleSizeAnswer, SizeAnswer, TargetAnswer};
use crate::fitting::{DesignRow, TWO_SIDED_95};
use crate::present::fit_files::session_changes_text::two_digits;
use crate::shooter::ShotKind;
use crate::units::{DEGREE_RAD, UnitSystem};

/// Simulated tests of each size: `48`, or `48 (12 of 970 shots)` where large sizes have fewer.
fn repetitions_in_words(rows: &[DesignRow], usual: u64) -> String {
    let fewer = rows.iter().filter(|row| row.repetitions != usual);
    let fewer: Vec<String> = fewer
        .map(|row| format!("{} of {} shots", row.repetitions, row.shots))
        .collect();
    match fewer.is_empty() {
        true => usual.to_string(),
        false => format!("{usual} ({})", fewer.join(", ")),
    }
}

impl DesignedTests {
    /// For people.
    pub(super) fn text(&self, options: &DesignOptions) -> String {
        let first = self.first.as_ref();
        let repetitions = repetitions_in_words(&self.rows, options.repetitions);
        let mut text = self.shot_in_words(&repetitions) + &self.table();
        if let Some(shots) = self.checked {
            text += &format!(
                "\nThe row of {shots} shots is there because --change asks about tests as large as that.\n"
            );
        }
        let changes = shots_for_changes(&self.rows, first, &options.change);
        text += &format!("\n{changes}\n");
        if let Some(against) = &self.against {
            text += &format!("\n{}", against.text(first));
        }
        if let Some(target) = &self.target {
            text += &self.target_in_words(target);
        }
        text + &self.errors_in_words(&repetitions)
    }

    /// What is tested.
    fn shot_in_words(&self, repetitions: &str) -> String {
        let (long, metre) = self.units.length();
        let (profile, nominal) = (&self.shot.profile, &self.shot.nominal);
        format!(
            "{}: tests of the {} shot at {:.2} {long}/s and {:.1} deg, {}, which makes {:.1} of 100; with {} ({}), {repetitions} simulated tests of each size; all errors are one standard deviation (a 95 % interval reaches twice as far to each side)\n\n",
            profile.shooter().name,
            ShotKind::of(profile, nominal).name(),
            nominal.speed_m_s / metre,
            nominal.pitch_rad / DEGREE_RAD,
            profile.location().in_words(self.units),
            100.0 * self.shot.probability,
            self.tracker.name.0,
            self.tracker.name.1,
        )
    }

    /// A row for each size.
    fn table(&self) -> String {
        let mut text = format!(
            "{:>6}  {:^29}  {:^24}  {:>14}\n{:>6} {:>9} {:>9} {:>9}  {:>11} {:>12}  {:>14}\n",
            "",
            "scatter is known to",
            "P is known to (points)",
            "P changed by",
            "shots",
            "speed",
            "pitch",
            "polar",
            "by the fit",
            "by counting",
            "shows (points)"
        );
        for row in &self.rows {
            let [speed, pitch, polar] = row.sd_errors.map(|error| 100.0 * error);
            text += &format!(
                "{:>6} {:>7.1} % {:>7.1} % {:>7.1} %  {:>11.1} {:>12.1}  {:>14.1}\n",
                row.shots,
                speed,
                pitch,
                polar,
                100.0 * row.probability_error,
                100.0 * row.counting_error,
                100.0 * least_change(row, self.first.as_ref())
            );
        }
        text
    }

    /// How many shots make P known as well as it is wanted.
    fn target_in_words(&self, target: &Target) -> String {
        let &Target { points, shots, .. } = target;
        let in_words = |shots: usize| match shots {
            MOST_SHOTS.. => format!("More than {MOST_SHOTS}"),
            shots => format!("About {}", two_digits(shots as f64)),
        };
        let mut text = match target.is_added {
            true => format!("\nThe row of {shots} shots checks what --target asks.\n"),
            false => String::new(),
        };
        let of_interval = shots_for(&self.rows, points / 100.0 / TWO_SIDED_95);
        // First the interval that `fit` prints.
        text += &format!(
            "\n{} shots in all make the 95 % interval of P reach {points} points to each side; {} make its standard deviation {points} points.\n",
            in_words(of_interval),
            in_words(shots).to_lowercase()
        );
        if let Some(first) = &self.first
            && of_interval > first.shots
            && of_interval < MOST_SHOTS
        {
            text += &format!(
                "Together with the {} shots of the first session that is about {} more.\n",
                first.shots,
                two_digits((of_interval - first.shots) as f64)
            );
        }
        text
    }

    /// How far these numbers are known, and the tracker's errors.
    fn errors_in_words(&self, repetitions: &str) -> String {
        let (long, metre) = self.units.length();
        let of_errors = self.rows.iter().map(|row| row.simulation_error);
        let of_error = of_errors.fold(0.0, f64::max);
        let sd = |i: usize, size: f64| self.noise[(i, i)].max(0.0).sqrt() / size;
        let decimals = if self.units == UnitSystem::Metric {
            3
        } else {
            2
        };
        format!(
            "\nWith {repetitions} simulated tests the errors of P are known to {:.0} %, the numbers of shots to {:.0} % (one standard deviation; --repetitions).\nAt this shot the tracker errs by {:.decimals$} {long}/s, {:.2} deg up and {:.2} deg sideways. The physics is taken as known: more shots do not tell it, and `bankshot physics` says what rests on it.\n",
            100.0 * of_error,
            200.0 * of_error,
            sd(0, metre),
            sd(1, DEGREE_RAD),
            sd(2, DEGREE_RAD),
        )
    }

    /// For programs.
    pub(super) fn answer(&self, changes: &[f64]) -> SampleSizeAnswer {
        let first = self.first.as_ref();
        let tests = self.rows.iter().map(|row| {
            let [speed, pitch, polar] = row.sd_errors;
            SizeAnswer {
                shots: row.shots,
                repetitions: row.repetitions,
                speed_sd_relative_error: speed,
                pitch_sd_relative_error: pitch,
                polar_sd_relative_error: polar,
                probability_error: row.probability_error,
                simulation_error: row.simulation_error,
                counting_error: row.counting_error,
                least_change_of_probability: least_change(row, first),
            }
        });
        SampleSizeAnswer {
            shooter: self.shot.profile.shooter().name.clone(),
            probability: self.shot.probability,
            tracker: self.tracker.name.0.clone(),
            tracker_noise: self.tracker.name.1.clone(),
            changes: shots_for_changes_answer(&self.rows, first, changes),
            first_session: first.map(|first| FirstSessionAnswer {
                shots: first.shots,
                probability_error: first.p.error(),
                sd_relative_error: first.scatter.error(),
            }),
            tests: tests.collect(),
            target: self.target.as_ref().map(|target| TargetAnswer {
                probability_error: target.points / 100.0,
                shots: target.shots,
            }),
            against: self.against.as_ref().map(Against::answer),
            provenance: Provenance::of(&self.shot.profile),
        }
    }
}
