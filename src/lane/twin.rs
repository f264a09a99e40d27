//! Two of a kind of lanes: two chains of operations that do not wait for one another.

use super::{Bits, Lane, Mask, Packed};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Twice as many numbers.
#[derive(Clone, Copy)]
pub(crate) struct Twin<L>(L, L);

/// Twice as many truth values.
#[derive(Clone, Copy)]
pub(crate) struct TwinMask<M>(M, M);

macro_rules! operator {
    ($trait:ident, $method:ident, $sign:tt) => {
        impl<L: Lane> $trait for Twin<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $sign other.0, self.1 $sign other.1)
            }
        }
    };
    ($trait:ident, $method:ident, $sign:tt, scalar) => {
        impl<L: Lane> $trait<f64> for Twin<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self(self.0 $sign other, self.1 $sign other)
            }
        }
    };
    ($trait:ident, $method:ident, $sign:tt, mask) => {
        impl<M: Mask> $trait for TwinMask<M> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $sign other.0, self.1 $sign other.1)
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

impl<L: Lane> Neg for Twin<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<M: Mask> Not for TwinMask<M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

impl<M: Mask> Mask for TwinMask<M> {
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }
    #[inline(always)]
    fn all(self) -> bool {
        (self.0 & self.1).all()
    }
}

impl<L: Lane> Lane for Twin<L> {
    type Mask = TwinMask<L::Mask>;

    #[inline(always)]
    fn lit(self, value: f64) -> Self {
        Self(self.0.lit(value), self.0.lit(value))
    }
    #[inline(always)]
    fn mask(self, value: bool) -> Self::Mask {
        TwinMask(self.0.mask(value), self.0.mask(value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        TwinMask(self.0.lt(other.0), self.1.lt(other.1))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        TwinMask(self.0.le(other.0), self.1.le(other.1))
    }
    #[inline(always)]
    fn when(self, mask: Self::Mask, other: Self) -> Self {
        Self(self.0.when(mask.0, other.0), self.1.when(mask.1, other.1))
    }
}

impl<L: Packed> Packed for Twin<L> {
    type Simd = L::Simd;

    const WIDTH: usize = 2 * L::WIDTH;

    #[inline(always)]
    fn splat(simd: L::Simd, value: f64) -> Self {
        Self(L::splat(simd, value), L::splat(simd, value))
    }
    #[inline(always)]
    fn load(simd: L::Simd, values: &[f64]) -> Self {
        Self(L::load(simd, values), L::load(simd, &values[L::WIDTH..]))
    }
    #[inline(always)]
    fn store(self, values: &mut [f64]) {
        self.0.store(values);
        self.1.store(&mut values[L::WIDTH..]);
    }
    #[inline(always)]
    fn mask_of(simd: L::Simd, bits: Bits) -> Self::Mask {
        TwinMask(L::mask_of(simd, bits), L::mask_of(simd, bits >> L::WIDTH))
    }
    #[inline(always)]
    fn bits(mask: Self::Mask) -> Bits {
        L::bits(mask.0) | L::bits(mask.1) << L::WIDTH
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::{Numbers, Pack};
    use fearless_simd::{Level, Simd};

    fn check<S: Simd>(simd: S) {
        type Wide<S> = Twin<Pack<S>>;
        let from = |f: &dyn Fn(f64) -> f64| -> Numbers { std::array::from_fn(|i| f(i as f64)) };
        let (a, b) = (from(&|i| i - 7.5), from(&|i| 3.0 / (i + 1.0)));
        let [x, y] = [&a, &b].map(|values| Wide::<S>::load(simd, values));
        let least = Wide::<S>::bits(x.lt(y));
        let mut found: Numbers = [0.0; 16];
        for (pack, f) in [
            (x + y, (|a, b| a + b) as fn(f64, f64) -> f64),
            (x - y, |a, b| a - b),
            (x * y, |a, b| a * b),
            (x / y, |a, b| a / b),
            (x.abs().sqrt(), |a, _| a.abs().sqrt()),
            (-x, |a, _| -a),
            (x.when(x.lt(y), y), |a, b| if a < b { a } else { b }),
            (x * 2.0 + 1.0 - 0.5, |a, _| a * 2.0 + 1.0 - 0.5),
        ] {
            pack.store(&mut found);
            for i in 0..16 {
                assert_eq!(found[i], f(a[i], b[i]));
            }
        }
        for bits in [0, 1, 0x8001, 0x00ff, 0xff00, Wide::<S>::ALL, least] {
            let mask = Wide::<S>::mask_of(simd, bits);
            assert_eq!(Wide::<S>::bits(mask), bits);
            assert_eq!(Wide::<S>::bits(!mask), !bits);
            assert_eq!((mask.any(), mask.all()), (bits != 0, bits == u16::MAX));
        }
        assert_eq!(
            least.count_ones() as usize,
            (0..16).filter(|&i| a[i] < b[i]).count()
        );
    }

    #[test]
    fn contract_sixteen_lanes_compute_as_one() {
        for level in [Level::baseline(), Level::new()] {
            fearless_simd::dispatch!(level, simd => check(simd));
        }
    }
}
