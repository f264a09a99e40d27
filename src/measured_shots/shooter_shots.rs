//! The measured shots of a shooter, and what the file does not say of them.

use super::court_frame::CourtFrame;
use super::source::Source;
use crate::fitting::{
    FlightFit, Landing, MeasuredRelease, Place, PlaceScatter, ReleaseDifference, SpinSource,
    TrackedPoint, TrackerNoise, Values,
};
use crate::model::league_courts::League;

/// What the file does not say.
#[derive(Clone, Debug)]
pub struct ReadOptions {
    /// The coordinates of trajectories.
    pub frame: CourtFrame,
    /// The court whose places have the names of the file.
    pub court: League,
    /// Distance of the place, m.
    pub distance_m: Option<f64>,
    /// Its angle on the court, rad.
    pub court_angle_rad: Option<f64>,
    /// Heights of the release above the floor, m: of a shooter, or of all who have none.
    pub release_heights_m: Vec<(Option<String>, f64)>,
    /// Backspin, rad/s.
    pub backspin_rad_s: Option<f64>,
    /// The tracker's errors.
    pub noise: TrackerNoise,
}

impl ReadOptions {
    /// The height of the release of a shooter, m.
    #[must_use]
    pub fn release_height_m(&self, shooter: &str) -> Option<f64> {
        let of = |name: Option<&str>| {
            let mut heights = self.release_heights_m.iter();
            heights.find_map(|(known, height_m)| (known.as_deref() == name).then_some(*height_m))
        };
        of(Some(shooter)).or_else(|| of(None))
    }
}

/// The measured shots of one shooter.
#[derive(Clone, Debug)]
pub struct ShooterShots {
    /// Their name; empty if the file does not say.
    pub name: String,
    /// What was measured.
    pub source: Source,
    /// Where they shot from.
    pub places: Vec<Place>,
    /// The name of each place; empty where the file does not say.
    pub place_names: Vec<String>,
    /// How far the releases of each place lie apart.
    pub place_scatter: Vec<PlaceScatter>,
    /// The shots, in the order of the file.
    pub shots: Vec<MeasuredRelease>,
    /// The session of each; empty if the file does not say.
    pub sessions: Vec<String>,
    /// The name or number of each; empty if the file does not say.
    pub shot_names: Vec<String>,
    /// Rows that are kept out, and why.
    pub rejected: Vec<(u64, String)>,
    /// Where the backspin comes from.
    pub spin: SpinSource,
    /// Unit of the speeds in the file, and its size in m/s.
    pub speed_unit: (&'static str, f64),
    /// The tracked points in free flight of each shot.
    pub tracks: Vec<Vec<TrackedPoint>>,
    /// Squared residuals of each trajectory, and what is expected of them.
    pub chi_squares: Vec<(f64, f64)>,
    /// Releases that were measured beside the landings.
    pub differences: Vec<ReleaseDifference>,
}

/// A shot before its place is known.
pub(super) struct RawShot {
    pub(super) row: u64,
    pub(super) session: String,
    pub(super) name: String,
    pub(super) made: Option<bool>,
    pub(super) place: Place,
    pub(super) measured: Raw,
}

/// What was measured of it.
pub(super) enum Raw {
    Release(Values),
    Landing(Landing, f64),
    Flight(Box<FlightFit>, Vec<TrackedPoint>),
    /// No more than its result.
    Nothing,
}
