//! P of the best shots under each physics, a row for each.

use super::axes::{format_tick, ticks};
use super::svg::{Anchor, FAINT, INK, Plot, Svg, shortened};
use crate::best_shot::{PhysicsComparison, PhysicsRow};
use crate::present::physics_text::{physics_name, same_shot_in_words, what_stays};
use crate::units::UnitSystem;

/// Colours of the best direct shot, and of the best bank shot.
const DIRECT_COLOUR: &str = "#0072b2";
const BANK_COLOUR: &str = "#d55e00";
/// Width of the drawing, left edge and width of the scale, top of the first row and height of a
/// row, px.
const WIDTH: f64 = 980.0;
const LEFT: f64 = 350.0;
const SCALE_WIDTH: f64 = 590.0;
const TOP: f64 = 80.0;
const ROW: f64 = 24.0;

/// Draws one row for each physics. `name` is the shooter's.
#[must_use]
pub fn draw(name: &str, comparison: &PhysicsComparison, units: UnitSystem) -> Plot {
    let rows = &comparison.rows;
    let title = format!(
        "{}: how likely the shots go in under each physics",
        shortened(name, 60)
    );
    let bottom = TOP + ROW * rows.len() as f64;
    let mut svg = Svg::new(WIDTH, bottom + 80.0);
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, &title);
    let range = range_of(rows);
    let x_of = |p: f64| LEFT + SCALE_WIDTH * (p - range.0) / (range.1 - range.0);
    let grid = format!("stroke=\"{FAINT}\" stroke-opacity=\"0.35\" fill=\"none\"");
    for p in ticks(range) {
        svg.polyline([(x_of(p), TOP), (x_of(p), bottom)], &grid);
        svg.text(
            (x_of(p), bottom + 18.0),
            11.0,
            Anchor::Middle,
            &format_tick(p),
        );
    }
    svg.text(
        (LEFT + 0.5 * SCALE_WIDTH, bottom + 38.0),
        12.0,
        Anchor::Middle,
        "probability",
    );
    draw_key(&mut svg);
    for (i, row) in rows.iter().enumerate() {
        let y = TOP + ROW * (i as f64 + 0.5);
        svg.text(
            (LEFT - 12.0, y + 4.0),
            12.0,
            Anchor::End,
            &shortened(&physics_name(row.of, units), 60),
        );
        svg.polyline([(LEFT, y), (LEFT + SCALE_WIDTH, y)], &grid);
        for (shot, colour) in [(&row.direct, DIRECT_COLOUR), (&row.bank, BANK_COLOUR)] {
            if let Ok(shot) = shot {
                let at = (x_of(shot.estimate.probability), y);
                svg.circle(at, 5.0, &format!("fill=\"{colour}\""));
            }
        }
        if let Some(estimate) = &row.same_shot {
            mark_same_shot(&mut svg, (x_of(estimate.probability), y));
        }
    }
    svg.footnote(
        (20.0, bottom + 64.0),
        &format!(
            "Bar: {}, {}.",
            same_shot_in_words(comparison.same_shot),
            what_stays(comparison.same_shot)
        ),
    );
    Plot {
        name: "physics".to_owned(),
        caption: title.clone(),
        svg: svg.finish(&title),
    }
}

/// The range of all probabilities, with a margin.
fn range_of(rows: &[PhysicsRow]) -> (f64, f64) {
    let best = rows.iter().flat_map(|row| [&row.direct, &row.bank]);
    let best = best.flatten().map(|shot| shot.estimate.probability);
    let same_shot = rows.iter().filter_map(|row| row.same_shot.as_ref());
    let all = best.chain(same_shot.map(|estimate| estimate.probability));
    let (low, high) = all.fold((1.0_f64, 0.0_f64), |(low, high), p| {
        (low.min(p), high.max(p))
    });
    (
        (low - 0.03).max(0.0),
        (high + 0.03).min(1.0).max(low + 0.03),
    )
}

fn mark_same_shot(svg: &mut Svg, (x, y): (f64, f64)) {
    let style = format!("stroke=\"{INK}\" stroke-width=\"2\" fill=\"none\"");
    svg.polyline([(x, y - 7.0), (x, y + 7.0)], &style);
}

fn draw_key(svg: &mut Svg) {
    let y = 54.0;
    let entries = [
        (LEFT, "best direct shot"),
        (LEFT + 160.0, "best bank shot"),
        (LEFT + 310.0, "one shot, the same under each physics"),
    ];
    svg.circle((entries[0].0, y), 5.0, &format!("fill=\"{DIRECT_COLOUR}\""));
    svg.circle((entries[1].0, y), 5.0, &format!("fill=\"{BANK_COLOUR}\""));
    mark_same_shot(svg, (entries[2].0, y));
    for (x, text) in entries {
        svg.text((x + 12.0, y + 4.0), 12.0, Anchor::Start, text);
    }
}
