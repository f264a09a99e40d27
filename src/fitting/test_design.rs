//! What a test of some size will tell, before anyone shoots.

use super::advice::usual_probabilities;
use super::fitted_profile::fitted_profile;
use super::measured_release::{Covariance, MeasuredRelease, Place, Values};
use super::posterior::{FitError, FitOptions, SpinSource, Tails, fit, standard_normal};
use super::session_comparison::POWER;
use crate::probability::{Progress, Sampler};
use crate::shooter::{Nominal, Profile, ReleaseDistribution};
use nalgebra::{SMatrix, SVector, Vector4};
use rand::SeedableRng;
use rand::rngs::ChaCha12Rng;
use rayon::prelude::*;

/// Shots of the sample that the probabilities of a simulated test are computed with.
const SHOTS: usize = 8_192;

/// What a test of one size tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignRow {
    /// Shots of the test.
    pub shots: usize,
    /// Simulated tests.
    pub repetitions: u64,
    /// Relative standard deviations of the three standard deviations (speed, pitch, polar angle).
    pub sd_errors: [f64; 3],
    /// Standard deviation of P from the fitted profile.
    pub probability_error: f64,
    /// Relative standard error of [`DesignRow::probability_error`], by the finite number of
    /// simulated tests.
    pub simulation_error: f64,
    /// Standard deviation of P from counting makes.
    pub counting_error: f64,
}

impl DesignRow {
    /// The mean of the relative errors of the three standard deviations.
    #[must_use]
    pub fn sd_error(&self) -> f64 {
        self.sd_errors.iter().sum::<f64>() / self.sd_errors.len() as f64
    }
}

/// How far a session knows something: P, as a fraction of 1, or a scatter, relative to itself. The
/// error falls with the square root of the shots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SessionError {
    /// The standard deviation that one shot alone would leave.
    pub of_one_shot: f64,
    /// Shots of the session.
    pub shots: f64,
}

impl SessionError {
    /// The standard deviation of the session.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.of_one_shot / self.shots.sqrt()
    }

    /// How many shots a second session needs to show a change since this one at the level of 95 %
    /// with a power of 80 %, where `of_one_shot` is the error of one of its shots; `None` if no
    /// number suffices.
    #[must_use]
    pub fn second_session(&self, change: f64, of_one_shot: f64) -> Option<f64> {
        let own = self.error();
        let seen = change / POWER;
        let left = seen * seen - own * own;
        (left > 0.0).then(|| of_one_shot * of_one_shot / left)
    }

    /// How many shots two equal sessions need each to show a change. `ratio` is the error of a shot
    /// of the second over that of one of the first.
    #[must_use]
    pub fn each_session(of_one_shot: f64, change: f64, ratio: f64) -> f64 {
        let needed = POWER * of_one_shot * libm::hypot(1.0, ratio) / change;
        needed * needed
    }
}

/// Standard normal numbers of a shot: nine of the release, four of the tracker.
const NORMALS: usize = 13;
type Normals = SVector<f64, NORMALS>;

fn normals(shots: usize, seed: u64) -> Vec<Normals> {
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    (0..shots)
        .map(|_| Normals::from_fn(|_, _| standard_normal(&mut random)))
        .collect()
}

/// A simulated test: shots of a profile with a tracker's errors.
pub fn simulated_test(
    profile: &Profile,
    nominal: &Nominal,
    noise: &Covariance,
    shots: usize,
    seed: u64,
) -> Vec<MeasuredRelease> {
    test_of(profile, nominal, noise, &normals(shots, seed))
}

/// Tests with fewer shots are not made typical: it takes many more of them.
pub const LEAST_TYPICAL_SHOTS: usize = 20;

