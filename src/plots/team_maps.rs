//! The players of a team side by side: P of each one's best shot over the court, where they should
//! bank, and who is best from where.

use super::colormaps::{Rgb, sequential};
use super::colour_key::{ColourKey, ColourScale};
use super::court_map::ColouredPlace;
use super::svg::{Anchor, Plot, Svg, shortened};
use super::sweep_results::SweepResults;
use crate::sweep::probability_by_place::{PlaceProbabilities, Preference};

/// Most maps in a row.
const COLUMNS: usize = 3;
/// y of the first maps, px.
const MAPS_TOP: f64 = 34.0;
/// Longest name in a title and in the legend, in characters.
const LONGEST_NAME: usize = 24;
/// See [`LONGEST_NAME`]: beside a map there is less space.
const LONGEST_IN_LEGEND: usize = 14;
/// Where several players are level.
const LEVEL: Rgb = [225, 225, 225];
/// Colours of players that can be told apart, also by most of those who are colour-blind (Okabe and
/// Ito 2008); a ninth player has the first one's again, darker.
const PLAYERS: [Rgb; 8] = [
    [0, 114, 178],
    [230, 159, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [213, 94, 0],
    [240, 228, 66],
    [90, 90, 90],
];

/// Draws a map for each player and one of the team. `best` has the best players at each place, by
/// their numbers; more than one are level. All sweeps are of the same places.
#[must_use]
pub fn draw(players: &[SweepResults<'_>], best: &[Vec<usize>]) -> Option<Plot> {
    let first = players.first()?;
    let map = first.court_map();
    let (width, height) = map.size();
    // As square as it goes.
    let columns = (1..COLUMNS)
        .find(|columns| columns * columns > players.len())
        .unwrap_or(COLUMNS);
    let lines = (players.len() + 1).div_ceil(columns);
    let note_top = MAPS_TOP + lines as f64 * height + 6.0;
    let mut svg = Svg::new(columns as f64 * width, note_top + 34.0);
    svg.heading(
        (20.0, 24.0),
        16.0,
        Anchor::Start,
        "The team: how likely each player's best shot goes in, and who is best from each place",
    );
    let corner = |i: usize| {
        let (line, column) = (i / columns, i % columns);
        (column as f64 * width, MAPS_TOP + line as f64 * height)
    };
    // One scale for all, and no wider than they need.
    let all = players.iter().flat_map(|player| player.chances());
    let least = all
        .filter_map(|place| Some(place.best()?.value))
        .fold(1.0, f64::min);
    let low = (libm::floor(10.0 * least) / 10.0).clamp(0.0, 0.9);
    let colour = |p: f64| sequential((p - low) / (1.0 - low));
    let scale = ColourKey::Scale(ColourScale {
        name: "probability",
        range: (low, 1.0),
        colour: &colour,
    });
    for (i, player) in players.iter().enumerate() {
        let places: Vec<ColouredPlace> = player
            .chances()
            .iter()
            .map(|place| ColouredPlace {
                x_m: place.place.x_m,
                y_m: place.place.y_m,
                colour: place.best().map(|p| colour(p.value)),
            })
            .collect();
        let title = shortened(&player.shooter_name(), LONGEST_NAME);
        map.draw(&mut svg, corner(i), &title, &places, &scale);
        let is_bank = |place: &&PlaceProbabilities| {
            place.preference() == Some(Preference::Bank) && place.is_sure()
        };
        let bank = player.chances().iter().filter(is_bank);
        let bank: Vec<(f64, f64)> = bank.map(|p| (p.place.x_m, p.place.y_m)).collect();
        map.draw_outline(&mut svg, corner(i), &bank);
    }
    let of_team: Vec<ColouredPlace> = first
        .chances()
        .iter()
        .zip(best)
        .map(|(place, best)| ColouredPlace {
            x_m: place.place.x_m,
            y_m: place.place.y_m,
            colour: match best[..] {
                [] => None,
                [one] => Some(colour_of(one)),
                _ => Some(LEVEL),
            },
        })
        .collect();
    let mut legend: Vec<(String, Rgb)> = players
        .iter()
        .enumerate()
        .map(|(i, player)| {
            (
                shortened(&player.shooter_name(), LONGEST_IN_LEGEND),
                colour_of(i),
            )
        })
        .collect();
    legend.push(("level".to_owned(), LEVEL));
    let legend = ColourKey::Legend(&legend);
    map.draw(
        &mut svg,
        corner(players.len()),
        "the best of the team",
        &of_team,
        &legend,
    );
    let caption = "Outlined: the bank shot is better by 1 per 100 or more (for a fitted player, with a probability of at least 90 % too). Level: the best two or more differ by less than 1 per 100, or by less than the simulation error.";
    svg.footnote((20.0, note_top), caption);
    svg.footnote((20.0, note_top + 16.0), &first.team_note(players.len()));
    Some(Plot {
        name: "team".to_owned(),
        svg: svg.finish(caption),
        caption: caption.to_owned(),
    })
}

/// The colour of a player.
fn colour_of(player: usize) -> Rgb {
    let colour = PLAYERS[player % PLAYERS.len()];
    if player < PLAYERS.len() {
        colour
    } else {
        colour.map(|part| (u16::from(part) * 3 / 5) as u8)
    }
}
