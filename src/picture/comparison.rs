//! Bank and direct at one place over speed and pitch angle, and their difference.

use super::colours::diverging;
use super::release_map::{self, WHOLE};
use super::report::Shot;
use super::svg::{Anchor, Svg, shortened};
use super::sweep_maps::Picture;
use crate::dynamics::Simulator;
use crate::probability::release_map::{Cells, outcomes, probabilities};
use crate::profile::Profile;
use crate::units::{DEGREE_RAD, REV_RAD, System};

/// Cells of the maps along speed and pitch angle.
pub const CELLS: (usize, usize) = (400, 300);
/// Room about the best shots: speed, in standard deviations and m/s; pitch angle, rad.
const ROOM: (f64, f64, f64) = (6.0, 0.5, 12.0 * DEGREE_RAD);
/// Standard error of a cell's P, from eight shots in each of the cells that errors reach; differences within twice that of
/// two are left white.
const CELL_ERROR: f64 = 0.004;

/// The cells of a map that shows both best shots.
fn cells(profile: &Profile, shots: &[Shot]) -> Cells {
    let (sigmas, least, pitch) = ROOM;
    let mut cells = Cells {
        speed_m_s: (f64::INFINITY, f64::NEG_INFINITY),
        pitch_rad: (f64::INFINITY, f64::NEG_INFINITY),
        columns: CELLS.0,
        rows: CELLS.1,
    };
    for shot in shots {
        let nominal = &shot.nominal;
        let room = (sigmas * profile.shooter.errors.speed_m_s(nominal.speed_m_s)).max(least);
        let widen = |range: &mut (f64, f64), value: f64, room: f64| {
            range.0 = range.0.min(value - room);
            range.1 = range.1.max(value + room);
        };
        widen(&mut cells.speed_m_s, nominal.speed_m_s, room);
        widen(&mut cells.pitch_rad, nominal.pitch_rad, pitch);
    }
    cells.speed_m_s.0 = cells.speed_m_s.0.max(0.1);
    cells.pitch_rad.0 = cells.pitch_rad.0.max(DEGREE_RAD);
    cells.pitch_rad.1 = cells.pitch_rad.1.min(89.0 * DEGREE_RAD);
    cells
}

/// Draws how shots about the best ones end, without errors: `cond` of Eq. 21 in the paper, one pixel a shot.
#[must_use]
pub fn outcomes_about(profile: &Profile, simulator: &Simulator, shots: &[Shot]) -> Option<Picture> {
    if shots.is_empty() {
        return None;
    }
    let cells = cells(profile, shots);
    let units = profile.output.units;
    let alike = shots.len() == 2 && hold_the_same(&shots[0], &shots[1]);
    let drawn = if alike { &shots[..1] } else { shots };
    let width = (drawn.len() as f64 * WHOLE.0).max(1.3 * WHOLE.0);
    let mut svg = Svg::new(width, WHOLE.1 + 60.0);
    let name = shortened(&profile.shooter.name, 60);
    let title = format!("How shots end: {name}, {}", place(profile));
    svg.heading((20.0, 24.0), 16.0, Anchor::Start, &title);
    for (i, shot) in drawn.iter().enumerate() {
        let kinds = outcomes(profile, simulator, &shot.nominal, &cells);
        let corner = (i as f64 * WHOLE.0, 34.0);
        let title = if alike {
            held(shot).replacen("direct", "direct (left) and bank", 1)
        } else {
            held(shot)
        };
        release_map::of_outcomes(&mut svg, corner, &title, &cells, units, &kinds);
        for marked in if alike { shots } else { &shots[i..=i] } {
            mark(&mut svg, corner, &cells, units, marked);
        }
    }
    let caption =
        "How each shot without errors ends, by speed and pitch angle; circles: the best shots.";
    svg.text((20.0, WHOLE.1 + 46.0), 11.0, Anchor::Start, caption);
    Some(Picture {
        name: "outcomes".to_owned(),
        svg: svg.finish(&title),
        caption: caption.to_owned(),
    })
}

/// Are the maps of two shots the same, to the eye?
fn hold_the_same(one: &Shot, other: &Shot) -> bool {
    let (a, b) = (&one.nominal, &other.nominal);
    let near = |x: f64, y: f64, by: f64| (x - y).abs() < by;
    near(a.polar_rad, b.polar_rad, 0.05 * DEGREE_RAD)
        && near(a.backspin_rad_s, b.backspin_rad_s, 0.02 * REV_RAD)
        && near(a.rifle_spin_rad_s, b.rifle_spin_rad_s, 0.02 * REV_RAD)
        && near(a.side_spin_rad_s, b.side_spin_rad_s, 0.02 * REV_RAD)
}

