//! The two sessions of a comparison.

use crate::cli::commands::fit::{failure, report_rejected};
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::{MeasuredFile, MeasuredShotsOptions};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::print_remark;
use crate::fitting::{
    DrawProbabilities, FitNote, MeasuredRelease, Place, Posterior, session_names, share_unseen,
    usual_probabilities, values_at_height,
};
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::model::SolidId;
use crate::probability::{Progress, Pulse};
use crate::shooter::Profile;
use crate::store::fit::{Fit, SHOTS};
use crate::units::UnitSystem;
use std::path::Path;

/// A fitted session.
pub(super) struct Session {
    pub(super) name: String,
    /// Whether the name is from the column of a file.
    pub(super) is_of_column: bool,
    /// The number of places, and the index of the one that is compared.
    pub(super) places: usize,
    pub(super) place: usize,
    /// Its name; empty where the file does not say.
    pub(super) place_name: String,
    pub(super) posterior: Posterior,
    /// Made at this place, and all with a result.
    pub(super) makes: (usize, usize),
    /// P of the usual shot at this place.
    pub(super) probabilities: DrawProbabilities,
    /// The profile at this place.
    pub(super) profile: Profile,
    /// Their name, if the file has it.
    pub(super) shooter: Option<String>,
    /// What should be said of the fit.
    pub(super) notes: Vec<FitNote>,
    pub(super) units: UnitSystem,
}

impl Session {
    /// How a warning names it: a session of a file may be called `1`.
    pub(super) fn title(&self) -> String {
        if self.is_of_column {
            format!("session {}", self.name)
        } else {
            self.name.clone()
        }
    }

    /// A session is a fit at one of its places.
    fn of(name: String, mut fit: Fit, number: Option<u32>) -> Result<Self, Failure> {
        let place = fit_folder::index_of_place(number, fit.profiles.len())?;
        Ok(Self {
            name,
            is_of_column: false,
            places: fit.profiles.len(),
            place,
            place_name: fit.place_names.swap_remove(place),
            probabilities: fit.usual_probabilities(place),
            posterior: fit.posterior,
            makes: fit.observed[place],
            profile: fit.profiles.swap_remove(place),
            shooter: fit.shooter,
            notes: fit.notes,
            units: fit.units,
        })
    }
}

/// A session from a file or from the folder of a fit.
pub(super) fn read(
    path: &Path,
    measured: &MeasuredShotsOptions,
    place: Option<u32>,
) -> Result<Session, Failure> {
    let name = path.display().to_string();
    if path.is_dir() {
        return Session::of(name, fit_folder::read(path)?, place);
    }
    let file = measured.read(path)?;
    let shots = file.only_shooter()?;
    report_rejected(&file, shots, true);
    let fit = file
        .fit(shots, &ProgressBars::new())
        .map_err(|error| failure(&name, &error))?;
    Session::of(name, Fit::of(fit, shots, &file.tracker.0), place)
}

/// Ring, backspin and the tracker's constant error are those of both sessions: they are no change.
pub(super) fn share_what_no_sensor_sees([before, after]: &mut [Session; 2]) -> Result<(), Failure> {
    let places = [
        (&mut before.posterior, before.place),
        (&mut after.posterior, after.place),
    ];
    let ring = share_unseen(places);
    for session in [before, after] {
        if let Some(ring) = ring {
            session.profile = session.profile.with(|settings| {
                let set = settings.physics.set_restitution_on(SolidId::Ring, ring);
                debug_assert!(set.is_ok(), "a ring of a gym");
            })?;
        }
        session.probabilities =
            usual_probabilities(&session.profile, &session.posterior, session.place, SHOTS);
    }
    Ok(())
}

/// Fits of one physics can be compared. What no sensor sees is shared by then.
pub(super) fn refuse_other_physics([before, after]: &[Session; 2]) -> Result<(), Failure> {
    if before.profile.physics() != after.profile.physics() {
        return Err(Failure::usage(format!(
            "{} and {} were fitted with different physics; fit both with the same --physics",
            before.name, after.name
        )));
    }
    Ok(())
}

/// Warns where two shooters, or two places, are compared.
pub(super) fn warn_of_differences([before, after]: &[Session; 2]) {
    if let (Some(first), Some(second)) = (&before.shooter, &after.shooter)
        && first != second
    {
        print_remark(&format!(
            "warning: these are the shots of {first} and of {second}: two shooters differ in more than what changed"
        ));
    }
    let place = |session: &Session| {
        let location = session.profile.location();
        let height_m = session.profile.shooter().release_height_m;
        (location.distance_m, location.angle_rad, height_m)
    };
    let (a, b) = (place(before), place(after));
    let moved_m = libm::fabs(a.0 - b.0)
        .max(a.0 * libm::fabs(a.1 - b.1))
        .max(libm::fabs(a.2 - b.2));
    if moved_m > SAME_PLACE_M {
        print_remark(
            "warning: the sessions are from different places; speed, angle and makes per 100 are for each place",
        );
    }
}

