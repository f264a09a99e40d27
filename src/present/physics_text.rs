//! How much of an answer rests on the physics, for people.

use super::fit_files::change_in_words::changes_in_words;
use crate::answers::physics::{FAR_MAKES, FittedRows, PhysicsAnswer};
use crate::best_shot::{
    BestShot, ChangeOfP, NoShot, PhysicsChange, PhysicsComparison, PhysicsOf, PhysicsRow, SameShot,
    together,
};
use crate::fitting::{Interval, Measured};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, FOOT_M, UnitSystem, with_decimals};
use comfy_table::{CellAlignment, LineStyle, Table, presets};

/// A bank shot that makes so much less than the direct one is told too.
const NEAR: f64 = 0.05;

/// What a physics is, or what it changes.
#[must_use]
pub fn physics_name(of: PhysicsOf, units: UnitSystem) -> String {
    match of {
        PhysicsOf::Profile => "the profile's".to_owned(),
        PhysicsOf::Given => "as given".to_owned(),
        PhysicsOf::Preset(name) => name.to_owned(),
        PhysicsOf::Changed(change) => format!("with {}", change_name(change, units)),
        PhysicsOf::ChangedNcaa(change) => format!("ncaa, {}", change_name(change, units)),
    }
}

fn change_name(change: PhysicsChange, units: UnitSystem) -> String {
    let length = |by_m: f64| match units {
        UnitSystem::Imperial => format!("{:.1} ft", by_m.abs() / FOOT_M),
        UnitSystem::Metric => format!("{:.2} cm", 100.0 * by_m.abs()),
    };
    match change {
        PhysicsChange::NoAir => "no air".to_owned(),
        PhysicsChange::Altitude => match units {
            UnitSystem::Imperial => "air of 5280 ft".to_owned(),
            UnitSystem::Metric => "air of 1609 m".to_owned(),
        },
        PhysicsChange::Drag(drag) => format!("drag_coefficient {drag:.2}"),
        PhysicsChange::Lift(slope) => format!("lift_slope {slope}"),
        PhysicsChange::ThinRing => "a ring of no thickness".to_owned(),
        PhysicsChange::NoBracket => "no bracket".to_owned(),
        PhysicsChange::RingRestitution(of) => format!("hoop_restitution {of:.2}"),
        PhysicsChange::RingStiffness(times) if times < 1.0 => "hoop_stiffness half".to_owned(),
        PhysicsChange::RingStiffness(_) => "hoop_stiffness double".to_owned(),
        PhysicsChange::BoardRestitution(of) => format!("board_restitution {of:.2}"),
        PhysicsChange::ReleaseHeight(by_m) if by_m < 0.0 => {
            format!("release {} lower", length(by_m))
        }
        PhysicsChange::ReleaseHeight(by_m) => format!("release {} higher", length(by_m)),
        PhysicsChange::Friction(friction) => format!("friction {friction}"),
    }
}

/// What a row changes; of another row its name.
fn row_change(row: &PhysicsRow, units: UnitSystem) -> String {
    match row.of.change() {
        Some(change) => change_name(change, units),
        None => physics_name(row.of, units),
    }
}

/// The same as far as the gym may have it: `56 % of the way to drag_coefficient 0.54`.
fn possible_change(row: &PhysicsRow, units: UnitSystem) -> String {
    let change = row_change(row, units);
    match row.is_ruled_out() {
        true => format!("{:.0} % of the way to {change}", 100.0 * row.possible_share),
        false => change,
    }
}

/// What the shot is that is the same in every row.
#[must_use]
pub fn same_shot_in_words(same: SameShot) -> &'static str {
    match same {
        SameShot::OfProfile => "the usual shot (the profile's [nominal] table)",
        SameShot::BestOfFirstRow => "the best shot of the first row",
        SameShot::AsMeasured => "the usual shot",
    }
}

/// What of it is the same under each physics.
#[must_use]
pub fn what_stays(same: SameShot) -> &'static str {
    match same {
        SameShot::OfProfile | SameShot::BestOfFirstRow => "released the same way everywhere",
        SameShot::AsMeasured => "which falls to the hoop as it was measured",
    }
}

/// Which kind it is; empty for another shot than the best one.
fn kind_of_same_shot(comparison: &PhysicsComparison) -> &'static str {
    let first = comparison.rows.first();
    match (comparison.same_shot, first) {
        (SameShot::BestOfFirstRow, Some(first)) if first.bank_p() > first.direct_p() => {
            " (a bank shot)"
        }
        (SameShot::BestOfFirstRow, Some(_)) => " (a direct shot)",
        _ => "",
    }
}

