//! What the search for the best shot looks at, and how precisely.

use super::invalid_setting::SettingChecks;
use super::nominal::NominalOverrides;
use super::release_errors::MAX_SPEED_M_S;
use super::release_variable::NominalVariable;
use crate::units::{DEGREE_RAD, FOOT_M};
use serde::{Serialize, Serializer};
use std::ops::RangeInclusive;

/// Pitch angles that can be searched, rad.
const PITCH_RANGE_RAD: RangeInclusive<f64> = DEGREE_RAD..=89.0 * DEGREE_RAD;
/// Points of a table along one axis.
const TABLE_POINTS: RangeInclusive<usize> = 2..=100_000;

/// Points along each axis of the table about a best shot. The table of the search, which only has
/// to find where to look, has two thirds of them along speed, pitch and polar angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct TableGrid {
    /// Speeds on each line.
    pub speed: usize,
    /// Pitch angles.
    pub pitch: usize,
    /// Polar angles.
    pub polar: usize,
    /// Backspins.
    pub backspin: usize,
}

impl TableGrid {
    /// Number of points.
    #[must_use]
    pub fn points(self) -> u64 {
        self.speed as u64 * self.pitch as u64 * self.polar as u64 * self.backspin as u64
    }

    /// The grid of the search's table.
    #[must_use]
    pub fn of_search(self) -> Self {
        let fewer = |points: usize| (2 * points).div_ceil(3).max(1);
        Self {
            speed: fewer(self.speed),
            pitch: fewer(self.pitch),
            polar: fewer(self.polar),
            backspin: self.backspin,
        }
    }

    pub(super) fn check(&self, checks: &mut SettingChecks) {
        for (key, points) in [
            ("grid.speed", self.speed),
            ("grid.pitch", self.pitch),
            ("grid.polar", self.polar),
            ("grid.backspin", self.backspin),
        ] {
            let (low, high) = (TABLE_POINTS.start(), TABLE_POINTS.end());
            let allowed = format!("a whole number from {low} to {high}");
            checks.require(key, TABLE_POINTS.contains(&points), &allowed);
        }
    }
}

impl Default for TableGrid {
    fn default() -> Self {
        Self {
            speed: 56,
            pitch: 36,
            polar: 36,
            backspin: 12,
        }
    }
}

/// The variables of a nominal shot that the search chooses. The others are fixed by the profile's
/// `[nominal]` table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SearchChoice {
    chosen: [bool; NominalVariable::SEARCHABLE.len()],
}

impl SearchChoice {
    /// Only the given variables. Rifle spin cannot be searched and is ignored.
    #[must_use]
    pub fn only(variables: &[NominalVariable]) -> Self {
        Self {
            chosen: NominalVariable::SEARCHABLE.map(|variable| variables.contains(&variable)),
        }
    }

    /// Whether the search chooses a variable.
    #[must_use]
    pub fn includes(&self, variable: NominalVariable) -> bool {
        NominalVariable::SEARCHABLE
            .iter()
            .zip(self.chosen)
            .any(|(&searchable, chosen)| searchable == variable && chosen)
    }

    /// The chosen variables in the order of [`NominalVariable::SEARCHABLE`].
    pub fn iter(&self) -> impl Iterator<Item = NominalVariable> + use<> {
        let chosen = self.chosen;
        NominalVariable::SEARCHABLE
            .into_iter()
            .zip(chosen)
            .filter_map(|(variable, chosen)| chosen.then_some(variable))
    }

    fn is_empty(&self) -> bool {
        !self.chosen.contains(&true)
    }
}

impl Default for SearchChoice {
    /// All but side spin.
    fn default() -> Self {
        use NominalVariable::{Backspin, Pitch, Polar, Speed};
        Self::only(&[Speed, Pitch, Polar, Backspin])
    }
}

impl Serialize for SearchChoice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

