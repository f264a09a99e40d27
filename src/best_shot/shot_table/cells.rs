//! The cells of a table between its nodes.

use super::interpolation_check::PARTS;
use crate::shooter::Location;

/// The rectangle between neighbouring nodes: its ranges of distance, m, and court angle, rad. With
/// one angle the second has no width.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub(super) distance_m: [f64; 2],
    pub(super) angle_rad: [f64; 2],
}

impl Cell {
    /// What tells it from others.
    pub(super) fn key(&self) -> [u64; 4] {
        let [near, far] = self.distance_m.map(f64::to_bits);
        let [low, high] = self.angle_rad.map(f64::to_bits);
        [near, far, low, high]
    }

    fn place(&self, along: f64, across: f64) -> Location {
        let between = |[low, high]: [f64; 2], part: f64| low + part * (high - low);
        Location {
            distance_m: between(self.distance_m, along),
            angle_rad: between(self.angle_rad, across),
        }
    }

    pub(super) fn middle(&self) -> Location {
        self.place(0.5, 0.5)
    }

    /// The places where interpolation is checked; the middle is among them.
    pub(super) fn checked_places(&self) -> Vec<Location> {
        let one_angle = self.angle_rad[0] == self.angle_rad[1];
        let across: &[f64] = if one_angle { &[0.5] } else { &PARTS };
        let places = |&across: &f64| PARTS.map(|along| self.place(along, across));
        across.iter().flat_map(places).collect()
    }

    pub(super) fn corners(&self) -> Vec<Location> {
        grid(&self.distance_m, &self.angle_rad)
    }
}

/// All pairs, angle by angle.
pub(super) fn grid(distances_m: &[f64], angles_rad: &[f64]) -> Vec<Location> {
    let line = |&angle_rad: &f64| {
        distances_m.iter().map(move |&distance_m| Location {
            distance_m,
            angle_rad,
        })
    };
    angles_rad.iter().flat_map(line).collect()
}
