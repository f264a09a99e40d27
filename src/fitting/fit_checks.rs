//! Checks of measured shots: before a fit, whether it makes sense; after it, whether the model
//! holds.

use super::flight_fit::DragEstimate;
use super::measured_release::{MeasuredRelease, Place, VALUE_NAMES, Values};
use super::posterior::{Draw, SpinSource, Tails};
use super::session_trends::SessionTrend;
use crate::math::normal_distribution::cdf;
use crate::model::Physics;
use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD};
use nalgebra::{SMatrix, SVector};

/// Why shots cannot be fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TestError {
    /// Fewer shots than unknowns.
    #[error(
        "has {shots} usable shots; a fit of shots from {places} place(s) has {unknowns} unknowns and needs at least {needed} shots"
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

/// What a fit should be told to a user.
#[derive(Clone, Debug, PartialEq)]
pub enum FitWarning {
    /// The tracker's error is as large as the scatter: value, share of the variance.
    NoisyTracker(&'static str, f64),
    /// The population tells more than the shots: value, weight.
    MostlyPopulation(&'static str, f64),
    /// The tracker seems to err more, or less, than stated: the ratio of seen to stated variance.
    OtherNoise(f64),
    /// The flights reject the drag coefficient of the physics: theirs, and that of the physics.
    OtherDrag(DragEstimate, f64),
    /// The shots are not normal: the p-values of Mardia's skewness and kurtosis, and whether the
    /// means of the sessions differ, which alone can cause it.
    NotNormal([f64; 2], bool),
    /// Heavier tails than normal ones were fitted: one over the degrees of freedom, and whether the
    /// shots show that they are heavier.
    HeavyTails(f64, bool),
    /// The aim drifts within the sessions: value, p-value, and by how much from the first shot to
    /// the last (m/s, rad or rad/s).
    Drift(&'static str, f64, f64),
    /// The means of the sessions differ: value, p-value.
    SessionsDiffer(&'static str, f64),
    /// The scatter of sessions differs: value, p-value.
    ScatterDiffers(&'static str, f64),
    /// The number of makes is not what these shots give: seen, expected, its standard deviation.
    OtherMakes(usize, f64, f64),
    /// The chances are too sure: see [`ExpectedMakes::calibration_z`](super::ExpectedMakes). With
    /// the most surprising shots: line, chance and result.
    TooSure(f64, Vec<(u64, f64, bool)>),
    /// Neighbouring shots are alike: value, p-value.
    SerialCorrelation(&'static str, f64),
}

impl std::fmt::Display for FitWarning {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoisyTracker(name, share) => write!(
                out,
                "{name}: {:.0} % of the variance of the measurements is the tracker's error; the shooter's own scatter is what is left of it, and uncertain",
                100.0 * share
            ),
            Self::MostlyPopulation(name, weight) => write!(
                out,
                "{name}: {:.0} % of what is known of its scatter comes from the population of shooters, not from these shots",
                100.0 * weight
            ),
            Self::OtherNoise(ratio) => write!(
                out,
                "the trajectories scatter {:.1} times as much about the fitted flights as the tracker should; give its noise with --tracker FILE: the error of a position is about so many times what the tracker says",
                ratio.sqrt()
            ),
            Self::OtherDrag(found, own) => write!(
                out,
                "the flights fit a drag coefficient of {:.3} (95 % interval {:.3} to {:.3}), the physics has {own:.3}: speeds and angles rest on it; `bankshot fit --free drag_coefficient` shows how to use another",
                found.best, found.interval[0], found.interval[1]
            ),
            Self::NotNormal([skewness, kurtosis], sessions_differ) => write!(
                out,
                "the releases are not normal (Mardia: skewness p = {skewness:.4}, kurtosis p = {kurtosis:.4}); {}",
                if *sessions_differ {
                    "the sessions differ (see there), which alone can be the reason: fit each with --session"
                } else {
                    "look for outliers, or for shots of two kinds"
                }
            ),
            Self::HeavyTails(weight, is_seen) => write!(
                out,
                "{} a t distribution with {:.1} degrees of freedom was fitted. profile.toml holds its standard deviations, draws.parquet all of it (`--draws`)",
                if *is_seen {
                    "far releases are more frequent than normal ones;"
                } else {
                    "the shots do not show more far releases than normal ones have; as asked for,"
                },
                1.0 / weight
            ),
            Self::OtherMakes(made, expected, sd) => write!(
                out,
                "{made} shots went in where {expected:.1} \u{b1} {sd:.1} were expected of the measured releases; {LOOK_AT}"
            ),
            Self::TooSure(z, shots) => {
                let shown = shots.iter().map(|(line, chance, made)| {
                    let result = if *made { "went in" } else { "missed" };
                    format!("line {line} (chance {chance:.2}) {result}")
                });
                write!(
                    out,
                    "the chances of single shots are too sure (Spiegelhalter's z {z:+.1}; above 3 in about 1 of 700 tests if they are right). The most surprising: {}. First suspect the tracker's noise (--tracker FILE with a greater one) and these rows; then look at the place, the height of the release, the columns and the physics",
                    shown.collect::<Vec<_>>().join(", ")
                )
            }
            Self::Drift(name, p, by) => write!(
                out,
                "{name} drifts by {} from the first shot to the last ({}): the last shots differ from the mean, on which P and the advice are based",
                drift_in_words(name, *by),
                p_value(*p)
            ),
            Self::SessionsDiffer(name, p) => write!(
                out,
                "{name} differs between the sessions ({}): the scatter here holds that too, and is wider than that of one session (fit one alone with --session NAME)",
                p_value(*p)
            ),
            Self::ScatterDiffers(name, p) => write!(
                out,
                "the scatter of {name} differs between the sessions ({}): this fit describes their mixture, not the latest one (fit one alone with --session NAME; `bankshot compare-sessions` compares two)",
                p_value(*p)
            ),
            Self::SerialCorrelation(name, p) => write!(
                out,
                "{name}: a shot is like the one before it ({}); intervals are then too narrow",
                p_value(*p)
            ),
        }
    }
}

/// How much and to which side a value drifts.
fn drift_in_words(name: &str, by: f64) -> String {
    let size = by.abs();
    let side = |words: [&'static str; 2]| words[usize::from(by < 0.0)];
    match name {
        "pitch" => format!("{:.1} deg {}", size / DEGREE_RAD, side(["up", "down"])),
        "polar" => format!(
            "{:.1} deg {}",
            size / DEGREE_RAD,
            side(["to the left", "to the right"])
        ),
        "speed" => format!(
            "{:.2} ft/s ({size:.2} m/s) {}",
            size / FOOT_M,
            side(["up", "down"])
        ),
        _ => format!("{:.2} rev/s {}", size / REV_RAD, side(["up", "down"])),
    }
}

/// `p = 0.22`, `p = 0.0031`, or `p < 0.0001`.
#[must_use]
pub fn p_value(p: f64) -> String {
    match p {
        p if p < 1e-4 => "p < 0.0001".to_owned(),
        p if p < 0.01 => format!("p = {p:.4}"),
        p => format!("p = {p:.2}"),
    }
}

/// What makes chances wrong.
const LOOK_AT: &str = "look at the place (a free throw is 13.75 ft or 4.19 m from the hoop's centre) and the height of the release, the columns (units, left and right, what depth is counted from, made), the physics (air, and this ring may be softer or harder) and the tracker's noise (--tracker)";

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
    let values = if spin == SpinSource::Measured { 4 } else { 3 };
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
    for index in 0..places.len() {
        let of_place = || shots.iter().filter(move |shot| shot.place == index);
        for (i, name) in VALUE_NAMES.iter().enumerate().take(values) {
            let first = of_place().next().map_or(0.0, |shot| shot.values[i]);
            let differs = of_place().any(|shot| (shot.values[i] - first).abs() > 1e-9);
            if !differs && of_place().count() > 1 {
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
    for (index, place) in places.iter().enumerate() {
        let of_place = || shots.iter().filter(move |shot| shot.place == index);
        let speed = median(of_place().map(|shot| shot.values[0]).collect());
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
    for place in 0..places {
        let of_place: Vec<usize> = (0..shots.len())
            .filter(|&i| shots[i].place == place)
            .collect();
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
    let Some(inverse) = covariance.try_inverse() else {
        return ShapeTest {
            skewness_p: 1.0,
            kurtosis_p: 1.0,
            kurtosis_ratio: 1.0,
        };
    };
    let (mut skewness, mut kurtosis) = (0.0, 0.0);
    for a in &deviations {
        let along = inverse * a;
        for b in &deviations {
            let product = along.dot(b);
            skewness += product * product * product;
        }
        let square = along.dot(a);
        kurtosis += square * square;
    }
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
pub fn warnings(
    shots: &[MeasuredRelease],
    (shape, trends): (&ShapeTest, &[SessionTrend]),
    typical: &Draw,
    prior_weights: &Values,
    values: usize,
) -> Vec<FitWarning> {
    /// From this share of the variance on, a user is told.
    const NOISY: f64 = 0.4;
    let mut warnings = Vec::new();
    for (i, name) in VALUE_NAMES.iter().enumerate().take(values) {
        let noise = shots.iter().map(|shot| shot.noise[(i, i)]).sum::<f64>() / shots.len() as f64;
        let own = typical.sds[i] * typical.sds[i];
        let share = noise / (noise + own);
        if share > NOISY {
            warnings.push(FitWarning::NoisyTracker(name, share));
        }
        if prior_weights[i] > 0.25 {
            warnings.push(FitWarning::MostlyPopulation(name, prior_weights[i]));
        }
    }
    if typical.tail_weight > 0.0 {
        let is_seen = tails_of(shots, typical.means.len()) == Tails::Student;
        warnings.push(FitWarning::HeavyTails(typical.tail_weight, is_seen));
    } else if shape.skewness_p < WARNING_LEVEL || shape.kurtosis_p < WARNING_LEVEL {
        let sessions_differ = |trend: &SessionTrend| {
            [trend.sessions_p, trend.spreads_p]
                .into_iter()
                .flatten()
                .any(|p| p < WARNING_LEVEL)
        };
        warnings.push(FitWarning::NotNormal(
            [shape.skewness_p, shape.kurtosis_p],
            trends.iter().any(sessions_differ),
        ));
    }
    for trend in trends {
        if let Some(p) = trend.sessions_p.filter(|p| *p < WARNING_LEVEL) {
            warnings.push(FitWarning::SessionsDiffer(trend.name, p));
        }
        if let Some(p) = trend.spreads_p.filter(|p| *p < WARNING_LEVEL) {
            warnings.push(FitWarning::ScatterDiffers(trend.name, p));
        }
        if trend.drift_p < WARNING_LEVEL {
            warnings.push(FitWarning::Drift(trend.name, trend.drift_p, trend.drift));
        }
        if trend.serial_p < WARNING_LEVEL {
            warnings.push(FitWarning::SerialCorrelation(trend.name, trend.serial_p));
        }
    }
    warnings
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

    /// A warning where flights fit worse, or better, than the tracker's noise says.
    #[must_use]
    pub fn warning(&self) -> Option<FitWarning> {
        let expected = self.expected.max(1.0);
        let ratio = self.chi_square / expected;
        // Five standard deviations of a chi-square, and a fifth, since outliers are weighed down.
        let tolerance = 0.2 + 5.0 * (2.0 / expected).sqrt();
        ((ratio - 1.0).abs() > tolerance).then_some(FitWarning::OtherNoise(ratio))
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
    fn contract_the_words_on_tails_follow_the_choice() {
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
        let all = warnings(&shots, (&shape, &[]), &posterior.typical(), &[0.0; 4], 3);
        let tails = |warning: &&FitWarning| matches!(warning, FitWarning::HeavyTails(..));
        let words = all.iter().find(tails).unwrap().to_string();
        assert!(!words.contains("as asked for"), "{words}");
    }
}
