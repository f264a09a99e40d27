//! The simulated tests of each size, and what they are asked.

use super::against::Against;
use super::changes::{FirstSession, MOST_SHOTS, shots_for, size_to_check};
use super::options::SampleSizeOptions;
use super::tested_shot::TestedShot;
use super::tracker::TrackerOfTest;
use crate::cli::failure::{Failure, code};
use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::fitting::{Covariance, DesignRow, FitError, LEAST_TYPICAL_SHOTS, design};
use crate::units::UnitSystem;

/// Simulated tests of a size that the answer asked for, at least.
const LEAST_REPETITIONS: u64 = 12;

/// How many times as many tests of a size that is too small to be typical.
const MORE_OF_SMALL: u64 = 4;

/// The size that `--target` asks for.
pub(super) struct Target {
    /// P is to be known to so many points.
    pub(super) points: f64,
    /// The shots that do it.
    pub(super) shots: usize,
}

/// What tests of each size tell.
pub(super) struct DesignedTests {
    pub(super) shot: TestedShot,
    pub(super) tracker: TrackerOfTest,
    /// Its errors as errors of the release.
    pub(super) noise: Covariance,
    pub(super) rows: Vec<DesignRow>,
    /// The size that was added because `--change` asks about tests as large as that.
    pub(super) checked: Option<usize>,
    /// The session that a second one is compared with.
    pub(super) first: Option<FirstSession>,
    pub(super) target: Option<Target>,
    pub(super) against: Option<Against>,
    pub(super) units: UnitSystem,
}

/// Simulates tests of a shot of each size.
fn simulate_of(
    shot: &TestedShot,
    noise: &Covariance,
    sizes: &[usize],
    options: &SampleSizeOptions,
) -> Result<Vec<DesignRow>, Failure> {
    // A large test scatters less from one simulation to the next, and takes longer.
    let asked = options.shots.iter().chain(&options.first);
    let largest = u64::from(asked.copied().max().unwrap_or(0));
    let of_size = |shots: usize| match options.repetitions * largest / shots as u64 {
        _ if shots < LEAST_TYPICAL_SHOTS => MORE_OF_SMALL * options.repetitions,
        fewer if shots as u64 > largest => fewer.max(options.repetitions.min(LEAST_REPETITIONS)),
        _ => options.repetitions,
    };
    let sizes: Vec<(usize, u64)> = sizes.iter().map(|n| (*n, of_size(*n))).collect();
    let bars = ProgressBars::new();
    design(&shot.profile, &shot.nominal, noise, &sizes, &bars).map_err(|error| Failure {
        code: match error {
            FitError::NotConverged { .. } => code::IMPRECISE,
            FitError::NoScatter | FitError::NoShot { .. } => code::USAGE,
        },
        message: error.to_string(),
    })
}

impl DesignedTests {
    /// Simulates what the options ask for.
    pub(super) fn simulate(options: &SampleSizeOptions) -> Result<Self, Failure> {
        let (physics, place) = (&options.physics, options.place);
        let shot = TestedShot::read(&options.profile, physics, place, &options.nominal)?;
        let second = options
            .against
            .as_deref()
            .map(|path| TestedShot::read(path, physics, place, &NominalOptions::default()));
        let second = second.transpose()?;
        let tracker = TrackerOfTest::of(options.tracker.as_deref(), &shot)?;
        let noise = tracker.noise_at(&shot)?;
        let mut sizes: Vec<usize> = options.shots.iter().map(|n| *n as usize).collect();
        sizes.extend(options.first.map(|shots| shots as usize));
        sizes.sort_unstable();
        sizes.dedup();
        let mut rows = simulate_of(&shot, &noise, &sizes, options)?;
        let checked = size_to_check(&rows, &options.change);
        if let Some(shots) = checked {
            rows.extend(simulate_of(&shot, &noise, &[shots], options)?);
            sizes.push(shots);
        }
        // Shots that are there already were measured by the tracker of their fit.
        let first = options
            .first
            .map(|shots| FirstSession::designed(&rows, shots as usize));
        let mut tests = Self {
            first: first.or(shot.fitted.clone()),
            units: options.units.map_or(shot.units, UnitSystem::from),
            shot,
            tracker,
            noise,
            rows,
            checked,
            target: None,
            against: None,
        };
        if let Some(points) = options.target {
            tests.target = Some(tests.size_for(points, &sizes, options)?);
        }
        if let Some(second) = second {
            tests.against = Some(tests.against(&second, &sizes, options)?);
        }
        Ok(tests)
    }

    /// The size that makes P known to so many points; its row is added.
    fn size_for(
        &mut self,
        points: f64,
        sizes: &[usize],
        options: &SampleSizeOptions,
    ) -> Result<Target, Failure> {
        let shots = shots_for(&self.rows, points / 100.0);
        let is_added = (10..=MOST_SHOTS).contains(&shots) && !sizes.contains(&shots);
        if is_added {
            let row = simulate_of(&self.shot, &self.noise, &[shots], options)?;
            self.rows.extend(row);
            self.rows.sort_by_key(|row| row.shots);
        }
        Ok(Target { points, shots })
    }

    /// How many shots show how a second shooter differs.
    fn against(
        &self,
        second: &TestedShot,
        sizes: &[usize],
        options: &SampleSizeOptions,
    ) -> Result<Against, Failure> {
        let noise = self.tracker.noise_at(second)?;
        let rows = simulate_of(second, &noise, sizes, options)?;
        let own_name = &second.profile.shooter().name;
        // Two sessions of one shooter have one name.
        let is_same = self.shot.profile.shooter().name == *own_name;
        let name = match (&options.against, is_same) {
            (Some(path), true) => path.display().to_string(),
            _ => own_name.clone(),
        };
        Ok(Against::new(
            name,
            [&self.shot, second],
            [&self.rows, &rows],
            [&self.noise, &noise],
            (self.first.as_ref(), self.units),
        ))
    }
}
