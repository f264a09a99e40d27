//! The results of `best`: one record per shot, a table for people, and the files of the folder.

use super::{Record, number, object, provenance};
use crate::probability::best::{Best, BestShot, NoShot, ShotKind};
use crate::probability::lessons::{Changed, Difference};
use crate::profile::Profile;
use crate::units::{DEGREE_RAD, REV_RAD, System};
use comfy_table::{CellAlignment, Table, presets};
use serde_json::Value;

/// The record of one best shot.
#[must_use]
pub fn shot_record(profile: &Profile, shot: &BestShot, units: System) -> Record {
    let (long, foot) = units.length();
    let (short, inch) = units.short_length();
    let nominal = &shot.nominal;
    let estimate = &shot.estimate;
    let outcome = &shot.outcome;
    let hoop = profile.physics.hoop_height_m;
    let board = outcome.board_point_m;
    let maybe = |value: Option<f64>| value.map_or(Value::Null, number);
    let fields: Vec<(String, Value)> = vec![
        (format!("speed_{long}_s"), number(nominal.speed_m_s / foot)),
        ("pitch_deg".into(), number(nominal.pitch_rad / DEGREE_RAD)),
        ("polar_deg".into(), number(nominal.polar_rad / DEGREE_RAD)),
        (
            "backspin_rev_s".into(),
            number(nominal.backspin_rad_s / REV_RAD),
        ),
        (
            "side_spin_rev_s".into(),
            number(nominal.side_spin_rad_s / REV_RAD),
        ),
        ("probability".into(), number(estimate.probability)),
        ("standard_error".into(), number(estimate.standard_error)),
        ("shots".into(), estimate.shots.into()),
        ("share_swish".into(), number(estimate.shares.swish)),
        ("share_ring".into(), number(estimate.shares.ring)),
        ("share_board".into(), number(estimate.shares.banked())),
        ("unresolved".into(), estimate.unresolved.into()),
        ("error_free_kind".into(), outcome.kind.name().into()),
        (
            "error_free_contacts".into(),
            outcome.verdict.contacts.to_string().into(),
        ),
        (
            "entry_angle_deg".into(),
            maybe(outcome.entry.map(|entry| entry.angle_rad / DEGREE_RAD)),
        ),
        (
            format!("aim_past_centre_{short}"),
            maybe(shot.aim_past_centre_m.map(|m| m / inch)),
        ),
        (
            format!("board_aim_across_{short}"),
            maybe(board.map(|(_, y, _)| y / inch)),
        ),
        (
            format!("board_aim_above_hoop_{short}"),
            maybe(board.map(|(_, _, z)| z / inch)),
        ),
        (
            format!("apex_above_floor_{long}"),
            number((outcome.apex_m + hoop) / foot),
        ),
        ("flight_time_s".into(), number(outcome.verdict.time_s)),
        ("mass_outside_bracket".into(), number(shot.mass_outside)),
        ("at_limits".into(), shot.at_limits.join(" ").into()),
    ];
    fields
}

/// What a shooter learns from a shot, with units in the names.
fn lessons_record(shot: &BestShot, units: System) -> Value {
    let (long, foot) = units.length();
    let difference = |gain: &Difference| {
        vec![
            ("gain".to_owned(), number(gain.by)),
            ("standard_error".to_owned(), number(gain.standard_error)),
        ]
    };
    let lessons = &shot.lessons;
    let scales = [
        (format!("speed_{long}_s"), foot),
        ("pitch_deg".to_owned(), DEGREE_RAD),
        ("polar_deg".to_owned(), DEGREE_RAD),
    ];
    let windows = scales
        .into_iter()
        .zip(&lessons.windows)
        .map(|((name, scale), window)| {
            let ends = window.ends.map_or(Value::Null, |(low, high)| {
                vec![number(low / scale), number(high / scale)].into()
            });
            (name, ends)
        })
        .collect();
    let costs: Vec<Value> = lessons
        .costs
        .iter()
        .map(|cost| {
            object(vec![
                ("error".to_owned(), cost.error.into()),
                ("without".to_owned(), object(difference(&cost.without))),
                (
                    "a_tenth_less".to_owned(),
                    object(difference(&cost.a_tenth_less)),
                ),
            ])
        })
        .collect();
    let changed = |name: &str, scale: f64, all: &[Changed]| -> Value {
        let records = all.iter().map(|changed| {
            let mut record = vec![(name.to_owned(), number(changed.value / scale))];
            record.extend(difference(&changed.gain));
            object(record)
        });
        records.collect::<Vec<_>>().into()
    };
    object(vec![
        ("windows".to_owned(), object(windows)),
        ("costs".to_owned(), costs.into()),
        (
            "spins".to_owned(),
            changed("backspin_rev_s", REV_RAD, &lessons.spins),
        ),
        (
            "heights".to_owned(),
            changed(&format!("release_height_{long}"), foot, &lessons.heights),
        ),
    ])
}

