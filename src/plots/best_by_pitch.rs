//! P and speed of the best shot at each of several pitch angles.

use super::axes::Axes;
use super::svg::{Anchor, FAINT, INK, Plot, Svg, shortened};
use crate::best_shot::{ShotAtPitch, TableKind, TableShot};
use crate::fitting::{AngleOverDraws, Interval};
use crate::shooter::{Nominal, Profile, ShotKind};
use crate::units::{DEGREE_RAD, UnitSystem};

/// Width and height of a panel, px.
const PANEL: (f64, f64) = (330.0, 230.0);
/// Left edge of the first panel, and distance of the second one from it, px.
const LEFT: f64 = 70.0;
const APART: f64 = 430.0;
/// Letters in a line of the caption.
const CAPTION_LETTERS: usize = 130;
/// Colour of the usual shot.
const USUAL_COLOUR: &str = "#d55e00";
/// Top of the panels, px.
const TOP: f64 = 74.0;

/// The usual shot of a fit.
#[derive(Clone, Copy, Debug)]
pub struct UsualShot {
    /// The release.
    pub nominal: Nominal,
    /// Its P over the draws.
    pub probability: Interval,
}

/// Draws both curves, and the `usual` shot if it is known; `None` with fewer than two angles that
/// have a shot. P over the draws of a fit may be given, one for each row.
#[must_use]
pub fn draw(
    profile: &Profile,
    kind: TableKind,
    (rows, over_draws): (&[ShotAtPitch], &[Option<AngleOverDraws>]),
    (usual, units): (Option<UsualShot>, UnitSystem),
) -> Option<Plot> {
    let (long, metre) = units.length();
    let angles = rows.iter().filter(|row| row.shot.is_some());
    let angles: Vec<f64> = angles.map(|row| row.pitch_rad / DEGREE_RAD).collect();
    let [first, .., last] = angles[..] else {
        return None;
    };
    // Points and bars do not lie on the frame.
    let x_margin = 0.03 * (last - first);
    let mut svg = Svg::new(LEFT + APART + PANEL.0 + 30.0, TOP + PANEL.1 + 92.0);
    let name = shortened(&profile.shooter().name, 50);
    let title = match kind {
        TableKind::One(kind) => {
            format!("The best {} shot at each pitch angle: {name}", kind.name())
        }
        TableKind::Better => format!("The best shot at each pitch angle: {name}"),
    };
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, &title);
    let place = profile.location().in_words(units);
    svg.text((20.0, 46.0), 12.0, Anchor::Start, &place);
    let speed = move |shot: &TableShot| shot.nominal.speed_m_s / metre;
    let probability = |shot: &TableShot| shot.probability;
    let chances = rows
        .iter()
        .filter_map(|row| row.shot.as_ref())
        .map(probability);
    let ends = over_draws.iter().flatten().map(|angle| angle.probability);
    let chances = chances.chain(ends.flat_map(|p| [p.low, p.high]));
    // One beyond the angles would lie outside of the panels.
    let is_inside = |usual: &UsualShot| {
        (first - x_margin..=last + x_margin).contains(&(usual.nominal.pitch_rad / DEGREE_RAD))
    };
    let usual = usual.filter(is_inside);
    let of_usual = usual.map(|usual| [usual.probability.low, usual.probability.high]);
    let chances = chances.chain(of_usual.into_iter().flatten());
    let (lowest, highest) = chances.fold((1.0_f64, 0.0_f64), |(low, high), p| {
        (low.min(p), high.max(p))
    });
    let p_margin = (0.08 * (highest - lowest)).max(0.005);
    let speeds = rows.iter().filter_map(|row| row.shot.as_ref()).map(speed);
    let speeds = speeds.chain(usual.map(|usual| usual.nominal.speed_m_s / metre));
    let (slowest, fastest) = speeds.fold((f64::INFINITY, 0.0_f64), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let margin = (0.08 * (fastest - slowest)).max(0.05);
    let panel = |i: usize, y| Axes {
        corner: (LEFT + APART * i as f64, TOP),
        size: PANEL,
        x: (first - x_margin, last + x_margin),
        y,
    };
    let of_p = panel(
        0,
        ((lowest - p_margin).max(0.0), (highest + p_margin).min(1.0)),
    );
    let of_speed = panel(1, (slowest - margin, fastest + margin));
    draw_curve(&mut svg, &of_p, (rows, kind), &probability);
    for (row, angle) in rows.iter().zip(over_draws) {
        let Some(AngleOverDraws { probability, .. }) = angle else {
            continue;
        };
        let end = |p: f64| of_p.pixel((row.pitch_rad / DEGREE_RAD, p));
        let style = format!("stroke=\"{INK}\" stroke-width=\"1\" fill=\"none\"");
        svg.polyline([end(probability.low), end(probability.high)], &style);
    }
    if let Some(usual) = usual {
        draw_usual(&mut svg, &of_p, &usual);
    }
    of_p.draw(&mut svg, "", "release angle (deg)", "probability");
    draw_curve(&mut svg, &of_speed, (rows, kind), &speed);
    if let Some(UsualShot { nominal, .. }) = usual {
        let at = (nominal.pitch_rad / DEGREE_RAD, nominal.speed_m_s / metre);
        mark_usual(&mut svg, of_speed.pixel(at));
    }
    let label = format!("best speed ({long}/s)");
    of_speed.draw(&mut svg, "", "release angle (deg)", &label);
    let bars = if over_draws.is_empty() {
        ""
    } else {
        " Bars: 95 % intervals."
    };
    let kinds = match kind {
        TableKind::One(_) => "",
        TableKind::Better => " White circles: bank shots.",
    };
    let of_usual = match usual {
        Some(_) => " Square: the current shot as measured, with its 95 % interval.",
        None => "",
    };
    let caption = format!(
        "The best shot at each release angle, and its speed. Large circle: the best of all.{kinds}{bars}{of_usual}"
    );
    for (i, line) in textwrap::wrap(&caption, CAPTION_LETTERS).iter().enumerate() {
        let y = TOP + PANEL.1 + 64.0 + 15.0 * i as f64;
        svg.footnote((20.0, y), line);
    }
    Some(Plot {
        name: "best_by_pitch".to_owned(),
        svg: svg.finish(&caption),
        caption,
    })
}

