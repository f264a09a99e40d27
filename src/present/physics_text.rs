//! How much an answer depends on the physics, in text.

use super::fit_files::change_in_words::changes_in_words;
use super::layout::{Side, TextAnswer, TextTable};
use super::words::{
    difference_interval, difference_per_100, list, of_100, per_100, simulation_error, subject,
    with_commas,
};
use crate::answers::physics::{FAR_MAKES, FittedRows, PhysicsAnswer};
use crate::best_shot::{
    BestShot, ChangeOfP, NoShot, PhysicsChange, PhysicsComparison, PhysicsOf, PhysicsRow, SameShot,
    together,
};
use crate::fitting::{Interval, Measured};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, FOOT_M, UnitSystem, with_decimals};

/// A bank shot that makes so much less than the direct one is named too.
const NEAR: f64 = 0.05;

/// What a physics is, or what it changes.
#[must_use]
pub fn physics_name(of: PhysicsOf, units: UnitSystem) -> String {
    match of {
        PhysicsOf::Profile => "the profile's".to_owned(),
        PhysicsOf::Given => "as given".to_owned(),
        PhysicsOf::Preset(name) => name.to_owned(),
        PhysicsOf::Changed(change) => change_name(change, units),
        PhysicsOf::ChangedNcaa(change) => format!("ncaa, {}", change_name(change, units)),
    }
}

fn change_name(change: PhysicsChange, units: UnitSystem) -> String {
    let length = |by_m: f64| match units {
        UnitSystem::Imperial => format!("{:.1} ft", by_m.abs() / FOOT_M),
        UnitSystem::Metric => format!("{:.0} cm", 100.0 * by_m.abs()),
    };
    match change {
        PhysicsChange::NoAir => "no air".to_owned(),
        PhysicsChange::Altitude => match units {
            UnitSystem::Imperial => "air at 5280 ft".to_owned(),
            UnitSystem::Metric => "air at 1609 m".to_owned(),
        },
        PhysicsChange::Drag(drag) => format!("drag {drag:.2}"),
        PhysicsChange::Lift(slope) => format!("lift slope {slope}"),
        PhysicsChange::ThinRing => "a ring of wire".to_owned(),
        PhysicsChange::NoBracket => "no bracket".to_owned(),
        PhysicsChange::RingRestitution(of) => format!("ring restitution {of:.2}"),
        PhysicsChange::RingStiffness(times) if times < 1.0 => "ring half as stiff".to_owned(),
        PhysicsChange::RingStiffness(_) => "ring twice as stiff".to_owned(),
        PhysicsChange::BoardRestitution(of) => format!("board restitution {of:.2}"),
        PhysicsChange::ReleaseHeight(by_m) if by_m < 0.0 => {
            format!("release {} lower", length(by_m))
        }
        PhysicsChange::ReleaseHeight(by_m) => format!("release {} higher", length(by_m)),
        PhysicsChange::Friction(friction) => format!("friction {friction}"),
    }
}

/// What a row changes; for another row its name.
fn row_change(row: &PhysicsRow, units: UnitSystem) -> String {
    match row.of.change() {
        Some(change) => change_name(change, units),
        None => physics_name(row.of, units),
    }
}

/// A change as far as the gym may have it: `56 % of the way to drag 0.54`.
fn possible_change(row: &PhysicsRow, units: UnitSystem) -> String {
    let change = row_change(row, units);
    match row.is_ruled_out() {
        true => format!("{:.0} % of the way to {change}", 100.0 * row.possible_share),
        false => change,
    }
}

/// The shot that is the same in every row.
#[must_use]
pub fn same_shot_in_words(same: SameShot) -> &'static str {
    match same {
        SameShot::OfProfile => "the current shot ([nominal] in the profile)",
        SameShot::BestOfFirstRow => "the best shot of the first row",
        SameShot::AsMeasured => "the current shot",
    }
}

/// What stays the same of it under each physics.
#[must_use]
pub fn what_stays(same: SameShot) -> &'static str {
    match same {
        SameShot::OfProfile | SameShot::BestOfFirstRow => "with the same release in each row",
        SameShot::AsMeasured => "with the same flight to the hoop in each row, as measured",
    }
}

