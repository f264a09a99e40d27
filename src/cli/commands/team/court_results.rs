//! What the sweeps of a team say: who is best from where, who should bank from where; as text, CSV
//! and a page.

use crate::analysis::sensitivity::Difference;
use crate::fitting::UnseenParameter;
use crate::output::fit_files::session_changes_text::two_digits;
use crate::plots::svg::{Plot, shortened};
use crate::report::team_page::{PageTable, TeamPage};
use crate::sweep::probability_by_place::{
    PlaceProbabilities, Preference, board_aim_of_sides, with_mirror_images,
};
use crate::units::{DEGREE_RAD, UnitSystem};
use comfy_table::{Table, presets};

/// Longest name of a player in the tables, in characters.
pub(super) const LONGEST_NAME: usize = 24;
/// Longest place in a list, in characters.
const LONGEST_PLACE: usize = 60;
/// What to say where a player's two sides differ.
pub(super) const SIDES_DIFFER: &str = "Left and right differ for players whose aim is correlated with speed or angle. After a fit of few shots that can be chance: its profile.toml has the intervals.\n";

/// A chance in 100.
pub(super) fn in_hundred(p: f64) -> String {
    format!("{:.1}", 100.0 * p)
}

pub(super) fn table_of(header: Vec<String>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(header);
    table
}

/// Places to bank from that are printed for each player.
const MOST_BANK_PLACES: usize = 5;

/// A player's finished sweep.
pub(super) struct PlayerSweep {
    pub(super) name: String,
    pub(super) places: Vec<PlaceProbabilities>,
    /// What a fitted player's own shots say, and where they were from.
    pub(super) advice: Option<(String, String)>,
}

impl PlayerSweep {
    /// The places where a bank shot is surely better, those with the greatest gain first.
    fn bank_places(&self) -> Vec<&PlaceProbabilities> {
        self.by_gain(|place| place.preference() == Some(Preference::Bank) && place.is_sure())
    }

    /// The places where the measured shots leave bank or direct open.
    fn unsure_places(&self) -> Vec<&PlaceProbabilities> {
        self.by_gain(|place| !place.is_sure())
    }

    /// Some places, those where a bank shot gains most first.
    fn by_gain(&self, wanted: impl Fn(&PlaceProbabilities) -> bool) -> Vec<&PlaceProbabilities> {
        let mut places: Vec<&PlaceProbabilities> =
            self.places.iter().filter(|place| wanted(place)).collect();
        let gain = |place: &PlaceProbabilities| place.bank_gain().map_or(1.0, |gain| gain.value);
        places.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
        places
    }
}

/// Players whose P differs by less than this are level.
const LEVEL: f64 = 0.01;

/// The players with the greatest P at each place: those who are not surely worse than the best one
/// by a shot in 100, or by twice the error of the difference.
pub(super) fn best_players(players: &[PlayerSweep]) -> Vec<Vec<usize>> {
    (0..players[0].places.len())
        .map(|place| {
            let found: Vec<(usize, Difference)> = players
                .iter()
                .enumerate()
                .filter_map(|(i, player)| Some((i, player.places[place].best()?)))
                .collect();
            let best = found.iter().map(|(_, p)| *p);
            let Some(best) = best.reduce(|a, b| if b.value > a.value { b } else { a }) else {
                return Vec::new();
            };
            let is_level = |(_, p): &&(usize, Difference)| {
                let error = libm::hypot(p.standard_error, best.standard_error);
                best.value - p.value <= LEVEL.max(2.0 * error)
            };
            found.iter().filter(is_level).map(|(i, _)| *i).collect()
        })
        .collect()
}

