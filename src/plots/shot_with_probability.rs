//! A nominal shot with its probability, as plots show it.

use crate::best_shot::{BestShots, ShotKind};
use crate::shooter::Nominal;

/// A nominal shot with its probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlottedShot {
    /// Direct or bank.
    pub kind: ShotKind,
    /// The nominal shot.
    pub nominal: Nominal,
    /// P of the shot.
    pub probability: f64,
    /// Standard error of P.
    pub standard_error: f64,
}

impl PlottedShot {
    /// The best shots of a location, without the kinds that have none.
    #[must_use]
    pub fn of_best(best: &BestShots) -> Vec<Self> {
        best.by_kind()
            .into_iter()
            .filter_map(|(kind, shot)| {
                let shot = shot.as_ref().ok()?;
                Some(Self {
                    kind,
                    nominal: shot.nominal,
                    probability: shot.estimate.probability,
                    standard_error: shot.estimate.standard_error,
                })
            })
            .collect()
    }
}
