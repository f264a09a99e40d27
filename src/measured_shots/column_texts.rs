//! Cells with their units, sides and decimal commas as plain numbers: `42°`, `13' 9"`, `L 0.9`.

use super::made_or_missed::parse_made;
use super::other_units::OTHER_UNITS;
use super::session_days::{are_dates, can_tell_sessions};
use crate::files::table_rows::is_number_with_comma;
use crate::model::league_courts::League;
use crate::model::named_places::place_named;

/// What the cells of a column, or a row of units, say beside the numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnText {
    /// The suffix of the unit.
    pub unit: Option<&'static str>,
    /// Numbers grow to the right, as the cells name the sides.
    pub is_positive_to_the_right: bool,
    /// The cells of the column; `None` where only its name is known.
    pub summary: Option<ColumnSummary>,
}

/// The cells of a column in short.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnSummary {
    /// The median of its numbers, where most cells are numbers.
    pub median: Option<f64>,
    /// Half of the numbers lie within this of the median, times 1.48: the standard deviation of
    /// normal ones.
    pub spread: f64,
    /// Cells that are not empty.
    pub filled: usize,
    /// Different ones among them.
    pub distinct: usize,
    /// Whether they can tell sessions apart.
    pub can_tell_sessions: bool,
    /// What the cells themselves say that the column is: the names of places, the words for makes
    /// and misses, dates.
    pub label_by_cells: Option<&'static str>,
    /// The first different ones.
    pub examples: Vec<String>,
}

impl ColumnSummary {
    /// That of some cells.
    pub(super) fn of<'a>(cells: impl Iterator<Item = &'a str>) -> Self {
        /// Cells that are shown.
        const EXAMPLES: usize = 3;
        let filled: Vec<&str> = cells.filter(|cell| !cell.is_empty()).collect();
        let mut numbers: Vec<f64> = filled
            .iter()
            .filter_map(|cell| cell.parse().ok())
            .filter(|number: &f64| number.is_finite())
            .collect();
        numbers.sort_by(f64::total_cmp);
        let are_numbers = 2 * numbers.len() > filled.len();
        let median = numbers.get(numbers.len() / 2).copied().unwrap_or(0.0);
        let mut apart: Vec<f64> = numbers
            .iter()
            .map(|number| (number - median).abs())
            .collect();
        apart.sort_by(f64::total_cmp);
        let label_by_cells = label_by_cells(&filled);
        let mut examples: Vec<String> = Vec::new();
        let mut seen = std::collections::HashSet::new();
        for cell in &filled {
            if seen.insert(*cell) && examples.len() < EXAMPLES {
                examples.push(cell.chars().take(20).collect());
            }
        }
        Self {
            median: are_numbers.then_some(median),
            spread: 1.4826 * apart.get(apart.len() / 2).copied().unwrap_or(0.0),
            can_tell_sessions: can_tell_sessions(&filled),
            filled: filled.len(),
            label_by_cells,
            distinct: seen.len(),
            examples,
        }
    }
}

/// The label that cells are, whatever the name of their column.
fn label_by_cells(filled: &[&str]) -> Option<&'static str> {
    let mut distinct: Vec<&str> = filled.to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    let is_number = |cell: &&str| cell.parse::<f64>().is_ok();
    if distinct.is_empty() || distinct.iter().any(is_number) {
        return None;
    }
    let results = distinct.iter().map(|cell| parse_made(cell));
    let results: Vec<Option<bool>> = results.map(|result| result.ok().flatten()).collect();
    if results.iter().all(Option::is_some)
        && results.contains(&Some(true))
        && results.contains(&Some(false))
    {
        return Some("made");
    }
    if distinct
        .iter()
        .all(|cell| place_named(cell, League::Ncaa).is_some())
    {
        return Some("place");
    }
    (can_tell_sessions(filled) && are_dates(filled)).then_some("session")
}

/// A column is taken as numbers with units where this share of its cells are.
const LEAST_SHARE: f64 = 0.8;

/// A cell as a number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct NumberText {
    number: f64,
    unit: Option<&'static str>,
    has_side: bool,
}

/// Makes numbers of the cells of a column where they are numbers with units, sides or decimal
/// commas; says what was beside them.
pub(super) fn tidy_cells(cells: &mut [&mut String]) -> ColumnText {
    let filled: Vec<usize> = (0..cells.len())
        .filter(|&index| !cells[index].is_empty())
        .collect();
    let is_plain = |cell: &str| cell.parse::<f64>().is_ok();
    if filled.iter().all(|&index| is_plain(cells[index])) {
        return ColumnText::default();
    }
    let parsed: Vec<(usize, NumberText)> = filled
        .iter()
        .filter_map(|&index| Some((index, number_text(cells[index])?)))
        .collect();
    if (parsed.len() as f64) < LEAST_SHARE * filled.len() as f64 || parsed.is_empty() {
        return ColumnText::default();
    }
    let mut units: Vec<&'static str> = parsed.iter().filter_map(|(_, text)| text.unit).collect();
    units.dedup();
    let has_one_unit = units.windows(2).all(|pair| pair[0] == pair[1]);
    if !has_one_unit {
        return ColumnText::default();
    }
    let is_positive_to_the_right = parsed.iter().any(|(_, text)| text.has_side);
    for (index, text) in parsed {
        if !is_plain(cells[index]) {
            *cells[index] = text.number.to_string();
        }
    }
    ColumnText {
        unit: units.first().copied(),
        is_positive_to_the_right,
        summary: None,
    }
}

