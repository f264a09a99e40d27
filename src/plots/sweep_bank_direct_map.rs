//! P of the best direct and bank shots over the court, and their difference.

use super::colormaps::{diverging, sequential};
use super::colour_key::{ColourKey, ColourScale};
use super::svg::Plot;
use super::svg::{Anchor, Svg};
use super::sweep_results::{PlaceResults, SweepResults, difference_colour, largest_difference};
use crate::analysis::sensitivity::Difference;
use crate::best_shot::ShotKind;
use crate::sweep::bank_direct_difference::{
    BankAdvantage, SIGNIFICANT_SIGMAS, difference, is_advised,
};

/// Limits of the colour scale of the difference. Larger differences have the colour of the largest
/// on the scale.
const SCALE_LIMITS: (f64, f64) = (0.02, 0.1);
/// y of the maps, px; the title stands above them.
const MAPS_TOP: f64 = 34.0;

/// Draws P of direct and bank shots and their difference, with an outline where bank shots are
/// better; `None` if the sweep does not have both kinds.
#[must_use]
pub fn draw(results: &SweepResults<'_>) -> Option<Plot> {
    if !results.has_both_kinds() {
        return None;
    }
    let gain = |place: &PlaceResults| bank_gain(results, place);
    let largest = largest_difference(results.places().iter().filter_map(gain))
        .clamp(SCALE_LIMITS.0, SCALE_LIMITS.1);
    let compared = results.places().iter().filter_map(gain).count();
    let bank_places: Vec<(f64, f64)> = results
        .places()
        .iter()
        .filter(|place| gain(place).is_some_and(|by| is_advised(by) && by.value > 0.0))
        .map(|results| (results.place.x_m, results.place.y_m))
        .collect();
    let advantage = BankAdvantage {
        better: bank_places.len(),
        compared,
    };
    let caption = advantage.to_string();
    let note = format!(
        "{caption} These are outlined. White: the difference is below {SIGNIFICANT_SIGMAS} standard errors; full colour from {:.0} per 100.",
        100.0 * largest
    );
    let map = results.court_map();
    let (width, height) = map.size();
    let mut svg = Svg::new(3.0 * width, height + 62.0);
    let title = format!("Bank and direct: {}", results.shooter_name());
    svg.heading((20.0, 24.0), 16.0, Anchor::Start, &title);
    draw_probabilities(results, &mut svg);
    let corner = (2.0 * width, MAPS_TOP);
    draw_gain(results, &mut svg, corner, largest);
    map.draw_outline(&mut svg, corner, &bank_places);
    svg.footnote((20.0, MAPS_TOP + height + 6.0), &note);
    svg.footnote((20.0, MAPS_TOP + height + 22.0), &results.source_note());
    Some(Plot {
        name: "bank_and_direct".to_owned(),
        svg: svg.finish(&caption),
        caption,
    })
}

/// P of the bank shot minus P of the direct shot.
fn bank_gain(results: &SweepResults<'_>, place: &PlaceResults) -> Option<Difference> {
    let direct = results.probability(place, ShotKind::Direct)?;
    let bank = results.probability(place, ShotKind::Bank)?;
    Some(difference(bank, direct))
}

fn draw_probabilities(results: &SweepResults<'_>, svg: &mut Svg) {
    let map = results.court_map();
    let (width, _) = map.size();
    let scale = ColourKey::Scale(ColourScale::PROBABILITY);
    for (i, kind) in ShotKind::ALL.into_iter().enumerate() {
        let corner = (i as f64 * width, MAPS_TOP);
        let title = format!("probability of the best {} shot", kind.name());
        results.draw_on(&map, svg, corner, &title, &scale, &|place| {
            Some(sequential(results.probability(place, kind)?.value))
        });
    }
}

/// Draws the difference with a scale from `-largest` to `largest`.
fn draw_gain(results: &SweepResults<'_>, svg: &mut Svg, corner: (f64, f64), largest: f64) {
    let colour = |by: f64| diverging(by / largest);
    let scale = ColourKey::Scale(ColourScale {
        name: "bank \u{2212} direct",
        range: (-largest, largest),
        colour: &colour,
    });
    let map = results.court_map();
    results.draw_on(&map, svg, corner, "bank minus direct", &scale, &|place| {
        Some(difference_colour(bank_gain(results, place)?, largest))
    });
}
