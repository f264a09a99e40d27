//! `draws.parquet`: the draws of a posterior, one a row, with the names and units of `fit.json`.

use crate::files::parquet_rows::{ParquetRows, ParquetSink, column};
use crate::fitting::{
    Draw, DrawProbabilities, Posterior, SpinSource, VALUE_NAMES, Values, pair_name,
};
use crate::store::parameters::value_units;
use crate::units::UnitSystem;
use nalgebra::SMatrix;
use parquet::basic::Type as Physical;
use std::fs::File;

/// Rows that are read at a time.
const BLOCK: (usize, usize) = (10_000, 16 << 20);

fn pairs() -> impl Iterator<Item = (usize, usize)> {
    (1..4).flat_map(|j| (0..j).map(move |i| (i, j)))
}

/// The columns, each with the size of its unit in SI units.
fn columns(places: usize, units: UnitSystem) -> Vec<(String, f64)> {
    let of_value = value_units(units).map(|(unit, size)| (unit.replace('/', "_"), size));
    let mut columns = Vec::new();
    for place in 1..=places {
        for (name, (unit, size)) in VALUE_NAMES.iter().zip(&of_value) {
            columns.push((format!("{}{name}_mean_{unit}", of_place(place)), *size));
        }
    }
    for (name, (unit, size)) in VALUE_NAMES.iter().zip(&of_value) {
        columns.push((format!("{name}_sd_{unit}"), *size));
    }
    let (long, metre) = units.length();
    columns.extend([
        (format!("c10_{long}_s"), metre),
        ("c11".to_owned(), 1.0),
        (format!("c12_s_{long}"), 1.0 / metre),
        ("tail_weight".to_owned(), 1.0),
    ]);
    columns.extend(pairs().map(|(i, j)| (format!("corr_{}", pair_name(i, j)), 1.0)));
    columns.push(("hoop_restitution".to_owned(), 1.0));
    for place in 1..=places {
        for (name, (unit, size)) in VALUE_NAMES.iter().zip(&of_value) {
            let column = format!("{}{name}_reads_high_by_{unit}", of_place(place));
            columns.push((column, *size));
        }
    }
    columns
}

/// What the names of a place's columns begin with, as in `fit.json`: nothing at the first place.
fn of_place(place: usize) -> String {
    if place == 1 {
        String::new()
    } else {
        format!("place_{place}_")
    }
}

/// The columns that are written only for readers: P of the current shot of each draw, and its
/// number as programs for draws want it (ArviZ: `chain`, `draw`).
fn names_for_readers(places: usize) -> Vec<String> {
    let probabilities = (1..=places).map(|place| format!("{}probability", of_place(place)));
    let numbers = ["chain", "draw"].map(str::to_owned);
    probabilities.chain(numbers).collect()
}

/// The bytes of the file. `probabilities` are those of the draws at each place.
///
/// # Errors
/// The writer failed.
pub fn draws_parquet(
    posterior: &Posterior,
    probabilities: &[DrawProbabilities],
    units: UnitSystem,
) -> parquet::errors::Result<Vec<u8>> {
    let places = posterior.draws[0].means.len();
    let columns = columns(places, units);
    let described = columns
        .iter()
        .map(|(name, _)| name.clone())
        .chain(names_for_readers(places))
        .map(|name| match name.as_str() {
            "chain" | "draw" => column(&name, Physical::INT64),
            _ => column(&name, Physical::DOUBLE),
        })
        .collect::<parquet::errors::Result<Vec<_>>>()?;
    let mut sink = ParquetSink::new(Vec::new(), &described)?;
    for (k, draw) in posterior.draws.iter().enumerate() {
        let mut values: Vec<f64> = draw.means.iter().flatten().copied().collect();
        values.extend(draw.sds);
        values.extend(draw.speed_coefficients);
        values.push(draw.tail_weight);
        values.extend(pairs().map(|(i, j)| draw.correlation[(i, j)]));
        values.push(draw.ring_restitution.unwrap_or(0.0));
        values.extend(draw.constant_errors.iter().flatten());
        for (value, (_, size)) in values.iter_mut().zip(&columns) {
            *value /= size;
        }
        values.extend(probabilities.iter().map(|place| place.of_draws[k]));
        let mut cells: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
        cells.extend(["0".to_owned(), k.to_string()]);
        sink.push(cells.into())?;
    }
    sink.finish()
}

