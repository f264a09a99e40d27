//! Two SIMD numbers side by side: two chains of operations that do not wait for each other.

use super::arithmetic_operators::elementwise_operators;
use super::real::{LaneBits, Mask, Real, SimdReal};

/// Twice as many lanes as `T`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unrolled<T>(T, T);

/// Twice as many truth values as `M`.
#[derive(Clone, Copy)]
pub(crate) struct UnrolledMask<M>(M, M);

elementwise_operators!(number [T: Real] Unrolled<T> { 0 1 });
elementwise_operators!(mask [M: Mask] UnrolledMask<M> { 0 1 });

impl<M: Mask> Mask for UnrolledMask<M> {
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }
    #[inline(always)]
    fn all(self) -> bool {
        (self.0 & self.1).all()
    }
}

impl<T: Real> Real for Unrolled<T> {
    type Mask = UnrolledMask<T::Mask>;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self(self.0.splat(value), self.0.splat(value))
    }
    #[inline(always)]
    fn splat_mask(self, value: bool) -> Self::Mask {
        UnrolledMask(self.0.splat_mask(value), self.0.splat_mask(value))
    }
    #[inline(always)]
    fn outlined<Value>(self, f: impl FnOnce() -> Value) -> Value {
        self.0.outlined(f)
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
        UnrolledMask(self.0.lt(other.0), self.1.lt(other.1))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        UnrolledMask(self.0.le(other.0), self.1.le(other.1))
    }
    #[inline(always)]
    fn select(self, condition: Self::Mask, other: Self) -> Self {
        Self(
            self.0.select(condition.0, other.0),
            self.1.select(condition.1, other.1),
        )
    }
}

impl<T: SimdReal> SimdReal for Unrolled<T> {
    type Simd = T::Simd;
    type Element = T::Element;

    const LANES: usize = 2 * T::LANES;

    #[inline(always)]
    fn broadcast(simd: T::Simd, value: f64) -> Self {
        Self(T::broadcast(simd, value), T::broadcast(simd, value))
    }
    #[inline(always)]
    fn load(simd: T::Simd, values: &[T::Element]) -> Self {
        Self(T::load(simd, values), T::load(simd, &values[T::LANES..]))
    }
    #[inline(always)]
    fn store(self, values: &mut [T::Element]) {
        self.0.store(values);
        self.1.store(&mut values[T::LANES..]);
    }
    #[inline(always)]
    fn mask_from_bits(simd: T::Simd, bits: LaneBits) -> Self::Mask {
        UnrolledMask(
            T::mask_from_bits(simd, bits),
            T::mask_from_bits(simd, bits >> T::LANES),
        )
    }
    #[inline(always)]
    fn mask_to_bits(mask: Self::Mask) -> LaneBits {
        T::mask_to_bits(mask.0) | T::mask_to_bits(mask.1) << T::LANES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::real::MAX_F64_LANES;
    use crate::math::simd::F64x8;
    use fearless_simd::{Level, Simd};

    fn check<S: Simd>(simd: S) {
        type Wide<S> = Unrolled<F64x8<S>>;
        let from = |f: &dyn Fn(f64) -> f64| -> [f64; MAX_F64_LANES] {
            std::array::from_fn(|i| f(i as f64))
        };
        let (a, b) = (from(&|i| i - 7.5), from(&|i| 3.0 / (i + 1.0)));
        let [x, y] = [&a, &b].map(|values| Wide::<S>::load(simd, values));
        let less = Wide::<S>::mask_to_bits(x.lt(y));
        let mut found: [f64; MAX_F64_LANES] = [0.0; 16];
        for (result, f) in [
            (x + y, (|a, b| a + b) as fn(f64, f64) -> f64),
            (x - y, |a, b| a - b),
            (x * y, |a, b| a * b),
            (x / y, |a, b| a / b),
            (x.abs().sqrt(), |a, _| a.abs().sqrt()),
            (-x, |a, _| -a),
            (x.select(x.lt(y), y), |a, b| if a < b { a } else { b }),
            (x * 2.0 + 1.0 - 0.5, |a, _| a * 2.0 + 1.0 - 0.5),
        ] {
            result.store(&mut found);
            for i in 0..16 {
                assert_eq!(found[i], f(a[i], b[i]));
            }
        }
        for bits in [0, 1, 0x8001, 0x00ff, 0xff00, Wide::<S>::ALL, less] {
            let mask = Wide::<S>::mask_from_bits(simd, bits);
            assert_eq!(Wide::<S>::mask_to_bits(mask), bits);
            assert_eq!(Wide::<S>::mask_to_bits(!mask), Wide::<S>::ALL & !bits);
            assert_eq!(
                (mask.any(), mask.all()),
                (bits != 0, bits == Wide::<S>::ALL)
            );
        }
        assert_eq!(
            less.count_ones() as usize,
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
