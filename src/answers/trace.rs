//! The path of one shot without errors: its events and its points.

use super::json::{Answer, Provenance};
use crate::dynamics::{EventKind, Trace};
use crate::math::vector::Vec3;
use crate::model::SolidId;
use crate::shooter::Profile;
use serde::Serialize;

/// Something that happens to the ball.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EventAnswer {
    /// `release`, `touch board`, `leave board`, `touch ring` ..., `end`.
    pub event: String,
    /// When, after the release.
    pub time_s: f64,
    /// Where the ball's centre is: from the hoop's centre to the shooter, to the shooter's right,
    /// and above the ring.
    pub position_m: [f64; 3],
    /// How it moves.
    pub velocity_m_s: [f64; 3],
    /// How long a contact lasted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration_s: Option<f64>,
    /// The impulse of a contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impulse_n_s: Option<[f64; 3]>,
}

/// The path of one shot.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TraceAnswer {
    /// Whether it goes in.
    pub made: bool,
    /// How it ends.
    pub kind: &'static str,
    /// What it touches.
    pub contacts: String,
    /// From the release to the end.
    pub flight_time_s: f64,
    /// The highest point of the ball's centre.
    pub apex_above_ring_m: f64,
    /// At which angle it falls through the ring.
    pub entry_angle_rad: Option<f64>,
    /// What happens on the way.
    pub events: Vec<EventAnswer>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl TraceAnswer {
    /// The path of a shot of a profile.
    #[must_use]
    pub fn new(profile: &Profile, trace: &Trace) -> Self {
        let outcome = &trace.outcome;
        let events = trace.events.iter().map(|event| {
            let (name, contact) = match event.kind {
                EventKind::Release => ("release".to_owned(), None),
                EventKind::Touch(solid) => (format!("touch {}", solid.name()), None),
                EventKind::Part {
                    solid,
                    impulse_n_s,
                    duration_s,
                } => (
                    format!("leave {}", solid.name()),
                    Some((duration_s, impulse_n_s)),
                ),
                EventKind::End => ("end".to_owned(), None),
            };
            EventAnswer {
                event: name,
                time_s: event.time_s,
                position_m: event.state.position_m.into(),
                velocity_m_s: event.state.velocity_m_s.into(),
                duration_s: contact.map(|(duration_s, _)| duration_s),
                impulse_n_s: contact.map(|(_, impulse): (f64, Vec3<f64>)| impulse.into()),
            }
        });
        Self {
            made: outcome.verdict.made,
            kind: outcome.kind.name(),
            contacts: outcome.verdict.contacts.to_string(),
            flight_time_s: outcome.verdict.time_s,
            apex_above_ring_m: outcome.apex_m,
            entry_angle_rad: outcome.entry.map(|entry| entry.angle_rad),
            events: events.collect(),
            provenance: Provenance::of(profile),
        }
    }
}

/// A point of the path.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PointAnswer {
    /// After the release.
    pub time_s: f64,
    /// From the hoop's centre to the shooter.
    pub x_m: f64,
    /// To the right, as the shooter sees it.
    pub y_m: f64,
    /// Above the ring.
    pub z_above_ring_m: f64,
    /// Velocity along x.
    pub vx_m_s: f64,
    /// Velocity along y.
    pub vy_m_s: f64,
    /// Velocity upwards.
    pub vz_m_s: f64,
    /// Spin about x.
    pub spin_x_rad_s: f64,
    /// Spin about y.
    pub spin_y_rad_s: f64,
    /// Spin about the vertical.
    pub spin_z_rad_s: f64,
    /// 1 while the ball touches the board.
    pub on_board: u8,
    /// 1 while it touches the ring.
    pub on_ring: u8,
}

/// The points of a path.
#[must_use]
pub fn points(trace: &Trace) -> Vec<PointAnswer> {
    let point = |sample: &crate::dynamics::Sample| {
        let [x, y, z, vx, vy, vz, wx, wy, wz] = sample.state.to_array();
        PointAnswer {
            time_s: sample.time_s,
            x_m: x,
            y_m: y,
            z_above_ring_m: z,
            vx_m_s: vx,
            vy_m_s: vy,
            vz_m_s: vz,
            spin_x_rad_s: wx,
            spin_y_rad_s: wy,
            spin_z_rad_s: wz,
            on_board: u8::from(sample.touches(SolidId::Board)),
            on_ring: u8::from(sample.touches(SolidId::Ring)),
        }
    };
    trace.samples.iter().map(point).collect()
}

impl Answer for TraceAnswer {
    const NAME: &'static str = "trace";
}
