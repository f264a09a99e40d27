//! The coordinates of a tracking system.

use crate::units::FOOT_M;

/// Where the hoop is in the coordinates of a tracking system, and how they lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CourtFrame {
    /// x from the hoop's centre along the court, y across.
    Hoop,
    /// The corner of a court of 94 by 50 ft: x along it, y across; either hoop.
    Court94By50,
    /// A hoop at a point (m), and the direction that leads from it onto the court.
    HoopAt([f64; 2], OntoCourt),
}

/// The axis of a tracking system that leads from the hoop onto the court.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OntoCourt {
    /// Greater x.
    PlusX,
    /// Smaller x.
    MinusX,
    /// Greater y.
    PlusY,
    /// Smaller y.
    MinusY,
}

impl OntoCourt {
    /// The direction of a name such as `-y`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "+x" => Some(Self::PlusX),
            "-x" => Some(Self::MinusX),
            "+y" => Some(Self::PlusY),
            "-y" => Some(Self::MinusY),
            _ => None,
        }
    }

    /// A point along the court and across: turned about the vertical, so that left and right stay.
    fn turned(self, x: f64, y: f64) -> (f64, f64) {
        match self {
            Self::PlusX => (x, y),
            Self::MinusX => (-x, -y),
            Self::PlusY => (y, -x),
            Self::MinusY => (-y, x),
        }
    }
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
        let ([x0, y0], onto_court) = match *self {
            Self::Hoop => ([0.0, 0.0], OntoCourt::PlusX),
            Self::HoopAt(hoop, onto_court) => (hoop, onto_court),
            Self::Court94By50 => {
                let ends_left = track.last().is_none_or(|(x, _)| *x < 0.5 * COURT_LENGTH_M);
                if ends_left {
                    ([FROM_END_M, HALF_WIDTH_M], OntoCourt::PlusX)
                } else {
                    let hoop = [COURT_LENGTH_M - FROM_END_M, HALF_WIDTH_M];
                    (hoop, OntoCourt::MinusX)
                }
            }
        };
        track
            .iter()
            .map(|(x, y)| onto_court.turned(x - x0, y - y0))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball a metre in front of the hoop and half a metre to the right of who looks at it, in
    /// four systems that are turned about the vertical.
    #[test]
    fn contract_turned_coordinates_keep_left_and_right() {
        for (onto_court, ball) in [
            (OntoCourt::PlusX, (3.0, 4.5)),
            (OntoCourt::PlusY, (1.5, 5.0)),
            (OntoCourt::MinusX, (1.0, 3.5)),
            (OntoCourt::MinusY, (2.5, 3.0)),
        ] {
            let frame = CourtFrame::HoopAt([2.0, 4.0], onto_court);
            assert_eq!(frame.from_hoop(&[ball]), [(1.0, 0.5)], "{onto_court:?}");
        }
    }
}
