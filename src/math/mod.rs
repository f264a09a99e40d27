//! Numbers, vectors and distributions: mathematics without physics.

pub mod evenly_spaced;
pub mod normal_distribution;
mod operator_macro;
pub(crate) mod real;
pub(crate) mod simd;
pub(crate) mod single_precision;
pub mod sobol;
pub(crate) mod unrolled_simd;
pub mod vector;
