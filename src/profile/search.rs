//! Sizes of the table, bounds of the search and where results go, from TOML.

use super::fault::Fault;
use super::keys::Keys;
use super::read::{FASTEST_M_S, check};
use super::template::GivenSearch;
use super::{CHOICES, Choice, Grid, Intent, Output, Shooter};
use crate::units::{DEGREE_RAD, Dimension, System};
use std::ops::RangeInclusive;

/// Pitch angles that can be searched.
const PITCHES_RAD: RangeInclusive<f64> = DEGREE_RAD..=89.0 * DEGREE_RAD;

pub(super) fn read_grid(root: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Grid {
    let mut keys = root.table("grid", faults);
    let mut grid = Grid::default();
    for (key, place) in [
        ("speed", &mut grid.speed),
        ("pitch", &mut grid.pitch),
        ("polar", &mut grid.polar),
        ("backspin", &mut grid.backspin),
    ] {
        if let Some(count) = keys.count(key, 2..=100_000, faults) {
            *place = usize::try_from(count).unwrap_or(usize::MAX);
        }
    }
    keys.finish(faults);
    grid
}

/// The search, and a fault in the place of what it chooses, for those found later.
pub(super) fn read_search(
    root: &mut Keys<'_, '_>,
    faults: &mut Vec<Fault>,
) -> (GivenSearch, Fault) {
    let mut keys = root.table("search", faults);
    let mut pitch = |key, faults: &mut Vec<Fault>| {
        let value = keys.quantity(key, Dimension::Angle, faults);
        let holds = |a: f64| PITCHES_RAD.contains(&a);
        check(&keys, key, value, holds, "from 1 to 89 deg", faults)
    };
    let pitch_min_rad = pitch("pitch_min", faults);
    let pitch_max_rad = pitch("pitch_max", faults);
    if let Some((low, high)) = pitch_min_rad.zip(pitch_max_rad)
        && !(low < high)
    {
        let most = high / DEGREE_RAD;
        faults.push(keys.fault(
            "pitch_min",
            format!("must be less than pitch_max ({most:.1} deg)"),
        ));
    }
    let speed = keys.quantity("speed_max", Dimension::Speed, faults);
    let speed_max_m_s = check(
        &keys,
        "speed_max",
        speed,
        |v| v > 0.0 && v <= FASTEST_M_S,
        "above 0 and at most 40 m/s",
        faults,
    );
    let error = keys.quantity("standard_error", Dimension::Number, faults);
    let standard_error = check(
        &keys,
        "standard_error",
        error,
        |e| (1e-5..=0.1).contains(&e),
        "from 0.00001 to 0.1",
        faults,
    );
    let mut search = GivenSearch {
        choose: Choice::default(),
        pitch_min_rad,
        pitch_max_rad,
        speed_max_m_s,
        standard_error,
        climb_samples: keys
            .count("climb_samples", 64..=65536, faults)
            .and_then(|count| u32::try_from(count).ok()),
        seed: keys.count("seed", 0..=u64::MAX, faults),
    };
    if let Some(names) = keys.texts("choose", faults) {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        if names.is_empty() || names.iter().any(|name| !CHOICES.contains(name)) {
            let known = CHOICES.join(", ");
            faults.push(keys.fault("choose", format!("must name one or more of {known}")));
        }
        search.choose = Choice::only(&names);
    }
    let chosen = keys.fault("choose", "");
    keys.finish(faults);
    (search, chosen)
}

/// Holds what the search does not choose, which the profile must then give.
pub(super) fn hold(
    search: GivenSearch,
    shooter: &Shooter,
    nominal: &Intent,
    chosen: &Fault,
    faults: &mut Vec<Fault>,
) -> GivenSearch {
    let mut refuse = |message: &str| {
        faults.push(Fault {
            message: message.to_owned(),
            ..chosen.clone()
        });
    };
    let mut search = search;
    let choose = search.choose;
    if !choose.speed && nominal.speed_m_s.is_none() {
        refuse("leaves speed out, so [nominal] must give it");
    }
    if !choose.pitch {
        match nominal.pitch_rad {
            Some(pitch_rad) if PITCHES_RAD.contains(&pitch_rad) => {
                search.pitch_min_rad = Some(pitch_rad);
                search.pitch_max_rad = Some(pitch_rad);
            }
            Some(_) => refuse("leaves pitch out, so [nominal] must give it from 1 to 89 deg"),
            None => refuse("leaves pitch out, so [nominal] must give it"),
        }
    }
    if choose.side_spin && !(shooter.max_side_spin_rad_s > 0.0) {
        refuse("names side_spin, so [shooter] must give max_side_spin, above 0");
    }
    search
}

pub(super) fn read_output(root: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Output {
    let mut keys = root.table("output", faults);
    let mut output = Output::default();
    if let Some(folder) = keys.text("folder", faults) {
        if folder.is_empty() || folder.contains('\0') {
            faults.push(keys.fault("folder", "must be the name of a folder"));
        }
        output.folder = folder;
    }
    match keys.text("units", faults).as_deref() {
        None | Some("imperial") => {}
        Some("metric") => output.units = System::Metric,
        Some(_) => faults.push(keys.fault("units", "must be \"imperial\" or \"metric\"")),
    }
    keys.finish(faults);
    output
}
