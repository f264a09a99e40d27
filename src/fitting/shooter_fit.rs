//! Everything that is fitted to one shooter's shots.

use super::advice::{USUAL_SHOTS, usual_probabilities};
use super::autocorrelation::widen_means;
use super::current_form::probability_at_the_end;
use super::draw_probabilities::DrawProbabilities;
use super::expected_makes::{ExpectedMakes, expected_makes, makes_of_counts};
use super::fit_checks::{FlightResiduals, ShapeTest, TestError, check_releases, notes, shape_test};
use super::fit_note::FitNote;
use super::fitted_profile::{fitted_profile, with_backspin_kept};
use super::joint_posterior::{FlightsOf, with_unseen};
use super::makes_alone::{CountsError, posterior_of_makes};
use super::measured_release::{MeasuredRelease, Place, PlaceScatter, Values};
use super::posterior::{Draw, FitError, FitOptions, Posterior, SpinSource, fit_watched};
use super::predicted_bins::PredictiveCheck;
use super::prior::{Spread, UnseenPrior};
use super::session_trends::{SessionTrend, trends};
use super::shape_comparison::ShapeScore;
use crate::model::{Physics, SolidId};
use crate::probability::{Progress, Pulse, Silent};
use crate::shooter::{Profile, ProfileError};
use rayon::prelude::*;

/// Draws of the flights alone, of which those of the posterior are taken.
const FLIGHT_DRAWS: usize = 4000;
/// Makes farther from what is expected, in standard deviations, are worth a word.
const FAR_MAKES: f64 = 3.0;
/// See [`ExpectedMakes::calibration_z`].
const FAR_CALIBRATION: f64 = 3.0;

/// A fitted shooter.
#[derive(Clone, Debug)]
pub struct ShooterFit {
    /// Their name.
    pub name: String,
    /// Where they shot from.
    pub places: Vec<Place>,
    /// How far the releases of each place lie apart.
    pub place_scatter: Vec<PlaceScatter>,
    /// The posterior.
    pub posterior: Posterior,
    /// Its middle.
    pub typical: Draw,
    /// The restitution of the ring in the profiles, with three decimals; `None` where it was given.
    pub ring_restitution: Option<f64>,
    /// The profile at each place.
    pub profiles: Vec<Profile>,
    /// P of the current shot at each place.
    pub probabilities: Vec<DrawProbabilities>,
    /// At each place, P of the release as it is at the end of the session, where a value drifts.
    pub at_the_end: Vec<Option<DrawProbabilities>>,
    /// Predicted against observed.
    pub makes: ExpectedMakes,
    /// How well tracked flights fit; `None` without any.
    pub residuals: Option<FlightResiduals>,
    /// Whether the releases are normal.
    pub shape: ShapeTest,
    /// How each measured value runs over the sessions.
    pub trends: Vec<SessionTrend>,
    /// What should be said.
    pub notes: Vec<FitNote>,
    /// Predicted against measured; empty until it was asked for.
    pub predictive: PredictiveCheck,
    /// How well shapes of the releases predict; empty until it was asked for.
    pub shapes: Vec<ShapeScore>,
}

