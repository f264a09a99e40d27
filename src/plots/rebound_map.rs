//! A map of the court of where the misses of a shot come down.

use super::colormaps::{Rgb, sequential};
use super::colour_key::{ColourKey, ColourScale};
use super::court_map::{ColouredPlace, CourtMap, MapStyle};
use super::svg::{Anchor, Plot, Svg, shortened};
use crate::analysis::rebounds::Rebound;
use crate::answers::rebounds::ReboundsAnswer;
use crate::model::league_courts::League;
use crate::shooter::Profile;
use crate::units::{FOOT_M, UnitSystem, at_most_two_decimals};
use std::collections::BTreeMap;

/// Side of a square, m.
fn step_m(units: UnitSystem) -> f64 {
    match units {
        UnitSystem::Imperial => FOOT_M,
        UnitSystem::Metric => 0.3,
    }
}

/// Draws the share of the misses that fall into each square; `None` where none comes down.
#[must_use]
pub fn draw(profile: &Profile, rebounds: &[Rebound], answer: &ReboundsAnswer) -> Option<Plot> {
    let units = profile.output().units;
    let (long, metre) = units.length();
    let step = step_m(units);
    let mut counts: BTreeMap<(i64, i64), usize> = BTreeMap::new();
    for rebound in rebounds {
        let spot = rebound.spots[1];
        let cell = (
            (spot.x_m / step).round() as i64,
            (spot.y_m / step).round() as i64,
        );
        *counts.entry(cell).or_default() += 1;
    }
    let most = *counts.values().max()? as f64;
    let total = rebounds.len() as f64;
    let places: Vec<ColouredPlace> = counts
        .iter()
        .map(|((x, y), count)| ColouredPlace {
            x_m: *x as f64 * step,
            y_m: *y as f64 * step,
            colour: Some(sequential(*count as f64 / most)),
        })
        .collect();
    let court = League::of_physics(profile.physics()).court();
    let location = profile.location();
    let map = CourtMap {
        court: &court,
        physics: profile.physics(),
        units,
        step_m: Some(step),
        least_gap_m: 0.0,
        far_x_m: location.to_xy().0.max(20.0 * FOOT_M),
        style: MapStyle::Plot,
    };
    let (width, height) = map.size();
    let mut svg = Svg::new(width + 40.0, height + 70.0);
    let who = shortened(&profile.shooter().name, 40);
    let from = location.in_words(units);
    svg.heading((20.0, 24.0), 15.0, Anchor::Start, &format!("{who}: {from}"));
    let largest = 100.0 * most / total;
    let colour = |percent: f64| -> Rgb { sequential(percent / largest) };
    let key = ColourKey::Scale(ColourScale {
        name: "% of misses",
        range: (0.0, largest),
        colour: &colour,
    });
    let height_words = at_most_two_decimals(answer.height_m / metre);
    let title = format!("where misses come down ({height_words} {long} above the floor)");
    map.draw(&mut svg, (0.0, 30.0), &title, &places, &key);
    svg.footnote(
        (20.0, height + 44.0),
        &format!(
            "{} misses of {} shots; half of them {:.1} to {:.1} {long} from the hoop's centre.",
            answer.misses,
            answer.shots,
            answer.all.distance_m.lower_quartile / metre,
            answer.all.distance_m.upper_quartile / metre
        ),
    );
    svg.footnote(
        (20.0, height + 60.0),
        "Without net and players; below the ring the ball touches nothing.",
    );
    let caption = "Where the misses of the shot come down.";
    Some(Plot {
        name: "rebounds".to_owned(),
        caption: caption.to_owned(),
        svg: svg.finish(caption),
    })
}