/// Whether the better kind of shot is the same under each change that nobody measured; empty where
/// there is one kind alone.
fn kinds_in_words(comparison: &PhysicsComparison, units: UnitSystem) -> String {
    let base = comparison.rows.get(comparison.base);
    let Some(gain) = base.and_then(PhysicsRow::bank_gain) else {
        return String::new();
    };
    // The rule of `team` and of sweeps: less than a shot in 100 decides nothing.
    if gain.abs() < 0.01 {
        return "The best bank shot and the best direct one are level, within one of 100. "
            .to_owned();
    }
    let (better, worse) = match gain > 0.0 {
        true => ("bank", "direct"),
        false => ("direct", "bank"),
    };
    let more = format!(
        "The best {better} shot makes more than the best {worse} one ({:.1} of 100 more)",
        100.0 * gain.abs()
    );
    let turned = comparison.kind_turners();
    let turned: Vec<String> = turned.iter().map(|row| row_change(row, units)).collect();
    match &turned[..] {
        [] => {
            format!("{more}, and does so under each change of what nobody measured in this gym. ")
        }
        turned => format!(
            "{more}, but not with {}: that depends on what nobody measured in this gym. ",
            turned.join(", ")
        ),
    }
}

/// How far P of the best shots rests on what nobody measured in this gym, and how far that of the
/// shot that is the same in every row does.
#[must_use]
pub fn comparison_in_words(comparison: &PhysicsComparison, units: UnitSystem) -> Option<String> {
    let base = comparison.rows.get(comparison.base)?;
    let range = |p: &dyn Fn(&PhysicsRow) -> Option<f64>| {
        let changes = comparison.unmeasured_changes(|_, row| p(row));
        let here = p(base).filter(|_| !changes.is_empty())?;
        let [down, up] = together(&changes);
        let ends = [here + down, here + up].map(|p| p.clamp(0.0, 1.0));
        Some(format!("{here:.2} ({:.2} to {:.2})", ends[0], ends[1]))
    };
    let direct = range(&PhysicsRow::direct_p);
    let is_bank_near = base.bank_p() > base.direct_p().map(|p| p - NEAR);
    let bank = range(&PhysicsRow::bank_p).filter(|_| is_bank_near);
    let best: Vec<String> = [("direct", direct), ("bank", bank)]
        .into_iter()
        .filter_map(|(kind, range)| Some(format!("of the best {kind} shot {}", range?)))
        .collect();
    if best.is_empty() {
        return None;
    }
    let under = match comparison.base {
        0 => String::new(),
        _ => format!(" under {}", physics_name(base.of, units)),
    };
    let mut text = kinds_in_words(comparison, units);
    text += &format!(
        "P{under}, with the range that what nobody measured in this gym leaves: {}, searched anew in the gym as it is (the speed set there, by where shots land).",
        best.join(", ")
    );
    if let Some(same) = range(&PhysicsRow::same_shot_p) {
        text += &format!(
            " P of {}{}, {}: {same}.",
            same_shot_in_words(comparison.same_shot),
            kind_of_same_shot(comparison),
            what_stays(comparison.same_shot)
        );
    }
    Some(text)
}

/// An answer in words.
struct Words<'a> {
    comparison: &'a PhysicsComparison,
    units: UnitSystem,
}

/// A fit in words.
struct FitWords<'a> {
    comparison: &'a PhysicsComparison,
    units: UnitSystem,
    fitted: &'a FittedRows,
    /// The advised changes; empty where nothing is advised.
    changes: String,
}

