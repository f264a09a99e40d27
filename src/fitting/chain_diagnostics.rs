//! Whether chains have converged, and what they are worth.
//!
//! R-hat of normal scores, and effective sample sizes of the middle and of the tails (Vehtari et
//! al., Bayesian Anal. 16 (2021) 667); the autocorrelation of an ensemble as in Foreman-Mackey et
//! al., Publ. Astron. Soc. Pac. 125 (2013) 306. A chain is an ensemble: its walkers depend on each
//! other.

use crate::math::normal_distribution::quantile;

/// The values of one parameter.
pub(super) struct ParameterChains {
    /// Walk by walk: those of the first chain's first walker, of its second, and so on.
    pub(super) values: Vec<f64>,
    pub(super) chains: usize,
    pub(super) steps: usize,
}

/// How far chains have converged: the worst of their parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Convergence {
    /// The greater R-hat of the values and of their distances from the median.
    pub(super) r_hat: f64,
    /// Independent draws that know the middle as well.
    pub(super) bulk_size: f64,
    /// Independent draws that know the 5 % and the 95 % quantile as well, the worse of the two.
    pub(super) tail_size: f64,
}

impl Convergence {
    /// That of no parameter.
    pub(super) const PERFECT: Self = Self {
        r_hat: 1.0,
        bulk_size: f64::INFINITY,
        tail_size: f64::INFINITY,
    };

    pub(super) fn worse(self, other: Self) -> Self {
        Self {
            r_hat: self.r_hat.max(other.r_hat),
            bulk_size: self.bulk_size.min(other.bulk_size),
            tail_size: self.tail_size.min(other.tail_size),
        }
    }
}

/// The tails are beyond this quantile and its opposite.
const TAIL: f64 = 0.05;

/// The indices of values in ascending order.
fn ascending(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|a, b| values[*a].total_cmp(&values[*b]).then(a.cmp(b)));
    order
}

/// The normal quantiles of the ranks; equal values share the mean of theirs.
fn normal_scores(values: &[f64], order: &[usize]) -> Vec<f64> {
    let count = values.len() as f64;
    let mut scores = vec![0.0; values.len()];
    let mut before = 0;
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = before as f64 + 0.5 * (equal.len() as f64 + 1.0);
        before += equal.len();
        let score = quantile((rank - 0.375) / (count + 0.25));
        for index in equal {
            scores[*index] = score;
        }
    }
    scores
}

/// Autocorrelations are summed up to this many times their sum.
const WINDOW: f64 = 5.0;

/// The sum of products, in eight partial sums that do not wait for each other.
fn product_sum(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest = a.remainder().iter().zip(b.remainder());
    let mut sums = [0.0; 8];
    for (a, b) in a.zip(b) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + rest.map(|(a, b)| a * b).sum::<f64>()
}

impl ParameterChains {
    fn walkers(&self) -> usize {
        self.values.len() / (self.chains * self.steps)
    }

    fn mean_and_variance(&self, chain: usize, steps: &std::ops::Range<usize>) -> (f64, f64) {
        let of_chain = self.walkers() * self.steps;
        let walks = self.values[chain * of_chain..(chain + 1) * of_chain].chunks(self.steps);
        let count = (steps.len() * self.walkers()) as f64;
        let values = || walks.clone().flat_map(|walk| &walk[steps.clone()]);
        let mean = values().sum::<f64>() / count;
        let squares: f64 = values().map(|x| (x - mean) * (x - mean)).sum();
        (mean, squares / (count - 1.0))
    }

    fn of(&self, values: Vec<f64>) -> Self {
        Self {
            values,
            chains: self.chains,
            steps: self.steps,
        }
    }

    /// How far the chains have converged.
    pub(super) fn convergence(&self) -> Convergence {
        let order = ascending(&self.values);
        let at = |share: f64| self.values[order[(share * (order.len() - 1) as f64) as usize]];
        let scores = self.of(normal_scores(&self.values, &order));
        let median = at(0.5);
        let folded: Vec<f64> = self.values.iter().map(|x| (x - median).abs()).collect();
        let of_scale = self.of(normal_scores(&folded, &ascending(&folded)));
        let (low, high) = (at(TAIL), at(1.0 - TAIL));
        let beyond = |is_beyond: &dyn Fn(f64) -> bool| {
            let indicators = self
                .values
                .iter()
                .map(|x| f64::from(u8::from(is_beyond(*x))));
            self.of(indicators.collect()).effective_sample_size()
        };
        Convergence {
            r_hat: scores.split_r_hat().max(of_scale.split_r_hat()),
            bulk_size: scores.effective_sample_size(),
            tail_size: beyond(&|x| x <= low).min(beyond(&|x| x >= high)),
        }
    }

