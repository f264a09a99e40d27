//! What a reader of a table of best shots must know.

use crate::best_shot::{ShotKind, ShotTable, TableKind, TableShot};
use crate::model::SolidId;
use crate::shooter::{Location, Nominal, Profile, ReleaseVariable};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// What can change the decision: at most three.
#[must_use]
pub(super) fn key_notes(table: &ShotTable, profile: &Profile, units: UnitSystem) -> Vec<String> {
    let notes = [
        steep_note(table, units),
        no_shot_note(table, profile, units),
        other_kind_note(table, units),
        limit_note(table, profile, units),
        reserve_note(table, profile, units),
        jump_note(table, units),
        unlikely_note(table, units),
    ];
    notes.into_iter().flatten().take(3).collect()
}

/// What a reader of the table must know: what interpolation costs, which nodes were added, where
/// shots are not clean, and where the other kind is better.
#[must_use]
pub fn notes(table: &ShotTable, profile: &Profile, units: UnitSystem) -> Vec<String> {
    let notes = [
        kinds_note(table, units),
        steep_note(table, units),
        range_note(table, units),
        mean_note(table),
        no_shot_note(table, profile, units),
        Some(check_note(table, units)),
        added_note(table, units),
        jump_note(table, units),
        limit_note(table, profile, units),
        reserve_note(table, profile, units),
        bounce_note(table, units),
        nearly_other_kind_note(table, units),
        unlikely_note(table, units),
        other_kind_note(table, units),
        Some("These numbers assume a typical ring, board and air; `bankshot physics PROFILE` shows how much that matters.".to_owned()),
    ];
    notes.into_iter().flatten().collect()
}

/// Whose shots these are: name, release height and the standard deviations at the first place.
#[must_use]
pub(super) fn shooter_note(table: &ShotTable, profile: &Profile, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let shooter = profile.shooter();
    let name = &shooter.name;
    let mut note = format!(
        "Shooter: {name}, release height {} {long}",
        short(shooter.release_height_m / metre)
    );
    let first = table.shots.iter().position(Option::is_some);
    if let Some((index, shot)) = first.and_then(|i| Some((i, table.shots[i].as_ref()?))) {
        let sd = |variable| shooter.dispersion.sigma(variable, &shot.nominal);
        let distance_m = table.distances_m[index % table.distances_m.len()];
        let of_speed = shooter.dispersion.c11;
        let percent = if of_speed > 0.0 {
            format!(
                " ({} % of the speed)",
                short(100.0 * sd(ReleaseVariable::Speed) / shot.nominal.speed_m_s)
            )
        } else {
            String::new()
        };
        note += &format!(
            ", scatter (at {} {long}): speed {} {long}/s{percent}, angle {} deg, direction {} deg, backspin {} rev/s",
            short(distance_m / metre),
            short(sd(ReleaseVariable::Speed) / metre),
            short(sd(ReleaseVariable::Pitch) / DEGREE_RAD),
            short(sd(ReleaseVariable::Polar) / DEGREE_RAD),
            short(sd(ReleaseVariable::Backspin) / REV_RAD),
        );
    }
    note + "."
}

/// Ball, hoop and air, so that tables for two balls can be told apart.
#[must_use]
pub fn physics_note(profile: &Profile, units: UnitSystem) -> String {
    let physics = profile.physics();
    let (unit, size) = units.short_length();
    let air = if physics.air.density_kg_m3 > 0.0 {
        format!(
            "drag coefficient {} in air of {} kg/m3",
            short(physics.air.drag_coefficient),
            short(physics.air.density_kg_m3)
        )
    } else {
        "no air".to_owned()
    };
    format!(
        "Physics: a ball of {} kg and {:.2} {unit}, restitution {:.2} on the hoop and {:.2} on the board, {air}.",
        short(physics.ball_mass_kg),
        2.0 * physics.ball_radius_m / size,
        physics.restitution_on(SolidId::Ring),
        physics.restitution_on(SolidId::Board)
    )
}

