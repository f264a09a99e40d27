//! Sobol points with Owen's nested uniform scrambling.
//!
//! Direction numbers: S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635-2654,
//! DOI 10.1137/070709359 (set new-joe-kuo-6), the first nine dimensions. Scrambling by a hash of
//! the reversed bits: B. Burley, J. Comput. Graph. Tech. 9 (2020) no. 4, with a seed per dimension
//! and replicate. Point `i` of a replicate is found without the points before it, so any sample can
//! be computed alone and the number of threads changes nothing.

/// Dimensions that are available.
pub const DIMENSIONS: usize = 9;
/// Points in one replicate at most.
pub const MOST_POINTS: u32 = 1 << 31;

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

/// The direction numbers, bit `b` of the index with its number.
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

    /// Coordinate `dimension` of point `index`, unscrambled, as a 32-bit fraction.
    fn fraction(&self, index: u32, dimension: usize) -> u32 {
        let mut value = 0;
        let mut bits = index;
        for direction in self.directions[dimension] {
            if bits == 0 {
                break;
            }
            if bits & 1 == 1 {
                value ^= direction;
            }
            bits >>= 1;
        }
        value
    }

    /// Coordinate `dimension` of point `index` under the scramble `key`, within 0 to 1 exclusive.
    #[must_use]
    pub fn point(&self, index: u32, dimension: usize, key: u64) -> f64 {
        let scrambled = owen(self.fraction(index, dimension), seed(key, dimension));
        (f64::from(scrambled) + 0.5) / 4_294_967_296.0
    }
}

/// A scramble's key from the user's seed and the number of the replicate.
#[must_use]
pub fn key(user_seed: u64, replicate: u64) -> u64 {
    mix(user_seed ^ mix(replicate.wrapping_add(0x9E37_79B9_7F4A_7C15)))
}

fn seed(key: u64, dimension: usize) -> u32 {
    (mix(key.wrapping_add(0xD1B5_4A32_D192_ED03_u64.wrapping_mul(dimension as u64 + 1))) >> 32)
        as u32
}

/// The finaliser of splitmix64.
fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

/// Nested uniform scrambling of a fraction's bits: each bit is flipped by a hash of those above it.
fn owen(fraction: u32, seed: u32) -> u32 {
    let mut x = fraction.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_every_dimension_is_a_net_in_base_2_before_and_after_scrambling() {
        let sobol = Sobol::new();
        for dimension in 0..DIMENSIONS {
            for m in [4_u32, 8, 10] {
                let mut plain = vec![0; 1 << m];
                let mut scrambled = vec![0; 1 << m];
                for i in 0..1 << m {
                    plain[(sobol.fraction(i, dimension) >> (32 - m)) as usize] += 1;
                    let cell = sobol.point(i, dimension, key(7, 3)) * f64::from(1 << m);
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
    fn val_first_points_of_joe_and_kuo() {
        // Points 1 to 3 of the published sequence in the first three dimensions.
        let sobol = Sobol::new();
        let point = |i| [0, 1, 2].map(|d| f64::from(sobol.fraction(i, d)) / 4_294_967_296.0);
        assert_eq!(point(1), [0.5, 0.5, 0.5]);
        assert_eq!(point(2), [0.25, 0.75, 0.75]);
        assert_eq!(point(3), [0.75, 0.25, 0.25]);
    }
}
