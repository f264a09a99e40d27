//! The tables `[grid]`, `[search]` and `[output]`.

use super::diagnostics::Diagnostic;
use super::toml_reader::TableReader;
use crate::shooter::{NominalVariable, OutputSettings, SearchChoice, SearchSettings, TableGrid};
use crate::units::{Dimension, UnitSystem, suggestion};

pub(super) fn read_grid(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> TableGrid {
    let mut table = root.table("grid", diagnostics);
    let mut grid = TableGrid::default();
    for (key, points) in [
        ("speed", &mut grid.speed),
        ("pitch", &mut grid.pitch),
        ("polar", &mut grid.polar),
        ("backspin", &mut grid.backspin),
    ] {
        if let Some(count) = table.count(key, 2..=100_000, diagnostics) {
            *points = usize::try_from(count).unwrap_or(usize::MAX);
        }
    }
    table.report_unknown_keys(diagnostics);
    grid
}

/// The search. What limits the shooter (the variables to choose, pitch angles, speed) is that of
/// `shooter` where the table does not say it.
pub(super) fn read_search(
    root: &mut TableReader<'_, '_>,
    shooter: &SearchSettings,
    diagnostics: &mut Vec<Diagnostic>,
) -> SearchSettings {
    let mut table = root.table("search", diagnostics);
    let search = SearchSettings {
        choice: read_choice(&mut table, diagnostics).unwrap_or(shooter.choice),
        pitch_min_rad: table
            .quantity("pitch_min", Dimension::Angle, diagnostics)
            .or(shooter.pitch_min_rad),
        pitch_max_rad: table
            .quantity("pitch_max", Dimension::Angle, diagnostics)
            .or(shooter.pitch_max_rad),
        speed_max_m_s: table
            .quantity("speed_max", Dimension::Speed, diagnostics)
            .or(shooter.speed_max_m_s),
        standard_error: table.quantity("standard_error", Dimension::Number, diagnostics),
        climb_samples: table
            .count("climb_samples", 64..=65536, diagnostics)
            .and_then(|count| u32::try_from(count).ok()),
        seed: table.count("seed", 0..=u64::MAX, diagnostics),
    };
    table.report_unknown_keys(diagnostics);
    search
}

fn read_choice(
    table: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<SearchChoice> {
    let names = table.texts("choose", diagnostics)?;
    let known = NominalVariable::SEARCHABLE.map(NominalVariable::name);
    let unknown = names.iter().find(|name| !known.contains(&name.as_str()));
    if names.is_empty() || unknown.is_some() {
        let what = unknown.map_or(String::new(), |name| {
            let hint = suggestion(name, known);
            format!(
                "; \"{}\" is none of them{hint}",
                name.chars().take(60).collect::<String>()
            )
        });
        let message = format!("must name one or more of {}{what}", known.join(", "));
        diagnostics.push(table.diagnostic("choose", message));
        return None;
    }
    let chosen: Vec<NominalVariable> = NominalVariable::SEARCHABLE
        .into_iter()
        .filter(|variable| names.iter().any(|name| name == variable.name()))
        .collect();
    Some(SearchChoice::only(&chosen))
}

/// The output; in `units`, where the table does not say it.
pub(super) fn read_output(
    root: &mut TableReader<'_, '_>,
    units: UnitSystem,
    diagnostics: &mut Vec<Diagnostic>,
) -> OutputSettings {
    let mut table = root.table("output", diagnostics);
    let mut output = OutputSettings {
        units,
        ..OutputSettings::default()
    };
    if let Some(folder) = table.text("folder", diagnostics) {
        output.folder = folder;
    }
    match table.text("units", diagnostics).as_deref() {
        None => {}
        Some("imperial") => output.units = UnitSystem::Imperial,
        Some("metric") => output.units = UnitSystem::Metric,
        Some(_) => {
            diagnostics.push(table.diagnostic("units", "must be \"imperial\" or \"metric\""));
        }
    }
    table.report_unknown_keys(diagnostics);
    output
}
