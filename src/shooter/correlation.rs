//! Correlations of the release errors.

use super::release_variable::ReleaseVariable;
use nalgebra::SMatrix;
use serde::{Serialize, Serializer};

const N: usize = ReleaseVariable::COUNT;

type Matrix = SMatrix<f64, N, N>;

/// A pivot below this counts as zero; below minus this, the matrix is not positive semi-definite.
const ZERO_PIVOT: f64 = 1e-10;

/// The correlation matrix of the errors, with the Cholesky factor that correlated errors are drawn
/// with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Symmetric, 1 on the diagonal.
    coefficients: Matrix,
    /// Lower triangular.
    factor: Matrix,
    /// Whether the factor is not that of independent errors.
    is_correlated: bool,
}

impl Default for Correlation {
    fn default() -> Self {
        Self::NONE
    }
}

impl Serialize for Correlation {
    /// The coefficients, row by row.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rows: Vec<Vec<f64>> = self
            .coefficients
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        rows.serialize(serializer)
    }
}

const fn identity() -> Matrix {
    let mut columns = [[0.0; N]; N];
    let mut i = 0;
    while i < N {
        columns[i][i] = 1.0;
        i += 1;
    }
    Matrix::from_array_storage(nalgebra::ArrayStorage(columns))
}

/// The matrix with these coefficients of pairs of variables.
fn matrix_of(pairs: &[(ReleaseVariable, ReleaseVariable, f64)]) -> Matrix {
    let mut matrix = identity();
    for &(a, b, value) in pairs {
        matrix[(a.index(), b.index())] = value;
        matrix[(b.index(), a.index())] = value;
    }
    matrix
}

impl Correlation {
    /// Independent errors.
    pub const NONE: Self = Self {
        coefficients: identity(),
        factor: identity(),
        is_correlated: false,
    };

    /// From the coefficients (-1 to 1) of pairs of variables. `None` if they are impossible
    /// together: the matrix is not positive semi-definite.
    #[must_use]
    pub fn new(pairs: &[(ReleaseVariable, ReleaseVariable, f64)]) -> Option<Self> {
        let coefficients = matrix_of(pairs);
        let factor = match coefficients.cholesky() {
            Some(cholesky) if smallest_pivot(&cholesky.l()) > ZERO_PIVOT => cholesky.unpack(),
            _ => semi_definite_factor(&coefficients)?,
        };
        Some(Self {
            coefficients,
            is_correlated: factor != identity(),
            factor,
        })
    }

    /// The least eigenvalue of the matrix of these pairs: negative if they are impossible together.
    #[must_use]
    pub fn least_eigenvalue(pairs: &[(ReleaseVariable, ReleaseVariable, f64)]) -> f64 {
        matrix_of(pairs).symmetric_eigenvalues().min()
    }

    /// The correlation of two variables, -1 to 1.
    #[must_use]
    pub fn coefficient(&self, a: ReleaseVariable, b: ReleaseVariable) -> f64 {
        self.coefficients[(a.index(), b.index())]
    }

    /// Correlated standard normals from independent ones.
    #[must_use]
    pub fn apply(&self, independent: [f64; N]) -> [f64; N] {
        if !self.is_correlated {
            return independent;
        }
        std::array::from_fn(|i| {
            (0..=i).fold(0.0, |sum, j| {
                let weight = self.factor[(i, j)];
                if weight == 0.0 {
                    sum
                } else {
                    sum + weight * independent[j]
                }
            })
        })
    }

    /// Independent normals from correlated ones: the inverse of [`Correlation::apply`]. Not numbers
    /// if a variable is fully determined by others.
    #[must_use]
    pub(crate) fn independent_of(&self, correlated: &[f64; N]) -> [f64; N] {
        if !self.is_correlated {
            return *correlated;
        }
        let mut independent = [0.0; N];
        for i in 0..N {
            let mut rest = correlated[i];
            for (j, known) in independent.iter().enumerate().take(i) {
                let weight = self.factor[(i, j)];
                if weight != 0.0 {
                    rest -= weight * known;
                }
            }
            independent[i] = rest / self.factor[(i, i)];
        }
        independent
    }

