//! Parsers of option values.

use crate::dynamics::InstructionSet;
use crate::sweep::job_list::Shard;
use crate::sweep::run::FaultInjection;
use crate::units::UnitSystem;
use clap::{Args, ValueEnum};

/// Another physics than that of the file.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct PhysicsArg {
    /// The physics: a preset (paper, ncaa, ncaa_women, nba, wnba, fiba, fiba_women, youth), or a
    /// TOML file with a [physics] table.
    #[arg(long, value_name = "PRESET|FILE")]
    pub(crate) physics: Option<String>,
}

/// The unit systems by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum UnitsArg {
    /// ft, ft/s, deg, rev/s.
    Imperial,
    /// m, m/s, deg, rev/s.
    Metric,
}

impl From<UnitsArg> for UnitSystem {
    fn from(units: UnitsArg) -> Self {
        match units {
            UnitsArg::Imperial => Self::Imperial,
            UnitsArg::Metric => Self::Metric,
        }
    }
}

/// A standard error of a probability.
pub(crate) fn standard_error(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1e-6..=0.5).contains(&value) => Ok(value),
        _ => Err("must be a number from 0.000001 to 0.5".to_owned()),
    }
}

/// A standard error of a probability in percentage points.
pub(crate) fn points(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.1..=50.0).contains(&value) => Ok(value),
        _ => Err("must be a number from 0.1 to 50, in makes per 100".to_owned()),
    }
}

/// A seed and an index, such as `1:2049`.
pub(crate) fn sample(text: &str) -> Result<(u64, u64), String> {
    text.split_once(':')
        .and_then(|(seed, index)| Some((seed.parse().ok()?, index.parse().ok()?)))
        .ok_or_else(|| "must be two whole numbers, such as 1:2049".to_owned())
}

/// `panic:SPOT`, `abort:SPOT` or `wait:SPOT:FILE`.
pub(crate) fn fault_injection(text: &str) -> Result<FaultInjection, String> {
    let mut parts = text.splitn(3, ':');
    let (fault, spot, file) = (parts.next(), parts.next(), parts.next());
    let spot = spot.and_then(|spot| spot.parse().ok());
    match (fault, spot, file) {
        (Some("panic"), Some(spot), None) => Ok(FaultInjection::Panic(spot)),
        (Some("abort"), Some(spot), None) => Ok(FaultInjection::Abort(spot)),
        (Some("wait"), Some(spot), Some(file)) => Ok(FaultInjection::Wait(spot, file.into())),
        _ => Err("must be panic:SPOT, abort:SPOT or wait:SPOT:FILE".to_owned()),
    }
}

/// A shard, such as `3/64`.
pub(crate) fn shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| text.parse::<usize>().ok();
    let parts = text
        .split_once('/')
        .and_then(|(index, count)| Some((number(index)?, number(count)?)));
    match parts {
        Some((index, count)) if index >= 1 && index <= count && count <= 1_000_000 => Ok(Shard {
            index: index - 1,
            count,
        }),
        _ => Err("must be the number of the shard and of all shards, such as 3/64".to_owned()),
    }
}

/// A fraction, such as `1%` or `0.01`.
pub(crate) fn fraction(text: &str) -> Result<f64, String> {
    let value = match text.strip_suffix('%') {
        Some(percent) => percent
            .trim()
            .parse::<f64>()
            .ok()
            .map(|percent| percent / 100.0),
        None => text.parse::<f64>().ok(),
    };
    match value {
        Some(value) if value > 0.0 && value <= 1.0 => Ok(value),
        _ => Err("must be a fraction such as 1% or 0.01, at most 100%".to_owned()),
    }
}

/// Vector instructions by name: those of this machine.
pub(crate) fn instruction_set(text: &str) -> Result<InstructionSet, String> {
    let available = InstructionSet::available();
    let found = available.iter().find(|(name, _)| *name == text);
    found.map(|(_, set)| *set).ok_or_else(|| {
        let names: Vec<&str> = available.iter().map(|(name, _)| *name).collect();
        format!("must be one of {}", names.join(", "))
    })
}
