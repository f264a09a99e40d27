//! The table `[location]`: distance and angle, or x and y.

use super::diagnostics::Diagnostic;
use super::toml_reader::TableReader;
use crate::model::Physics;
use crate::shooter::Location;
use crate::units::Dimension;
use std::f64::consts::PI;

pub(super) fn read_location(
    mut table: TableReader<'_, '_>,
    physics: &Physics,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Location> {
    let is_cartesian = table.has("x") || table.has("y");
    if is_cartesian && (table.has("distance") || table.has("angle")) {
        diagnostics.push(table.diagnostic("x", "give either distance and angle, or x and y"));
    }
    let (location, key) = if is_cartesian {
        // Known keys, although they are not read.
        let _ = table.quantity("distance", Dimension::Length, diagnostics);
        let _ = table.quantity("angle", Dimension::Angle, diagnostics);
        let x = table.required("x", Dimension::Length, diagnostics);
        let y = table.required("y", Dimension::Length, diagnostics);
        (x.zip(y).map(|(x, y)| Location::from_xy(x, y)), "x")
    } else {
        let _ = table.quantity("x", Dimension::Length, diagnostics);
        let _ = table.quantity("y", Dimension::Length, diagnostics);
        (read_polar(&mut table, diagnostics), "distance")
    };
    let problem = location
        .and_then(|location| location.check(physics).err())
        .map(|error| table.diagnostic(key, error.to_string()));
    table.report_unknown_keys(diagnostics);
    if problem.is_some() {
        diagnostics.extend(problem);
        return None;
    }
    location
}

fn read_polar(
    table: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Location> {
    let distance = table.required("distance", Dimension::Length, diagnostics);
    let angle = table.required("angle", Dimension::Angle, diagnostics);
    let (distance_m, angle_rad) = (distance?, angle?);
    let before = diagnostics.len();
    if !(distance_m > 0.0) {
        diagnostics.push(table.diagnostic("distance", "must be above 0"));
    }
    if !(angle_rad.abs() <= PI) {
        diagnostics.push(table.diagnostic("angle", "must be between -180 and 180 deg"));
    }
    (diagnostics.len() == before).then_some(Location {
        distance_m,
        angle_rad,
    })
}