/// From where to where P is high, for the levels of [`HIGH`] that some rows of a table with one
/// angle reach and others do not.
pub(super) fn range_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    if table.angles_rad.len() > 1 {
        return None;
    }
    let (long, metre) = units.length();
    let of_levels = HIGH.iter().filter_map(|level| {
        let places = Places::of(table, |shot| shot.probability >= *level);
        let is_some = !places.is_empty() && places.count() < table.shots.len();
        let ranges = places.0.iter().map(|stretch| {
            let ends = [(stretch.first(), -1), (stretch.last(), 1)];
            let [from, to] = ends.map(|(row, step)| {
                let at_m = row.map_or(f64::NAN, |(_, d)| crossing_m(table, *d, step, *level));
                format!("{:.2}", at_m / metre)
            });
            if from == to {
                format!("at {from} {long}")
            } else {
                format!("from {from} to {to} {long}")
            }
        });
        let ranges: Vec<String> = ranges.collect();
        is_some.then(|| {
            format!(
                "{:.0} of 100 or more go in {}",
                100.0 * level,
                ranges.join(" and ")
            )
        })
    });
    // The highest level that is reached.
    let mut of_levels = of_levels;
    of_levels.next().map(|text| text + ".")
}

/// The greatest speed of a profile in brackets, with a space before it; empty without one.
pub(super) fn speed_limit_in_words(profile: &Profile, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let most = profile.search().speed_max_m_s;
    most.map_or_else(String::new, |most| {
        format!(" (up to {:.1} {long}/s)", most / metre)
    })
}

/// The mean of P over the places that were asked for: two launchers can be told apart by it.
fn mean_note(table: &ShotTable) -> Option<String> {
    let mut sum = 0.0;
    let mut places = 0;
    for (a, angle_rad) in table.angles_rad.iter().enumerate() {
        for (d, distance_m) in table.distances_m.iter().enumerate() {
            let is_added = table.added_distances_m.contains(distance_m)
                || table.added_angles_rad.contains(angle_rad);
            // At a jump a place has a row of each side: the first one counts.
            let is_second = d > 0 && table.distances_m[d - 1] == *distance_m;
            if !is_added && !is_second {
                sum += table.at(a, d).map_or(0.0, |shot| shot.probability);
                places += 1;
            }
        }
    }
    (places > 1).then(|| {
        format!(
            "Average over the {places} requested places: {:.1} per 100 (a place without a shot counts as 0).",
            100.0 * sum / f64::from(places)
        )
    })
}

/// Where no clean shot goes in, and the greatest speed, if the profile has one.
fn no_shot_note(table: &ShotTable, profile: &Profile, units: UnitSystem) -> Option<String> {
    let places = Places::where_row(table, |shot| shot.is_none());
    (!places.is_empty()).then(|| {
        format!(
            "No exact shot goes in within the limits{}: {}. (`bankshot angles PROFILE --distances ..` shows releases that go in by chance.)",
            speed_limit_in_words(profile, units),
            places.text(table, units)
        )
    })
}

/// Where the interpolated P falls to a level beyond a row that is above it, towards the row before
/// (-1) or after (1), m; at the row itself where there is none, or none with a shot.
fn crossing_m(table: &ShotTable, row: usize, step: isize, level: f64) -> f64 {
    let inside_m = table.distances_m[row];
    let Some(outside) = row
        .checked_add_signed(step)
        .filter(|i| *i < table.distances_m.len())
    else {
        return inside_m;
    };
    match (table.at(0, row), table.at(0, outside)) {
        (Some(shot), Some(other)) if other.probability < level => {
            let part = (shot.probability - level) / (shot.probability - other.probability);
            inside_m + part * (table.distances_m[outside] - inside_m)
        }
        _ => inside_m,
    }
}

/// Levels of P that are told from where to where they are reached.
const HIGH: [f64; 2] = [0.8, 0.5];

/// What interpolation costs, and by how much the interpolated P errs.
fn check_note(table: &ShotTable, units: UnitSystem) -> String {
    let (Some(costliest), Some(most_wrong)) = (table.costliest(), table.most_wrong()) else {
        return "Not checked between the rows.".to_owned();
    };
    format!(
        "Checked at {} places between the rows: interpolated shots lose at most {:.2} per 100 (at {}), and the interpolated number is off by at most {:.2} (at {}).",
        table.checks.len(),
        100.0 * costliest.loss().max(0.0),
        place_text(table, &costliest.location, units),
        100.0 * most_wrong.error().abs(),
        place_text(table, &most_wrong.location, units),
    )
}

/// The place of an angle and a distance, by their indices.
fn location(table: &ShotTable, angle: usize, distance: usize) -> Location {
    Location {
        distance_m: table.distances_m[distance],
        angle_rad: table.angles_rad[angle],
    }
}

