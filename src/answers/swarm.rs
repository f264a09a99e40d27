//! The paths of some simulated shots, each with its own errors, to look at.

use super::json::{Answer, Provenance};
use crate::dynamics::{Outcome, OutcomeKind, StateError, Trace};
use crate::math::vector::Vec3;
use crate::probability::Sampler;
use crate::shooter::{Nominal, Profile};
use rayon::prelude::*;
use serde::Serialize;

/// Spacing of the points of a path in flight, s.
pub const INTERVAL_S: f64 = 0.03;
/// Points closer in time than this are merged, s.
const MIN_INTERVAL_S: f64 = 0.002;

/// One shot of a swarm.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SwarmShot {
    /// Whether it goes in.
    pub made: bool,
    /// How it ends.
    pub kind: OutcomeKind,
    /// Its points, in order of time: after the release, s, and from the hoop's centre, m: to the
    /// shooter, to the shooter's right, upwards.
    pub path: Vec<[f64; 4]>,
}

/// Simulated shots of a nominal shot.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SwarmAnswer {
    /// The shots.
    pub shots: Vec<SwarmShot>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl SwarmAnswer {
    /// The first shots of the sample with which the probability of a nominal shot is computed.
    ///
    /// # Errors
    /// A release has a value that is not finite.
    pub fn simulate(
        profile: &Profile,
        nominal: &Nominal,
        shots: usize,
    ) -> Result<Self, StateError> {
        let seed = profile.search().seed;
        let sampler = Sampler::new(profile);
        let shot = |index: usize| {
            let release = sampler.sample(nominal, seed, index as u64);
            let trace = profile.simulator().trace(&release, INTERVAL_S)?;
            let Outcome { verdict, kind, .. } = trace.outcome;
            Ok(SwarmShot {
                made: verdict.made,
                kind,
                path: path(&trace, INTERVAL_S),
            })
        };
        Ok(Self {
            shots: (0..shots)
                .into_par_iter()
                .map(shot)
                .collect::<Result<_, StateError>>()?,
            provenance: Provenance::of(profile),
        })
    }
}

impl Answer for SwarmAnswer {
    const NAME: &'static str = "swarm";
    const IS_SI: bool = true;
}

/// The points of a path, to the millisecond and the centimetre, about every `interval_s` and at
/// each event.
#[must_use]
pub fn path(trace: &Trace, interval_s: f64) -> Vec<[f64; 4]> {
    let events = trace.events.iter();
    let mut points: Vec<(f64, Vec3<f64>)> = events
        .map(|event| (event.time_s, event.state.position_m))
        .collect();
    // In contact the trace has many more samples than a picture needs.
    let mut last_s = f64::NEG_INFINITY;
    for sample in &trace.samples {
        if sample.time_s - last_s >= 0.9 * interval_s {
            points.push((sample.time_s, sample.state.position_m));
            last_s = sample.time_s;
        }
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0 - b.0 < MIN_INTERVAL_S);
    let rounded = |value: f64, steps: f64| (steps * value).round() / steps + 0.0;
    let each = points.into_iter();
    each.map(|(time_s, position)| {
        let [x, y, z] = [position.x, position.y, position.z].map(|length| rounded(length, 100.0));
        [rounded(time_s, 1000.0), x, y, z]
    })
    .collect()
}
