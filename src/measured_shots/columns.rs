//! The columns of a file of measured shots: what they mean, and their units.
//!
//! A column is `QUANTITY_UNIT`, such as `speed_ft_s`; columns of other names are named with
//! `--map`, which can also turn a sign round and move the zero.

use super::column_texts::{ColumnSummary, ColumnText, unit_named};
use super::other_units::OTHER_UNITS;
use super::table::Table;
use crate::units::{DEGREE_RAD, Dimension, FOOT_M, INCH_M, REV_RAD};

/// A unit: its suffix and its size in SI units.
type Unit = (&'static str, f64);

const SPEED_UNITS: &[Unit] = &[
    ("ft_s", FOOT_M),
    ("m_s", 1.0),
    ("mph", 0.447_04),
    ("km_h", 1.0 / 3.6),
];
const ANGLE_UNITS: &[Unit] = &[("deg", DEGREE_RAD), ("rad", 1.0)];
const SPIN_UNITS: &[Unit] = &[("rev_s", REV_RAD), ("rpm", REV_RAD / 60.0), ("rad_s", 1.0)];
const LENGTH_UNITS: &[Unit] = &[
    ("ft", FOOT_M),
    ("in", INCH_M),
    ("m", 1.0),
    ("cm", 0.01),
    ("mm", 0.001),
];
const TIME_UNITS: &[Unit] = &[("s", 1.0), ("ms", 0.001)];

/// A quantity of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Speed of the release.
    Speed,
    /// Its angle above the horizontal.
    Pitch,
    /// Its direction on the floor, from the court's long axis.
    Polar,
    /// Its direction from the line to the hoop's centre.
    Aim,
    /// Backspin.
    Backspin,
    /// Distance of the place from the hoop's centre.
    Distance,
    /// Angle of the place on the court.
    CourtAngle,
    /// Height of the release above the floor.
    ReleaseHeight,
    /// Angle below the horizontal at the height of the hoop.
    EntryAngle,
    /// Depth from the front of the ring at the height of the hoop.
    Depth,
    /// To the right of the shot's own line there.
    LeftRight,
    /// Time of a tracked point.
    Time,
    /// Its coordinates.
    X,
    /// See `X`.
    Y,
    /// Height above the floor.
    Z,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Speed,
        Self::Pitch,
        Self::Polar,
        Self::Aim,
        Self::Backspin,
        Self::Distance,
        Self::CourtAngle,
        Self::ReleaseHeight,
        Self::EntryAngle,
        Self::Depth,
        Self::LeftRight,
        Self::Time,
        Self::X,
        Self::Y,
        Self::Z,
    ];

    /// The name of its column without the unit.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Speed => "speed",
            Self::Pitch => "pitch",
            Self::Polar => "polar",
            Self::Aim => "aim",
            Self::Backspin => "backspin",
            Self::Distance => "distance",
            Self::CourtAngle => "court_angle",
            Self::ReleaseHeight => "release_height",
            Self::EntryAngle => "entry_angle",
            Self::Depth => "depth",
            Self::LeftRight => "left_right",
            Self::Time => "time",
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }

    /// The suffixes of its units.
    #[must_use]
    pub fn unit_names(self) -> Vec<&'static str> {
        self.units().iter().map(|(name, _)| *name).collect()
    }

    /// The dimension of texts with units of their own, such as `6 ft 11 in`: of lengths alone.
    pub(super) fn dimension_of_texts(self) -> Option<Dimension> {
        (self.units() == LENGTH_UNITS).then_some(Dimension::Length)
    }

    /// Its units.
    pub(super) fn units(self) -> &'static [Unit] {
        match self {
            Self::Speed => SPEED_UNITS,
            Self::Pitch | Self::Polar | Self::Aim | Self::CourtAngle | Self::EntryAngle => {
                ANGLE_UNITS
            }
            Self::Backspin => SPIN_UNITS,
            Self::Time => TIME_UNITS,
            _ => LENGTH_UNITS,
        }
    }
}

/// A text of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Label {
    /// Whether the shot went in.
    Made,
    /// How many shots a row counts.
    Attempts,
    /// How many of them went in.
    Makes,
    /// Who shot.
    Shooter,
    /// When.
    Session,
    /// The name of the place.
    Place,
    /// Which shot a tracked point belongs to.
    Shot,
}