/// Whether the better kind of shot stays better in every gym; `None` where there is one kind alone.
fn kinds_in_words(comparison: &PhysicsComparison, units: UnitSystem) -> Option<String> {
    let base = comparison.rows.get(comparison.base)?;
    let gain = base.bank_gain()?;
    // The rule of `team` and of sweeps: less than 1 per 100 decides nothing.
    if gain.abs() < 0.01 {
        return Some("Bank and direct are level, within 1 per 100.".to_owned());
    }
    let (better, worse) = match gain > 0.0 {
        true => ("Bank", "direct"),
        false => ("Direct", "bank"),
    };
    let by = per_100(gain.abs());
    let turned = comparison.kind_turners();
    let turned: Vec<String> = turned.iter().map(|row| row_change(row, units)).collect();
    Some(match &turned[..] {
        [] => format!(
            "{better} beats {worse} by {by} per 100, and stays better for every ring, board, air and height tried."
        ),
        turned => format!(
            "{better} beats {worse} by {by} per 100 here, but not with {}.",
            list(turned)
        ),
    })
}

/// P of one quantity here, and its range in other gyms.
fn range(
    comparison: &PhysicsComparison,
    p: &dyn Fn(&PhysicsRow) -> Option<f64>,
) -> Option<(f64, [f64; 2])> {
    let base = comparison.rows.get(comparison.base)?;
    let changes = comparison.unmeasured_changes(|_, row| p(row));
    let here = p(base).filter(|_| !changes.is_empty())?;
    let [down, up] = together(&changes);
    Some((here, [here + down, here + up].map(|p| p.clamp(0.0, 1.0))))
}

/// How far the makes depend on what was not measured in this gym.
fn ranges_in_words(comparison: &PhysicsComparison) -> Option<String> {
    let base = comparison.rows.get(comparison.base)?;
    let direct = range(comparison, &PhysicsRow::direct_p);
    let is_bank_near = base.bank_p() > base.direct_p().map(|p| p - NEAR);
    let bank = range(comparison, &PhysicsRow::bank_p).filter(|_| is_bank_near);
    let same = range(comparison, &PhysicsRow::same_shot_p);
    let words = |(kind, found): (&str, Option<(f64, [f64; 2])>)| {
        let (here, [low, high]) = found?;
        Some(format!(
            "{} of 100 go in with the best {kind} shot; in other gyms {:.0} to {:.0} with the speed re-tuned there",
            of_100(here),
            100.0 * low,
            100.0 * high
        ))
    };
    let best: Vec<String> = [("direct", direct), ("bank", bank)]
        .into_iter()
        .filter_map(words)
        .collect();
    let mut sentences: Vec<String> = best.iter().map(|words| format!("{words}.")).collect();
    if let Some((here, [low, high])) = same {
        let which = match comparison.same_shot {
            SameShot::BestOfFirstRow => "With the same release everywhere",
            SameShot::OfProfile => "The current shot, with the same release everywhere,",
            SameShot::AsMeasured => "The current shot, with the flight as measured,",
        };
        let makes = match comparison.same_shot {
            SameShot::BestOfFirstRow => String::new(),
            _ => format!(" makes {};", of_100(here)),
        };
        sentences.push(format!(
            "{which}{makes} in other gyms {:.0} to {:.0}.",
            100.0 * low,
            100.0 * high
        ));
    }
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// How far the best shots depend on what was not measured in this gym.
#[must_use]
pub fn comparison_in_words(comparison: &PhysicsComparison, units: UnitSystem) -> Option<String> {
    let ranges = ranges_in_words(comparison)?;
    Some(match kinds_in_words(comparison, units) {
        Some(kinds) => format!("{kinds} {ranges}"),
        None => ranges,
    })
}

/// A fit in words.
struct FitWords<'a> {
    comparison: &'a PhysicsComparison,
    units: UnitSystem,
    fitted: &'a FittedRows,
    /// The suggested changes; empty where nothing is suggested.
    changes: String,
}

