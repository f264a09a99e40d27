//! What the sweeps of a team say: who is best from where, who should bank from where.

use super::player_advice::PlayerAdvice;
use super::player_sweep::{PlayerSweep, best_players};
use super::ranking::{Ranking, Standing, own_sd, pooled};
use super::words::{LONGEST_NAME, in_hundred, table_of, whole_percent};
use crate::analysis::sensitivity::Difference;
use crate::fitting::UnseenParameter;
use crate::model::SolidId;
use crate::plots::svg::shortened;
use crate::present::fit_files::session_changes_text::two_digits;
use crate::sweep::probability_by_place::{
    PlaceProbabilities, board_aim_of_sides, left_and_right_differ, with_mirror_images,
};
use crate::units::{DEGREE_RAD, UnitSystem};

/// Longest place in a list, in characters.
const LONGEST_PLACE: usize = 60;
/// Places to bank from that are printed for each player.
const MOST_BANK_PLACES: usize = 5;

/// A table of places and players is printed up to this size.
const MOST_COLUMNS: usize = 5;
/// Longest name at the top of its columns, in characters.
const LONGEST_IN_HEADER: usize = 9;
/// See [`MOST_COLUMNS`].
const MOST_ROWS: usize = 16;

/// A place in words, and `direct/bank` of each player there.
pub(super) fn place_rows(players: &[PlayerSweep], units: UnitSystem) -> Vec<Vec<String>> {
    let row = |(place, known): (usize, &PlaceProbabilities)| {
        let cell = |player: &PlayerSweep| {
            let p = |p: Option<Difference>| {
                p.map_or("-".to_owned(), |p| format!("{:.0}", 100.0 * p.value))
            };
            let here = &player.places[place];
            let doubt = if here.is_sure() { "" } else { "?" };
            format!("{}/{}{doubt}", p(here.direct), p(here.bank))
        };
        let words = place_in_words(known, &[], units);
        std::iter::once(words)
            .chain(players.iter().map(cell))
            .collect()
    };
    players[0].places.iter().enumerate().map(row).collect()
}

/// The names of the columns of [`place_rows`].
pub(super) fn place_header(players: &[PlayerSweep], longest_name: usize) -> Vec<String> {
    // Two lines at most, so that a name is cut as late as possible.
    let name = |player: &PlayerSweep| {
        let mut words = player.name.split_whitespace();
        let first = shortened(words.next().unwrap_or_default(), longest_name);
        let rest: Vec<&str> = words.collect();
        match rest.is_empty() {
            true => first,
            false => format!("{first}\n{}", shortened(&rest.join(" "), longest_name)),
        }
    };
    let names = players.iter().map(name);
    std::iter::once("from".to_owned()).chain(names).collect()
}

/// The mean of P over all places of a player's best shots, with the error that the measured shots
/// leave, without what all players have in common.
fn mean_over_places(player: &PlayerSweep) -> Standing {
    let found = player.places.iter().filter_map(PlaceProbabilities::best);
    let found: Vec<f64> = found.map(|p| p.value).collect();
    Standing {
        value: found.iter().sum::<f64>() / found.len().max(1) as f64,
        // The simulation's own error is far less.
        standard_error: own_sd(player.probability_sd, player.shared_sd).max(1e-4),
    }
}

/// Who is best over all places.
pub(super) fn ranking(players: &[PlayerSweep]) -> Ranking {
    Ranking::of(&standings(players))
}

/// The players' means over all places as those of one team.
pub(super) fn standings(players: &[PlayerSweep]) -> Vec<Standing> {
    let alone: Vec<Standing> = players.iter().map(mean_over_places).collect();
    pooled(&alone)
}

