//! What `--free` finds of parameters that were not measured.

use crate::fitting::UnseenParameter;
use serde::{Deserialize, Serialize};

/// What the shots say of a parameter that was not measured.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FreeParameter {
    /// Its name, such as `hoop_restitution`.
    pub name: String,
    /// Its unit; empty for none.
    pub unit: String,
    /// The likeliest value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best: Option<f64>,
    /// The lower end of its interval of 95 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low: Option<f64>,
    /// The upper end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub high: Option<f64>,
    /// Whether the shots tell both ends.
    pub is_decided: bool,
    /// Whether the value of the physics lies in the interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub is_usual: Option<bool>,
    /// Whether the interval is narrower than what sources say.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tells_more_than_sources: Option<bool>,
    /// The logarithm of the likelihood over the value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<CurvePoint>>,
}

/// A point of a likelihood curve.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// The value, in the unit of the parameter.
    pub value: f64,
    /// The logarithm of its likelihood.
    pub log_likelihood: f64,
}

/// The interval of the ring's restitution that makes tell, among what `--free` found.
pub(super) fn ring_of(free: &[FreeParameter]) -> Option<(f64, f64)> {
    let parameter = UnseenParameter::HoopRestitution;
    let ring = free.iter().find(|of| of.name == parameter.name());
    let ring = ring.filter(|ring| ring.is_decided)?;
    let (low, high) = ring.low.zip(ring.high)?;
    (low < high).then_some((low, high))
}