/// Numbers whose mean is exactly 0 and whose covariance is exactly the unit matrix (divided by one
/// less than their number): a test that is neither lucky nor unlucky in its means, scatters and
/// correlations, so that a few tell what many random ones tell on average.
fn typical_normals(shots: usize, seed: u64) -> Vec<Normals> {
    let drawn = normals(shots, seed);
    let mean = drawn.iter().sum::<Normals>() / shots as f64;
    let centred = drawn.iter().map(|z| z - mean);
    let squares: SMatrix<f64, NORMALS, NORMALS> = centred.clone().map(|z| z * z.transpose()).sum();
    let cholesky = (squares / (shots as f64 - 1.0)).cholesky();
    match cholesky {
        Some(cholesky) if shots >= LEAST_TYPICAL_SHOTS => centred
            .map(|z| cholesky.l().solve_lower_triangular(&z).unwrap_or(z))
            .collect(),
        _ => drawn,
    }
}

/// Points that stand for the means and the variances of speed, pitch and polar angle of all random
/// tests.
const POINTS: u64 = 12;

/// Turns a typical test into the one of a point of the six-dimensional space of means and
/// variances: one of them is off by the root of six standard errors to one side (a cubature formula
/// of degree three; Stroud, *Approximate calculation of multiple integrals*, 1971). A variance of
/// `n` shots has the relative standard error `sqrt(2/(n - 1))`.
fn put_at_point(test: &mut [MeasuredRelease], number: u64) {
    let count = test.len() as f64;
    let values = |shot: &MeasuredRelease| SVector::<f64, 3>::from_fn(|i, _| shot.values[i]);
    let mean = test.iter().map(values).sum::<SVector<f64, 3>>() / count;
    let squares: SMatrix<f64, 3, 3> = test
        .iter()
        .map(|shot| (values(shot) - mean) * (values(shot) - mean).transpose())
        .sum();
    let point = number % POINTS;
    let axis = (point / 2 % 3) as usize;
    let off = match point.is_multiple_of(2) {
        true => 6.0_f64.sqrt(),
        false => -6.0_f64.sqrt(),
    };
    if point < 6 {
        let Some(cholesky) = (squares / (count - 1.0)).cholesky() else {
            return;
        };
        let by = cholesky.l().column(axis) * (off / count.sqrt());
        for shot in test {
            (0..3).for_each(|i| shot.values[i] += by[i]);
        }
    } else {
        let factor = (1.0 + off * (2.0 / (count - 1.0)).sqrt()).max(0.0).sqrt();
        for shot in test {
            shot.values[axis] = mean[axis] + factor * (shot.values[axis] - mean[axis]);
        }
    }
}

fn test_of(
    profile: &Profile,
    nominal: &Nominal,
    noise: &Covariance,
    normals: &[Normals],
) -> Vec<MeasuredRelease> {
    let distribution = ReleaseDistribution::new(profile, nominal);
    let noise_factor = super::expected_makes::factor_of(noise);
    let shot = |(row, z): (usize, &Normals)| {
        let release = distribution.from_normal(std::array::from_fn(|i| z[i]));
        let made = profile
            .simulator()
            .simulate(&release)
            .is_ok_and(|outcome| outcome.verdict.made);
        let truth = Vector4::new(
            release.speed_m_s,
            release.pitch_rad,
            release.polar_rad,
            release.backspin_rad_s,
        );
        let error = noise_factor * Vector4::from_fn(|i, _| z[NORMALS - 4 + i]);
        MeasuredRelease {
            row: row as u64 + 1,
            place: 0,
            values: Values::from(truth + error),
            noise: *noise,
            made: Some(made),
            own: None,
        }
    };
    normals.iter().enumerate().map(shot).collect()
}

