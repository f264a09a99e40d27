//! Evenly spaced values: cells of an axis, and points with both ends included.

use serde::Serialize;

/// An axis divided into cells of equal width.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CellAxis {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Number of cells.
    pub count: usize,
}

impl CellAxis {
    /// Width of a cell.
    #[must_use]
    pub fn step(&self) -> f64 {
        (self.high - self.low) / self.count as f64
    }

    /// The value in cell `i`, at the fraction `offset` (0 to 1) of the cell from its lower end.
    #[must_use]
    pub fn value(&self, i: usize, offset: f64) -> f64 {
        self.low + (i as f64 + offset) * self.step()
    }

    /// One value in each cell, at the fraction `offset` (0 to 1) of the cell from its lower end.
    pub fn values(&self, offset: f64) -> impl Iterator<Item = f64> + Clone + use<> {
        let axis = *self;
        (0..axis.count).map(move |i| axis.value(i, offset))
    }
}

/// Evenly spaced points, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Linspace {
    /// The first point.
    pub low: f64,
    /// The last point.
    pub high: f64,
    /// Number of points; one if both ends are the same.
    pub count: usize,
}

impl Linspace {
    /// `count` points from `low` to `high`: at least two if these differ, one if they are the same.
    #[must_use]
    pub fn new(low: f64, high: f64, count: usize) -> Self {
        let count = if low < high { count.max(2) } else { 1 };
        Self { low, high, count }
    }

    /// A single point.
    #[must_use]
    pub fn single(value: f64) -> Self {
        Self::new(value, value, 1)
    }

    /// Distance between two points; 0 of a single one.
    #[must_use]
    pub fn step(&self) -> f64 {
        (self.high - self.low) / self.count.saturating_sub(1).max(1) as f64
    }

    /// The points in order.
    pub fn values(&self) -> impl Iterator<Item = f64> + Clone + use<> {
        let Self { low, count, .. } = *self;
        let step = self.step();
        (0..count).map(move |i| low + i as f64 * step)
    }
}