/// A row for each player: name, mean, places to bank from, places where nobody is as good.
pub(super) fn player_rows(players: &[PlayerSweep], best: &[Vec<usize>]) -> Vec<Vec<String>> {
    let ranking = ranking(players);
    let standings = standings(players);
    let row = |&number: &usize| {
        let player = &players[number];
        let mean = standings[number];
        let own = best.iter().filter(|of| of[..] == [number]).count();
        let (banks, unsure) = (player.bank_places().len(), player.unsure_places().len());
        let places = player.places.len();
        vec![
            shortened(&player.name, LONGEST_NAME),
            match player.probability_sd {
                0.0 => in_hundred(mean.value),
                _ => {
                    let half = 1.96 * libm::hypot(mean.standard_error, player.shared_sd);
                    format!(
                        "{:.0} ({:.0} to {:.0})",
                        100.0 * mean.value,
                        100.0 * (mean.value - half).max(0.0),
                        100.0 * (mean.value + half).min(1.0)
                    )
                }
            },
            format!("{} %", whole_percent(ranking.is_best[number])),
            match unsure {
                0 => format!("{banks} of {places}"),
                unsure => format!("{banks} of {places}, {unsure} not clear"),
            },
            format!("{own} of {}", best.len()),
        ]
    };
    ranking.order.iter().map(row).collect()
}

/// The columns of [`player_rows`].
pub(super) const PLAYER_COLUMNS: [&str; 5] = [
    "player",
    "average over\nall places",
    "best of\nall",
    "places\nto bank",
    "places where\nbest alone",
];

/// What is to be said of places where players are level, and of what is taken as exact.
pub(super) fn remarks(
    players: &[PlayerSweep],
    best: &[Vec<usize>],
    ring: (f64, f64),
) -> (String, &'static str) {
    let level = best.iter().filter(|of| of.len() > 1).count();
    let of_level = if level > 0 {
        format!(
            "At {level} of {} places two or more players are within 1 per 100, or within their uncertainty (listed in team.csv).\n",
            best.len()
        )
    } else {
        String::new()
    };
    let has_draws = |player: &PlayerSweep| {
        let mut places = player.places.iter();
        places.any(|place| place.bank_is_better.is_some())
    };
    let has_unsure_places = |player: &PlayerSweep| !player.unsure_places().is_empty();
    let of_profiles = if players.iter().any(has_unsure_places) {
        "?: not clear, as the probability that this kind is better is below 90 % (listed in team.csv). The numbers of single places take each profile as exact, however few shots it rests on.\n"
    } else if players.iter().any(has_draws) {
        "The numbers of single places take each profile as exact, however few shots it rests on; team.csv has the probability that bank is better.\n"
    } else {
        "The numbers take each profile as exact; for a measured player see `bankshot advise`.\n"
    };
    (of_level + &of_hoops(players, ring), of_profiles)
}

/// What the ring and the board of the gym have to do with bank or direct; empty where they decide
/// nothing and nothing was asked about them.
fn of_hoops(players: &[PlayerSweep], (low, high): (f64, f64)) -> String {
    let mut places = players.iter().flat_map(|player| player.bank_places());
    let turns = places.any(PlaceProbabilities::turns_with_the_hoop);
    let told = (low, high) != UnseenParameter::HoopRestitution.usual_range();
    let mut text = match told {
        true => format!(
            "The makes support a ring restitution of {low:.2} to {high:.2}. The numbers use the ring of the profiles; bank or direct was checked on these rings too.\n"
        ),
        false if turns => format!(
            "The ring of this gym was not measured. Published values of its restitution run from {low:.2} (dead) to {high:.2} (lively). `bankshot fit SHOTS --free hoop_restitution` estimates it from makes and misses; `team` then uses that estimate.\n"
        ),
        false => String::new(),
    };
    if turns {
        text += "Boards were checked with a restitution 0.05 lower and higher. On some rings and boards direct is better, at the places marked.\n";
    }
    text
}

