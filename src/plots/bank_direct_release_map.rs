//! The best bank and the best direct shot of a location in release space: maps over speed and pitch
//! angle about them, and the difference of these maps.
//!
//! Each map has the polar angle and the spins of its own shot. If both shots have nearly the same,
//! one map shows both.

use super::colormaps::{NOT_SIGNIFICANT, Rgb, diverging};
use super::colour_key::ColourScale;
use super::release_map::{MAP_SIZE, ReleaseMap};
use super::shot_with_probability::PlottedShot;
use super::svg::Plot;
use super::svg::{Anchor, Svg, shortened};
use crate::analysis::release_map::{ReleaseCells, outcomes, probabilities};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, REV_RAD};
use std::f64::consts::SQRT_2;

/// Cells of a map along speed and pitch angle.
const CELLS: (usize, usize) = (400, 300);
/// Range of a map on each side of a shot: the speed in standard deviations, but at least this many
/// m/s; the pitch angle in rad.
const SPEED_MARGIN_SIGMAS: f64 = 6.0;
const MIN_SPEED_MARGIN_M_S: f64 = 0.5;
const PITCH_MARGIN_RAD: f64 = 12.0 * DEGREE_RAD;
/// Standard error of a cell's P: each of the cells that errors reach has eight shots.
const CELL_STANDARD_ERROR: f64 = 0.004;
/// Differences of P below twice the standard error of a difference are not significant.
const MIN_SIGNIFICANT: f64 = 2.0 * CELL_STANDARD_ERROR * SQRT_2;
/// y of the maps, px; the title stands above them.
const MAPS_TOP: f64 = 34.0;

/// Draws the outcomes of error-free shots about the best shots, `cond` in Eq. 21 of the paper, one
/// pixel for each shot; `None` if there are no shots.
#[must_use]
pub fn draw_outcomes(profile: &Profile, shots: &[PlottedShot]) -> Option<Plot> {
    let maps = BestShotMaps::new(profile, shots)?;
    let mut svg = maps.empty_drawing(maps.mapped_shots().len(), 60.0);
    let title = format!("How shots end: {}", maps.subject());
    svg.heading((20.0, 24.0), 16.0, Anchor::Start, &title);
    for (i, shot) in maps.mapped_shots().iter().enumerate() {
        let kinds = outcomes(profile, &shot.nominal, &maps.cells);
        maps.map(i)
            .draw_outcomes(&mut svg, &maps.map_title(shot), &kinds);
        maps.mark_shots(&mut svg, i);
    }
    let caption =
        "How each error-free shot ends, by speed and pitch angle; circles: the best shots.";
    svg.footnote((20.0, MAP_SIZE.1 + 46.0), caption);
    Some(Plot {
        name: "outcomes".to_owned(),
        svg: svg.finish(&title),
        caption: caption.to_owned(),
    })
}

/// Draws P about the best shots, and the difference of bank and direct; `None` if there are no
/// shots.
#[must_use]
pub fn draw_probabilities(profile: &Profile, shots: &[PlottedShot]) -> Option<Plot> {
    let maps = BestShotMaps::new(profile, shots)?;
    let has_difference = maps.mapped_shots().len() == 2;
    let mut svg = maps.empty_drawing(if has_difference { 3 } else { 1 }, 70.0);
    let title = format!("Bank and direct in release space: {}", maps.subject());
    svg.heading((20.0, 24.0), 16.0, Anchor::Start, &title);
    let mut values = Vec::new();
    for (i, shot) in maps.mapped_shots().iter().enumerate() {
        let p = probabilities(profile, &shot.nominal, &maps.cells);
        maps.map(i)
            .draw_probabilities(&mut svg, &maps.map_title(shot), &p);
        maps.mark_shots(&mut svg, i);
        values.push(p);
    }
    if let [direct, bank] = &values[..] {
        draw_difference(&mut svg, &maps.map(2), direct, bank);
    }
    let caption = format!("Best shots (circles): {}.", maps.best_probabilities());
    let white = if has_difference {
        format!(" White in the difference: within {MIN_SIGNIFICANT:.3}.")
    } else {
        String::new()
    };
    let note = format!(
        "{caption} Errors in speed, pitch, polar angle, backspin.{white} bankshot {}",
        env!("CARGO_PKG_VERSION")
    );
    svg.footnote((20.0, MAP_SIZE.1 + 52.0), &note);
    Some(Plot {
        name: "release_space".to_owned(),
        svg: svg.finish(&caption),
        caption,
    })
}

fn draw_difference(svg: &mut Svg, map: &ReleaseMap<'_>, direct: &[f64], bank: &[f64]) {
    let differences: Vec<f64> = direct.iter().zip(bank).map(|(a, b)| b - a).collect();
    let largest = differences
        .iter()
        .fold(0.05, |largest: f64, by| largest.max(by.abs()));
    let colour = |by: f64| diverging(by / largest);
    let colours: Vec<Rgb> = differences
        .iter()
        .map(|&by| {
            if by.abs() < MIN_SIGNIFICANT {
                NOT_SIGNIFICANT
            } else {
                colour(by)
            }
        })
        .collect();
    let scale = ColourScale {
        name: "bank \u{2212} direct",
        range: (-largest, largest),
        colour: &colour,
    };
    map.draw_colours(svg, "bank minus direct", &colours, &scale);
}

