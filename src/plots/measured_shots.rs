//! Plots of measured shots and of what was fitted to them.

use super::axes::Axes;
use super::svg::{Anchor, FAINT, INK, Plot, Svg, shortened};
use crate::fitting::{
    CENTRE_DEPTH_M, Interval, Landing, MeasuredRelease, PredictedBin, ShooterFit, SpinSource,
    Values, landing_of, nominal_of, release_of_landing, session_names,
};
use crate::units::{DEGREE_RAD, INCH_M, UnitSystem};
use rayon::prelude::*;
use std::ops::Range;

const MADE: &str = "#0072b2";
const MISSED: &str = "#d55e00";
const UNKNOWN: &str = "#666666";
const ZONE: [u8; 4] = [190, 225, 190, 255];
const OUTSIDE: [u8; 4] = [250, 250, 250, 255];
/// The picture of the make zone reaches this far from the hoop's centre, at least and at most.
const LEAST_HALF_WIDTH_M: f64 = 16.0 * INCH_M;
const MOST_HALF_WIDTH_M: f64 = 36.0 * INCH_M;
/// Cells of the make zone along depth and across.
const ZONE_CELLS: (usize, usize) = (72, 72);
/// Two-dimensional normal: 95 % are within this many standard deviations.
const RADIUS_95: f64 = 2.447_747;
/// More sessions than this are not named in a plot.
const MOST_NAMED_SESSIONS: usize = 8;
/// Points of an ellipse.
const ELLIPSE_POINTS: usize = 96;

/// All plots of a fit; of several places, the releases and the make zone of each. `sessions` has
/// the session of each shot, with empty texts where there is none.
#[must_use]
pub fn all(
    fit: &ShooterFit,
    shots: &[MeasuredRelease],
    sessions: &[String],
    units: UnitSystem,
) -> Vec<Plot> {
    // Of makes alone there is nothing else to draw.
    if fit.posterior.spin == SpinSource::NothingMeasured {
        return vec![intervals(fit, units)];
    }
    let mut plots = Vec::new();
    for place in 0..fit.places.len() {
        plots.push(release_scatter(fit, place, shots, units));
        plots.push(make_zone(fit, place, shots, units));
    }
    if !fit.makes.bins.is_empty() {
        plots.push(reliability(fit));
    }
    if fit.predictive.bins().next().is_some() {
        plots.push(predicted(fit, units));
    }
    plots.extend([drift(fit, shots, sessions, units), intervals(fit, units)]);
    plots
}

fn named(fit: &ShooterFit, name: &str, what: &str, svg: Svg) -> Plot {
    let shooter = if fit.name.is_empty() {
        "shooter"
    } else {
        &fit.name
    };
    let title = format!("{shooter}: {what}");
    Plot {
        name: name.to_owned(),
        caption: title.clone(),
        svg: svg.finish(&title),
    }
}

/// The name of a plot, and of several places the place in words.
fn of_place(
    fit: &ShooterFit,
    place: usize,
    name: &str,
    units: UnitSystem,
) -> (String, Option<String>) {
    if fit.places.len() == 1 {
        return (name.to_owned(), None);
    }
    let from = fit.places[place].location.in_words(units);
    // The first place has the name that the only one would have.
    let name = match place {
        0 => name.to_owned(),
        _ => format!("{name}_place_{}", place + 1),
    };
    (name, Some(format!("place {}: {from}", place + 1)))
}

/// Writes what a plot shows, and below it the place, if there are several; gives both.
fn title(svg: &mut Svg, what: &str, place: Option<&String>) -> String {
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, what);
    match place {
        None => what.to_owned(),
        Some(place) => {
            svg.text((20.0, 46.0), 12.0, Anchor::Start, place);
            format!("{what}, {place}")
        }
    }
}

