//! One court map for a player's wall: makes in 100 shots at each place, and where to bank. It reads as well in black and
//! white.

use super::colormaps::{Rgb, sequential};
use super::colour_key::{ColourKey, ColourScale};
use super::svg::{Anchor, Plot, Svg};
use super::sweep_results::{PlaceResults, SweepResults};
use crate::analysis::sensitivity::Difference;
use crate::best_shot::ShotKind;
use crate::sweep::bank_direct_difference::{difference, is_significant};
use crate::sweep::columns;
use crate::units::FOOT_M;

/// y of the map, px.
const MAP_TOP: f64 = 30.0;

/// The map, and what it says in three sentences, two numbers each; `None` if nothing can be made from any place.
#[must_use]
pub fn draw(results: &SweepResults<'_>) -> Option<(Plot, [String; 3])> {
    let p = |place: &PlaceResults| place.best()?.real(columns::PROBABILITY);
    let found: Vec<(f64, &PlaceResults)> = results
        .places()
        .iter()
        .filter_map(|place| Some((p(place)?, place)))
        .collect();
    let best = found
        .iter()
        .copied()
        .reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    let worst = found
        .iter()
        .copied()
        .reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    let is_bank = |place: &PlaceResults| {
        bank_gain(results, place).is_some_and(|gain| is_significant(gain) && gain.value > 0.0)
    };
    let bank: Vec<(f64, f64)> = results
        .places()
        .iter()
        .filter(|place| is_bank(place))
        .map(|results| (results.place.x_m, results.place.y_m))
        .collect();
    let map = results.court_map();
    let (width, height) = map.size();
    let mut svg = Svg::new(width, height + MAP_TOP);
    svg.heading((20.0, 22.0), 18.0, Anchor::Start, &results.shooter_name());
    let corner = (0.0, MAP_TOP);
    let key = ColourKey::Scale(ColourScale {
        name: "P",
        range: (0.0, 1.0),
        colour: &pale,
    });
    results.draw_on(
        &map,
        &mut svg,
        corner,
        "makes in 100 shots",
        &key,
        &|place| Some(pale(p(place)?)),
    );
    map.draw_outline(&mut svg, corner, &bank);
    let numbers: Vec<((f64, f64), String, bool)> = found
        .iter()
        .map(|(p, results)| {
            let at = (results.place.x_m, results.place.y_m);
            (at, format!("{:.0}", 100.0 * p), is_bank(results))
        })
        .collect();
    map.draw_numbers(&mut svg, corner, &numbers);
    let far =
        |place: &PlaceResults| format!("{:.0} ft", place.place.location().distance_m / FOOT_M);
    let words = [
        format!(
            "Your surest place is {} from the hoop: {:.0} of 100 go in.",
            far(best.1),
            100.0 * best.0
        ),
        format!(
            "Bank the ball where the map has an outline: at {} of {} places.",
            bank.len(),
            found.len()
        ),
        format!(
            "Your hardest place is {} from the hoop: {:.0} of 100 go in.",
            far(worst.1),
            100.0 * worst.0
        ),
    ];
    let plot = Plot {
        name: "poster".to_owned(),
        svg: svg.finish(&words.join(" ")),
        caption: words.join(" "),
    };
    Some((plot, words))
}

/// The colour of a probability, so pale that black numbers stand out on it.
fn pale(p: f64) -> Rgb {
    sequential(p).map(|part| 140 + (u16::from(part) * 115 / 255) as u8)
}

fn bank_gain(results: &SweepResults<'_>, place: &PlaceResults) -> Option<Difference> {
    let direct = results.probability(place, ShotKind::Direct)?;
    let bank = results.probability(place, ShotKind::Bank)?;
    Some(difference(bank, direct))
}
