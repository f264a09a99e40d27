//! Everything that is fitted to one shooter's shots.

use super::advice::{USUAL_SHOTS, usual_probabilities};
use super::draw_probabilities::DrawProbabilities;
use super::expected_makes::{ExpectedMakes, expected_makes};
use super::fit_checks::{FlightResiduals, ShapeTest, TestError, check_releases, notes, shape_test};
use super::fit_note::FitNote;
use super::fitted_profile::{fitted_profile, with_backspin_kept};
use super::measured_release::{MeasuredRelease, Place, PlaceScatter, Values};
use super::posterior::{Draw, FitError, FitOptions, Posterior, SpinSource, fit};
use super::session_trends::{SessionTrend, trends};
use crate::model::Physics;
use crate::shooter::{Profile, ProfileError};

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
    /// The profile at each place.
    pub profiles: Vec<Profile>,
    /// P of the current shot at each place.
    pub probabilities: Vec<DrawProbabilities>,
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
) -> Result<ShooterFit, ShooterFitError> {
    check_releases(
        physics,
        test.places,
        test.shots,
        options.spin,
        test.speed_unit,
    )?;
    let residuals = FlightResiduals::of(test.chi_squares);
    if let Some(residuals) = residuals {
        residuals.check()?;
    }
    let posterior = fit(test.shots, test.places.len(), options)?;
    let typical = posterior.typical();
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
    let probabilities = (0..test.places.len())
        .map(|place| usual_probabilities(&profiles[place], &posterior, place, USUAL_SHOTS))
        .collect();
    let values = options.spin.measured_values();
    let makes = expected_makes(&profiles, test.shots, &typical, values);
    let shape = shape_test(test.shots, test.places.len());
    let sds: Vec<Values> = (0..typical.means.len())
        .map(|place| typical.sds_at(place))
        .collect();
    let trends = trends(test.shots, test.sessions, (&typical.means, &sds), values);
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
        profiles,
        probabilities,
        makes,
        residuals,
        shape,
        trends,
        notes,
    })
}