/// The marker of a shot.
fn mark(svg: &mut Svg, at: (f64, f64), made: Option<bool>) {
    match made {
        Some(true) => svg.circle(at, 3.5, &format!("fill=\"{MADE}\" fill-opacity=\"0.75\"")),
        Some(false) => {
            let style = format!("stroke=\"{MISSED}\" stroke-width=\"1.8\" fill=\"none\"");
            let ((x, y), d) = (at, 3.5);
            svg.polyline([(x - d, y - d), (x + d, y + d)], &style);
            svg.polyline([(x - d, y + d), (x + d, y - d)], &style);
        }
        None => svg.circle(at, 3.0, &format!("fill=\"{UNKNOWN}\" fill-opacity=\"0.7\"")),
    }
}

fn key(svg: &mut Svg, (x, y): (f64, f64), shots: &[MeasuredRelease], last: &str) {
    let mut at = x;
    let kinds = [
        (Some(true), "made"),
        (Some(false), "missed"),
        (None, "result unknown"),
    ];
    for (made, name) in kinds {
        if shots.iter().any(|shot| shot.made == made) {
            mark(svg, (at, y - 4.0), made);
            svg.text((at + 9.0, y), 11.0, Anchor::Start, name);
            at += 30.0 + 7.0 * name.len() as f64;
        }
    }
    svg.polyline(
        [(at, y - 4.0), (at + 22.0, y - 4.0)],
        &format!("stroke=\"{INK}\" fill=\"none\""),
    );
    svg.text((at + 28.0, y), 11.0, Anchor::Start, last);
}

fn shots_at(shots: &[MeasuredRelease], place: usize) -> Vec<MeasuredRelease> {
    let here = shots.iter().filter(|shot| shot.place == place);
    here.cloned().collect()
}

/// A range of values with a margin.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let margin = 0.08 * (high - low).max(1e-3);
    (low - margin, high + margin)
}

/// The 95 % ellipse of two of the values at a place.
fn ellipse(fit: &ShooterFit, place: usize, (i, j): (usize, usize)) -> Vec<(f64, f64)> {
    let draw = &fit.typical;
    let sds = draw.sds_at(place);
    let correlation = draw.correlation[(i, j)];
    let (mean, other) = (draw.means[place][i], draw.means[place][j]);
    let root = (1.0 - correlation * correlation).max(0.0).sqrt();
    (0..=ELLIPSE_POINTS)
        .map(|k| {
            let angle = std::f64::consts::TAU * k as f64 / ELLIPSE_POINTS as f64;
            let (sin, cos) = libm::sincos(angle);
            let (a, b) = (
                RADIUS_95 * cos,
                RADIUS_95 * (correlation * cos + root * sin),
            );
            (mean + sds[i] * a, other + sds[j] * b)
        })
        .collect()
}

fn release_scatter(
    fit: &ShooterFit,
    place: usize,
    shots: &[MeasuredRelease],
    units: UnitSystem,
) -> Plot {
    let (long, metre) = units.length();
    let angle = fit.places[place].location.angle_rad;
    let shots = shots_at(shots, place);
    let (name, from) = of_place(fit, place, "releases", units);
    let mut svg = Svg::new(980.0, 470.0);
    let title = title(&mut svg, "Measured releases", from.as_ref());
    let display = |k: usize, value: f64| match k {
        0 => value / metre,
        2 => (value - angle) / DEGREE_RAD,
        _ => value / DEGREE_RAD,
    };
    let speed_label = format!("speed ({long}/s)");
    let labels = [
        &speed_label,
        "pitch angle (deg)",
        "aim from the line to the hoop (deg, left is +)",
    ];
    for (panel, (i, j)) in [(0, 1), (2, 0)].into_iter().enumerate() {
        let curve = ellipse(fit, place, (i, j));
        let x = range(
            shots
                .iter()
                .map(|s| display(i, s.values[i]))
                .chain(curve.iter().map(|p| display(i, p.0))),
        );
        // What went to the left is on the left.
        let axes = Axes {
            corner: (80.0 + 480.0 * panel as f64, 70.0),
            size: (380.0, 320.0),
            x: if i == 2 { (x.1, x.0) } else { x },
            y: range(
                shots
                    .iter()
                    .map(|s| display(j, s.values[j]))
                    .chain(curve.iter().map(|p| display(j, p.1))),
            ),
        };
        axes.draw_grid(&mut svg);
        for shot in &shots {
            let at = axes.pixel((display(i, shot.values[i]), display(j, shot.values[j])));
            mark(&mut svg, at, shot.made);
        }
        let line = curve
            .iter()
            .map(|p| axes.pixel((display(i, p.0), display(j, p.1))));
        svg.polyline(
            line,
            &format!("stroke=\"{INK}\" stroke-width=\"1.5\" fill=\"none\""),
        );
        axes.draw(&mut svg, "", labels[i], labels[j]);
    }
    key(
        &mut svg,
        (80.0, 452.0),
        &shots,
        "95 % of the shooter's releases, without the tracker's error",
    );
    named(fit, &name, &title, svg)
}