/// Brings the means of the second session to the release height of the first, along its usual
/// flight, where heights of one place were estimated or given apart. P does not depend on it.
pub(super) fn to_one_release_height([before, after]: &mut [Session; 2], units: UnitSystem) {
    let place = Place {
        location: after.profile.location(),
        release_height_m: after.profile.shooter().release_height_m,
    };
    let height_m = before.profile.shooter().release_height_m;
    let apart_m = libm::fabs(place.release_height_m - height_m);
    if !(SAME_HEIGHT_M..=SAME_PLACE_M).contains(&apart_m) {
        return;
    }
    let usual = after.posterior.typical().means[after.place];
    let simulator = after.profile.simulator();
    let Some(moved) = values_at_height(simulator, &place, &usual, height_m) else {
        return;
    };
    for draw in &mut after.posterior.draws {
        for (mean, (to, from)) in draw.means[after.place]
            .iter_mut()
            .zip(moved.iter().zip(usual))
        {
            *mean += to - from;
        }
    }
    let (long, metre) = units.length();
    print_remark(&format!(
        "the release heights are {:.2} and {:.2} {long}: speeds and angles of both sessions are those at {:.2} {long}",
        height_m / metre,
        place.release_height_m / metre,
        height_m / metre,
    ));
}

/// Release heights nearer than this are the same, m: 0.004 m/s in speed.
const SAME_HEIGHT_M: f64 = 0.002;
/// Places nearer than this are the same, m.
const SAME_PLACE_M: f64 = 0.15;

/// The two sessions of a shooter: those that are `wanted`, or all.
pub(super) fn fit_by_session(
    file: &MeasuredFile,
    shots: &ShooterShots,
    (wanted, number): (&[String], Option<u32>),
    bars: &ProgressBars,
) -> Result<[Session; 2], Failure> {
    let place = file.file.display().to_string();
    report_rejected(file, shots, file.shooters.len() == 1);
    let mut names = session_names(&shots.sessions);
    let listed = names
        .iter()
        .map(|name| name.as_str())
        .collect::<Vec<_>>()
        .join(", ");
    if let Some(missing) = wanted.iter().find(|wanted| !names.contains(wanted)) {
        return Err(Failure::usage(format!(
            "{place}: has no session {missing}; it has {listed}"
        )));
    }
    if !wanted.is_empty() {
        names = wanted.iter().collect();
        names.dedup();
    }
    let [first, second] = names[..] else {
        return Err(Failure::usage(match &names[..] {
            [] => format!("{place}: has no shots"),
            [one] if one.is_empty() => format!(
                "{place}: has no column session: say which column it is with --map 'session=COLUMN', or give two files"
            ),
            [one] if !wanted.is_empty() => {
                format!("--session {one}: name two sessions; {place} has {listed}")
            }
            [one] => format!("{place}: has one session, {one}; give a file with two, or two files"),
            more => format!(
                "{place}: has {} sessions ({listed}); choose two with --session NAME --session NAME",
                more.len()
            ),
        }));
    };
    let fit = |session: &String, other: &String| -> Result<Session, Failure> {
        let kept = only_session(shots, session, other);
        let fit = file
            .fit(&kept, &Pulse(bars))
            .map_err(|error| failure(&place, &error))?;
        bars.advance(1);
        Ok(Session {
            is_of_column: true,
            ..Session::of(
                session.clone(),
                Fit::of(fit, &kept, &file.tracker.0),
                number,
            )?
        })
    };
    Ok([fit(first, second)?, fit(second, first)?])
}

/// The shots of one session. Its places are those that it has shots from, those that the other
/// session has too first, so that the same place is compared.
fn only_session(shots: &ShooterShots, session: &str, other: &str) -> ShooterShots {
    let of_session: Vec<_> = shots.shots.iter().zip(&shots.sessions).collect();
    let has = |place: usize, name: &str| {
        let mut all = of_session.iter();
        all.any(|(shot, of)| shot.place == place && *of == name)
    };
    let mut places: Vec<usize> = (0..shots.places.len())
        .filter(|place| has(*place, session))
        .collect();
    places.sort_by_cached_key(|place| !has(*place, other));
    let kept = of_session.iter().filter(|(_, of)| *of == session);
    let kept = kept.map(|(shot, _)| {
        let place = places.iter().position(|place| *place == shot.place);
        MeasuredRelease {
            place: place.unwrap_or(0),
            ..(*shot).clone()
        }
    });
    ShooterShots {
        shots: kept.collect(),
        sessions: Vec::new(),
        places: places.iter().map(|place| shots.places[*place]).collect(),
        place_scatter: places
            .iter()
            .map(|place| shots.place_scatter[*place])
            .collect(),
        place_names: places
            .iter()
            .map(|place| shots.place_names[*place].clone())
            .collect(),
        tracks: Vec::new(),
        chi_squares: Vec::new(),
        ..shots.clone()
    }
}
