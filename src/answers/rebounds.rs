//! Where the misses of a shot come down.
//!
//! ```
//! use bankshot::analysis::rebounds::{REACH_M, find_rebounds};
//! use bankshot::answers::rebounds::ReboundsAnswer;
//!
//! let text = std::fs::read_to_string("configs/free_throw.toml")?;
//! let profile = bankshot::config::parse_profile(&text, "the example")?;
//! let (_, found) = bankshot::best_shot::find_kinds(
//!     &profile,
//!     &[bankshot::shooter::ShotKind::Direct],
//!     bankshot::analysis::sensitivity::SensitivityTopics::NONE,
//!     &bankshot::probability::Silent,
//! )?;
//! let best = found[0].as_ref().map_err(|error| error.to_string())?;
//! let rebounds = find_rebounds(&profile, &best.nominal, 1, REACH_M);
//! let answer = ReboundsAnswer::new(&profile, &rebounds, REACH_M);
//! assert!(answer.all.distance_m.median > 0.3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::analysis::rebounds::{REBOUND_SHOTS, Rebound, Spot};
use crate::dynamics::OutcomeKind;
use crate::shooter::Profile;
use crate::units::{self, Dimension};
use serde::Serialize;

/// The middle half of a quantity.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Quartiles {
    /// A quarter is below.
    pub lower_quartile: f64,
    /// Half is below.
    pub median: f64,
    /// A quarter is above.
    pub upper_quartile: f64,
}

impl Quartiles {
    fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * values.len() as f64) as usize;
            values.get(index).copied().unwrap_or(0.0)
        };
        Self {
            lower_quartile: at(0.25),
            median: at(0.5),
            upper_quartile: at(0.75),
        }
    }
}

/// Where the misses of one kind come down within reach.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReboundGroup {
    /// How they miss: short, long, left, right, in and out, over the board, or all.
    pub miss: &'static str,
    /// Their share of all misses that come down.
    pub share: f64,
    /// Distance from the hoop's centre on the floor.
    pub distance_m: Quartiles,
    /// The share beyond the hoop, as the shooter sees it.
    pub beyond_hoop: f64,
    /// The share to the right of the line from the shooter to the hoop.
    pub right_of_line: f64,
    /// Median time from the release.
    pub time_s: f64,
}

/// Where the misses of a shot come down.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReboundsAnswer {
    /// Simulated shots.
    pub shots: u32,
    /// Misses that come down.
    pub misses: usize,
    /// Height of the ball's centre above the floor.
    pub height_m: f64,
    /// All of them.
    pub all: ReboundGroup,
    /// By how they miss, the most frequent first.
    pub groups: Vec<ReboundGroup>,
    /// Distance from the hoop's centre where they touch the floor.
    pub floor_distance_m: Quartiles,
    /// Distance where they fall below 9 ft.
    pub contested_distance_m: Quartiles,
}

/// A height of a rebounder's reach, m.
///
/// # Errors
/// It is no length, or nobody's reach.
pub fn reach(text: &str) -> Result<f64, String> {
    let height_m = units::parse(text, Dimension::Length).map_err(|error| error.to_string())?;
    match (0.5..=4.0).contains(&height_m) {
        true => Ok(height_m),
        false => Err("must be from 0.5 m to 4 m (1.7 to 13 ft)".to_owned()),
    }
}

/// The name of a kind of miss.
fn miss_name(rebound: &Rebound) -> &'static str {
    match rebound.kind {
        OutcomeKind::Short => "short",
        OutcomeKind::Long => "long",
        OutcomeKind::Wide if rebound.right_of_centre_m < 0.0 => "left",
        OutcomeKind::Wide => "right",
        OutcomeKind::InAndOut => "in and out",
        OutcomeKind::OverBoard => "over the board",
        OutcomeKind::Airball => "airball",
        _ => "other",
    }
}

impl ReboundsAnswer {
    /// The summary of some misses; `reach_m` is the height that they were looked at.
    #[must_use]
    pub fn new(profile: &Profile, rebounds: &[Rebound], reach_m: f64) -> Self {
        let (sin, cos) = libm::sincos(profile.location().angle_rad);
        let group = |miss: &'static str, of: &[&Rebound]| {
            let spots: Vec<Spot> = of.iter().map(|rebound| rebound.spots[1]).collect();
            let count = (of.len() as f64).max(1.0);
            let share = |is: &dyn Fn(&Spot) -> bool| {
                spots.iter().filter(|spot| is(spot)).count() as f64 / count
            };
            ReboundGroup {
                miss,
                share: of.len() as f64 / (rebounds.len() as f64).max(1.0),
                distance_m: Quartiles::of(spots.iter().map(Spot::distance_m).collect()),
                // The shooter is in the direction of (cos, sin) from the hoop.
                beyond_hoop: share(&|spot| spot.x_m * cos + spot.y_m * sin < 0.0),
                right_of_line: share(&|spot| spot.y_m * cos - spot.x_m * sin > 0.0),
                time_s: Quartiles::of(spots.iter().map(|spot| spot.time_s).collect()).median,
            }
        };
        let mut names: Vec<&'static str> = Vec::new();
        for rebound in rebounds {
            let name = miss_name(rebound);
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let mut groups: Vec<ReboundGroup> = names
            .into_iter()
            .map(|name| {
                let of = rebounds.iter().filter(|rebound| miss_name(rebound) == name);
                group(name, &of.collect::<Vec<_>>())
            })
            .collect();
        groups.sort_by(|a, b| b.share.total_cmp(&a.share));
        let distance = |height: usize| {
            let distances = rebounds
                .iter()
                .map(|rebound| rebound.spots[height].distance_m());
            Quartiles::of(distances.collect())
        };
        Self {
            shots: REBOUND_SHOTS,
            misses: rebounds.len(),
            height_m: reach_m,
            all: group("all", &rebounds.iter().collect::<Vec<_>>()),
            groups,
            floor_distance_m: distance(2),
            contested_distance_m: distance(0),
        }
    }
}
