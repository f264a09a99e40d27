//! Makes the measured shots of the docs: one made-up player, seen by a lab, by a gym sensor and by
//! optical tracking. `cargo run --release --example make_measured_shots [FOLDER]`. The default
//! folder is `docs/data`.
//!
//! The player's true profile stands here and in `docs/fitting.md`.

use bankshot::dynamics::{Release, Simulator};
use bankshot::fitting::{
    Place, Tracker, TrackerNoise, Values, landing_of, nominal_of, release_of_landing,
};
use bankshot::math::normal_distribution::quantile;
use bankshot::model::Preset;
use bankshot::shooter::Location;
use bankshot::units::{DEGREE_RAD, FOOT_M, INCH_M, REV_RAD};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The aim and the scatter: speed (ft/s), pitch (deg), aim (deg), backspin (rev/s).
const AIM: [f64; 4] = [24.15, 51.0, 0.3, 2.1];
const SCATTER: [f64; 4] = [0.25, 1.3, 1.2, 0.35];
/// Correlation of speed and pitch angle.
const SPEED_PITCH: f64 = 0.2;
const UNITS: [f64; 4] = [FOOT_M, DEGREE_RAD, DEGREE_RAD, REV_RAD];

/// Where the player stands.
const MIDDLE: Location = Location {
    distance_m: 13.75 * FOOT_M,
    angle_rad: 0.0,
};

struct Player {
    simulator: Simulator,
    place: Place,
    random: ChaCha12Rng,
}

impl Player {
    fn new(seed: u64) -> Self {
        let physics = Preset::named("ncaa").expect("a preset").physics();
        Self {
            simulator: Simulator::new(&physics).expect("a preset can be simulated"),
            place: Place {
                location: MIDDLE,
                release_height_m: 7.0 * FOOT_M,
            },
            random: ChaCha12Rng::seed_from_u64(seed),
        }
    }

    fn normal(&mut self) -> f64 {
        quantile(self.random.random::<f64>().max(1e-300))
    }

    fn release(&self, values: &Values) -> Release {
        let nominal = nominal_of(values);
        Release {
            distance_m: self.place.location.distance_m,
            court_angle_rad: self.place.location.angle_rad,
            height_above_hoop_m: self.place.release_height_m
                - self.simulator.physics().hoop_plane_height_m(),
            speed_m_s: nominal.speed_m_s,
            pitch_rad: nominal.pitch_rad,
            polar_rad: nominal.polar_rad,
            backspin_rad_s: nominal.backspin_rad_s,
            rifle_spin_rad_s: 0.0,
            side_spin_rad_s: 0.0,
        }
    }

    /// A shot, and whether it goes in.
    fn shoot(&mut self) -> (Values, bool) {
        let mut z: Values = std::array::from_fn(|_| self.normal());
        z[1] = SPEED_PITCH * z[0] + (1.0 - SPEED_PITCH * SPEED_PITCH).sqrt() * z[1];
        let values = std::array::from_fn(|i| (AIM[i] + SCATTER[i] * z[i]) * UNITS[i]);
        let outcome = self
            .simulator
            .simulate(&self.release(&values))
            .expect("finite values");
        (values, outcome.verdict.made)
    }
}

/// The places of tracked shots scatter by this, m.
const PLACES_M: f64 = 0.35 * FOOT_M;

impl Player {
    /// A shot from a place that is off by [`PLACES_M`], where the player then stands. The player
    /// sees it: the shot lands as the same one from the middle does.
    fn shoot_from_about_here(&mut self) -> (Values, bool) {
        self.place.location = MIDDLE;
        let (values, _) = self.shoot();
        let landing =
            landing_of(&self.simulator, &self.place, &values).expect("it reaches the hoop");
        let x = MIDDLE.distance_m + PLACES_M * self.normal();
        let y = PLACES_M * self.normal();
        self.place.location = Location {
            distance_m: libm::hypot(x, y),
            angle_rad: libm::atan2(y, x),
        };
        let (values, _) =
            release_of_landing(&self.simulator, &self.place, &landing, &[0.0; 3], values[3])
                .expect("it lands there from here too");
        let outcome = self.simulator.simulate(&self.release(&values));
        (values, outcome.expect("finite values").verdict.made)
    }
}

