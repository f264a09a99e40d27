//! `bankshot sweep`, `status`, `verify`, `missing` and `merge`: best shots at many places.

use super::arguments::{FolderOptions, MergeOptions, MissingOptions, SweepOptions, VerifyOptions};
use super::best::named_folder;
use super::failure::{Failure, code};
use super::plan::read_text;
use super::progress::Bars;
use super::signals;
use super::terminal::{answer, tell};
use bankshot::output::{self, files};
use bankshot::plan::{Plan, PlanError};
use bankshot::probability::{BATCH_BYTES, Progress};
use bankshot::sweep::configuration::{Texts, names, parse_sweep};
use bankshot::sweep::folder::{Folder, is_held};
use bankshot::sweep::jobs::{Jobs, Shard};
use bankshot::sweep::row::{Cell, Row, Status};
use bankshot::sweep::run::{self, Fault, Options, Run};
use bankshot::sweep::tables::Tables;
use bankshot::sweep::{Configuration, store};
use bankshot::units::DEGREE_RAD;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Jobs that are safe on disk, for the word on leaving.
static DONE: AtomicUsize = AtomicUsize::new(0);

/// Reads a sweep and the files that it names, found beside it.
pub(crate) fn load(path: &Path) -> Result<(Configuration, Texts), Failure> {
    let sweep = read_text(path)?;
    let names = names(&sweep);
    let beside = |name: Option<String>| {
        let folder = path.parent().unwrap_or(Path::new("."));
        name.map(|name| read_text(&folder.join(name))).transpose()
    };
    let texts = Texts {
        shooter: beside(names.shooter)?,
        places: beside(names.places)?,
        sweep,
    };
    let configuration = parse_sweep(&texts, &path.display().to_string())?;
    Ok((configuration, texts))
}

/// Places on which the forecast is calibrated at most; of a small sweep a quarter.
const CALIBRATED: usize = 8;
/// Bytes of a job in the store and in the tables, about.
const BYTES_PER_JOB: (f64, f64) = (600.0, 1100.0);

/// Says what a sweep would take.
pub(crate) fn plan(path: &Path, json: bool, quiet: bool) -> Result<u8, Failure> {
    let (configuration, _) = load(path)?;
    let jobs = Jobs::new(&configuration);
    let threads = rayon::current_num_threads();
    let places = jobs.places.len();
    let some = CALIBRATED.min(places.div_ceil(4)).max(threads.min(places));
    let chosen: Vec<usize> = (0..some)
        .map(|i| (2 * i + 1) * places / (2 * some))
        .collect();
    // From some places nothing goes in, which takes no table.
    let memory = chosen
        .iter()
        .filter_map(|&place| configuration.template.at(jobs.places[place].place()).ok())
        .find_map(|profile| match Plan::new(&profile) {
            Err(PlanError::OutOfReach) => None,
            plan => Some(plan),
        })
        .transpose()?
        .map_or(0.0, |plan| plan.memory_bytes as f64);
    let seconds = run::calibrate(&configuration, &jobs, &chosen, threads, &Bars::new(quiet))
        .map(|mean| mean * places.div_ceil(threads) as f64);
    let (store, tables) = BYTES_PER_JOB;
    let rows = (jobs.sources.len() * jobs.kinds.len()) as f64;
    let disk = store * jobs.count() as f64 + tables * rows;
    // Each thread has a table of the search or a window, and a batch of shots.
    let memory =
        threads as f64 * (2.0 * memory + BATCH_BYTES as f64) + 4000.0 * jobs.count() as f64 + 10e6;
    let mib = |bytes: f64| bytes / f64::from(1 << 20);
    answer(&if json {
        let mut record = output::provenance(&configuration.hash());
        record.push(("places".to_owned(), jobs.sources.len().into()));
        record.push(("computed_places".to_owned(), places.into()));
        record.push(("jobs".to_owned(), jobs.count().into()));
        record.push((
            "forecast_s".to_owned(),
            seconds.map_or(serde_json::Value::Null, output::number),
        ));
        record.push(("threads".to_owned(), threads.into()));
        record.push(("memory_bytes".to_owned(), output::number(memory.round())));
        record.push(("disk_bytes".to_owned(), output::number(disk.round())));
        format!("{:#}\n", output::object(record))
    } else {
        let time = seconds.map_or("unknown".to_owned(), |seconds| {
            format!(
                "about {:.0} s ({:.2} h) on {threads} threads, from {some} places",
                seconds,
                seconds / 3600.0
            )
        });
        format!(
            "places  {}, of which {places} are computed (the others are their mirror images)\njobs    {}\ntime    {time}\nmemory  about {:.0} MiB\ndisk    about {:.1} MiB\n",
            jobs.sources.len(),
            jobs.count(),
            mib(memory),
            mib(disk)
        )
    })
}