/// The labels with their names in a file.
pub const LABELS: [(&str, Label); 7] = [
    ("made", Label::Made),
    ("attempts", Label::Attempts),
    ("makes", Label::Makes),
    ("shooter", Label::Shooter),
    ("session", Label::Session),
    ("place", Label::Place),
    ("shot", Label::Shot),
];

/// The target of a map that leaves a column out.
pub const UNUSED: &str = "unused";

/// A column with its meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantityColumn {
    /// Index in the file.
    pub index: usize,
    /// Suffix of its unit, and its size in SI units.
    pub unit: Unit,
    /// What the quantity is in terms of the column's numbers.
    pub zero: Zero,
}

/// The sign and the zero of a column: the quantity is `sign * number + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// 1 or -1.
    pub sign: f64,
    /// In the column's unit.
    pub offset: f64,
}

impl Zero {
    /// Those of a column that holds the quantity itself.
    pub const OWN: Self = Self {
        sign: 1.0,
        offset: 0.0,
    };
}

/// A value in a unit, with four decimals at most.
pub(super) fn in_unit(value: f64, size: f64) -> f64 {
    (1e4 * value / size).round() / 1e4
}

impl QuantityColumn {
    /// What `--map` says of the sign and the number added, in words; empty where it says nothing.
    #[must_use]
    pub fn zero_in_words(&self) -> String {
        let mut words = Vec::new();
        if self.zero.sign < 0.0 {
            words.push("its sign is turned".to_owned());
        }
        if self.zero.offset != 0.0 {
            words.push(format!("{} is added", self.zero.offset));
        }
        if words.is_empty() {
            String::new()
        } else {
            format!(" (--map: {})", words.join(" and "))
        }
    }

    /// The quantity in SI units.
    #[must_use]
    pub fn value(&self, number: f64) -> f64 {
        (self.zero.sign * number + self.zero.offset) * self.unit.1
    }
}

/// The known columns of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    quantities: Vec<(Quantity, QuantityColumn)>,
    labels: Vec<(Label, usize)>,
    /// Columns that a map leaves out.
    left_out: Vec<usize>,
    /// The names of the columns, as in the file.
    names: Vec<String>,
    /// What the cells say of each column; empty where only names are known.
    texts: Vec<ColumnText>,
}

/// What a mapped or file column is taken as.
enum Meaning {
    Quantity(Quantity, Unit),
    Label(Label),
}

/// The unit that is written as its suffix or as others write it: `m_s`, `m/s`, `inches`.
fn known_as_written(given: &str, units: &[Unit]) -> Option<Unit> {
    let known = |suffix: &str| units.iter().find(|(name, _)| *name == suffix).copied();
    let other = || {
        let lower = given.to_lowercase();
        let found = OTHER_UNITS.iter().find(|(other, _)| *other == lower)?;
        known(found.1)
    };
    known(given)
        .or_else(|| known(&given.replace('/', "_")))
        .or_else(other)
}

/// The meaning of a name: a label, or a quantity with or without its unit.
fn meaning(name: &str, unit: Option<&str>) -> Result<Option<Meaning>, String> {
    if let Some((_, label)) = LABELS.iter().find(|(label, _)| *label == name) {
        return Ok(Some(Meaning::Label(*label)));
    }
    for quantity in Quantity::ALL {
        let Some(rest) = name.strip_prefix(quantity.name()) else {
            continue;
        };
        let own = rest.strip_prefix('_');
        if !rest.is_empty() && own.is_none() {
            continue;
        }
        let units = quantity.units();
        let known = |suffix: &str| units.iter().find(|(name, _)| *name == suffix).copied();
        // `x` is no prefix of a longer name.
        let own = match own {
            Some(suffix) => match known(suffix) {
                Some(unit) => Some(unit),
                None => continue,
            },
            None => None,
        };
        let chosen = match (unit, own) {
            (Some(given), _) => known_as_written(given, units).ok_or_else(|| {
                format!(
                    "{}: {given} is not one of its units ({})",
                    quantity.name(),
                    quantity.unit_names().join(", ")
                )
            })?,
            (None, Some(own)) => own,
            (None, None) => return Ok(None),
        };
        return Ok(Some(Meaning::Quantity(quantity, chosen)));
    }
    Ok(None)
}

