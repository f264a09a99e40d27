//! What to write as `--map` for a file whose columns have other names.

use super::columns::{Columns, Label, Quantity, in_unit};
use super::other_units::OTHER_UNITS;
use crate::fitting::CENTRE_DEPTH_M;
use crate::units::{DEGREE_RAD, INCH_M, REV_RAD};

/// Parts of the names that others give to a quantity or a label, in small letters without spaces.
/// What is named first is found first.
const OTHER_NAMES: [(&str, &[&str]); 17] = [
    (
        "release_height",
        &[
            "releaseheight",
            "releaseht",
            "heightofrelease",
            "relheight",
            "relht",
            "releasez",
            "releasein",
            "releasecm",
            "releaseft",
            "heightatrelease",
            "hrelease",
            "abwurfhöhe",
        ],
    ),
    (
        "entry_angle",
        &["entry", "incoming", "eintritt", "einfall", "entrada"],
    ),
    (
        "depth",
        &[
            "depth",
            "longshort",
            "deep",
            "shortlong",
            "tiefe",
            "profond",
            "profund",
        ],
    ),
    (
        "speed",
        &[
            "speed",
            "velocity",
            "velo",
            "v0",
            "vrelease",
            "releasev",
            "mph",
            "kmh",
            "geschwind",
            "vitesse",
        ],
    ),
    (
        "pitch",
        &[
            "pitch",
            "releaseangle",
            "launch",
            "elevation",
            "arc",
            "theta",
            "abwurfwinkel",
        ],
    ),
    ("polar", &["polar", "azimuth"]),
    (
        "aim",
        &[
            "aim",
            "direction",
            "lateral",
            "horizontalangle",
            "rightofhoop",
            "leftofhoop",
        ],
    ),
    ("backspin", &["backspin", "spinrate", "spin", "rpm"]),
    (
        "left_right",
        &[
            "leftright",
            "leftorright",
            "offline",
            "lateraloffset",
            "sideways",
            "linksrechts",
            "gauchedroite",
            "izquierda",
        ],
    ),
    ("court_angle", &["courtangle", "floorangle"]),
    (
        "distance",
        &[
            "distance",
            "dist",
            "fromhoop",
            "frombasket",
            "fromrim",
            "entfernung",
        ],
    ),
    (
        "made",
        &[
            "made", "make", "result", "outcome", "goal", "basket", "hit", "scored", "success",
            "treffer", "acierto", "réussi", "score",
        ],
    ),
    (
        "shooter",
        &[
            "shooter",
            "player",
            "athlete",
            "subject",
            "participant",
            "spieler",
            "joueur",
            "jugador",
            "giocatore",
            "schuetze",
            "schütze",
            "firstname",
            "lastname",
            "fullname",
            "pupil",
            "student",
            "schüler",
            "elev",
        ],
    ),
    (
        "session",
        &[
            "session",
            "date",
            "day",
            "timestamp",
            "visit",
            "phase",
            "condition",
            "datum",
            "fecha",
        ],
    ),
    (
        "place",
        &["spot", "zone", "location", "position", "area", "platz"],
    ),
    (
        "shot",
        &["shotid", "shotnumber", "shotno", "trial", "schuss", "wurf"],
    ),
    ("time", &["time"]),
];

/// Names that are too short to be looked for within others.
const SHORT_NAMES: [(&str, &str); 14] = [
    ("place", "where"),
    ("session", "when"),
    ("shooter", "name"),
    ("shooter", "who"),
    ("release_height", "height"),
    ("aim", "phi"),
    ("pitch", "angle"),
    ("made", "in"),
    ("left_right", "lr"),
    ("left_right", "side"),
    ("left_right", "left"),
    ("left_right", "right"),
    ("shot", "releaseid"),
    ("shot", "id"),
];

/// A column with what it may hold.
#[derive(Clone, Debug, PartialEq)]
pub struct ProposedMap {
    /// The index of the column.
    pub column: usize,
    /// The quantity or label.
    pub target: &'static str,
    /// What `--map` takes; `UNIT` stands where nothing says the unit.
    pub map: String,
    /// Whether the unit is known.
    pub is_complete: bool,
    /// Some of its cells.
    pub examples: Vec<String>,
}