/// P along each part of the best shots: `kind, nominal, unit, value, probability`.
#[must_use]
pub fn curves_csv(best: &Best, units: System) -> Vec<u8> {
    let (long, foot) = units.length();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut write = |row: [&str; 5]| {
        // Writing to memory does not fail.
        let _ = writer.write_record(row);
    };
    write(["kind", "nominal", "unit", "value", "probability"]);
    for (kind, shot) in shots(best) {
        let Ok(shot) = shot else { continue };
        for curve in &shot.curves {
            let (unit, scale) = match curve.nominal {
                "speed" => (format!("{long}/s"), foot),
                "pitch" | "polar" => ("deg".to_owned(), DEGREE_RAD),
                _ => ("rev/s".to_owned(), REV_RAD),
            };
            for (value, p) in &curve.points {
                let (value, p) = ((value / scale).to_string(), p.to_string());
                write([kind.name(), curve.nominal, &unit, &value, &p]);
            }
        }
    }
    writer.into_inner().unwrap_or_default()
}

/// What a shooter learns from the best shots: `kind, lesson, of, unit, value, gain, standard_error`, the gains in P.
/// A lesson is `window_low` and `window_high` (no gain), `without` and `a_tenth_less` of an error, or
/// another `backspin` or `release_height`.
#[must_use]
pub fn lessons_csv(best: &Best, units: System) -> Vec<u8> {
    let (long, foot) = units.length();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let header = [
        "kind",
        "lesson",
        "of",
        "unit",
        "value",
        "gain",
        "standard_error",
    ];
    // Writing to memory does not fail.
    let _ = writer.write_record(header);
    for (kind, shot) in shots(best) {
        let Ok(shot) = shot else { continue };
        let lessons = &shot.lessons;
        let mut write =
            |lesson: &str, of: &str, unit: &str, value: Option<f64>, gain: Option<&Difference>| {
                let text = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
                let (by, error) = (
                    gain.map(|gain| gain.by),
                    gain.map(|gain| gain.standard_error),
                );
                let numbers = [value, by, error].map(text);
                let words = [kind.name(), lesson, of, unit].map(str::to_owned);
                let _ = writer.write_record(words.iter().chain(&numbers));
            };
        let speed = format!("{long}/s");
        let axes = [
            ("speed", speed.as_str(), foot),
            ("pitch", "deg", DEGREE_RAD),
            ("polar", "deg", DEGREE_RAD),
        ];
        for ((of, unit, scale), window) in axes.into_iter().zip(&lessons.windows) {
            write(
                "window_low",
                of,
                unit,
                window.ends.map(|ends| ends.0 / scale),
                None,
            );
            write(
                "window_high",
                of,
                unit,
                window.ends.map(|ends| ends.1 / scale),
                None,
            );
        }
        for cost in &lessons.costs {
            write("without", cost.error, "", None, Some(&cost.without));
            write(
                "a_tenth_less",
                cost.error,
                "",
                None,
                Some(&cost.a_tenth_less),
            );
        }
        for spin in &lessons.spins {
            write(
                "backspin",
                "backspin",
                "rev/s",
                Some(spin.value / REV_RAD),
                Some(&spin.gain),
            );
        }
        for height in &lessons.heights {
            write(
                "release_height",
                "height",
                long,
                Some(height.value / foot),
                Some(&height.gain),
            );
        }
    }
    writer.into_inner().unwrap_or_default()
}

