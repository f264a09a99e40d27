//! The content of `team.html`.

use super::court_results::{
    PLAYER_COLUMNS, bank_texts, least_to_most, notes, place_header, place_in_words, place_rows,
    player_rows, ranking, remarks, standings, sure_in_words,
};
use super::player_advice::PlayerAdvice;
use super::player_sweep::{PlayerSweep, best_players};
use super::words::{LONGEST_NAME, in_hundred};
use crate::plots::svg::{Plot, shortened};
use crate::report::team_page::{PageTable, TeamPage};
use crate::sweep::probability_by_place::{PlaceProbabilities, with_mirror_images};
use crate::units::UnitSystem;

/// The page has a table of all places up to this many.
const MOST_PAGE_ROWS: usize = 60;
/// Places to bank from in a row of the summary.
const MOST_PLACES: usize = 4;

/// The content of the page.
pub(super) fn team_page(
    players: &[PlayerSweep],
    maps: Option<Plot>,
    has_posters: bool,
    (warnings, ring): (&str, (f64, f64)),
    units: UnitSystem,
) -> TeamPage {
    let best = best_players(players);
    let (of_level, of_profiles) = remarks(players, &best, ring);
    let mut tables = vec![PageTable {
        caption: format!(
            "Makes per 100 with each player's best shot (not the current one), {}",
            ranking(players).in_words()
        ),
        columns: PLAYER_COLUMNS.map(|name| name.replace('\n', " ")).to_vec(),
        rows: player_rows(players, &best),
    }];
    if best.len() <= MOST_PAGE_ROWS {
        tables.push(PageTable {
            caption: "Makes per 100 at each place: direct/bank".to_owned(),
            columns: place_header(players, LONGEST_NAME),
            rows: place_rows(players, units),
        });
    }
    let advised: Vec<&PlayerAdvice> = advised(players).collect();
    let one_place = one_place(&advised);
    let advice = advised.iter().map(|advice| {
        let text = advice.text.trim_end().to_owned();
        let mut remarks = Vec::new();
        if one_place.is_none() {
            remarks.push(format!("From {}.", advice.from));
        }
        if advice.further_places > 0 {
            remarks.push(format!(
                "The fit has {} more (`bankshot advise`).",
                match advice.further_places {
                    1 => "1 place".to_owned(),
                    places => format!("{places} places"),
                }
            ));
        }
        match remarks.is_empty() {
            true => text,
            false => format!("{text} ({})", remarks.join(" ")),
        }
    });
    TeamPage {
        advice: advice.collect(),
        advice_title: match one_place {
            Some(from) => format!("Each player's measured shot, {from}"),
            None => "Each player's measured shot".to_owned(),
        },
        summary: summary(players, units),
        answer: bank_texts(players, units).concat(),
        tables,
        maps,
        posters: has_posters.then(|| "posters.html".to_owned()),
        footer: format!("{warnings}{}{of_level}{of_profiles}", notes(players)),
    }
}

/// The advice of the players who were measured, the best player first.
fn advised(players: &[PlayerSweep]) -> impl Iterator<Item = &PlayerAdvice> {
    let order = ranking(players).order.into_iter();
    order.filter_map(|number| players[number].advice.as_ref())
}

/// Where all measured shots are from, if that is one place.
fn one_place<'a>(advised: &[&'a PlayerAdvice]) -> Option<&'a str> {
    let first = advised.first()?;
    let is_one = advised.iter().all(|other| other.from == first.from);
    is_one.then_some(first.from.as_str())
}