/// The unit that a text is, such as `(m/s)`, `[deg]`, `inches` or `°`.
#[must_use]
pub(super) fn unit_named(text: &str) -> Option<&'static str> {
    let text = text.trim_matches(|c: char| c.is_whitespace() || "()[]<>.".contains(c));
    let lower = text.to_lowercase();
    let signs = [
        ("\"", "in"),
        ("″", "in"),
        ("”", "in"),
        ("''", "in"),
        ("'", "ft"),
        ("′", "ft"),
        ("’", "ft"),
    ];
    let mut all = OTHER_UNITS.into_iter().chain(signs);
    all.find(|(other, _)| *other == lower).map(|(_, unit)| unit)
}

/// A cell as a number with its unit, and its side: negative to the left.
fn number_text(cell: &str) -> Option<NumberText> {
    let (cell, side) = without_side(cell.trim());
    let end = cell
        .char_indices()
        .find(|(at, c)| {
            !(c.is_ascii_digit() || ".,".contains(*c) || (*at == 0 && "+-".contains(*c)))
        })
        .map_or(cell.len(), |(at, _)| at);
    let (digits, rest) = cell.split_at(end);
    let number: f64 = match is_number_with_comma(digits.as_bytes()) {
        true => digits.replace(',', ".").parse().ok()?,
        false => digits.parse().ok()?,
    };
    let (number, unit) = match rest.trim() {
        "" => (number, None),
        rest => match unit_named(rest) {
            Some(unit) => (number, Some(unit)),
            None => (number + inches_after_feet(rest)? / 12.0, Some("ft")),
        },
    };
    Some(NumberText {
        number: side.map_or(number, |sign| sign * number),
        unit,
        has_side: side.is_some(),
    })
}

/// The inches of `' 9"` and `ft 9 in`, what follows the feet.
fn inches_after_feet(rest: &str) -> Option<f64> {
    let digits = rest.find(|c: char| c.is_ascii_digit())?;
    let (feet, inches) = rest.split_at(digits);
    let end = inches
        .find(|c: char| !(c.is_ascii_digit() || c == '.'))
        .unwrap_or(inches.len());
    let (number, unit) = inches.split_at(end);
    let are_inches = unit.trim().is_empty() || unit_named(unit) == Some("in");
    (unit_named(feet) == Some("ft") && are_inches).then(|| number.parse().ok())?
}

/// A cell without the word for a side, and the sign of the side.
fn without_side(cell: &str) -> (&str, Option<f64>) {
    const SIDES: [(&str, f64); 4] = [("left", -1.0), ("right", 1.0), ("l", -1.0), ("r", 1.0)];
    let lower = cell.to_lowercase();
    if lower.len() != cell.len() || !lower.contains(|c: char| c.is_ascii_digit()) {
        return (cell, None);
    }
    for (word, sign) in SIDES {
        if lower.starts_with(word) {
            let rest = cell[word.len()..].trim_start_matches([':', ' ']);
            if rest.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
                return (rest, Some(sign));
            }
        }
        if lower.ends_with(word) {
            let rest = cell[..cell.len() - word.len()].trim_end();
            if rest.ends_with(|c: char| !c.is_alphabetic()) {
                return (rest, Some(sign));
            }
        }
    }
    (cell, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tidied(cells: &[&str]) -> (Vec<String>, ColumnText) {
        let mut cells: Vec<String> = cells.iter().map(|cell| (*cell).to_owned()).collect();
        let text = tidy_cells(&mut cells.iter_mut().collect::<Vec<_>>());
        (cells, text)
    }

    #[test]
    fn contract_units_and_sides_in_cells_are_read() {
        for (cells, numbers, unit, right) in [
            (
                &["42°", "41.5°", ""][..],
                &["42", "41.5", ""][..],
                Some("deg"),
                false,
            ),
            (&["9\"", "8.5\""], &["9", "8.5"], Some("in"), false),
            (
                &["13' 9\"", "15'", "13 ft 9 in"],
                &["13.75", "15", "13.75"],
                Some("ft"),
                false,
            ),
            (&["L 0.9", "R 0.4", "0"], &["-0.9", "0.4", "0"], None, true),
            (&["0.9 left", "0.4\" R"], &["-0.9", "0.4"], Some("in"), true),
            (
                &["24.1 ft/s", "23,9 ft/s"],
                &["24.1", "23.9"],
                Some("ft_s"),
                false,
            ),
            (&["42,5", "41"], &["42.5", "41"], None, false),
        ] {
            let (found, text) = tidied(cells);
            assert_eq!(found, numbers, "{cells:?}");
            assert_eq!(
                (text.unit, text.is_positive_to_the_right),
                (unit, right),
                "{cells:?}"
            );
        }
        for kept in [
            &["Ana", "Ben"][..],
            &["2025-10-14", "2025-10-15"],
            &["L", "R"],
            &["9 in", "23 cm"],
        ] {
            assert_eq!(
                tidied(kept),
                (
                    kept.iter().map(|c| (*c).to_owned()).collect(),
                    ColumnText::default()
                )
            );
        }
    }
}
