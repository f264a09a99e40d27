//! `draws.parquet`: the draws of a posterior, one a row, in SI units.

use crate::fitting::{
    Draw, DrawProbabilities, Posterior, SpinSource, VALUE_NAMES, Values, pair_name,
};
use crate::output::simulation_files::parquet_rows::{ParquetRows, ParquetSink, column};
use nalgebra::SMatrix;
use parquet::basic::Type as Physical;
use std::fs::File;

const UNITS: [&str; 4] = ["m_s", "rad", "rad", "rad_s"];
const COEFFICIENTS: [&str; 3] = ["c10_m_s", "c11", "c12_s_m"];
/// Rows that are read at a time.
const BLOCK: (usize, usize) = (10_000, 16 << 20);

fn pairs() -> impl Iterator<Item = (usize, usize)> {
    (1..4).flat_map(|j| (0..j).map(move |i| (i, j)))
}

fn names(places: usize) -> Vec<String> {
    let mut names = Vec::new();
    for place in 1..=places {
        for (name, unit) in VALUE_NAMES.iter().zip(UNITS) {
            names.push(format!("place_{place}_{name}_mean_{unit}"));
        }
    }
    for (name, unit) in VALUE_NAMES.iter().zip(UNITS) {
        names.push(format!("{name}_sd_{unit}"));
    }
    names.extend(COEFFICIENTS.map(str::to_owned));
    names.push("tail_weight".to_owned());
    names.extend(pairs().map(|(i, j)| format!("corr_{}", pair_name(i, j))));
    names
}

/// The columns that are written for readers alone: P of the usual shot of each draw.
fn probability_names(places: usize) -> Vec<String> {
    (1..=places)
        .map(|place| format!("place_{place}_probability"))
        .collect()
}

/// The bytes of the file. `probabilities` are those of the draws at each place.
///
/// # Errors
/// The writer failed.
pub fn draws_parquet(
    posterior: &Posterior,
    probabilities: &[DrawProbabilities],
) -> parquet::errors::Result<Vec<u8>> {
    let places = posterior.draws[0].means.len();
    let mut names = names(places);
    names.extend(probability_names(places));
    let columns = names
        .iter()
        .map(|name| column(name, Physical::DOUBLE))
        .collect::<parquet::errors::Result<Vec<_>>>()?;
    let mut sink = ParquetSink::new(Vec::new(), &columns)?;
    for (k, draw) in posterior.draws.iter().enumerate() {
        let mut values: Vec<f64> = draw.means.iter().flatten().copied().collect();
        values.extend(draw.sds);
        values.extend(draw.speed_coefficients);
        values.push(draw.tail_weight);
        values.extend(pairs().map(|(i, j)| draw.correlation[(i, j)]));
        values.extend(probabilities.iter().map(|place| place.of_draws[k]));
        let cells: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
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
        .filter(|name| name.ends_with("_speed_mean_m_s"))
        .count();
    // The probabilities are for readers alone; a fit of an older version has none.
    let wanted = names(places);
    let (needed, more) = header.split_at(wanted.len().min(header.len()));
    if places == 0 || needed != wanted || !(more.is_empty() || more == probability_names(places)) {
        return Err("is not a file of draws that `bankshot fit` wrote".to_owned());
    }
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
            let value = |i: usize| values[i];
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
            draws.push(draw.with_tail_weight(tail_weight));
        }
    }
    if draws.is_empty() {
        return Err("has no draws".to_owned());
    }
    Ok(Posterior {
        draws,
        spin,
        r_hat: 1.0,
        effective_sample_size: f64::NAN,
        prior_weights: [f64::NAN; 4],
        growth_terms: 0,
        shots,
    })
}
