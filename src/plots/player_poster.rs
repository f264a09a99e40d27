//! One court map for a player's wall: makes in 100 shots at each place, and where to bank. It reads
//! as well in black and white.

use super::colormaps::{Rgb, sequential};
use super::colour_key::{ColourKey, ColourScale};
use super::svg::{Anchor, Plot, Svg};
use super::sweep_results::SweepResults;
use crate::analysis::sensitivity::Difference;
use crate::sweep::columns;
use crate::sweep::place_chances::{PlaceChances, Preference};
use crate::units::UnitSystem;

/// y of the map, px.
const MAP_TOP: f64 = 30.0;

/// The map, and what it says in three sentences, two numbers each; `None` if nothing can be made
/// from any place.
#[must_use]
pub fn draw(results: &SweepResults<'_>) -> Option<(Plot, [String; 3])> {
    let found: Vec<(f64, &PlaceChances)> = results
        .chances()
        .iter()
        .filter_map(|place| Some((place.best()?.value, place)))
        .collect();
    let first = found.first().copied()?;
    let best = found.iter().copied();
    let best = best.fold(first, |a, b| if b.0 > a.0 { b } else { a });
    let worst = found.iter().copied();
    let worst = worst.fold(first, |a, b| if b.0 < a.0 { b } else { a });
    let is_bank = |place: &PlaceChances| place.preference() == Some(Preference::Bank);
    let at = |place: &PlaceChances| (place.place.x_m, place.place.y_m);
    let bank = results.chances().iter().filter(|place| is_bank(place));
    let bank: Vec<&PlaceChances> = bank.collect();
    let outlined: Vec<(f64, f64)> = bank.iter().map(|place| at(place)).collect();
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
        &|place| Some(pale(place.best()?.real(columns::PROBABILITY)?)),
    );
    map.draw_outline(&mut svg, corner, &outlined);
    let numbers: Vec<((f64, f64), String, bool)> = found
        .iter()
        .map(|(p, place)| (at(place), format!("{:.0}", 100.0 * p), is_bank(place)))
        .collect();
    map.draw_numbers(&mut svg, corner, &numbers);
    let units = results.units();
    let words = [
        format!(
            "Your surest place is {}: {:.0} of 100 go in.",
            best.1.in_words(units),
            100.0 * best.0
        ),
        bank_in_words(&bank, units),
        format!(
            "Your hardest place is {}: {:.0} of 100 go in.",
            worst.1.in_words(units),
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

/// Where banking helps most, and how to.
fn bank_in_words(bank: &[&PlaceChances], units: UnitSystem) -> String {
    let gain = |place: &PlaceChances| place.bank_gain().map_or(1.0, |gain| gain.value);
    let most = bank
        .iter()
        .reduce(|a, b| if gain(b) > gain(a) { b } else { a });
    let Some(most) = most else {
        return "Shoot direct: no place is surely better off the board.".to_owned();
    };
    let in_hundred = |p: Option<Difference>| p.map(|p| format!("{:.0}", 100.0 * p.value));
    let direct = in_hundred(most.direct).map_or(String::new(), |p| format!(", {p} direct"));
    let aim = most.board_aim_in_words(units);
    format!(
        "Bank the ball where the map has an outline; it helps most {}: {} of 100 go in{direct}. Aim {}.",
        most.in_words(units),
        in_hundred(most.bank).unwrap_or_default(),
        aim.unwrap_or_else(|| "at the board".to_owned())
    )
}
