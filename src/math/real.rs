//! The number type of the equations: one `f64` or `f32`, or several in SIMD lanes.
//!
//! The equations of motion are written once, generic over [`Real`]. With `f64` they are the
//! readable scalar form. With a [`SimdReal`] the same operations run on several shots at once. The
//! trait has only operations that IEEE 754 rounds correctly (`+ - * /`, square root, comparisons),
//! and nothing is fused. So every lane count gives the same bits.

use fearless_simd::Simd;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// The truth values of a comparison, one for each lane.
pub trait Mask:
    Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> + Sized
{
    /// True if any lane is true.
    fn any(self) -> bool;
    /// True if every lane is true.
    fn all(self) -> bool;

    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    fn select(self, condition: Self, other: Self) -> Self {
        (condition & self) | (!condition & other)
    }
}

/// A real number (`f64`), or one in each SIMD lane.
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Sized
{
    /// The result of a comparison.
    type Mask: Mask;

    /// `value` in every lane. (`self` only supplies the instruction set.)
    fn splat(self, value: f64) -> Self;
    /// `value` in every lane of a mask. (`self` only supplies the instruction set.)
    fn splat_mask(self, value: bool) -> Self::Mask;
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `self` where `condition` holds, `other` elsewhere.
    fn select(self, condition: Self::Mask, other: Self) -> Self;

    /// The result of `f`, which is compiled for the instruction set of `self` in a function of its
    /// own. (A function that is not inlined is not compiled for the vector instructions of its
    /// caller; and one that is inlined in many places takes long to compile.)
    #[inline(always)]
    fn outlined<Value>(self, f: impl FnOnce() -> Value) -> Value {
        f()
    }

    /// Zero in every lane.
    #[inline(always)]
    fn zero(self) -> Self {
        self.splat(0.0)
    }
    /// One in every lane.
    #[inline(always)]
    fn one(self) -> Self {
        self.splat(1.0)
    }
    /// `self > 0`.
    #[inline(always)]
    fn is_positive(self) -> Self::Mask {
        self.zero().lt(self)
    }
    /// `self < 0`.
    #[inline(always)]
    fn is_negative(self) -> Self::Mask {
        self.lt(self.zero())
    }
    /// The smaller of two numbers; `other` if either is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.select(self.lt(other), other)
    }
    /// The larger of two numbers; `other` if either is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.select(other.lt(self), other)
    }
    /// The number, or zero if it is negative.
    #[inline(always)]
    fn positive_part(self) -> Self {
        Real::max(self, self.zero())
    }
    /// `self` times itself.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
}

/// One bit for each lane; lane `i` is bit `i`.
pub(crate) type LaneBits = u32;

/// Most lanes of `f64`, and of any number type.
pub(crate) const MAX_F64_LANES: usize = 16;
pub(crate) const MAX_LANES: usize = LaneBits::BITS as usize;

/// What a lane holds: `f64` or `f32`.
pub(crate) trait LaneElement: Copy + Default {
    /// Rounded to the nearest.
    fn from_f64(value: f64) -> Self;
    fn to_f64(self) -> f64;
}

impl LaneElement for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
}

impl LaneElement for f32 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value as Self
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

/// Numbers in the lanes of a vector instruction set.
pub(crate) trait SimdReal: Real {
    /// The instruction set.
    type Simd: Simd;
    /// What a lane holds.
    type Element: LaneElement;

    /// The number of lanes.
    const LANES: usize;
    /// The bits of all lanes.
    const ALL: LaneBits = LaneBits::MAX >> (LaneBits::BITS as usize - Self::LANES);

    /// `value` in every lane.
    fn broadcast(simd: Self::Simd, value: f64) -> Self;
    /// The first [`SimdReal::LANES`] numbers of `values`.
    fn load(simd: Self::Simd, values: &[Self::Element]) -> Self;
    /// Writes the first [`SimdReal::LANES`] numbers of `values`.
    fn store(self, values: &mut [Self::Element]);
    /// The mask with the given bits.
    fn mask_from_bits(simd: Self::Simd, bits: LaneBits) -> Self::Mask;
    /// The bits of a mask.
    fn mask_to_bits(mask: Self::Mask) -> LaneBits;
}

/// One number, for a single shot.
pub(crate) trait ScalarReal: Real<Mask = bool> {
    /// Rounded to the nearest.
    fn from_f64(value: f64) -> Self;
    fn to_f64(self) -> f64;
}

impl ScalarReal for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
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

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn splat_mask(self, value: bool) -> bool {
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
    fn select(self, condition: bool, other: Self) -> Self {
        if condition { self } else { other }
    }
}
