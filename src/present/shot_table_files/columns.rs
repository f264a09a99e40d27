//! The columns and the rows of a table of best shots.

use crate::best_shot::{ShotTable, TableKind, TableShot};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// A column: its name with its unit, its decimals for people, and its value.
pub(super) type TableColumn = (String, usize, fn(&TableShot) -> f64, f64);

pub(super) fn columns(kind: TableKind, units: UnitSystem) -> Vec<TableColumn> {
    let (long, metre) = units.length();
    let (short, short_m) = units.short_length();
    let in_unit = |name: &str, unit: &str| {
        if unit.is_empty() {
            name.to_owned()
        } else {
            format!("{name}_{unit}")
        }
    };
    let speed = format!("{long}_s");
    let other_kind = match kind {
        TableKind::One(kind) => kind.other().name(),
        TableKind::Better => "other_kind",
    };
    vec![
        (in_unit("speed", &speed), 2, |s| s.nominal.speed_m_s, metre),
        (
            in_unit("pitch", "deg"),
            1,
            |s| s.nominal.pitch_rad,
            DEGREE_RAD,
        ),
        (in_unit("aim", "deg"), 2, |s| s.aim_rad, DEGREE_RAD),
        (
            in_unit("backspin", "rev_s"),
            2,
            |s| s.nominal.backspin_rad_s,
            REV_RAD,
        ),
        (
            in_unit("time", "s"),
            2,
            |s| s.time_s.unwrap_or(f64::NAN),
            1.0,
        ),
        (
            in_unit("entry", "deg"),
            1,
            |s| s.entry_rad.unwrap_or(f64::NAN),
            DEGREE_RAD,
        ),
        (in_unit("probability", ""), 3, |s| s.probability, 1.0),
        (in_unit("standard_error", ""), 4, |s| s.standard_error, 1.0),
        (
            in_unit("speed_tolerance_below", &speed),
            2,
            |s| s.tolerances[0][0],
            metre,
        ),
        (
            in_unit("speed_tolerance_above", &speed),
            2,
            |s| s.tolerances[0][1],
            metre,
        ),
        (
            in_unit("pitch_tolerance_below", "deg"),
            1,
            |s| s.tolerances[1][0],
            DEGREE_RAD,
        ),
        (
            in_unit("pitch_tolerance_above", "deg"),
            1,
            |s| s.tolerances[1][1],
            DEGREE_RAD,
        ),
        (
            in_unit(&format!("{other_kind}_probability"), ""),
            3,
            |s| s.other_kind.unwrap_or(f64::NAN),
            1.0,
        ),
        (in_unit("makes_off_board_first", ""), 2, |s| s.banked, 1.0),
        (
            in_unit("board_aim_across", short),
            1,
            |s| s.board_aim_m.map_or(f64::NAN, |aim| aim.0),
            short_m,
        ),
        (
            in_unit("board_aim_above_hoop", short),
            1,
            |s| s.board_aim_m.map_or(f64::NAN, |aim| aim.1),
            short_m,
        ),
    ]
}

/// A node.
pub(super) struct TableNode<'a> {
    /// In units of the results.
    pub(super) distance: f64,
    /// Court angle, deg.
    pub(super) angle: f64,
    pub(super) is_added: bool,
    pub(super) shot: Option<&'a TableShot>,
}

/// The nodes, angle by angle.
pub(super) fn nodes(table: &ShotTable, units: UnitSystem) -> impl Iterator<Item = TableNode<'_>> {
    let metre = units.length().1;
    (0..table.angles_rad.len()).flat_map(move |a| {
        (0..table.distances_m.len()).map(move |d| TableNode {
            distance: without_rounding(table.distances_m[d] / metre),
            angle: without_rounding(table.angles_rad[a] / DEGREE_RAD),
            is_added: table.added_distances_m.contains(&table.distances_m[d])
                || table.added_angles_rad.contains(&table.angles_rad[a]),
            shot: table.at(a, d),
        })
    })
}

/// A value that was converted to SI units and back, without what that cost in the last digits.
fn without_rounding(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}
