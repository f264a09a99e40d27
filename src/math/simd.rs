//! Eight numbers in the vector registers of the machine, however wide these are.

use super::operator_macro::elementwise_operators;
use super::real::{LaneBits, Mask, Real, SimdReal};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x8, mask64x8};

/// Eight numbers under the instruction set `S`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct F64x8<S: Simd>(f64x8<S>);

/// Eight truth values under the instruction set `S`.
#[derive(Clone, Copy)]
pub(crate) struct Mask8<S: Simd>(mask64x8<S>);

elementwise_operators!(number [S: Simd] F64x8<S> { 0 });
elementwise_operators!(mask [S: Simd] Mask8<S> { 0 });

impl<S: Simd> PartialEq for F64x8<S> {
    /// Whether all lanes are equal.
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.0.simd_eq(other.0).all_true()
    }
}

impl<S: Simd> SimdReal for F64x8<S> {
    type Simd = S;

    const LANES: usize = 8;

    #[inline(always)]
    fn broadcast(simd: S, value: f64) -> Self {
        Self(f64x8::splat(simd, value))
    }
    #[inline(always)]
    fn load(simd: S, values: &[f64]) -> Self {
        Self(f64x8::from_slice(simd, &values[..Self::LANES]))
    }
    #[inline(always)]
    fn store(self, values: &mut [f64]) {
        self.0.store_slice(&mut values[..Self::LANES]);
    }
    #[inline(always)]
    fn mask_from_bits(simd: S, bits: LaneBits) -> Mask8<S> {
        Mask8(mask64x8::from_bitmask(simd, u64::from(bits & Self::ALL)))
    }
    #[inline(always)]
    fn mask_to_bits(mask: Mask8<S>) -> LaneBits {
        mask.0.to_bitmask() as LaneBits
    }
}

impl<S: Simd> Mask for Mask8<S> {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.any_true()
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0.all_true()
    }
}

impl<S: Simd> Real for F64x8<S> {
    type Mask = Mask8<S>;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self(f64x8::splat(self.0.simd, value))
    }
    #[inline(always)]
    fn splat_mask(self, value: bool) -> Mask8<S> {
        Mask8(mask64x8::splat(self.0.simd, value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8<S> {
        Mask8(self.0.simd_lt(other.0))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask8<S> {
        Mask8(self.0.simd_le(other.0))
    }
    #[inline(always)]
    fn select(self, condition: Mask8<S>, other: Self) -> Self {
        Self(condition.0.select(self.0, other.0))
    }
}
