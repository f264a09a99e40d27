//! From TOML text to a checked [`Profile`].

use super::fault::{Fault, ProfileError};
use super::keys::Keys;
use super::place::read_place;
use super::search::{hold, read_grid, read_output, read_search};
use super::template::Template;
use super::world::read_physics;
use super::{Correlation, ERROR_NAMES, Errors, Intent, Profile, Shooter};
use crate::dynamics::Integrator;
use crate::physics::Physics;
use crate::units::Dimension;
use std::f64::consts::PI;
use std::sync::LazyLock;
use toml::de::DeTable;

/// Largest profile that is read, in bytes.
pub const LARGEST_PROFILE_BYTES: u64 = 16 * 1024 * 1024;
/// Greatest speed that a search may be given, m/s.
pub(super) const FASTEST_M_S: f64 = 40.0;
/// Longest name of a shooter, in characters.
const LONGEST_NAME: usize = 500;

/// Reads a profile; `origin` names it in messages.
///
/// ```
/// let text = r#"
///     [shooter]
///     release_height = "7 ft"
///     max_backspin = "3 rev/s"
///     [shooter.errors]
///     c10 = "0.25 ft/s"
///     c20 = "1.2 deg"
///     c30 = "1.22 deg"
///     c40 = "0.3 rev/s"
///     [location]
///     distance = "13.75 ft"
///     angle = "0 deg"
/// "#;
/// let profile = bankshot::profile::parse(text, "example")?;
/// assert_eq!(profile.place.distance_m, 13.75 * 0.3048);
/// # Ok::<(), bankshot::profile::ProfileError>(())
/// ```
///
/// # Errors
/// Every fault of the profile at once.
pub fn parse(text: &str, origin: &str) -> Result<Profile, ProfileError> {
    with_table(text, origin, |mut keys, faults| {
        let place_at = keys.table("location", faults);
        let place_key = place_at.clone();
        let template = read_template(&mut keys, faults);
        let physics = template
            .as_ref()
            .map_or_else(Physics::paper, |template| template.physics.clone());
        let place = read_place(place_at, &physics, faults);
        keys.finish(faults);
        let profile = template?.at(place?);
        if let Err(error) = &profile {
            faults.push(place_key.here(error.to_string()));
        }
        profile.ok()
    })
}

/// Reads all of a profile but its place.
pub(crate) fn read_template(keys: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Option<Template> {
    let shooter = read_shooter(keys, faults);
    let nominal = read_nominal(keys, faults);
    let physics = read_physics(keys, faults);
    match shooter {
        Some(shooter) => read_rest(keys, shooter, nominal, physics, faults),
        None => {
            // For their faults.
            read_grid(keys, faults);
            read_search(keys, faults);
            read_output(keys, faults);
            None
        }
    }
}

/// Reads what is left of a profile beside the shooter, the nominal values, the physics and the place.
pub(crate) fn read_rest(
    keys: &mut Keys<'_, '_>,
    shooter: Shooter,
    nominal: Intent,
    (physics, integrator): (Physics, Integrator),
    faults: &mut Vec<Fault>,
) -> Option<Template> {
    let grid = read_grid(keys, faults);
    let (search, chosen) = read_search(keys, faults);
    let output = read_output(keys, faults);
    let search = hold(search, &shooter, &nominal, &chosen, faults);
    Some(Template {
        shooter,
        nominal,
        physics,
        integrator,
        grid,
        search,
        output,
    })
}

/// Reads a file that holds only a `[physics]` table (or a profile, of which the rest is ignored).
///
/// # Errors
/// Every fault of the table at once.
pub fn parse_physics(text: &str, origin: &str) -> Result<(Physics, Integrator), ProfileError> {
    with_table(text, origin, |mut keys, faults| {
        if !keys.has("physics") {
            faults.push(keys.fault("physics", "there is no [physics] table in this file"));
        }
        Some(read_physics(&mut keys, faults))
    })
}

/// Reads a TOML text by `read`; every fault at once.
pub(crate) fn with_table<T>(
    text: &str,
    origin: &str,
    read: impl FnOnce(Keys<'_, '_>, &mut Vec<Fault>) -> Option<T>,
) -> Result<T, ProfileError> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut faults: Vec<Fault> = errors
        .into_iter()
        .map(|error| Fault {
            span: error.span().unwrap_or(0..0),
            key: String::new(),
            message: format!("not TOML: {}", error.message()),
        })
        .collect();
    let syntax_is_sound = faults.is_empty();
    let result = read(Keys::root(&table), &mut faults);
    match result {
        Some(value) if faults.is_empty() => Ok(value),
        _ => {
            if !syntax_is_sound {
                // What follows from broken syntax would only confuse.
                faults.retain(|fault| fault.key.is_empty());
            }
            faults.sort_by_key(|fault| fault.span.start);
            Err(ProfileError {
                origin: origin.to_owned(),
                text: text.to_owned(),
                faults,
            })
        }
    }
}

