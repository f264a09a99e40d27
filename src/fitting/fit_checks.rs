//! Checks of measured shots: before a fit, whether it makes sense; after it, whether the model
//! holds.

use super::fit_note::FitNote;
use super::measured_release::{MeasuredRelease, Place, VALUE_NAMES, Values, by_place};
use super::posterior::{Draw, SpinSource, Tails};
use super::session_trends::SessionTrend;
use crate::math::normal_distribution::cdf;
use crate::model::Physics;
use crate::shooter::ReleaseVariable;
use crate::units::Measure;
use nalgebra::{SMatrix, SVector};

/// Why shots cannot be fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TestError {
    /// Fewer shots than unknowns.
    #[error(
        "has {shots} usable shots{}; a fit needs at least {needed}", if *.places > 1 { format!(" from {} places", .places) } else { String::new() }
    )]
    TooFewShots {
        /// Usable shots.
        shots: usize,
        /// Places.
        places: usize,
        /// Unknowns of the model.
        unknowns: usize,
        /// Shots that are needed.
        needed: usize,
    },
    /// No row could be used.
    #[error("has no usable shots; the reasons are above")]
    NoShots,
    /// The trajectories cannot be flights measured with the tracker's noise: the ratio of the seen
    /// to the expected root mean square of their residuals.
    #[error(
        "the trajectories scatter {0:.1} times as much about the fitted flights as the tracker should: they are not flights that this tracker measured. Look at the units, the frame rate and the hoop (--frame). If these are right, its error of a position is about {0:.1} times what the tracker says: give that with --tracker FILE"
    )]
    OtherTracker(f64),
    /// A value is the same in every shot.
    #[error(
        "{0}: every shot at one place has the same value; a shooter scatters. Is it a nominal value, or rounded?"
    )]
    NoSpread(&'static str),
    /// Speeds in another unit.
    #[error(
        "speed: {given:.1} {unit} (the median) cannot be that of a shot from there, which has about {needed:.1} {unit}; the column looks like {likely}: --map 'speed=COLUMN:{suffix}'"
    )]
    WrongUnit {
        /// The median.
        given: f64,
        /// Its unit.
        unit: &'static str,
        /// A speed that reaches the hoop.
        needed: f64,
        /// What it looks like, and the suffix of that unit.
        likely: &'static str,
        /// See `likely`.
        suffix: &'static str,
    },
}

/// How far a release that the file holds beside the landings differs from the one that they give.
#[derive(Clone, Debug, PartialEq)]
pub struct ReleaseDifference {
    /// The column of the file.
    pub column: String,
    /// Index of the value: 0 is the speed, 1 the pitch.
    pub value: usize,
    /// Shots with both.
    pub shots: usize,
    /// Mean of the column less what the landings give, m/s or rad.
    pub mean: f64,
    /// Its standard error, without errors that all shots share.
    pub standard_error: f64,
}

/// Shots for each unknown.
const LEAST_SHOTS: usize = 10;
/// Flights whose residuals are so many times those of the tracker were not measured by it.
const MOST_RESIDUALS: f64 = 4.0;
/// A test warns below this p-value: one session in two hundred without reason.
pub const WARNING_LEVEL: f64 = 0.005;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    if count == 0 {
        f64::NAN
    } else {
        0.5 * (values[(count - 1) / 2] + values[count / 2])
    }
}

/// The least speed at which a ball reaches the hoop in a vacuum, m/s.
fn least_speed_m_s(physics: &Physics, place: &Place) -> f64 {
    physics.least_speed_to_hoop_m_s(place.location.distance_m, place.release_height_m)
}

