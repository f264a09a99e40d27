//! The best shots of two sweeps over the court, and their difference.

use super::colormaps::{diverging, sequential};
use super::colour_key::{ColourKey, ColourScale};
use super::svg::Plot;
use super::svg::{Anchor, Svg, shortened};
use super::sweep_results::{PlaceResults, SweepResults, difference_colour, largest_difference};
use crate::analysis::sensitivity::Difference;
use crate::sweep::bank_direct_difference::{SIGNIFICANT_SIGMAS, difference};
use std::collections::BTreeMap;

/// Limits of the colour scale of the difference. Larger differences have the colour of the largest
/// on the scale.
const SCALE_LIMITS: (f64, f64) = (0.02, 0.5);
/// y of the maps, px; the title stands above them.
const MAPS_TOP: f64 = 34.0;

/// Draws the best shots of two sweeps and their difference, `second` minus `first`; `None` if they
/// share no place with results.
#[must_use]
pub fn draw(first: &SweepResults<'_>, second: &SweepResults<'_>) -> Option<Plot> {
    let second_places = places_by_position(second);
    let gain = |place: &PlaceResults| {
        let other = second_places.get(&position(place))?;
        Some(difference(
            best_probability(other)?,
            best_probability(place)?,
        ))
    };
    let gains: Vec<Difference> = first.places().iter().filter_map(gain).collect();
    if gains.is_empty() {
        return None;
    }
    let largest = largest_difference(gains.iter().copied()).clamp(SCALE_LIMITS.0, SCALE_LIMITS.1);
    let mean = gains.iter().map(|by| by.value).sum::<f64>() / gains.len() as f64;
    let (first_name, second_name) = (first.name(), second.name());
    let caption = format!(
        "Of 100 shots {:.1} {} go in for {second_name} than for {first_name}, on average over {} places.",
        100.0 * mean.abs(),
        if mean < 0.0 { "fewer" } else { "more" },
        gains.len()
    );
    let (width, height) = first.court_map().size();
    let mut svg = Svg::new(3.0 * width, height + 62.0);
    let title = format!("{first_name} and {second_name}");
    svg.heading((20.0, 24.0), 16.0, Anchor::Start, &title);
    draw_probabilities(&mut svg, first, second);
    let minus = format!(
        "{} \u{2212} {}",
        shortened(&second_name, 18),
        shortened(&first_name, 18)
    );
    draw_difference(&mut svg, first, &minus, &gain, largest);
    let note = format!(
        "{caption} Each player takes the best shot from each place. White: the difference is below {SIGNIFICANT_SIGMAS} standard errors."
    );
    svg.footnote((20.0, MAPS_TOP + height + 6.0), &note);
    svg.footnote((20.0, MAPS_TOP + height + 22.0), &first.source_note());
    Some(Plot {
        name: "against".to_owned(),
        svg: svg.finish(&caption),
        caption,
    })
}

/// Draws both sweeps on maps of the first one.
fn draw_probabilities(svg: &mut Svg, first: &SweepResults<'_>, second: &SweepResults<'_>) {
    let map = first.court_map();
    let (width, _) = map.size();
    let scale = ColourKey::Scale(ColourScale::PROBABILITY);
    for (i, sweep) in [first, second].into_iter().enumerate() {
        let corner = (i as f64 * width, MAPS_TOP);
        let title = shortened(&sweep.name(), 40);
        sweep.draw_on(&map, svg, corner, &title, &scale, &|place| {
            Some(sequential(best_probability(place)?.value))
        });
    }
}

/// Draws the difference with a scale from `-largest` to `largest`.
fn draw_difference(
    svg: &mut Svg,
    first: &SweepResults<'_>,
    title: &str,
    gain: &dyn Fn(&PlaceResults) -> Option<Difference>,
    largest: f64,
) {
    let map = first.court_map();
    let (width, _) = map.size();
    let scale = ColourKey::Scale(ColourScale {
        name: "difference",
        range: (-largest, largest),
        colour: &|by| diverging(by / largest),
    });
    let corner = (2.0 * width, MAPS_TOP);
    first.draw_on(&map, svg, corner, title, &scale, &|place| {
        Some(difference_colour(gain(place)?, largest))
    });
}

/// P of the best shot of either kind.
fn best_probability(place: &PlaceResults) -> Option<Difference> {
    place.best()?.probability()
}

/// The coordinates of a place, comparable.
fn position(results: &PlaceResults) -> (u64, u64) {
    (results.place.x_m.to_bits(), results.place.y_m.to_bits())
}

fn places_by_position<'a>(sweep: &'a SweepResults<'_>) -> BTreeMap<(u64, u64), &'a PlaceResults> {
    let places = sweep.places().iter();
    places.map(|place| (position(place), place)).collect()
}
