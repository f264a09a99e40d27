//! The shooter's test: from measured shots to the distribution of the releases, and how sure it is.
//!
//! A measured release is the true one plus the error of the tracker, `y = x + e`; the true ones of
//! a shooter at a place are normal about the shooter's aim there, `x ~ N(mu, Sigma)`, and the
//! covariance of `e` is known for each shot. The answer is a sample of the posterior distribution
//! of `mu` and `Sigma` ([`Posterior`]); every probability that follows from it is computed for each
//! draw ([`DrawProbabilities`]), so it has an interval.
//!
//! The values of a release are `[speed, pitch, polar angle, backspin]`, m/s, rad, rad, rad/s
//! ([`Values`]). `docs/fitting.md` has the model, its prior and how it was checked.

mod advice;
mod advice_steps;
mod angle_over_draws;
mod autocorrelation;
mod best_aims;
mod chain_diagnostics;
mod constant_error;
mod contradiction;
mod current_form;
mod dispersion_posterior;
mod draw_probabilities;
mod expected_makes;
mod fit_checks;
mod fit_note;
mod fitted_profile;
mod flight_fit;
mod grouped_measurements;
mod importance;
mod interval;
mod joint_posterior;
mod landing;
mod makes_alone;
mod makes_likelihood;
mod measured_release;
mod noise_of_tracks;
mod other_release_height;
mod posterior;
mod predicted_bins;
mod predictive_check;
mod prior;
mod prior_sensitivity;
mod session_comparison;
mod session_trends;
mod shape_comparison;
mod shared_error;
mod shooter_fit;
mod shots_under_physics;
mod skew_posterior;
mod student_posterior;
mod test_design;
mod tracked_flight_noise;
mod tracker_noise;
mod unmeasured_parameter_likelihood;

pub use advice::{Advice, KindComparison, TrainingGain, advise, usual_probabilities};
pub use advice_steps::{AdviceStep, AdviceSteps, AloneGains, Cause, SAME_SPEED_M_S, Support};
pub use angle_over_draws::{AngleOverDraws, best_angles_of_draws};
pub use best_aims::BestAims;
pub use contradiction::Contradiction;
pub use dispersion_posterior::is_speed_scatter_possible;
pub use draw_probabilities::{DrawProbabilities, WeightedShots};
pub use expected_makes::{
    ExpectedMakes, KnownRelease, ReliabilityBin, ShotChance, Wilson, change_of_share,
    expected_makes, made_z_of_releases, wilson_interval,
};
pub use fit_checks::{
    FlightResiduals, ReleaseDifference, ShapeTest, TestError, WARNING_LEVEL, check_releases,
    check_speed_unit, far_shots, notes, shape_test, tails_of,
};
pub use fit_note::{FitNote, SurprisingShot};
pub use fitted_profile::fitted_profile;
pub use flight_fit::{
    DragEstimate, FlightFit, FlightFitError, TrackedPoint, fit_drag_coefficient, fit_flight,
};
pub use importance::UnseenSample;
pub use interval::Interval;
pub use landing::{
    CENTRE_DEPTH_M, Landing, LandingError, landing_of, own_path, release_of_landing,
    release_of_uncertain_landing,
};
pub use measured_release::{
    Covariance, MeasuredRelease, OwnPath, Place, PlaceScatter, VALUE_NAMES, Values, nominal_of,
    values_of,
};
pub use noise_of_tracks::noise_of_tracks;
pub use other_release_height::values_at_height;
pub use posterior::{Draw, FitError, FitOptions, Posterior, SpinSource, Tails, fit, pair_name};
pub use predicted_bins::{PredictedBin, PredictiveCheck};
pub use predictive_check::predictive_check;
pub use prior::{
    AimPrior, ConstantErrorPrior, PopulationPrior, PriorOf, PriorOfDraws, RINGS_OF_GYMS, Spread,
    StudentSpread, UnseenPrior,
};
pub use prior_sensitivity::PriorSensitivity;
pub use session_comparison::{
    DAILY_FORM, POWER, ProbabilityChange, SessionComparison, TWO_SIDED_95, compare_probabilities,
    compare_sessions, probability_change, share_unseen,
};
pub use session_trends::{SessionTrend, session_names, trends};
pub use shape_comparison::{Shape, ShapeScore, compare_shapes};
pub use shared_error::shared_sd;
pub use shooter_fit::{ShooterFit, ShooterFitError, ShooterTest, fit_shooter, fit_shooters};
pub use shots_under_physics::{FittedShots, Measured, ShotsUnderPhysics};
pub use test_design::{DesignRow, LEAST_TYPICAL_SHOTS, SessionError, design, simulated_test};
pub use tracked_flight_noise::tracked_flight_noise;
pub use tracker_noise::{Tracker, TrackerNoise};
pub use unmeasured_parameter_likelihood::{
    FittedShooter, LikelihoodCurve, UnseenParameter, likelihood_curve,
};