fn noise(tracker: &str) -> TrackerNoise {
    Tracker::named(tracker).expect("a tracker").noise
}

fn lab() -> String {
    let mut player = Player::new(11);
    let noise = noise("lab");
    let mut text = String::from(
        "speed_ft_s,pitch_deg,aim_deg,backspin_rev_s,distance_ft,release_height_ft,made\n",
    );
    for _ in 0..60 {
        let (values, made) = player.shoot();
        let seen: Values =
            std::array::from_fn(|i| (values[i] + noise.release[i] * player.normal()) / UNITS[i]);
        let _ = writeln!(
            text,
            "{:.3},{:.2},{:.2},{:.2},13.75,7,{}",
            seen[0],
            seen[1],
            seen[2],
            seen[3],
            u8::from(made)
        );
    }
    text
}

fn gym_sensor() -> String {
    let mut player = Player::new(12);
    let noise = noise("noah").landing;
    let mut text = String::from(
        "shot,entry_angle_deg,depth_in,left_right_in,distance_ft,release_height_ft,made\n",
    );
    for shot in 1..=125 {
        let (values, made) = player.shoot();
        let landing =
            landing_of(&player.simulator, &player.place, &values).expect("it reaches the hoop");
        let depth = (landing.depth_m + noise[0] * player.normal()) / INCH_M;
        let right = (landing.right_m + noise[1] * player.normal()) / INCH_M;
        let entry = (landing.entry_angle_rad + noise[2] * player.normal()) / DEGREE_RAD;
        let _ = writeln!(
            text,
            "{shot},{entry:.1},{depth:.1},{right:.1},13.75,7,{}",
            u8::from(made)
        );
    }
    text
}

fn tracking() -> String {
    let mut player = Player::new(13);
    let noise = noise("optical_25hz");
    let mut text = String::from("shot,time_s,x_ft,y_ft,z_ft,made\n");
    let (frame_s, rho) = (1.0 / noise.frames_per_s, noise.frame_correlation);
    let height = player.simulator.physics().hoop_plane_height_m();
    for shot in 1..=60 {
        let (values, made) = player.shoot_from_about_here();
        let start = player.release(&values).state();
        let (_, fall_s) = player
            .simulator
            .undisturbed_fall_to_hoop(&start)
            .expect("it reaches the hoop");
        let phase: f64 = player.random.random();
        let mut errors = [0.0; 3];
        // From the hand, 8 frames before the release, to where the ball meets the hoop.
        for frame in -8..(fall_s / frame_s) as i32 {
            let t = (f64::from(frame) + phase) * frame_s;
            let position: [f64; 3] = if t < 0.0 {
                // Pushed from rest along the line of the release, in 0.35 s.
                let left = (1.0 + t / 0.35).max(0.0);
                (start.position_m - start.velocity_m_s * (0.175 * (1.0 - left * left))).into()
            } else {
                player
                    .simulator
                    .undisturbed_state(&start, t)
                    .position_m
                    .into()
            };
            let mut seen = [0.0; 3];
            for axis in 0..3 {
                let z = player.normal();
                errors[axis] = if frame == -8 {
                    z
                } else {
                    rho * errors[axis] + (1.0 - rho * rho).sqrt() * z
                };
                seen[axis] = position[axis] + noise.position_m * errors[axis];
            }
            let _ = writeln!(
                text,
                "{shot},{:.3},{:.2},{:.2},{:.2},{}",
                10.0 * f64::from(shot) + t,
                seen[0] / FOOT_M,
                seen[1] / FOOT_M,
                (seen[2] + height) / FOOT_M,
                u8::from(made)
            );
        }
    }
    text
}

fn main() -> std::io::Result<()> {
    let folder = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/data")),
        PathBuf::from,
    );
    let write = |name: &str, text: String| std::fs::write(Path::new(&folder).join(name), text);
    write("lab.csv", lab())?;
    write("gym_sensor.csv", gym_sensor())?;
    write("optical_tracking.csv", tracking())
}
