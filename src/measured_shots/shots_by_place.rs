//! Shots by place, as the releases from these places that land as the shots did.

use super::places::{middle, shots_of_places};
use super::row_reader::RowReader;
use super::shooter_shots::{Raw, RawShot, ShooterShots};
use super::source::Source;
use crate::fitting::{
    Covariance, FlightFit, Landing, LandingError, MeasuredRelease, OwnPath, Place, PlaceScatter,
    Values, landing_of, own_path, release_of_landing, release_of_uncertain_landing,
};
use rayon::prelude::*;

/// What became of a shot, as a release from the place of its group.
struct AtPlace {
    values: Values,
    noise: Covariance,
    own: Option<OwnPath>,
}

/// Sorts shots by place. A shot keeps its landing: its release is the one from the place of its
/// group that lands alike, and it remembers its own path.
pub(super) fn group_by_place(
    reader: &RowReader<'_>,
    raw: Vec<RawShot>,
    shooter: &mut ShooterShots,
) {
    let own_places: Vec<Place> = raw.iter().map(|shot| shot.place).collect();
    let is_stated = reader.source != Source::Trajectories;
    let groups = shots_of_places(&own_places, is_stated, &|| reader.progress.advance(0));
    let mut group_of_shot = vec![0; raw.len()];
    for (group, shots) in groups.iter().enumerate() {
        for &shot in shots {
            group_of_shot[shot] = group;
        }
    }
    shooter.places = groups
        .iter()
        .map(|shots| middle(&own_places, shots))
        .collect();
    shooter.place_scatter = groups.iter().map(|shots| scatter(&raw, shots)).collect();
    let noise = noise_of_landings(reader, &raw, &groups, shooter);
    let at_place = |(shot, group): (&RawShot, &usize)| {
        let (place, from) = (&shooter.places[*group], &shot.place);
        // The rows of flights and of counted shots are done already.
        let is_row = matches!(shot.measured, Raw::Release(_) | Raw::Landing(..));
        reader.progress.advance(u64::from(is_row));
        match &shot.measured {
            Raw::Nothing => Ok(AtPlace {
                values: Values::default(),
                noise: Covariance::zeros(),
                own: None,
            }),
            Raw::Release(values) => of_release(reader, (from, values), place),
            Raw::Landing(landing, backspin) => {
                of_landing(reader, (from, landing), place, (&noise[*group], *backspin))
            }
            Raw::Flight(fit, _) => of_flight(reader, fit, place),
        }
    };
    let found = raw.par_iter().zip(&group_of_shot).map(at_place);
    let found: Vec<Result<AtPlace, LandingError>> = found.collect();
    for ((shot, group), found) in raw.into_iter().zip(group_of_shot).zip(found) {
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                shooter.rejected.push((shot.row, error.to_string()));
                continue;
            }
        };
        if let Raw::Flight(fit, points) = shot.measured {
            shooter.tracks.push(points);
            shooter.chi_squares.push(fit.chi_square);
        }
        shooter.sessions.push(shot.session);
        shooter.shot_names.push(shot.name);
        shooter.shots.push(MeasuredRelease {
            row: shot.row,
            place: group,
            values: found.values,
            noise: found.noise,
            made: shot.made,
            own: found.own,
        });
    }
}

fn of_release(
    reader: &RowReader<'_>,
    (from, values): (&Place, &Values),
    place: &Place,
) -> Result<AtPlace, LandingError> {
    let noise = reader.options.noise.release_covariance();
    if from == place {
        return Ok(AtPlace {
            values: *values,
            noise,
            own: None,
        });
    }
    let landing = landing_of(reader.simulator, from, values).ok_or(LandingError)?;
    let (there, _) = release_of_landing(reader.simulator, place, &landing, &[0.0; 3], values[3])?;
    let own = own_path(reader.simulator, (from, values), (place, &there)).ok_or(LandingError)?;
    // The errors of the release, carried to the place.
    let back = own.change.try_inverse().ok_or(LandingError)?;
    let mut carried = noise;
    let small = back * noise.fixed_view::<3, 3>(0, 0) * back.transpose();
    carried.fixed_view_mut::<3, 3>(0, 0).copy_from(&small);
    Ok(AtPlace {
        values: there,
        noise: carried,
        own: Some(own),
    })
}

fn of_landing(
    reader: &RowReader<'_>,
    (from, landing): (&Place, &Landing),
    place: &Place,
    (noise, backspin): (&Covariance, f64),
) -> Result<AtPlace, LandingError> {
    let release = |place| release_of_landing(reader.simulator, place, landing, &[0.0; 3], backspin);
    let (values, _) = release(place)?;
    let own = if from == place {
        None
    } else {
        let (there, _) = release(from)?;
        own_path(reader.simulator, (from, &there), (place, &values))
    };
    Ok(AtPlace {
        values,
        noise: *noise,
        own,
    })
}

fn of_flight(
    reader: &RowReader<'_>,
    fit: &FlightFit,
    place: &Place,
) -> Result<AtPlace, LandingError> {
    let landing = (&fit.landing, &fit.landing_covariance);
    let (values, noise) =
        release_of_uncertain_landing(reader.simulator, place, landing, fit.values[3])?;
    Ok(AtPlace {
        values,
        noise,
        own: own_path(
            reader.simulator,
            (&fit.place, &fit.values),
            (place, &values),
        ),
    })
}

/// How far the releases of a group lie apart, less what the tracker's errors give.
fn scatter(raw: &[RawShot], shots: &[usize]) -> PlaceScatter {
    let sd = |value: &dyn Fn(&Place) -> f64, noise: &dyn Fn(&FlightFit) -> f64| {
        let count = shots.len() as f64;
        let mean = shots.iter().map(|&i| value(&raw[i].place)).sum::<f64>() / count;
        let square: f64 = shots
            .iter()
            .map(|&i| {
                let off = value(&raw[i].place) - mean;
                let noise = match &raw[i].measured {
                    Raw::Flight(fit, _) => noise(fit),
                    _ => 0.0,
                };
                off * off * count / (count - 1.0).max(1.0) - noise
            })
            .sum();
        (square / count).max(0.0).sqrt()
    };
    PlaceScatter {
        distance_m: sd(&|p| p.location.distance_m, &|fit| fit.place_variances[0]),
        court_angle_rad: sd(&|p| p.location.angle_rad, &|fit| fit.place_variances[1]),
        height_m: sd(&|p| p.release_height_m, &|_| 0.0),
    }
}

/// The covariance of releases from landings at each place: that of its mean landing, so that it
/// is the same for all.
fn noise_of_landings(
    reader: &RowReader<'_>,
    raw: &[RawShot],
    groups: &[Vec<usize>],
    shooter: &ShooterShots,
) -> Vec<Covariance> {
    let noise = &reader.options.noise;
    groups
        .iter()
        .zip(&shooter.places)
        .map(|(shots, place)| {
            let landings: Vec<(&Landing, f64)> = shots
                .iter()
                .filter_map(|&shot| match &raw[shot].measured {
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
            release_of_landing(reader.simulator, place, &middle, &noise.landing, spin)
                .map(|(_, mut covariance)| {
                    covariance[(3, 3)] = noise.release[3] * noise.release[3];
                    covariance
                })
                .unwrap_or_else(|_| noise.release_covariance())
        })
        .collect()
}
