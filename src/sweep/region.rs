//! The places of a sweep.

use crate::court::League;
use crate::physics::Physics;
use crate::profile::{Place, PlaceError};
use serde::Serialize;

/// Most places of a sweep.
pub const MOST_PLACES: usize = 100_000;

/// Which places are asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Region {
    /// A grid about the hoop's centre over half the court.
    HalfCourt {
        /// Distance of neighbours, m.
        step_m: f64,
        /// Only on and inside the three-point line.
        inside_three: bool,
    },
    /// A grid about the hoop's centre within a rectangle.
    Rectangle {
        /// Distance of neighbours, m.
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
        /// Angle between neighbours, rad.
        step_rad: f64,
    },
    /// Along the three-point line.
    ThreePointLine {
        /// Distance of neighbours along the line, m.
        step_m: f64,
    },
    /// Places of a file.
    Places(Vec<(f64, f64)>),
}

/// A place of the sweep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spot {
    /// x, m.
    pub x_m: f64,
    /// y, m.
    pub y_m: f64,
}

impl Spot {
    /// As a shooter's place.
    #[must_use]
    pub fn place(&self) -> Place {
        Place::from_xy(self.x_m, self.y_m)
    }
}

impl Region {
    /// Its places in their order, those from which nobody can shoot left out of a grid; of a file's, each must
    /// be one that somebody can shoot from.
    ///
    /// # Errors
    /// The number of a place of a file, from 0, and why nobody can shoot from it.
    pub fn spots(
        &self,
        league: League,
        physics: &Physics,
    ) -> Result<Vec<Spot>, (usize, PlaceError)> {
        let court = league.court();
        let spot = |(x_m, y_m): (f64, f64)| Spot { x_m, y_m };
        let can = |spot: &Spot| spot.place().check(physics).is_ok();
        Ok(match self {
            Self::HalfCourt {
                step_m,
                inside_three,
            } => {
                let y = (-court.half_width_m, court.half_width_m);
                grid(*step_m, (court.baseline_x_m, court.half_line_x_m), y)
                    .filter(|&(x, y)| !inside_three || court.is_inside_three(x, y))
                    .map(spot)
                    .filter(can)
                    .collect()
            }
            Self::Rectangle { step_m, x_m, y_m } => {
                grid(*step_m, *x_m, *y_m).map(spot).filter(can).collect()
            }
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
                    .map(spot)
                    .filter(can)
                    .collect()
            }
            Self::ThreePointLine { step_m } => {
                let along = court.along_three(*step_m);
                along.into_iter().map(spot).filter(can).collect()
            }
            Self::Places(places) => {
                let spots: Vec<Spot> = places.iter().copied().map(spot).collect();
                for (row, spot) in spots.iter().enumerate() {
                    spot.place().check(physics).map_err(|error| (row, error))?;
                }
                spots
            }
        })
    }

    /// About how many places there are, before any is made.
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
            Self::Places(places) => places.len() as f64,
        }
    }
}

/// The multiples of a step within a range, ends included.
fn multiples(step: f64, (low, high): (f64, f64)) -> impl Iterator<Item = f64> + Clone {
    let slack = 1e-9;
    let first = (low / step - slack).ceil() as i64;
    let last = (high / step + slack).floor() as i64;
    (first..=last).map(move |i| i as f64 * step)
}

fn grid(step: f64, x: (f64, f64), y: (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    multiples(step, x).flat_map(move |x| multiples(step, y).map(move |y| (x, y)))
}