/// What is held in the map of a shot.
fn held(shot: &Shot) -> String {
    format!(
        "{}: polar {:.2} deg, backspin {:.1} rev/s held",
        shot.kind,
        shot.nominal.polar_rad / DEGREE_RAD + 0.0,
        shot.nominal.backspin_rad_s / REV_RAD
    )
}

fn place(profile: &Profile) -> String {
    let (long, foot) = profile.output.units.length();
    format!(
        "{:.2} {long} from the hoop at {:.1} deg",
        profile.place.distance_m / foot,
        profile.place.angle_rad / DEGREE_RAD
    )
}

/// A circle at the best shot.
fn mark(svg: &mut Svg, corner: (f64, f64), cells: &Cells, units: System, shot: &Shot) {
    let (_, foot) = units.length();
    let frame = release_map::frame(corner, cells, units);
    let at = frame.at((
        shot.nominal.speed_m_s / foot,
        shot.nominal.pitch_rad / DEGREE_RAD,
    ));
    svg.circle(
        at,
        5.0,
        "fill=\"none\" stroke=\"#ffffff\" stroke-width=\"3\"",
    );
    svg.circle(
        at,
        5.0,
        "fill=\"none\" stroke=\"#000000\" stroke-width=\"1.5\"",
    );
}

/// Draws both kinds that were found, each with its own polar angle and spin held, and their difference.
#[must_use]
pub fn in_release_space(
    profile: &Profile,
    simulator: &Simulator,
    shots: &[Shot],
) -> Option<Picture> {
    let found: Vec<(&str, &Shot)> = shots
        .iter()
        .map(|shot| (shot.kind.as_str(), shot))
        .collect();
    if shots.is_empty() {
        return None;
    }
    let cells = cells(profile, shots);
    let units = profile.output.units;
    // Where both hold the same, one map shows both, and there is no difference to draw.
    let alike = shots.len() == 2 && hold_the_same(&shots[0], &shots[1]);
    let panels = match shots.len() {
        2 if !alike => 3,
        _ => 1,
    };
    // A single panel is narrower than its heading.
    let width = (panels as f64 * WHOLE.0).max(1.3 * WHOLE.0);
    let mut svg = Svg::new(width, WHOLE.1 + 70.0);
    let name = shortened(&profile.shooter.name, 60);
    let place = place(profile);
    svg.heading(
        (20.0, 24.0),
        16.0,
        Anchor::Start,
        &format!("Bank and direct in release space: {name}, {place}"),
    );
    let mut maps = Vec::new();
    let drawn = if alike { &shots[..1] } else { shots };
    for (i, shot) in drawn.iter().enumerate() {
        let values = probabilities(profile, simulator, &shot.nominal, &cells);
        let corner = (i as f64 * WHOLE.0, 34.0);
        let title = if alike {
            held(shot).replacen("direct", "direct (left) and bank", 1)
        } else {
            held(shot)
        };
        release_map::of_probabilities(&mut svg, corner, &title, &cells, units, &values);
        for marked in if alike { shots } else { &shots[i..=i] } {
            mark(&mut svg, corner, &cells, units, marked);
        }
        maps.push(values);
    }
    if let [direct, bank] = &maps[..] {
        let most = direct
            .iter()
            .zip(bank)
            .fold(0.05, |most: f64, (a, b)| most.max((b - a).abs()));
        let sure = 2.0 * CELL_ERROR * std::f64::consts::SQRT_2;
        let colours: Vec<[u8; 3]> = direct
            .iter()
            .zip(bank)
            .map(|(a, b)| {
                let by = b - a;
                if by.abs() < sure {
                    [255, 255, 255]
                } else {
                    diverging(by / most)
                }
            })
            .collect();
        release_map::of_values(
            &mut svg,
            (2.0 * WHOLE.0, 34.0),
            "bank less direct",
            (&cells, units),
            &colours,
            ("bank \u{2212} direct", (-most, most)),
            |by| diverging(by / most),
        );
    }
    let p: Vec<String> = found
        .iter()
        .map(|(kind, shot)| format!("{kind} {:.3} \u{b1} {:.3}", shot.p.0, shot.p.1))
        .collect();
    let caption = format!("P of the best shots (circles): {}.", p.join(", "));
    let white = if panels == 3 {
        format!(
            " White in the difference: within {:.3}.",
            2.0 * CELL_ERROR * std::f64::consts::SQRT_2
        )
    } else {
        String::new()
    };
    let note = format!(
        "{caption} Errors in speed, pitch, polar angle, backspin.{white} bankshot {}",
        env!("CARGO_PKG_VERSION")
    );
    svg.text((20.0, WHOLE.1 + 52.0), 11.0, Anchor::Start, &note);
    Some(Picture {
        name: "release_space".to_owned(),
        svg: svg.finish(&caption),
        caption,
    })
}
