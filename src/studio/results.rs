//! Fits and sweeps of the folder.

use super::folder::{fit_folder, sweep_folder};
use super::refusal::Refusal;
use super::site::Site;
use crate::answers::json::in_si;
use crate::shooter::Nominal;
use crate::store::fit::{FIT_FILE, profile_file};
use crate::sweep::columns;
use crate::sweep::job_list::Jobs;
use crate::sweep::probability_by_place::PlaceProbabilities;
use crate::sweep::result_row::ResultRow;
use crate::sweep::sweep_folder::SweepFolder;
use crate::sweep::{SweepConfig, is_locked};
use axum::Json;
use axum::extract::{Path as UrlPath, State};
use axum::http::StatusCode;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The file of the advice of a fit.
pub(super) const ADVICE_FILE: &str = "advice.json";

fn read_json(path: &Path) -> Option<Value> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// The advice beside a fit, if it is not older than the fit: one object for each place.
fn advice(folder: &Path) -> Option<Vec<Value>> {
    let written = |name: &str| std::fs::metadata(folder.join(name)).ok()?.modified().ok();
    if written(ADVICE_FILE)? < written(FIT_FILE)? {
        return None;
    }
    let text = std::fs::read(folder.join(ADVICE_FILE)).ok()?;
    let objects = serde_json::Deserializer::from_slice(&text).into_iter::<Value>();
    objects.collect::<Result<_, _>>().ok()
}

/// A fit, the profile of each of its places, and its advice if it was asked for.
pub(super) async fn fit(
    State(site): State<Arc<Site>>,
    UrlPath(name): UrlPath<String>,
) -> Result<Json<Value>, Refusal> {
    let folder = fit_folder(&site, &name)?;
    let fit = read_json(&folder.join(FIT_FILE)).ok_or_else(|| {
        Refusal::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            format!("{name}: its fit.json is damaged; fit the player again"),
        )
    })?;
    let profiles =
        (0..).map_while(|place| std::fs::read_to_string(folder.join(profile_file(place))).ok());
    let profiles: Vec<String> = profiles.collect();
    Ok(Json(json!({
        "name": name,
        "fit": fit,
        "profiles": profiles,
        "advice": advice(&folder).unwrap_or_default(),
    })))
}

/// The best shots at a place, SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct PlaceResult {
    /// From the hoop's centre to midcourt.
    x_m: f64,
    /// To the right, facing the hoop.
    y_m: f64,
    /// Its name, if the sweep gives one.
    name: Option<String>,
    /// Makes of the best direct shot, as a fraction; `None` while it is not known, or without one.
    direct: Option<f64>,
    /// Makes of the best bank shot.
    bank: Option<f64>,
    /// The best direct shot.
    direct_shot: Option<Nominal>,
    /// The best bank shot.
    bank_shot: Option<Nominal>,
    /// The gain of the best backspin over none, of the better kind.
    spin_gain: Option<f64>,
}

/// A sweep as far as it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct SweepState {
    /// Its name.
    name: String,
    /// The court whose lines it has.
    court: &'static str,
    /// The jobs, and those that are done.
    jobs: usize,
    done: usize,
    /// Whether a process works on it.
    is_running: bool,
    /// The text of its shooter's profile, if it has a file of its own.
    shooter_toml: Option<String>,
    /// The places.
    places: Vec<PlaceResult>,
    /// What is damaged, in words.
    remarks: Vec<String>,
}

/// The gain of the best backspin over none at each place, of the kind with more makes.
fn spin_gain(jobs: &Jobs, rows: &BTreeMap<u64, ResultRow>, place: usize) -> Option<f64> {
    let source = jobs.sources.get(place)?;
    let of_kinds = (0..jobs.kinds.len()).filter_map(|kind| {
        let row = rows.get(&jobs.number(source.computed, kind))?;
        let probability = row.probability()?.value;
        Some((probability, row.real(columns::BEST_BACKSPIN_OVER_NONE)?))
    });
    of_kinds
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, gain)| gain)
}

fn places(config: &SweepConfig, rows: &BTreeMap<u64, ResultRow>) -> Vec<PlaceResult> {
    let jobs = Jobs::new(config);
    let all = PlaceProbabilities::of_sweep(config, rows).into_iter();
    all.enumerate()
        .map(|(index, place)| {
            let [direct_shot, bank_shot] = place.nominals;
            PlaceResult {
                x_m: place.place.x_m,
                y_m: place.place.y_m,
                name: place.name,
                direct: place.direct.map(|p| p.value),
                bank: place.bank.map(|p| p.value),
                direct_shot,
                bank_shot,
                spin_gain: spin_gain(&jobs, rows, index),
            }
        })
        .collect()
}

fn state(path: &Path) -> Result<SweepState, String> {
    let refuse = |error: &dyn std::fmt::Display| error.to_string();
    let (folder, config) = SweepFolder::open_read_only(path).map_err(|e| refuse(&e))?;
    let (rows, remarks) = folder.union().map_err(|e| refuse(&e))?;
    let stores = folder.stores().map_err(|e| refuse(&e))?;
    let mut locks = stores.iter().map(|store| store.with_extension("lock"));
    let own = path.parent().map(|parent| parent.join("shooter.toml"));
    Ok(SweepState {
        name: config.name.clone(),
        court: config.league.name(),
        jobs: Jobs::new(&config).count(),
        done: rows.len(),
        is_running: locks.any(|lock| is_locked(&lock)),
        shooter_toml: own.and_then(|file| std::fs::read_to_string(file).ok()),
        places: places(&config, &rows),
        remarks,
    })
}

/// A sweep with the results so far.
pub(super) async fn sweep(
    State(site): State<Arc<Site>>,
    UrlPath(name): UrlPath<String>,
) -> Result<Json<Value>, Refusal> {
    let folder = sweep_folder(&site, &name)?;
    let state = tokio::task::spawn_blocking(move || state(&folder)).await;
    match state {
        Ok(Ok(state)) => Ok(Json(in_si(&state))),
        Ok(Err(words)) => Err(Refusal::bad(words)),
        Err(_) => Err(Refusal::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            format!("{name}: cannot be read"),
        )),
    }
}