pub(super) fn team_csv(players: &[PlayerSweep], units: UnitSystem) -> String {
    let (unit, metre) = units.length();
    let (short, short_metre) = units.short_length();
    let quoted = |name: &str| format!("\"{}\"", name.replace('"', "\"\""));
    let mut text =
        format!("place,name,x_{unit},y_{unit},distance_{unit},court_angle_deg,best_players");
    for player in players {
        for column in [
            "direct",
            "direct error",
            "bank",
            "bank error",
            "shoot",
            "sure %",
            &format!("bank aim right of the board's middle {short}"),
            &format!("bank aim above the ring {short}"),
            "least bank gain over rings",
        ] {
            text += &format!(",{}", quoted(&format!("{} {column}", player.name)));
        }
    }
    text.push('\n');
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.5}"));
    for (place, best) in best_players(players).into_iter().enumerate() {
        let known = &players[0].places[place];
        let location = known.place.location();
        text += &format!(
            "{place},{},{:.3},{:.3},{:.3},{:.2},{}",
            known.name.as_deref().map_or(String::new(), quoted),
            known.place.x_m / metre,
            known.place.y_m / metre,
            location.distance_m / metre,
            location.angle_rad / DEGREE_RAD,
            match &best[..] {
                [] => String::new(),
                best => {
                    let names: Vec<&str> = best.iter().map(|i| players[*i].name.as_str()).collect();
                    quoted(&names.join("; "))
                }
            }
        );
        for player in players {
            let chances = &player.places[place];
            for p in [chances.direct, chances.bank] {
                text += &format!(
                    ",{},{}",
                    number(p.map(|p| p.value)),
                    number(p.map(|p| p.standard_error))
                );
            }
            text += &format!(",{}", chances.preference().map_or("", Preference::name));
            let share = chances.share_of_preferred();
            text += &share.map_or(",".to_owned(), |share| format!(",{}", whole_percent(share)));
            text += &chances
                .board_aim_m
                .map_or(",,".to_owned(), |(across_m, above_m)| {
                    format!(
                        ",{:.1},{:.1}",
                        across_m / short_metre,
                        above_m / short_metre
                    )
                });
            let least = chances.least_gain_over_rings;
            text += &format!(",{}", number(least.map(|(gain, _)| gain)));
        }
        text.push('\n');
    }
    text
}

/// A share in percent, rounded down: 90 is at least 90 %, which counts as sure.
pub(super) fn whole_percent(share: f64) -> u32 {
    (100.0 * share + 1e-9) as u32
}

/// A table of places and players is printed up to this size.
const MOST_COLUMNS: usize = 5;
/// Longest name at the top of its columns, in characters.
const LONGEST_IN_HEADER: usize = 9;
/// See [`MOST_COLUMNS`].
const MOST_ROWS: usize = 16;
/// The page has one up to this many rows.
const MOST_PAGE_ROWS: usize = 60;

