//! The probability of making a shot (Eqs. 20-28 of the paper).
//!
//! [`NominalTable`] gives P of all nominal shots of a plan from one table of shots (Eq. 25).
//! [`Sampler`] integrates one nominal shot with scrambled Sobol points. [`monte_carlo`] and
//! [`grid_integration`] are independent methods to check them against.
//!
//! An *unresolved* shot (the numerics gave up) counts neither as made nor as missed. P is the
//! number of made shots over that of all shots, and the interval of P is widened upwards by the
//! share of unresolved shots.

mod gaussian_cell_weights;
pub mod grid_integration;
mod made_shot_counts;
pub mod monte_carlo;
mod neighbourhood;
mod nominal_probability_table;
mod probability_and_error;
mod progress;
mod shared_sample;
mod sobol_integration;

pub(crate) use made_shot_counts::Counts;
pub(crate) use neighbourhood::Neighbourhood;
pub use nominal_probability_table::{
    MAX_BATCH_BYTES, NominalProbabilities, NominalTable, TABLE_RMS_ERROR,
};
pub use probability_and_error::{Estimate, MadeShares};
pub use progress::{Progress, Pulse, Silent};
pub(crate) use shared_sample::{MadeReleases, SharedSample};
pub use sobol_integration::{MAX_SHOTS, MIN_SHOTS, REPLICATES, Sampler};
