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

pub(super) fn read_search(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> SearchSettings {
    let mut table = root.table("search", diagnostics);
    let search = SearchSettings {
        choice: read_choice(&mut table, diagnostics),
        pitch_min_rad: table.quantity("pitch_min", Dimension::Angle, diagnostics),
        pitch_max_rad: table.quantity("pitch_max", Dimension::Angle, diagnostics),
        speed_max_m_s: table.quantity("speed_max", Dimension::Speed, diagnostics),
        standard_error: table.quantity("standard_error", Dimension::Number, diagnostics),
        climb_samples: table
            .count("climb_samples", 64..=65536, diagnostics)
            .and_then(|count| u32::try_from(count).ok()),
        seed: table.count("seed", 0..=u64::MAX, diagnostics),
    };
    table.report_unknown_keys(diagnostics);
    search
}

fn read_choice(table: &mut TableReader<'_, '_>, diagnostics: &mut Vec<Diagnostic>) -> SearchChoice {
    let Some(names) = table.texts("choose", diagnostics) else {
        return SearchChoice::default();
    };
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
        return SearchChoice::default();
    }
    let chosen: Vec<NominalVariable> = NominalVariable::SEARCHABLE
        .into_iter()
        .filter(|variable| names.iter().any(|name| name == variable.name()))
        .collect();
    SearchChoice::only(&chosen)
}

pub(super) fn read_output(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> OutputSettings {
    let mut table = root.table("output", diagnostics);
    let mut output = OutputSettings::default();
    if let Some(folder) = table.text("folder", diagnostics) {
        output.folder = folder;
    }
    match table.text("units", diagnostics).as_deref() {
        None | Some("imperial") => {}
        Some("metric") => output.units = UnitSystem::Metric,
        Some(_) => {
            diagnostics.push(table.diagnostic("units", "must be \"imperial\" or \"metric\""));
        }
    }
    table.report_unknown_keys(diagnostics);
    output
}