/// The landing of a shot in short lengths: right and depth.
fn landing(fit: &ShooterFit, place: usize, values: &Values, inch: f64) -> Option<(f64, f64)> {
    let simulator = fit.profiles[place].simulator();
    let landing = landing_of(simulator, &fit.places[place], values)?;
    Some((landing.right_m / inch, landing.depth_m / inch))
}

fn make_zone(
    fit: &ShooterFit,
    place_index: usize,
    shots: &[MeasuredRelease],
    units: UnitSystem,
) -> Plot {
    let (short, inch) = units.short_length();
    let shots = shots_at(shots, place_index);
    let place = &fit.places[place_index];
    let profile = &fit.profiles[place_index];
    let simulator = profile.simulator();
    let usual = &fit.typical.means[place_index];
    let entry = landing_of(simulator, place, usual).map_or(0.75, |landing| landing.entry_angle_rad);
    let landings: Vec<((f64, f64), Option<bool>)> = shots
        .iter()
        .filter_map(|shot| Some((landing(fit, place_index, &shot.values, inch)?, shot.made)))
        .collect();
    let centre = CENTRE_DEPTH_M / inch;
    // As wide as the shots need it, within limits.
    let farthest = |((x, y), _): &((f64, f64), Option<bool>)| x.abs().max((y - centre).abs());
    let needed = 1.05 * landings.iter().map(farthest).fold(0.0, f64::max);
    let half = needed.clamp(LEAST_HALF_WIDTH_M / inch, MOST_HALF_WIDTH_M / inch);
    let outside = landings.iter().filter(|l| farthest(l) > half).count();
    let (name, from) = of_place(fit, place_index, "make_zone", units);
    let mut svg = Svg::new(640.0, 680.0);
    let what = "Where shots fall, and the make zone";
    let title = title(&mut svg, what, from.as_ref());
    let axes = Axes {
        corner: (80.0, 70.0),
        size: (500.0, 500.0),
        x: (-half, half),
        y: (centre - half, centre + half),
    };
    let (columns, rows) = ZONE_CELLS;
    let colours: Vec<[u8; 4]> = (0..columns * rows)
        .into_par_iter()
        .map(|cell| {
            let (row, column) = (cell / columns, cell % columns);
            let x = axes.x.0 + (axes.x.1 - axes.x.0) * (column as f64 + 0.5) / columns as f64;
            let y = axes.y.1 - (axes.y.1 - axes.y.0) * (row as f64 + 0.5) / rows as f64;
            let landing = Landing {
                depth_m: y * inch,
                right_m: x * inch,
                entry_angle_rad: entry,
            };
            let is_made = release_of_landing(simulator, place, &landing, &[0.0; 3], usual[3])
                .ok()
                .and_then(|(values, _)| {
                    simulator
                        .simulate(&profile.release(&nominal_of(&values)))
                        .ok()
                })
                .is_some_and(|outcome| outcome.verdict.made);
            if is_made { ZONE } else { OUTSIDE }
        })
        .collect();
    svg.pixels(axes.corner, axes.size, ZONE_CELLS, &colours);
    let ring = profile.physics().ring_radius_m / inch;
    let circle = axes.pixel((0.0, centre));
    svg.circle(
        circle,
        axes.pixels_of_length(ring),
        &format!("fill=\"none\" stroke=\"{FAINT}\" stroke-width=\"2\""),
    );
    // The ellipse of the landings, by the derivatives of the landing at the usual release.
    let curve = landing_ellipse(fit, place_index, inch);
    svg.clipped(axes.corner, axes.size, |svg| {
        for (at, made) in &landings {
            mark(svg, axes.pixel(*at), *made);
        }
        let line = curve.iter().map(|p| axes.pixel(*p));
        svg.polyline(
            line,
            &format!("stroke=\"{INK}\" stroke-width=\"1.5\" fill=\"none\""),
        );
    });
    axes.draw(
        &mut svg,
        "",
        &format!("left and right of the shot's line ({short})"),
        &format!("depth from the front of the ring ({short})"),
    );
    key(
        &mut svg,
        (80.0, 626.0),
        &shots,
        "95 % of the shooter's shots",
    );
    svg.footnote(
        (80.0, 646.0),
        &format!(
            "Green: goes in at the mean entry angle ({:.0} deg) and backspin, without other scatter. Circle: the ring.",
            entry / DEGREE_RAD
        ),
    );
    if outside > 0 {
        let lie = if outside == 1 {
            "shot lies"
        } else {
            "shots lie"
        };
        svg.footnote(
            (80.0, 664.0),
            &format!("{outside} {lie} outside the picture."),
        );
    }
    named(fit, &name, &title, svg)
}

