//! Whether chains have converged, and what they are worth.
//!
//! Gelman et al., *Bayesian Data Analysis* (3rd edition, 2013), section 11.4; the autocorrelation
//! of an ensemble as in Foreman-Mackey et al., Publ. Astron. Soc. Pac. 125 (2013) 306.

/// The values of one parameter.
pub(super) struct ParameterChains {
    /// Walk by walk: those of the first chain's first walker, of its second, and so on.
    pub(super) values: Vec<f64>,
    pub(super) chains: usize,
    pub(super) steps: usize,
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

    /// The factor by which the spread could still shrink: halves of chains against all of them.
    pub(super) fn split_r_hat(&self) -> f64 {
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
    pub(super) fn effective_sample_size(&self) -> f64 {
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
}
