//! The table `[location]`: distance and angle, x and y, or the name of a place.

use super::diagnostics::Diagnostic;
use super::toml_reader::TableReader;
use crate::model::Physics;
use crate::model::league_courts::League;
use crate::model::named_places::{place_named, place_names_in_words};
use crate::shooter::Location;
use crate::units::Dimension;
use std::f64::consts::PI;

pub(super) fn read_location(
    mut table: TableReader<'_, '_>,
    physics: &Physics,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Location> {
    if table.has("place") || table.has("court") {
        return read_named(table, physics, diagnostics);
    }
    // Known keys, although they are not there.
    let _ = table.text("place", diagnostics);
    let _ = table.text("court", diagnostics);
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

/// `place = "left elbow"`, on the court of the physics or of `court`.
fn read_named(
    mut table: TableReader<'_, '_>,
    physics: &Physics,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Location> {
    let others = ["distance", "angle", "x", "y"];
    if let Some(other) = others.into_iter().find(|key| table.has(key)) {
        diagnostics.push(table.diagnostic(other, "give either this or place"));
        return None;
    }
    for key in ["distance", "x", "y"] {
        let _ = table.quantity(key, Dimension::Length, diagnostics);
    }
    let _ = table.quantity("angle", Dimension::Angle, diagnostics);
    let name = table.text("place", diagnostics);
    let court = table.text("court", diagnostics);
    let league = match court.as_deref().map(League::from_name) {
        None => Some(League::of_physics(physics)),
        Some(Some(league)) => Some(league),
        Some(None) => {
            let message = "must be \"ncaa\", \"nba\", \"fiba\" or \"high_school\"";
            diagnostics.push(table.diagnostic("court", message));
            None
        }
    };
    if name.is_none() {
        diagnostics.push(table.diagnostic("court", "needs place = \"...\" beside it"));
    }
    let place = name
        .as_ref()
        .zip(league)
        .and_then(|(name, league)| place_named(name, league));
    if name.is_some() && league.is_some() && place.is_none() {
        let message = format!("must be {}", place_names_in_words());
        diagnostics.push(table.diagnostic("place", message));
    }
    table.report_unknown_keys(diagnostics);
    place.map(|place| Location::from_xy(place.x_m, place.y_m))
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
