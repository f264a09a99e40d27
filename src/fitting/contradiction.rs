//! Makes that contradict the measured shots.

use super::expected_makes::wilson_interval;
use super::fit_note::FitNote;
use super::interval::Interval;

/// Makes that contradict the measured shots: nothing that rests on these is to be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction {
    /// Shots that went in.
    pub made: usize,
    /// Shots with a result.
    pub shots: usize,
    /// Shots that the measured releases predict to go in.
    pub expected: f64,
}

impl Contradiction {
    /// That of a whole fit, from its notes and the number of its shots with a result.
    #[must_use]
    pub fn of_fit(notes: &[FitNote], shots: usize) -> Option<Self> {
        notes.iter().find_map(|note| match note {
            FitNote::OtherMakes { made, expected, .. } => Some(Self {
                made: *made,
                shots,
                expected: *expected,
            }),
            _ => None,
        })
    }

    /// That of a place, from P of the current shot there: 3 standard errors or more, which about
    /// 1 of 400 places has by luck.
    #[must_use]
    pub fn of_place((made, shots): (usize, usize), p: &Interval) -> Option<Self> {
        const MOST_STANDARD_ERRORS: f64 = 3.0;
        let count = wilson_interval(made, shots);
        let error = libm::hypot(0.25 * (count.high - count.low), p.sd);
        let differs = libm::fabs(count.share - p.mean) >= MOST_STANDARD_ERRORS * error;
        (shots > 0 && differs).then_some(Self {
            made,
            shots,
            expected: p.mean * shots as f64,
        })
    }
}