/// From where a player should bank, and from where that is open.
fn bank_text(player: &PlayerSweep, units: UnitSystem) -> String {
    let name = shortened(&player.name, LONGEST_NAME);
    let aim = |same: &[&PlaceProbabilities]| {
        let aim = board_aim_of_sides(same, units);
        let aim = aim.map(|aim| format!("aim at the board, {aim}"));
        let sure =
            sure_in_words(same).map(|sure| format!("probability that bank is better: {sure}"));
        let words = [sure, aim, hoop_in_words(same), sides_in_words(same)];
        let words: Vec<String> = words.into_iter().flatten().collect();
        (!words.is_empty()).then(|| words.join("; "))
    };
    let share = |same: &[&PlaceProbabilities]| {
        let shares = same.iter().filter_map(|place| {
            let share = whole_percent(place.share_of_preferred()?);
            let more = match place.shots_to_be_sure() {
                Some(more) if more < MOST_SHOTS => {
                    format!("; about {} more shots would settle it", two_digits(more))
                }
                _ => String::new(),
            };
            Some(format!(
                "{} is probably better ({share} %){more}",
                place.preference()?.name()
            ))
        });
        let mut shares: Vec<String> = shares.chain(sides_in_words(same)).collect();
        // Both sides of a place mostly have one answer.
        shares.dedup();
        (!shares.is_empty()).then(|| shares.join("; "))
    };
    let surely = place_list(&player.bank_places(), ("  ", &aim), units);
    let perhaps = place_list(&player.unsure_places(), ("    ", &share), units);
    let mut text = match (surely.is_empty(), perhaps.is_empty()) {
        (true, true) => format!("{name}: no place where the bank shot is better by 1 per 100.\n"),
        (true, false) => format!("{name}: no place where the bank shot is clearly better.\n"),
        (false, _) => format!("{name}: bank it from\n{surely}"),
    };
    if !perhaps.is_empty() {
        text += &format!("  not clear yet which is better:\n{perhaps}");
    }
    text
}

/// In how many of 100 draws the preferred kind is the better one at a place, or at both sides:
/// `92 %`, `over 99 %`. `None` where no draws were asked.
pub(super) fn sure_in_words(same: &[&PlaceProbabilities]) -> Option<String> {
    let shares = same.iter().filter_map(|place| place.share_of_preferred());
    let least = shares.reduce(f64::min)?;
    Some(match whole_percent(least) {
        100 => "above 99 %".to_owned(),
        percent => format!("{percent} %"),
    })
}

/// That the draws tell a place from its mirror image; `None` where they do not.
fn sides_in_words(same: &[&PlaceProbabilities]) -> Option<String> {
    let agree = same.iter().filter_map(|place| place.sides_differ);
    let agree = agree.reduce(f64::min)?;
    Some(format!(
        "left and right differ (probability {} %)",
        whole_percent(agree).min(99)
    ))
}

/// P of the bank shot at some places, a line for each, which begins with `indent`, and below it
/// what else there is to say of the place, or of both sides together.
fn place_list(
    places: &[&PlaceProbabilities],
    (indent, more): (&str, &dyn Fn(&[&PlaceProbabilities]) -> Option<String>),
    units: UnitSystem,
) -> String {
    let listed = with_mirror_images(places);
    let mut text = String::new();
    for same in listed.iter().take(MOST_BANK_PLACES) {
        let words = place_in_words(same[0], places, units);
        text += &format!(
            "{indent}{words}: {} (direct {})\n",
            least_to_most(same.iter().map(|place| place.bank), 1),
            least_to_most(same.iter().map(|place| place.direct), 1),
        );
        if let Some(words) = more(same) {
            text += &format!("{indent}  {words}\n");
        }
    }
    if listed.len() > MOST_BANK_PLACES {
        let more = listed.len() - MOST_BANK_PLACES;
        text += &format!("{indent}and {more} more: team.csv\n");
    }
    text
}

/// A place in a player's words, with its court angle: the words alone may be those of two.
pub(super) fn place_in_words(
    place: &PlaceProbabilities,
    listed: &[&PlaceProbabilities],
    units: UnitSystem,
) -> String {
    let words = shortened(&place.in_players_words(listed, units), LONGEST_PLACE);
    if place.name.is_some() {
        return words;
    }
    let angle_deg = place.place.location().angle_rad / DEGREE_RAD;
    let side = match angle_deg {
        _ if place.has_mirror_in(listed) => "",
        angle if angle >= 0.5 => " right",
        angle if angle <= -0.5 => " left",
        _ => "",
    };
    format!("{words} ({:.0} deg{side})", angle_deg.abs())
}

/// More shots than these are no plan.
const MOST_SHOTS: f64 = 5000.0;

