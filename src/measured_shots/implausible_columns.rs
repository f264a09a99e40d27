//! Columns that hold something else than their names say: another unit, another zero, each other.
//!
//! A single absurd row is kept out. Where the middle of a whole column is absurd, the column is.

use super::columns::{Columns, Label, Quantity, Zero, in_unit};
use super::made_or_missed::parse_made;
use crate::fitting::CENTRE_DEPTH_M;
use crate::units::{DEGREE_RAD, INCH_M};

/// A quantity whose median over many shots lies between two values, SI units, whatever the shooter.
struct UsualMedian {
    quantity: Quantity,
    low: f64,
    high: f64,
    /// The range in words.
    in_words: &'static str,
}

const USUAL_MEDIANS: [UsualMedian; 3] = [
    UsualMedian {
        quantity: Quantity::Depth,
        low: -3.0 * INCH_M,
        // A shooter can be long on average; centimetres that are read as inches are 28.
        high: 20.0 * INCH_M,
        in_words: "from the front of the ring (0 in) to its back (18 in)",
    },
    UsualMedian {
        quantity: Quantity::EntryAngle,
        low: 22.0 * DEGREE_RAD,
        high: 70.0 * DEGREE_RAD,
        in_words: "from 25 to 65 deg",
    },
    UsualMedian {
        quantity: Quantity::Pitch,
        low: 15.0 * DEGREE_RAD,
        high: 85.0 * DEGREE_RAD,
        in_words: "from 25 to 80 deg",
    },
];
/// Fewer shots than this have no middle.
const LEAST_SHOTS: usize = 5;
/// A median depth nearer than this to the front of the ring is that of a shooter who makes few
/// shots.
const SHORT_DEPTH_M: f64 = 3.0 * INCH_M;
/// More makes than this fraction of the shots are more than such a shooter can have: the front of
/// the ring is 9 in from its centre, and half of the shots are shorter.
const MOST_MAKES: f64 = 0.5;
/// Shots with a result that this needs: 15 makes of 30 are seldom those of a shooter who makes a
/// third.
const LEAST_LABELLED: usize = 30;

/// What is wrong with a column as a whole, and what to write. Only quantities that the fit uses are
/// looked at.
pub(super) fn implausible_column(
    columns: &Columns,
    used: &[Quantity],
    rows: &[(u64, &[String])],
) -> Option<String> {
    let mut medians = USUAL_MEDIANS
        .iter()
        .filter(|usual| used.contains(&usual.quantity));
    let of_unit = medians.find_map(|usual| {
        let median = median_of(columns, rows, usual.quantity)?;
        let column = columns.quantity(usual.quantity)?;
        let is_usual = |value: f64| (usual.low..=usual.high).contains(&value);
        if is_usual(median) {
            return None;
        }
        let name = columns.name(column.index);
        let (unit, size) = column.unit;
        let number = median / size;
        let likely = usual
            .quantity
            .units()
            .iter()
            .find(|(other, size)| *other != unit && is_usual(number * size));
        let fix = likely.map_or_else(String::new, |(other, _)| {
            if column.zero != Zero::OWN {
                return format!(". The numbers look like {other}");
            }
            format!(
                ". The numbers look like {other}: --map '{}={name}:{other}'",
                usual.quantity.name()
            )
        });
        Some(format!(
            "{name}: the median is {number:.4} {unit}{}; shots at a hoop have it {}{fix}",
            column.zero_in_words(),
            usual.in_words
        ))
    });
    of_unit.or_else(|| {
        let is_landing = used.contains(&Quantity::Depth);
        is_landing.then(|| misplaced_depth(columns, rows)).flatten()
    })
}

/// Depths that are not counted from the front of the ring, or are in another column.
fn misplaced_depth(columns: &Columns, rows: &[(u64, &[String])]) -> Option<String> {
    let depth = median_of(columns, rows, Quantity::Depth)?;
    let left_right = median_of(columns, rows, Quantity::LeftRight)?;
    let column = columns.quantity(Quantity::Depth)?;
    let name = columns.name(column.index);
    let other = columns.name(columns.quantity(Quantity::LeftRight)?.index);
    if left_right.abs() > 5.0 * INCH_M && depth.abs() < SHORT_DEPTH_M {
        return Some(format!(
            "{name} and {other}: the medians are {:.1} and {:.1} in; the two look swapped",
            depth / INCH_M,
            left_right / INCH_M
        ));
    }
    let made = rows.iter().filter_map(|(_, cells)| {
        let cell = cells.get(columns.label(Label::Made)?)?;
        parse_made(cell).ok().flatten()
    });
    let made: Vec<bool> = made.collect();
    let makes = made.iter().filter(|made| **made).count();
    let makes_many = made.len() >= LEAST_LABELLED && makes as f64 > MOST_MAKES * made.len() as f64;
    (depth < SHORT_DEPTH_M && makes_many).then(|| {
        format!(
            "{name}: the median is {:.1} in, at the front of the ring, but {makes} of {} shots went in. Depth counts from the front \
             of the ring; if yours counts from its centre: --map 'depth={}{name}:{}{:+}'",
            depth / INCH_M,
            made.len(),
            if column.zero.sign < 0.0 { "-" } else { "" },
            column.unit.0,
            in_unit(CENTRE_DEPTH_M, column.unit.1) + column.zero.offset
        )
    })
}

/// The median of the numbers of a column, SI units.
fn median_of(columns: &Columns, rows: &[(u64, &[String])], quantity: Quantity) -> Option<f64> {
    let column = columns.quantity(quantity)?;
    let numbers = rows
        .iter()
        .filter_map(|(_, cells)| cells.get(column.index)?.parse::<f64>().ok())
        .filter(|number| number.is_finite());
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    (numbers.len() >= LEAST_SHOTS).then(|| column.value(numbers[numbers.len() / 2]))
}