/// The usual shot with the interval of its P.
fn draw_usual(svg: &mut Svg, of_p: &Axes, usual: &UsualShot) {
    let pitch_deg = usual.nominal.pitch_rad / DEGREE_RAD;
    let at = |p: f64| of_p.pixel((pitch_deg, p));
    let style = format!("stroke=\"{USUAL_COLOUR}\" stroke-width=\"2\" fill=\"none\"");
    let ends = [usual.probability.low, usual.probability.high];
    svg.polyline(ends.map(at), &style);
    mark_usual(svg, at(usual.probability.mean));
}

fn mark_usual(svg: &mut Svg, (x, y): (f64, f64)) {
    const HALF: f64 = 4.5;
    let style = format!("fill=\"{USUAL_COLOUR}\"");
    svg.rect((x - HALF, y - HALF), (2.0 * HALF, 2.0 * HALF), &style);
}

/// Draws a value of the shots as a line with points; a gap where there is no shot.
fn draw_curve(
    svg: &mut Svg,
    axes: &Axes,
    (rows, kind): (&[ShotAtPitch], TableKind),
    value: &dyn Fn(&TableShot) -> f64,
) {
    let is_of_both = kind == TableKind::Better;
    axes.draw_grid(svg);
    let style = format!("stroke=\"{INK}\" stroke-width=\"2\" fill=\"none\"");
    let point =
        |row: &ShotAtPitch, shot: &TableShot| axes.pixel((row.pitch_rad / DEGREE_RAD, value(shot)));
    for stretch in rows.split(|row| row.shot.is_none()) {
        let points = stretch
            .iter()
            .filter_map(|row| Some(point(row, row.shot.as_ref()?)));
        svg.polyline(points, &style);
    }
    let shots = rows
        .iter()
        .filter_map(|row| Some((row, row.shot.as_ref()?)));
    for (row, shot) in shots.clone() {
        let fill = match shot.kind {
            ShotKind::Bank if is_of_both => "white",
            _ => INK,
        };
        let style = format!("fill=\"{fill}\" stroke=\"{INK}\" stroke-width=\"1.5\"");
        svg.circle(point(row, shot), 3.0, &style);
    }
    let best = shots.max_by(|a, b| a.1.probability.total_cmp(&b.1.probability));
    if let Some((row, shot)) = best {
        let (x, y) = point(row, shot);
        let style = format!("fill=\"none\" stroke=\"{INK}\" stroke-width=\"2\"");
        svg.circle((x, y), 7.0, &style);
        let dashes = format!("stroke=\"{FAINT}\" stroke-dasharray=\"4 3\" fill=\"none\"");
        svg.polyline([(x, y), (x, axes.corner.1 + axes.size.1)], &dashes);
    }
}