/// A row for each player: the chances over the court, where to bank, and what to change.
fn summary(players: &[PlayerSweep], units: UnitSystem) -> PageTable {
    let advised: Vec<&PlayerAdvice> = advised(players).collect();
    let mut columns = vec!["player", "best shots", "bank it from"];
    if !advised.is_empty() {
        columns.extend(["now", "after", "change", "train"]);
    }
    let standings = standings(players);
    let rows = ranking(players).order.into_iter().map(|number| {
        let mean = standings[number].value;
        let player = &players[number];
        let mut row = vec![
            shortened(&player.name, LONGEST_NAME),
            in_hundred(mean),
            bank_lines(player, units),
        ];
        if !advised.is_empty() {
            row.extend(player.advice.as_ref().map_or_else(
                || std::array::from_fn(|_| String::new()),
                |PlayerAdvice { short, from, .. }| {
                    // The numbers of an interval stay on one line.
                    let usual = short.usual.replace(' ', "\u{a0}");
                    let usual = match one_place(&advised) {
                        Some(_) => usual,
                        None => format!("{usual}\n{from}"),
                    };
                    [
                        usual,
                        short.advised.replace(' ', "\u{a0}"),
                        short.change.clone(),
                        short.training.clone(),
                    ]
                },
            ));
        }
        row
    });
    let mut caption = "Makes per 100. Best shots: with the best release, mean of all places. Bank it from: the best bank shot (the best direct shot)".to_owned();
    let has_draws = |place: &PlaceProbabilities| place.bank_is_better.is_some();
    if players
        .iter()
        .any(|player| player.places.iter().any(has_draws))
    {
        caption += ", and the probability that bank is better";
    }
    let mut banks = players.iter().flat_map(|player| player.bank_places());
    if banks.any(PlaceProbabilities::turns_with_the_hoop) {
        caption += "; * where direct is better on an unusual ring or board";
    }
    caption += ".";
    if !advised.is_empty() {
        let from = one_place(&advised).map_or_else(String::new, |from| format!(", {from}"));
        caption += &format!(
            " Now: with the current shot{from} (95 % interval). After: with the suggested shot and the same scatter (95 % interval; ? where no change is clearly better). Change: in brackets the probability that this change is the better one to start with. Train: the scatter that costs most."
        );
    }
    PageTable {
        caption,
        columns: columns.into_iter().map(str::to_owned).collect(),
        rows: rows.collect(),
    }
}

/// The places to bank from, a line each: `either wing, 11 ft: 80 to 82 (75), 96 %`.
fn bank_lines(player: &PlayerSweep, units: UnitSystem) -> String {
    let (bank, unsure) = (player.bank_places(), player.unsure_places());
    let words_of = |same: &[&PlaceProbabilities], listed: &[&PlaceProbabilities]| {
        let words = same[0].in_players_words(listed, units);
        let alike = [&bank, &unsure].into_iter().flatten();
        let alike = alike.filter(|other| {
            let is_same = same.iter().any(|place| place.place == other.place);
            !is_same && other.in_players_words(listed, units) == words
        });
        // The angle only where the words are those of two places.
        let words = match alike.count() {
            0 => words,
            _ => place_in_words(same[0], listed, units),
        };
        words.replace(" from the hoop", "")
    };
    let p_of = |same: &[&PlaceProbabilities]| {
        let [bank, direct] = [
            least_to_most(same.iter().map(|place| place.bank), 0),
            least_to_most(same.iter().map(|place| place.direct), 0),
        ];
        format!("{bank} ({direct})")
    };
    let surely = with_mirror_images(&bank).into_iter().map(|same| {
        let turns = same.iter().any(|place| place.turns_with_the_hoop());
        let sure = sure_in_words(&same).map_or_else(String::new, |sure| format!(", {sure}"));
        format!(
            "{}: {}{sure}{}",
            words_of(&same, &bank),
            p_of(&same),
            if turns { "\u{a0}*" } else { "" }
        )
    });
    let open = with_mirror_images(&unsure).into_iter().filter_map(|same| {
        /// Draws that are divided more evenly lean to no side.
        const LEANS: f64 = 0.6;
        let leaning = match same[0].share_of_preferred()? {
            share if share >= LEANS => format!(
                ", {} more likely ({})",
                same[0].preference()?.name(),
                sure_in_words(&same)?
            ),
            _ => String::new(),
        };
        Some(format!(
            "not clear{leaning}: {}: {}",
            words_of(&same, &unsure),
            p_of(&same)
        ))
    });
    let mut lines: Vec<String> = surely.chain(open).collect();
    if lines.is_empty() {
        return "nowhere: shoot direct".to_owned();
    }
    if lines.len() > MOST_PLACES {
        let more = lines.len() - (MOST_PLACES - 1);
        lines.truncate(MOST_PLACES - 1);
        lines.push(format!("and {more} more"));
    }
    lines.join("\n")
}