/// The settings of the search that a profile gives. The defaults of the others depend on the
/// location.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SearchSettings {
    /// The variables that are searched.
    pub choice: SearchChoice,
    /// Smallest nominal pitch angle, rad.
    pub pitch_min_rad: Option<f64>,
    /// Largest nominal pitch angle, rad.
    pub pitch_max_rad: Option<f64>,
    /// Largest speed of a release, m/s.
    pub speed_max_m_s: Option<f64>,
    /// Wanted standard error of each probability.
    pub standard_error: Option<f64>,
    /// Sobol points of each comparison in the climb.
    pub climb_samples: Option<u32>,
    /// Seed of the Sobol scrambles.
    pub seed: Option<u64>,
}

/// The search for the best shot from one location.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Search {
    /// The variables that are searched.
    pub choice: SearchChoice,
    /// Smallest nominal pitch angle, rad. If the pitch angle is fixed, its value.
    pub pitch_min_rad: f64,
    /// Largest nominal pitch angle, rad. If the pitch angle is fixed, its value.
    pub pitch_max_rad: f64,
    /// Largest speed of a release, m/s. The default is twice the least speed to the hoop.
    pub speed_max_m_s: Option<f64>,
    /// Wanted standard error of each probability.
    pub standard_error: f64,
    /// Sobol points of each comparison in the climb. More make the choice among local optima more
    /// certain.
    pub climb_samples: u32,
    /// Seed of the Sobol scrambles.
    pub seed: u64,
}

impl Search {
    /// Default standard error of each probability.
    pub const DEFAULT_STANDARD_ERROR: f64 = 0.001;
    /// Default seed of the Sobol scrambles.
    const DEFAULT_SEED: u64 = 1;
    const DEFAULT_CLIMB_SAMPLES: u32 = 2048;

    /// The search from a location with the given settings. The default pitch angles are from 8 deg
    /// below to 14 deg above the one with the least speed to the hoop: 45 deg plus half the angle
    /// at which the hoop is seen (Brancazio 1981).
    #[must_use]
    pub fn new(
        settings: &SearchSettings,
        nominal: &NominalOverrides,
        distance_m: f64,
        height_above_hoop_m: f64,
    ) -> Self {
        let deg = DEGREE_RAD;
        let least = 45.0 * deg + 0.5 * libm::atan2(-height_above_hoop_m, distance_m);
        let low = settings
            .pitch_min_rad
            .unwrap_or((least - 8.0 * deg).clamp(deg, 80.0 * deg));
        let high = settings
            .pitch_max_rad
            .unwrap_or((least + 14.0 * deg).clamp(9.0 * deg, 85.0 * deg));
        let fixed = nominal
            .pitch_rad
            .filter(|_| !settings.choice.includes(NominalVariable::Pitch));
        Self {
            choice: settings.choice,
            pitch_min_rad: fixed.unwrap_or(low),
            pitch_max_rad: fixed.unwrap_or(high),
            speed_max_m_s: settings.speed_max_m_s,
            standard_error: settings
                .standard_error
                .unwrap_or(Self::DEFAULT_STANDARD_ERROR),
            climb_samples: settings
                .climb_samples
                .unwrap_or(Self::DEFAULT_CLIMB_SAMPLES),
            seed: settings.seed.unwrap_or(Self::DEFAULT_SEED),
        }
    }
}

