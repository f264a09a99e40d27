//! `bankshot sweep --plan`: jobs, time, memory and disk.

use crate::answers::checks::SweepPlanAnswer;
use crate::answers::json;
use crate::cli::config_files::load_sweep;
use crate::cli::failure::Failure;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, time_in_words};
use crate::probability::MAX_BATCH_BYTES;
use crate::search_space::{PlanError, TablePlan};
use crate::sweep::SweepConfig;
use crate::sweep::job_list::Jobs;
use crate::sweep::run::mean_spot_time_s;
use std::path::Path;
use std::time::Duration;

/// Greatest number of spots that the forecast is based on, unless there are more threads.
const MAX_CALIBRATION_SPOTS: usize = 8;
/// After this time no more spots are begun.
const BUDGET: Duration = Duration::from_millis(900);
/// About the size of a job in the store, and of a row in the tables, bytes.
const STORE_BYTES_PER_JOB: f64 = 600.0;
/// See [`STORE_BYTES_PER_JOB`].
const TABLE_BYTES_PER_ROW: f64 = 1100.0;
/// About the memory of a job, and of the program itself, bytes.
const MEMORY_BYTES_PER_JOB: f64 = 4000.0;
/// See [`MEMORY_BYTES_PER_JOB`].
const PROGRAM_BYTES: f64 = 10e6;

pub(crate) fn run(path: &Path, as_json: bool) -> Result<u8, Failure> {
    let (config, _) = load_sweep(path)?;
    let jobs = Jobs::new(&config);
    let threads = rayon::current_num_threads();
    let spots = jobs.spots.len();
    let chosen = calibration_spots(&jobs);
    let table_bytes = table_bytes(&config, &jobs, &chosen)?;
    let forecast = forecast(&config, &jobs, &chosen, &ProgressBars::new());
    let seconds = forecast.map(|(seconds, _)| seconds);
    let calibrated = forecast.map_or(0, |(_, computed)| computed);
    let rows = (jobs.sources.len() * jobs.kinds.len()) as f64;
    let disk = STORE_BYTES_PER_JOB * jobs.count() as f64 + TABLE_BYTES_PER_ROW * rows;
    // Each thread has a table of the search or a window, and a batch of shots.
    let memory = threads as f64 * (2.0 * table_bytes + MAX_BATCH_BYTES as f64)
        + MEMORY_BYTES_PER_JOB * jobs.count() as f64
        + PROGRAM_BYTES;
    if as_json {
        let answer = SweepPlanAnswer {
            provenance: config.provenance()?,
            places: jobs.sources.len(),
            computed_places: spots,
            jobs: jobs.count(),
            forecast_s: seconds,
            threads,
            memory_bytes: memory.round(),
            disk_bytes: disk.round(),
        };
        return print_answer(&json::text(&json::document(
            &answer,
            config.settings.output.units,
        )));
    }
    let time = seconds.map_or("unknown".to_owned(), |seconds| {
        format!(
            "about {} on {threads} threads, from {calibrated} places",
            time_in_words(seconds)
        )
    });
    let which = if config.is_mirror_symmetric() {
        format!("{spots} are computed, the others are their mirror images")
    } else {
        "all are computed: this shooter's left and right differ".to_owned()
    };
    let mib = |bytes: f64| bytes / f64::from(1 << 20);
    print_answer(&format!(
        "places  {}; {which}\njobs    {}\ntime    {time}\nmemory  about {:.0} MiB\ndisk    about {:.1} MiB\n",
        jobs.sources.len(),
        jobs.count(),
        mib(memory),
        mib(disk)
    ))
}

/// The time of a sweep on all threads, s; `None` if nothing of it could be computed.
pub(super) fn forecast_s(config: &SweepConfig) -> Option<f64> {
    let jobs = Jobs::new(config);
    let chosen = calibration_spots(&jobs);
    forecast(config, &jobs, &chosen, &ProgressBars::hidden()).map(|(seconds, _)| seconds)
}

/// The time of a sweep, s, and how many of the `chosen` spots it was measured at.
fn forecast(
    config: &SweepConfig,
    jobs: &Jobs,
    chosen: &[usize],
    bars: &ProgressBars,
) -> Option<(f64, usize)> {
    let threads = rayon::current_num_threads();
    let (mean_s, computed) = mean_spot_time_s(config, jobs, chosen, threads, BUDGET, bars)?;
    Some((mean_s * jobs.spots.len() as f64, computed))
}

/// The spots that a forecast is based on.
fn calibration_spots(jobs: &Jobs) -> Vec<usize> {
    let spots = jobs.spots.len();
    let most = MAX_CALIBRATION_SPOTS.max(rayon::current_num_threads());
    spread_out(spots, most.min(spots))
}

/// `count` of `total` spots, far apart, in an order in which the first few are far apart too: the
/// van der Corput sequence, from the middle on.
fn spread_out(total: usize, count: usize) -> Vec<usize> {
    let mut spots: Vec<usize> = Vec::new();
    for k in 1_u32.. {
        if spots.len() == count.min(total) {
            break;
        }
        // The reversed bits are a fraction of 2^32.
        let spot = ((u64::from(k.reverse_bits()) * total as u64) >> 32) as usize;
        if !spots.contains(&spot) {
            spots.push(spot);
        }
    }
    spots
}

/// Memory of the table of a spot, bytes. From some spots nothing can go in; they have no table.
fn table_bytes(config: &SweepConfig, jobs: &Jobs, chosen: &[usize]) -> Result<f64, Failure> {
    let plan = chosen
        .iter()
        .filter_map(|&spot| config.settings.at(jobs.spots[spot].location()).ok())
        .find_map(|profile| match TablePlan::for_search(&profile) {
            Err(PlanError::OutOfReach { .. }) => None,
            plan => Some(plan),
        })
        .transpose()?;
    Ok(plan.map_or(0.0, |plan| plan.memory_bytes as f64))
}