/// What the columns of a file may hold, by their names and their cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposal<'a> {
    columns: &'a Columns,
    /// A map for each column that was understood.
    pub maps: Vec<ProposedMap>,
    is_tracked: bool,
    /// A column of heights that may be those of the player.
    is_short_height: bool,
    /// Quantities that are needed and that no column seems to hold.
    missing: Vec<Quantity>,
}

/// The range of the median of a column of shots, SI units, whoever shoots; `None` where any is
/// plausible.
fn usual_median(quantity: Quantity) -> Option<(f64, f64)> {
    let (low, high, size) = match quantity {
        Quantity::Speed => (4.0, 14.0, 1.0),
        Quantity::Pitch => (20.0, 80.0, DEGREE_RAD),
        Quantity::EntryAngle => (22.0, 70.0, DEGREE_RAD),
        Quantity::Aim => (-20.0, 20.0, DEGREE_RAD),
        Quantity::Polar | Quantity::CourtAngle => (-120.0, 120.0, DEGREE_RAD),
        Quantity::Depth => (-10.0, 26.0, INCH_M),
        Quantity::LeftRight => (-12.0, 12.0, INCH_M),
        Quantity::Backspin => (-1.0, 10.0, REV_RAD),
        Quantity::Distance => (1.5, 9.5, 1.0),
        Quantity::ReleaseHeight => (1.2, 3.2, 1.0),
        Quantity::Time | Quantity::X | Quantity::Y | Quantity::Z => return None,
    };
    Some((low * size, high * size))
}

/// The median depth of the shots of those who aim at the middle of the hoop, m.
const USUAL_DEPTH_M: (f64, f64) = (5.5 * INCH_M, 15.0 * INCH_M);
/// The standard deviation of the depths of a shooter's shots, m.
const USUAL_DEPTH_SPREAD_M: (f64, f64) = (1.8 * INCH_M, 11.0 * INCH_M);

/// The unit of a column: that of its name or its cells, or the only one that makes its numbers
/// plausible.
///
/// # Errors
/// The numbers are implausible in each unit: the column holds something else.
fn unit_of_column(
    columns: &Columns,
    index: usize,
    quantity: Quantity,
) -> Result<Option<&'static str>, ()> {
    let name = columns.name(index);
    let known = quantity.unit_names();
    let by_cells = columns.unit_by_cells(index);
    if by_cells.is_some_and(|unit| !known.contains(&unit)) {
        return Err(());
    }
    let stated = by_cells.or_else(|| unit_of(name, quantity));
    let Some(summary) = columns.summary(index) else {
        return Ok(stated);
    };
    let Some(median) = summary.median else {
        // A length may be written as `6 ft 11 in`.
        let is_text = summary.filled > 0 && quantity.dimension_of_texts().is_none();
        return if is_text { Err(()) } else { Ok(stated) };
    };
    let Some((low, high)) = usual_median(quantity) else {
        return Ok(stated);
    };
    let (sign, offset) = zero_of(name, quantity, stated);
    let offset_in_its_unit: f64 = offset.parse().unwrap_or(0.0);
    let is_plausible = |unit: &&'static str| {
        let size = quantity.units().iter().find(|(name, _)| name == unit);
        let offset: f64 = offset.parse().unwrap_or(0.0);
        let turned = if sign.is_empty() { median } else { -median };
        size.is_some_and(|(_, size)| (low..=high).contains(&(size * (turned + offset))))
    };
    if let Some(stated) = stated
        && is_plausible(&stated)
    {
        return Ok(Some(stated));
    }
    // A depth without a unit: where shots end and how far they scatter tells inches from
    // centimetres.
    let is_usual_depth = |unit: &&'static str| {
        let size = quantity.units().iter().find(|(name, _)| name == unit);
        let is_within = |(least, most): (f64, f64), value: f64| {
            size.is_some_and(|(_, size)| (least..=most).contains(&(size * value)))
        };
        quantity != Quantity::Depth
            || is_within(USUAL_DEPTH_SPREAD_M, summary.spread)
                && is_within(USUAL_DEPTH_M, median + offset_in_its_unit)
    };
    let plausible: Vec<&'static str> = known
        .iter()
        .copied()
        .filter(is_plausible)
        .filter(is_usual_depth)
        .collect();
    match (stated, &plausible[..]) {
        (_, []) => Err(()),
        (None, [one]) => Ok(Some(one)),
        (None, _) => Ok(None),
        // A unit of the name that the numbers contradict; degrees are only assumed.
        (Some("deg"), [one]) => Ok(Some(one)),
        (Some(_), _) => Err(()),
    }
}

