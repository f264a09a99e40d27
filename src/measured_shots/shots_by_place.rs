//! Shots by place, as releases from these places.

use super::row_reader::RowReader;
use super::shooter_shots::{Raw, RawShot, ShooterShots};
use super::source::Source;
use crate::fitting::{Covariance, Landing, MeasuredRelease, Place, release_of_landing};
use crate::shooter::Location;

/// Tracked releases nearer than this are from one place, m.
const SAME_PLACE_M: f64 = 0.75;
/// Releases whose heights differ by no more than this from the first belong to one place, m.
const SAME_HEIGHT_M: f64 = 0.15;

/// Sorts shots by place, and turns them into releases from these places.
pub(super) fn group_by_place(
    reader: &RowReader<'_>,
    raw: Vec<RawShot>,
    shooter: &mut ShooterShots,
) {
    let tolerance = if reader.source == Source::Trajectories {
        SAME_PLACE_M
    } else {
        0.005
    };
    let point = |place: &Place| {
        let (sin, cos) = libm::sincos(place.location.angle_rad);
        (
            place.location.distance_m * cos,
            place.location.distance_m * sin,
            place.release_height_m,
        )
    };
    let mut firsts: Vec<(f64, f64, f64)> = Vec::new();
    let mut members: Vec<Vec<usize>> = Vec::new();
    let mut of_shot = Vec::with_capacity(raw.len());
    for (i, shot) in raw.iter().enumerate() {
        let (x, y, z) = point(&shot.place);
        let near = |first: &(f64, f64, f64)| {
            libm::hypot(first.0 - x, first.1 - y) <= tolerance
                && (first.2 - z).abs() <= SAME_HEIGHT_M
        };
        let place = firsts.iter().position(near).unwrap_or_else(|| {
            firsts.push((x, y, z));
            members.push(Vec::new());
            firsts.len() - 1
        });
        members[place].push(i);
        of_shot.push(place);
    }
    shooter.places = members
        .iter()
        .map(|members| {
            let count = members.len() as f64;
            let mean = |axis: &dyn Fn((f64, f64, f64)) -> f64| {
                members
                    .iter()
                    .map(|&i| axis(point(&raw[i].place)))
                    .sum::<f64>()
                    / count
            };
            let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
            let heights = || members.iter().map(|&i| raw[i].place.release_height_m);
            let least = heights().fold(f64::INFINITY, f64::min);
            let greatest = heights().fold(f64::NEG_INFINITY, f64::max);
            if greatest > least {
                let merged = shooter.merged_heights_m.get_or_insert([least, greatest]);
                *merged = [merged[0].min(least), merged[1].max(greatest)];
            }
            // Of rows that state their place, exactly that.
            if reader.source == Source::Trajectories {
                Place {
                    location: Location {
                        distance_m: libm::hypot(x, y),
                        angle_rad: libm::atan2(y, x),
                    },
                    release_height_m: mean(&|p| p.2),
                }
            } else if greatest > least {
                Place {
                    release_height_m: mean(&|p| p.2),
                    ..raw[members[0]].place
                }
            } else {
                raw[members[0]].place
            }
        })
        .collect();
    let noise = noise_of_landings(reader, &raw, &of_shot, shooter);
    for (shot, place) in raw.into_iter().zip(of_shot) {
        let own = &shooter.places[place];
        let (values, noise) = match shot.measured {
            Raw::Release(values) => (values, reader.options.noise.release_covariance()),
            Raw::Landing(landing, backspin) => {
                let zero = [0.0; 3];
                // The ball left from its own height.
                match release_of_landing(reader.simulator, &shot.place, &landing, &zero, backspin) {
                    Ok((values, _)) => (values, noise[place]),
                    Err(error) => {
                        shooter.rejected.push((shot.row, error.to_string()));
                        continue;
                    }
                }
            }
            Raw::Flight(fit, points) => {
                // The aim counts, not the direction on the floor: shots are not from one point.
                let aim = fit.values[2] - fit.place.location.angle_rad;
                let mut values = fit.values;
                values[2] = own.location.angle_rad + aim;
                shooter.tracks.push(points);
                shooter.chi_squares.push(fit.chi_square);
                (values, fit.aim_covariance)
            }
        };
        shooter.sessions.push(shot.session);
        shooter.shot_names.push(shot.name);
        shooter.shots.push(MeasuredRelease {
            row: shot.row,
            place,
            values,
            noise,
            made: shot.made,
        });
    }
}

/// The covariance of releases from landings at each place: that of its mean landing, so that it
/// is the same for all.
fn noise_of_landings(
    reader: &RowReader<'_>,
    raw: &[RawShot],
    of_shot: &[usize],
    shooter: &ShooterShots,
) -> Vec<Covariance> {
    (0..shooter.places.len())
        .map(|place| {
            let landings: Vec<(&Landing, f64)> = raw
                .iter()
                .zip(of_shot)
                .filter(|(_, of)| **of == place)
                .filter_map(|(shot, _)| match &shot.measured {
                    Raw::Landing(landing, spin) => Some((landing, *spin)),
                    _ => None,
                })
                .collect();
            let count = landings.len().max(1) as f64;
            let mean = |value: &dyn Fn(&Landing) -> f64| {
                landings
                    .iter()
                    .map(|(landing, _)| value(landing))
                    .sum::<f64>()
                    / count
            };
            let middle = Landing {
                depth_m: mean(&|l| l.depth_m),
                right_m: mean(&|l| l.right_m),
                entry_angle_rad: mean(&|l| l.entry_angle_rad),
            };
            let spin = landings.iter().map(|(_, spin)| spin).sum::<f64>() / count;
            let noise = &reader.options.noise;
            release_of_landing(
                reader.simulator,
                &shooter.places[place],
                &middle,
                &noise.landing,
                spin,
            )
            .map(|(_, mut covariance)| {
                covariance[(3, 3)] = noise.release[3] * noise.release[3];
                covariance
            })
            .unwrap_or_else(|_| noise.release_covariance())
        })
        .collect()
}