impl FitWords<'_> {
    /// The intervals of the fit and of the physics in one, and what the makes say.
    fn together(&self) -> String {
        let (comparison, fitted) = (self.comparison, self.fitted);
        let usual = fitted.with_physics(comparison, |own| Some(own.usual));
        let Some((low, high)) = usual else {
            return String::new();
        };
        let mut text = format!(
            "With what the shots leave open and what nobody measured in this gym together, P of the usual shot{} is {low:.2} to {high:.2}",
            match comparison.base {
                0 => String::new(),
                base => format!(" under {}", self.name(base)),
            }
        );
        let gain = fitted.with_physics(comparison, |own| Some(own.advised?[1]));
        if let Some((low, high)) = gain {
            text += &format!(
                ", and the gain {:+.1} to {:+.1} points",
                in_points(low),
                in_points(high)
            );
        }
        text += " (95 % interval of the fit, and the changes taken together: the root of the sum of squares; a constant error of the tracker is not in it: see `bankshot fit`).\n";
        let Some(share) = fitted.share_of_makes() else {
            return text;
        };
        let (made, shots) = fitted.observed;
        text += &format!(
            "Of the measured shots {made} of {shots} went in: {:.2} (95 %: {:.2} to {:.2}).",
            share.share, share.low, share.high
        );
        let rows = 0..comparison.rows.len();
        let contradicted = rows.filter(|row| fitted.do_makes_contradict(*row));
        let contradicted: Vec<String> = contradicted.map(|row| self.name(row)).collect();
        text += &match (&contradicted[..], fitted.has_z()) {
            ([], _) => " They speak against none of the rows.\n".to_owned(),
            (rows, true) => format!(
                " The makes speak against these, where the balls that went in differ by more than {FAR_MAKES:.0} standard deviations from what is expected of their releases (z in the last table): {}.\n",
                rows.join(", ")
            ),
            (rows, false) => format!(
                " They speak against these, where the intervals do not meet: {}. (A fit with --physics tells more: its z says whether the makes of each ball agree.)\n",
                rows.join(", ")
            ),
        };
        text
    }

    fn name(&self, row: usize) -> String {
        physics_name(self.comparison.rows[row].of, self.units)
    }

    /// The usual shot and the gain under each physics, with their 95 % intervals.
    fn table(&self) -> Table {
        let mut header = vec!["physics", "usual\nP", "95 %"];
        if !self.changes.is_empty() {
            header.extend(["advice\ngains", "95 %"]);
        }
        let fitted = self.fitted;
        let has_z = fitted.has_z();
        if has_z {
            header.push("z");
        }
        let mut table = table_with(header.into_iter().map(str::to_owned).collect());
        if let Some(names) = table.column_mut(0).filter(|_| has_z) {
            names.set_padding((0, 1));
        }
        let interval = |of: Option<Interval>, text: &dyn Fn(f64) -> String| {
            of.map_or(["-".to_owned(), "-".to_owned()], |of| {
                [
                    text(of.mean),
                    format!("{} to {}", text(of.low), text(of.high)),
                ]
            })
        };
        // Room for z in 80 columns.
        let [p_decimals, gain_decimals] = if has_z { [2, 0] } else { [3, 1] };
        for (i, (own, z)) in fitted.rows.iter().zip(&fitted.made_z).enumerate() {
            let mut cells = vec![self.name(i)];
            let usual = own.as_ref().map(|own| own.usual);
            cells.extend(interval(usual, &|p| format!("{p:.p_decimals$}")));
            if !self.changes.is_empty() {
                cells.extend(interval(fitted.gain(i), &|p| {
                    format!("{:+.gain_decimals$}", in_points(p))
                }));
            }
            if has_z {
                cells.push(z.map_or("-".to_owned(), |z| format!("{z:+.1}")));
            }
            table.add_row(cells);
        }
        table
    }

    /// Whether the advice is sure under the physics that nobody measured in this gym.
    fn is_sure(&self) -> String {
        if self.changes.is_empty() {
            return "`bankshot advise` advises no change to this shooter.\n".to_owned();
        }
        let (comparison, fitted) = (self.comparison, self.fitted);
        let rows = || comparison.rows.iter().enumerate();
        let names = |wanted: &dyn Fn(Option<Interval>) -> bool| {
            let unmeasured = rows().filter(|(_, row)| row.of.unmeasured().is_some());
            let named = unmeasured.filter(|(i, _)| wanted(fitted.possible_gain(comparison, *i)));
            named
                .map(|(_, row)| row_change(row, self.units))
                .collect::<Vec<_>>()
        };
        let unsure = names(&|gain| gain.is_some_and(|gain| gain.low <= 0.0));
        let unknown = names(&|gain| gain.is_none());
        let of = match comparison.base {
            0 => "what nobody measured in this gym",
            _ => "ncaa in what nobody measured in this gym (the fit's physics has no air)",
        };
        let as_far = match comparison.rows.iter().any(PhysicsRow::is_ruled_out) {
            true => ", as far as the makes leave it",
            false => "",
        };
        let mut text = match (&unsure[..], &unknown[..]) {
            ([], []) => format!(
                "The advice holds under each change of {of}{as_far}: the 95 % interval of its gain lies above 0.\n"
            ),
            ([], _) => String::new(),
            _ => format!(
                "The advice is not sure under some changes of {of}: {}. There the 95 % interval of its gain reaches below 0.\n",
                unsure.join(", ")
            ),
        };
        if !unknown.is_empty() {
            text += &format!("No gain could be computed with {}.\n", unknown.join(", "));
        }
        let lost: Vec<String> = rows()
            .skip(1)
            .filter(|(i, row)| row.of.unmeasured().is_none() && !fitted.do_makes_contradict(*i))
            .filter(|(i, _)| fitted.gain(*i).is_some_and(|gain| gain.low <= 0.0))
            .map(|(_, row)| row_change(row, self.units))
            .collect();
        if !lost.is_empty() {
            text += &format!(
                "(With other balls, hoops or air it does not gain for sure, or loses: {}. They matter only where one of them is yours.)\n",
                lost.join(", ")
            );
        }
        text
    }

    /// What the advice gains under the physics of the profile, and under those that nobody measured
    /// in this gym; empty where nothing is advised.
    fn gains(&self) -> String {
        if self.changes.is_empty() {
            return String::new();
        }
        let points = |gain: &Interval| {
            let [mean, low, high] = [gain.mean, gain.low, gain.high].map(in_points);
            format!("{mean:+.1} points (95 %: {low:+.1} to {high:+.1})")
        };
        let mut text = format!("The advice ({})", self.changes);
        if let Some(own) = self.fitted.gain(0) {
            text += &format!(" gains {} under the first row's physics", points(&own));
        }
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
        if let [Some(least), Some(most)] = ends {
            text += &format!(
                "; of the changes that nobody measured, least {} with {}, most {} with {}",
                points(&least.1),
                least.0,
                points(&most.1),
                most.0
            );
        }
        text += match self.fitted.measured {
            Measured::Release => ". The measured release is the same in every row.\n",
            Measured::Landing => {
                ". What was measured is how the ball falls to the hoop: it does so in every row, and the release is the one that leads there.\n"
            }
        };
        text
    }
}

