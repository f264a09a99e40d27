//! The arithmetic and logical operators of the SIMD types, written once.

/// Implements `+ - * /` (with the type itself and, except `/`, with `f64`), `+= -= *=` and unary
/// minus for a tuple struct of numbers (`narrow number` if its fields take `f32`), and `& | !` for
/// a tuple struct of masks, field by field.
macro_rules! elementwise_operators {
    (number [$($generics:tt)*] $type:ty { $($field:tt)+ }) => {
        $crate::math::arithmetic_operators::elementwise_operators!(@number [$($generics)*] $type { $($field)+ } other => other);
    };
    (narrow number [$($generics:tt)*] $type:ty { $($field:tt)+ }) => {
        $crate::math::arithmetic_operators::elementwise_operators!(@number [$($generics)*] $type { $($field)+ } other => (other as f32));
    };
    (@number [$($generics:tt)*] $type:ty { $($field:tt)+ } $other:ident => $value:expr) => {
        $crate::math::arithmetic_operators::elementwise_operators!(@pair [$($generics)*] $type, Add, add, +, { $($field)+ });
        $crate::math::arithmetic_operators::elementwise_operators!(@pair [$($generics)*] $type, Sub, sub, -, { $($field)+ });
        $crate::math::arithmetic_operators::elementwise_operators!(@pair [$($generics)*] $type, Mul, mul, *, { $($field)+ });
        $crate::math::arithmetic_operators::elementwise_operators!(@pair [$($generics)*] $type, Div, div, /, { $($field)+ });
        $crate::math::arithmetic_operators::elementwise_operators!(@scalar [$($generics)*] $type, Add, add, +, { $($field)+ } $other => $value);
        $crate::math::arithmetic_operators::elementwise_operators!(@scalar [$($generics)*] $type, Sub, sub, -, { $($field)+ } $other => $value);
        $crate::math::arithmetic_operators::elementwise_operators!(@scalar [$($generics)*] $type, Mul, mul, *, { $($field)+ } $other => $value);
        $crate::math::arithmetic_operators::elementwise_operators!(@unary [$($generics)*] $type, Neg, neg, -, { $($field)+ });
        $crate::math::arithmetic_operators::elementwise_operators!(@assign [$($generics)*] $type, AddAssign, add_assign, +);
        $crate::math::arithmetic_operators::elementwise_operators!(@assign [$($generics)*] $type, SubAssign, sub_assign, -);
        $crate::math::arithmetic_operators::elementwise_operators!(@assign [$($generics)*] $type, MulAssign, mul_assign, *);
    };
    (mask [$($generics:tt)*] $type:ty { $($field:tt)+ }) => {
        $crate::math::arithmetic_operators::elementwise_operators!(@pair [$($generics)*] $type, BitAnd, bitand, &, { $($field)+ });
        $crate::math::arithmetic_operators::elementwise_operators!(@pair [$($generics)*] $type, BitOr, bitor, |, { $($field)+ });
        $crate::math::arithmetic_operators::elementwise_operators!(@unary [$($generics)*] $type, Not, not, !, { $($field)+ });
    };
    (@pair [$($generics:tt)*] $type:ty, $trait:ident, $method:ident, $operator:tt, { $($field:tt)+ }) => {
        impl<$($generics)*> std::ops::$trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self($(self.$field $operator other.$field),+)
            }
        }
    };
    (@scalar [$($generics:tt)*] $type:ty, $trait:ident, $method:ident, $operator:tt, { $($field:tt)+ } $other:ident => $value:expr) => {
        impl<$($generics)*> std::ops::$trait<f64> for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, $other: f64) -> Self {
                Self($(self.$field $operator $value),+)
            }
        }
    };
    (@assign [$($generics:tt)*] $type:ty, $trait:ident, $method:ident, $operator:tt) => {
        impl<$($generics)*> std::ops::$trait for $type {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        }
    };
    (@unary [$($generics:tt)*] $type:ty, $trait:ident, $method:ident, $operator:tt, { $($field:tt)+ }) => {
        impl<$($generics)*> std::ops::$trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self) -> Self {
                Self($($operator self.$field),+)
            }
        }
    };
}

pub(super) use elementwise_operators;
