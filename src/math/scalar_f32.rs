//! One single-precision number as a [`Real`].

use super::arithmetic_operators::elementwise_operators;
use super::real::{Real, ScalarReal};

/// One single-precision number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct F32(f32);

elementwise_operators!(narrow number [] F32 { 0 });

impl Real for F32 {
    type Mask = bool;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self(value as f32)
    }
    #[inline(always)]
    fn splat_mask(self, value: bool) -> bool {
        value
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
    fn lt(self, other: Self) -> bool {
        self.0 < other.0
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self.0 <= other.0
    }
    #[inline(always)]
    fn select(self, condition: bool, other: Self) -> Self {
        if condition { self } else { other }
    }
}

impl ScalarReal for F32 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self(value as f32)
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self.0)
    }
}