/// Whether the cells of a column can be a label.
fn can_be_label(columns: &Columns, index: usize, target: &str) -> bool {
    let Some(summary) = columns.summary(index) else {
        return true;
    };
    match target {
        // Several rows for each.
        "shooter" | "place" => 2 * summary.distinct <= summary.filled,
        "session" => summary.can_tell_sessions,
        "made" => (1..=4).contains(&summary.distinct),
        _ => true,
    }
}

impl<'a> Proposal<'a> {
    /// What the columns may hold.
    #[must_use]
    pub fn of(columns: &'a Columns) -> Self {
        let unused = columns.unused();
        let is_landing = columns.quantity(Quantity::Depth).is_some()
            || unused
                .iter()
                .any(|name| target_of(name, false, &[]) == Some("depth"));
        let is_tracked = is_tracked(columns, &unused);
        let mut taken: Vec<&str> = Vec::new();
        let mut maps = Vec::new();
        let mut is_short_height = false;
        let mut unit_of_depth = columns
            .quantity(Quantity::Depth)
            .map(|column| column.unit.0);
        for index in columns.unused_indices() {
            let name = columns.name(index);
            let of_tracker = if is_tracked {
                tracked_target(name)
            } else {
                None
            };
            let target = of_tracker.filter(|target| !taken.contains(target));
            // A second time of a point is none of the session.
            if target.is_none() && of_tracker == Some("time") {
                continue;
            }
            let by_cells = columns
                .summary(index)
                .and_then(|summary| summary.label_by_cells)
                .filter(|target| !taken.contains(target));
            let by_name = || target_of(name, is_landing, &taken);
            let Some(target) = target.or(by_cells).or_else(by_name) else {
                continue;
            };
            let is_label_taken = || columns.has_label(target);
            let quantity = Quantity::ALL.into_iter().find(|q| q.name() == target);
            let is_known = match quantity {
                Some(quantity) => columns.quantity(quantity).is_some(),
                None => is_label_taken(),
            };
            if is_known {
                continue;
            }
            let (map, is_complete) = match quantity {
                None if can_be_label(columns, index, target) => (format!("{target}={name}"), true),
                None => continue,
                Some(quantity) => {
                    let Ok(unit) = unit_of_column(columns, index, quantity) else {
                        continue;
                    };
                    // One sensor has one unit for both.
                    let unit = match quantity {
                        Quantity::LeftRight => unit.or(unit_of_depth),
                        _ => unit,
                    };
                    if quantity == Quantity::Depth {
                        unit_of_depth = unit;
                    }
                    let (sign, offset) = zero_of(name, quantity, unit);
                    let map = format!("{target}={sign}{name}:{}{offset}", unit.unwrap_or("UNIT"));
                    (map, unit.is_some())
                }
            };
            taken.push(target);
            is_short_height |= target == "release_height"
                && first_word(&name.to_lowercase()) == "height"
                && !letters_of(name).contains("release");
            let summary = columns.summary(index);
            maps.push(ProposedMap {
                column: index,
                target,
                map,
                is_complete,
                examples: summary.map_or_else(Vec::new, |summary| summary.examples.clone()),
            });
        }
        let is_release = taken.contains(&"speed") && !is_landing;
        let has_side = taken.contains(&"polar") || taken.contains(&"aim");
        let needed: &[Quantity] = match () {
            () if maps.is_empty() => &[],
            () if is_tracked => &[Quantity::Time],
            () if is_landing => &[Quantity::EntryAngle, Quantity::Depth, Quantity::LeftRight],
            () if is_release && has_side => &[Quantity::Pitch],
            () if is_release => &[Quantity::Pitch, Quantity::Aim],
            () => &[],
        };
        let is_missing = |quantity: &Quantity| {
            !taken.contains(&quantity.name()) && columns.quantity(*quantity).is_none()
        };
        Self {
            columns,
            is_tracked,
            is_short_height,
            missing: needed.iter().copied().filter(is_missing).collect(),
            maps,
        }
    }