/// Where a sweep goes when nothing else is said.
pub(crate) fn usual_folder(configuration: &Configuration) -> PathBuf {
    let parent = PathBuf::from(&configuration.template.output.folder);
    parent.join(named_folder(&configuration.name, &configuration.hash()))
}

pub(crate) fn run(options: &SweepOptions, quiet: bool) -> Result<u8, Failure> {
    let (configuration, texts) = load(&options.sweep)?;
    let jobs = Jobs::new(&configuration);
    let shard = options.shard.unwrap_or(Shard::WHOLE);
    let path = options
        .out
        .clone()
        .unwrap_or_else(|| usual_folder(&configuration));
    let folder = Folder::open(&path, &configuration, &texts)?;
    let claim = folder.claim(shard)?;
    signals::note_aborts(&claim.aborted);
    let options = Options {
        shard,
        threads: rayon::current_num_threads(),
        retry: options.retry_failed,
        fault: options.fault,
    };
    let run = Run::new(&folder, &claim, &configuration, &jobs, options, &DONE)?;
    for damage in run.damaged() {
        tell(&format!("remark: {damage}"));
    }
    let (total, there) = run.extent();
    if there > 0 && !quiet {
        tell(&format!("resuming: {there} of {total} done"));
    }
    signals::say_on_leaving(move || {
        format!(
            "stopped: {} of {total} jobs are safe; the same command goes on",
            DONE.load(Ordering::Relaxed)
        )
    });
    let went = run.go(&Bars::new(quiet)).map_err(|error| {
        let safe = DONE.load(Ordering::Relaxed);
        let mut failure = Failure::from(error);
        failure.message += &format!("\n{safe} of {total} jobs are safe; the same command goes on");
        failure
    })?;
    drop(run);
    if shard == Shard::WHOLE {
        return finish(&folder, &configuration, &jobs, None, quiet);
    }
    answer(&format!(
        "shard {shard}: {total} jobs, {} there before, {} computed, {} failed; `bankshot merge {}` joins the shards\n",
        went.resumed,
        went.computed,
        went.failed,
        path.display()
    ))?;
    Ok(if went.failed > 0 {
        code::INCOMPLETE
    } else {
        code::WHOLE
    })
}

