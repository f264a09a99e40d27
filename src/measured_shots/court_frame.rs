//! The coordinates of a tracking system.

use crate::units::FOOT_M;

/// Where the hoop is in the coordinates of a tracking system, and how they lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CourtFrame {
    /// x from the hoop's centre along the court, y across.
    Hoop,
    /// The corner of a court of 94 by 50 ft: x along it, y across; either hoop.
    Court94By50,
    /// A hoop at a point, with the court on the side of greater x (1) or smaller x (-1), m.
    HoopAt(f64, f64, f64),
}

/// Distance of a hoop's centre from the end of a court of 94 by 50 ft, and half its width, m.
const FROM_END_M: f64 = 5.25 * FOOT_M;
const HALF_WIDTH_M: f64 = 25.0 * FOOT_M;
const COURT_LENGTH_M: f64 = 94.0 * FOOT_M;

impl CourtFrame {
    /// The frame of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "hoop" => Some(Self::Hoop),
            "court_94x50" => Some(Self::Court94By50),
            _ => None,
        }
    }

    /// Points on the floor in coordinates from the hoop that the track ends near: along the court
    /// and across.
    #[must_use]
    pub fn from_hoop(&self, track: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let (x0, y0, sign) = match *self {
            Self::Hoop => (0.0, 0.0, 1.0),
            Self::HoopAt(x, y, sign) => (x, y, sign),
            Self::Court94By50 => {
                let ends_left = track.last().is_none_or(|(x, _)| *x < 0.5 * COURT_LENGTH_M);
                if ends_left {
                    (FROM_END_M, HALF_WIDTH_M, 1.0)
                } else {
                    (COURT_LENGTH_M - FROM_END_M, HALF_WIDTH_M, -1.0)
                }
            }
        };
        // Turned by half a turn for the other hoop, so that left and right stay.
        track
            .iter()
            .map(|(x, y)| (sign * (x - x0), sign * (y - y0)))
            .collect()
    }
}