    /// The maps that are taken with `--accept`.
    ///
    /// # Errors
    /// The unit of a column is not known; what to add.
    pub fn accepted(&self) -> Result<Vec<String>, String> {
        if let Some(open) = self.maps.iter().find(|map| !map.is_complete) {
            let units = Quantity::ALL
                .into_iter()
                .find(|quantity| quantity.name() == open.target)
                .map_or_else(Vec::new, Quantity::unit_names);
            let first = units.first().copied().unwrap_or_default();
            return Err(format!(
                "--accept: nothing says the unit of {}: add --map '{}' (or {})",
                open.target,
                open.map.replace("UNIT", first),
                units[1.min(units.len())..].join(", ")
            ));
        }
        Ok(self.maps.iter().map(|map| map.map.clone()).collect())
    }

    /// Columns that may name players although their names do not say so: texts that nothing else is
    /// taken from, each for many rows. With some of the texts.
    #[must_use]
    pub fn possible_players(&self) -> Vec<(String, Vec<String>)> {
        /// Shots of a player, at least.
        const SHOTS: usize = 8;
        if self.has("shooter") || self.columns.label(Label::Shooter).is_some() || self.is_tracked {
            return Vec::new();
        }
        let unused = self.columns.unused_indices().into_iter();
        let is_open = |index: &usize| {
            let name = self.columns.name(*index);
            !self
                .maps
                .iter()
                .any(|map| map.map.ends_with(&format!("={name}")))
        };
        unused
            .filter(is_open)
            .filter_map(|index| {
                let summary = self.columns.summary(index)?;
                let are_texts = summary.median.is_none() && summary.label_by_cells.is_none();
                let is_repeated = (2..=summary.filled / SHOTS).contains(&summary.distinct);
                (are_texts && is_repeated).then(|| {
                    (
                        self.columns.name(index).to_owned(),
                        summary.examples.clone(),
                    )
                })
            })
            .collect()
    }

    fn has(&self, target: &str) -> bool {
        self.maps.iter().any(|map| map.target == target)
    }

    fn is_known(&self, quantity: Quantity) -> bool {
        self.has(quantity.name()) || self.columns.quantity(quantity).is_some()
    }

    /// In words, for a message.
    #[must_use]
    pub fn text(&self) -> String {
        let names = self.columns.names();
        let mut text = format!("\nits columns are {}", names_in_short(names));
        let all_unused = self.columns.unused().len() == names.len();
        if self.maps.is_empty() {
            if all_unused {
                text += "; name them with --map 'speed=ReleaseSpeed:mph'";
            }
            return text;
        }
        text += "\nthey may hold (the first values in brackets):";
        for map in &self.maps {
            let examples = match map.examples.is_empty() {
                true => String::new(),
                false => format!("   ({})", map.examples.join(", ")),
            };
            text += &format!("\n  --map '{}'{examples}", map.map);
        }
        for quantity in &self.missing {
            text += &format!("\n  --map '{}=COLUMN:UNIT'", quantity.name());
        }
        text += "\nif this is right, add --accept; to change a line, add it corrected beside --accept (or keep the lines in a file: --map @FILE)";
        for map in self.maps.iter().filter(|map| !map.is_complete) {
            let quantity = Quantity::ALL.into_iter().find(|q| q.name() == map.target);
            let units = quantity.map_or_else(Vec::new, Quantity::unit_names);
            text += &format!("\n  UNIT of {}: {}", map.target, units.join(", "));
        }
        text + &self.remarks()
    }

