//! At how many places of a sweep the bank shot is better than the direct one.

use super::job_list::Jobs;
use super::result_row::ResultRow;
use crate::analysis::sensitivity::Difference;
use crate::shooter::ShotKind;
use std::collections::BTreeMap;
use std::fmt;

/// A difference is significant if it exceeds this many of its standard errors.
pub const SIGNIFICANT_SIGMAS: f64 = 2.0;

/// Least difference in P that is worth a word: one shot in 100.
const LEAST_ADVISED_GAIN: f64 = 0.01;

/// `a` minus `b`, two independent estimates of P.
#[must_use]
pub fn difference(a: Difference, b: Difference) -> Difference {
    Difference {
        value: a.value - b.value,
        standard_error: libm::hypot(b.standard_error, a.standard_error),
    }
}

/// Whether a difference, positive or negative, is significant.
#[must_use]
pub fn is_significant(difference: Difference) -> bool {
    difference.value.abs() > SIGNIFICANT_SIGMAS * difference.standard_error
}

/// Whether a difference, positive or negative, is significant and worth a word. The one rule for
/// what is better, in texts, tables and outlines.
#[must_use]
pub fn is_advised(difference: Difference) -> bool {
    is_significant(difference) && difference.value.abs() >= LEAST_ADVISED_GAIN
}

/// The number of places at which the bank shot is better (see [`is_advised`]), of those with a shot
/// of each kind. Mirrored places count. Its text is one sentence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BankAdvantage {
    /// Places at which the bank shot is better.
    pub better: usize,
    /// Places with both a direct and a bank shot.
    pub compared: usize,
}

impl BankAdvantage {
    /// From the results of a sweep by job; `None` if no place has both kinds of shot.
    #[must_use]
    pub fn of(jobs: &Jobs, rows: &BTreeMap<u64, ResultRow>) -> Option<Self> {
        let index = |kind| jobs.kinds.iter().position(|&other| other == kind);
        let (direct, bank) = (index(ShotKind::Direct)?, index(ShotKind::Bank)?);
        let gains: Vec<Difference> = jobs
            .sources
            .iter()
            .filter_map(|source| {
                let at = |kind| rows.get(&jobs.number(source.computed, kind))?.probability();
                Some(difference(at(bank)?, at(direct)?))
            })
            .collect();
        let is_better = |gain: &&Difference| is_advised(**gain) && gain.value > 0.0;
        (!gains.is_empty()).then(|| Self {
            better: gains.iter().filter(is_better).count(),
            compared: gains.len(),
        })
    }
}

impl fmt::Display for BankAdvantage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "Bank is better at {} of {} places, by at least 1 per 100.",
            self.better, self.compared
        )
    }
}