/// Writes the tables of what is there and says how it stands.
fn finish(
    folder: &Folder,
    configuration: &Configuration,
    jobs: &Jobs,
    shards: Option<usize>,
    quiet: bool,
) -> Result<u8, Failure> {
    let (rows, remarks) = folder.union()?;
    for remark in remarks {
        tell(&format!("remark: {remark}"));
    }
    let whole = rows.len() == jobs.count();
    if !whole {
        let mut text = standing(jobs, &rows);
        let array = missing_shards(jobs, &rows, shards.unwrap_or(1));
        text.push_str(&match shards {
            Some(shards) => format!("incomplete; of {shards} shards submit again: --array={array}\n"),
            None => "incomplete; the sweep's own command goes on (or give --shards to see which to submit again)\n".to_owned(),
        });
        answer(&text)?;
        return Ok(code::INCOMPLETE);
    }
    let tables = Tables::new(configuration, jobs, &rows);
    let parquet = tables
        .parquet()
        .map_err(|error| Failure::bug(format!("the Parquet table: {error}")))?;
    for (name, bytes) in [
        ("best_shots.csv", tables.csv()),
        ("best_shots.parquet", parquet),
        ("provenance.json", tables.provenance(configuration)),
    ] {
        let path = folder.path().join(name);
        files::write(&path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    answer(&(standing(jobs, &rows) + &highlights(configuration, jobs, &rows)))?;
    if !quiet {
        let path = folder.path().display();
        tell(&format!(
            "written to {path}: best_shots.csv, best_shots.parquet, provenance.json"
        ));
    }
    let target = configuration.template.standard_error();
    let missed =
        |row: &Row| matches!(row.get("standard_error"), Cell::Real(error) if *error > target);
    Ok(
        if rows
            .values()
            .any(|row| row.status() == Some(Status::Failed))
        {
            code::INCOMPLETE
        } else if rows.values().any(missed) {
            code::MISSED
        } else {
            code::WHOLE
        },
    )
}

/// How many jobs ended how, and which failed.
fn standing(jobs: &Jobs, rows: &BTreeMap<u64, Row>) -> String {
    let count = |status| {
        rows.values()
            .filter(|row| row.status() == Some(status))
            .count()
    };
    let mut text = format!(
        "{} of {} jobs there: {} found, {} without a shot that can go in, {} failed\n",
        rows.len(),
        jobs.count(),
        count(Status::Found),
        count(Status::None),
        count(Status::Failed)
    );
    let failed = rows
        .values()
        .filter(|row| row.status() == Some(Status::Failed));
    for row in failed.take(10) {
        if let (Cell::Text(kind), Cell::Real(x), Cell::Real(y), Cell::Text(reason)) = (
            row.get("kind"),
            row.get("x"),
            row.get("y"),
            row.get("reason"),
        ) {
            text.push_str(&format!(
                "failed: job {}, {kind} from x {x:.3} m, y {y:.3} m: {reason}\n",
                row.job
            ));
        }
    }
    text
}

/// The best and the worst place, and where banks win.
fn highlights(configuration: &Configuration, jobs: &Jobs, rows: &BTreeMap<u64, Row>) -> String {
    let (long, foot) = configuration.template.output.units.length();
    let p = |row: &Row| match row.get("probability") {
        Cell::Real(p) => Some(*p),
        _ => None,
    };
    let mut places: Vec<(f64, &Row)> = Vec::new();
    let (mut banks, mut both) = (0, 0);
    for source in &jobs.sources {
        let found: Vec<(f64, &Row)> = (0..jobs.kinds.len())
            .filter_map(|kind| rows.get(&jobs.number(source.place, kind)))
            .filter_map(|row| p(row).map(|p| (p, row)))
            .collect();
        if let [(direct, _), (bank, _)] = found[..] {
            both += 1;
            banks += usize::from(bank > direct);
        }
        places.extend(
            found
                .into_iter()
                .reduce(|a, b| if b.0 > a.0 { b } else { a }),
        );
    }
    let mut text = String::new();
    let ends = [
        (
            "best",
            places
                .iter()
                .copied()
                .reduce(|a, b| if b.0 > a.0 { b } else { a }),
        ),
        (
            "worst",
            places
                .iter()
                .copied()
                .reduce(|a, b| if b.0 < a.0 { b } else { a }),
        ),
    ];
    for (name, found) in ends {
        if let Some((p, row)) = found
            && let (Cell::Text(kind), Cell::Real(distance), Cell::Real(angle)) =
                (row.get("kind"), row.get("distance"), row.get("court_angle"))
        {
            text.push_str(&format!(
                "{name:5} P {p:.3}, {kind}, {:.1} {long} from the hoop at {:.0} deg\n",
                distance / foot,
                angle / DEGREE_RAD
            ));
        }
    }
    if both > 0 {
        text.push_str(&format!(
            "the bank shot is the better one at {banks} of {both} places\n"
        ));
    }
    text
}

/// The shards with jobs that are not there, as `sbatch --array` takes them.
fn missing_shards(jobs: &Jobs, rows: &BTreeMap<u64, Row>, shards: usize) -> String {
    let mut missing = vec![false; shards];
    for job in 0..jobs.count() as u64 {
        if !rows.contains_key(&job)
            && let Some((place, _)) = jobs.of(job)
        {
            missing[place % shards] = true;
        }
    }
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for shard in (0..shards)
        .filter(|&shard| missing[shard])
        .map(|shard| shard + 1)
    {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == shard => *last = shard,
            _ => ranges.push((shard, shard)),
        }
    }
    let ranges: Vec<String> = ranges
        .into_iter()
        .map(|(first, last)| {
            if first == last {
                first.to_string()
            } else {
                format!("{first}-{last}")
            }
        })
        .collect();
    ranges.join(",")
}

pub(crate) fn status(options: &FolderOptions) -> Result<u8, Failure> {
    let (folder, configuration) = Folder::to_look_at(&options.folder)?;
    let jobs = Jobs::new(&configuration);
    let (rows, remarks) = folder.union()?;
    let mut text = format!("{}\n", configuration.name) + &standing(&jobs, &rows);
    for store in folder.stores()? {
        let (done, seconds) = store::timing(&store);
        let lock = store.with_extension("lock");
        let running = is_held(&lock);
        text.push_str(&format!(
            "{}: {done} jobs, {:.2} s each{}\n",
            store.file_name().unwrap_or_default().display(),
            seconds / done.max(1) as f64,
            if running { ", running" } else { "" }
        ));
    }
    for remark in remarks {
        text.push_str(&format!("remark: {remark}\n"));
    }
    answer(&text)?;
    Ok(exit_of(&jobs, &rows))
}

/// Whole, or incomplete.
pub(crate) fn exit_of(jobs: &Jobs, rows: &BTreeMap<u64, Row>) -> u8 {
    let failed = rows
        .values()
        .any(|row| row.status() == Some(Status::Failed));
    if rows.len() < jobs.count() || failed {
        code::INCOMPLETE
    } else {
        code::WHOLE
    }
}

pub(crate) fn verify(options: &VerifyOptions, quiet: bool) -> Result<u8, Failure> {
    let (folder, configuration) = Folder::existing(&options.folder)?;
    let jobs = Jobs::new(&configuration);
    let (rows, remarks) = folder.union()?;
    let mut text = standing(&jobs, &rows);
    for remark in &remarks {
        text.push_str(&format!("damaged: {remark}\n"));
    }
    let every = options
        .recompute
        .map(|part| (1.0 / part).round().max(1.0) as usize);
    let mut differing = Vec::new();
    if let Some(every) = every {
        let chosen: Vec<&Row> = rows
            .values()
            .filter(|row| row.status() != Some(Status::Failed))
            .step_by(every)
            .collect();
        let bars = Bars::new(quiet);
        bars.begin("recomputing", chosen.len() as u64);
        for row in &chosen {
            if let Some((place, kind)) = jobs.of(row.job) {
                let again = run::evaluate(&configuration, &jobs, place, &[kind]);
                if again.ok().as_deref() != Some(std::slice::from_ref(*row)) {
                    differing.push(row.job);
                }
            }
            bars.advance(1);
        }
        bars.end();
        text.push_str(&format!(
            "recomputed {} jobs: {} differ\n",
            chosen.len(),
            differing.len()
        ));
        for job in &differing {
            text.push_str(&format!("differs: job {job}\n"));
        }
    }
    answer(&text)?;
    Ok(if !remarks.is_empty() || !differing.is_empty() {
        code::DAMAGED
    } else {
        exit_of(&jobs, &rows)
    })
}

pub(crate) fn missing(options: &MissingOptions) -> Result<u8, Failure> {
    let (folder, configuration) = Folder::to_look_at(&options.folder)?;
    let jobs = Jobs::new(&configuration);
    let (rows, _) = folder.union()?;
    let array = missing_shards(&jobs, &rows, options.shards);
    if array.is_empty() {
        return Ok(code::WHOLE);
    }
    answer(&format!("{array}\n"))?;
    Ok(code::INCOMPLETE)
}

pub(crate) fn merge(options: &MergeOptions, quiet: bool) -> Result<u8, Failure> {
    let (folder, configuration) = Folder::existing(&options.folder)?;
    let jobs = Jobs::new(&configuration);
    finish(&folder, &configuration, &jobs, options.shards, quiet)
}

/// `panic:PLACE` or `abort:PLACE`.
pub(crate) fn fault(text: &str) -> Result<Fault, String> {
    let parts = text.split_once(':');
    let place = parts.and_then(|(_, place)| place.parse().ok());
    match (parts.map(|(what, _)| what), place) {
        (Some("panic"), Some(place)) => Ok(Fault::Panic(place)),
        (Some("abort"), Some(place)) => Ok(Fault::Abort(place)),
        _ => Err("must be panic:PLACE or abort:PLACE".to_owned()),
    }
}

/// `3/64`.
pub(crate) fn shard(text: &str) -> Result<Shard, String> {
    let number = |text: &str| text.parse::<usize>().ok();
    let parts = text
        .split_once('/')
        .and_then(|(index, count)| Some((number(index)?, number(count)?)));
    match parts {
        Some((index, count)) if index >= 1 && index <= count && count <= 1_000_000 => Ok(Shard {
            index: index - 1,
            count,
        }),
        _ => Err("must be a number and how many there are, such as 3/64".to_owned()),
    }
}

/// A part such as `1%` or `0.01`.
pub(crate) fn part(text: &str) -> Result<f64, String> {
    let value = match text.strip_suffix('%') {
        Some(percent) => percent
            .trim()
            .parse::<f64>()
            .ok()
            .map(|percent| percent / 100.0),
        None => text.parse::<f64>().ok(),
    };
    match value {
        Some(value) if value > 0.0 && value <= 1.0 => Ok(value),
        _ => Err("must be a part such as 1% or 0.01, at most 100%".to_owned()),
    }
}
