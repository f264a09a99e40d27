//! Release errors: standard deviations (Eq. 28 of the paper and five more) and their correlations.

use super::Nominal;
use serde::Serialize;

/// Number of the errors.
pub const ERRORS: usize = 9;
/// The nine errors of Eq. 23 in the order in which they are drawn: a profile gives the first four as
/// coefficients of Eq. 28, the others as standard deviations.
pub const ERROR_NAMES: [&str; ERRORS] = [
    "speed",
    "pitch",
    "polar",
    "backspin",
    "rifle_spin",
    "side_spin",
    "distance",
    "court_angle",
    "height",
];
/// Pivots of the correlation below this count as zero; below minus this it is no correlation.
const NO_PIVOT: f64 = 1e-10;

/// Standard deviations of the release errors as functions of the nominal values (Eq. 28).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// Speed: `c10 + c11 v + c12 v^2`; c10 in m/s.
    pub c10_m_s: f64,
    /// c11, a bare number.
    pub c11: f64,
    /// c12, s/m.
    pub c12_s_m: f64,
    /// Pitch angle, rad.
    pub c20_rad: f64,
    /// Polar angle, rad.
    pub c30_rad: f64,
    /// Backspin: `c40 + c41 w + c42 w^2`; c40 in rad/s.
    pub c40_rad_s: f64,
    /// c41, a bare number.
    pub c41: f64,
    /// c42, s/rad.
    pub c42_s_rad: f64,
    /// Spin about the level direction of the shot, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: f64,
    /// Distance from the hoop, m.
    pub distance_m: f64,
    /// Angle of the place on the court, rad.
    pub court_angle_rad: f64,
    /// Height of the release, m.
    pub height_m: f64,
    /// How the errors go together.
    pub correlation: Correlation,
}

impl Errors {
    /// Standard deviation of the speed at the nominal speed, m/s.
    #[must_use]
    pub fn speed_m_s(&self, nominal_m_s: f64) -> f64 {
        self.c10_m_s + self.c11 * nominal_m_s + self.c12_s_m * nominal_m_s * nominal_m_s
    }

    /// Standard deviation of the backspin at the nominal backspin, rad/s.
    #[must_use]
    pub fn backspin_rad_s(&self, nominal_rad_s: f64) -> f64 {
        self.c40_rad_s + self.c41 * nominal_rad_s + self.c42_s_rad * nominal_rad_s * nominal_rad_s
    }

    /// The standard deviations about a nominal shot, in the order of [`ERROR_NAMES`], SI units.
    #[must_use]
    pub fn sigmas(&self, nominal: &Nominal) -> [f64; ERRORS] {
        [
            self.speed_m_s(nominal.speed_m_s),
            self.c20_rad,
            self.c30_rad,
            self.backspin_rad_s(nominal.backspin_rad_s),
            self.rifle_spin_rad_s,
            self.side_spin_rad_s,
            self.distance_m,
            self.court_angle_rad,
            self.height_m,
        ]
    }

    /// Makes one error, by its place in [`ERROR_NAMES`], `times` as large.
    pub fn scale(&mut self, error: usize, times: f64) {
        match error {
            0 => {
                self.c10_m_s *= times;
                self.c11 *= times;
                self.c12_s_m *= times;
            }
            1 => self.c20_rad *= times,
            2 => self.c30_rad *= times,
            3 => {
                self.c40_rad_s *= times;
                self.c41 *= times;
                self.c42_s_rad *= times;
            }
            4 => self.rifle_spin_rad_s *= times,
            5 => self.side_spin_rad_s *= times,
            6 => self.distance_m *= times,
            7 => self.court_angle_rad *= times,
            _ => self.height_m *= times,
        }
    }

    /// Are the errors of a shot's mirror image those of the shot? Not where an error that changes sides goes
    /// with one that does not.
    #[must_use]
    pub fn mirror_alike(&self) -> bool {
        // Polar angle, rifle spin, side spin and court angle change sign in the mirror.
        let sides = |k: usize| matches!(k, 2 | 4 | 5 | 7);
        (0..ERRORS).all(|i| {
            (0..ERRORS).all(|j| sides(i) == sides(j) || self.correlation.coefficients[i][j] == 0.0)
        })
    }

    /// Are there only the four errors of Eq. 25, and independent?
    #[must_use]
    pub fn are_of_eq_25(&self) -> bool {
        let more = [
            self.rifle_spin_rad_s,
            self.side_spin_rad_s,
            self.distance_m,
            self.court_angle_rad,
            self.height_m,
        ];
        more.iter().all(|&sigma| sigma == 0.0) && self.correlation == Correlation::NONE
    }
}

/// The correlations of the errors, with the factor by which correlated errors are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Correlation {
    /// The coefficients, symmetric, 1 on the diagonal; -1 to 1.
    pub coefficients: [[f64; ERRORS]; ERRORS],
    #[serde(skip)]
    factor: [[f64; ERRORS]; ERRORS],
}

