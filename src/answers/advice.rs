//! What a measured shooter should change, and how sure that is.

use super::json::{Answer, Provenance};
use crate::fitting::{
    Advice, AdviceStep, Interval, Landing, Support, TrainingGain, Values, values_of,
};
use crate::shooter::ShotKind;
use crate::store::fit::Fit;
use serde::Serialize;

/// A release.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Release {
    /// Its speed.
    pub speed_m_s: f64,
    /// Above the horizontal.
    pub pitch_rad: f64,
    /// From the court's long axis.
    pub polar_rad: f64,
    /// Its backspin.
    pub backspin_rad_s: f64,
}

impl From<Values> for Release {
    fn from([speed_m_s, pitch_rad, polar_rad, backspin_rad_s]: Values) -> Self {
        Self {
            speed_m_s,
            pitch_rad,
            polar_rad,
            backspin_rad_s,
        }
    }
}

/// How many shots went in.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Makes {
    /// Shots with a result.
    pub shots: usize,
    /// Those that went in.
    pub made: usize,
}

/// A step from the current release towards the best one.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// What changes.
    pub cause: &'static str,
    /// Makes it adds, as a probability, after the steps before it.
    #[serde(flatten)]
    pub gain: Interval,
    /// Whether the measured shots support it.
    pub support: Support,
    /// The release after it.
    pub release: Release,
}

impl From<&AdviceStep> for Step {
    fn from(step: &AdviceStep) -> Self {
        Self {
            cause: step.cause.name(),
            gain: step.gain,
            support: step.support,
            release: step.release.into(),
        }
    }
}

/// What the speed and the angle gain, each without the other.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Alone {
    /// The speed.
    pub speed: Interval,
    /// The angle.
    pub pitch: Interval,
    /// The share of the draws in which the speed gains more.
    pub speed_is_better: f64,
}

/// What a tenth less scatter gains.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Training {
    /// Of what.
    pub less_scatter_of: &'static str,
    /// The gain in P.
    #[serde(flatten)]
    pub gain: Interval,
}

impl From<&TrainingGain> for Training {
    fn from(training: &TrainingGain) -> Self {
        Self {
            less_scatter_of: training.cause.name(),
            gain: training.gain,
        }
    }
}

/// Where a ball falls to the height of the hoop.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fall {
    /// Below the horizontal.
    pub entry_angle_rad: f64,
    /// From the front of the ring.
    pub depth_short_m: f64,
    /// To the right, as the shooter sees it.
    pub left_right_short_m: f64,
}

impl From<&Landing> for Fall {
    fn from(landing: &Landing) -> Self {
        Self {
            entry_angle_rad: landing.entry_angle_rad,
            depth_short_m: landing.depth_m,
            left_right_short_m: landing.right_m,
        }
    }
}

/// Where the current and the suggested shot fall.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Falls {
    /// The current shot.
    pub current: Fall,
    /// The suggested shot.
    pub suggested: Fall,
}

/// The best bank shot against the best direct one.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BankOrDirect {
    /// P of the best direct shot.
    pub direct: Interval,
    /// P of the best bank shot.
    pub bank: Interval,
    /// The difference, draw by draw.
    pub bank_minus_direct: Interval,
    /// The share of the draws in which the bank shot is better.
    pub bank_is_better: f64,
}

/// The advice for a shooter at one place.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AdviceAnswer {
    /// Who shoots.
    pub shooter: String,
    /// From how far.
    pub distance_m: f64,
    /// From the court's long axis.
    pub court_angle_rad: f64,
    /// The kind of the current shot.
    pub kind: ShotKind,
    /// The current release.
    pub current: Release,
    /// P of the current shot.
    pub current_probability: Interval,
    /// Its numerical standard error.
    pub numerical_standard_error: f64,
    /// How many of the measured shots went in.
    pub observed: Makes,
    /// Whether the makes contradict the measured shots: then nothing here is to be followed.
    pub makes_contradict: bool,
    /// The best release for this scatter.
    pub best: Option<Release>,
    /// P of the best shot.
    pub best_probability: Option<Interval>,
    /// P after the suggested steps.
    pub suggested_probability: Interval,
    /// P of the best shot minus P of the current one, draw by draw.
    pub gain: Option<Interval>,
    /// The share of the draws in which that is positive.
    pub gain_is_positive: f64,
    /// The steps from the current to the best release.
    pub causes: Vec<Step>,
    /// The release after the suggested steps.
    pub suggested: Option<Release>,
    /// What the suggested steps gain together.
    pub suggested_gain: Option<Interval>,
    /// What speed and angle gain alone, where both are suggested.
    pub suggested_alone: Option<Alone>,
    /// What to train, largest gain first.
    pub training: Vec<Training>,
    /// Where direct shots fall.
    pub landings: Option<Falls>,
    /// Bank against direct, where both can be made.
    pub bank_or_direct: Option<BankOrDirect>,
    /// The name of the place; empty where the file of the shots does not say.
    pub place: String,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl AdviceAnswer {
    /// The advice for a fitted shooter at a place, by its index.
    #[must_use]
    pub fn new(fit: &Fit, place: usize, advice: &Advice) -> Self {
        let (profile, (made, shots)) = (&fit.profiles[place], fit.observed[place]);
        let steps = advice.steps.as_ref();
        Self {
            shooter: profile.shooter().name.clone(),
            distance_m: profile.location().distance_m,
            court_angle_rad: profile.location().angle_rad,
            kind: advice.kind,
            current: advice.usual.into(),
            current_probability: advice.usual_probability,
            numerical_standard_error: advice.numerical_standard_error,
            observed: Makes { shots, made },
            makes_contradict: fit
                .contradiction(place, &advice.usual_probability)
                .is_some(),
            best: advice
                .best
                .as_ref()
                .map(|best| values_of(&best.nominal).into()),
            best_probability: advice.best_probability,
            suggested_probability: advice.advised_probability,
            gain: advice.gain,
            gain_is_positive: advice.gain_is_positive,
            causes: steps.map_or_else(Vec::new, |steps| {
                steps.steps.iter().map(Step::from).collect()
            }),
            suggested: steps.map(|steps| steps.advised.into()),
            suggested_gain: steps.map(|steps| steps.gain),
            suggested_alone: steps.and_then(|steps| steps.alone).map(|alone| Alone {
                speed: alone.speed,
                pitch: alone.pitch,
                speed_is_better: alone.speed_is_better,
            }),
            training: advice.training.iter().map(Training::from).collect(),
            landings: advice.landings.as_ref().map(|[usual, advised]| Falls {
                current: usual.into(),
                suggested: advised.into(),
            }),
            bank_or_direct: advice.kinds.as_ref().map(|kinds| BankOrDirect {
                direct: kinds.probabilities[ShotKind::Direct as usize],
                bank: kinds.probabilities[ShotKind::Bank as usize],
                bank_minus_direct: kinds.difference,
                bank_is_better: kinds.bank_is_better,
            }),
            place: fit.place_names[place].clone(),
            provenance: Provenance::of(profile),
        }
    }
}

impl Answer for AdviceAnswer {
    const NAME: &'static str = "advice";
}