/// What a shooter learns from the best shots, in words.
#[must_use]
pub fn lessons(profile: &Profile, best: &Best, units: System) -> String {
    let (long, foot) = units.length();
    let points = |gain: &Difference| {
        // Nothing is not negative.
        let by = 100.0 * gain.by;
        let by = if by.abs() < 0.05 { 0.0 } else { by };
        format!("{by:+.1} ± {:.1}", 100.0 * gain.standard_error)
    };
    let mut text = String::new();
    for (kind, shot) in shots(best) {
        let Ok(shot) = shot else { continue };
        let lessons = &shot.lessons;
        let [speed, pitch, polar] = lessons.windows.map(|window| window.width());
        text.push_str(&format!(
            "{}, in points of P (0.01):\n  window   speed {:.2} {long}/s, pitch {:.1} deg, polar {:.1} deg wide, the others held\n",
            kind.name(),
            speed / foot,
            pitch / DEGREE_RAD,
            polar / DEGREE_RAD
        ));
        let costs: Vec<String> = lessons
            .costs
            .iter()
            .map(|cost| {
                format!(
                    "{:11} {}, with a tenth less {}\n",
                    cost.error.replace('_', " "),
                    points(&cost.without),
                    points(&cost.a_tenth_less)
                )
            })
            .collect();
        for (i, cost) in costs.iter().enumerate() {
            text.push_str(if i == 0 { "  without  " } else { "           " });
            text.push_str(cost);
        }
        if let Some(worth) = lessons.spin_is_worth() {
            let sure = worth.by > 2.0 * worth.standard_error;
            text.push_str(&format!(
                "  spin     {} over none{}\n",
                points(&worth),
                if sure { "" } else { ": not worth it here" }
            ));
        }
        let heights: Vec<String> = lessons
            .heights
            .iter()
            .map(|changed| {
                let by = changed.value - profile.shooter.release_height_m;
                format!("{:+.2} {long} {}", by / foot, points(&changed.gain))
            })
            .collect();
        text.push_str(&format!(
            "  height   {} (pitch held, speed aimed anew)\n",
            heights.join(", ")
        ));
    }
    if let (Ok(direct), Ok(bank)) = (&best.direct, &best.bank) {
        let (direct, bank) = (&direct.estimate, &bank.estimate);
        let gain = Difference {
            by: bank.probability - direct.probability,
            standard_error: libm::hypot(bank.standard_error, direct.standard_error),
        };
        text.push_str(&format!("bank less direct: {}\n", points(&gain)));
    }
    text
}

/// The whole answer as one JSON object.
#[must_use]
pub fn json(profile: &Profile, best: &Best, units: System) -> Value {
    let (long, foot) = units.length();
    let mut record = vec![
        ("shooter".to_owned(), profile.shooter.name.clone().into()),
        (
            format!("distance_{long}"),
            number(profile.place.distance_m / foot),
        ),
        (
            "court_angle_deg".to_owned(),
            number(profile.place.angle_rad / DEGREE_RAD),
        ),
        (
            format!("release_height_{long}"),
            number(profile.shooter.release_height_m / foot),
        ),
    ];
    for (kind, shot) in [
        (ShotKind::Direct, &best.direct),
        (ShotKind::Bank, &best.bank),
    ] {
        match shot {
            Ok(shot) => {
                let mut value = shot_record(profile, shot, units);
                value.push(("lessons".to_owned(), lessons_record(shot, units)));
                record.push((kind.name().to_owned(), object(value)));
            }
            Err(reason) => {
                record.push((kind.name().to_owned(), Value::Null));
                record.push((format!("{}_reason", kind.name()), reason.to_string().into()));
            }
        }
    }
    if let (Ok(direct), Ok(bank)) = (&best.direct, &best.bank) {
        let (direct, bank) = (&direct.estimate, &bank.estimate);
        let error = libm::hypot(bank.standard_error, direct.standard_error);
        let gain = vec![
            (
                "gain".to_owned(),
                number(bank.probability - direct.probability),
            ),
            ("standard_error".to_owned(), number(error)),
        ];
        record.push(("bank_less_direct".to_owned(), object(gain)));
    }
    record.extend(provenance(&profile.hash()));
    record.push(("seed".to_owned(), profile.search.seed.into()));
    record.push(("table_shots".to_owned(), best.plan.shots.into()));
    object(record)
}