impl SearchSettings {
    /// Wanted standard error of each probability.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        self.standard_error
            .unwrap_or(Search::DEFAULT_STANDARD_ERROR)
    }

    /// Seed of the Sobol scrambles.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed.unwrap_or(Search::DEFAULT_SEED)
    }

    /// How a speed breaks the limit that is set, such as `is more than search.speed_max (9 m/s)`;
    /// `None` if it does not.
    #[must_use]
    pub fn speed_beyond_limit(&self, speed_m_s: f64) -> Option<String> {
        let most = self.speed_max_m_s.filter(|most| speed_m_s > most + 1e-9)?;
        let round = |speed: f64| (speed * 1e4).round() / 1e4;
        Some(format!(
            "is more than search.speed_max ({} ft/s, {} m/s)",
            round(most / FOOT_M),
            round(most)
        ))
    }

    /// How a pitch angle breaks the limits that are set, such as `is more than search.pitch_max
    /// (60 deg)`; `None` if it does not.
    #[must_use]
    pub fn pitch_beyond_limits(&self, pitch_rad: f64) -> Option<String> {
        let tolerance_rad = 1e-9;
        let is_below = |limit: &f64| pitch_rad < limit - tolerance_rad;
        let is_above = |limit: &f64| pitch_rad > limit + tolerance_rad;
        let words = |word: &str, key: &str, limit_rad: f64| {
            let limit_deg = (limit_rad / DEGREE_RAD * 1e6).round() / 1e6;
            format!("is {word} than search.{key} ({limit_deg} deg)")
        };
        let low = self.pitch_min_rad.filter(is_below);
        let high = self.pitch_max_rad.filter(is_above);
        low.map(|limit| words("less", "pitch_min", limit))
            .or_else(|| high.map(|limit| words("more", "pitch_max", limit)))
    }

    pub(super) fn check(
        &self,
        checks: &mut SettingChecks,
        nominal: &NominalOverrides,
        max_side_spin_rad_s: f64,
    ) {
        for (key, value) in [
            ("search.pitch_min", self.pitch_min_rad),
            ("search.pitch_max", self.pitch_max_rad),
        ] {
            let holds = value.is_none_or(|pitch| PITCH_RANGE_RAD.contains(&pitch));
            checks.require(key, holds, "from 1 to 89 deg");
        }
        if let Some((low, high)) = self.pitch_min_rad.zip(self.pitch_max_rad) {
            let mut allowed = format!("less than pitch_max ({:.1} deg)", high / DEGREE_RAD);
            if low == high {
                allowed +=
                    "; for one fixed angle give pitch under [nominal], and leave it out of choose";
            }
            checks.require("search.pitch_min", low < high, &allowed);
        }
        checks.require(
            "search.speed_max",
            self.speed_max_m_s
                .is_none_or(|speed| speed > 0.0 && speed <= MAX_SPEED_M_S),
            "above 0 and at most 40 m/s",
        );
        checks.require(
            "search.standard_error",
            self.standard_error
                .is_none_or(|error| (1e-5..=0.1).contains(&error)),
            "from 0.00001 to 0.1",
        );
        checks.require(
            "search.climb_samples",
            self.climb_samples
                .is_none_or(|samples| (64..=65536).contains(&samples)),
            "a whole number from 64 to 65536",
        );
        self.check_choice(checks, nominal, max_side_spin_rad_s);
    }

    fn check_choice(
        &self,
        checks: &mut SettingChecks,
        nominal: &NominalOverrides,
        max_side_spin_rad_s: f64,
    ) {
        const KEY: &str = "search.choose";
        let omits = |variable| !self.choice.includes(variable);
        if self.choice.is_empty() {
            let known = NominalVariable::SEARCHABLE.map(NominalVariable::name);
            checks.refuse(
                KEY,
                format!("must name one or more of {}", known.join(", ")),
            );
            return;
        }
        if omits(NominalVariable::Speed) && nominal.speed_m_s.is_none() {
            checks.refuse(KEY, "leaves speed out, so [nominal] must give it");
        }
        let speed = nominal.speed_m_s.filter(|_| omits(NominalVariable::Speed));
        if let Some(words) = speed.and_then(|speed| self.speed_beyond_limit(speed)) {
            checks.refuse(
                "nominal.speed",
                format!("{words} (search.choose leaves speed out, so every shot has this one)"),
            );
        }
        if omits(NominalVariable::Pitch) {
            match nominal.pitch_rad {
                Some(pitch) if PITCH_RANGE_RAD.contains(&pitch) => {
                    if let Some(words) = self.pitch_beyond_limits(pitch) {
                        checks.refuse(
                            "nominal.pitch",
                            format!("{words} (search.choose leaves pitch out, so every shot has this one)"),
                        );
                    }
                }
                Some(pitch) => checks.refuse(
                    "nominal.pitch",
                    format!(
                        "{:.1} deg: must be from 1 to 89 deg (search.choose leaves pitch out, so every shot has this one)",
                        pitch / DEGREE_RAD
                    ),
                ),
                None => checks.refuse(KEY, "leaves pitch out, so [nominal] must give it"),
            }
        }
        if self.choice.includes(NominalVariable::SideSpin) && !(max_side_spin_rad_s > 0.0) {
            checks.refuse(
                KEY,
                "names side_spin, so [shooter] must give max_side_spin, above 0",
            );
        }
    }
}