pub(crate) fn check(
    keys: &Keys<'_, '_>,
    key: &str,
    value: Option<f64>,
    holds: impl Fn(f64) -> bool,
    allowed: &str,
    faults: &mut Vec<Fault>,
) -> Option<f64> {
    let value = value?;
    if holds(value) {
        return Some(value);
    }
    faults.push(keys.fault(key, format!("must be {allowed}")));
    None
}

fn read_shooter(root: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Option<Shooter> {
    let mut keys = root.table("shooter", faults);
    let name = keys
        .text("name", faults)
        .unwrap_or_else(|| "shooter".to_owned());
    if name.chars().count() > LONGEST_NAME {
        faults.push(keys.fault(
            "name",
            format!("must have at most {LONGEST_NAME} characters"),
        ));
    }
    if name.chars().any(char::is_control) {
        faults.push(keys.fault("name", "must not contain control characters"));
    }
    let height = keys.required("release_height", Dimension::Length, faults);
    let height = check(
        &keys,
        "release_height",
        height,
        |h| h > 0.0 && h < 10.0,
        "above 0 and below 10 m",
        faults,
    );
    let spin = keys.required("max_backspin", Dimension::Spin, faults);
    let spin = check(
        &keys,
        "max_backspin",
        spin,
        |w| (0.0..=200.0).contains(&w),
        "0 to 200 rad/s (31.8 rev/s)",
        faults,
    );
    let side_spin = keys.quantity("max_side_spin", Dimension::Spin, faults);
    let side_spin = check(
        &keys,
        "max_side_spin",
        side_spin,
        |w| (0.0..=200.0).contains(&w),
        "0 to 200 rad/s (31.8 rev/s)",
        faults,
    );
    let mut table = keys.table("errors", faults);
    let errors = read_errors(&mut table, spin.unwrap_or(0.0), faults);
    table.finish(faults);
    let correlation = read_correlation(&mut keys, faults);
    let errors = errors.map(|errors| Errors {
        correlation,
        ..errors
    });
    keys.finish(faults);
    Some(Shooter {
        name,
        release_height_m: height?,
        max_backspin_rad_s: spin?,
        max_side_spin_rad_s: side_spin.unwrap_or(0.0),
        errors: errors?,
    })
}

fn read_errors(keys: &mut Keys<'_, '_>, max_spin: f64, faults: &mut Vec<Fault>) -> Option<Errors> {
    let before = faults.len();
    let mut sigma = |key, dimension, faults: &mut Vec<Fault>| {
        let value = keys.required(key, dimension, faults);
        check(keys, key, value, |s| s >= 0.0, "0 or more", faults)
    };
    let c10 = sigma("c10", Dimension::Speed, faults);
    let c20 = sigma("c20", Dimension::Angle, faults);
    let c30 = sigma("c30", Dimension::Angle, faults);
    let c40 = sigma("c40", Dimension::Spin, faults);
    for (key, value) in [("c20", c20), ("c30", c30)] {
        check(
            keys,
            key,
            value,
            |s| s < 0.5,
            "below 0.5 rad (28.6 deg)",
            faults,
        );
    }
    let c11 = keys
        .quantity("c11", Dimension::Number, faults)
        .unwrap_or(0.0);
    let c12 = keys
        .quantity("c12", Dimension::PerSpeed, faults)
        .unwrap_or(0.0);
    let c41 = keys
        .quantity("c41", Dimension::Number, faults)
        .unwrap_or(0.0);
    let c42 = keys
        .quantity("c42", Dimension::PerSpin, faults)
        .unwrap_or(0.0);
    let mut more = |key, dimension, most: f64, allowed: &str, faults: &mut Vec<Fault>| {
        let value = keys.quantity(key, dimension, faults);
        check(
            keys,
            key,
            value,
            |s| (0.0..=most).contains(&s),
            allowed,
            faults,
        )
        .unwrap_or(0.0)
    };
    let spin_range = "from 0 to 200 rad/s (31.8 rev/s)";
    let rifle_spin_rad_s = more("rifle_spin", Dimension::Spin, 200.0, spin_range, faults);
    let side_spin_rad_s = more("side_spin", Dimension::Spin, 200.0, spin_range, faults);
    let length_range = "from 0 to 1 m (3.28 ft)";
    let distance_m = more("distance", Dimension::Length, 1.0, length_range, faults);
    let height_m = more("height", Dimension::Length, 1.0, length_range, faults);
    let angle_range = "from 0 to 0.5 rad (28.6 deg)";
    let court_angle_rad = more("court_angle", Dimension::Angle, 0.5, angle_range, faults);
    let errors = Errors {
        rifle_spin_rad_s,
        side_spin_rad_s,
        distance_m,
        court_angle_rad,
        height_m,
        correlation: Correlation::NONE,
        c10_m_s: c10?,
        c11,
        c12_s_m: c12,
        c20_rad: c20?,
        c30_rad: c30?,
        c40_rad_s: c40?,
        c41,
        c42_s_rad: c42,
    };
    // Eq. 28 must stay a standard deviation, and one of this world, over all that can be nominal.
    let scan = |to: f64, most: f64, sigma: &dyn Fn(f64) -> f64| {
        (0..=200).all(|i| (0.0..=most).contains(&sigma(to * f64::from(i) / 200.0)))
    };
    if !scan(FASTEST_M_S, 10.0, &|v| errors.speed_m_s(v)) {
        faults.push(keys.fault(
            "c10",
            "c10 + c11 v + c12 v^2 must be from 0 to 10 m/s for every speed up to 40 m/s",
        ));
    }
    if !scan(max_spin, 200.0, &|w| errors.backspin_rad_s(w)) {
        faults.push(keys.fault(
            "c40",
            "c40 + c41 w + c42 w^2 must be from 0 to 200 rad/s for every backspin up to max_backspin",
        ));
    }
    (faults.len() == before).then_some(errors)
}

/// `[shooter.correlation]`: keys such as `speed_pitch`, each a number from -1 to 1.
fn read_correlation(shooter: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Correlation {
    let mut keys = shooter.table("correlation", faults);
    let mut pairs = Vec::new();
    for (i, j, key) in PAIRS.iter() {
        let value = keys.quantity(key, Dimension::Number, faults);
        let value = check(
            &keys,
            key,
            value,
            |r| (-1.0..=1.0).contains(&r),
            "from -1 to 1",
            faults,
        );
        pairs.extend(value.map(|value| (*i, *j, value)));
    }
    let correlation = Correlation::new(&pairs);
    let impossible = correlation.is_none().then(|| {
        let least = Correlation::least_eigenvalue(&pairs);
        keys.here(format!("these coefficients are impossible together: the matrix of correlations is not positive semi-definite (its least eigenvalue is {least:.3})"))
    });
    keys.finish(faults);
    faults.extend(impossible);
    correlation.unwrap_or(Correlation::NONE)
}

/// The keys of `[shooter.correlation]` with the places of their two errors, in the order of
/// [`ERROR_NAMES`].
static PAIRS: LazyLock<Vec<(usize, usize, &'static str)>> = LazyLock::new(|| {
    let mut pairs = Vec::new();
    for (i, first) in ERROR_NAMES.iter().enumerate() {
        for (j, second) in ERROR_NAMES.iter().enumerate().skip(i + 1) {
            // 36 short names, once in the life of the program.
            let key: &'static str = format!("{first}_{second}").leak();
            pairs.push((i, j, key));
        }
    }
    pairs
});

/// `[nominal]`: what the shooter means to do.
fn read_nominal(root: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Intent {
    let mut keys = root.table("nominal", faults);
    let mut read = |key: &'static str, dimension| {
        let value = keys.quantity(key, dimension, faults);
        let (holds, allowed): (fn(f64) -> bool, &str) = intended(dimension);
        check(&keys, key, value, holds, allowed, faults)
    };
    let intent = Intent {
        speed_m_s: read("speed", Dimension::Speed),
        pitch_rad: read("pitch", Dimension::Angle),
        polar_rad: read("polar", Dimension::Angle),
        backspin_rad_s: read("backspin", Dimension::Spin),
        rifle_spin_rad_s: read("rifle_spin", Dimension::Spin),
        side_spin_rad_s: read("side_spin", Dimension::Spin),
    };
    keys.finish(faults);
    intent
}

/// What a nominal value may be.
fn intended(dimension: Dimension) -> (fn(f64) -> bool, &'static str) {
    match dimension {
        Dimension::Speed => (
            |v| v > 0.0 && v <= FASTEST_M_S,
            "above 0 and at most 40 m/s",
        ),
        Dimension::Angle => (|a| a.abs() <= PI, "between -180 and 180 deg"),
        _ => (|w| w.abs() <= 200.0, "within 200 rad/s (31.8 rev/s)"),
    }
}