impl Default for Correlation {
    fn default() -> Self {
        Self::NONE
    }
}

const fn unit_matrix() -> [[f64; ERRORS]; ERRORS] {
    let mut matrix = [[0.0; ERRORS]; ERRORS];
    let mut i = 0;
    while i < ERRORS {
        matrix[i][i] = 1.0;
        i += 1;
    }
    matrix
}

impl Correlation {
    /// Independent errors.
    pub const NONE: Self = Self {
        coefficients: unit_matrix(),
        factor: unit_matrix(),
    };

    /// From the coefficients of pairs of errors (by their places in [`ERROR_NAMES`]); none where they are
    /// impossible together, that is, where the matrix is not positive semi-definite.
    #[must_use]
    pub fn new(pairs: &[(usize, usize, f64)]) -> Option<Self> {
        let mut coefficients = unit_matrix();
        for &(i, j, value) in pairs {
            coefficients[i][j] = value;
            coefficients[j][i] = value;
        }
        let factor = factor(&coefficients)?;
        Some(Self {
            coefficients,
            factor,
        })
    }

    /// The least eigenvalue of the matrix of these pairs: negative where they are impossible together.
    #[must_use]
    pub fn least_eigenvalue(pairs: &[(usize, usize, f64)]) -> f64 {
        let mut matrix = nalgebra::SMatrix::<f64, ERRORS, ERRORS>::identity();
        for &(i, j, value) in pairs {
            matrix[(i, j)] = value;
            matrix[(j, i)] = value;
        }
        matrix.symmetric_eigenvalues().min()
    }

    /// Correlated standard normals from independent ones.
    #[must_use]
    pub fn apply(&self, independent: [f64; ERRORS]) -> [f64; ERRORS] {
        std::array::from_fn(|i| {
            let row = &self.factor[i][..=i];
            row.iter()
                .zip(&independent)
                .fold(0.0, |sum, (&weight, &normal)| {
                    if weight == 0.0 {
                        sum
                    } else {
                        sum + weight * normal
                    }
                })
        })
    }

    /// Which independent normals count, given the standard deviations of the errors.
    #[must_use]
    pub fn needed(&self, sigmas: &[f64; ERRORS]) -> [bool; ERRORS] {
        std::array::from_fn(|k| (k..ERRORS).any(|i| sigmas[i] > 0.0 && self.factor[i][k] != 0.0))
    }
}

/// The lower triangular factor of a positive semi-definite matrix (Cholesky), a zero column where a
/// pivot is zero.
fn factor(matrix: &[[f64; ERRORS]; ERRORS]) -> Option<[[f64; ERRORS]; ERRORS]> {
    let mut factor = [[0.0; ERRORS]; ERRORS];
    for k in 0..ERRORS {
        let inner = |i: usize, factor: &[[f64; ERRORS]; ERRORS]| {
            (0..k).fold(matrix[i][k], |rest, j| rest - factor[i][j] * factor[k][j])
        };
        let pivot = inner(k, &factor);
        if !(pivot >= -NO_PIVOT) {
            return None;
        }
        for i in k..ERRORS {
            let rest = inner(i, &factor);
            factor[i][k] = if pivot > NO_PIVOT {
                rest / pivot.sqrt()
            } else if rest.abs() <= NO_PIVOT.sqrt() {
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
    use super::*;

    #[test]
    fn prop_the_factor_gives_the_correlations_back() {
        let pairs = [(0, 1, -0.25), (0, 3, 0.5), (2, 7, 0.3), (5, 8, 1.0)];
        let correlation = Correlation::new(&pairs).unwrap();
        for i in 0..ERRORS {
            for j in 0..ERRORS {
                let product: f64 = (0..ERRORS)
                    .map(|k| correlation.factor[i][k] * correlation.factor[j][k])
                    .sum();
                assert!((product - correlation.coefficients[i][j]).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn prop_impossible_correlations_are_refused() {
        // Two that go with a third, but against each other.
        let pairs = [(0, 1, 0.9), (0, 2, 0.9), (1, 2, -0.9)];
        assert_eq!(Correlation::new(&pairs), None);
        // Of [[1, r, r], [r, 1, -r], [r, -r, 1]]: 1 + r twice and 1 - 2 r.
        assert!((Correlation::least_eigenvalue(&pairs) - (1.0 - 2.0 * 0.9)).abs() < 1e-12);
        assert!(Correlation::new(&[(0, 1, 1.0), (0, 2, 0.5), (1, 2, 0.5)]).is_some());
        assert_eq!(
            Correlation::new(&[(0, 1, 1.0), (0, 2, 0.5), (1, 2, 0.4)]),
            None
        );
    }
}