    /// Which independent normals matter, given the standard deviations of the errors.
    #[must_use]
    pub fn needed(&self, sigmas: &[f64; N]) -> [bool; N] {
        std::array::from_fn(|k| (k..N).any(|i| sigmas[i] > 0.0 && self.factor[(i, k)] != 0.0))
    }
}

fn smallest_pivot(factor: &Matrix) -> f64 {
    let diagonal = factor.diagonal();
    let least = diagonal.min();
    least * least
}

/// The lower triangular factor of a positive semi-definite matrix, with a zero column for each zero
/// pivot: correlations of exactly 1 or -1, which nalgebra's Cholesky decomposition refuses.
fn semi_definite_factor(matrix: &Matrix) -> Option<Matrix> {
    let mut factor = Matrix::zeros();
    for k in 0..N {
        let reduced = |i: usize, factor: &Matrix| {
            (0..k).fold(matrix[(i, k)], |rest, j| {
                rest - factor[(i, j)] * factor[(k, j)]
            })
        };
        let pivot = reduced(k, &factor);
        if !(pivot >= -ZERO_PIVOT) {
            return None;
        }
        for i in k..N {
            let rest = reduced(i, &factor);
            factor[(i, k)] = if pivot > ZERO_PIVOT && i == k {
                pivot.sqrt()
            } else if pivot > ZERO_PIVOT {
                rest / pivot.sqrt()
            } else if rest.abs() <= ZERO_PIVOT.sqrt() {
                0.0
            } else {
                return None;
            };
        }
    }
    Some(factor)
}

#[cfg(test)]
mod tests {
    use super::ReleaseVariable::{Backspin, CourtAngle, Height, Pitch, Polar, SideSpin, Speed};
    use super::*;

    #[test]
    fn prop_the_factor_gives_the_correlations_back() {
        let pairs = [
            (Speed, Pitch, -0.25),
            (Speed, Backspin, 0.5),
            (Polar, CourtAngle, 0.3),
            (SideSpin, Height, 1.0),
        ];
        for pairs in [&pairs[..3], &pairs[..]] {
            let correlation = Correlation::new(pairs).unwrap();
            let product = correlation.factor * correlation.factor.transpose();
            assert!((product - correlation.coefficients).abs().max() < 1e-9);
            assert_eq!(correlation.coefficient(Pitch, Speed), -0.25);
        }
    }

    #[test]
    fn contract_both_factors_of_a_definite_matrix_have_the_same_bits() {
        // So a draw does not depend on which of the two was used.
        let pairs = [
            (Speed, Pitch, -0.25),
            (Speed, Backspin, 0.5),
            (Pitch, Height, 0.7),
            (Polar, CourtAngle, 0.3),
        ];
        let matrix = matrix_of(&pairs);
        let library = matrix.cholesky().unwrap().unpack();
        assert_eq!(Some(library), semi_definite_factor(&matrix));
    }

    #[test]
    fn prop_impossible_correlations_are_refused() {
        // Two variables go with a third one, but against each other.
        let pairs = [
            (Speed, Pitch, 0.9),
            (Speed, Polar, 0.9),
            (Pitch, Polar, -0.9),
        ];
        assert_eq!(Correlation::new(&pairs), None);
        // The eigenvalues of [[1, r, r], [r, 1, -r], [r, -r, 1]] are 1 + r twice and 1 - 2 r.
        assert!((Correlation::least_eigenvalue(&pairs) - (1.0 - 2.0 * 0.9)).abs() < 1e-12);
        let equal = |third| {
            [
                (Speed, Pitch, 1.0),
                (Speed, Polar, 0.5),
                (Pitch, Polar, third),
            ]
        };
        assert!(Correlation::new(&equal(0.5)).is_some());
        assert_eq!(Correlation::new(&equal(0.4)), None);
    }
}
