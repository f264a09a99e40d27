//! One court map for a player's wall: makes in 100 shots at each place, and where to bank. It reads
//! as well in black and white.

use super::colormaps::{Rgb, sequential};
use super::colour_key::ColourKey;
use super::court_map::{CourtMap, MapStyle};
use super::svg::{Anchor, Plot, Svg};
use super::sweep_results::SweepResults;
use crate::analysis::sensitivity::Difference;
use crate::sweep::probability_by_place::{
    PlaceProbabilities, Preference, board_aim_of_sides, left_and_right_differ, with_mirror_images,
};
use crate::units::UnitSystem;

/// y of the map, px.
const MAP_TOP: f64 = 40.0;
/// Font size of the sentences, px; their lines are [`LINE_HEIGHT`] apart and at most
/// [`LINE_LETTERS`] long.
const WORDS_FONT: f64 = 18.0;
/// See [`WORDS_FONT`].
const LINE_HEIGHT: f64 = 25.0;
/// See [`WORDS_FONT`].
const LINE_LETTERS: usize = 66;

/// A poster.
#[derive(Clone, Debug)]
pub struct PlayerPoster {
    /// The map with the sentences below it.
    pub plot: Plot,
    /// The map alone, for a page with the sentences as text.
    pub map_svg: String,
    /// What the map says: three sentences, two numbers each; two of them for one place. After them
    /// what the player's own shots say, if they were measured.
    pub sentences: Vec<String>,
}

/// Draws the poster of a player; `None` if nothing can be made from any place. `own` is what the
/// player's own shots say: a last sentence.
#[must_use]
pub fn draw(results: &SweepResults<'_>, own: Option<&str>) -> Option<PlayerPoster> {
    let found: Vec<(f64, &PlaceProbabilities)> = results
        .chances()
        .iter()
        .filter_map(|place| Some((place.told()?.value, place)))
        .collect();
    let first = found.first().copied()?;
    let best = found.iter().copied();
    let best = best.fold(first, |a, b| if b.0 > a.0 { b } else { a });
    let worst = found.iter().copied();
    let worst = worst.fold(first, |a, b| if b.0 < a.0 { b } else { a });
    let is_bank = |place: &PlaceProbabilities| {
        place.preference() == Some(Preference::Bank) && place.is_sure()
    };
    let at = |place: &PlaceProbabilities| (place.place.x_m, place.place.y_m);
    let bank = results.chances().iter().filter(|place| is_bank(place));
    let bank: Vec<&PlaceProbabilities> = bank.collect();
    let outlined: Vec<(f64, f64)> = bank.iter().map(|place| at(place)).collect();
    let numbers: Vec<((f64, f64), String, bool)> = found
        .iter()
        .map(|(p, place)| {
            let doubt = if place.is_sure() { "" } else { "?" };
            (at(place), shown(*p) + doubt, is_bank(place))
        })
        .collect();
    let units = results.units();
    // The mirror image of a place is named with it where the map shows the same number there.
    let alike = |p: f64| -> Vec<&PlaceProbabilities> {
        let same = found.iter().filter(|(other, _)| shown(*other) == shown(p));
        same.map(|(_, place)| *place).collect()
    };
    let as_sure = like_best_count(&found, best.0);
    let like_best = alike(best.0);
    let named = best.1.in_players_words(&like_best, units);
    let is_both = best.1.has_mirror_in(&like_best);
    let others = as_sure.saturating_sub(if is_both { 2 } else { 1 });
    let is_one_place = found.len() == 1;
    let mut sentences = vec![
        match others {
            _ if is_one_place => format!(
                "With your best release {} of 100 go in from {named}.",
                of_hundred(best.0)
            ),
            0 => format!(
                "Your best place: {named}. With your best release {} of 100 go in there.",
                of_hundred(best.0)
            ),
            _ => format!(
                "Your best place: {named}. With your best release {} of 100 go in there; {others} other {} as good.",
                of_hundred(best.0),
                if others == 1 {
                    "place is"
                } else {
                    "places are"
                }
            ),
        },
        if bank.is_empty() {
            direct_in_words(results.chances())
        } else {
            bank_in_words(&bank, units)
        },
    ];
    if !is_one_place {
        sentences.push(format!(
            "Your hardest place: {}. {} of 100 go in there.",
            worst.1.in_players_words(&alike(worst.0), units),
            of_hundred(worst.0)
        ));
    }
    sentences.extend(own.filter(|own| !own.is_empty()).map(str::to_owned));
    let mut notes = hoop_in_words(&bank, units) + &doubt_in_words(results.chances());
    if own.is_some() && left_and_right_differ(results.chances()) {
        notes += " The difference between left and right can be chance.";
    }
    if !notes.is_empty() {
        sentences.push(notes.trim_start().to_owned());
    }
    let drawing = |words: &[String]| {
        let map = CourtMap {
            style: MapStyle::Poster,
            ..results.court_map()
        };
        let (width, height) = map.size();
        let lines: Vec<_> = words
            .iter()
            .flat_map(|sentence| textwrap::wrap(sentence, LINE_LETTERS))
            .collect();
        let words_top = MAP_TOP + height;
        let mut svg = Svg::new(width, words_top + LINE_HEIGHT * lines.len() as f64);
        let title = format!(
            "{}: makes per 100 with the best release",
            results.shooter_name()
        );
        svg.heading((10.0, 26.0), 22.0, Anchor::Start, &title);
        let corner = (0.0, MAP_TOP);
        let no_key = ColourKey::Legend(&[]);
        results.draw_on(&map, &mut svg, corner, "", &no_key, &|place| {
            let chances = results.chances();
            let told = chances
                .iter()
                .find(|known| known.place == place.place)?
                .told();
            Some(pale(told?.value))
        });
        map.draw_outline(&mut svg, corner, &outlined);
        map.draw_numbers(&mut svg, corner, &numbers);
        for (i, line) in lines.iter().enumerate() {
            let at = (10.0, words_top + LINE_HEIGHT * (i as f64 + 0.6));
            svg.text(at, WORDS_FONT, Anchor::Start, line);
        }
        svg.finish(&sentences.join(" "))
    };
    Some(PlayerPoster {
        plot: Plot {
            name: "poster".to_owned(),
            svg: drawing(&sentences),
            caption: sentences.join(" "),
        },
        map_svg: drawing(&[]).to_string(),
        sentences,
    })
}

