//! The tracker of the simulated tests.

use super::tested_shot::TestedShot;
use crate::cli::config_files::read_text;
use crate::cli::failure::Failure;
use crate::cli::measured_shots_flags::tracker_noise;
use crate::fitting::{
    Covariance, Landing, Place, Tracker, TrackerNoise, landing_of, release_of_landing,
    tracked_flight_noise, values_of,
};
use crate::measured_shots::source::Source;
use std::path::Path;

/// What a tracker measures.
pub(super) struct TrackerOfTest {
    /// Its name or its file, and where its noise is from.
    pub(super) name: (String, String),
    noise: TrackerNoise,
    sees: Source,
}

impl TrackerOfTest {
    /// That of a flag, or else that of the fit.
    pub(super) fn of(named: Option<&str>, shot: &TestedShot) -> Result<Self, Failure> {
        if let Some(name) = named {
            return tracker_named(name, None);
        }
        let (own, sees) = &shot.tracker;
        tracker_named(own, *sees).map_err(|failure| Failure {
            message: format!(
                "the tracker of the fit: {}{}",
                failure.message,
                match Path::new(own).exists() {
                    true => "",
                    false => "; run it in the folder of that file, or give --tracker FILE",
                }
            ),
            ..failure
        })
    }

    /// Its errors as errors of a shot's release.
    pub(super) fn noise_at(&self, shot: &TestedShot) -> Result<Covariance, Failure> {
        let (profile, nominal) = (&shot.profile, &shot.nominal);
        let place = Place {
            location: profile.location(),
            release_height_m: profile.shooter().release_height_m,
        };
        let (simulator, values) = (profile.simulator(), values_of(nominal));
        let refuse =
            || Failure::usage("the current shot does not fall through the height of the hoop");
        let landing: Landing = landing_of(simulator, &place, &values).ok_or_else(refuse)?;
        match self.sees {
            Source::Releases => Ok(self.noise.release_covariance()),
            Source::Trajectories => tracked_flight_noise(simulator, &place, &values, &self.noise)
                .map_err(|error| Failure::usage(format!("the current shot, as tracked: {error}"))),
            Source::Landings | Source::Makes => {
                let noise = &self.noise.landing;
                release_of_landing(simulator, &place, &landing, noise, values[3])
                    .map(|(_, covariance)| covariance)
                    .map_err(|_| refuse())
            }
        }
    }
}

/// The tracker of a name or of a file. A file with an error of the depth is that of a gym sensor,
/// one with that of a position a camera's, unless it is known what it `sees`.
fn tracker_named(name: &str, sees: Option<Source>) -> Result<TrackerOfTest, Failure> {
    let is_file = Tracker::named(name).is_none();
    let keys: toml::Table = if is_file && Path::new(name).exists() {
        read_text(Path::new(name))?.parse().unwrap_or_default()
    } else {
        toml::Table::new()
    };
    let sees = if let Some(sees) = sees {
        sees
    } else if name == "noah" || keys.contains_key("depth") {
        Source::Landings
    } else if name.starts_with("optical_") || keys.contains_key("position") {
        Source::Trajectories
    } else {
        Source::Releases
    };
    let (noise, name) = tracker_noise(name, sees)?;
    Ok(TrackerOfTest { name, noise, sees })
}
