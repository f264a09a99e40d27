//! The probability of making a shot (Eqs. 20-28 of the paper).
//!
//! [`Table`] holds, for one place, what every release of a grid leads to, summed over speed with the
//! weights of every nominal speed (Eq. 25, first axis); [`Table::probabilities`] applies the
//! remaining axes. the module `estimate` integrates one nominal shot with scrambled Sobol points drawn from
//! the normal, and the module `best` joins the two into Eq. 26.

pub mod best;
pub mod curves;
pub mod estimate;
pub mod grid;
pub mod lessons;
pub mod misses;
pub mod monte_carlo;
pub mod normal;
pub mod release_map;
pub mod sobol;
mod table;

pub use table::{BATCH_BYTES, Probabilities, Table};

/// Told how far a long computation has come.
pub trait Progress: Sync {
    /// A stage of `total` units of work (shots, rounds of a search, bytes) begins.
    fn begin(&self, stage: &str, total: u64);
    /// `units` more are done.
    fn advance(&self, units: u64);
    /// The stage is over.
    fn end(&self);
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _stage: &str, _total: u64) {}
    fn advance(&self, _shots: u64) {}
    fn end(&self) {}
}