/// Why a shooter was not fitted.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ShooterFitError {
    /// The shots make no sense.
    #[error(transparent)]
    Test(#[from] TestError),
    /// The posterior did not converge, or has no scatter.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The fitted values make no profile.
    #[error("the fitted values make no profile: {0}")]
    Profile(#[from] ProfileError),
}

/// The measured shots of one shooter.
#[derive(Clone, Copy, Debug)]
pub struct ShooterTest<'a> {
    /// Their name.
    pub name: &'a str,
    /// Where they shot from.
    pub places: &'a [Place],
    /// How far the releases of each place lie apart.
    pub place_scatter: &'a [PlaceScatter],
    /// The shots.
    pub shots: &'a [MeasuredRelease],
    /// The session of each shot; empty if the file does not say.
    pub sessions: &'a [String],
    /// Unit of the speeds in the file, and its size in m/s.
    pub speed_unit: (&'static str, f64),
    /// Squared residuals of tracked flights, and what is expected of them.
    pub chi_squares: &'a [(f64, f64)],
}

/// Fits a shooter.
///
/// # Errors
/// The shots make no sense, the posterior did not converge, or its values make no profile.
pub fn fit_shooter(
    test: &ShooterTest<'_>,
    physics: &Physics,
    options: &FitOptions,
    unseen: &UnseenPrior,
) -> Result<ShooterFit, ShooterFitError> {
    let mut fits = fit_shooters(&[(*test, *options, *unseen)], physics, &Silent);
    fits.swap_remove(0)
}

/// Fits shooters who shot at one ring: what the makes of each say of it counts for the others.
pub fn fit_shooters(
    tests: &[(ShooterTest<'_>, FitOptions, UnseenPrior)],
    physics: &Physics,
    progress: &dyn Progress,
) -> Vec<Result<ShooterFit, ShooterFitError>> {
    // Of several the progress is that of all; of one, that of its parts.
    let (pulse, silent) = (Pulse(progress), Silent);
    let (of_all, of_one): (&dyn Progress, &dyn Progress) = match tests {
        [_] => (&silent, progress),
        _ => (progress, &pulse),
    };
    let count = tests.len() as u64;
    let finished = |_: &_| of_all.advance(1);
    of_all.begin("preparing players", count);
    let flights: Vec<Result<Option<FlightsOf<'_>>, ShooterFitError>> = tests
        .par_iter()
        .map(|(test, options, unseen)| flights_of(test, physics, (options, unseen), of_one))
        .inspect(finished)
        .collect();
    of_all.end();
    let ring_of = |number: usize| -> Option<Spread> {
        let (test, options, unseen) = &tests[number];
        let prior = unseen.ring?;
        let flights = flights[number].as_ref().ok()?.as_ref();
        let alone = posterior_of((test, physics), flights, (options, unseen), of_one).ok()?;
        let ring = alone.summary(|draw| draw.ring_restitution.unwrap_or(prior.middle));
        prior.likelihood(ring.mean, ring.sd)
    };
    let rings: Vec<(usize, Spread)> = match tests {
        [_] => Vec::new(),
        _ => {
            of_all.begin("finding the ring", count);
            let rings = (0..tests.len()).into_par_iter();
            let rings = rings.filter_map(|number| {
                of_all.advance(1);
                Some((number, ring_of(number)?))
            });
            let rings = rings.collect();
            of_all.end();
            rings
        }
    };
    let fit = |number: usize| {
        let (test, options, unseen) = &tests[number];
        let flights = flights[number].as_ref().map_err(Clone::clone)?;
        let others = rings.iter().filter(|(other, _)| *other != number);
        let unseen = UnseenPrior {
            ring_of_others: together(others.map(|(_, ring)| *ring)),
            ..*unseen
        };
        finish(
            (test, physics),
            flights.as_ref(),
            (options, &unseen),
            of_one,
        )
    };
    of_all.begin("fitting players", count);
    let fits = (0..tests.len()).into_par_iter().map(fit);
    let fits = fits.inspect(|_| of_all.advance(1)).collect();
    of_all.end();
    fits
}

/// What several normal likelihoods say together.
fn together(all: impl Iterator<Item = Spread>) -> Option<Spread> {
    let (mut precision, mut weighted) = (0.0, 0.0);
    for one in all {
        precision += 1.0 / (one.sd * one.sd);
        weighted += one.mean / (one.sd * one.sd);
    }
    (precision > 0.0).then(|| Spread {
        mean: weighted / precision,
        sd: 1.0 / precision.sqrt(),
    })
}

/// A physics with this restitution of the ring.
fn with_ring(physics: &Physics, restitution: Option<f64>) -> Physics {
    let mut physics = physics.clone();
    if let Some(restitution) = restitution {
        let set = physics.set_restitution_on(SolidId::Ring, restitution);
        debug_assert!(set.is_ok(), "a ring of a gym");
    }
    physics
}

fn flights_of<'a>(
    test: &ShooterTest<'a>,
    physics: &Physics,
    (options, unseen): (&FitOptions, &UnseenPrior),
    progress: &dyn Progress,
) -> Result<Option<FlightsOf<'a>>, ShooterFitError> {
    if options.spin == SpinSource::NothingMeasured {
        return match test.shots.is_empty() {
            true => Err(TestError::NoShots.into()),
            false => Ok(None),
        };
    }
    check_releases(
        physics,
        test.places,
        test.shots,
        options.spin,
        test.speed_unit,
    )?;
    if let Some(residuals) = FlightResiduals::of(test.chi_squares) {
        residuals.check()?;
    }
    let more_draws = FitOptions {
        draws: FLIGHT_DRAWS.max(options.draws),
        ..*options
    };
    let releases = (test.shots, test.places.len());
    let mut posterior = fit_watched(releases, &more_draws, progress)?;
    widen_means(&mut posterior, (test.shots, test.sessions), options.seed);
    Ok(Some(FlightsOf {
        name: test.name,
        physics: with_ring(physics, unseen.ring.map(|ring| ring.middle)),
        places: test.places,
        shots: test.shots,
        posterior,
    }))
}

/// The posterior of flights and makes, or of makes alone.
fn posterior_of(
    (test, physics): (&ShooterTest<'_>, &Physics),
    flights: Option<&FlightsOf<'_>>,
    (options, unseen): (&FitOptions, &UnseenPrior),
    progress: &dyn Progress,
) -> Result<Posterior, ShooterFitError> {
    if let Some(flights) = flights {
        return Ok(with_unseen(flights, unseen, options, progress)?);
    }
    let physics = with_ring(physics, unseen.ring.map(|ring| ring.middle));
    let shots = (test.places, test.shots);
    let posterior = posterior_of_makes(test.name, shots, &physics, (options, unseen), progress);
    posterior.map_err(|error| match error {
        CountsError::Fit(error) => error.into(),
        CountsError::Profile(error) => error.into(),
    })
}

fn finish(
    (test, physics): (&ShooterTest<'_>, &Physics),
    flights: Option<&FlightsOf<'_>>,
    (options, unseen): (&FitOptions, &UnseenPrior),
    progress: &dyn Progress,
) -> Result<ShooterFit, ShooterFitError> {
    let residuals = FlightResiduals::of(test.chi_squares);
    let posterior = posterior_of((test, physics), flights, (options, unseen), progress)?;
    let typical = posterior.typical();
    let ring_restitution = typical
        .ring_restitution
        .map(|ring| (ring * 1000.0).round() / 1000.0);
    let physics = &with_ring(physics, ring_restitution);
    let profiles = test
        .places
        .iter()
        .enumerate()
        .map(|(i, place)| {
            let profile = fitted_profile(test.name, physics, &typical, place)?;
            match options.spin {
                SpinSource::Measured => Ok(profile),
                _ => with_backspin_kept(&profile, typical.means[i][3]),
            }
        })
        .collect::<Result<Vec<_>, ProfileError>>()?;
    progress.begin("chances of places", test.places.len() as u64);
    let probabilities: Vec<DrawProbabilities> = (0..test.places.len())
        .map(|place| usual_probabilities(&profiles[place], &posterior, place, USUAL_SHOTS))
        .inspect(|_| progress.advance(1))
        .collect();
    progress.end();
    let values = options.spin.measured_values();
    let (makes, shape) = match options.spin {
        SpinSource::NothingMeasured => {
            let chance = |place: usize| probabilities[place].interval().mean;
            (
                makes_of_counts(test.shots, &typical, chance),
                ShapeTest::NONE,
            )
        }
        _ => (
            expected_makes(&profiles, test.shots, (&typical, values), progress),
            shape_test(test.shots, test.places.len()),
        ),
    };
    let sds: Vec<Values> = (0..typical.means.len())
        .map(|place| typical.sds_at(place))
        .collect();
    let trends = trends(test.shots, test.sessions, (&typical.means, &sds), values);
    let at_the_end = (0..test.places.len())
        .map(|place| probability_at_the_end(&profiles[place], &posterior, &trends, place))
        .collect();
    let mut notes = notes(
        test.shots,
        (&shape, &trends),
        &typical,
        &posterior.prior_weights,
        values,
    );
    notes.extend(residuals.and_then(|residuals| residuals.note()));
    // Half a shot for the simulated chances themselves.
    let sd = libm::hypot(makes.expected_sd, 0.5);
    if (makes.made as f64 - makes.expected).abs() > FAR_MAKES * sd && makes.labelled > 0 {
        notes.push(FitNote::OtherMakes {
            made: makes.made,
            expected: makes.expected,
            expected_sd: makes.expected_sd,
        });
    } else if let Some(z) = makes.calibration_z.filter(|z| *z > FAR_CALIBRATION) {
        notes.push(FitNote::TooSure {
            calibration_z: z,
            shots: makes.most_surprising(),
        });
    }
    Ok(ShooterFit {
        name: test.name.to_owned(),
        places: test.places.to_vec(),
        place_scatter: test.place_scatter.to_vec(),
        posterior,
        typical,
        ring_restitution,
        profiles,
        at_the_end,
        probabilities,
        makes,
        residuals,
        shape,
        trends,
        notes,
        predictive: PredictiveCheck::default(),
        shapes: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::measured_release::Covariance;
    use crate::fitting::posterior::standard_normal;
    use crate::fitting::{AimPrior, RINGS_OF_GYMS};
    use crate::model::Preset;
    use crate::shooter::Location;
    use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD};
    use rand::SeedableRng;
    use rand::rngs::ChaCha12Rng;
    use std::sync::Mutex;

    /// Stages with their units, and what was done of them.
    #[derive(Default)]
    struct Stages(Mutex<Vec<(String, u64, u64)>>);

    impl Progress for Stages {
        fn begin(&self, stage: &str, total: u64) {
            let mut stages = self.0.lock().unwrap();
            stages.push((stage.to_owned(), total, 0));
        }
        fn advance(&self, units: u64) {
            self.0.lock().unwrap().last_mut().unwrap().2 += units;
        }
        fn end(&self) {}
    }

    /// A file of a stranger may have any number of shots, places and players: each part whose time
    /// grows with it reports how far it is, to its end.
    #[test]
    fn contract_a_fit_reports_its_progress() {
        let at = |distance_ft: f64| Place {
            location: Location {
                distance_m: distance_ft * FOOT_M,
                angle_rad: 0.0,
            },
            release_height_m: 7.0 * FOOT_M,
        };
        let places = [at(13.75), at(16.0)];
        let mut random = ChaCha12Rng::seed_from_u64(1);
        let mut normal = || standard_normal(&mut random);
        let shots: Vec<MeasuredRelease> = (0..40)
            .map(|row| MeasuredRelease {
                row,
                place: row as usize % 2,
                values: [
                    (24.2 + 1.6 * (row % 2) as f64 + 0.25 * normal()) * FOOT_M,
                    (52.0 + 1.2 * normal()) * DEGREE_RAD,
                    1.2 * normal() * DEGREE_RAD,
                    2.25 * REV_RAD,
                ],
                noise: Covariance::identity() * 1e-6,
                made: Some(row % 3 > 0),
                own: None,
            })
            .collect();
        let test = ShooterTest {
            name: "Ann",
            places: &places,
            place_scatter: &[PlaceScatter::default(); 2],
            shots: &shots,
            sessions: &[],
            speed_unit: ("ft/s", FOOT_M),
            chi_squares: &[],
        };
        let options = FitOptions {
            spin: SpinSource::Given,
            ..FitOptions::default()
        };
        let unseen = UnseenPrior {
            ring: Some(RINGS_OF_GYMS),
            aim: Some(AimPrior::POPULATION),
            ..UnseenPrior::NONE
        };
        let physics = Preset::named("ncaa").unwrap().physics();
        let stages = |players: usize| {
            let reported = Stages::default();
            let tests = vec![(test, options, unseen); players];
            for fit in fit_shooters(&tests, &physics, &reported) {
                fit.unwrap();
            }
            let reported = reported.0.into_inner().unwrap();
            for (stage, total, done) in &reported {
                assert_eq!(done, total, "{stage}");
            }
            let mut stages: Vec<String> = reported.into_iter().map(|(stage, ..)| stage).collect();
            // Chains that have not converged are followed by longer ones.
            stages.dedup();
            stages
        };
        let of_one = [
            "fitting releases",
            "finding shots",
            "simulating shots",
            "weighing makes",
            "chances of places",
            "counting makes",
            "chances of places",
            "chances of shots",
        ];
        assert_eq!(stages(1), of_one);
        assert_eq!(
            stages(2),
            ["preparing players", "finding the ring", "fitting players"]
        );
    }
}