    /// What must be known beside the names.
    fn remarks(&self) -> String {
        let mut text = String::new();
        for (quantity, side, other) in [
            (Quantity::Aim, "left", "right"),
            (Quantity::Polar, "left", "right"),
            (Quantity::LeftRight, "right", "left"),
        ] {
            let name = quantity.name();
            if self.has(name) {
                text += &format!(
                    "\n  {name} is positive to the shooter's {side}: for a column that is positive to \
                     the {other}, write a minus before its name"
                );
            }
        }
        if self.is_short_height {
            text += "\n  release_height is that of the ball when it leaves the hand: leave it out if the \
                     column has the player's height";
        }
        text += "\n  without --physics, the men's college ball and hoop (ncaa) are assumed";
        if self.maps.iter().any(|map| is_metric(&map.map)) {
            text += "\n  answers are in feet and ft/s: --units metric gives metres and m/s";
        }
        if self.is_tracked {
            text += "\n  x, y and z are taken from the hoop's centre (x onto the court, y to the right of who faces the hoop, z upwards); for another origin give --frame, or --hoop such as '7.2 m,12.45 m,-y'";
        } else if !self.is_known(Quantity::Time) {
            text += &self.place_to_give();
        }
        text
    }

    /// The options that say the place, where no column does.
    fn place_to_give(&self) -> String {
        let has_place = self.has("place") || self.columns.label(Label::Place).is_some();
        let missing: Vec<&str> = [
            (Quantity::Distance, "--at 'free throw'"),
            (Quantity::ReleaseHeight, "--release-height '7 ft'"),
        ]
        .into_iter()
        .filter(|(quantity, _)| !(*quantity == Quantity::Distance && has_place))
        .filter_map(|(quantity, option)| (!self.is_known(quantity)).then_some(option))
        .collect();
        if missing.is_empty() {
            return String::new();
        }
        let mut text = format!(
            "\nand, as no column gives the place of the shots: {}",
            missing.join(" ")
        );
        if self.has("shooter") || self.columns.label(Label::Shooter).is_some() {
            text +=
                "\n  (each shooter can have a height: --release-height 'NAME=6.9 ft', repeated)";
        }
        text
    }
}

/// The names of columns, not all of them if they are many or long.
fn names_in_short(names: &[String]) -> String {
    const MOST: usize = 20;
    const LONGEST: usize = 40;
    let shown = names.iter().take(MOST).map(|name| {
        let short: String = name.chars().take(LONGEST).collect();
        match short.len() < name.len() {
            true => format!("{short}..."),
            false => short,
        }
    });
    let shown: Vec<String> = shown.collect();
    let more = match names.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    shown.join(", ") + &more
}

/// The columns of a file and what they may hold, in words.
#[must_use]
pub fn map_proposal(columns: &Columns) -> String {
    Proposal::of(columns).text()
}

/// Whether a map such as `--map 'speed=v:m/s'` has a metric unit.
fn is_metric(map: &str) -> bool {
    let unit = map.rsplit(':').next();
    let unit = unit.map(|unit| unit.split(['+', '-']).next().unwrap_or(unit));
    matches!(unit, Some("m" | "cm" | "mm" | "m/s" | "cm/s" | "km/h"))
}

/// Whether three of the columns are the coordinates of a ball.
fn is_tracked(columns: &Columns, unused: &[&str]) -> bool {
    [Quantity::X, Quantity::Y, Quantity::Z]
        .into_iter()
        .all(|axis| {
            columns.quantity(axis).is_some()
                || unused
                    .iter()
                    .any(|name| tracked_target(name) == Some(axis.name()))
        })
}

/// What a column of a tracked flight may hold: a coordinate, such as `px_m`, `Ball X (ft)`,
/// `pos_x`, or the time. The number of a frame is no time.
fn tracked_target(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    let mut words = lower.split(|c: char| !c.is_alphanumeric());
    let axis = words.find_map(|word| {
        ["x", "y", "z"].into_iter().find(|axis| {
            let rest = word.strip_prefix(axis).or_else(|| word.strip_suffix(axis));
            matches!(rest, Some("" | "b" | "p" | "pos" | "ball" | "position"))
        })
    });
    let is_time = match first_word(&lower) {
        "t" | "time" | "timestamp" | "clock" | "seconds" => true,
        "frame" => unit_of(name, Quantity::Time).is_some(),
        _ => false,
    };
    axis.or(is_time.then_some("time"))
}

