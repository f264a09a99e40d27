//! Numbers in the vector registers of the machine, however wide these are.

use super::arithmetic_operators::elementwise_operators;
use super::real::{LaneBits, Mask, Real, SimdReal};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x16, f64x8, mask32x16, mask64x8};

/// Eight double-precision numbers under the instruction set `S`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct F64x8<S: Simd>(f64x8<S>);

/// Sixteen single-precision numbers under the instruction set `S`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct F32x16<S: Simd>(f32x16<S>);

/// Eight truth values under the instruction set `S`.
#[derive(Clone, Copy)]
pub(crate) struct Mask8<S: Simd>(mask64x8<S>);

/// Sixteen truth values under the instruction set `S`.
#[derive(Clone, Copy)]
pub(crate) struct Mask16<S: Simd>(mask32x16<S>);

elementwise_operators!(number [S: Simd] F64x8<S> { 0 });
elementwise_operators!(narrow number [S: Simd] F32x16<S> { 0 });
elementwise_operators!(mask [S: Simd] Mask8<S> { 0 });
elementwise_operators!(mask [S: Simd] Mask16<S> { 0 });

/// Implements the traits of numbers for a register type.
macro_rules! simd_number {
    ($number:ident($register:ident, $element:ty, $lanes:literal), $mask:ident($mask_register:ident)) => {
        impl<S: Simd> PartialEq for $number<S> {
            /// Whether all lanes are equal.
            #[inline(always)]
            fn eq(&self, other: &Self) -> bool {
                self.0.simd_eq(other.0).all_true()
            }
        }

        impl<S: Simd> SimdReal for $number<S> {
            type Simd = S;
            type Element = $element;

            const LANES: usize = $lanes;

            #[inline(always)]
            fn broadcast(simd: S, value: f64) -> Self {
                Self($register::splat(simd, value as $element))
            }
            #[inline(always)]
            fn load(simd: S, values: &[$element]) -> Self {
                Self($register::from_slice(simd, &values[..Self::LANES]))
            }
            #[inline(always)]
            fn store(self, values: &mut [$element]) {
                self.0.store_slice(&mut values[..Self::LANES]);
            }
            #[inline(always)]
            fn mask_from_bits(simd: S, bits: LaneBits) -> $mask<S> {
                $mask($mask_register::from_bitmask(
                    simd,
                    u64::from(bits & Self::ALL),
                ))
            }
            #[inline(always)]
            fn mask_to_bits(mask: $mask<S>) -> LaneBits {
                mask.0.to_bitmask() as LaneBits
            }
        }

        impl<S: Simd> Mask for $mask<S> {
            #[inline(always)]
            fn any(self) -> bool {
                self.0.any_true()
            }
            #[inline(always)]
            fn all(self) -> bool {
                self.0.all_true()
            }
        }

        impl<S: Simd> Real for $number<S> {
            type Mask = $mask<S>;

            #[inline(always)]
            fn splat(self, value: f64) -> Self {
                Self($register::splat(self.0.simd, value as $element))
            }
            #[inline(always)]
            fn splat_mask(self, value: bool) -> $mask<S> {
                $mask($mask_register::splat(self.0.simd, value))
            }
            #[inline(always)]
            fn outlined<Value>(self, f: impl FnOnce() -> Value) -> Value {
                self.0.simd.vectorize(f)
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
            fn lt(self, other: Self) -> $mask<S> {
                $mask(self.0.simd_lt(other.0))
            }
            #[inline(always)]
            fn le(self, other: Self) -> $mask<S> {
                $mask(self.0.simd_le(other.0))
            }
            #[inline(always)]
            fn select(self, condition: $mask<S>, other: Self) -> Self {
                Self(condition.0.select(self.0, other.0))
            }
        }
    };
}

simd_number!(F64x8(f64x8, f64, 8), Mask8(mask64x8));
simd_number!(F32x16(f32x16, f32, 16), Mask16(mask32x16));
