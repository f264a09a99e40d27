//! All of a profile but the place: what a shooter takes from place to place.

use super::{Choice, Grid, Intent, Output, Place, PlaceError, Profile, Search, Shooter};
use crate::dynamics::Integrator;
use crate::physics::Physics;
use serde::Serialize;

/// A profile without its place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Template {
    /// Who shoots.
    pub shooter: Shooter,
    /// The nominal shot, or parts of it.
    pub nominal: Intent,
    /// The world.
    pub physics: Physics,
    /// How the equations are integrated.
    pub integrator: Integrator,
    /// Sizes of the table.
    pub grid: Grid,
    /// The search, as far as it is given.
    pub search: GivenSearch,
    /// Where and in which units results are written.
    pub output: Output,
}

/// What a profile says about the search; the rest depends on the place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GivenSearch {
    /// What is searched.
    pub choose: Choice,
    /// Smallest nominal pitch angle, rad.
    pub pitch_min_rad: Option<f64>,
    /// Largest nominal pitch angle, rad.
    pub pitch_max_rad: Option<f64>,
    /// Largest speed of a release, m/s.
    pub speed_max_m_s: Option<f64>,
    /// Standard error wanted for each probability.
    pub standard_error: Option<f64>,
    /// Sobol points by which the search climbs.
    pub climb_samples: Option<u32>,
    /// Seed of the Sobol scrambles.
    pub seed: Option<u64>,
}

impl Template {
    /// Standard error wanted for each probability.
    #[must_use]
    pub fn standard_error(&self) -> f64 {
        let given = self.search.standard_error;
        given.unwrap_or_else(|| Search::around(1.0, 0.0).standard_error)
    }

    /// Seed of the Sobol scrambles.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.search
            .seed
            .unwrap_or_else(|| Search::around(1.0, 0.0).seed)
    }

    /// The profile at a place.
    ///
    /// # Errors
    /// When nobody can shoot from there, or no pitch angle is left to search.
    pub fn at(&self, place: Place) -> Result<Profile, PlaceError> {
        place.check(&self.physics)?;
        let height_m = self.shooter.release_height_m - self.physics.hoop_height_m;
        let usual = Search::around(place.distance_m, height_m);
        let given = &self.search;
        let search = Search {
            choose: given.choose,
            pitch_min_rad: given.pitch_min_rad.unwrap_or(usual.pitch_min_rad),
            pitch_max_rad: given.pitch_max_rad.unwrap_or(usual.pitch_max_rad),
            speed_max_m_s: given.speed_max_m_s,
            standard_error: given.standard_error.unwrap_or(usual.standard_error),
            climb_samples: given.climb_samples.unwrap_or(usual.climb_samples),
            seed: given.seed.unwrap_or(usual.seed),
        };
        let (low_rad, high_rad) = (search.pitch_min_rad, search.pitch_max_rad);
        if search.choose.pitch && !(low_rad < high_rad) {
            return Err(PlaceError::NoPitch { low_rad, high_rad });
        }
        Ok(Profile {
            shooter: self.shooter.clone(),
            place,
            nominal: self.nominal,
            physics: self.physics.clone(),
            integrator: self.integrator,
            grid: self.grid,
            search,
            output: self.output.clone(),
        })
    }
}
