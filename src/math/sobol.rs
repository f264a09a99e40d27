//! Sobol points under random linear scrambles and digital shifts.
//!
//! Direction numbers: S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635-2654, DOI
//! 10.1137/070709359 (set new-joe-kuo-6), the first nine dimensions. Scrambling: J. Matousek, J.
//! Complexity 14 (1998) 527-556, DOI 10.1006/jcom.1998.0489: a random lower triangular matrix of
//! bits and a shift per dimension. Every point is uniform, and the variance of a mean is that of
//! Owen's nested scrambling (Owen, ACM TOMACS 13 (2003) 363-378, DOI 10.1145/945511.945518). Point
//! `i` is computed without the points before it. So any sample can be computed alone, and no result
//! depends on the number of threads.

use rand::rngs::ChaCha12Rng;
use rand::{Rng, SeedableRng};

/// Available dimensions.
const DIMENSIONS: usize = 9;

/// Degree, coefficients and first direction numbers of dimensions 2 to 9.
const PRIMITIVE: [(u32, u32, &[u32]); DIMENSIONS - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
];

/// The direction numbers of each dimension, one for each bit of the index.
#[derive(Clone, Debug)]
pub struct Sobol {
    directions: [[u32; 32]; DIMENSIONS],
}

impl Default for Sobol {
    fn default() -> Self {
        Self::new()
    }
}

impl Sobol {
    /// Computes the direction numbers.
    #[must_use]
    pub fn new() -> Self {
        let mut directions = [[0; 32]; DIMENSIONS];
        directions[0] = std::array::from_fn(|bit| 1 << (31 - bit));
        for (v, (degree, coefficients, first)) in directions[1..].iter_mut().zip(PRIMITIVE) {
            let s = degree as usize;
            for bit in 0..32 {
                v[bit] = if bit < s {
                    first[bit] << (31 - bit)
                } else {
                    let mut value = v[bit - s] ^ (v[bit - s] >> s);
                    for k in 1..s {
                        if coefficients >> (s - 1 - k) & 1 == 1 {
                            value ^= v[bit - k];
                        }
                    }
                    value
                };
            }
        }
        Self { directions }
    }

    /// One scramble of the points.
    #[must_use]
    pub fn scrambled(&self, key: ScrambleKey) -> Scramble {
        let mut random = ChaCha12Rng::seed_from_u64(key.seed);
        random.set_stream(key.replicate);
        let mut scramble = Scramble {
            directions: self.directions,
            prefixes: [[0; 32]; DIMENSIONS],
            shifts: [0; DIMENSIONS],
        };
        for (directions, shift) in scramble.directions.iter_mut().zip(&mut scramble.shifts) {
            // Row r of the matrix: any bits above (more significant than) bit r, and bit r itself.
            let rows: [u32; 32] = std::array::from_fn(|r| {
                let diagonal = 1 << (31 - r);
                (random.next_u32() & !(diagonal | (diagonal - 1))) | diagonal
            });
            for direction in directions {
                *direction = rows.iter().fold(0, |bits, row| {
                    bits << 1 | (row & *direction).count_ones() & 1
                });
            }
            *shift = random.next_u32();
        }
        let pairs = scramble.prefixes.iter_mut().zip(&scramble.directions);
        for (prefixes, directions) in pairs {
            let mut all = 0;
            for (prefix, direction) in prefixes.iter_mut().zip(directions) {
                all ^= direction;
                *prefix = all;
            }
        }
        scramble
    }
}

/// The seed of a scramble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScrambleKey {
    /// The user's seed.
    pub seed: u64,
    /// Number of the replicate.
    pub replicate: u64,
}

/// One scramble of the Sobol points.
#[derive(Clone, Debug)]
pub struct Scramble {
    directions: [[u32; 32]; DIMENSIONS],
    /// For each direction, the exclusive or of all up to it.
    prefixes: [[u32; 32]; DIMENSIONS],
    shifts: [u32; DIMENSIONS],
}

/// The points of a scramble one after the other: each follows from the one before by one exclusive
/// or.
#[derive(Clone, Debug)]
pub(crate) struct Sequence<'a> {
    scramble: &'a Scramble,
    index: u32,
    bits: [u32; DIMENSIONS],
}

impl Sequence<'_> {
    /// A coordinate of the present point, as [`Scramble::point`].
    pub(crate) fn coordinate(&self, dimension: usize) -> f64 {
        as_fraction(self.bits[dimension] ^ self.scramble.shifts[dimension])
    }

    /// Goes on to the next point.
    pub(crate) fn advance(&mut self) {
        self.index = self.index.wrapping_add(1);
        // From i to i + 1 the last zero bit and the ones after it change.
        let last_changed = self.index.trailing_zeros() as usize & 31;
        for (bits, prefixes) in self.bits.iter_mut().zip(&self.scramble.prefixes) {
            *bits ^= prefixes[last_changed];
        }
    }
}