/// A name in small letters, without spaces and signs.
fn letters_of(name: &str) -> String {
    let lower = name.to_lowercase();
    lower.chars().filter(|c| c.is_alphanumeric()).collect()
}

/// The sign before a column and the number after its unit, where its name says that it counts from
/// the centre of the ring, or to the left.
fn zero_of(name: &str, quantity: Quantity, unit: Option<&str>) -> (&'static str, String) {
    let letters = letters_of(name);
    match quantity {
        Quantity::Depth if letters.contains("centre") || letters.contains("center") => {
            let size = quantity
                .units()
                .iter()
                .find(|(name, _)| Some(*name) == unit);
            let offset = size.map_or_else(
                || "+9 IN ITS UNIT".to_owned(),
                |(_, size)| format!("+{}", in_unit(CENTRE_DEPTH_M, *size)),
            );
            ("", offset)
        }
        Quantity::LeftRight if is_positive_to(name, "left") => ("-", String::new()),
        Quantity::Aim | Quantity::Polar if is_positive_to(name, "right") => ("-", String::new()),
        _ => ("", String::new()),
    }
}

/// Whether a name says that its numbers grow to a side: `Left (in)`, `Side (+ = left)`.
fn is_positive_to(name: &str, side: &str) -> bool {
    let other = if side == "left" { "right" } else { "left" };
    let lower = name.to_lowercase();
    let spaceless: String = lower.chars().filter(|c| !c.is_whitespace()).collect();
    let says = |words: String| spaceless.contains(&words);
    let is_alone = first_word(&lower) == side && !lower.contains(other);
    let is_negative = says(format!("-={side}"))
        || says(format!("{side}negative"))
        || says(format!("negative={side}"));
    // `Azimuth_deg_right`, `azimuth_right_deg`
    let mut parts = lower.split('_').skip(1);
    let is_part = parts.any(|part| part == side) && !lower.contains(other);
    let is_positive = is_part
        || says(format!("+={side}"))
        || says(format!("{side}positive"))
        || says(format!("positive={side}"));
    !is_negative && (is_alone || is_positive)
}

/// The first word of a name: `left` of `Left (in)`.
fn first_word(name: &str) -> &str {
    let name = name.trim();
    &name[..name
        .find(|c: char| !c.is_alphabetic())
        .unwrap_or(name.len())]
}

/// Whether the name of a column says that it tells sessions apart.
#[must_use]
pub fn names_sessions(name: &str) -> bool {
    target_of(name, false, &[]) == Some("session")
}

/// Whether the name of a column says that it names players.
#[must_use]
pub fn names_players(name: &str) -> bool {
    target_of(name, false, &[]) == Some("shooter")
}

/// What a column may hold, if nothing else is taken as that. In a file of landings an arc is that
/// of the fall.
fn target_of(name: &str, is_landing: bool, taken: &[&str]) -> Option<&'static str> {
    let letters = letters_of(name);
    let found = OTHER_NAMES
        .iter()
        .find(|(_, parts)| parts.iter().any(|part| letters.contains(part)))
        .or_else(|| {
            // `L/R (in)` is `lr` with a unit.
            let without_unit = letters_of(name.split(['(', '[']).next().unwrap_or_default());
            // So is `height_m`.
            let is_unit = |word: &str| {
                let word = word.to_lowercase();
                let mut quantities = Quantity::ALL.into_iter();
                quantities.any(|quantity| quantity.unit_names().contains(&word.as_str()))
            };
            let before_last = match name.rsplit_once('_') {
                Some((before, last)) if is_unit(last) => before,
                _ => name,
            };
            let before_last = letters_of(before_last);
            let short = SHORT_NAMES.iter().find(|(_, short)| {
                [&letters, &without_unit, &before_last].contains(&&(*short).to_owned())
            });
            OTHER_NAMES
                .iter()
                .find(|(target, _)| short.is_some_and(|(short, _)| short == target))
        })?;
    let target = match found.0 {
        // `Angle` beside `Arc`.
        "pitch" if is_landing && letters == "angle" && taken.contains(&"entry_angle") => {
            "court_angle"
        }
        "pitch" if is_landing && (letters.starts_with("arc") || letters.starts_with("angle")) => {
            "entry_angle"
        }
        // `Side (deg)` is a direction.
        "left_right" if says_degrees(name) => "aim",
        target => target,
    };
    (!taken.contains(&target)).then_some(target)
}

