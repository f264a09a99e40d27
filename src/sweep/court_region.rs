//! The region of a sweep: its places on the court.

use crate::model::Physics;
use crate::model::league_courts::League;
use crate::shooter::{Location, LocationError};
use serde::Serialize;

/// Greatest number of places.
pub const MAX_PLACES: usize = 100_000;

/// The region of the court that a sweep covers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Region {
    /// A grid about the hoop's centre over half the court.
    HalfCourt {
        /// Spacing, m.
        step_m: f64,
        /// Only places on and inside the three-point line.
        inside_three: bool,
    },
    /// A grid about the hoop's centre within a rectangle.
    Rectangle {
        /// Spacing, m.
        step_m: f64,
        /// Least and greatest x, m.
        x_m: (f64, f64),
        /// Least and greatest y, m.
        y_m: (f64, f64),
    },
    /// Circles about the hoop.
    Arcs {
        /// Their radii, m.
        distances_m: Vec<f64>,
        /// Least and greatest court angle, rad.
        angles_rad: (f64, f64),
        /// Spacing, rad.
        step_rad: f64,
    },
    /// Along the three-point line.
    ThreePointLine {
        /// Spacing along the line, m.
        step_m: f64,
    },
    /// The places of a file: (x, y), m.
    Locations(Vec<(f64, f64)>),
}

/// A place on the court.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CourtPlace {
    /// x, from the board towards midcourt, m.
    pub x_m: f64,
    /// y, across, m.
    pub y_m: f64,
}

impl CourtPlace {
    /// The place as the location of a shooter.
    #[must_use]
    pub fn location(&self) -> Location {
        Location::from_xy(self.x_m, self.y_m)
    }
}

impl Region {
    /// Its places in order. A grid omits those from which nobody can shoot.
    ///
    /// # Errors
    /// Nobody can shoot from a place of a file: its row, from 0, and the reason.
    pub fn places(
        &self,
        league: League,
        physics: &Physics,
    ) -> Result<Vec<CourtPlace>, (usize, LocationError)> {
        let court = league.court();
        let place = |(x_m, y_m): (f64, f64)| CourtPlace { x_m, y_m };
        let is_possible = |place: &CourtPlace| place.location().check(physics).is_ok();
        Ok(match self {
            Self::HalfCourt {
                step_m,
                inside_three,
            } => {
                let y = (-court.half_width_m, court.half_width_m);
                grid(*step_m, (court.baseline_x_m, court.half_line_x_m), y)
                    .filter(|&(x, y)| !inside_three || court.is_inside_three(x, y))
                    .map(place)
                    .filter(is_possible)
                    .collect()
            }
            Self::Rectangle { step_m, x_m, y_m } => grid(*step_m, *x_m, *y_m)
                .map(place)
                .filter(is_possible)
                .collect(),
            Self::Arcs {
                distances_m,
                angles_rad,
                step_rad,
            } => {
                let angles = multiples(*step_rad, *angles_rad);
                distances_m
                    .iter()
                    .flat_map(|&distance| {
                        angles.clone().map(move |angle| {
                            let (sin, cos) = libm::sincos(angle);
                            (distance * cos, distance * sin)
                        })
                    })
                    .map(place)
                    .filter(is_possible)
                    .collect()
            }
            Self::ThreePointLine { step_m } => {
                let along = court.along_three(*step_m);
                along.into_iter().map(place).filter(is_possible).collect()
            }
            Self::Locations(locations) => {
                let places: Vec<CourtPlace> = locations.iter().copied().map(place).collect();
                for (row, place) in places.iter().enumerate() {
                    place
                        .location()
                        .check(physics)
                        .map_err(|error| (row, error))?;
                }
                places
            }
        })
    }

    /// About the number of places, before any is computed.
    #[must_use]
    pub fn size(&self, league: League) -> f64 {
        let court = league.court();
        let span = |(low, high): (f64, f64), step: f64| (high - low) / step + 1.0;
        match self {
            Self::HalfCourt { step_m, .. } => {
                span((court.baseline_x_m, court.half_line_x_m), *step_m)
                    * span((-court.half_width_m, court.half_width_m), *step_m)
            }
            Self::Rectangle { step_m, x_m, y_m } => span(*x_m, *step_m) * span(*y_m, *step_m),
            Self::Arcs {
                distances_m,
                angles_rad,
                step_rad,
            } => distances_m.len() as f64 * span(*angles_rad, *step_rad),
            Self::ThreePointLine { step_m } => 4.0 * court.three_radius_m / step_m,
            Self::Locations(locations) => locations.len() as f64,
        }
    }
}

/// The multiples of `step` within a range, ends included.
fn multiples(step: f64, (low, high): (f64, f64)) -> impl Iterator<Item = f64> + Clone {
    let tolerance = 1e-9;
    let first = (low / step - tolerance).ceil() as i64;
    let last = (high / step + tolerance).floor() as i64;
    (first..=last).map(move |i| i as f64 * step)
}

fn grid(step: f64, x: (f64, f64), y: (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    multiples(step, x).flat_map(move |x| multiples(step, y).map(move |y| (x, y)))
}