/// A difference of P in makes of 100, rounded.
fn in_points(p: f64) -> f64 {
    with_decimals(100.0 * p, 1)
}

/// A table whose first column is text, and the others numbers.
fn table_with(header: Vec<String>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY.row_separator(LineStyle::none()));
    table.set_header(header);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

impl Words<'_> {
    /// The best shots under each physics.
    fn table(&self) -> Table {
        let (long, metre) = self.units.length();
        let (short, short_m) = self.units.short_length();
        let mut table = table_with(vec![
            "physics".to_owned(),
            "direct\nP".to_owned(),
            format!("speed\n{long}/s"),
            "pitch\ndeg".to_owned(),
            format!("past\n{short}"),
            "bank\nP".to_owned(),
            "same\nshot P".to_owned(),
        ]);
        let p = |shot: &Result<BestShot, NoShot>| match shot {
            Ok(shot) => format!("{:.3}", shot.estimate.probability),
            Err(_) => "none".to_owned(),
        };
        let number = |value: Option<f64>, digits: usize| {
            value.map_or("-".to_owned(), |value| format!("{value:.digits$}"))
        };
        for row in &self.comparison.rows {
            let nominal = row.direct.as_ref().ok().map(|shot| shot.nominal);
            table.add_row(vec![
                physics_name(row.of, self.units),
                p(&row.direct),
                number(nominal.map(|shot| shot.speed_m_s / metre), 2),
                number(nominal.map(|shot| shot.pitch_rad / DEGREE_RAD), 1),
                number(row.aim_past_centre_m.map(|aim_m| aim_m / short_m), 1),
                p(&row.bank),
                number(row.same_shot_p(), 3),
            ]);
        }
        table
    }

    /// Which of the changes that nobody measured are ruled out, and what that means.
    fn ruled_out(&self, told_ring: Option<(f64, f64)>) -> String {
        let rows = self.comparison.rows.iter();
        let ruled_out: Vec<String> = rows
            .filter(|row| row.is_ruled_out())
            .map(|row| {
                let change = row_change(row, self.units);
                format!("{change} ({:.0} %)", 100.0 * row.possible_share)
            })
            .collect();
        if ruled_out.is_empty() {
            return String::new();
        }
        let ring = told_ring.map_or_else(String::new, |(low, high)| {
            format!(" (the ring's restitution is {low:.2} to {high:.2}, as `fit --free` found)")
        });
        format!(
            "The makes of the measured shots rule some changes out{ring}; every range goes only as far towards them as the makes leave it: {}.\n",
            ruled_out.join(", ")
        )
    }

    /// What each change that nobody measured does to P of the best shot and of the usual one.
    fn changes(&self) -> String {
        let comparison = self.comparison;
        let base = &comparison.rows[comparison.base];
        // Of the kind that is the better one.
        let is_bank = base.bank_p() > base.direct_p();
        let (title, best) = match is_bank {
            true => (
                "best\nbank shot",
                comparison.unmeasured_changes(|_, row| row.bank_p()),
            ),
            false => (
                "best\ndirect shot",
                comparison.unmeasured_changes(|_, row| row.direct_p()),
            ),
        };
        let same = comparison.unmeasured_changes(|_, row| row.same_shot_p());
        if best.is_empty() && same.is_empty() {
            return String::new();
        }
        let of = |changes: &[ChangeOfP], row: usize| {
            let change = changes.iter().find(|change| change.row == row);
            change.map_or("-".to_owned(), |change| {
                format!("{:+.1}", in_points(change.by))
            })
        };
        let header = ["change", title, "same\nshot"];
        let mut table = table_with(header.map(str::to_owned).to_vec());
        // Those that do most first.
        let most = |row: usize| {
            let both = best.iter().chain(&same).filter(|change| change.row == row);
            both.fold(0.0_f64, |most, change| most.max(change.by.abs()))
        };
        let rows = comparison.rows.iter().enumerate();
        let unmeasured = rows.filter(|(_, row)| row.of.unmeasured().is_some());
        let mut unmeasured: Vec<usize> = unmeasured.map(|(index, _)| index).collect();
        unmeasured.sort_by(|a, b| most(*b).total_cmp(&most(*a)));
        for &index in &unmeasured {
            let change = possible_change(&comparison.rows[index], self.units);
            table.add_row(vec![change, of(&best, index), of(&same, index)]);
        }
        let both = [&best, &same].map(|changes| {
            let [down, up] = together(changes).map(|by| with_decimals(100.0 * by, 0));
            format!("{down:+.0} to {up:+.0}")
        });
        let [of_best, of_same] = both;
        table.add_row(vec!["together about".to_owned(), of_best, of_same]);
        let is_ring = |index: &usize| {
            let change = comparison.rows[*index].of.unmeasured();
            matches!(change, Some(PhysicsChange::RingRestitution(_)))
        };
        format!(
            "\nWhat nobody measured in this gym, by what it does to P, in makes of 100{}:\n{}\n",
            match unmeasured.iter().any(is_ring) {
                true => {
                    " (`bankshot fit SHOTS --free hoop_restitution` finds that one from made and missed)"
                }
                false => "",
            },
            table.trim_fmt()
        )
    }
}

