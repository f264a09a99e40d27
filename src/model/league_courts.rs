//! The floor lines of a basketball court, relative to the hoop's centre: x from the board towards
//! midcourt, y across.
//!
//! Sources: NCAA Men's Basketball Rules 2023-24, rule 1; NBA Official Rules 2023-24, rule 1; FIBA
//! Official Basketball Rules 2022, rule 2; NFHS Basketball Rules 2023-24, rule 1 (high schools of
//! the United States). Distances are to the outer edge of the lines.

use super::{Physics, Preset};
use crate::units::{FOOT_M, INCH_M};
use serde::Serialize;

/// The rule book that defines the court.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum League {
    /// Men's college basketball in the United States.
    Ncaa,
    /// The National Basketball Association.
    Nba,
    /// International basketball.
    Fiba,
    /// High schools of the United States.
    #[serde(rename = "high_school")]
    HighSchool,
}

impl League {
    /// All leagues.
    pub const ALL: [Self; 4] = [Self::Ncaa, Self::Nba, Self::Fiba, Self::HighSchool];

    /// `ncaa`, `nba`, `fiba` or `high_school`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ncaa => "ncaa",
            Self::Nba => "nba",
            Self::Fiba => "fiba",
            Self::HighSchool => "high_school",
        }
    }

    /// The court that goes with a ball and a hoop.
    #[must_use]
    pub fn of_physics(physics: &Physics) -> Self {
        match Preset::of(physics).map(|preset| preset.name) {
            Some("nba" | "wnba") => Self::Nba,
            Some("fiba" | "fiba_women") => Self::Fiba,
            Some("youth") => Self::HighSchool,
            _ => Self::Ncaa,
        }
    }

    /// x of the middle of the block: the mark at the lane between the first two players, m.
    #[must_use]
    pub fn block_x_m(self) -> f64 {
        match self {
            // 7 to 8 ft from the baseline.
            Self::Ncaa | Self::Nba | Self::HighSchool => self.court().baseline_x_m + 7.5 * FOOT_M,
            // The neutral zone, 2.6 to 3.0 m from the baseline.
            Self::Fiba => self.court().baseline_x_m + 2.8,
        }
    }

    /// The league with this name, if there is one.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|league| league.name() == name)
    }

    /// The lines of its court.
    #[must_use]
    pub fn court(self) -> Court {
        match self {
            Self::Ncaa => Court {
                half_width_m: 25.0 * FOOT_M,
                baseline_x_m: -5.25 * FOOT_M,
                half_line_x_m: 41.75 * FOOT_M,
                three_radius_m: 22.0 * FOOT_M + 1.75 * INCH_M,
                three_corner_y_m: 21.0 * FOOT_M + 7.875 * INCH_M,
                lane_half_width_m: 6.0 * FOOT_M,
                free_throw_x_m: 13.75 * FOOT_M,
                circle_radius_m: 6.0 * FOOT_M,
                restricted_radius_m: 4.0 * FOOT_M,
            },
            Self::Nba => Court {
                three_radius_m: 23.75 * FOOT_M,
                three_corner_y_m: 22.0 * FOOT_M,
                lane_half_width_m: 8.0 * FOOT_M,
                ..Self::Ncaa.court()
            },
            Self::HighSchool => Court {
                half_line_x_m: 36.75 * FOOT_M,
                three_radius_m: 19.75 * FOOT_M,
                three_corner_y_m: 19.75 * FOOT_M,
                ..Self::Ncaa.court()
            },
            Self::Fiba => Court {
                half_width_m: 7.5,
                baseline_x_m: -1.575,
                half_line_x_m: 14.0 - 1.575,
                three_radius_m: 6.75,
                three_corner_y_m: 6.6,
                lane_half_width_m: 2.45,
                free_throw_x_m: 5.8 - 1.575,
                circle_radius_m: 1.8,
                restricted_radius_m: 1.25,
            },
        }
    }
}