/// A place in words, and `direct/bank` of each player there.
fn place_rows(players: &[PlayerSweep], units: UnitSystem) -> Vec<Vec<String>> {
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
fn place_header(players: &[PlayerSweep], longest_name: usize) -> Vec<String> {
    let names = players
        .iter()
        .map(|player| shortened(&player.name, longest_name));
    std::iter::once("from".to_owned()).chain(names).collect()
}

/// The numbers of the players by the mean of P over all places, the greatest first, with that mean.
fn by_mean(players: &[PlayerSweep]) -> Vec<(usize, f64)> {
    let mean = |player: &PlayerSweep| {
        let found = player.places.iter().filter_map(PlaceProbabilities::best);
        let found: Vec<f64> = found.map(|p| p.value).collect();
        found.iter().sum::<f64>() / found.len().max(1) as f64
    };
    let mut order: Vec<(usize, f64)> = players.iter().map(mean).enumerate().collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    order
}

/// A row for each player: name, mean, places to bank from, places where nobody is as good.
fn player_rows(players: &[PlayerSweep], best: &[Vec<usize>]) -> Vec<Vec<String>> {
    let row = |(number, mean): (usize, f64)| {
        let player = &players[number];
        let own = best.iter().filter(|of| of[..] == [number]).count();
        let (banks, unsure) = (player.bank_places().len(), player.unsure_places().len());
        let places = player.places.len();
        vec![
            shortened(&player.name, LONGEST_NAME),
            in_hundred(mean),
            match unsure {
                0 => format!("{banks} of {places} places"),
                unsure => format!("{banks} of {places}, perhaps {unsure} more"),
            },
            format!("{own} of {} places", best.len()),
        ]
    };
    by_mean(players).into_iter().map(row).collect()
}

/// The columns of [`player_rows`].
const PLAYER_COLUMNS: [&str; 4] = [
    "player",
    "mean of\nall places,\nbest kind",
    "banks at",
    "alone the\nbest at",
];

/// What is to be said of places where players are level, and of what is taken as exact.
fn remarks(
    players: &[PlayerSweep],
    best: &[Vec<usize>],
    ring: (f64, f64),
) -> (String, &'static str) {
    let level = best.iter().filter(|of| of.len() > 1).count();
    let of_level = if level > 0 {
        format!(
            "At {level} of {} places two or more are level: within 1 in 100 (team.csv names them).\n",
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
        "Not sure yet (?): the kind is the better one in fewer than 90 of 100 draws of the fit (team.csv has the share). P itself takes each profile as exact.\n"
    } else if players.iter().any(has_draws) {
        "P takes each profile as exact; team.csv has the share of the draws of the fit in which bank is better.\n"
    } else {
        "Each profile is taken as exact; `bankshot fit` says how sure a measured one is.\n"
    };
    (of_level + &of_rings(players, ring), of_profiles)
}

/// What the ring of the gym has to do with bank or direct; empty where it decides nothing.
fn of_rings(players: &[PlayerSweep], (low, high): (f64, f64)) -> String {
    let mut places = players.iter().flat_map(|player| player.bank_places());
    if !places.any(PlaceProbabilities::turns_with_the_ring) {
        return String::new();
    }
    if (low, high) != UnseenParameter::HoopRestitution.usual_range() {
        return format!(
            "By the makes the restitution of the ring is {low:.2} to {high:.2}; on some of these rings direct is better at the places that say so.\n"
        );
    }
    format!(
        "Nobody measured the ring of this gym; sources give restitutions from {low:.2} (a dead ring) to {high:.2} (a lively one). `bankshot fit SHOTS --free hoop_restitution` asks the makes about it; after that this command heeds what they say.\n"
    )
}

/// From where a player should bank, and from where that is open.
fn bank_text(player: &PlayerSweep, units: UnitSystem) -> String {
    let name = shortened(&player.name, LONGEST_NAME);
    let aim = |same: &[&PlaceProbabilities]| {
        let aim = board_aim_of_sides(same, units);
        let aim = aim.map(|aim| format!("aim at the board, {aim}"));
        let words = [aim, ring_in_words(same)];
        let words: Vec<String> = words.into_iter().flatten().collect();
        (!words.is_empty()).then(|| words.join("; "))
    };
    let share = |same: &[&PlaceProbabilities]| {
        let shares = same.iter().filter_map(|place| {
            let share = whole_percent(place.share_of_preferred()?);
            let more = match place.shots_to_be_sure() {
                Some(more) if more < MOST_SHOTS => {
                    format!(", about {} more shots would tell", two_digits(more))
                }
                _ => String::new(),
            };
            Some(format!(
                "{} is better with {share} % certainty{more}",
                place.preference()?.name()
            ))
        });
        let shares: Vec<String> = shares.collect();
        (!shares.is_empty()).then(|| shares.join("; "))
    };
    let surely = place_list(&player.bank_places(), ("  ", &aim), units);
    let perhaps = place_list(&player.unsure_places(), ("    ", &share), units);
    let mut text = match (surely.is_empty(), perhaps.is_empty()) {
        (true, true) => format!("{name}: no place where a bank shot is better by 1 in 100.\n"),
        (true, false) => format!("{name}: no place yet where a bank shot is surely better.\n"),
        (false, _) => format!("{name}: bank it from\n{surely}"),
    };
    if !perhaps.is_empty() {
        text += &format!("  not sure yet which is better:\n{perhaps}");
    }
    text
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
            least_to_most(same.iter().map(|place| place.bank)),
            least_to_most(same.iter().map(|place| place.direct)),
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
fn place_in_words(
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

/// That the direct shot is better on some ring; `None` if it is on none, from either side.
fn ring_in_words(same: &[&PlaceProbabilities]) -> Option<String> {
    let of_rings = same.iter().filter_map(|place| place.least_gain_over_rings);
    let (gain, restitution) = of_rings.reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    (gain < 0.0).then(|| {
        format!(
            "on a ring of restitution {restitution:.2} direct is better by {}",
            in_hundred(-gain)
        )
    })
}

/// P in 100 of a shot from one place, or from both sides: `80.6 to 82.2` where they differ.
fn least_to_most(of_sides: impl Iterator<Item = Option<Difference>>) -> String {
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

/// The same of all players, the surest first.
fn bank_texts(players: &[PlayerSweep], units: UnitSystem) -> Vec<String> {
    let order = by_mean(players).into_iter();
    order
        .map(|(number, _)| bank_text(&players[number], units))
        .collect()
}

/// The answer for people.
pub(super) fn team_text(players: &[PlayerSweep], ring: (f64, f64), units: UnitSystem) -> String {
    let best = best_players(players);
    let mut table = table_of(PLAYER_COLUMNS.map(str::to_owned).to_vec());
    for row in player_rows(players, &best) {
        table.add_row(row);
    }
    let (of_level, of_profiles) = remarks(players, &best, ring);
    let mut text = format!(
        "makes in 100 of each one's best shot (not of the usual one), the best player first\n{}\n{of_level}",
        table.trim_fmt()
    );
    if players.len() <= MOST_COLUMNS && best.len() <= MOST_ROWS {
        let mut table = table_of(place_header(players, LONGEST_IN_HEADER));
        for mut row in place_rows(players, units) {
            row[0] = textwrap::fill(&row[0], 20);
            table.add_row(row);
        }
        text += &format!("\nat each place: direct/bank\n{}\n", table.trim_fmt());
    }
    text += of_profiles;
    text + &bank_texts(players, units).concat()
}

/// The page: the tables, the maps and the posters.
pub(super) fn team_page(
    players: &[PlayerSweep],
    maps: Option<Plot>,
    posters: Option<String>,
    (warnings, ring): (&str, (f64, f64)),
    units: UnitSystem,
) -> TeamPage {
    let best = best_players(players);
    let (of_level, of_profiles) = remarks(players, &best, ring);
    let mut tables = vec![PageTable {
        caption:
            "Makes in 100 of each one's best shot (not of the usual one), the best player first"
                .to_owned(),
        columns: PLAYER_COLUMNS.map(|name| name.replace('\n', " ")).to_vec(),
        rows: player_rows(players, &best),
        is_printed: true,
    }];
    if best.len() <= MOST_PAGE_ROWS {
        tables.push(PageTable {
            caption: "Makes in 100 at each place: direct/bank".to_owned(),
            columns: place_header(players, LONGEST_NAME),
            rows: place_rows(players, units),
            is_printed: false,
        });
    }
    let advised = by_mean(players).into_iter();
    let advised: Vec<&(String, String)> = advised
        .filter_map(|(number, _)| players[number].advice.as_ref())
        .collect();
    let from_one_place = advised.windows(2).all(|pair| pair[0].1 == pair[1].1);
    let advice_title = match advised.first() {
        Some((_, from)) if from_one_place => {
            format!("Each player's measured shot, {from}: now, and what to change")
        }
        _ => "Each player's measured shot: now, and what to change".to_owned(),
    };
    let advice = advised.iter().map(|(text, from)| {
        // That the other kind is no better from there is no news on a page about banking.
        let lines = text.trim_end().lines();
        let lines = lines.filter(|line| !line.starts_with("Bank or direct: "));
        let text = lines.collect::<Vec<_>>().join("\n");
        match from_one_place {
            true => text,
            false => format!("{text} (From {from}.)"),
        }
    });
    let advice = advice.collect();
    TeamPage {
        advice_title,
        advice,
        answer: bank_texts(players, units).concat(),
        tables,
        maps,
        posters,
        footer: format!("{warnings}{of_level}{of_profiles}"),
    }
}
