//! The distribution of releases about one nominal shot.

use super::correlation::Correlation;
use super::nominal::Nominal;
use super::profile::Profile;
use super::release_variable::ReleaseVariable;
use crate::dynamics::Release;
use crate::math::normal_distribution;

const N: usize = ReleaseVariable::COUNT;

/// The normal distribution of the releases about one nominal shot.
#[derive(Clone, Debug)]
pub struct ReleaseDistribution {
    centre: Release,
    sigmas: [f64; N],
    needed: [bool; N],
    correlation: Correlation,
}

impl ReleaseDistribution {
    /// The distribution of a profile's releases about a nominal shot.
    #[must_use]
    pub fn new(profile: &Profile, nominal: &Nominal) -> Self {
        let dispersion = &profile.shooter().dispersion;
        let sigmas = dispersion.sigmas(nominal);
        Self {
            centre: profile.release(nominal),
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

    /// The release for uniform numbers, 0 to 1 exclusive. `uniform` gives the one of each dimension that
    /// matters.
    pub fn from_uniform(&self, mut uniform: impl FnMut(usize) -> f64) -> Release {
        self.from_normal(std::array::from_fn(|k| {
            if self.needed[k] {
                normal_distribution::quantile(uniform(k))
            } else {
                0.0
            }
        }))
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
