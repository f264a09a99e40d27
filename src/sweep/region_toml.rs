//! The keys of a sweep that give its region.

use super::court_region::Region;
use crate::config::Diagnostic;
use crate::config::toml_reader::TableReader;
use crate::units::Dimension;
use std::f64::consts::FRAC_PI_2;

/// Least spacing of places, m and rad.
const MIN_STEP_M: f64 = 0.001;
/// See [`MIN_STEP_M`].
const MIN_STEP_RAD: f64 = 1e-5;
/// Greatest width of a range, SI units.
const MAX_RANGE: f64 = 1000.0;

/// A kind of region with its keys.
struct RegionKind {
    name: &'static str,
    required: &'static [&'static str],
    optional: &'static [&'static str],
}

const KINDS: [RegionKind; 5] = [
    RegionKind {
        name: "half_court",
        required: &["step"],
        optional: &["within"],
    },
    RegionKind {
        name: "rectangle",
        required: &["step", "x", "y"],
        optional: &[],
    },
    RegionKind {
        name: "arcs",
        required: &["distances", "angle_step"],
        optional: &["angles"],
    },
    RegionKind {
        name: "three_point_line",
        required: &["step"],
        optional: &[],
    },
    RegionKind {
        name: "places",
        required: &[],
        optional: &["places", "names"],
    },
];

const REGION_KEYS: [&str; 9] = [
    "step",
    "within",
    "x",
    "y",
    "distances",
    "angles",
    "angle_step",
    "places",
    "names",
];

/// The values of the keys, as far as they are given.
struct RegionValues {
    step_m: Option<f64>,
    within: Option<String>,
    x_m: Option<(f64, f64)>,
    y_m: Option<(f64, f64)>,
    distances_m: Option<Vec<f64>>,
    angles_rad: Option<(f64, f64)>,
    angle_step_rad: Option<f64>,
    locations: Option<Vec<(f64, f64)>>,
}

/// Reads the region. `locations` is the content of the file that `places` names.
pub(super) fn read_region(
    table: &mut TableReader<'_, '_>,
    locations: Option<Result<Vec<(f64, f64)>, String>>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Region> {
    let before = diagnostics.len();
    let name = table.text("region", diagnostics);
    let mut values = read_values(table, diagnostics);
    let kind = KINDS.iter().find(|kind| Some(kind.name) == name.as_deref());
    match kind {
        Some(kind) => check_keys(table, kind, diagnostics),
        None => {
            let message = "must be \"half_court\", \"rectangle\", \"arcs\", \"three_point_line\" or \"places\"";
            diagnostics.push(table.diagnostic("region", message));
        }
    }
    let inside_three = match values.within.as_deref() {
        None | Some("court") => false,
        Some("three_point_line") => true,
        Some(_) => {
            let message = "must be \"court\" or \"three_point_line\"";
            diagnostics.push(table.diagnostic("within", message));
            false
        }
    };
    if kind.is_some_and(|kind| kind.name == "places") && table.has("places") == table.has("names") {
        let message = "the region \"places\" needs one of: names = [\"left elbow\", ...] (or [\"all\"]), or places = the name of a CSV file";
        diagnostics.push(table.diagnostic("region", message));
    }
    match locations {
        Some(Ok(locations)) => values.locations = Some(locations),
        Some(Err(message)) => diagnostics.push(table.diagnostic("places", message)),
        None => {}
    }
    if diagnostics.len() > before {
        return None;
    }
    Some(match kind?.name {
        "half_court" => Region::HalfCourt {
            step_m: values.step_m?,
            inside_three,
        },
        "rectangle" => Region::Rectangle {
            step_m: values.step_m?,
            x_m: values.x_m?,
            y_m: values.y_m?,
        },
        "arcs" => Region::Arcs {
            distances_m: values.distances_m?,
            angles_rad: values.angles_rad.unwrap_or((-FRAC_PI_2, FRAC_PI_2)),
            step_rad: values.angle_step_rad?,
        },
        "three_point_line" => Region::ThreePointLine {
            step_m: values.step_m?,
        },
        _ => Region::Locations(values.locations?),
    })
}

fn read_values(table: &mut TableReader<'_, '_>, diagnostics: &mut Vec<Diagnostic>) -> RegionValues {
    let step_m = table.quantity("step", Dimension::Length, diagnostics);
    if step_m.is_some_and(|step| !(step >= MIN_STEP_M)) {
        diagnostics.push(table.diagnostic("step", "must be 0.001 m or more"));
    }
    let within = table.text("within", diagnostics);
    let x_m = read_range(table, "x", Dimension::Length, diagnostics);
    let y_m = read_range(table, "y", Dimension::Length, diagnostics);
    let distances_m = table.quantities("distances", Dimension::Length, diagnostics);
    let angles_rad = read_range(table, "angles", Dimension::Angle, diagnostics);
    let angle_step_rad = table.quantity("angle_step", Dimension::Angle, diagnostics);
    if angle_step_rad.is_some_and(|step| !(step >= MIN_STEP_RAD)) {
        diagnostics.push(table.diagnostic("angle_step", "must be 0.00001 rad or more"));
    }
    // Read with the file that it names.
    let _ = table.text("places", diagnostics);
    RegionValues {
        step_m,
        within,
        x_m,
        y_m,
        distances_m,
        angles_rad,
        angle_step_rad,
        locations: None,
    }
}

/// Reports keys that the kind of region needs or does not have.
fn check_keys(table: &TableReader<'_, '_>, kind: &RegionKind, diagnostics: &mut Vec<Diagnostic>) {
    let name = kind.name;
    for key in kind.required {
        if !table.has(key) {
            let message = format!("is missing; the region \"{name}\" needs it");
            diagnostics.push(table.diagnostic(key, message));
        }
    }
    for key in REGION_KEYS {
        if table.has(key) && !kind.required.contains(&key) && !kind.optional.contains(&key) {
            let message = format!("does not belong to the region \"{name}\"");
            diagnostics.push(table.diagnostic(key, message));
        }
    }
}

/// Two quantities, the lower first.
fn read_range(
    table: &mut TableReader<'_, '_>,
    key: &'static str,
    dimension: Dimension,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<(f64, f64)> {
    let values = table.quantities(key, dimension, diagnostics)?;
    match values[..] {
        [low, high] if low < high && high - low < MAX_RANGE => Some((low, high)),
        _ => {
            let message = "must be two quantities, the lower first";
            diagnostics.push(table.diagnostic(key, message));
            None
        }
    }
}