/// The maps about the best shots, side by side with the same axes.
struct BestShotMaps<'a> {
    profile: &'a Profile,
    shots: &'a [PlottedShot],
    cells: ReleaseCells,
    /// Whether one map shows both shots.
    is_shared: bool,
}

impl<'a> BestShotMaps<'a> {
    fn new(profile: &'a Profile, shots: &'a [PlottedShot]) -> Option<Self> {
        if shots.is_empty() {
            return None;
        }
        Some(Self {
            profile,
            shots,
            cells: cells_about(profile, shots),
            is_shared: shots.len() == 2 && have_same_map(&shots[0], &shots[1]),
        })
    }

    /// The shots that have a map of their own.
    fn mapped_shots(&self) -> &[PlottedShot] {
        if self.is_shared {
            &self.shots[..1]
        } else {
            self.shots
        }
    }

    /// A drawing with space for some maps, `space` px above and below them together.
    fn empty_drawing(&self, maps: usize, space: f64) -> Svg {
        // The title is wider than a single map.
        let width = (maps as f64 * MAP_SIZE.0).max(1.3 * MAP_SIZE.0);
        Svg::new(width, MAP_SIZE.1 + space)
    }

    fn map(&self, i: usize) -> ReleaseMap<'_> {
        ReleaseMap {
            corner: (i as f64 * MAP_SIZE.0, MAPS_TOP),
            cells: &self.cells,
            units: self.profile.output().units,
        }
    }

    /// Marks the shots that belong to the `i`-th map.
    fn mark_shots(&self, svg: &mut Svg, i: usize) {
        let shots = if self.is_shared {
            self.shots
        } else {
            &self.shots[i..=i]
        };
        for shot in shots {
            self.map(i).mark_shot(svg, &shot.nominal);
        }
    }

    /// The shooter and the location.
    fn subject(&self) -> String {
        let (long, unit_m) = self.profile.output().units.length();
        let location = self.profile.location();
        format!(
            "{}, {:.2} {long} from the hoop at {:.1} deg",
            shortened(&self.profile.shooter().name, 60),
            location.distance_m / unit_m,
            location.angle_rad / DEGREE_RAD
        )
    }

    /// The kind of a map's shot and the values that are fixed in the map.
    fn map_title(&self, shot: &PlottedShot) -> String {
        let kind = if self.is_shared {
            "direct (left) and bank"
        } else {
            shot.kind.name()
        };
        format!(
            "{kind}: polar {:.2} deg, backspin {:.1} rev/s fixed",
            // Adding 0 turns a negative zero into zero.
            shot.nominal.polar_rad / DEGREE_RAD + 0.0,
            shot.nominal.backspin_rad_s / REV_RAD
        )
    }

    fn best_probabilities(&self) -> String {
        let texts: Vec<String> = self
            .shots
            .iter()
            .map(|shot| {
                format!(
                    "{} {:.3} \u{b1} {:.3}",
                    shot.kind.name(),
                    shot.probability,
                    shot.standard_error
                )
            })
            .collect();
        texts.join(", ")
    }
}

/// Cells that show all shots.
fn cells_about(profile: &Profile, shots: &[PlottedShot]) -> ReleaseCells {
    let dispersion = &profile.shooter().dispersion;
    let mut speed = (f64::INFINITY, f64::NEG_INFINITY);
    let mut pitch = (f64::INFINITY, f64::NEG_INFINITY);
    let widen = |range: &mut (f64, f64), value: f64, margin: f64| {
        range.0 = range.0.min(value - margin);
        range.1 = range.1.max(value + margin);
    };
    for shot in shots {
        let nominal = &shot.nominal;
        let sigma_m_s = dispersion.speed_m_s(nominal.speed_m_s);
        let margin = (SPEED_MARGIN_SIGMAS * sigma_m_s).max(MIN_SPEED_MARGIN_M_S);
        widen(&mut speed, nominal.speed_m_s, margin);
        widen(&mut pitch, nominal.pitch_rad, PITCH_MARGIN_RAD);
    }
    ReleaseCells {
        speed_m_s: (speed.0.max(0.1), speed.1),
        pitch_rad: (pitch.0.max(DEGREE_RAD), pitch.1.min(89.0 * DEGREE_RAD)),
        columns: CELLS.0,
        rows: CELLS.1,
    }
}

/// Whether the maps of two shots look the same: their polar angles and spins are nearly equal.
fn have_same_map(one: &PlottedShot, other: &PlottedShot) -> bool {
    let (a, b) = (&one.nominal, &other.nominal);
    let near = |x: f64, y: f64, tolerance: f64| (x - y).abs() < tolerance;
    near(a.polar_rad, b.polar_rad, 0.05 * DEGREE_RAD)
        && near(a.backspin_rad_s, b.backspin_rad_s, 0.02 * REV_RAD)
        && near(a.rifle_spin_rad_s, b.rifle_spin_rad_s, 0.02 * REV_RAD)
        && near(a.side_spin_rad_s, b.side_spin_rad_s, 0.02 * REV_RAD)
}