/// The 95 % ellipse of right and depth.
fn landing_ellipse(fit: &ShooterFit, place: usize, inch: f64) -> Vec<(f64, f64)> {
    let usual = &fit.typical.means[place];
    let sds = fit.typical.sds_at(place);
    let Some(centre) = landing(fit, place, usual, inch) else {
        return Vec::new();
    };
    let mut slopes = [(0.0, 0.0); 3];
    for (i, slope) in slopes.iter_mut().enumerate() {
        let step = 0.05 * sds[i];
        let at = |sign: f64| {
            let mut moved = *usual;
            moved[i] += sign * step;
            landing(fit, place, &moved, inch)
        };
        if let (Some(up), Some(down)) = (at(1.0), at(-1.0)) {
            *slope = ((up.0 - down.0) / 0.1, (up.1 - down.1) / 0.1);
        }
    }
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for i in 0..3 {
        for j in 0..3 {
            let c = fit.typical.correlation[(i, j)];
            xx += c * slopes[i].0 * slopes[j].0;
            xy += c * slopes[i].0 * slopes[j].1;
            yy += c * slopes[i].1 * slopes[j].1;
        }
    }
    let (sx, sy) = (xx.max(0.0).sqrt(), yy.max(0.0).sqrt());
    let r = if sx * sy > 0.0 { xy / (sx * sy) } else { 0.0 };
    let root = (1.0 - r * r).max(0.0).sqrt();
    (0..=ELLIPSE_POINTS)
        .map(|k| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * k as f64 / ELLIPSE_POINTS as f64);
            (
                centre.0 + RADIUS_95 * sx * cos,
                centre.1 + RADIUS_95 * sy * (r * cos + root * sin),
            )
        })
        .collect()
}