/// Simulates tests of each size, as many as it says, and fits them. `sizes` have shots and
/// repetitions. From [`LEAST_TYPICAL_SHOTS`] on the tests are typical ones: exactly those of
/// the shooter but for a mean or a variance, twelve of which stand for all.
///
/// # Errors
/// A fit did not converge.
pub fn design(
    profile: &Profile,
    nominal: &Nominal,
    noise: &Covariance,
    sizes: &[(usize, u64)],
    progress: &dyn Progress,
) -> Result<Vec<DesignRow>, FitError> {
    let probability = Sampler::new(profile)
        .estimate(
            nominal,
            0.002,
            profile.search().seed,
            &crate::probability::Silent,
        )
        .probability;
    let place = Place {
        location: profile.location(),
        release_height_m: profile.shooter().release_height_m,
    };
    let mut prior = super::prior::PopulationPrior::MEASURED;
    prior.backspin.mean = nominal.backspin_rad_s;
    let all = sizes.iter().map(|(_, repetitions)| repetitions).sum();
    progress.begin("simulating tests", all);
    let rows = sizes.iter().map(|&(shots, repetitions)| {
        let variances: Vec<Result<[f64; 4], FitError>> = (0..repetitions)
            .into_par_iter()
            .map(|repetition| {
                let seed = profile.search().seed ^ (repetition << 20 | shots as u64);
                let mut test = test_of(profile, nominal, noise, &typical_normals(shots, seed));
                if shots >= LEAST_TYPICAL_SHOTS {
                    put_at_point(&mut test, repetition);
                }
                let options = FitOptions {
                    prior,
                    spin: SpinSource::Given,
                    tails: Tails::Normal,
                    draws: 400,
                    seed,
                };
                let posterior = fit(&test, 1, &options)?;
                let relative = |i: usize| {
                    let sd = posterior.summary(|draw| draw.sds[i]);
                    sd.sd / sd.mean
                };
                let typical = posterior.typical();
                let p = fitted_profile("design", profile.physics(), &typical, &place)
                    .map(|fitted| {
                        usual_probabilities(&fitted, &posterior, 0, SHOTS)
                            .interval()
                            .sd
                    })
                    .unwrap_or(f64::NAN);
                progress.advance(1);
                Ok([relative(0), relative(1), relative(2), p].map(|x| x * x))
            })
            .collect();
        let (mut sums, mut p_squares) = ([0.0; 4], 0.0);
        for variance in variances {
            let variance = variance?;
            p_squares += variance[3] * variance[3];
            for (sum, value) in sums.iter_mut().zip(variance) {
                *sum += value;
            }
        }
        // Of the root of a mean: half the relative error of the mean.
        let count = repetitions as f64;
        let p_mean = sums[3] / count;
        let of_one = (p_squares / count - p_mean * p_mean).max(0.0).sqrt();
        let simulation_error = 0.5 * of_one / p_mean / (count - 1.0).max(1.0).sqrt();
        let [speed, pitch, polar, p] = sums.map(|sum| (sum / repetitions as f64).sqrt());
        Ok(DesignRow {
            shots,
            repetitions,
            sd_errors: [speed, pitch, polar],
            probability_error: p,
            simulation_error,
            counting_error: (probability * (1.0 - probability) / shots as f64).sqrt(),
        })
    });
    let rows = rows.collect();
    progress.end();
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: the variance of a difference is the sum of the variances.
    #[test]
    fn contract_a_second_session_of_the_needed_size_shows_the_change() {
        let first = SessionError {
            of_one_shot: 0.4,
            shots: 60.0,
        };
        let shots = first.second_session(0.2, 0.8 * 0.4).unwrap();
        let difference = libm::hypot(first.error(), 0.8 * 0.4 / shots.sqrt());
        assert!((difference * POWER - 0.2).abs() < 1e-12);
        // As many as in the first, where that is the size of both.
        let each = SessionError::each_session(0.4, 0.2, 1.0);
        let equal = SessionError {
            shots: each,
            ..first
        };
        assert!((equal.second_session(0.2, 0.4).unwrap() - each).abs() < 1e-9);
        // The first session alone is less sure than the change.
        assert_eq!(first.second_session(0.1, 0.4), None);
    }

    /// Authority: the definition.
    #[test]
    fn contract_typical_normals_have_the_moments_of_the_distribution() {
        let drawn = typical_normals(40, 3);
        let mean = drawn.iter().sum::<Normals>() / 40.0;
        assert!(mean.norm() < 1e-12);
        let covariance: SMatrix<f64, NORMALS, NORMALS> =
            drawn.iter().map(|z| z * z.transpose() / 39.0).sum();
        assert!((covariance - SMatrix::identity()).norm() < 1e-12);
        assert_eq!(typical_normals(19, 3), normals(19, 3));
    }
}
