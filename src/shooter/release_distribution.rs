//! The distribution of releases about one nominal shot.

use super::correlation::Correlation;
use super::nominal::Nominal;
use super::profile::Profile;
use super::release_variable::ReleaseVariable;
use crate::dynamics::{Release, ReleaseWithoutSpeed};
use crate::math::normal_distribution;
use crate::math::sobol::Scramble;
use crate::math::vector::Vec3;
use crate::model::BallState;

const N: usize = ReleaseVariable::COUNT;

/// What a spin is worth shows over much more than people's errors of it.
pub(crate) const LEAST_WIDE_SPIN_RAD_S: f64 = 3.0;

/// The normal distribution of the releases about one nominal shot.
#[derive(Clone, Debug)]
pub struct ReleaseDistribution {
    centre: Release,
    sigmas: [f64; N],
    needed: [bool; N],
    correlation: Correlation,
    /// Position of the release, m, if it has no error.
    position_m: Option<Vec3<f64>>,
}

impl ReleaseDistribution {
    /// The distribution of a profile's releases about a nominal shot.
    #[must_use]
    pub fn new(profile: &Profile, nominal: &Nominal) -> Self {
        let dispersion = &profile.shooter().dispersion;
        let sigmas = dispersion.sigmas(nominal);
        let centre = profile.release(nominal);
        let of_position = [
            ReleaseVariable::Distance,
            ReleaseVariable::CourtAngle,
            ReleaseVariable::Height,
        ];
        let is_fixed = of_position.iter().all(|v| sigmas[v.index()] == 0.0);
        Self {
            position_m: is_fixed.then(|| centre.position_m()),
            centre,
            sigmas,
            needed: dispersion.correlation.needed(&sigmas),
            correlation: dispersion.correlation,
        }
    }