fn drift(
    fit: &ShooterFit,
    shots: &[MeasuredRelease],
    sessions: &[String],
    units: UnitSystem,
) -> Plot {
    let (long, metre) = units.length();
    let speed = format!("speed ({long}/s)");
    let rows = [
        (0, speed.as_str(), metre),
        (1, "pitch (deg)", DEGREE_RAD),
        (2, "aim (deg)", DEGREE_RAD),
    ];
    let mut svg = Svg::new(860.0, 640.0);
    svg.heading(
        (20.0, 26.0),
        16.0,
        Anchor::Start,
        "The shots, session by session, relative to the mean of their place",
    );
    // Session by session, also where their shots take turns in the file.
    let names = session_names(sessions);
    let number_of = |k: usize| names.iter().position(|name| Some(*name) == sessions.get(k));
    let mut order: Vec<usize> = (0..shots.len()).collect();
    order.sort_by_key(|&k| number_of(k));
    let shots: &Vec<MeasuredRelease> = &order.iter().map(|&k| shots[k].clone()).collect();
    let in_order = order.iter().filter_map(|&k| sessions.get(k).cloned());
    let sessions: &Vec<String> = &in_order.collect();
    let runs = runs_of_equal(sessions);
    let window = (shots.len() / 8).clamp(5, 50);
    for (panel, (i, label, unit)) in rows.into_iter().enumerate() {
        let deviations: Vec<f64> = shots
            .iter()
            .map(|shot| (shot.values[i] - fit.typical.means[shot.place][i]) / unit)
            .collect();
        let axes = Axes {
            corner: (80.0, 64.0 + 182.0 * panel as f64),
            size: (740.0, 132.0),
            x: (0.0, shots.len() as f64 + 1.0),
            y: range(deviations.iter().copied()),
        };
        axes.draw_grid(&mut svg);
        for (k, (deviation, shot)) in deviations.iter().zip(shots).enumerate() {
            mark(
                &mut svg,
                axes.pixel((k as f64 + 1.0, *deviation)),
                shot.made,
            );
        }
        // A mean does not reach from one session into the next.
        for run in &runs {
            let smooth = run.clone().map(|k| {
                let from = k.saturating_sub(window / 2).max(run.start);
                let part = &deviations[from..(k + window / 2 + 1).min(run.end)];
                axes.pixel((k as f64 + 1.0, part.iter().sum::<f64>() / part.len() as f64))
            });
            svg.polyline(
                smooth,
                &format!("stroke=\"{INK}\" stroke-width=\"1.5\" fill=\"none\""),
            );
            if runs.len() == 1 || runs.len() > MOST_NAMED_SESSIONS {
                continue;
            }
            let (x, top) = axes.pixel((run.start as f64 + 0.5, axes.y.1));
            let style = format!("stroke=\"{INK}\" stroke-dasharray=\"4 3\" fill=\"none\"");
            svg.polyline([(x, top), (x, top + axes.size.1)], &style);
            if panel == 0 {
                let name = shortened(&sessions[run.start], 16);
                svg.text((x + 4.0, top + 13.0), 11.0, Anchor::Start, &name);
            }
        }
        axes.draw(&mut svg, label, if panel == 2 { "shot" } else { "" }, "");
    }
    key(
        &mut svg,
        (80.0, 626.0),
        shots,
        &format!("mean of {window} shots"),
    );
    named(fit, "drift", "the shots in their order", svg)
}

/// The runs of equal texts.
fn runs_of_equal(texts: &[String]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (k, text) in texts.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if texts[run.start] == *text => run.end = k + 1,
            _ => runs.push(k..k + 1),
        }
    }
    runs
}

