//! Numbers, vectors and distributions: mathematics without physics.

pub mod evenly_spaced;
pub mod normal_distribution;
mod operators;
pub(crate) mod real;
pub(crate) mod simd;
pub(crate) mod simd_pair;
pub mod sobol;
pub mod vector;