impl FitWords<'_> {
    /// The current shot and the gain of the advice, with the uncertainty of the shots and of the
    /// gym together.
    fn answer(&self) -> Vec<String> {
        let (comparison, fitted) = (self.comparison, self.fitted);
        let mut answer = vec![self.support()];
        let current = fitted.with_physics(comparison, |own| Some(own.usual));
        let base = fitted.rows[comparison.base].as_ref();
        if let Some((base, (low, high))) = base.zip(current) {
            answer.push(format!(
                "Now {} of 100 go in; {:.0} to {:.0} with the 95 % interval and other gyms combined.",
                of_100(base.usual.mean),
                100.0 * low,
                100.0 * high
            ));
        }
        let gain = fitted.with_physics(comparison, |own| Some(own.advised?[1]));
        if let Some((own, (low, high))) = fitted.gain(comparison.base).zip(gain) {
            answer.push(format!(
                "The advice ({}) adds {} per 100; {} with both combined.",
                self.changes,
                difference_per_100(own.mean),
                difference_interval(low, high)
            ));
        }
        answer
    }

    fn name(&self, row: usize) -> String {
        physics_name(self.comparison.rows[row].of, self.units)
    }

    /// Whether the data support the advice in every gym that was tried.
    fn support(&self) -> String {
        if self.changes.is_empty() {
            return "`bankshot advise` suggests no change for this player.".to_owned();
        }
        let (comparison, fitted) = (self.comparison, self.fitted);
        let rows = comparison.rows.iter().enumerate();
        let unmeasured = rows.filter(|(_, row)| row.of.unmeasured().is_some());
        let not_clear: Vec<String> = unmeasured
            .filter(|(i, _)| {
                let gain = fitted.possible_gain(comparison, *i);
                gain.is_some_and(|gain| gain.low <= 0.0)
            })
            .map(|(_, row)| row_change(row, self.units))
            .collect();
        match &not_clear[..] {
            [] => "The advice holds for every ring, board, air and height tried.".to_owned(),
            names => format!("The advice is not clear with {}.", list(names)),
        }
    }

    /// What the makes rule out, and where no gain could be computed.
    fn notes(&self) -> Vec<String> {
        let (comparison, fitted) = (self.comparison, self.fitted);
        let mut notes = Vec::new();
        let rows = 0..comparison.rows.len();
        let contradicted = rows.filter(|row| fitted.do_makes_contradict(*row));
        let contradicted: Vec<String> = contradicted.map(|row| self.name(row)).collect();
        if !contradicted.is_empty() {
            let (made, shots) = fitted.observed;
            notes.push(format!(
                "{made} of {shots} went in, which rules out: {}.",
                list(&contradicted)
            ));
        }
        let rows = comparison.rows.iter().enumerate();
        let unknown: Vec<String> = rows
            .filter(|(i, row)| {
                let has_advice = !self.changes.is_empty();
                has_advice && row.of.unmeasured().is_some() && fitted.gain(*i).is_none()
            })
            .map(|(_, row)| row_change(row, self.units))
            .collect();
        if !unknown.is_empty() {
            notes.push(format!(
                "No gain could be computed with {}.",
                list(&unknown)
            ));
        }
        notes
    }

    /// The current shot and the gain under each physics, with their 95 % intervals.
    fn details(&self) -> String {
        let fitted = self.fitted;
        let mut columns = vec![
            ("physics", "", Side::Left),
            ("current", "per 100", Side::Right),
            ("95 %", "interval", Side::Left),
        ];
        if !self.changes.is_empty() {
            columns.extend([
                ("advice", "adds", Side::Right),
                ("95 %", "interval", Side::Left),
            ]);
        }
        let has_z = fitted.has_z();
        if has_z {
            columns.push(("z", "", Side::Right));
        }
        let mut table = TextTable::new(&columns);
        let dash = || "-".to_owned();
        for (i, (own, z)) in fitted.rows.iter().zip(&fitted.made_z).enumerate() {
            let mut cells = vec![self.name(i)];
            match own.as_ref().map(|own| own.usual) {
                Some(p) => cells.extend([
                    per_100(p.mean),
                    format!("{} to {}", per_100(p.low), per_100(p.high)),
                ]),
                None => cells.extend([dash(), dash()]),
            }
            if !self.changes.is_empty() {
                match fitted.gain(i) {
                    Some(gain) => cells.extend([
                        difference_per_100(gain.mean),
                        difference_interval(gain.low, gain.high),
                    ]),
                    None => cells.extend([dash(), dash()]),
                }
            }
            if has_z {
                cells.push(z.map_or_else(dash, |z| format!("{z:+.1}")));
            }
            table.add(cells);
        }
        let mut text = table.text();
        if has_z {
            text += &format!(
                "z: how far the number of makes is from what the releases predict, in standard\ndeviations; beyond {FAR_MAKES:.0} a physics is ruled out.\n"
            );
        }
        text + &self.extremes()
            + match fitted.measured {
                Measured::Release => "The measured release is the same in every row.\n",
                Measured::Landing => {
                    "The measured flight to the hoop is the same in every row; the release follows.\n"
                }
            }
    }

    /// Where the advice adds least and most.
    fn extremes(&self) -> String {
        let rows = self.comparison.rows.iter().enumerate();
        let unmeasured = rows.filter(|(_, row)| row.of.unmeasured().is_some());
        let gains: Vec<(String, Interval)> = unmeasured
            .filter_map(|(i, row)| {
                let gain = self.fitted.possible_gain(self.comparison, i)?;
                Some((possible_change(row, self.units), gain))
            })
            .collect();
        let by_mean =
            |a: &&(String, Interval), b: &&(String, Interval)| a.1.mean.total_cmp(&b.1.mean);
        let ends = [gains.iter().min_by(by_mean), gains.iter().max_by(by_mean)];
        let [Some(least), Some(most)] = ends else {
            return String::new();
        };
        format!(
            "The advice adds least with {} ({}) and most with {} ({}).\n",
            least.0,
            difference_per_100(least.1.mean),
            most.0,
            difference_per_100(most.1.mean)
        )
    }
}