    /// The factor by which the spread could still shrink: halves of chains against all of them.
    fn split_r_hat(&self) -> f64 {
        let half = self.steps / 2;
        let parts: Vec<(f64, f64)> = (0..self.chains)
            .flat_map(|chain| [(chain, 0..half), (chain, half..2 * half)])
            .map(|(chain, steps)| self.mean_and_variance(chain, &steps))
            .collect();
        let count = parts.len() as f64;
        let mean = parts.iter().map(|(mean, _)| mean).sum::<f64>() / count;
        let between = parts
            .iter()
            .map(|(part, _)| (part - mean) * (part - mean))
            .sum::<f64>()
            / (count - 1.0);
        let within = parts.iter().map(|(_, variance)| variance).sum::<f64>() / count;
        if within > 0.0 {
            ((within + between) / within).sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// The number of independent draws that know the mean as well.
    fn effective_sample_size(&self) -> f64 {
        let (mut mean, mut variance) = (0.0, 0.0);
        for chain in 0..self.chains {
            let (m, v) = self.mean_and_variance(chain, &(0..self.steps));
            mean += m / self.chains as f64;
            variance += v / self.chains as f64;
        }
        let walks = (self.chains * self.walkers()) as f64;
        let centred: Vec<f64> = self.values.iter().map(|x| x - mean).collect();
        let correlation = |lag: usize| {
            let products = centred
                .chunks(self.steps)
                .map(|walk| product_sum(&walk[lag..], &walk[..walk.len() - lag]));
            products.sum::<f64>() / (walks * (self.steps - lag) as f64 * variance)
        };
        let mut time = 1.0;
        for lag in 1..self.steps / 2 {
            time += 2.0 * correlation(lag);
            if lag as f64 >= WINDOW * time {
                break;
            }
        }
        walks * self.steps as f64 / time.max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha12Rng;
    use rand::{RngExt, SeedableRng};

    /// Authority: an autoregressive process of order 1 has the autocorrelation time (1 + a)/(1 -
    /// a).
    #[test]
    fn val_effective_sample_size_of_an_autoregressive_process() {
        let (chains, steps, walkers) = (4, 2000, 8);
        for a in [0.0, 0.5, 0.9_f64] {
            let mut random = ChaCha12Rng::seed_from_u64(1);
            let mut values = vec![0.0; chains * steps * walkers];
            for walk in 0..chains * walkers {
                let mut x = 0.0;
                for step in 0..steps {
                    let uniform: f64 = random.random();
                    x = a * x + (1.0 - a * a).sqrt() * (uniform - 0.5);
                    values[walk * steps + step] = x;
                }
            }
            let parameter = ParameterChains {
                values: values.clone(),
                chains,
                steps,
            };
            let expected = (chains * steps * walkers) as f64 * (1.0 - a) / (1.0 + a);
            let found = parameter.effective_sample_size();
            assert!(
                (found / expected - 1.0).abs() < 0.15,
                "{a}: {found} {expected}"
            );
            assert!(parameter.split_r_hat() < 1.01);
            // One chain elsewhere.
            for value in &mut values[..steps * walkers] {
                *value += 1.0;
            }
            let parameter = ParameterChains {
                values,
                ..parameter
            };
            assert!(parameter.split_r_hat() > 1.1);
        }
    }

    /// Authority: of independent draws every quantile is known as well as by that number of draws,
    /// and R-hat is 1, whatever the distribution; chains of one mean and two widths are seen by
    /// the distances from the median alone. The seed is fixed.
    #[test]
    fn val_convergence_of_independent_draws_and_of_chains_of_two_widths() {
        let (chains, steps, walkers) = (4, 1000, 4);
        let mut random = ChaCha12Rng::seed_from_u64(2);
        // Without a mean: Cauchy's distribution.
        let mut draw = || libm::tan(std::f64::consts::PI * (random.random::<f64>() - 0.5));
        let values: Vec<f64> = (0..chains * steps * walkers).map(|_| draw()).collect();
        let count = values.len() as f64;
        let parameter = ParameterChains {
            values,
            chains,
            steps,
        };
        let found = parameter.convergence();
        assert!(found.r_hat < 1.005, "{found:?}");
        for size in [found.bulk_size, found.tail_size] {
            assert!((size / count - 1.0).abs() < 0.1, "{found:?}");
        }
        let mut values = parameter.values.clone();
        for value in &mut values[..2 * steps * walkers] {
            *value *= 3.0;
        }
        let wide = parameter.of(values);
        let order = ascending(&wide.values);
        let scores = wide.of(normal_scores(&wide.values, &order));
        assert!(scores.split_r_hat() < 1.01);
        assert!(wide.convergence().r_hat > 1.05);
    }
}