/// Whether a name says that its numbers are degrees.
fn says_degrees(name: &str) -> bool {
    name.contains('°') || name.to_lowercase().contains("deg")
}

/// The unit that the name of a column ends with or has in brackets; degrees for an angle without
/// one (an angle in radians is then refused as absurd, row by row).
fn unit_of(name: &str, quantity: Quantity) -> Option<&'static str> {
    /// A unit of so many letters needs nothing that sets it apart, as in `DepthInches`.
    const LONG_UNIT: usize = 4;
    let name = name.to_lowercase();
    let name = name.trim_end_matches([')', ']', ' ', '.']);
    let known = quantity.unit_names();
    let ends_with = |unit: &str| {
        name.strip_suffix(unit).is_some_and(|rest| {
            unit.len() >= LONG_UNIT || !rest.ends_with(|c: char| c.is_alphabetic())
        })
    };
    // In brackets a unit comes first, whatever follows it: `Depth (in, + = long)`.
    let in_brackets = name.rsplit_once(['(', '[']).map(|(_, rest)| {
        let rest = rest.trim();
        // `(in mm)`
        let rest = match rest.strip_prefix("in ") {
            Some(unit) if unit.starts_with(char::is_alphabetic) => unit,
            _ => rest,
        };
        let end = rest.find([',', ';', ' ']).unwrap_or(rest.len());
        rest[..end].trim()
    });
    let found = OTHER_UNITS
        .into_iter()
        .filter(|(_, unit)| known.contains(unit))
        .find(|(other, _)| in_brackets == Some(*other) || ends_with(other))
        .map(|(_, unit)| unit);
    found.or_else(|| known.contains(&"deg").then_some("deg"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_maps_are_proposed_for_other_names() {
        let header = [
            "Player",
            "Release Speed (mph)",
            "LaunchAngle",
            "Side (deg)",
            "Result",
            "Depth",
            "note",
        ];
        let header: Vec<String> = header.map(str::to_owned).to_vec();
        let columns = Columns::new(&header, &[]).unwrap();
        let text = map_proposal(&columns);
        for map in [
            "--map 'shooter=Player'",
            "--map 'speed=Release Speed (mph):mph'",
            "--map 'pitch=LaunchAngle:deg'",
            "--map 'aim=Side (deg):deg'",
            "write a minus before its name",
            "--map 'made=Result'",
            "--map 'depth=Depth:UNIT'",
            "UNIT of depth: ft, in, m, cm, mm",
        ] {
            assert!(text.contains(map), "{text}");
        }
        assert!(!text.contains("note:"), "{text}");
        // What is proposed is understood.
        let maps = ["speed=Release Speed (mph):mph".to_owned()];
        assert!(Columns::new(&header, &maps).is_ok());
    }

    #[test]
    fn contract_maps_of_a_sensor_that_counts_from_the_centre() {
        let header = [
            "Shot No",
            "Arc (deg)",
            "Depth from rim centre (in, + = long)",
            "Left (in)",
        ];
        let header = header.map(str::to_owned);
        let text = map_proposal(&Columns::new(&header, &[]).unwrap());
        for map in [
            "--map 'entry_angle=Arc (deg):deg'",
            "--map 'depth=Depth from rim centre (in, + = long):in+9'",
            "--map 'left_right=-Left (in):in'",
        ] {
            assert!(text.contains(map), "{text}");
            let map = map.trim_start_matches("--map '").trim_end_matches('\'');
            assert!(Columns::new(&header, &[map.to_owned()]).is_ok(), "{map}");
        }
    }

    #[test]
    fn contract_maps_of_the_log_of_an_app() {
        let header = [
            "Day",
            "Player",
            "Spot",
            "Feet from hoop",
            "Floor angle",
            "Release in",
            "Ball MPH",
            "Launch angle",
            "Right of hoop deg",
            "Result",
        ];
        let header = header.map(str::to_owned);
        let text = map_proposal(&Columns::new(&header, &[]).unwrap());
        for map in [
            "session=Day",
            "shooter=Player",
            "place=Spot",
            "distance=Feet from hoop:",
            "court_angle=Floor angle:deg",
            "release_height=Release in:in",
            "speed=Ball MPH:mph",
            "pitch=Launch angle:deg",
            "aim=-Right of hoop deg:deg",
            "made=Result",
        ] {
            assert!(text.contains(&format!("--map '{map}")), "{map}: {text}");
        }
    }

    #[test]
    fn contract_maps_of_a_tracker() {
        let proposal = |header: [&str; 6]| {
            map_proposal(&Columns::new(&header.map(str::to_owned), &[]).unwrap())
        };
        let text = proposal(["trial", "frame_ms", "px_m", "py_m", "pz_m", "scored"]);
        for map in [
            "shot=trial'",
            "time=frame_ms:ms'",
            "x=px_m:m'",
            "y=py_m:m'",
            "z=pz_m:m'",
            "made=scored'",
        ] {
            assert!(text.contains(&format!("--map '{map}")), "{map}: {text}");
        }
        assert!(
            text.contains("--frame") && !text.contains("--distance"),
            "{text}"
        );
        let text = proposal(["Frame", "T (s)", "Ball X (ft)", "Ball Y (ft)", "Z", "id"]);
        for map in [
            "shot=id'",
            "time=T (s):s'",
            "y=Ball Y (ft):ft'",
            "z=Z:UNIT'",
        ] {
            assert!(text.contains(&format!("--map '{map}")), "{map}: {text}");
        }
        assert!(!text.contains("=Frame"), "{text}");
    }

    #[test]
    fn contract_units_are_read_off_names() {
        assert_eq!(unit_of("Depth (in, + = long)", Quantity::Depth), Some("in"));
        assert_eq!(unit_of("Depth (in mm)", Quantity::Depth), Some("mm"));
        assert_eq!(unit_of("Distance (in m)", Quantity::Distance), Some("m"));
        for (name, target) in [
            ("Left (in)", Some("left_right")),
            ("L/R (inches)", Some("left_right")),
            ("Side (in, - = left)", Some("left_right")),
            ("Right handed (in)", None),
            ("Depth (in; positive = long)", Some("depth")),
            ("angle (deg)", Some("entry_angle")),
        ] {
            assert_eq!(target_of(name, true, &[]), target, "{name}");
        }
        for (name, side, expected) in [
            ("Left (in)", "left", true),
            ("Side (+ = left)", "left", true),
            ("Side (in, - = left)", "left", false),
            ("Left-right (in)", "left", false),
            ("Side (deg, + = right)", "right", true),
            ("Side (deg)", "right", false),
            ("azimuth_deg_right", "right", true),
            ("azimuth_right_deg", "right", true),
            ("left_right_in", "left", false),
        ] {
            assert_eq!(is_positive_to(name, side), expected, "{name}");
        }
        assert_eq!(unit_of("speed_fps", Quantity::Speed), Some("ft_s"));
        assert_eq!(unit_of("Depth (in)", Quantity::Depth), Some("in"));
        assert_eq!(unit_of("DepthInches", Quantity::Depth), Some("in"));
        assert_eq!(unit_of("EntryAngle", Quantity::EntryAngle), Some("deg"));
        assert_eq!(unit_of("margin", Quantity::Depth), None);
        assert_eq!(unit_of("Spin", Quantity::Backspin), None);
        assert_eq!(unit_of("spin_hz", Quantity::Backspin), Some("rev_s"));
        assert_eq!(target_of("RelHt", true, &[]), Some("release_height"));
        assert_eq!(target_of("h_release", false, &[]), Some("release_height"));
        assert_eq!(target_of("v_release", false, &[]), Some("speed"));
        assert_eq!(target_of("success", false, &[]), Some("made"));
        assert_eq!(
            target_of("Angle", true, &["entry_angle"]),
            Some("court_angle")
        );
        assert_eq!(target_of("Angle", true, &[]), Some("entry_angle"));
        assert_eq!(
            target_of("rel_height_m", false, &[]),
            Some("release_height")
        );
    }
}