impl Scramble {
    /// The points from number `index` on.
    pub(crate) fn sequence(&self, index: u32) -> Sequence<'_> {
        Sequence {
            scramble: self,
            index,
            bits: std::array::from_fn(|k| fraction(&self.directions[k], index)),
        }
    }

    /// Coordinate `dimension` of point `index`, above 0 and below 1.
    #[must_use]
    pub fn point(&self, index: u32, dimension: usize) -> f64 {
        let bits = fraction(&self.directions[dimension], index) ^ self.shifts[dimension];
        as_fraction(bits)
    }
}

/// 32 bits as a number above 0 and below 1.
fn as_fraction(bits: u32) -> f64 {
    (f64::from(bits) + 0.5) / 4_294_967_296.0
}

/// A coordinate of point `index` as a 32-bit fraction.
fn fraction(directions: &[u32; 32], index: u32) -> u32 {
    let mut value = 0;
    let mut bits = index;
    while bits != 0 {
        value ^= directions[bits.trailing_zeros() as usize];
        bits &= bits - 1;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: ScrambleKey = ScrambleKey {
        seed: 7,
        replicate: 3,
    };

    #[test]
    fn prop_every_dimension_is_a_net_in_base_2_before_and_after_scrambling() {
        let sobol = Sobol::new();
        let scramble = sobol.scrambled(KEY);
        for dimension in 0..DIMENSIONS {
            for m in [4_u32, 8, 10] {
                let mut plain = vec![0; 1 << m];
                let mut scrambled = vec![0; 1 << m];
                for i in 0..1 << m {
                    plain[(fraction(&sobol.directions[dimension], i) >> (32 - m)) as usize] += 1;
                    let cell = scramble.point(i, dimension) * f64::from(1 << m);
                    scrambled[cell as usize] += 1;
                }
                assert!(
                    plain.iter().chain(&scrambled).all(|&n| n == 1),
                    "{dimension} {m}"
                );
            }
        }
    }

    #[test]
    fn prop_a_sequence_has_the_points_of_the_scramble() {
        let scramble = Sobol::new().scrambled(KEY);
        for start in [0, 1, 1000, (1 << 21) - 3] {
            let mut sequence = scramble.sequence(start);
            for index in start..start + 70 {
                for dimension in 0..DIMENSIONS {
                    let coordinate = sequence.coordinate(dimension);
                    assert_eq!(coordinate, scramble.point(index, dimension), "{index}");
                }
                sequence.advance();
            }
        }
    }

    #[test]
    fn prop_replicates_are_uniform_and_uncorrelated() {
        // Over 4000 replicates: mean 1/2 of each point, and no correlation between two points or
        // two dimensions; each within 5 standard errors (false alarm: 18 comparisons, 1e-5).
        let sobol = Sobol::new();
        let n = 4000;
        let points: Vec<[f64; 3]> = (0..n)
            .map(|replicate| {
                let scramble = sobol.scrambled(ScrambleKey { seed: 1, replicate });
                [
                    scramble.point(5, 0) - 0.5,
                    scramble.point(5, 3) - 0.5,
                    scramble.point(6, 8) - 0.5,
                ]
            })
            .collect();
        let count = n as f64;
        for i in 0..3 {
            let mean = points.iter().map(|p| p[i]).sum::<f64>() / count;
            assert!(mean.abs() < 5.0 * (1.0 / 12.0 / count).sqrt(), "{i} {mean}");
            for j in 0..i {
                let both = points.iter().map(|p| p[i] * p[j]).sum::<f64>() / count;
                assert!(both.abs() < 5.0 / 12.0 / count.sqrt(), "{i} {j} {both}");
            }
        }
    }

    #[test]
    fn val_first_points_of_joe_and_kuo() {
        // Points 1 to 3 of the published sequence in the first three dimensions.
        let sobol = Sobol::new();
        let coordinate = |i, d: usize| fraction(&sobol.directions[d], i);
        let point = |i| [0, 1, 2].map(|d| f64::from(coordinate(i, d)) / 4_294_967_296.0);
        assert_eq!(point(1), [0.5, 0.5, 0.5]);
        assert_eq!(point(2), [0.25, 0.75, 0.75]);
        assert_eq!(point(3), [0.75, 0.25, 0.25]);
    }
}