/// Places that show the same number as the surest one.
fn like_best_count(found: &[(f64, &PlaceProbabilities)], best: f64) -> usize {
    found
        .iter()
        .filter(|(p, _)| shown(*p) == shown(best))
        .count()
}

/// A chance as the map shows it: nobody makes all shots.
fn shown(p: f64) -> String {
    if p >= 0.995 {
        ">99".to_owned()
    } else {
        format!("{:.0}", 100.0 * p)
    }
}

/// A chance in a sentence: nobody makes all shots.
fn of_hundred(p: f64) -> String {
    if p >= 0.995 {
        "more than 99".to_owned()
    } else {
        shown(p)
    }
}

/// The colour of a probability, so pale that black numbers stand out on it.
fn pale(p: f64) -> Rgb {
    sequential(p).map(|part| 140 + (u16::from(part) * 115 / 255) as u8)
}

/// That the bank shot is better at no place, and at how many it is as good.
fn direct_in_words(places: &[PlaceProbabilities]) -> String {
    let is_level = |place: &&PlaceProbabilities| place.preference() == Some(Preference::Either);
    let level = match places.iter().filter(is_level).count() {
        0 => String::new(),
        1 => " At 1 place the bank shot is just as good.".to_owned(),
        places => format!(" At {places} places the bank shot is just as good."),
    };
    let clearly = match places.iter().all(PlaceProbabilities::is_sure) {
        true => "Shoot direct everywhere.",
        false => "Shoot direct: the bank shot is clearly better nowhere.",
    };
    format!("{clearly}{level}")
}

