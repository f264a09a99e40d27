//! Tracked shots: the points of each, and the flight that is fitted to them.

use super::columns::{Label, Quantity};
use super::made_or_missed::parse_made;
use super::row_reader::{FARTHEST_LANDING_M, IS_MISSING, RowReader};
use super::shooter_shots::{Raw, RawShot};
use crate::fitting::{TrackedPoint, TrackerNoise, fit_flight, noise_of_tracks};
use crate::units::FOOT_M;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A height that every shot rises through, m.
const LOW_RELEASE_M: f64 = 1.5;

/// Shots that begin farther than this behind the plane of the hoop's centre are behind the board,
/// m.
const BEHIND_BOARD_M: f64 = 0.5;

/// A tracked shot: its first row, session and name, and its points and result.
struct TrackedShot {
    row: u64,
    session: String,
    name: String,
    track: Result<(Vec<TrackedPoint>, Option<bool>), String>,
}

/// The tracked shots of some rows.
fn tracks(reader: &RowReader<'_>, rows: &[(u64, &[String])]) -> Vec<TrackedShot> {
    let mut by_shot: Vec<(String, Vec<(u64, &[String])>)> = Vec::new();
    let mut index = BTreeMap::new();
    for &(row, cells) in rows {
        let part = |label| reader.label(cells, label).unwrap_or_default();
        let shot = [Label::Shooter, Label::Session, Label::Shot]
            .map(part)
            .join("\n");
        let at = *index.entry(shot.clone()).or_insert_with(|| {
            by_shot.push((shot, Vec::new()));
            by_shot.len() - 1
        });
        by_shot[at].1.push((row, cells));
    }
    let z0 = reader.simulator.physics().hoop_plane_height_m();
    let shots = by_shot.iter().map(|(_, rows)| {
        let (row, cells) = rows[0];
        let label = |label| reader.label(cells, label).unwrap_or_default().to_owned();
        TrackedShot {
            row,
            session: label(Label::Session),
            name: label(Label::Shot),
            track: track(reader, rows, z0),
        }
    });
    shots.collect()
}

/// The frame rate and the noise of the tracker, from all flights of a file; `None` where they do
/// not tell it.
pub(super) fn noise_of_file(
    reader: &RowReader<'_>,
    rows: &[(u64, &[String])],
) -> Option<TrackerNoise> {
    let shots = tracks(reader, rows);
    let points: Vec<&[TrackedPoint]> = shots
        .iter()
        .filter_map(|shot| Some(shot.track.as_ref().ok()?.0.as_slice()))
        .collect();
    noise_of_tracks(&points)
}

/// The flights of the tracked shots, each at its own place.
///
/// # Errors
/// Most shots begin behind the board.
pub(super) fn tracked_shots(
    reader: &RowReader<'_>,
    rows: &[(u64, &[String])],
    rejected: &mut Vec<(u64, String)>,
) -> Result<Vec<RawShot>, String> {
    let tracks = tracks(reader, rows);
    let noise = &reader.options.noise;
    let backspin = reader.options.backspin_rad_s.unwrap_or(0.0);
    let shooter = rows
        .first()
        .and_then(|(_, cells)| reader.label(cells, Label::Shooter))
        .unwrap_or_default();
    let height = reader.options.release_height_m(shooter).unwrap_or_else(|| {
        let begins = tracks.par_iter().filter_map(|shot| {
            reader.progress.advance(0);
            let (points, _) = shot.track.as_ref().ok()?;
            let fit = fit_flight(reader.simulator, points, noise, LOW_RELEASE_M, backspin).ok()?;
            Some(fit.begins_at_m)
        });
        let mut begins: Vec<f64> = begins.collect();
        begins.sort_by(f64::total_cmp);
        begins
            .get(begins.len() / 2)
            .map_or(LOW_RELEASE_M, |height| height.max(LOW_RELEASE_M))
    });
    let fits: Vec<Result<RawShot, (u64, String)>> = tracks
        .into_par_iter()
        .map(|shot| {
            let TrackedShot {
                row,
                session,
                name,
                track,
            } = shot;
            let (points, made) = track.map_err(|reason| (row, reason))?;
            reader.progress.advance(points.len() as u64);
            let fit = fit_flight(reader.simulator, &points, noise, height, backspin)
                .map_err(|error| (row, format!("trajectory: {error}")))?;
            let used = points[fit.points.clone()].to_vec();
            Ok(RawShot {
                row,
                session,
                name,
                made,
                place: fit.place,
                measured: Raw::Flight(Box::new(fit), used),
            })
        })
        .collect();
    let mut raw = Vec::new();
    for fit in fits {
        match fit {
            Ok(shot) => raw.push(shot),
            Err(reason) => rejected.push(reason),
        }
    }
    let places: Vec<(f64, f64)> = raw.iter().map(|shot| shot.place.location.to_xy()).collect();
    let behind = places.iter().filter(|(x, _)| *x < -BEHIND_BOARD_M).count();
    if 2 * behind > places.len() {
        return Err(reader.options.frame.advice_behind_board(&places));
    }
    Ok(raw)
}

/// The points of one shot in the coordinates of the hoop, and whether it went in.
fn track(
    reader: &RowReader<'_>,
    rows: &[(u64, &[String])],
    z0: f64,
) -> Result<(Vec<TrackedPoint>, Option<bool>), String> {
    let mut points = Vec::with_capacity(rows.len());
    let (mut made, mut start_s) = (None, None);
    for &(row, cells) in rows {
        let need = |quantity: Quantity| {
            let value = reader
                .value(cells, quantity)
                .map_err(|error| format!("row {row}: {error}"))?;
            value.ok_or_else(|| format!("column {} is missing", quantity.name()))
        };
        made = made.or(parse_made(
            reader.label(cells, Label::Made).unwrap_or_default(),
        )?);
        let position = [Quantity::X, Quantity::Y, Quantity::Z].map(need);
        // A frame in which the ball was not seen.
        let is_gap = |value: &Result<f64, String>| {
            value
                .as_ref()
                .is_err_and(|reason| reason.ends_with(IS_MISSING))
        };
        if position.iter().any(is_gap) {
            continue;
        }
        // From the first frame on: a clock may count from 1970.
        let time_s = need(Quantity::Time)?;
        let start_s = *start_s.get_or_insert(time_s);
        let [x, y, z] = position;
        points.push(TrackedPoint {
            time_s: time_s - start_s,
            position_m: [x?, y?, z? - z0],
        });
    }
    if points.is_empty() {
        return Err("no frame has all coordinates of the ball".to_owned());
    }
    let floor: Vec<(f64, f64)> = points
        .iter()
        .map(|p| (p.position_m[0], p.position_m[1]))
        .collect();
    for (point, (x, y)) in points
        .iter_mut()
        .zip(reader.options.frame.from_hoop(&floor))
    {
        (point.position_m[0], point.position_m[1]) = (x, y);
    }
    let nearest = points
        .iter()
        .map(|p| libm::hypot(p.position_m[0], p.position_m[1]))
        .fold(f64::INFINITY, f64::min);
    if nearest > 2.0 * FARTHEST_LANDING_M {
        return Err(format!(
            "the ball comes no nearer than {:.1} ft to the hoop: is it another hoop, or another --frame?",
            nearest / FOOT_M
        ));
    }
    Ok((points, made))
}