/// The best shots under each physics.
fn all_physics(comparison: &PhysicsComparison, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let (short, short_m) = units.short_length();
    let speed_unit = format!("{long}/s");
    let mut table = TextTable::new(&[
        ("physics", "", Side::Left),
        ("direct", "per 100", Side::Right),
        ("speed", &speed_unit, Side::Right),
        ("angle", "deg", Side::Right),
        ("past", short, Side::Right),
        ("bank", "per 100", Side::Right),
        ("same shot", "per 100", Side::Right),
    ]);
    let p = |shot: &Result<BestShot, NoShot>| match shot {
        Ok(shot) => per_100(shot.estimate.probability),
        Err(_) => "none".to_owned(),
    };
    let number = |value: Option<f64>, digits: usize| {
        value.map_or("-".to_owned(), |value| format!("{:.digits$}", value + 0.0))
    };
    for row in &comparison.rows {
        let nominal = row.direct.as_ref().ok().map(|shot| shot.nominal);
        table.add([
            physics_name(row.of, units),
            p(&row.direct),
            number(nominal.map(|shot| shot.speed_m_s / metre), 2),
            number(nominal.map(|shot| shot.pitch_rad / DEGREE_RAD), 1),
            number(row.aim_past_centre_m.map(|aim_m| aim_m / short_m), 1),
            p(&row.bank),
            row.same_shot_p().map_or("-".to_owned(), per_100),
        ]);
    }
    table.text()
}

/// Which of the changes the makes rule out, and as far as what.
fn ruled_out(
    comparison: &PhysicsComparison,
    told_ring: Option<(f64, f64)>,
    units: UnitSystem,
) -> Option<String> {
    let rows = comparison.rows.iter().filter(|row| row.is_ruled_out());
    let ruled_out: Vec<String> = rows
        .map(|row| {
            format!(
                "{} ({:.0} %)",
                row_change(row, units),
                100.0 * row.possible_share
            )
        })
        .collect();
    (!ruled_out.is_empty()).then(|| {
        let ring = told_ring.map_or_else(String::new, |(low, high)| {
            format!(" The ring's restitution is {low:.2} to {high:.2} (`fit --free`).")
        });
        format!(
            "The makes rule out part of the range: {}. Each range goes only as far as the makes leave it.{ring}",
            ruled_out.join(", ")
        )
    })
}