/// Rows of a table: stretches of neighbours along the distance, each row by the indices of its
/// angle and distance.
struct Places(Vec<Vec<(usize, usize)>>);

impl Places {
    /// The rows whose shot is `wanted`.
    fn of(table: &ShotTable, mut wanted: impl FnMut(&TableShot) -> bool) -> Self {
        Self::where_row(table, |shot| shot.is_some_and(&mut wanted))
    }

    /// The rows that are `wanted`, with or without a shot.
    fn where_row(table: &ShotTable, mut wanted: impl FnMut(Option<&TableShot>) -> bool) -> Self {
        let mut stretches: Vec<Vec<(usize, usize)>> = Vec::new();
        for angle in 0..table.angles_rad.len() {
            let mut is_continued = false;
            for distance in 0..table.distances_m.len() {
                let is_wanted = wanted(table.at(angle, distance));
                match stretches.last_mut() {
                    Some(stretch) if is_wanted && is_continued => stretch.push((angle, distance)),
                    _ if is_wanted => stretches.push(vec![(angle, distance)]),
                    _ => {}
                }
                is_continued = is_wanted;
            }
        }
        Self(stretches)
    }

    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn count(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }

    fn count_text(&self) -> String {
        count_text(self.count())
    }

    /// The stretches; the longest of them if there are many.
    fn text(&self, table: &ShotTable, units: UnitSystem) -> String {
        const MOST_NAMED: usize = 8;
        let mut named: Vec<&Vec<(usize, usize)>> = self.0.iter().collect();
        named.sort_by_key(|stretch| std::cmp::Reverse(stretch.len()));
        named.truncate(MOST_NAMED);
        named.sort();
        let texts = named.into_iter().filter_map(|stretch| {
            let (first, last) = (stretch.first()?, stretch.last()?);
            let [from, to] = [first, last].map(|(a, d)| location(table, *a, *d));
            let text = place_text(table, &to, units);
            // A jump has two rows of one distance.
            let is_one_place = from.distance_m == to.distance_m;
            let from = short(from.distance_m / units.length().1);
            Some(if is_one_place {
                text
            } else {
                format!("{from} to {text}")
            })
        });
        let named = texts.collect::<Vec<_>>().join("; ");
        match self.0.len().saturating_sub(MOST_NAMED) {
            0 => named,
            1 => named + " and one shorter stretch",
            more => format!("{named} and {more} shorter stretches"),
        }
    }
}

fn count_text(rows: usize) -> String {
    match rows {
        1 => "one row".to_owned(),
        rows => format!("{rows} rows"),
    }
}

/// A place; without its angle where the table has one alone.
fn place_text(table: &ShotTable, place: &Location, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let distance = short(place.distance_m / metre);
    if table.angles_rad.len() == 1 {
        format!("{distance} {long}")
    } else {
        format!(
            "{distance} {long}, {} deg",
            short(place.angle_rad / DEGREE_RAD)
        )
    }
}

/// At most four decimals, without zeros at the end.
fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Which distances and angles were added to those that were asked for.
fn added_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let (long, metre) = units.length();
    let list = |values: &[f64], unit: f64, name: &str| {
        let texts: Vec<String> = values.iter().map(|value| short(value / unit)).collect();
        (!texts.is_empty()).then(|| format!("{} {name}", texts.join(", ")))
    };
    let parts = [
        list(&table.added_distances_m, metre, long),
        list(&table.added_angles_rad, DEGREE_RAD, "deg"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty())
        .then(|| format!("Rows added for the interpolation: {}.", parts.join(" and ")))
}

/// Where the best shot jumps.
fn jump_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let (long, metre) = units.length();
    let jumps: Vec<String> = table
        .jumps_m()
        .map(|jump_m| format!("{:.2}", jump_m / metre))
        .collect();
    let what = match table.kind {
        TableKind::One(_) => "The best shot jumps",
        TableKind::Better => "The better kind changes, or the best shot jumps,",
    };
    (!jumps.is_empty()).then(|| {
        format!(
            "{what} at {} {long}: the first of the two rows applies below it, the second from it on.{}",
            jumps.join(", "),
            match table.kind {
                // Where P is nearly the same over a range of angles.
                TableKind::One(_) => " A narrower range of angles (pitch_min, pitch_max, or --pitch) avoids the jump; `bankshot angles` shows what that costs.",
                TableKind::Better => "",
            }
        )
    })
}

