//! The columns and the rows of a table of best shots.

use crate::best_shot::{NotCleanShot, ShotTable, TableKind, TableShot};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, Dimension, UnitSystem};

/// A column of shots.
pub(super) struct TableColumn {
    /// Its name with its unit.
    pub(super) name: String,
    /// Its decimals for people.
    pub(super) decimals: usize,
    /// The size of its unit in SI units.
    pub(super) size: f64,
    value: fn(&TableShot) -> f64,
    /// The value of the most probable shot where no clean one goes in.
    not_clean: fn(&NotCleanShot, &Profile) -> Option<f64>,
}

impl TableColumn {
    /// The value of a shot in its unit; NaN where it has none.
    pub(super) fn of(&self, shot: &TableShot) -> f64 {
        (self.value)(shot) / self.size
    }

    /// The same of a shot that is not clean.
    pub(super) fn of_not_clean(&self, shot: &NotCleanShot, profile: &Profile) -> Option<f64> {
        Some((self.not_clean)(shot, profile)? / self.size)
    }
}

pub(super) fn columns(kind: TableKind, units: UnitSystem) -> Vec<TableColumn> {
    use Dimension::{Angle, Number, Speed, Spin, Time};
    let column = |name: &str, dimension, decimals, value| {
        let unit = units.unit(dimension);
        TableColumn {
            name: match unit.suffix {
                "" => name.to_owned(),
                suffix => format!("{name}_{suffix}"),
            },
            decimals,
            size: unit.size,
            value,
            not_clean: |_, _| None,
        }
    };
    let short = |name: &str, value| {
        let (suffix, size) = units.short_length();
        TableColumn {
            name: format!("{name}_{suffix}"),
            size,
            ..column(name, Dimension::Number, 1, value)
        }
    };
    let other_kind = match kind {
        TableKind::One(kind) => kind.other().name(),
        TableKind::Better => "other_kind",
    };
    let other_kind = format!("{other_kind}_probability");
    vec![
        TableColumn {
            not_clean: |shot, _| Some(shot.nominal.speed_m_s),
            ..column("speed", Speed, 2, |s| s.nominal.speed_m_s)
        },
        column("pitch", Angle, 1, |s| s.nominal.pitch_rad),
        TableColumn {
            not_clean: |shot, profile| Some(shot.nominal.polar_rad - profile.location().angle_rad),
            ..column("aim", Angle, 2, |s| s.aim_rad)
        },
        TableColumn {
            not_clean: |shot, _| Some(shot.nominal.backspin_rad_s),
            ..column("backspin", Spin, 2, |s| s.nominal.backspin_rad_s)
        },
        column("time", Time, 2, |s| s.time_s.unwrap_or(f64::NAN)),
        column("entry", Angle, 1, |s| s.entry_rad.unwrap_or(f64::NAN)),
        TableColumn {
            not_clean: |shot, _| Some(shot.probability),
            ..column("probability", Number, 3, |s| s.probability)
        },
        column("standard_error", Number, 4, |s| s.standard_error),
        column("speed_tolerance_below", Speed, 2, |s| s.tolerances[0][0]),
        column("speed_tolerance_above", Speed, 2, |s| s.tolerances[0][1]),
        column("pitch_tolerance_below", Angle, 1, |s| s.tolerances[1][0]),
        column("pitch_tolerance_above", Angle, 1, |s| s.tolerances[1][1]),
        column(&other_kind, Number, 3, |s| s.other_kind.unwrap_or(f64::NAN)),
        column("makes_off_board_first", Number, 2, |s| s.banked),
        short("board_aim_across", |s| {
            s.board_aim_m.map_or(f64::NAN, |aim| aim.0)
        }),
        short("board_aim_above_hoop", |s| {
            s.board_aim_m.map_or(f64::NAN, |aim| aim.1)
        }),
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