/// The whole answer. `is_moved`: the profile is not at its own place.
#[must_use]
pub fn physics_text(answer: &PhysicsAnswer, profile: &Profile, is_moved: bool) -> String {
    let has_air = profile.physics().air.density_kg_m3 > 0.0;
    let units = profile.output().units;
    let comparison = &answer.comparison;
    let words = Words { comparison, units };
    let fit = answer.fitted.as_ref().map(|fitted| FitWords {
        comparison,
        units,
        fitted,
        changes: changes_in_words(&fitted.advice, profile.location().angle_rad, units),
    });
    let mut text =
        comparison_in_words(comparison, units).map_or_else(String::new, |words| words + "\n\n");
    text += &words.ruled_out(answer.told_ring);
    if let Some(fit) = &fit {
        text += &format!("{}\n{}\n", fit.together(), fit.is_sure());
    }
    let of_fit = match &fit {
        Some(fit) => format!(
            "\nP of the usual shot, and what the advice adds in makes of 100, with 95 % intervals of what the fit leaves open:\n{}\n{}",
            fit.table().trim_fmt(),
            fit.gains()
        ),
        None if is_moved => "\n(Of a profile that was fitted to landings or trajectories the speeds were derived with the physics; here the scatter stays the same in each row.)\n".to_owned(),
        None => "\n(Of a profile that was fitted to landings or trajectories, give the folder of the fit: its speeds were derived with the physics, and change with it.)\n".to_owned(),
    };
    let first_row = match comparison.rows.first() {
        Some(row) if row.of == PhysicsOf::Given => "The first row is the physics of --physics",
        _ => "The first row is the profile's own physics",
    };
    let [with, it] = match has_air {
        true => ["with", "it"],
        false => ["ncaa,", "ncaa"],
    };
    let same = comparison.same_shot;
    format!(
        "{text}{}\n{}\nEach P has a numerical standard error of at most {:.4}. {first_row}; \"{with}\" changes one thing of {it}. past: of the ring's centre. The last column is the P of {}, {}.\n{of_fit}",
        words.table().trim_fmt(),
        words.changes(),
        comparison.greatest_standard_error(),
        same_shot_in_words(same),
        what_stays(same),
    )
}
