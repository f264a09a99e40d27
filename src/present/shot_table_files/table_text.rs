//! A table of best shots in text.

use super::by_pitch::{or_dash, tolerance};
use super::notes::{
    key_notes, notes, physics_note, range_note, shooter_note, speed_limit_in_words,
};
use crate::best_shot::{ShotTable, TableKind, TableShot};
use crate::dynamics::OutcomeKind;
use crate::present::layout::{Side, TextAnswer, TextTable, paragraphs};
use crate::present::words::{of_100, per_100, physics_name};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem, rounded};

/// The table for people.
#[must_use]
pub fn table_text(table: &ShotTable, profile: &Profile, units: UnitSystem) -> TextAnswer {
    let text = TableText {
        table,
        profile,
        units,
    };
    text.answer()
}

struct TableText<'a> {
    table: &'a ShotTable,
    profile: &'a Profile,
    units: UnitSystem,
}

/// A column of shots: name, unit, side and cell.
type Column<'a> = (
    &'static str,
    String,
    Side,
    Box<dyn Fn(&TableShot) -> String + 'a>,
);

impl TableText<'_> {
    fn answer(&self) -> TextAnswer {
        let (table, profile, units) = (self.table, self.profile, self.units);
        let draft = match table.checks.is_empty() && table.shots.len() > 1 {
            true => " (Draft: not checked between rows.)",
            false => "",
        };
        let reach = range_note(table, units).unwrap_or_else(|| self.extremes());
        let mut details = vec![
            shooter_note(table, profile, units),
            physics_note(profile, units),
            "tolerance: how far below or above its value speed or angle can be before an exact shot misses."
                .to_owned(),
            "time, entry: when and at which angle the ball comes down through rim height, ignoring the ring (-: it meets the ring on its way up)."
                .to_owned(),
        ];
        details.extend(notes(table, profile, units));
        let mut last = Vec::new();
        if !(table.added_distances_m.is_empty() && table.added_angles_rad.is_empty()) {
            last.push("+: added row.");
        }
        last.push("-o FILE.csv, .java, .hpp or .py has all columns.");
        let mut notes = key_notes(table, profile, units);
        notes.push(last.join(" "));
        TextAnswer {
            answer: vec![format!("{reach}{draft}")],
            subject: self.subject(),
            table: Some(self.rows()),
            notes,
            details: paragraphs(&details),
            ..TextAnswer::default()
        }
    }

    fn shots(&self) -> impl Iterator<Item = &TableShot> {
        self.table.shots.iter().flatten()
    }

    /// The most and the fewest makes.
    fn extremes(&self) -> String {
        let makes = || self.shots().map(|shot| shot.probability);
        let (least, most) = (makes().fold(1.0, f64::min), makes().fold(0.0, f64::max));
        match self.shots().count() {
            0 => "No shot goes in.".to_owned(),
            1 => format!("{} of 100 go in.", of_100(most)),
            _ => format!("{} to {} of 100 go in.", of_100(least), of_100(most)),
        }
    }

    /// The one value of all shots, as it is printed.
    fn same(&self, text: impl Fn(&TableShot) -> String) -> Option<String> {
        let mut texts = self.shots().map(text);
        let first = texts.next()?;
        texts.all(|text| text == first).then_some(first)
    }

    /// What is the same in each row.
    fn fixed(&self) -> [Option<String>; 3] {
        [
            self.same(pitch_text)
                .map(|text| format!("angle {text} deg")),
            self.same(spin_text)
                .map(|text| format!("spin {text} rev/s")),
            self.same(aim_text)
                .map(|text| format!("direction {text} deg")),
        ]
    }

    fn subject(&self) -> String {
        let name = &self.profile.shooter().name;
        let mut parts: Vec<String> = Vec::new();
        if let TableKind::One(kind) = self.table.kind {
            parts.push(format!("{} shots", kind.name()));
        }
        // A table of one row has no column that is worth leaving out.
        if self.shots().count() > 1 {
            parts.extend(self.fixed().into_iter().flatten());
        }
        let parts = match (name.as_str(), &parts[..]) {
            ("", parts) => parts.join(", "),
            (name, []) => name.to_owned(),
            (name, parts) => format!("{name}: {}", parts.join(", ")),
        };
        format!("{parts}. Physics: {}.", physics_name(self.profile))
    }

    /// The columns of shots; those whose value is the same in each row stand in the subject.
    fn columns(&self) -> Vec<Column<'_>> {
        let (long, metre) = self.units.length();
        let speed_unit = format!("{long}/s");
        let has_one = self.shots().count() <= 1;
        let [angle, spin, direction] = self.fixed().map(|fixed| fixed.is_none() || has_one);
        let mut columns: Vec<Column<'_>> = Vec::new();
        let mut add = |name, unit: &str, side, cell: Box<dyn Fn(&TableShot) -> String>| {
            columns.push((name, unit.to_owned(), side, cell));
        };
        if self.table.kind == TableKind::Better {
            add(
                "kind",
                "",
                Side::Left,
                Box::new(|s| s.kind.name().to_owned()),
            );
        }
        let speed = move |s: &TableShot| format!("{:.2}", s.nominal.speed_m_s / metre);
        add("speed", &speed_unit, Side::Right, Box::new(speed));
        let of_speed = move |s: &TableShot| tolerance(s.tolerances[0].map(|side| side / metre), 2);
        add("tolerance", &speed_unit, Side::Right, Box::new(of_speed));
        if angle {
            add("angle", "deg", Side::Right, Box::new(pitch_text));
        }
        if direction {
            add("direction", "deg left", Side::Right, Box::new(aim_text));
        }
        if spin {
            add("spin", "rev/s", Side::Right, Box::new(spin_text));
        }
        add("time", "s", Side::Right, Box::new(|s| or_dash(s.time_s, 2)));
        let entry = |s: &TableShot| or_dash(s.entry_rad.map(|rad| rad / DEGREE_RAD), 1);
        add("entry", "deg", Side::Right, Box::new(entry));
        add(
            "makes",
            "per 100",
            Side::Right,
            Box::new(|s| per_100(s.probability)),
        );
        add(
            "error-free",
            "shot",
            Side::Left,
            Box::new(|s| error_free(s.outcome).to_owned()),
        );
        columns
    }

    fn rows(&self) -> TextTable {
        let (long, metre) = self.units.length();
        let table = self.table;
        let has_angles = table.angles_rad.len() > 1;
        let columns = self.columns();
        let mut heads = vec![("from", long, Side::Right)];
        if has_angles {
            heads.push(("court", "deg", Side::Right));
        }
        let of_shots = columns.iter();
        heads.extend(of_shots.map(|(name, unit, side, _)| (*name, unit.as_str(), *side)));
        let mut text = TextTable::new(&heads);
        for (a, angle_rad) in table.angles_rad.iter().enumerate() {
            for (d, distance_m) in table.distances_m.iter().enumerate() {
                let is_added = table.added_distances_m.contains(distance_m)
                    || table.added_angles_rad.contains(angle_rad);
                let plus = if is_added { "+" } else { "" };
                let mut cells = vec![format!("{plus}{:.2}", rounded(distance_m / metre))];
                if has_angles {
                    cells.push(format!("{:.1}", rounded(angle_rad / DEGREE_RAD)));
                }
                match table.at(a, d) {
                    Some(shot) => cells.extend(columns.iter().map(|(.., cell)| cell(shot))),
                    None => {
                        let count = columns.len() - 1;
                        cells.extend(std::iter::repeat_n("-".to_owned(), count));
                        let limit = speed_limit_in_words(self.profile, self.units);
                        cells.push(format!("none{limit}"));
                    }
                }
                text.add(cells);
            }
        }
        text
    }
}

fn pitch_text(shot: &TableShot) -> String {
    format!("{:.1}", shot.nominal.pitch_rad / DEGREE_RAD)
}

fn spin_text(shot: &TableShot) -> String {
    format!("{:.1}", shot.nominal.backspin_rad_s / REV_RAD + 0.0)
}

fn aim_text(shot: &TableShot) -> String {
    let text = format!("{:.2}", shot.aim_rad / DEGREE_RAD);
    match text.as_str() {
        "-0.00" => "0.00".to_owned(),
        _ => text,
    }
}

/// How the shot without errors goes in.
fn error_free(outcome: OutcomeKind) -> &'static str {
    match outcome {
        OutcomeKind::Swish => "swish",
        OutcomeKind::RimIn => "rim, in",
        OutcomeKind::BankIn => "board, in",
        OutcomeKind::BankRimIn => "board, rim, in",
        other => other.name(),
    }
}
