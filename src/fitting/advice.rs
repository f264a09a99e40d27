//! What a shooter should change, and how sure that is.

use super::advice_steps::{AdviceSteps, Cause, Change, ChangedShots, Shooting};
use super::draw_probabilities::{DrawProbabilities, WeightedShots};
use super::fitted_profile::with_backspin_kept;
use super::interval::Interval;
use super::landing::{Landing, landing_of};
use super::measured_release::{Place, VALUE_NAMES, Values, nominal_of, values_of};
use super::posterior::{Draw, Posterior, SpinSource};
use crate::analysis::sensitivity::SensitivityTopics;
use crate::best_shot::{BestShot, BestShotError, find_kinds};
use crate::probability::Progress;
use crate::shooter::{Profile, ShotKind};

/// Draws that advice is computed for, at most.
pub(super) const DRAWS: usize = 1000;
/// The factor on a standard deviation for "10 % less scatter".
const TRAINED: f64 = 0.9;

/// What 10 % less scatter of one value gains.
#[derive(Clone, Debug)]
pub struct TrainingGain {
    /// The value.
    pub cause: Cause,
    /// The gain in P of the advised shot: the usual one where no change is advised.
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
    /// The number of measured shots.
    pub shots: usize,
    /// The kind of the current shot; the best shot is of the same kind.
    pub kind: ShotKind,
    /// The current release: means over the draws.
    pub usual: Values,
    /// Where the backspin comes from. One that was not measured is kept.
    pub spin: SpinSource,
    /// P of the current shot.
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
    /// What to change, if there is a best shot.
    pub steps: Option<AdviceSteps>,
    /// P of the advised shot: that of the usual one if no step is sure.
    pub advised_probability: Interval,
    /// What to train, largest gain first.
    pub training: Vec<TrainingGain>,
    /// Where the usual and the advised release fall to the height of the hoop, for direct shots
    /// that do.
    pub landings: Option<[Landing; 2]>,
    /// Bank or direct, where both can be made.
    pub kinds: Option<KindComparison>,
}

/// Shots of the sample for P of the current shot, in a fit and in advice.
pub(super) const USUAL_SHOTS: usize = 65_536;

/// P of the current shot at a place for each draw.
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

/// At most so many draws, evenly over all.
pub(super) fn thinned(posterior: &Posterior, most: usize) -> Vec<Draw> {
    let step = posterior.draws.len().div_ceil(most);
    posterior.draws.iter().step_by(step).cloned().collect()
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
    let draws = thinned(posterior, DRAWS);
    let mut shooting = Shooting::new(profile, &draws, &typical, place);
    let usual_p = shooting.with(Change::default()).probabilities.clone();
    let measured = posterior.spin.measured_values();
    let keeps_backspin = measured < 4;
    let usual = typical.means[place];
    let searched = if keeps_backspin {
        &with_backspin_kept(profile, usual[3]).unwrap_or_else(|_| profile.clone())
    } else {
        profile
    };
    let (_, found) = find_kinds(searched, &ShotKind::ALL, SensitivityTopics::NONE, progress)?;
    let best_of = |kind: ShotKind| found[kind as usize].as_ref().ok();
    let bests = ShotKind::ALL.map(|kind| best_of(kind).map(|best| values_of(&best.nominal)));
    let kind = nearest_kind(&usual, &typical.sds_at(place), &bests)
        .unwrap_or_else(|| ShotKind::of(profile, &nominal_of(&usual)));
    let by_kind: Vec<Option<DrawProbabilities>> = ShotKind::ALL
        .into_iter()
        .map(|kind| {
            let values = values_of(&best_of(kind)?.nominal);
            let change = Change::to(&values, |i| i >= measured);
            Some(shooting.with(change).probabilities.clone())
        })
        .collect();
    let kinds = match &by_kind[..] {
        [Some(direct), Some(bank)] => {
            let difference = bank.minus(direct);
            Some(KindComparison {
                probabilities: [direct.interval(), bank.interval()],
                bank_is_better: difference.share_positive(),
                difference: difference.interval(),
            })
        }
        _ => None,
    };
    let best = best_of(kind);
    let gain = by_kind[kind as usize].as_ref().map(|p| p.minus(&usual_p));
    let (steps, change) = best
        .map(|best| shooting.steps(&usual, &values_of(&best.nominal), measured))
        .unzip();
    let change = change.unwrap_or_default();
    let advised = |draw: &Draw| change.of_draw(draw, &typical, place);
    let shots = shooting.with(change);
    let advised_probability = shots.probabilities.interval();
    let mut training = training_gains(shots, &draws, place, advised);
    // Nothing is known of a scatter that was not measured.
    training.retain(|gain| gain.cause.0 < measured);
    let fall = |values: &Values| {
        let from = Place {
            location: profile.location(),
            release_height_m: profile.shooter().release_height_m,
        };
        landing_of(profile.simulator(), &from, values)
    };
    let landings = match (kind, fall(&usual), fall(&advised(&typical))) {
        (ShotKind::Direct, Some(usual), Some(advised)) => Some([usual, advised]),
        _ => None,
    };
    let told = usual_probabilities(profile, posterior, place, USUAL_SHOTS);
    let usual_probability = told.interval();
    // P of the usual shot rests on more shots: that of the advised one is it and the gain.
    let gained = steps.as_ref().map_or(0.0, |steps| steps.gain.mean);
    let shift = usual_probability.mean + gained - advised_probability.mean;
    let advised_probability = Interval {
        mean: advised_probability.mean + shift,
        low: advised_probability.low + shift,
        high: advised_probability.high + shift,
        ..advised_probability
    };
    Ok(Advice {
        shots: posterior.shots,
        kind,
        usual,
        spin: posterior.spin,
        usual_probability,
        numerical_standard_error: told.numerical_standard_error(),
        best_probability: by_kind[kind as usize]
            .as_ref()
            .map(DrawProbabilities::interval),
        gain_is_positive: gain.as_ref().map_or(0.0, DrawProbabilities::share_positive),
        gain: gain.as_ref().map(DrawProbabilities::interval),
        best: best.cloned(),
        steps,
        advised_probability,
        training,
        landings,
        kinds,
    })
}

