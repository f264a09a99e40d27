//! What a file leaves open, and a wrong guess would answer silently: who shot, from where, when,
//! and what a blank result means.

use super::column_map_proposal::names_players;
use super::columns::{Columns, Label, Quantity};
use super::made_or_missed::parse_made;
use super::session_days::{
    DateOrder, Days, SHOTS_OF_SESSION, can_tell_sessions, day_in_words, days,
};
use super::source::Source;
use super::table::Table;
use crate::model::league_courts::League;
use crate::model::named_places::place_named;

/// Values that a message names.
const MOST_NAMED: usize = 6;

/// What the user says about what the file leaves open.
#[derive(Clone, Debug, Default)]
pub struct Decisions {
    /// The order of day and month.
    pub dates: Option<DateOrder>,
    /// The value of a make; all other rows are misses.
    pub made: Option<String>,
    /// Whether one distance was given for all rows.
    pub has_one_distance: bool,
}

/// The text of a cell.
fn cell(cells: &[String], index: usize) -> &str {
    cells.get(index).map_or("", |cell| cell.trim())
}

/// The different values of a column, without blanks, in the order of the file.
fn values(table: &Table, index: usize) -> Vec<&str> {
    let mut seen = std::collections::HashSet::new();
    let cells = table.rows.iter().map(|(_, cells)| cell(cells, index));
    cells
        .filter(|cell| !cell.is_empty() && seen.insert(*cell))
        .collect()
}

fn listed(values: &[&str]) -> String {
    let shown = values.iter().take(MOST_NAMED);
    let shown: Vec<String> = shown
        .map(|value| value.chars().take(40).collect())
        .collect();
    let more = if values.len() > MOST_NAMED {
        " ..."
    } else {
        ""
    };
    shown.join(", ") + more
}

/// Decides what can be decided, in the table, and says in which order the sessions are.
///
/// # Errors
/// What must be said first, and how.
pub fn decide(
    table: &mut Table,
    columns: &Columns,
    source: Source,
    decisions: &Decisions,
) -> Result<Option<String>, String> {
    refuse_players_as_one(table, columns)?;
    if source == Source::Trajectories {
        return Ok(None);
    }
    refuse_places_as_one(table, columns, decisions)?;
    if columns.label(Label::Attempts).is_none() {
        decide_blanks(table, columns, decisions)?;
    }
    match columns.label(Label::Session) {
        Some(index) => sessions_by_day(table, (index, columns.name(index)), decisions),
        None => Ok(None),
    }
}

/// Refuses a column of several players that nobody named as such.
fn refuse_players_as_one(table: &Table, columns: &Columns) -> Result<(), String> {
    if columns.label(Label::Shooter).is_some() {
        return Ok(());
    }
    for name in columns
        .unused()
        .into_iter()
        .filter(|name| names_players(name))
    {
        let index = columns.names().iter().position(|column| column == name);
        let players = index.map_or_else(Vec::new, |index| values(table, index));
        // A text that is another one in each row is no player.
        if (2..=table.rows.len() / 2).contains(&players.len()) {
            return Err(format!(
                "column {name} has {} players ({}): add --map 'shooter={name}' to fit each of them. (If all are one player, leave the column out of the file.)",
                players.len(),
                listed(&players)
            ));
        }
    }
    Ok(())
}

/// Refuses one distance for several places.
fn refuse_places_as_one(
    table: &Table,
    columns: &Columns,
    decisions: &Decisions,
) -> Result<(), String> {
    if !decisions.has_one_distance || columns.quantity(Quantity::Distance).is_some() {
        return Ok(());
    }
    let named = columns.label(Label::Place).map(|index| columns.name(index));
    for name in named.into_iter().chain(columns.unused()) {
        let Some(index) = columns.names().iter().position(|column| column == name) else {
            continue;
        };
        let places = values(table, index);
        let are_places = 2 * places.iter().filter(|place| is_place(place)).count() >= places.len();
        let is_taken = Some(name) == named;
        if places.len() >= 2 && (are_places || is_taken) && 2 * places.len() <= table.rows.len() {
            return Err(format!(
                "column {name} has {} places ({}), and one --distance or --at is not that of all: {}",
                places.len(),
                listed(&places),
                match are_places {
                    true if is_taken => "leave it out, so that the names say the places".to_owned(),
                    true => format!("leave it out and add --map 'place={name}', so that the names say the places"),
                    false => "keep the rows of one place in a file of their own, or add columns distance_ft and court_angle_deg".to_owned(),
                }
            ));
        }
    }
    Ok(())
}

/// Whether a text names a place on the court.
fn is_place(text: &str) -> bool {
    const WORDS: [&str; 14] = [
        "throw", "elbow", "wing", "corner", "block", "baseline", "key", "arc", "paint", "layup",
        "post", "3pt", "three", "midrange",
    ];
    if place_named(text, League::Ncaa).is_some() {
        return true;
    }
    let text = text.to_lowercase();
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    words.any(|word| WORDS.iter().any(|known| word.starts_with(known)) || word == "ft")
}

