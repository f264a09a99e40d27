//! What a shooter should change, and how sure that is.

use super::draw_probabilities::{DrawProbabilities, WeightedShots};
use super::interval::Interval;
use super::measured_release::{VALUE_NAMES, Values, nominal_of, values_of};
use super::posterior::{Draw, Posterior, SpinSource};
use crate::analysis::sensitivity::SensitivityTopics;
use crate::best_shot::{BestShot, BestShotError, find_kinds};
use crate::probability::Progress;
use crate::shooter::{Profile, ShotKind};
use rayon::prelude::*;

/// Draws that advice is computed for, at most.
const DRAWS: usize = 400;
/// Shots of each sample: for the shots that are compared, and for the mixtures of usual and best
/// shot.
const SHOTS: usize = 32_768;
const MIXTURE_SHOTS: usize = 8_192;
/// The factor on a standard deviation for "10 % less scatter".
const TRAINED: f64 = 0.9;
/// The combinations of four causes.
const COMBINATIONS: usize = 16;

/// A part of the release that a shooter can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cause(pub usize);

impl Cause {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["speed", "pitch", "aim", "backspin"][self.0]
    }
}

/// How much of the gap between usual and best shot one cause makes.
#[derive(Clone, Debug)]
pub struct CauseOfGap {
    /// The cause.
    pub cause: Cause,
    /// The usual value (mean over the draws) and the best one, SI units.
    pub values: (f64, f64),
    /// Its share of the gap in P: the mean over all orders in which the causes can be removed
    /// (Shapley's value).
    pub gain: Interval,
}

/// What 10 % less scatter of one value gains.
#[derive(Clone, Debug)]
pub struct TrainingGain {
    /// The value.
    pub cause: Cause,
    /// The gain in P of the usual shot.
    pub gain: Interval,
}

/// The best bank shot against the best direct one.
#[derive(Clone, Debug)]
pub struct KindComparison {
    /// P of the best direct and of the best bank shot.
    pub probabilities: [Interval; 2],
    /// P of the bank shot less that of the direct one.
    pub difference: Interval,
    /// The share of the draws in which the bank shot is better.
    pub bank_is_better: f64,
}

/// The advice for one place.
#[derive(Clone, Debug)]
pub struct Advice {
    /// The kind of the usual shot; the best shot is of the same kind.
    pub kind: ShotKind,
    /// The usual release: means over the draws.
    pub usual: Values,
    /// The backspin was not measured; that of the population is assumed.
    pub backspin_is_assumed: bool,
    /// P of the usual shot.
    pub usual_probability: Interval,
    /// Its numerical standard error.
    pub numerical_standard_error: f64,
    /// The best release for the scatter of all draws together.
    pub best: Option<BestShot>,
    /// P of the best shot.
    pub best_probability: Option<Interval>,
    /// P of the best shot less that of the usual one, draw by draw.
    pub gain: Option<Interval>,
    /// The share of the draws in which the best shot is better.
    pub gain_is_positive: f64,
    /// The gap by cause, largest first.
    pub causes: Vec<CauseOfGap>,
    /// What to train, largest gain first.
    pub training: Vec<TrainingGain>,
    /// Bank or direct, where both can be made.
    pub kinds: Option<KindComparison>,
}

/// P of the usual shot at a place for each draw.
#[must_use]
pub fn usual_probabilities(
    profile: &Profile,
    posterior: &Posterior,
    place: usize,
    shots: usize,
) -> DrawProbabilities {
    let means: Vec<Values> = posterior
        .draws
        .iter()
        .map(|draw| draw.means[place])
        .collect();
    WeightedShots::simulate(
        profile,
        (&posterior.draws, place),
        &means,
        shots,
        profile.search().seed,
    )
    .probabilities(
        &posterior.draws,
        |draw| draw.means[place],
        |draw| draw.factors[place],
    )
}