/// The kind of the current shot where both kinds can be made: that whose best shot is nearer in
/// speed, pitch and aim, in standard deviations. The path alone does not tell it: a direct shot
/// that is thrown too hard meets the board first as well.
fn nearest_kind(usual: &Values, sds: &Values, bests: &[Option<Values>; 2]) -> Option<ShotKind> {
    let [Some(direct), Some(bank)] = bests else {
        return None;
    };
    let square = |best: &Values| -> f64 {
        let z = (0..3).map(|i| (best[i] - usual[i]) / sds[i].max(f64::MIN_POSITIVE));
        z.map(|z| z * z).sum()
    };
    Some(match square(bank) < square(direct) {
        true => ShotKind::Bank,
        false => ShotKind::Direct,
    })
}

/// What 10 % less scatter of each value gains about the advised release, `mean`.
fn training_gains(
    advised: &ChangedShots,
    draws: &[Draw],
    place: usize,
    mean: impl Fn(&Draw) -> Values + Sync,
) -> Vec<TrainingGain> {
    let mut gains: Vec<TrainingGain> = (0..VALUE_NAMES.len())
        .map(|i| {
            let trained = advised.shots.probabilities(draws, &mean, |draw| {
                let mut factor = draw.factors[place];
                factor.row_mut(i).scale_mut(TRAINED);
                factor
            });
            TrainingGain {
                cause: Cause(i),
                gain: trained.minus(&advised.probabilities).interval(),
            }
        })
        .collect();
    gains.sort_by(|a, b| b.gain.mean.total_cmp(&a.gain.mean));
    gains
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_long_direct_shot_is_direct() {
        let (direct, bank) = ([7.3, 0.93, 0.0, 15.0], [7.8, 1.03, 0.0, 15.0]);
        let sds = [0.1, 0.03, 0.02, 2.0];
        let kind = |usual: [f64; 4], bests| nearest_kind(&usual, &sds, &bests);
        let both = [Some(direct), Some(bank)];
        // Three standard deviations too fast, and so off the board.
        let long = [7.6, 0.93, 0.0, 15.0];
        assert_eq!(kind(long, both), Some(ShotKind::Direct));
        assert_eq!(kind(bank, both), Some(ShotKind::Bank));
        assert_eq!(kind(long, [None, Some(bank)]), None);
    }
}
