//! Eight numbers side by side, on whatever vector registers the machine has.

use super::{Bits, Lane, Mask, Packed};
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x8, mask64x8};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Eight numbers under the instruction set `S`.
#[derive(Clone, Copy)]
pub(crate) struct Pack<S: Simd>(f64x8<S>);

/// Eight truth values under the instruction set `S`.
#[derive(Clone, Copy)]
pub(crate) struct PackMask<S: Simd>(mask64x8<S>);

impl<S: Simd> Packed for Pack<S> {
    type Simd = S;

    const WIDTH: usize = 8;

    #[inline(always)]
    fn splat(simd: S, value: f64) -> Self {
        Self(f64x8::splat(simd, value))
    }
    #[inline(always)]
    fn load(simd: S, values: &[f64]) -> Self {
        Self(f64x8::from_slice(simd, &values[..Self::WIDTH]))
    }
    #[inline(always)]
    fn store(self, values: &mut [f64]) {
        self.0.store_slice(&mut values[..Self::WIDTH]);
    }
    #[inline(always)]
    fn mask_of(simd: S, bits: Bits) -> PackMask<S> {
        PackMask(mask64x8::from_bitmask(simd, u64::from(bits & Self::ALL)))
    }
    #[inline(always)]
    fn bits(mask: PackMask<S>) -> Bits {
        mask.0.to_bitmask() as Bits
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $sign:tt) => {
        impl<S: Simd> $trait for Pack<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        }
    };
    ($trait:ident, $method:ident, $sign:tt, scalar) => {
        impl<S: Simd> $trait<f64> for Pack<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self(self.0 $sign other)
            }
        }
    };
    ($trait:ident, $method:ident, $sign:tt, mask) => {
        impl<S: Simd> $trait for PackMask<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);
operator!(Add, add, +, scalar);
operator!(Sub, sub, -, scalar);
operator!(Mul, mul, *, scalar);
operator!(BitAnd, bitand, &, mask);
operator!(BitOr, bitor, |, mask);

impl<S: Simd> Neg for Pack<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<S: Simd> Not for PackMask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl<S: Simd> Mask for PackMask<S> {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.any_true()
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0.all_true()
    }
}

impl<S: Simd> Lane for Pack<S> {
    type Mask = PackMask<S>;

    #[inline(always)]
    fn lit(self, value: f64) -> Self {
        Self(f64x8::splat(self.0.simd, value))
    }
    #[inline(always)]
    fn mask(self, value: bool) -> PackMask<S> {
        PackMask(mask64x8::splat(self.0.simd, value))
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
    fn lt(self, other: Self) -> PackMask<S> {
        PackMask(self.0.simd_lt(other.0))
    }
    #[inline(always)]
    fn le(self, other: Self) -> PackMask<S> {
        PackMask(self.0.simd_le(other.0))
    }
    #[inline(always)]
    fn when(self, mask: PackMask<S>, other: Self) -> Self {
        Self(mask.0.select(self.0, other.0))
    }
}