/// Refuses shots that no fit can make sense of. `speed_unit` is that of the file and its size in
/// m/s.
///
/// # Errors
/// The first reason.
pub fn check_releases(
    physics: &Physics,
    places: &[Place],
    shots: &[MeasuredRelease],
    spin: SpinSource,
    speed_unit: (&'static str, f64),
) -> Result<(), TestError> {
    let values = spin.measured_values();
    let unknowns = values * places.len() + values + values * (values - 1) / 2;
    let needed = unknowns.max(LEAST_SHOTS);
    if shots.is_empty() {
        return Err(TestError::NoShots);
    }
    if shots.len() < needed {
        return Err(TestError::TooFewShots {
            shots: shots.len(),
            places: places.len(),
            unknowns,
            needed,
        });
    }
    check_speed_unit(physics, places, shots, speed_unit)?;
    for of_place in by_place(shots, places.len()) {
        for (i, name) in VALUE_NAMES.iter().enumerate().take(values) {
            let first = of_place.first().map_or(0.0, |shot| shot.values[i]);
            let mut others = of_place.iter();
            let differs = others.any(|shot| (shot.values[i] - first).abs() > 1e-9);
            if !differs && of_place.len() > 1 {
                return Err(TestError::NoSpread(name));
            }
        }
    }
    Ok(())
}

/// Refuses speeds that look like another unit. `speed_unit` is that of the file and its size in
/// m/s.
///
/// # Errors
/// The median speed at a place cannot be a shot from there.
pub fn check_speed_unit(
    physics: &Physics,
    places: &[Place],
    shots: &[MeasuredRelease],
    speed_unit: (&'static str, f64),
) -> Result<(), TestError> {
    for (place, of_place) in places.iter().zip(by_place(shots, places.len())) {
        let speed = median(of_place.iter().map(|shot| shot.values[0]).collect());
        let least = least_speed_m_s(physics, place);
        if speed < 0.9 * least || speed > 2.5 * least {
            const UNITS: [(&str, &str, f64); 4] = [
                ("m/s", "m_s", 1.0),
                ("ft/s", "ft_s", 0.3048),
                ("mph", "mph", 0.447_04),
                ("km/h", "km_h", 1.0 / 3.6),
            ];
            let (unit, size) = speed_unit;
            let typical = 1.08 * least;
            let likely = UNITS
                .iter()
                .filter(|(name, ..)| *name != unit)
                .min_by(|a, b| {
                    let miss = |(.., other): &&(&str, &str, f64)| {
                        libm::log(speed / size * other / typical).abs()
                    };
                    miss(a).total_cmp(&miss(b))
                });
            return Err(TestError::WrongUnit {
                given: speed / size,
                unit,
                needed: typical / size,
                likely: likely.map_or("another quantity", |(name, ..)| name),
                suffix: likely.map_or("UNIT", |(_, suffix, _)| suffix),
            });
        }
    }
    Ok(())
}

/// Shots that are far from the others at their place: farther than `most` robust standard
/// deviations (from the median absolute deviation) in any value.
#[must_use]
pub fn far_shots(shots: &[MeasuredRelease], places: usize, values: usize, most: f64) -> Vec<bool> {
    let mut is_far = vec![false; shots.len()];
    let mut of_places = vec![Vec::new(); places];
    for (index, shot) in shots.iter().enumerate() {
        of_places[shot.place].push(index);
    }
    for of_place in of_places {
        for k in 0..values {
            let column = |i: &usize| shots[*i].values[k];
            let centre = median(of_place.iter().map(column).collect());
            let deviations = of_place
                .iter()
                .map(|i| (column(i) - centre).abs())
                .collect();
            let sd = 1.4826 * median(deviations);
            for &i in &of_place {
                if sd > 0.0 && (shots[i].values[k] - centre).abs() > most * sd {
                    is_far[i] = true;
                }
            }
        }
    }
    is_far
}

/// Mardia's tests of normality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeTest {
    /// p-value of the skewness.
    pub skewness_p: f64,
    /// p-value of the kurtosis.
    pub kurtosis_p: f64,
    /// The kurtosis over that of a normal distribution.
    pub kurtosis_ratio: f64,
}

impl ShapeTest {
    /// Where no release was measured.
    pub(super) const NONE: Self = Self {
        skewness_p: 1.0,
        kurtosis_p: 1.0,
        kurtosis_ratio: 1.0,
    };
}

/// Mardia's tests (Biometrika 57 (1970) 519) of speed, pitch and polar angle, with the normal
/// approximations of both statistics. Each shot is taken from its own place's mean.
#[must_use]
pub fn shape_test(shots: &[MeasuredRelease], places: usize) -> ShapeTest {
    const D: f64 = 3.0;
    let count = shots.len() as f64;
    let mut means = vec![SVector::<f64, 3>::zeros(); places];
    let mut counts = vec![0.0; places];
    let value = |shot: &MeasuredRelease| SVector::<f64, 3>::from_fn(|i, _| shot.values[i]);
    for shot in shots {
        means[shot.place] += value(shot);
        counts[shot.place] += 1.0;
    }
    for (mean, count) in means.iter_mut().zip(&counts) {
        *mean /= *count;
    }
    let deviations: Vec<SVector<f64, 3>> = shots
        .iter()
        .map(|shot| value(shot) - means[shot.place])
        .collect();
    let covariance: SMatrix<f64, 3, 3> = deviations
        .iter()
        .map(|d| d * d.transpose())
        .sum::<SMatrix<f64, 3, 3>>()
        / count;
    let Some(cholesky) = covariance.cholesky() else {
        return ShapeTest {
            skewness_p: 1.0,
            kurtosis_p: 1.0,
            kurtosis_ratio: 1.0,
        };
    };
    // The cubes of the products of all pairs add up to the squares of the third moments.
    let (mut third, mut kurtosis) = ([0.0; 27], 0.0);
    for deviation in &deviations {
        let mut z = *deviation;
        cholesky.l_dirty().solve_lower_triangular_mut(&mut z);
        for (index, moment) in third.iter_mut().enumerate() {
            *moment += z[index / 9] * z[index / 3 % 3] * z[index % 3];
        }
        kurtosis += z.norm_squared() * z.norm_squared();
    }
    let skewness: f64 = third.iter().map(|moment| moment * moment).sum();
    // n b1/6 is about chi-square with d (d + 1) (d + 2)/6 = 10 degrees of freedom (Wilson and
    // Hilferty's cube root), with Mardia's correction for few shots.
    let correction =
        (D + 1.0) * (count + 1.0) * (count + 3.0) / (count * ((count + 1.0) * (D + 1.0) - 6.0));
    let chi_square = correction * skewness / (6.0 * count);
    let freedom = 10.0;
    let spread = 2.0 / (9.0 * freedom);
    let z = (libm::cbrt(chi_square / freedom) - (1.0 - spread)) / spread.sqrt();
    let expected = D * (D + 2.0) * (count - 1.0) / (count + 1.0);
    let sd = (8.0 * D * (D + 2.0) / count).sqrt();
    let kurtosis_z = (kurtosis / count - expected) / sd;
    ShapeTest {
        skewness_p: 1.0 - cdf(z),
        kurtosis_p: 2.0 * (1.0 - cdf(kurtosis_z.abs())),
        kurtosis_ratio: kurtosis / count / expected,
    }
}

/// The distribution that the shots ask for: Student's t where their kurtosis is too great for
/// normal ones, and by so much that it matters (fewer than about 17 degrees of freedom). Of normal
/// shots about one test in fifty is taken for heavy, which costs a little precision.
#[must_use]
pub fn tails_of(shots: &[MeasuredRelease], places: usize) -> Tails {
    const LEVEL: f64 = 0.04;
    const LEAST_RATIO: f64 = 1.15;
    let shape = shape_test(shots, places);
    if shape.kurtosis_ratio > LEAST_RATIO && shape.kurtosis_p < LEVEL {
        Tails::Student
    } else {
        Tails::Normal
    }
}

/// What should be said of a fit with these tests of its shots.
#[must_use]
pub fn notes(
    shots: &[MeasuredRelease],
    (shape, trends): (&ShapeTest, &[SessionTrend]),
    typical: &Draw,
    prior_weights: &Values,
    values: usize,
) -> Vec<FitNote> {
    /// From this share of the variance on, a user is told.
    const NOISY: f64 = 0.4;
    let mut notes = Vec::new();
    for (i, of) in ReleaseVariable::ALL.into_iter().enumerate().take(values) {
        let noise = shots.iter().map(|shot| shot.noise[(i, i)]).sum::<f64>() / shots.len() as f64;
        let own = typical.sds[i] * typical.sds[i];
        let share = noise / (noise + own);
        if share > NOISY {
            notes.push(FitNote::NoisyTracker { of, share });
        }
        if prior_weights[i] > 0.25 {
            notes.push(FitNote::MostlyPopulation {
                of,
                weight: prior_weights[i],
            });
        }
    }
    if typical.tail_weight > 0.0 {
        let is_seen = tails_of(shots, typical.means.len()) == Tails::Student;
        notes.push(FitNote::HeavyTails {
            degrees_of_freedom: 1.0 / typical.tail_weight,
            is_seen,
        });
    } else if shape.skewness_p < WARNING_LEVEL || shape.kurtosis_p < WARNING_LEVEL {
        let sessions_differ = |trend: &SessionTrend| {
            [trend.sessions_p, trend.spreads_p]
                .into_iter()
                .flatten()
                .any(|p| p < WARNING_LEVEL)
        };
        notes.push(FitNote::NotNormal {
            skewness_p: shape.skewness_p,
            kurtosis_p: shape.kurtosis_p,
            sessions_differ: trends.iter().any(sessions_differ),
        });
    }
    for trend in trends {
        let of = trend.of;
        if let Some(p) = trend.sessions_p.filter(|p| *p < WARNING_LEVEL) {
            notes.push(FitNote::SessionsDiffer { of, p });
        }
        if let Some(p) = trend.spreads_p.filter(|p| *p < WARNING_LEVEL) {
            notes.push(FitNote::ScatterDiffers { of, p });
        }
        if trend.drift_p < WARNING_LEVEL {
            notes.push(FitNote::Drift {
                of,
                p: trend.drift_p,
                by: Measure::si(trend.drift, of.dimension()),
            });
        }
        if trend.serial_p < WARNING_LEVEL {
            notes.push(FitNote::SerialCorrelation {
                of,
                p: trend.serial_p,
            });
        }
    }
    notes
}

/// The residuals of tracked flights about the fitted ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightResiduals {
    /// The sum of the squares, each over the variance of the tracker's noise.
    pub chi_square: f64,
    /// Its expectation if the noise is what the tracker's is said to be.
    pub expected: f64,
}

