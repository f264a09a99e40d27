//! What tests of each size tell, for people and for programs.

use super::against::Against;
use super::changes::{
    MOST_SHOTS, in_words, least_change, shots_for, shots_for_changes_answer, shots_in_each,
    shots_to_show,
};
use super::designed_tests::{DesignedTests, Target};
use super::options::SampleSizeOptions;
use crate::answers::json::Provenance;
use crate::answers::sample_size::{FirstSessionAnswer, SampleSizeAnswer, SizeAnswer, TargetAnswer};
use crate::fitting::TWO_SIDED_95;
use crate::present::fit_files::session_changes_text::two_digits;
use crate::present::layout::{Side, TextAnswer, TextTable, paragraph};
use crate::present::words::of_100;
use crate::shooter::ShotKind;
use crate::units::{DEGREE_RAD, UnitSystem};

/// Half the width of a 95 % interval per 100, from a standard deviation.
fn half_width(probability_error: f64) -> f64 {
    100.0 * TWO_SIDED_95 * probability_error
}

/// A width with a decimal where it is small.
fn width_text(width: f64) -> String {
    match width < 9.5 {
        true => format!("{width:.1}"),
        false => format!("{width:.0}"),
    }
}

impl DesignedTests {
    /// For people.
    pub(super) fn text(&self, options: &SampleSizeOptions) -> TextAnswer {
        let mut notes = shots_to_show(&self.rows, self.first.as_ref(), &options.change);
        notes.extend(
            self.against
                .iter()
                .flat_map(|against| against.notes(self.first.as_ref())),
        );
        if let Some(shots) = self.checked {
            notes.push(format!(
                "The row of {shots} shots was added because the smallest change asked about needs about that many."
            ));
        }
        notes.extend(
            self.target
                .as_ref()
                .map(|target| self.target_in_words(target))
                .into_iter()
                .flatten(),
        );
        notes.push("A player also differs from day to day; that is not included.".to_owned());
        TextAnswer {
            answer: self.sentences(options),
            subject: self.subject(),
            table: Some(self.table()),
            notes,
            details: self.details(options),
            ..TextAnswer::default()
        }
    }

    /// What a session of about a hundred shots shows.
    fn sentences(&self, options: &SampleSizeOptions) -> Vec<String> {
        let nearest = self.rows.iter().min_by_key(|row| row.shots.abs_diff(100));
        let Some(row) = nearest else {
            return Vec::new();
        };
        let mut answer = vec![format!(
            "Measuring {} shots gives the makes per 100 to within {}; only counting them, to within {}.",
            row.shots,
            width_text(half_width(row.probability_error)),
            width_text(half_width(row.counting_error))
        )];
        let middle = options.change.get(options.change.len() / 2);
        answer.extend(middle.map(|points| {
            let shots = in_words(Some(shots_in_each(&self.rows, points / 100.0)));
            format!("To show a change of {points} per 100 you need {shots} shots before and as many after.")
        }));
        answer
    }

    /// What is tested.
    fn subject(&self) -> String {
        let (long, metre) = self.units.length();
        let (profile, nominal) = (&self.shot.profile, &self.shot.nominal);
        format!(
            "{}: {}, {} shot at {:.2} {long}/s and {:.1} deg, {} of 100 go in. Tracker: {} ({}).",
            profile.shooter().name,
            profile.location().in_words(self.units),
            ShotKind::of(profile, nominal).name(),
            nominal.speed_m_s / metre,
            nominal.pitch_rad / DEGREE_RAD,
            of_100(self.shot.probability),
            self.tracker.name.0,
            self.tracker.name.1,
        )
    }

    /// A row for each size.
    fn table(&self) -> TextTable {
        let mut table = TextTable::new(&[
            ("shots", "", Side::Right),
            ("makes per 100", "+/- (95 %)", Side::Right),
            ("by counting alone", "+/- (95 %)", Side::Right),
            ("smallest change shown", "(power 80 %)", Side::Right),
        ]);
        for row in &self.rows {
            table.add([
                row.shots.to_string(),
                width_text(half_width(row.probability_error)),
                width_text(half_width(row.counting_error)),
                width_text(100.0 * least_change(row, self.first.as_ref())),
            ]);
        }
        table
    }

    /// How many shots make P known as well as it is wanted.
    fn target_in_words(&self, target: &Target) -> Vec<String> {
        let &Target { points, .. } = target;
        let in_words = |shots: usize| match shots {
            MOST_SHOTS.. => format!("more than {MOST_SHOTS}"),
            shots => format!("about {}", two_digits(shots as f64)),
        };
        let of_interval = shots_for(&self.rows, points / 100.0 / TWO_SIDED_95);
        let mut notes = vec![format!(
            "A 95 % interval of +/- {points} needs {} shots in all.",
            in_words(of_interval)
        )];
        if let Some(first) = &self.first
            && of_interval > first.shots
            && of_interval < MOST_SHOTS
        {
            notes.push(format!(
                "Together with the {} shots of the first session that is about {} more.",
                first.shots,
                two_digits((of_interval - first.shots) as f64)
            ));
        }
        notes
    }

    fn details(&self, options: &SampleSizeOptions) -> String {
        let mut table = TextTable::new(&[
            ("shots", "", Side::Right),
            ("scatter of speed", "+/- (95 %)", Side::Right),
            ("of angle", "+/- (95 %)", Side::Right),
            ("of direction", "+/- (95 %)", Side::Right),
            ("simulated", "sessions", Side::Right),
        ]);
        for row in &self.rows {
            let [speed, pitch, polar] = row
                .sd_errors
                .map(|error| format!("{:.0} %", 100.0 * TWO_SIDED_95 * error));
            table.add([
                row.shots.to_string(),
                speed,
                pitch,
                polar,
                row.repetitions.to_string(),
            ]);
        }
        let (long, metre) = self.units.length();
        let of_errors = self.rows.iter().map(|row| row.simulation_error);
        let of_error = of_errors.fold(0.0, f64::max);
        let sd = |i: usize, size: f64| self.noise[(i, i)].max(0.0).sqrt() / size;
        let decimals = match self.units {
            UnitSystem::Metric => 3,
            UnitSystem::Imperial => 2,
        };
        let mut text = table.text();
        text += &paragraph(&format!(
            "The tracker's error for this shot: {:.decimals$} {long}/s in speed, {:.2} deg in angle, {:.2} deg in direction (standard deviations).",
            sd(0, metre),
            sd(1, DEGREE_RAD),
            sd(2, DEGREE_RAD)
        ));
        text += &paragraph(&format!(
            "With {} simulated sessions the widths are known to {:.0} %, the numbers of shots to {:.0} % (--repetitions).",
            options.repetitions,
            100.0 * of_error,
            200.0 * of_error
        ));
        text + &paragraph(
            "More shots cannot reveal the physics of your gym; see `bankshot physics`.",
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