fn intervals(fit: &ShooterFit, units: UnitSystem) -> Plot {
    let (long, metre) = units.length();
    let posterior = &fit.posterior;
    let of_sd = |i: usize, unit: f64| posterior.summary(|draw| draw.sds[i]).scaled(1.0 / unit);
    let has_several_places = fit.places.len() > 1;
    // Label, interval, and the ends of its scale.
    let mut rows: Vec<(String, Interval, (f64, f64))> = Vec::new();
    let share = |label, percent| (label, percent, (0.0, 100.0));
    let scatter = |label, interval: Interval| (label, interval, (0.0, 1.3 * interval.high));
    for (place, probabilities) in fit.probabilities.iter().enumerate() {
        let at = if has_several_places {
            format!(", place {}", place + 1)
        } else {
            String::new()
        };
        let p = probabilities.interval().scaled(100.0);
        rows.push(share(format!("current shot{at}: makes per 100"), p));
        let makes = fit.makes.at_place(place);
        if makes.labelled > 0 {
            let counted = Interval {
                mean: 100.0 * makes.share.share,
                sd: 0.0,
                low: 100.0 * makes.share.low,
                high: 100.0 * makes.share.high,
            };
            rows.push(share(format!("share of makes, counted{at} (%)"), counted));
        }
    }
    rows.extend([
        scatter(format!("scatter of speed ({long}/s)"), of_sd(0, metre)),
        scatter("scatter of pitch (deg)".to_owned(), of_sd(1, DEGREE_RAD)),
        scatter("scatter of aim (deg)".to_owned(), of_sd(2, DEGREE_RAD)),
    ]);
    let mut svg = Svg::new(860.0, 70.0 + 90.0 * rows.len() as f64);
    svg.heading(
        (20.0, 26.0),
        16.0,
        Anchor::Start,
        "What these shots tell: means and 95 % intervals",
    );
    for (k, (label, interval, scale)) in rows.iter().enumerate() {
        let axes = Axes {
            corner: (260.0, 60.0 + 90.0 * k as f64),
            size: (560.0, 26.0),
            x: *scale,
            y: (0.0, 1.0),
        };
        let (low, y) = axes.pixel((interval.low, 0.5));
        let (high, _) = axes.pixel((interval.high, 0.5));
        let (middle, _) = axes.pixel((interval.mean, 0.5));
        svg.polyline(
            [(low, y), (high, y)],
            &format!("stroke=\"{MADE}\" stroke-width=\"5\" fill=\"none\""),
        );
        svg.circle((middle, y), 6.0, &format!("fill=\"{MADE}\""));
        svg.text((245.0, y + 4.0), 12.0, Anchor::End, label);
        let bottom = axes.lower_right().1;
        let style = format!("stroke=\"{INK}\" fill=\"none\"");
        svg.polyline(
            [(axes.corner.0, bottom), (axes.lower_right().0, bottom)],
            &style,
        );
        for value in super::axes::ticks(axes.x) {
            let (x, _) = axes.pixel((value, 0.0));
            svg.polyline([(x, bottom), (x, bottom + 4.0)], &style);
            svg.text(
                (x, bottom + 16.0),
                11.0,
                Anchor::Middle,
                &super::axes::format_tick(value),
            );
        }
    }
    named(fit, "intervals", "means and 95 % intervals", svg)
}

fn reliability(fit: &ShooterFit) -> Plot {
    let mut svg = Svg::new(560.0, 560.0);
    svg.heading(
        (20.0, 26.0),
        16.0,
        Anchor::Start,
        "Predicted against observed",
    );
    let axes = Axes {
        corner: (80.0, 60.0),
        size: (420.0, 420.0),
        x: (0.0, 100.0),
        y: (0.0, 100.0),
    };
    axes.draw_grid(&mut svg);
    let style = format!("stroke=\"{FAINT}\" stroke-dasharray=\"5 4\" fill=\"none\"");
    svg.polyline([axes.pixel((0.0, 0.0)), axes.pixel((100.0, 100.0))], &style);
    // Points that lie together have one number, that of their shots.
    let mut numbers: Vec<((f64, f64), usize)> = Vec::new();
    for bin in &fit.makes.bins {
        let at = |share: f64| axes.pixel((100.0 * bin.predicted, 100.0 * share));
        let style = format!("stroke=\"{MADE}\" stroke-width=\"2\" fill=\"none\"");
        svg.polyline([at(bin.observed.low), at(bin.observed.high)], &style);
        let (x, y) = at(bin.observed.share);
        svg.circle((x, y), 5.0, &format!("fill=\"{MADE}\""));
        let is_near = |((a, b), _): &&mut ((f64, f64), usize)| {
            (*a - x).abs() <= 24.0 && (*b - y).abs() <= 12.0
        };
        match numbers.iter_mut().find(is_near) {
            Some((_, shots)) => *shots += bin.shots,
            None => numbers.push(((x, y), bin.shots)),
        }
    }
    for ((x, y), shots) in numbers {
        svg.text((x + 9.0, y + 4.0), 11.0, Anchor::Start, &shots.to_string());
    }
    axes.draw(
        &mut svg,
        "",
        "chance as measured (%)",
        "went in (%, 95 % interval)",
    );
    svg.footnote(
        (80.0, 545.0),
        "Points: shots of similar chance, with their number. On the dashed line: as predicted.",
    );
    named(fit, "reliability", "predicted against observed", svg)
}