/// The lines of half a court, m.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Court {
    /// Distance of the sidelines from the middle.
    pub half_width_m: f64,
    /// x of the baseline.
    pub baseline_x_m: f64,
    /// x of the midcourt line.
    pub half_line_x_m: f64,
    /// Radius of the three-point arc.
    pub three_radius_m: f64,
    /// Distance of the straight three-point lines in the corners from the middle.
    pub three_corner_y_m: f64,
    /// Distance of the lane lines from the middle.
    pub lane_half_width_m: f64,
    /// x of the free-throw line.
    pub free_throw_x_m: f64,
    /// Radius of the circles at the free-throw line and at midcourt.
    pub circle_radius_m: f64,
    /// Radius of the restricted-area arc.
    pub restricted_radius_m: f64,
}

/// Tolerance for a location on a line, m.
const ON_LINE_M: f64 = 1e-9;

impl Court {
    /// x at which the straight three-point lines of the corners meet the arc, m.
    #[must_use]
    pub fn three_break_x_m(&self) -> f64 {
        (self.three_radius_m * self.three_radius_m - self.three_corner_y_m * self.three_corner_y_m)
            .sqrt()
    }

    /// Whether the location is on this half of the court, lines included.
    #[must_use]
    pub fn contains(&self, x_m: f64, y_m: f64) -> bool {
        x_m >= self.baseline_x_m - ON_LINE_M
            && x_m <= self.half_line_x_m + ON_LINE_M
            && y_m.abs() <= self.half_width_m + ON_LINE_M
    }

    /// Whether the location is on or inside the three-point line.
    #[must_use]
    pub fn is_inside_three(&self, x_m: f64, y_m: f64) -> bool {
        if !self.contains(x_m, y_m) || y_m.abs() > self.three_corner_y_m + ON_LINE_M {
            return false;
        }
        x_m <= self.three_break_x_m()
            || (x_m * x_m + y_m * y_m).sqrt() <= self.three_radius_m + ON_LINE_M
    }

    /// Locations along the three-point line from one corner to the other, `step_m` apart along the
    /// line and symmetric about its top: (x, y), m.
    #[must_use]
    pub fn along_three(&self, step_m: f64) -> Vec<(f64, f64)> {
        let (break_x, corner_y, radius) = (
            self.three_break_x_m(),
            self.three_corner_y_m,
            self.three_radius_m,
        );
        let half_arc = radius * libm::atan2(corner_y, break_x);
        let half = half_arc + break_x - self.baseline_x_m;
        let count = (half / step_m) as i64;
        (-count..=count)
            .map(|i| {
                let along = i as f64 * step_m;
                let side = along.signum();
                if along.abs() <= half_arc {
                    let (sin, cos) = libm::sincos(along / radius);
                    (radius * cos, radius * sin)
                } else {
                    (break_x - (along.abs() - half_arc), side * corner_y)
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_the_three_point_line_lies_on_itself() {
        for league in League::ALL {
            let court = league.court();
            let places = court.along_three(0.5);
            assert!(places.len() > 30);
            for &(x, y) in &places {
                assert!(court.is_inside_three(x, y), "{league:?} {x} {y}");
                let (far_x, far_y) = if x > court.three_break_x_m() {
                    (1.001 * x, 1.001 * y)
                } else {
                    (x, 1.001 * y)
                };
                assert!(!court.is_inside_three(far_x, far_y), "{league:?} {x} {y}");
            }
        }
    }

    #[test]
    fn val_corner_lines_of_the_rules() {
        // NCAA 2023-24: 3 ft 4 1/8 in from the sideline; FIBA 2022: 0.9 m; NBA 2023-24: 3 ft.
        let gap = |league: League| {
            let court = league.court();
            court.half_width_m - court.three_corner_y_m
        };
        assert!((gap(League::Ncaa) - 40.125 * INCH_M).abs() < 1e-9);
        assert!((gap(League::Nba) - 3.0 * FOOT_M).abs() < 1e-9);
        assert!((gap(League::Fiba) - 0.9).abs() < 1e-9);
    }
}