/// At how many places the measured shots leave the kind of shot open; empty if at none.
fn doubt_in_words(places: &[PlaceProbabilities]) -> String {
    let places = match places.iter().filter(|place| !place.is_sure()).count() {
        0 => return String::new(),
        1 => "the place".to_owned(),
        open => format!("{open} places"),
    };
    format!(
        " At {places} marked ? your shots cannot yet settle bank or direct; the number is for the direct shot."
    )
}

/// Where the rectangle on the board is. Rule books give 24 by 18 in (59 by 45 cm) outside, and the
/// upper edge of its base line, 2 in (5 cm) wide, level with the
/// ring.
fn square_in_words(units: UnitSystem) -> String {
    let [height, half_width] = match units {
        UnitSystem::Imperial => ["16 in", "12 in"],
        UnitSystem::Metric => ["40 cm", "30 cm"],
    };
    format!(
        " (The square on the board reaches {height} above the ring and {half_width} to each side.)"
    )
}

/// From which of the places the bank shot is not better on each ring and board; empty if it is from
/// all.
fn hoop_in_words(bank: &[&PlaceProbabilities], units: UnitSystem) -> String {
    let turned = bank.iter().copied();
    let turned: Vec<&PlaceProbabilities> =
        turned.filter(|place| place.turns_with_the_hoop()).collect();
    let places = match turned.len() {
        0 => return String::new(),
        _ if bank.len() == 1 => "there".to_owned(),
        all if all == bank.len() => "from all outlined places".to_owned(),
        _ => {
            let groups = with_mirror_images(&turned).into_iter();
            let words = groups.map(|same| same[0].in_players_words(&turned, units));
            format!("from {}", words.collect::<Vec<_>>().join("; "))
        }
    };
    format!(" On some rings or boards direct is better {places}: try both in your gym.")
}

/// Where banking helps most, and where to aim from each place.
fn bank_in_words(bank: &[&PlaceProbabilities], units: UnitSystem) -> String {
    /// Places whose aims are told, with their mirror images: those where it helps most.
    const MOST_AIMS: usize = 4;
    let gain = |place: &PlaceProbabilities| place.bank_gain().map_or(1.0, |gain| gain.value);
    let most_of = |same: &[&PlaceProbabilities]| {
        same.iter()
            .fold(0.0_f64, |most, place| most.max(gain(place)))
    };
    let mut groups = with_mirror_images(bank);
    groups.sort_by(|a, b| most_of(b).total_cmp(&most_of(a)));
    let Some(most) = groups.first() else {
        return String::new();
    };
    let least_to_most = |of: &dyn Fn(&PlaceProbabilities) -> Option<Difference>| {
        let mut found: Vec<f64> = most
            .iter()
            .filter_map(|place| Some(of(place)?.value))
            .collect();
        found.sort_by(f64::total_cmp);
        let mut words: Vec<String> = found.into_iter().map(of_hundred).collect();
        words.dedup();
        (!words.is_empty()).then(|| words.join(" to "))
    };
    let direct =
        least_to_most(&|place| place.direct).map_or(String::new(), |p| format!(", {p} direct"));
    let aims: Vec<String> = groups
        .iter()
        .take(MOST_AIMS)
        .map(|same| {
            // Where the two sides differ in kind, that of the first.
            let aim = board_aim_of_sides(same, units)
                .or_else(|| same[0].board_aim_in_words(units))
                .unwrap_or_default();
            match groups.len() {
                1 => aim,
                _ => format!("from {}: {aim}", same[0].in_players_words(bank, units)),
            }
        })
        .collect();
    format!(
        "Bank the ball from the outlined places. Banking helps most here: {}. {} of 100 go in{direct}. Aim at the board, {}.{}",
        most[0].in_players_words(bank, units),
        least_to_most(&|place| place.bank).unwrap_or_default(),
        aims.join("; "),
        square_in_words(units)
    )
}