/// The answer as CSV, one row per kind of shot that exists.
#[must_use]
pub fn csv(profile: &Profile, best: &Best, units: System) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header_done = false;
    for (kind, shot) in shots(best) {
        let Ok(shot) = shot else { continue };
        let record = shot_record(profile, shot, units);
        if !header_done {
            let names = record.iter().map(|(name, _)| name.as_str());
            // Writing to memory does not fail.
            let _ = writer.write_record(std::iter::once("kind").chain(names));
            header_done = true;
        }
        let cells = record.iter().map(|(_, value)| match value {
            Value::String(text) => text.clone(),
            Value::Null => String::new(),
            other => other.to_string(),
        });
        let _ = writer.write_record(std::iter::once(kind.name().to_owned()).chain(cells));
    }
    writer.into_inner().unwrap_or_default()
}

fn shots(best: &Best) -> [(ShotKind, &Result<BestShot, NoShot>); 2] {
    [
        (ShotKind::Direct, &best.direct),
        (ShotKind::Bank, &best.bank),
    ]
}

/// The table that `best` prints.
#[must_use]
pub fn table(profile: &Profile, best: &Best, units: System) -> String {
    let (long, foot) = units.length();
    let (short, inch) = units.short_length();
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(vec![
        "shot".to_owned(),
        format!("speed\n{long}/s"),
        "pitch\ndeg".to_owned(),
        "polar\ndeg".to_owned(),
        "backspin\nrev/s".to_owned(),
        "probability".to_owned(),
        "swish / ring\n/ board".to_owned(),
        "entry\ndeg".to_owned(),
        "aim".to_owned(),
    ]);
    let mut notes = Vec::new();
    for (kind, shot) in shots(best) {
        let shot = match shot {
            Ok(shot) => shot,
            Err(reason) => {
                notes.push(format!("{}: {reason}.", kind.name()));
                continue;
            }
        };
        let nominal = &shot.nominal;
        let estimate = &shot.estimate;
        let aim = match (kind, shot.outcome.board_point_m, shot.aim_past_centre_m) {
            (ShotKind::Bank, Some((_, y, z)), _) => {
                format!(
                    "board, {:.1} {short} {} ring,\n{}",
                    z.abs() / inch,
                    if z < 0.0 { "below" } else { "above" },
                    aside(y / inch, short)
                )
            }
            (_, _, Some(past)) => {
                let side = if past < 0.0 { "short of" } else { "past" };
                format!("{:.1} {short} {side} centre", past.abs() / inch)
            }
            _ => String::new(),
        };
        let shares = &estimate.shares;
        table.add_row(vec![
            kind.name().to_owned(),
            format!("{:.2}", nominal.speed_m_s / foot),
            format!("{:.1}", nominal.pitch_rad / DEGREE_RAD),
            format!("{:.2}", tidy(nominal.polar_rad / DEGREE_RAD)),
            format!("{:.1}", nominal.backspin_rad_s / REV_RAD),
            format!(
                "{:.4} ± {:.4}",
                estimate.probability, estimate.standard_error
            ),
            format!(
                "{:.2} / {:.2} / {:.2}",
                shares.swish,
                shares.ring,
                shares.banked()
            ),
            shot.outcome.entry.map_or_else(String::new, |entry| {
                format!("{:.1}", entry.angle_rad / DEGREE_RAD)
            }),
            aim,
        ]);
        if nominal.side_spin_rad_s != 0.0 || nominal.rifle_spin_rad_s != 0.0 {
            notes.push(format!(
                "{}: with a side spin of {:.2} rev/s and a rifle spin of {:.2} rev/s.",
                kind.name(),
                nominal.side_spin_rad_s / REV_RAD,
                nominal.rifle_spin_rad_s / REV_RAD
            ));
        }
        if !shot.at_limits.is_empty() {
            notes.push(format!(
                "{}: the best lies at a limit: {}.",
                kind.name(),
                shot.at_limits.join(", ")
            ));
        }
        if estimate.standard_error > profile.search.standard_error {
            notes.push(format!(
                "{}: the standard error asked for was not reached.",
                kind.name()
            ));
        }
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut text = table.trim_fmt();
    text.push('\n');
    for note in notes {
        text.push_str(&note);
        text.push('\n');
    }
    text
}

/// Avoids printing a negative zero.
fn tidy(value: f64) -> f64 {
    if value.abs() < 0.005 { 0.0 } else { value }
}

fn aside(across: f64, unit: &str) -> String {
    if across.abs() < 0.05 {
        "on its middle line".to_owned()
    } else {
        format!(
            "{:.1} {unit} to the {}",
            across.abs(),
            if across > 0.0 {
                "right, facing the board"
            } else {
                "left, facing the board"
            }
        )
    }
}