/// Refuses results of one kind with blanks between them, which may be the other kind or unknown.
fn decide_blanks(
    table: &mut Table,
    columns: &Columns,
    decisions: &Decisions,
) -> Result<(), String> {
    let Some(index) = columns.label(Label::Made) else {
        return match &decisions.made {
            Some(value) => Err(format!(
                "has no column made for --made {value}; name it with --map 'made=COLUMN'"
            )),
            None => Ok(()),
        };
    };
    let name = columns.name(index);
    if let Some(made) = &decisions.made {
        if !values(table, index).contains(&made.trim()) {
            return Err(format!(
                "column {name} has no {made} (--made); it has {}",
                listed(&values(table, index))
            ));
        }
        for (_, cells) in &mut table.rows {
            if let Some(cell) = cells.get_mut(index) {
                *cell = u8::from(cell.trim() == made.trim()).to_string();
            }
        }
        return Ok(());
    }
    let blanks = table
        .rows
        .iter()
        .filter(|(_, cells)| cell(cells, index).is_empty())
        .count();
    let known = values(table, index);
    let are_known = |made: bool| {
        let mut read = known.iter().filter_map(|value| parse_made(value).ok());
        read.any(|result| result == Some(made))
    };
    // Where both results are known, an odd cell costs its own row.
    let is_odd = known.iter().any(|value| parse_made(value).is_err());
    if is_odd && !(are_known(true) && are_known(false)) {
        let and_blanks = match blanks {
            0 => String::new(),
            rows => format!(" and blanks ({rows} rows)"),
        };
        return Err(format!(
            "column {name} has {}{and_blanks}: which of them is a make? Add --made VALUE, with one of these; all other rows are then misses",
            listed(&known)
        ));
    }
    let [only] = known[..] else {
        return Ok(());
    };
    if blanks == 0 || parse_made(only).is_err() {
        return Ok(());
    }
    Err(format!(
        "column {name} has only \"{only}\" ({} rows) and blanks ({blanks} rows): add --made '{only}' if the blanks are the other result and {only} is a make; write NA where the result is not known",
        table.rows.len() - blanks
    ))
}

/// Makes days of the dates of a column of sessions, and puts the rows into the order of time.
fn sessions_by_day(
    table: &mut Table,
    (index, name): (usize, &str),
    decisions: &Decisions,
) -> Result<Option<String>, String> {
    let cells: Vec<&str> = table
        .rows
        .iter()
        .map(|(_, cells)| cell(cells, index))
        .collect();
    let found = days(&cells, decisions.dates);
    if let Days::Ambiguous(first) = &found {
        return Err(format!(
            "column {name}: in dates such as {first} day and month may change places: add --dates dmy (the day first) or --dates mdy"
        ));
    }
    let mut order = None;
    if let Days::Moments(moments, has_times) = found {
        for ((_, cells), moment) in table.rows.iter_mut().zip(&moments) {
            if let (Some(cell), Some(moment)) = (cells.get_mut(index), moment) {
                *cell = day_in_words(moment);
            }
        }
        let earlier = |a: &(i64, u32, u32, f64), b: &(i64, u32, u32, f64)| {
            (a.0, a.1, a.2)
                .cmp(&(b.0, b.1, b.2))
                .then(a.3.total_cmp(&b.3))
        };
        let known: Vec<_> = moments.iter().flatten().collect();
        let falls = known
            .windows(2)
            .all(|pair| earlier(pair[0], pair[1]).is_ge());
        let is_newest_first =
            falls && known.len() > 1 && earlier(known[0], known[known.len() - 1]).is_gt();
        if is_newest_first {
            // Within a day too, so that what drifts is not turned round.
            table.rows.reverse();
        } else if known.len() == moments.len() {
            let mut rows: Vec<_> = std::mem::take(&mut table.rows)
                .into_iter()
                .zip(moments.iter().flatten())
                .collect();
            rows.sort_by(|a, b| {
                if has_times {
                    earlier(a.1, b.1)
                } else {
                    (a.1.0, a.1.1, a.1.2).cmp(&(b.1.0, b.1.1, b.1.2))
                }
            });
            table.rows = rows.into_iter().map(|(row, _)| row).collect();
        }
        let first = known
            .iter()
            .min_by(|a, b| earlier(a, b))
            .map(|m| day_in_words(m));
        let last = known
            .iter()
            .max_by(|a, b| earlier(a, b))
            .map(|m| day_in_words(m));
        if let (Some(first), Some(last)) = (first, last)
            && first != last
        {
            let turned = if is_newest_first {
                "; the file has the newest first"
            } else {
                ""
            };
            order = Some(format!(
                "sessions are days in the order of time, from {first} to {last}{turned}"
            ));
        }
    }
    let sessions = values(table, index);
    let rows = table
        .rows
        .iter()
        .filter(|(_, cells)| !cell(cells, index).is_empty())
        .count();
    if sessions.len() > 1 && SHOTS_OF_SESSION * sessions.len() > rows {
        return Err(format!(
            "column {name} has {} values in {rows} rows: a session needs {SHOTS_OF_SESSION} shots or more; take a column of days, or none",
            sessions.len()
        ));
    }
    Ok(order)
}

/// A day as sessions are named in the table, or the name itself.
#[must_use]
pub fn session_name(name: &str, dates: Option<DateOrder>) -> String {
    match days(&[name.trim()], dates) {
        Days::Moments(moments, _) => match &moments[..] {
            [Some(moment)] => day_in_words(moment),
            _ => name.to_owned(),
        },
        _ => name.to_owned(),
    }
}

/// Whether a column that nothing was taken from can tell sessions apart: several values with enough
/// rows for each.
#[must_use]
pub fn can_be_sessions(table: &Table, index: usize) -> bool {
    let cells: Vec<&str> = table
        .rows
        .iter()
        .map(|(_, cells)| cell(cells, index))
        .collect();
    can_tell_sessions(&cells)
}