/// In a draft: neighbouring rows that are too far apart to interpolate between.
fn steep_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    /// A change of pitch from row to row after which the shot halfway may miss, rad.
    const STEEP_RAD: f64 = 5.0 * DEGREE_RAD;
    const MOST_NAMED: usize = 6;
    if !table.checks.is_empty() {
        return None;
    }
    let (long, metre) = units.length();
    let mut steep: Vec<String> = Vec::new();
    for angle in 0..table.angles_rad.len() {
        for distance in 1..table.distances_m.len() {
            let (Some(before), Some(after)) =
                (table.at(angle, distance - 1), table.at(angle, distance))
            else {
                continue;
            };
            let by_rad = after.nominal.pitch_rad - before.nominal.pitch_rad;
            if before.kind == after.kind && by_rad.abs() > STEEP_RAD {
                let angle_deg = table.angles_rad[angle] / DEGREE_RAD;
                let at = match table.angles_rad.len() {
                    1 => String::new(),
                    _ => format!(" at {} deg", short(angle_deg)),
                };
                steep.push(format!(
                    "{} to {} {long}{at} ({:+.1} deg)",
                    short(table.distances_m[distance - 1] / metre),
                    short(table.distances_m[distance] / metre),
                    by_rad / DEGREE_RAD
                ));
            }
        }
    }
    let more = steep.len().saturating_sub(MOST_NAMED);
    steep.truncate(MOST_NAMED);
    if more > 0 {
        steep.push(format!("{more} more"));
    }
    (!steep.is_empty()).then(|| {
        format!(
            "Do not interpolate from {}: the angle changes so much that a shot between may miss. Without --draft the table finds the jump.",
            steep.join(", from ")
        )
    })
}

/// From where to where each kind is the better one.
fn kinds_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    if table.kind != TableKind::Better {
        return None;
    }
    let (long, metre) = units.length();
    let mut stretches: Vec<(ShotKind, f64, f64)> = Vec::new();
    for (distance_m, shot) in table.distances_m.iter().zip(&table.shots) {
        let Some(shot) = shot else { continue };
        match stretches.last_mut() {
            Some((kind, _, to_m)) if *kind == shot.kind => *to_m = *distance_m,
            _ => stretches.push((shot.kind, *distance_m, *distance_m)),
        }
    }
    let texts: Vec<String> = stretches
        .iter()
        .map(|(kind, from_m, to_m)| {
            let [from, to] = [from_m, to_m].map(|m| short(m / metre));
            if from == to {
                format!("{} at {from} {long}", kind.name())
            } else {
                format!("{} from {from} to {to} {long}", kind.name())
            }
        })
        .collect();
    // The borders are only tried as far as interpolation needs them.
    (!texts.is_empty()).then(|| format!("Better kind, about: {}.", texts.join(", ")))
}

/// Where the pitch angle is a limit of the launcher.
fn limit_note(table: &ShotTable, profile: &Profile, units: UnitSystem) -> Option<String> {
    let search = &profile.settings().search;
    let limits = [
        ("pitch_min", search.pitch_min_rad),
        ("pitch_max", search.pitch_max_rad),
    ];
    let texts = limits.into_iter().filter_map(|(key, limit_rad)| {
        let limit_rad = limit_rad?;
        let places = Places::of(table, |shot| {
            (shot.nominal.pitch_rad - limit_rad).abs() < 1e-9
        });
        (!places.is_empty()).then(|| {
            format!(
                "In {} the angle is at its limit {key} ({} deg): {}.",
                places.count_text(),
                short(limit_rad / DEGREE_RAD),
                places.text(table, units)
            )
        })
    });
    let mut texts: Vec<String> = texts.collect();
    if let Some(limit_m_s) = search.speed_max_m_s {
        let places = Places::of(table, |shot| shot.nominal.speed_m_s > limit_m_s - 1e-9);
        let (long, metre) = units.length();
        if !places.is_empty() {
            texts.push(format!(
                "In {} the speed is at its limit speed_max ({} {long}/s): {}. The scatter reaches beyond the limit, so a motor that cannot turn faster makes fewer there.",
                places.count_text(),
                short(limit_m_s / metre),
                places.text(table, units)
            ));
        }
    }
    (!texts.is_empty()).then(|| texts.join(" "))
}

