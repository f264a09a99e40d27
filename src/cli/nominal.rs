//! The nominal shot of a command: the profile's `[nominal]` table, with flags before it.

use super::failure::Failure;
use bankshot::profile::{Nominal, Profile};
use bankshot::units::{self, Dimension};
use clap::Args;

/// Fastest release that is simulated, m/s.
const FASTEST_M_S: f64 = 1000.0;
/// Fastest spin that is simulated, rad/s.
const FASTEST_SPIN_RAD_S: f64 = 10_000.0;

/// Flags that say which shot is meant; each goes before the profile's `[nominal]`.
#[derive(Args, Debug)]
pub(crate) struct NominalOptions {
    /// Speed of the release, such as '23.5 ft/s'.
    #[arg(long, allow_hyphen_values = true)]
    speed: Option<String>,
    /// Pitch angle of the release, such as '52 deg'.
    #[arg(long, allow_hyphen_values = true)]
    pitch: Option<String>,
    /// Polar angle of the release [default: the profile's, else towards the hoop's centre].
    #[arg(long, allow_hyphen_values = true)]
    polar: Option<String>,
    /// Backspin [default: the profile's, else none].
    #[arg(long, allow_hyphen_values = true)]
    backspin: Option<String>,
    /// Spin about the level direction of the shot [default: the profile's, else none].
    #[arg(long, allow_hyphen_values = true)]
    rifle_spin: Option<String>,
    /// Spin about the vertical [default: the profile's, else none].
    #[arg(long, allow_hyphen_values = true)]
    side_spin: Option<String>,
}

impl NominalOptions {
    /// The nominal shot that is meant.
    pub(crate) fn resolve(&self, profile: &Profile) -> Result<Nominal, Failure> {
        let intent = &profile.nominal;
        let mut faults = Vec::new();
        let mut read = |name: &str, flag: &Option<String>, given: Option<f64>, dimension| {
            let value = match (flag, given) {
                (Some(text), _) => match units::parse(text, dimension) {
                    Ok(value) => value,
                    Err(error) => {
                        faults.push(format!("--{name}: {error}"));
                        return 0.0;
                    }
                },
                (None, Some(value)) => return value,
                (None, None) => {
                    faults.push(format!(
                        "--{name} is missing; give it, or {name} in the profile's [nominal] table"
                    ));
                    return 0.0;
                }
            };
            let allowed = match dimension {
                Dimension::Speed if !(0.0..=FASTEST_M_S).contains(&value) => "from 0 to 1000 m/s",
                Dimension::Spin if !(value.abs() <= FASTEST_SPIN_RAD_S) => "within 10000 rad/s",
                _ => return value,
            };
            faults.push(format!("--{name}: must be {allowed}"));
            0.0
        };
        let none = Some(0.0);
        let nominal = Nominal {
            speed_m_s: read("speed", &self.speed, intent.speed_m_s, Dimension::Speed),
            pitch_rad: read("pitch", &self.pitch, intent.pitch_rad, Dimension::Angle),
            polar_rad: read(
                "polar",
                &self.polar,
                intent.polar_rad.or(Some(profile.place.angle_rad)),
                Dimension::Angle,
            ),
            backspin_rad_s: read(
                "backspin",
                &self.backspin,
                intent.backspin_rad_s.or(none),
                Dimension::Spin,
            ),
            rifle_spin_rad_s: read(
                "rifle-spin",
                &self.rifle_spin,
                intent.rifle_spin_rad_s.or(none),
                Dimension::Spin,
            ),
            side_spin_rad_s: read(
                "side-spin",
                &self.side_spin,
                intent.side_spin_rad_s.or(none),
                Dimension::Spin,
            ),
        };
        if faults.is_empty() {
            Ok(nominal)
        } else {
            Err(Failure::usage(faults.join("\n")))
        }
    }
}
