//! Vectors: nalgebra's, over any `Real`.
//!
//! nalgebra's operators and constructors serve the SIMD lanes as they are. Its products and norms
//! ask for a zero without a value at hand, which a SIMD number cannot give. [`RealVector`] has
//! those under the same names, and for `f64` they have the same bits.

use super::real::Real;

/// A vector of three components, along x, y and z unless its name says otherwise.
pub type Vec3<T> = nalgebra::Vector3<T>;

/// A vector of two components.
pub type Vec2<T> = nalgebra::Vector2<T>;

/// Products and norms of vectors over any `Real`.
pub trait RealVector<T: Real>: Copy {
    /// `value` in every component.
    fn splat(value: T) -> Self;
    /// Scalar product.
    fn dot(self, other: Self) -> T;
    /// `self + other * factor`, rounded after each operation.
    #[must_use]
    fn add_scaled(self, other: Self, factor: T) -> Self;
    /// `self` where `condition` holds, `other` elsewhere.
    #[must_use]
    fn select(self, condition: T::Mask, other: Self) -> Self;

    /// Square of the length.
    #[inline(always)]
    fn norm_squared(self) -> T {
        self.dot(self)
    }
    /// Length.
    #[inline(always)]
    fn norm(self) -> T {
        self.norm_squared().sqrt()
    }
}

impl<T: Real> RealVector<T> for Vec3<T> {
    #[inline(always)]
    fn splat(value: T) -> Self {
        Self::new(value, value, value)
    }
    #[inline(always)]
    fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
    #[inline(always)]
    fn add_scaled(self, other: Self, factor: T) -> Self {
        self + other * factor
    }
    #[inline(always)]
    fn select(self, condition: T::Mask, other: Self) -> Self {
        Self::new(
            self.x.select(condition, other.x),
            self.y.select(condition, other.y),
            self.z.select(condition, other.z),
        )
    }
}

impl<T: Real> RealVector<T> for Vec2<T> {
    #[inline(always)]
    fn splat(value: T) -> Self {
        Self::new(value, value)
    }
    #[inline(always)]
    fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y
    }
    #[inline(always)]
    fn add_scaled(self, other: Self, factor: T) -> Self {
        self + other * factor
    }
    #[inline(always)]
    fn select(self, condition: T::Mask, other: Self) -> Self {
        Self::new(
            self.x.select(condition, other.x),
            self.y.select(condition, other.y),
        )
    }
}