/// Whether a shot is so fast that speed_max of the profile is less than one standard deviation
/// away.
pub(super) fn has_no_reserve(profile: &Profile, nominal: &Nominal) -> bool {
    let sd = profile
        .shooter()
        .dispersion
        .sigma(ReleaseVariable::Speed, nominal);
    let most = profile.search().speed_max_m_s;
    most.is_some_and(|most| nominal.speed_m_s > most - sd)
}

/// At which rows no speed is left to correct them in the gym.
fn reserve_note(table: &ShotTable, profile: &Profile, units: UnitSystem) -> Option<String> {
    let places = Places::of(table, |shot| has_no_reserve(profile, &shot.nominal));
    (!places.is_empty()).then(|| {
        format!(
            "In {} the speed is within one standard deviation of speed_max: {}. It cannot be set much higher in the gym.",
            places.count_text(),
            places.text(table, units)
        )
    })
}

/// How many shots touch more than they should.
fn bounce_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let bouncing = Places::of(table, |shot| !table.is_clean(shot));
    let touches = match table.kind {
        TableKind::One(ShotKind::Direct) => "touches ring or board",
        TableKind::One(ShotKind::Bank) => "touches the ring after the board",
        TableKind::Better => "touches the ring (or, a direct one, the board)",
    };
    (!bouncing.is_empty()).then(|| {
        format!(
            "In {} of {} even an exact shot {touches} first: {}.",
            bouncing.count(),
            count_text(table.shots.len()),
            bouncing.text(table, units)
        )
    })
}

/// Share of the makes above which a shot is also one of the other kind.
const MANY_OF_OTHER_KIND: f64 = 0.25;

/// Where many of the makes are those of the other kind.
fn nearly_other_kind_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let mut most = 0.0_f64;
    let places = Places::of(table, |shot| {
        let share = match shot.kind {
            ShotKind::Direct => shot.banked,
            ShotKind::Bank => 1.0 - shot.banked,
        };
        let is_many = share > MANY_OF_OTHER_KIND;
        if is_many {
            most = most.max(share);
        }
        is_many
    });
    let (touch, exact) = match table.kind {
        TableKind::One(ShotKind::Direct) => ("touch the board first", "direct"),
        TableKind::One(ShotKind::Bank) => ("do not touch the board first", "a bank shot"),
        TableKind::Better => ("are of the other kind", "of this kind"),
    };
    (!places.is_empty()).then(|| {
        format!(
            "Between bank and direct: {}. Up to {:.0} % of the makes there {touch}, though the exact shot is {exact}.",
            places.text(table, units),
            100.0 * most
        )
    })
}

/// Where even the best shot seldom goes in.
fn unlikely_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let places = Places::of(table, |shot| shot.probability < UNLIKELY);
    (!places.is_empty()).then(|| {
        format!(
            "In {} fewer than {:.0} of 100 go in: {}.",
            places.count_text(),
            100.0 * UNLIKELY,
            places.text(table, units)
        )
    })
}

/// P below which a shot is luck.
const UNLIKELY: f64 = 0.1;

/// Where the best shot of the other kind has the higher P.
fn other_kind_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let TableKind::One(kind) = table.kind else {
        return None;
    };
    let other = kind.other().name();
    let gain = |shot: &TableShot| shot.other_kind.map_or(0.0, |p| p - shot.probability);
    let places = Places::of(table, |shot| gain(shot) > LEAST_GAIN);
    let gains = places.0.iter().flatten().filter_map(|(angle, distance)| {
        let shot = table.at(*angle, *distance)?;
        Some((gain(shot), location(table, *angle, *distance)))
    });
    let (gain, place) = gains.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let most = format!(
        "most at {} ({:+.1} per 100)",
        place_text(table, &place, units),
        100.0 * gain
    );
    if places.count() == table.shots.len() {
        return Some(format!("The {other} shot is better everywhere, {most}."));
    }
    Some(format!(
        "The {other} shot is better in {}, {most}: {}.",
        places.count_text(),
        places.text(table, units),
    ))
}

/// Least gain in P for which the other kind is named.
const LEAST_GAIN: f64 = 0.005;

/// Which shots a table has.
#[must_use]
pub(super) fn what_shots(kind: TableKind) -> String {
    match kind {
        TableKind::One(kind) => format!("Best {} shots", kind.name()),
        TableKind::Better => "Best shots, direct or bank, whichever makes more".to_owned(),
    }
}
