//! One number or several side by side.
//!
//! The equations of motion are written once, over [`Lane`]. With `f64` they are the readable scalar
//! form; with a vector type the same operations run on several shots at a time. Only operations that
//! IEEE 754 rounds exactly (`+ - * /`, square root, comparisons) are in the trait and nothing is
//! fused, so every width gives the same bits.

mod twin;
mod vector;

pub(crate) use twin::Twin;
pub(crate) use vector::Pack;

use fearless_simd::Simd;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Truth values of a comparison, one per lane.
pub trait Mask:
    Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> + Sized
{
    /// True where any lane is true.
    fn any(self) -> bool;
    /// True where every lane is true.
    fn all(self) -> bool;
}

/// A number (`f64`), or several of them computed side by side.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Sized
{
    /// The truth values that comparisons give.
    type Mask: Mask;

    /// `value` in every lane. (`self` only says which kind of lane is wanted.)
    fn lit(self, value: f64) -> Self;
    /// `value` in every lane of a mask.
    fn mask(self, value: bool) -> Self::Mask;
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// `self < other`, lane by lane.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`, lane by lane.
    fn le(self, other: Self) -> Self::Mask;
    /// `self` where `mask` holds, `other` elsewhere.
    fn when(self, mask: Self::Mask, other: Self) -> Self;

    /// `self > other`, lane by lane.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// The smaller of two numbers; `other` where either is NaN.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.when(self.lt(other), other)
    }
    /// The larger of two numbers; `other` where either is NaN.
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.when(other.lt(self), other)
    }
    /// `self` times itself.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
}

/// As many bits as there may be lanes; lane `i` is bit `i`.
pub(crate) type Bits = u16;

/// Room for as many numbers as there may be lanes.
pub(crate) type Numbers = [f64; Bits::BITS as usize];

/// Lanes of a vector instruction set, to be filled from memory.
pub(crate) trait Packed: Lane {
    /// The instruction set.
    type Simd: Simd;

    /// The number of lanes.
    const WIDTH: usize;
    /// Every lane's bit.
    const ALL: Bits = Bits::MAX >> (Bits::BITS as usize - Self::WIDTH);

    /// `value` in every lane.
    fn splat(simd: Self::Simd, value: f64) -> Self;
    /// The first numbers of `values`.
    fn load(simd: Self::Simd, values: &[f64]) -> Self;
    /// Writes the first numbers of `values`.
    fn store(self, values: &mut [f64]);
    /// The truth values that `bits` holds.
    fn mask_of(simd: Self::Simd, bits: Bits) -> Self::Mask;
    /// Truth values as bits.
    fn bits(mask: Self::Mask) -> Bits;
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
}

impl Lane for f64 {
    type Mask = bool;

    #[inline(always)]
    fn lit(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn mask(self, value: bool) -> bool {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn when(self, mask: bool, other: Self) -> Self {
        if mask { self } else { other }
    }
}