/// That the direct shot is better on some ring or board; `None` if it is on none, from either side.
fn hoop_in_words(same: &[&PlaceProbabilities]) -> Option<String> {
    let turned: Vec<&PlaceProbabilities> = same
        .iter()
        .copied()
        .filter(|place| place.turns_with_the_hoop())
        .collect();
    let of_place = turned.iter().filter_map(|place| place.least_gain);
    let least = of_place.reduce(|a, b| if b.gain < a.gain { b } else { a })?;
    let side = match turned[..] {
        [one] if same.len() > 1 && one.place.y_m > 0.0 => " from the right",
        [_] if same.len() > 1 => " from the left",
        _ => "",
    };
    Some(format!(
        "on a {} with restitution {:.2} direct is better by {}{side}",
        match least.solid {
            SolidId::Board => "board",
            _ => "ring",
        },
        least.restitution,
        in_hundred(-least.gain)
    ))
}

/// P in 100 of a shot from one place, or from both sides: `80.6 to 82.2` where they differ.
pub(super) fn least_to_most(
    of_sides: impl Iterator<Item = Option<Difference>>,
    decimals: usize,
) -> String {
    let in_hundred = |p: f64| format!("{:.decimals$}", 100.0 * p);
    let mut points: Vec<f64> = of_sides.flatten().map(|p| p.value).collect();
    points.sort_by(f64::total_cmp);
    match (points.first(), points.last()) {
        (Some(&least), Some(&most)) if in_hundred(least) != in_hundred(most) => {
            format!("{} to {}", in_hundred(least), in_hundred(most))
        }
        (Some(&p), _) => in_hundred(p),
        _ => "none".to_owned(),
    }
}

/// Where to bank for each player, the clearest first.
pub(super) fn bank_texts(players: &[PlayerSweep], units: UnitSystem) -> Vec<String> {
    let order = ranking(players).order.into_iter();
    order
        .map(|number| bank_text(&players[number], units))
        .collect()
}

/// The answer for people.
pub(super) fn team_text(players: &[PlayerSweep], ring: (f64, f64), units: UnitSystem) -> String {
    let best = best_players(players);
    let mut table = table_of(&PLAYER_COLUMNS.map(str::to_owned));
    for row in player_rows(players, &best) {
        table.add(row);
    }
    let (of_level, of_profiles) = remarks(players, &best, ring);
    let mut text = format!(
        "Makes per 100 with each player's best shot (not the current one), {}\n{}\n{of_level}",
        ranking(players).in_words(),
        table.text().trim_end()
    );
    if players.len() <= MOST_COLUMNS && best.len() <= MOST_ROWS {
        let mut table = table_of(&place_header(players, LONGEST_IN_HEADER));
        for mut row in place_rows(players, units) {
            row[0] = textwrap::fill(&row[0], 20);
            table.add(row);
        }
        text += &format!(
            "\nMakes per 100 at each place: direct/bank\n{}\n",
            table.text().trim_end()
        );
    }
    text += of_profiles;
    text + &bank_texts(players, units).concat()
}

/// What must be said of where the shots were measured, and of left and right.
pub(super) fn notes(players: &[PlayerSweep]) -> String {
    measured_places(players) + &sides(players)
}

/// From where the players were measured: what they do elsewhere is taken from there.
fn measured_places(players: &[PlayerSweep]) -> String {
    let advice = players.iter().filter_map(|player| player.advice.as_ref());
    let advice: Vec<&PlayerAdvice> = advice.collect();
    let Some(first) = advice.first() else {
        return String::new();
    };
    let is_one = advice
        .iter()
        .all(|other| other.from == first.from && other.further_places == 0);
    let from = match is_one {
        true => format!("from one place, {}", first.from),
        false => "from the places of their fits".to_owned(),
    };
    let pooled = match advice.len() {
        1 => "",
        _ => " Averages are drawn towards the team's, as far as a player's shots leave them open.",
    };
    format!("Measured players shot {from}. Every other place assumes the same scatter.{pooled}\n")
}

fn sides(players: &[PlayerSweep]) -> String {
    let differ = |player: &&PlayerSweep| left_and_right_differ(&player.places);
    let measured = |player: &&PlayerSweep| player.advice.is_some();
    let differing: Vec<&PlayerSweep> = players.iter().filter(differ).collect();
    if differing.is_empty() {
        return String::new();
    }
    let mut text =
        "Left and right differ for players whose direction is correlated with speed or angle."
            .to_owned();
    if differing.iter().any(measured) {
        text += " With few shots that can be chance; profile.toml has the intervals.";
    }
    text + "\n"
}
