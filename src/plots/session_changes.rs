//! What changed between two sessions of a shooter: each value before and after, and what the change
//! of P comes from.

use super::axes::{format_tick, ticks};
use super::svg::{Anchor, FAINT, INK, Plot, Svg, shortened};
use crate::fitting::Interval;

/// Colours of both sessions, which also differ in brightness.
const BEFORE_COLOUR: &str = "#56b4e9";
const AFTER_COLOUR: &str = "#b85c00";
const CAUSE_COLOUR: &str = "#222";
/// Width of the drawing, left edge and width of the scales, left edge of the words beside them, px.
const WIDTH: f64 = 980.0;
const LEFT: f64 = 290.0;
const SCALE_WIDTH: f64 = 330.0;
const WORDS_LEFT: f64 = LEFT + SCALE_WIDTH + 24.0;
/// Top of the first row, height of a row, and how far both sessions lie from its middle, px.
const TOP: f64 = 92.0;
const ROW: f64 = 32.0;
const APART: f64 = 6.0;
/// Longest name of a session, in characters.
const LONGEST_NAME: usize = 40;

/// A value before and after, in the unit that it is printed in.
#[derive(Clone, Debug)]
pub struct ChangedValue {
    /// Such as `the scatter in speed`.
    pub name: String,
    /// Its unit; empty without any.
    pub unit: &'static str,
    /// Decimals of its change.
    pub decimals: usize,
    /// Before, after, and the change.
    pub before: Interval,
    /// See `before`.
    pub after: Interval,
    /// See `before`.
    pub change: Interval,
    /// Whether the change is beyond chance.
    pub is_decided: bool,
}

/// Part of the change of P, in points.
#[derive(Clone, Debug)]
pub struct ChangeCause {
    /// Such as `the scatter`.
    pub name: &'static str,
    /// What it makes.
    pub points: Interval,
}

/// Draws the values, a row each on a scale of its own, and below them the causes on one scale.
/// `shooter` and `sessions` are names.
#[must_use]
pub fn draw(
    shooter: &str,
    sessions: [&str; 2],
    values: &[ChangedValue],
    causes: &[ChangeCause],
) -> Plot {
    let values_bottom = TOP + ROW * values.len() as f64;
    let causes_top = values_bottom + 62.0;
    let causes_bottom = causes_top + ROW * causes.len() as f64;
    let mut svg = Svg::new(WIDTH, causes_bottom + 66.0);
    let sessions = sessions.map(|name| shortened(name, LONGEST_NAME));
    let title = match shooter {
        "" => "Two sessions".to_owned(),
        name => format!("{}: two sessions", shortened(name, LONGEST_NAME)),
    };
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, &title);
    for (i, (name, colour)) in sessions
        .iter()
        .zip([BEFORE_COLOUR, AFTER_COLOUR])
        .enumerate()
    {
        let x = 26.0 + 0.5 * WIDTH * i as f64;
        svg.circle((x, 50.0), 5.0, &format!("fill=\"{colour}\""));
        let when = ["before", "after"][i];
        let words = format!("{when}: {name}");
        svg.text((x + 12.0, 54.0), 12.0, Anchor::Start, &words);
    }
    svg.text(
        (WORDS_LEFT, TOP - 12.0),
        11.0,
        Anchor::Start,
        "change (95 % interval)",
    );
    for (i, value) in values.iter().enumerate() {
        draw_value(&mut svg, TOP + ROW * (i as f64 + 0.5), value);
    }
    svg.heading(
        (20.0, values_bottom + 40.0),
        13.0,
        Anchor::Start,
        "What each change alone adds, in makes per 100",
    );
    draw_causes(&mut svg, (causes_top, causes_bottom), causes);
    svg.footnote(
        (20.0, causes_bottom + 54.0),
        "Bars: 95 % intervals. Each value has its own scale. Bold: more than chance explains, corrected for the number of values. The parts need not add up.",
    );
    Plot {
        name: "sessions".to_owned(),
        caption: title.clone(),
        svg: svg.finish(&title),
    }
}