/// Advice from the posterior at one of its places; `profile` is that of [`super::fitted_profile`]
/// there.
///
/// # Errors
/// No shot from there can go in, or the search would be too large.
pub fn advise(
    profile: &Profile,
    posterior: &Posterior,
    place: usize,
    progress: &dyn Progress,
) -> Result<Advice, BestShotError> {
    let typical = posterior.typical();
    let step = posterior.draws.len().div_ceil(DRAWS);
    let draws: Vec<Draw> = posterior.draws.iter().step_by(step).cloned().collect();
    let seed = profile.search().seed;
    let simulate = |means: &[Values], shots: usize| {
        WeightedShots::simulate(profile, (&draws, place), means, shots, seed)
    };
    let factor = |draw: &Draw| draw.factors[place];
    let usual_means: Vec<Values> = draws.iter().map(|draw| draw.means[place]).collect();
    let usual_shots = simulate(&usual_means, SHOTS);
    let usual_p = usual_shots.probabilities(&draws, |draw| draw.means[place], factor);
    let of_draw = |draw: &Draw| draw.means[place];
    let training = training_gains(&usual_shots, &usual_p, &draws, place);

    let usual = typical.means[place];
    let kind = ShotKind::of(profile, &nominal_of(&usual));
    let (_, found) = find_kinds(profile, &ShotKind::ALL, SensitivityTopics::NONE, progress)?;
    let best_of = |kind: ShotKind| found[kind as usize].as_ref().ok();
    let fixed = |best: &BestShot| {
        let values = values_of(&best.nominal);
        simulate(&[values], SHOTS).probabilities(&draws, |_| values, factor)
    };
    let by_kind: Vec<Option<DrawProbabilities>> = ShotKind::ALL
        .into_iter()
        .map(|kind| best_of(kind).map(fixed))
        .collect();
    let kinds = match &by_kind[..] {
        [Some(direct), Some(bank)] => {
            let difference = bank.minus(direct);
            Some(KindComparison {
                probabilities: [direct.interval(), bank.interval()],
                bank_is_better: share_positive(&difference),
                difference: difference.interval(),
            })
        }
        _ => None,
    };
    let best = best_of(kind);
    let gain = by_kind[kind as usize].as_ref().map(|p| p.minus(&usual_p));
    let causes = best.map_or_else(Vec::new, |best| {
        let target = values_of(&best.nominal);
        let mixtures: Vec<DrawProbabilities> = (0..COMBINATIONS)
            .into_par_iter()
            .map(|changed| {
                let mixed = |draw: &Draw| mixture(&of_draw(draw), &target, changed);
                let means: Vec<Values> = draws.iter().map(mixed).collect();
                simulate(&means, MIXTURE_SHOTS).probabilities(&draws, mixed, factor)
            })
            .collect();
        causes_of_gap(&mixtures, &usual, &target)
    });
    Ok(Advice {
        kind,
        usual,
        backspin_is_assumed: posterior.spin == SpinSource::Assumed,
        usual_probability: usual_p.interval(),
        numerical_standard_error: usual_p.numerical_standard_error(),
        best_probability: by_kind[kind as usize]
            .as_ref()
            .map(DrawProbabilities::interval),
        gain_is_positive: gain.as_ref().map_or(0.0, share_positive),
        gain: gain.as_ref().map(DrawProbabilities::interval),
        best: best.cloned(),
        causes,
        training,
        kinds,
    })
}

fn share_positive(differences: &DrawProbabilities) -> f64 {
    let positive = differences.of_draws.iter().filter(|d| **d > 0.0).count();
    positive as f64 / differences.of_draws.len() as f64
}

/// The usual values with those of the bits of `changed` replaced by the best ones.
fn mixture(usual: &Values, best: &Values, changed: usize) -> Values {
    std::array::from_fn(|i| {
        if changed >> i & 1 == 1 {
            best[i]
        } else {
            usual[i]
        }
    })
}

/// Shapley's values of the four causes.
fn causes_of_gap(mixtures: &[DrawProbabilities], usual: &Values, best: &Values) -> Vec<CauseOfGap> {
    // |S|! (3 - |S|)! / 4! for a set S of other causes.
    const WEIGHTS: [f64; 4] = [0.25, 1.0 / 12.0, 1.0 / 12.0, 0.25];
    let mut causes: Vec<CauseOfGap> = (0..VALUE_NAMES.len())
        .map(|i| {
            let mut terms = Vec::new();
            for others in (0..COMBINATIONS).filter(|set| set >> i & 1 == 0) {
                let weight = WEIGHTS[others.count_ones() as usize];
                terms.push((weight, &mixtures[others | 1 << i]));
                terms.push((-weight, &mixtures[others]));
            }
            CauseOfGap {
                cause: Cause(i),
                values: (usual[i], best[i]),
                gain: DrawProbabilities::combination(&terms).interval(),
            }
        })
        .collect();
    causes.sort_by(|a, b| b.gain.mean.total_cmp(&a.gain.mean));
    causes
}

fn training_gains(
    shots: &WeightedShots,
    usual: &DrawProbabilities,
    draws: &[Draw],
    place: usize,
) -> Vec<TrainingGain> {
    let mut gains: Vec<TrainingGain> = (0..VALUE_NAMES.len())
        .map(|i| {
            let trained = shots.probabilities(
                draws,
                |draw| draw.means[place],
                |draw| {
                    let mut factor = draw.factors[place];
                    factor.row_mut(i).scale_mut(TRAINED);
                    factor
                },
            );
            TrainingGain {
                cause: Cause(i),
                gain: trained.minus(usual).interval(),
            }
        })
        .collect();
    gains.sort_by(|a, b| b.gain.mean.total_cmp(&a.gain.mean));
    gains
}
