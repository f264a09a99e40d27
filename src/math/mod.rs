//! Numbers, vectors and distributions: mathematics without physics.

mod arithmetic_operators;
pub mod evenly_spaced;
pub(crate) mod exponential;
pub mod normal_distribution;
pub(crate) mod real;
pub(crate) mod real_record;
pub(crate) mod scalar_f32;
pub(crate) mod simd;
pub mod sobol;
pub(crate) mod unrolled_simd;
pub mod vector;
