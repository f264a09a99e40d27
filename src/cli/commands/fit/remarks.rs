//! What is said beside a fit: shots that were kept out, sessions, columns, heights.

use crate::cli::measured_shots_flags::MeasuredFile;
use crate::cli::terminal::print_remark;
use crate::measured_shots::rejected_shots::grouped_reasons;
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::units::UnitSystem;
use std::collections::HashSet;

/// Rejected rows that are named.
const MOST_NAMED: usize = 20;

/// Names the shots that were kept out, or the first of them.
pub(crate) fn report_rejected(file: &MeasuredFile, shots: &ShooterShots, is_only: bool) {
    if shots.rejected.is_empty() {
        return;
    }
    let of = if shots.name.is_empty() {
        String::new()
    } else {
        format!("{}: ", shots.name)
    };
    // Of several shooters, fewer of each.
    let most_named = if is_only { MOST_NAMED } else { 3 };
    if shots.rejected.len() > most_named {
        for group in grouped_reasons(&shots.rejected) {
            print_remark(&format!(
                "{}: {} rows, the first in {} {}: {}",
                file.file.display(),
                group.rows,
                file.row_name,
                group.first,
                group.reason
            ));
        }
    }
    let named = match shots.rejected.len() > most_named {
        true => 0,
        false => most_named,
    };
    for (row, reason) in shots.rejected.iter().take(named) {
        print_remark(&format!(
            "{}: {} {row}: {reason}",
            file.file.display(),
            file.row_name
        ));
    }
    print_remark(&format!(
        "{of}{} shots used, {} left out; if those were misses, the makes per 100 are too high",
        shots.shots.len(),
        shots.rejected.len()
    ));
}

/// Says that sessions were fitted as one.
pub(crate) fn print_sessions(file: &MeasuredFile) {
    if let Some(order) = &file.session_order {
        print_remark(order);
    }
    let sessions = file.shooters.iter().flat_map(|shots| &shots.sessions);
    let names: HashSet<&String> = sessions.collect();
    if names.len() > 1 {
        print_remark(&format!(
            "{} sessions are fitted as one; --session NAME fits one alone, `bankshot compare` compares two",
            names.len()
        ));
    }
}

/// Says where the name of a place contradicts the sign of its court angle.
pub(super) fn print_sides(shooters: &[ShooterShots]) {
    let mut told: Vec<&str> = Vec::new();
    for shots in shooters {
        for (place, name) in shots.places.iter().zip(&shots.place_names) {
            let side = if place.location.angle_rad > 0.0 {
                ["right", "left"]
            } else {
                ["left", "right"]
            };
            let words = name.to_lowercase();
            let is_other = words.contains(side[1]) && !words.contains(side[0]);
            if is_other && place.location.angle_rad != 0.0 && !told.contains(&name.as_str()) {
                told.push(name);
                print_remark(&format!(
                    "warning: the place {name} is taken to be on the {}: court angles are positive to the right as one faces the hoop. If they grow to the left in this file: --map 'court_angle=-COLUMN:deg'",
                    side[0]
                ));
            }
        }
    }
}

/// Names the columns that nothing was taken from.
pub(crate) fn print_unused(file: &MeasuredFile) {
    for (name, texts) in &file.possible_players {
        print_remark(&format!(
            "warning: all shots are taken as one player's, but column {name} has several texts ({}): if they are players, add --map 'shooter={name}'",
            texts.join(", ")
        ));
    }
    if !file.unused.is_empty() {
        print_remark(&format!(
            "columns that were not used: {}",
            file.unused.join(", ")
        ));
        if !file.proposed.is_empty() {
            print_remark(&format!(
                "they may hold: {}; add --accept to use them",
                file.proposed.join(", ")
            ));
        }
        let mut sessions = file.shooters.iter().flat_map(|shots| &shots.sessions);
        if let Some(name) = file
            .sessions_column
            .as_ref()
            .filter(|_| sessions.all(String::is_empty) && file.proposed.is_empty())
        {
            print_remark(&format!(
                "if column {name} names the sessions, type --map 'session={name}' to test whether they differ"
            ));
        }
        let mut shots = file.shooters.iter().flat_map(|shots| &shots.shots);
        if shots.all(|shot| shot.made.is_none()) && file.proposed.is_empty() {
            print_remark(
                "no column shows what went in, so nothing checks the prediction; if one does, type --map 'made=COLUMN'",
            );
        }
    }
}

/// Says how far the releases of a place lie apart, and what is made of that.
pub(super) fn print_place_scatter(shots: &ShooterShots, units: UnitSystem) {
    /// Less than this is not worth a word, m.
    const LEAST_M: f64 = 0.02;
    let (long, metre) = units.length();
    let mut texts = Vec::new();
    for (number, (place, scatter)) in shots.places.iter().zip(&shots.place_scatter).enumerate() {
        let sideways_m = scatter.court_angle_rad * place.location.distance_m;
        let parts = [
            (scatter.distance_m, "towards the hoop"),
            (sideways_m, "sideways"),
            (scatter.height_m, "in height"),
        ];
        let parts: Vec<String> = parts
            .iter()
            .filter(|(size_m, _)| *size_m >= LEAST_M)
            .map(|(size_m, way)| format!("{:.2} {long} {way}", size_m / metre))
            .collect();
        if !parts.is_empty() {
            let name = match shots.places.len() {
                1 => String::new(),
                _ => format!("place {}: ", number + 1),
            };
            texts.push(format!("{name}{}", parts.join(", ")));
        }
    }
    if !texts.is_empty() {
        print_remark(&format!(
            "the releases are from scattered places (standard deviation): {}; the fit moves each to their middle and keeps its landing",
            texts.join("; ")
        ));
    }
}