/// The posterior of a file of draws, made from `shots` shots.
///
/// # Errors
/// What is wrong with the file.
pub fn read_draws(file: File, spin: SpinSource, shots: usize) -> Result<Posterior, String> {
    let mut rows = ParquetRows::open(file).map_err(|error| error.to_string())?;
    let header: Vec<String> = rows
        .header()
        .iter()
        .map(|cell| String::from_utf8_lossy(cell).into_owned())
        .collect();
    let places = header
        .iter()
        .filter(|name| name.contains("speed_mean_"))
        .count();
    let is_header = |columns: &[(String, f64)]| {
        let names = columns.iter().map(|(name, _)| name.clone());
        names
            .chain(names_for_readers(places))
            .eq(header.iter().cloned())
    };
    let known = [UnitSystem::Imperial, UnitSystem::Metric].map(|units| columns(places, units));
    let columns = known.iter().find(|columns| is_header(columns));
    let Some(columns) = columns.filter(|_| places > 0) else {
        return Err(
            "is not a file of draws that this version of `bankshot fit` wrote; fit again"
                .to_owned(),
        );
    };
    let mut draws = Vec::new();
    loop {
        let block = rows
            .next_rows(BLOCK.0, BLOCK.1)
            .map_err(|error| error.to_string())?;
        if block.is_empty() {
            break;
        }
        for row in block {
            let cells = row.cells?;
            let values = cells
                .iter()
                .map(|cell| {
                    let text = String::from_utf8_lossy(cell);
                    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
                    value.ok_or_else(|| format!("draw {}: \"{text}\" is not a number", row.number))
                })
                .collect::<Result<Vec<f64>, String>>()?;
            let value = |i: usize| values[i] * columns[i].1;
            let means: Vec<Values> = (0..places)
                .map(|place| std::array::from_fn(|i| value(4 * place + i)))
                .collect();
            let after = 4 * places;
            let mut correlation = SMatrix::<f64, 4, 4>::identity();
            for (k, (i, j)) in pairs().enumerate() {
                correlation[(i, j)] = value(after + 8 + k);
                correlation[(j, i)] = correlation[(i, j)];
            }
            let draw = Draw::new(
                means,
                std::array::from_fn(|i| value(after + i)),
                correlation,
                std::array::from_fn(|i| value(after + 4 + i)),
            );
            let tail_weight = value(after + 7);
            if !(0.0..0.5).contains(&tail_weight) {
                return Err(format!(
                    "draw {}: tail_weight {tail_weight} must be from 0 to below 0.5",
                    row.number
                ));
            }
            let ring = Some(value(after + 14)).filter(|ring| *ring > 0.0);
            if ring.is_some_and(|ring| !(0.0..=1.0).contains(&ring)) {
                return Err(format!(
                    "draw {}: hoop_restitution must be from 0 to 1",
                    row.number
                ));
            }
            let errors = |place| std::array::from_fn(|i| value(after + 15 + 4 * place + i));
            let draw = draw
                .with_tail_weight(tail_weight)
                .with_ring(ring)
                .with_constant_errors((0..places).map(errors).collect());
            draws.push(draw.rounded());
        }
    }
    if draws.is_empty() {
        return Err("has no draws".to_owned());
    }
    Ok(Posterior {
        draws,
        spin,
        r_hat: 1.0,
        bulk_effective_sample_size: f64::NAN,
        tail_effective_sample_size: f64::NAN,
        prior_weights: [f64::NAN; 4],
        growth_terms: 0,
        shots,
        unseen: None,
        priors: Vec::new(),
    })
}