    /// Whether there is no error at all.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.sigmas.iter().all(|&sigma| sigma == 0.0)
    }

    /// The state at the release for independent standard normals.
    pub(crate) fn state(&self, independent: [f64; N]) -> BallState {
        let release = self.from_normal(independent);
        let position_m = self.position_m.unwrap_or_else(|| release.position_m());
        ReleaseWithoutSpeed::at(position_m, &release)
            .state(release.speed_m_s, release.backspin_rad_s)
    }

    /// The same with errors so many times as great. Those of the spins are at least
    /// [`LEAST_WIDE_SPIN_RAD_S`], where there are any.
    pub(crate) fn widened(mut self, factor: f64) -> Self {
        for variable in ReleaseVariable::ALL {
            let sigma = &mut self.sigmas[variable.index()];
            let least = match variable {
                ReleaseVariable::Backspin | ReleaseVariable::SideSpin if *sigma > 0.0 => {
                    LEAST_WIDE_SPIN_RAD_S
                }
                _ => 0.0,
            };
            *sigma = (*sigma * factor).max(least);
        }
        self
    }

    /// Calls `use_state` with the state at the release of each point `from..to` of a scramble. The
    /// points are drawn in blocks: the normals of a block, variable by variable, are those of
    /// [`ReleaseDistribution::from_uniform`].
    pub(crate) fn for_each_state(
        &self,
        scramble: &Scramble,
        range: (u32, u32),
        mut use_state: impl FnMut(BallState),
    ) {
        self.for_each_state_and_normals(scramble, range, |state, _| use_state(state));
    }

    /// The same with the independent standard normals of each point.
    pub(crate) fn for_each_state_and_normals(
        &self,
        scramble: &Scramble,
        (from, to): (u32, u32),
        mut use_state: impl FnMut(BallState, &[f64; N]),
    ) {
        const BLOCK: usize = 256;
        let mut points = [[0.0; N]; BLOCK];
        let mut of_variable = [0.0; BLOCK];
        let mut sequence = scramble.sequence(from);
        for start in (from..to).step_by(BLOCK) {
            let points = &mut points[..BLOCK.min((to - start) as usize)];
            for point in points.iter_mut() {
                for (k, value) in point.iter_mut().enumerate() {
                    *value = if self.needed[k] {
                        sequence.coordinate(k)
                    } else {
                        0.0
                    };
                }
                sequence.advance();
            }
            for k in (0..N).filter(|&k| self.needed[k]) {
                let values = &mut of_variable[..points.len()];
                for (value, point) in values.iter_mut().zip(&*points) {
                    *value = point[k];
                }
                normal_distribution::quantiles(values);
                for (value, point) in values.iter().zip(points.iter_mut()) {
                    point[k] = *value;
                }
            }
            for point in points {
                use_state(self.state(*point), point);
            }
        }
    }

    /// The release for uniform numbers, 0 to 1 exclusive. `uniform` gives the one of each dimension
    /// that matters.
    pub fn from_uniform(&self, mut uniform: impl FnMut(usize) -> f64) -> Release {
        self.from_normal(std::array::from_fn(|k| {
            if self.needed[k] {
                normal_distribution::quantile(uniform(k))
            } else {
                0.0
            }
        }))
    }

    /// Independent standard normals for uniform numbers, 0 to 1 exclusive, in the order of
    /// [`ReleaseVariable::ALL`].
    pub(crate) fn normals(uniform: impl Fn(usize) -> f64) -> [f64; N] {
        std::array::from_fn(|k| normal_distribution::quantile(uniform(k)))
    }

    /// The density of this distribution over that of `other`, at the release that `other` has for
    /// independent standard normals. Not a number, or infinite, where that cannot be told.
    pub(crate) fn relative_density(&self, other: &Self, independent: &[f64; N]) -> f64 {
        let normals = other.correlation.apply(*independent);
        let (mine, others) = (values(&self.centre), values(&other.centre));
        let mut own = normals;
        let mut scales = 1.0;
        for k in 0..N {
            if self.sigmas[k] != other.sigmas[k] || mine[k] != others[k] {
                scales *= other.sigmas[k] / self.sigmas[k];
                own[k] = (others[k] + other.sigmas[k] * normals[k] - mine[k]) / self.sigmas[k];
            }
        }
        let own = self.correlation.independent_of(&own);
        let squares = |z: &[f64; N]| z.iter().map(|z| z * z).sum::<f64>();
        scales * libm::exp(0.5 * (squares(independent) - squares(&own)))
    }

    /// The independent standard normals here of the releases that `other` has for its own.
    pub(crate) fn normals_from(&self, other: &Self) -> NormalsMap {
        let (mine, others) = (values(&self.centre), values(&other.centre));
        let here = |independent: &[f64; N]| {
            let mut normals = other.correlation.apply(*independent);
            for k in 0..N {
                if self.sigmas[k] != other.sigmas[k] || mine[k] != others[k] {
                    normals[k] =
                        (others[k] + other.sigmas[k] * normals[k] - mine[k]) / self.sigmas[k];
                }
            }
            self.correlation.independent_of(&normals)
        };
        let offsets = here(&[0.0; N]);
        let mut rows = [[0.0; N]; N];
        for j in 0..N {
            let unit = std::array::from_fn(|k| f64::from(u8::from(k == j)));
            let column = here(&unit);
            for (i, row) in rows.iter_mut().enumerate() {
                row[j] = column[i] - offsets[i];
            }
        }
        NormalsMap { rows, offsets }
    }

    /// The release for independent standard normals, in the order of [`ReleaseVariable::ALL`].
    #[must_use]
    pub fn from_normal(&self, independent: [f64; N]) -> Release {
        let normals = self.correlation.apply(independent);
        let error =
            |variable: ReleaseVariable| self.sigmas[variable.index()] * normals[variable.index()];
        let centre = &self.centre;
        Release {
            speed_m_s: centre.speed_m_s + error(ReleaseVariable::Speed),
            pitch_rad: centre.pitch_rad + error(ReleaseVariable::Pitch),
            polar_rad: centre.polar_rad + error(ReleaseVariable::Polar),
            backspin_rad_s: centre.backspin_rad_s + error(ReleaseVariable::Backspin),
            rifle_spin_rad_s: centre.rifle_spin_rad_s + error(ReleaseVariable::RifleSpin),
            side_spin_rad_s: centre.side_spin_rad_s + error(ReleaseVariable::SideSpin),
            distance_m: centre.distance_m + error(ReleaseVariable::Distance),
            court_angle_rad: centre.court_angle_rad + error(ReleaseVariable::CourtAngle),
            height_above_hoop_m: centre.height_above_hoop_m + error(ReleaseVariable::Height),
        }
    }
}

/// The independent standard normals of a release of one distribution in another: `A z + b`.
pub(crate) struct NormalsMap {
    /// `A`.
    pub(crate) rows: [[f64; N]; N],
    /// `b`.
    pub(crate) offsets: [f64; N],
}

/// The values of a release in the order of [`ReleaseVariable::ALL`].
fn values(release: &Release) -> [f64; N] {
    ReleaseVariable::ALL.map(|variable| match variable {
        ReleaseVariable::Speed => release.speed_m_s,
        ReleaseVariable::Pitch => release.pitch_rad,
        ReleaseVariable::Polar => release.polar_rad,
        ReleaseVariable::Backspin => release.backspin_rad_s,
        ReleaseVariable::RifleSpin => release.rifle_spin_rad_s,
        ReleaseVariable::SideSpin => release.side_spin_rad_s,
        ReleaseVariable::Distance => release.distance_m,
        ReleaseVariable::CourtAngle => release.court_angle_rad,
        ReleaseVariable::Height => release.height_above_hoop_m,
    })
}