impl Columns {
    /// The columns of a header. `maps` are of the form `speed_ft_s=ReleaseSpeed:mph`: the quantity,
    /// the name of the column, and its unit where that is not the suffix of the quantity. A minus
    /// before the name turns the sign round, a number after the unit is added:
    /// `depth=PastCentre:in+9`. `unused=COLUMN` leaves a column out.
    ///
    /// # Errors
    /// A map that cannot be followed, or a quantity given twice.
    pub fn new(header: &[String], maps: &[String]) -> Result<Self, Vec<String>> {
        Self::with_texts(header, &[], maps)
    }

    /// The columns of a table, whose cells may say the units.
    ///
    /// # Errors
    /// As [`Columns::new`].
    pub fn of_table(table: &Table, maps: &[String]) -> Result<Self, Vec<String>> {
        Self::with_texts(&table.header, &table.texts, maps)
    }

    fn with_texts(
        header: &[String],
        texts: &[ColumnText],
        maps: &[String],
    ) -> Result<Self, Vec<String>> {
        let mut columns = Self {
            names: header.to_vec(),
            texts: texts.to_vec(),
            ..Self::default()
        };
        let mut errors = Vec::new();
        let mut is_mapped = vec![false; header.len()];
        for map in maps {
            if let Err(error) = columns.add_map(map, header, &mut is_mapped) {
                errors.push(format!("--map '{map}': {error}"));
            }
        }
        for (index, name) in header.iter().enumerate() {
            if is_mapped[index] {
                continue;
            }
            match columns.meaning_of_name(name, index) {
                Ok(Some(meaning)) => {
                    if let Err(error) = columns.add(meaning, index, Zero::OWN) {
                        errors.push(error);
                    }
                }
                Ok(None) => {}
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() {
            Ok(columns)
        } else {
            Err(errors)
        }
    }

    /// What a column is by its own name: `speed_ft_s`, `Speed (ft/s)`, or `speed` with a unit in
    /// its cells.
    fn meaning_of_name(&self, name: &str, index: usize) -> Result<Option<Meaning>, String> {
        if let Some(found) = meaning(name.trim(), None)? {
            return Ok(Some(found));
        }
        let lower = name.trim().to_lowercase();
        let (base, bracket) = match lower.split_once(['(', '[']) {
            Some((base, unit)) => (base.trim(), Some(unit)),
            None => (lower.as_str(), None),
        };
        let base = base.replace([' ', '-', '/'], "_");
        if LABELS.iter().any(|(label, _)| *label == base) {
            return meaning(&base, None);
        }
        if !Quantity::ALL.iter().any(|quantity| quantity.name() == base) {
            return Ok(None);
        }
        let unit = bracket.and_then(unit_named).or(self.unit_by_cells(index));
        // A unit that the quantity does not have is that of something else.
        Ok(unit.and_then(|unit| meaning(&base, Some(unit)).ok().flatten()))
    }

    /// The unit that the cells of a column have, or a row of units says.
    #[must_use]
    pub(super) fn unit_by_cells(&self, index: usize) -> Option<&'static str> {
        self.texts.get(index)?.unit
    }

    /// The cells of a column in short.
    #[must_use]
    pub(super) fn summary(&self, index: usize) -> Option<&ColumnSummary> {
        self.texts.get(index)?.summary.as_ref()
    }

    fn add_map(
        &mut self,
        map: &str,
        header: &[String],
        is_mapped: &mut [bool],
    ) -> Result<(), String> {
        let (target, source) = map.split_once('=').ok_or(
            "must be QUANTITY=COLUMN, QUANTITY=COLUMN:UNIT or QUANTITY=-COLUMN:UNIT+NUMBER",
        )?;
        let find = |name: &str| {
            header
                .iter()
                .position(|column| column.trim() == name.trim())
        };
        let mut zero = Zero::OWN;
        // A column's own name may have a colon, a plus or a minus.
        let (index, unit) = match find(source) {
            Some(index) => (index, None),
            None => {
                let (name, mut unit) = source.rsplit_once(':').unwrap_or((source, ""));
                if let Some(at) = unit.find(['+', '-']) {
                    let number = unit[at..].trim();
                    let is_plausible = |offset: &f64| offset.is_finite() && offset.abs() < 1e9;
                    zero.offset = number.parse().ok().filter(is_plausible).ok_or_else(|| {
                        format!("{number} is not a number to add, such as +9 or -9")
                    })?;
                    unit = &unit[..at];
                }
                let turned = name
                    .trim()
                    .strip_prefix('-')
                    .filter(|_| find(name).is_none());
                if turned.is_some() {
                    zero.sign = -1.0;
                }
                let name = turned.unwrap_or(name);
                let index = find(name).ok_or_else(|| {
                    format!(
                        "there is no column {}; the file has {}",
                        name.trim(),
                        header.join(", ")
                    )
                })?;
                let unit = unit.trim();
                (index, Some(unit).filter(|unit| !unit.is_empty()))
            }
        };
        if target.trim() == UNUSED {
            is_mapped[index] = true;
            self.left_out.push(index);
            return Ok(());
        }
        let unit = unit.or_else(|| {
            let quantity = Quantity::ALL
                .into_iter()
                .find(|q| q.name() == target.trim())?;
            let own = self.unit_by_cells(index)?;
            quantity.unit_names().contains(&own).then_some(own)
        });
        let meaning = meaning(target.trim(), unit)?.ok_or_else(|| {
            let target = target.trim();
            let quantity = Quantity::ALL.into_iter().find(|q| q.name() == target);
            if let Some(quantity) = quantity {
                let names = quantity.unit_names();
                let sign = if zero.sign < 0.0 { "-" } else { "" };
                let added = if zero.offset == 0.0 {
                    String::new()
                } else {
                    format!("{:+}", zero.offset)
                };
                return format!(
                    "give its unit: '{target}={sign}{}:{}{added}' (or {})",
                    header[index].trim(),
                    names[0],
                    names[1..].join(", ")
                );
            }
            let mut names: Vec<&str> = Quantity::ALL.iter().map(|q| q.name()).collect();
            names.extend(LABELS.iter().map(|(name, _)| *name));
            format!(
                "{target} is not a quantity; the quantities are {}",
                names.join(", ")
            )
        })?;
        is_mapped[index] = true;
        self.add(meaning, index, zero)
    }

    fn add(&mut self, meaning: Meaning, index: usize, zero: Zero) -> Result<(), String> {
        match meaning {
            Meaning::Label(_) if zero != Zero::OWN => {
                return Err("a text has no sign and no number to add".to_owned());
            }
            Meaning::Label(label) => self.labels.push((label, index)),
            Meaning::Quantity(quantity, unit) => {
                let is_right = self
                    .texts
                    .get(index)
                    .is_some_and(|text| text.is_positive_to_the_right);
                let zero = match quantity {
                    Quantity::Aim | Quantity::Polar if is_right && zero == Zero::OWN => {
                        Zero { sign: -1.0, ..zero }
                    }
                    _ => zero,
                };
                if let Some(other) = self.quantity(quantity) {
                    return Err(format!(
                        "columns {} and {} both give the {}; keep one",
                        self.names[other.index],
                        self.names[index],
                        quantity.name()
                    ));
                }
                self.quantities
                    .push((quantity, QuantityColumn { index, unit, zero }));
            }
        }
        Ok(())
    }

    /// The column of a quantity.
    #[must_use]
    pub fn quantity(&self, quantity: Quantity) -> Option<QuantityColumn> {
        let found = self.quantities.iter().find(|(q, _)| *q == quantity);
        found.map(|(_, column)| *column)
    }

    /// The column of a label.
    #[must_use]
    pub fn label(&self, label: Label) -> Option<usize> {
        let found = self.labels.iter().find(|(l, _)| *l == label);
        found.map(|(_, index)| *index)
    }

    /// Whether there is a column of the label of this name.
    pub(super) fn has_label(&self, name: &str) -> bool {
        let mut labels = LABELS.iter().filter(|(known, _)| *known == name);
        labels.any(|(_, label)| self.label(*label).is_some())
    }

    /// The names of all columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The name of a column.
    #[must_use]
    pub fn name(&self, index: usize) -> &str {
        &self.names[index]
    }

    /// The columns that nothing is taken from.
    #[must_use]
    pub fn unused(&self) -> Vec<&str> {
        let unused = self.unused_indices().into_iter();
        unused.map(|index| self.names[index].as_str()).collect()
    }

    /// See [`Columns::unused`].
    pub(super) fn unused_indices(&self) -> Vec<usize> {
        let is_used = |index: usize| {
            self.quantities
                .iter()
                .any(|(_, column)| column.index == index)
                || self.labels.iter().any(|(_, label)| *label == index)
        };
        (0..self.names.len())
            .filter(|&index| !is_used(index) && !self.left_out.contains(&index))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured_shots::made_or_missed::parse_made;

    fn header(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn contract_a_map_leaves_a_column_out() {
        let names = header(&["depth_in", "entry_angle_deg"]);
        let columns = Columns::new(&names, &["unused=depth_in".to_owned()]).unwrap();
        assert_eq!(columns.quantity(Quantity::Depth), None);
        assert!(columns.quantity(Quantity::EntryAngle).is_some());
        assert!(columns.unused().is_empty(), "it is not proposed again");
        assert!(Columns::new(&names, &["unused=none".to_owned()]).is_err());
    }

    #[test]
    fn contract_columns_have_units_and_maps() {
        let names = header(&[
            "Player",
            "ReleaseSpeed",
            "pitch_deg",
            "time",
            "x_ft",
            "made",
            "note",
        ]);
        let maps = [
            "speed_ft_s=ReleaseSpeed:mph".to_owned(),
            "shooter=Player".to_owned(),
        ];
        let columns = Columns::new(&names, &maps).unwrap();
        let speed = columns.quantity(Quantity::Speed).unwrap();
        assert_eq!((speed.index, speed.unit.1), (1, 0.447_04));
        assert_eq!(columns.quantity(Quantity::Pitch).unwrap().index, 2);
        assert_eq!(columns.quantity(Quantity::X).unwrap().unit.0, "ft");
        assert_eq!(columns.label(Label::Shooter), Some(0));
        // A quantity without its unit is not taken.
        assert_eq!(columns.unused(), ["time", "note"]);
    }

    #[test]
    fn contract_a_map_turns_the_sign_and_moves_the_zero() {
        let names = header(&["Past Centre", "-odd", "Left"]);
        let maps = [
            "depth=Past Centre:in+9",
            "left_right_in=-Left",
            "aim=-odd:deg",
        ];
        let columns = Columns::new(&names, &maps.map(str::to_owned)).unwrap();
        let value = |quantity, number| columns.quantity(quantity).unwrap().value(number);
        assert_eq!(value(Quantity::Depth, 2.0), 11.0 * INCH_M);
        assert_eq!(value(Quantity::LeftRight, 2.0), -2.0 * INCH_M);
        // The column's own name has the minus.
        assert_eq!(value(Quantity::Aim, 2.0), 2.0 * DEGREE_RAD);
        let from_the_back = Columns::new(&names, &["depth=-Left:cm+45.72".to_owned()]).unwrap();
        let depth = from_the_back.quantity(Quantity::Depth).unwrap();
        assert!((depth.value(10.0) - 0.3572).abs() < 1e-12);
    }

    #[test]
    fn contract_faulty_maps_and_doubled_columns_are_refused() {
        let names = header(&["a", "speed_ft_s", "speed_m_s"]);
        let refused = |maps: &[&str], part: &str| {
            let maps: Vec<String> = maps.iter().map(|map| (*map).to_owned()).collect();
            let errors = Columns::new(&names, &maps).unwrap_err().join("\n");
            assert!(errors.contains(part), "{errors}");
        };
        refused(&[], "both give the speed");
        refused(&["pitch=a"], "give its unit: 'pitch=a:deg'");
        refused(&["pitch=-a:+9"], "give its unit: 'pitch=-a:deg+9'");
        refused(&["loft=a"], "loft is not a quantity");
        refused(&["pitch_deg=b"], "there is no column b");
        for map in [
            "speed=a:m/s",
            "speed=a:km/h",
            "pitch=a:degrees",
            "backspin=a:rev/s",
        ] {
            assert!(
                Columns::new(&header(&["a"]), &[map.to_owned()]).is_ok(),
                "{map}"
            );
        }
        refused(&["pitch_deg=a:mph"], "not one of its units (deg, rad)");
        refused(&["pitch_deg"], "must be QUANTITY=COLUMN");
        refused(&["pitch=a:deg+x"], "+x is not a number to add");
        refused(&["made=-a"], "a text has no sign");
        assert_eq!(parse_made("Missed"), Ok(Some(false)));
        assert_eq!(parse_made(" "), Ok(None));
        assert!(parse_made("2").is_err());
    }
}
