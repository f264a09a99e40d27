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

    /// Its name, such as `-y`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PlusX => "+x",
            Self::MinusX => "-x",
            Self::PlusY => "+y",
            Self::MinusY => "-y",
        }
    }

    /// The direction under which most of some points are in front of the hoop, the opposite one
    /// first. The points are along the court and across by this one.
    fn with_most_in_front(self, points: &[(f64, f64)]) -> Self {
        let (opposite, back) = match self {
            Self::PlusX => (Self::MinusX, Self::PlusX),
            Self::MinusX => (Self::PlusX, Self::MinusX),
            Self::PlusY => (Self::MinusY, Self::MinusY),
            Self::MinusY => (Self::PlusY, Self::PlusY),
        };
        let in_front = |direction: Self| {
            let along = points.iter().map(|(along, across)| {
                let (x, y) = back.turned(*along, *across);
                direction.turned(x, y).0
            });
            along.filter(|along| *along > 0.0).count()
        };
        let all = [Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY];
        let others = all
            .into_iter()
            .filter(|other| ![self, opposite].contains(other));
        others.fold(opposite, |best, other| {
            if in_front(other) > in_front(best) {
                other
            } else {
                best
            }
        })
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

    /// What is wrong if most shots begin behind the board. `places` are where they begin, in
    /// coordinates from the hoop.
    #[must_use]
    pub fn advice_behind_board(&self, places: &[(f64, f64)]) -> String {
        match self {
            Self::HoopAt(_, onto_court) => format!(
                "the shots begin behind the board if {} leads from the hoop onto the court; --hoop with {} has them in front of it",
                onto_court.name(),
                onto_court.with_most_in_front(places).name()
            ),
            _ => "the shots begin behind the board: for another origin or direction give --frame or --hoop, such as '7.2 m,12.45 m,-y'".to_owned(),
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
            assert_eq!(OntoCourt::named(onto_court.name()), Some(onto_court));
        }
    }

    /// Balls in front of a hoop, some of them far to its side, under the opposite direction.
    #[test]
    fn contract_the_direction_with_most_shots_in_front_is_named() {
        let balls = [(1.5, 5.0), (9.0, 4.5), (-4.0, 6.0)];
        for (wrong, right) in [("-y", "+y"), ("-x", "+x")] {
            let wrong = OntoCourt::named(wrong).unwrap();
            let balls = balls.map(|(x, y)| {
                if right == "+x" {
                    (y - 2.0, x + 2.0)
                } else {
                    (x, y)
                }
            });
            let places = CourtFrame::HoopAt([2.0, 4.0], wrong).from_hoop(&balls);
            assert!(places.iter().all(|(x, _)| *x < 0.0), "{places:?}");
            assert_eq!(wrong.with_most_in_front(&places).name(), right);
        }
    }
}