/// One value on a scale that its intervals fill.
fn draw_value(svg: &mut Svg, y: f64, value: &ChangedValue) {
    let decimals = value.decimals;
    let label = (LEFT - 16.0, y + 4.0);
    let words = format!(
        "{:+.decimals$} ({:+.decimals$} to {:+.decimals$}) {}",
        value.change.mean, value.change.low, value.change.high, value.unit
    );
    let beside = (WORDS_LEFT, y + 4.0);
    if value.is_decided {
        svg.heading(label, 12.0, Anchor::End, &value.name);
        svg.heading(beside, 12.0, Anchor::Start, words.trim_end());
    } else {
        svg.text(label, 12.0, Anchor::End, &value.name);
        svg.text(beside, 12.0, Anchor::Start, words.trim_end());
    }
    let both = [&value.before, &value.after];
    let low = both.iter().fold(f64::INFINITY, |low, of| low.min(of.low));
    let high = both
        .iter()
        .fold(f64::NEG_INFINITY, |high, of| high.max(of.high));
    let width = (high - low).max(f64::MIN_POSITIVE);
    // Room for the numbers at both ends.
    let margin = 0.18 * SCALE_WIDTH;
    let x_of = |v: f64| LEFT + margin + (SCALE_WIDTH - 2.0 * margin) * (v - low) / width;
    for (of, colour, y) in [
        (&value.before, BEFORE_COLOUR, y - APART),
        (&value.after, AFTER_COLOUR, y + APART),
    ] {
        let style = format!("stroke=\"{colour}\" stroke-width=\"3\" fill=\"none\"");
        svg.polyline([(x_of(of.low), y), (x_of(of.high), y)], &style);
        svg.circle((x_of(of.mean), y), 4.5, &format!("fill=\"{colour}\""));
        let number = format!("{:.decimals$}", of.mean);
        // On the side that has more room.
        let is_left = of.mean - low > high - of.mean;
        let (x, anchor) = if is_left {
            (x_of(of.low) - 6.0, Anchor::End)
        } else {
            (x_of(of.high) + 6.0, Anchor::Start)
        };
        svg.text((x, y + 4.0), 10.0, anchor, &number);
    }
    let grid = format!("stroke=\"{FAINT}\" stroke-opacity=\"0.25\" fill=\"none\"");
    let below = y + 0.5 * ROW;
    svg.polyline([(20.0, below), (WIDTH - 20.0, below)], &grid);
}

/// The causes on one scale with a line at 0.
fn draw_causes(svg: &mut Svg, (top, bottom): (f64, f64), causes: &[ChangeCause]) {
    let ends = causes.iter().flat_map(|c| [c.points.low, c.points.high]);
    let (low, high) = ends.fold((-1.0_f64, 1.0_f64), |(low, high), end| {
        (low.min(end), high.max(end))
    });
    let margin = 0.04 * (high - low);
    let range = (low - margin, high + margin);
    let x_of = |v: f64| LEFT + SCALE_WIDTH * (v - range.0) / (range.1 - range.0);
    let grid = format!("stroke=\"{FAINT}\" stroke-opacity=\"0.35\" fill=\"none\"");
    for tick in ticks(range) {
        let is_zero = tick.abs() < 1e-9;
        let style = if is_zero {
            format!("stroke=\"{INK}\" stroke-width=\"1.5\" fill=\"none\"")
        } else {
            grid.clone()
        };
        svg.polyline([(x_of(tick), top), (x_of(tick), bottom)], &style);
        svg.text(
            (x_of(tick), bottom + 18.0),
            11.0,
            Anchor::Middle,
            &format_tick(tick),
        );
    }
    for (i, cause) in causes.iter().enumerate() {
        let y = top + ROW * (i as f64 + 0.5);
        let Interval {
            mean, low, high, ..
        } = cause.points;
        svg.text((LEFT - 16.0, y + 4.0), 12.0, Anchor::End, cause.name);
        let style = format!("stroke=\"{CAUSE_COLOUR}\" stroke-width=\"3\" fill=\"none\"");
        svg.polyline([(x_of(low), y), (x_of(high), y)], &style);
        svg.circle((x_of(mean), y), 5.0, &format!("fill=\"{CAUSE_COLOUR}\""));
        let words = format!("{mean:+.1} ({low:+.1} to {high:+.1})");
        svg.text((WORDS_LEFT, y + 4.0), 12.0, Anchor::Start, &words);
    }
}