/// What the fit predicts of shots like these, and what was measured.
fn predicted(fit: &ShooterFit, units: UnitSystem) -> Plot {
    let (short, inch) = units.short_length();
    let check = &fit.predictive;
    let depth = format!("depth from the front of the ring ({short})");
    let right = format!("left and right of the line ({short})");
    let panels = [
        (&check.depth, "Shots by depth", &depth, "shots", 1.0),
        (&check.left_right, "Shots by side", &right, "shots", 1.0),
        (
            &check.makes_by_depth,
            "Makes by depth",
            &depth,
            "went in (%)",
            100.0,
        ),
    ];
    let panels: Vec<_> = panels
        .into_iter()
        .filter(|(bins, ..)| !bins.is_empty())
        .collect();
    let mut svg = Svg::new(40.0 + 360.0 * panels.len() as f64, 430.0);
    let what = "Predicted by the fit against measured";
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, what);
    for (number, (bins, title, x_label, y_label, unit)) in panels.into_iter().enumerate() {
        // An open bin is as wide as its neighbour.
        let inner: Vec<f64> = bins
            .iter()
            .filter_map(|bin| bin.below_short_m)
            .map(|edge| edge / inch)
            .collect();
        let width = match inner[..] {
            [first, second, ..] => second - first,
            _ => 1.0,
        };
        let ends = |bin: &PredictedBin| {
            let low = bin.above_short_m.map(|edge| edge / inch);
            let high = bin.below_short_m.map(|edge| edge / inch);
            let (first, last) = (low.or(high), high.or(low));
            (
                low.or(first.map(|edge| edge - width)).unwrap_or(0.0),
                high.or(last.map(|edge| edge + width)).unwrap_or(1.0),
            )
        };
        let lows = bins.iter().map(|bin| ends(bin).0);
        let highs = bins.iter().map(|bin| ends(bin).1);
        let greatest = bins.iter().map(|bin| bin.high.max(bin.seen));
        let axes = Axes {
            corner: (70.0 + 360.0 * number as f64, 70.0),
            size: (280.0, 270.0),
            x: (
                lows.fold(f64::INFINITY, f64::min),
                highs.fold(f64::NEG_INFINITY, f64::max),
            ),
            y: (
                0.0,
                match unit {
                    100.0 => 100.0,
                    _ => 1.08 * greatest.fold(1.0, f64::max),
                },
            ),
        };
        axes.draw_grid(&mut svg);
        for bin in bins {
            let (low, high) = ends(bin);
            let at = |x: f64, y: f64| axes.pixel((x, unit * y));
            let corners = [
                at(low, bin.low),
                at(high, bin.low),
                at(high, bin.high),
                at(low, bin.high),
            ];
            svg.polyline(
                corners,
                &format!("stroke=\"none\" fill=\"{MADE}\" fill-opacity=\"0.22\""),
            );
            svg.polyline(
                [at(low, bin.predicted), at(high, bin.predicted)],
                &format!("stroke=\"{MADE}\" stroke-width=\"2\" fill=\"none\""),
            );
            let style = format!("fill=\"{INK}\"");
            svg.circle(at(0.5 * (low + high), bin.seen), 4.0, &style);
        }
        axes.draw(&mut svg, title, x_label, y_label);
    }
    svg.footnote(
        (70.0, 415.0),
        "Points: measured. Lines and bands: the same shots simulated from the fit, mean and nine in ten. The outer bins are open.",
    );
    named(
        fit,
        "predicted",
        "predicted by the fit against measured",
        svg,
    )
}
