//! Numbers, vectors and distributions: mathematics without physics.

mod arithmetic_operators;
pub mod evenly_spaced;
pub mod normal_distribution;
pub(crate) mod real;
pub(crate) mod simd;
pub(crate) mod single_precision;
pub mod sobol;
pub(crate) mod unrolled_simd;
pub mod vector;