impl FlightResiduals {
    /// Of the sums of each flight; `None` without any.
    #[must_use]
    pub fn of(chi_squares: &[(f64, f64)]) -> Option<Self> {
        (!chi_squares.is_empty()).then(|| Self {
            chi_square: chi_squares.iter().map(|(seen, _)| seen).sum(),
            expected: chi_squares.iter().map(|(_, expected)| expected).sum(),
        })
    }

    /// The root mean square, over what the tracker's noise gives.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        (self.chi_square / self.expected.max(1.0)).sqrt()
    }

    /// Refuses flights that scatter far more than the tracker can.
    ///
    /// # Errors
    /// They scatter four times as much.
    pub fn check(&self) -> Result<(), TestError> {
        if self.ratio() > MOST_RESIDUALS {
            Err(TestError::OtherTracker(self.ratio()))
        } else {
            Ok(())
        }
    }

    /// A note where flights fit worse, or better, than the tracker's noise says.
    #[must_use]
    pub fn note(&self) -> Option<FitNote> {
        let expected = self.expected.max(1.0);
        let ratio = self.chi_square / expected;
        // Five standard deviations of a chi-square, and a fifth, since outliers are weighed down.
        let tolerance = 0.2 + 5.0 * (2.0 / expected).sqrt();
        ((ratio - 1.0).abs() > tolerance).then_some(FitNote::OtherNoise {
            scatter_ratio: ratio.sqrt(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::posterior::{FitOptions, fit};
    use super::*;
    use crate::math::normal_distribution::quantile;
    use rand::rngs::ChaCha12Rng;
    use rand::{RngExt, SeedableRng};

    /// A fit that chooses a t distribution by itself gives the reason, at the level of its choice.
    #[test]
    fn contract_the_note_on_tails_follows_the_choice() {
        let sample = |seed: u64| -> Vec<MeasuredRelease> {
            let mut random = ChaCha12Rng::seed_from_u64(seed);
            let mut normal = || quantile(random.random::<f64>().max(1e-300));
            (0..60)
                .map(|row| {
                    let wide = if row % 9 == 0 { 2.2 } else { 1.0 };
                    let [a, b, c] = [0; 3].map(|_: i32| wide * normal());
                    MeasuredRelease {
                        row,
                        place: 0,
                        values: [7.4 + 0.08 * a, 0.92 + 0.02 * b, 0.02 * c, 0.0],
                        noise: super::super::measured_release::Covariance::zeros(),
                        made: None,
                        own: None,
                    }
                })
                .collect()
        };
        let between = (0..200).map(sample).find(|shots| {
            let shape = shape_test(shots, 1);
            shape.kurtosis_p > WARNING_LEVEL && tails_of(shots, 1) == Tails::Student
        });
        let shots = between.unwrap();
        let options = FitOptions {
            tails: Tails::Student,
            ..FitOptions::default()
        };
        let posterior = fit(&shots, 1, &options).unwrap();
        let shape = shape_test(&shots, 1);
        let all = super::notes(&shots, (&shape, &[]), &posterior.typical(), &[0.0; 4], 3);
        let is_seen = |note: &FitNote| matches!(note, FitNote::HeavyTails { is_seen: true, .. });
        assert!(all.iter().any(is_seen), "{all:?}");
    }
}