/// What each change that was not measured does to the best shot and to the current one, the
/// greatest first; the small ones together.
fn changes(comparison: &PhysicsComparison, units: UnitSystem) -> Option<TextTable> {
    /// Changes up to this stand in one row.
    const SMALL: f64 = 0.0035;
    let base = &comparison.rows[comparison.base];
    // Of the kind that is the better one.
    let (title, best) = match base.bank_p() > base.direct_p() {
        true => (
            "best bank shot,",
            comparison.unmeasured_changes(|_, row| row.bank_p()),
        ),
        false => (
            "best direct shot,",
            comparison.unmeasured_changes(|_, row| row.direct_p()),
        ),
    };
    let same = comparison.unmeasured_changes(|_, row| row.same_shot_p());
    if best.is_empty() && same.is_empty() {
        return None;
    }
    let by = |changes: &[ChangeOfP], row: usize| {
        let change = changes.iter().find(|change| change.row == row);
        change.map(|change| change.by)
    };
    let (same_title, same_unit) = match comparison.same_shot {
        SameShot::AsMeasured => ("current shot,", "same flight"),
        SameShot::OfProfile => ("current shot,", "same release"),
        SameShot::BestOfFirstRow => ("same release,", "unchanged"),
    };
    let mut table = TextTable::new(&[
        (
            "Not measured in your gym",
            "(change in makes per 100)",
            Side::Left,
        ),
        (title, "speed re-tuned", Side::Right),
        (same_title, same_unit, Side::Right),
    ]);
    let most = |row: usize| {
        let both = [by(&best, row), by(&same, row)].into_iter().flatten();
        both.fold(0.0_f64, |most, by| most.max(by.abs()))
    };
    let rows = comparison.rows.iter().enumerate();
    let unmeasured = rows.filter(|(_, row)| row.of.unmeasured().is_some());
    let mut unmeasured: Vec<usize> = unmeasured.map(|(index, _)| index).collect();
    unmeasured.sort_by(|a, b| most(*b).total_cmp(&most(*a)));
    let text = |change: Option<f64>| change.map_or("-".to_owned(), difference_per_100);
    let small = unmeasured.iter().filter(|row| most(**row) < SMALL).count();
    for &index in &unmeasured {
        if small > 1 && most(index) < SMALL {
            continue;
        }
        let change = possible_change(&comparison.rows[index], units);
        table.add([change, text(by(&best, index)), text(by(&same, index))]);
    }
    if small > 1 {
        let most = "0.3 or less".to_owned();
        table.add([format!("{small} others"), most.clone(), most]);
    }
    let both = [&best, &same].map(|changes| {
        let [down, up] = together(changes).map(|by| with_decimals(100.0 * by, 0));
        format!("{down:+.0} to {up:+.0}")
    });
    let [of_best, of_same] = both;
    table.add(["all together, about".to_owned(), of_best, of_same]);
    Some(table)
}

/// The whole answer. `is_moved`: the profile is not at its own place.
#[must_use]
pub fn physics_text(answer: &PhysicsAnswer, profile: &Profile, is_moved: bool) -> TextAnswer {
    let units = profile.output().units;
    let comparison = &answer.comparison;
    let fit = answer.fitted.as_ref().map(|fitted| FitWords {
        comparison,
        units,
        fitted,
        changes: changes_in_words(&fitted.advice, profile.location().angle_rad, units),
    });
    let mut sentences = fit.as_ref().map_or_else(Vec::new, FitWords::answer);
    sentences.extend(kinds_in_words(comparison, units));
    sentences.extend(ranges_in_words(comparison).filter(|_| fit.is_none()));
    let mut notes = Vec::new();
    if comparison.base > 0 {
        let base = physics_name(comparison.rows[comparison.base].of, units);
        notes.push(format!(
            "Changes and ranges are compared with {base}, as the profile has no air."
        ));
    }
    notes.extend(ruled_out(comparison, answer.told_ring, units));
    notes.extend(fit.as_ref().map(FitWords::notes).into_iter().flatten());
    let is_ring =
        |row: &PhysicsRow| matches!(row.of.unmeasured(), Some(PhysicsChange::RingRestitution(_)));
    if answer.told_ring.is_none() && comparison.rows.iter().any(is_ring) {
        notes.push(
            "`bankshot fit SHOTS --free hoop_restitution` estimates the ring from makes and misses."
                .to_owned(),
        );
    }
    let of_profile = match (&fit, is_moved) {
        (Some(_), _) => "",
        (None, true) => "The scatter is the same in each row.\n",
        (None, false) => {
            "If the profile was fitted to landings or trajectories, name the folder of the fit: its\nspeeds depend on the physics.\n"
        }
    };
    let details = format!(
        "{}past: how far past the ring's centre the direct shot is aimed.\nsame shot: {}, {}.\nSimulation error: up to {} per 100, with {} simulated shots.\n{of_profile}{}",
        all_physics(comparison, units),
        same_shot_in_words(comparison.same_shot),
        what_stays(comparison.same_shot),
        simulation_error(comparison.greatest_standard_error()),
        with_commas(profile.simulator().simulated_shots()),
        fit.map_or_else(String::new, |fit| format!("\n{}", fit.details()))
    );
    TextAnswer {
        answer: sentences,
        subject: subject(profile, units),
        table: changes(comparison, units),
        notes,
        details,
        ..TextAnswer::default()
    }
}
