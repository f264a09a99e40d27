//! Long work: commands of the program, one after the other, each with its progress.
//!
//! A job is what a user would type: its requests become the flags of a command, which runs as it
//! does in a terminal. What it has finished is in the folder, whatever happens to the page or to
//! the server.

use super::folder::{Content, UPLOADS, check_new_name, fit_folder, shot_flags, upload};
use super::questions::read_json;
use super::refusal::Refusal;
use super::results::ADVICE_FILE;
use super::site::Site;
use crate::answers::requests::ProfileRequest;
use crate::answers::shot_file::ShotFileRequest;
use crate::escape::toml_string;
use crate::files::atomic_file;
use crate::probability::Progress;
use axum::Json;
use axum::body::{Body, Bytes};
use axum::extract::{Path as UrlPath, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::sync::watch;

/// Jobs that are remembered.
const MAX_JOBS: usize = 50;
/// Jobs that may wait.
const MAX_WAITING: usize = 20;
/// Between two messages about the jobs, and while nothing changes.
const PAUSE: Duration = Duration::from_millis(150);
const HEARTBEAT: Duration = Duration::from_secs(10);

/// What a command said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Finished {
    /// Its exit code.
    pub exit_code: u8,
    /// What it would print on standard output.
    pub answer: Vec<u8>,
    /// What it would print on standard error.
    pub remarks: String,
}

/// How commands are run, and how one is stopped from within a call of its progress.
#[derive(Clone, Copy)]
pub struct Commands {
    /// Runs one; the first argument is the name of the program.
    pub run: fn(&[String], Arc<dyn Progress + Send>) -> Finished,
    /// Stops it.
    pub stop: fn() -> !,
}

/// Long work that the page asks for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(tag = "job", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum JobRequest {
    /// A fit of every player in some files, a sheet to print, and the advice for each.
    Players {
        /// The folder of the results.
        name: String,
        /// The uploaded files.
        files: Vec<String>,
        /// The sessions that are fitted; all, if none is named.
        #[serde(default)]
        sessions: Vec<String>,
        /// Whether older results of this name are replaced.
        #[serde(default)]
        replace: bool,
        /// What they do not say by themselves.
        #[serde(default)]
        shots: ShotFileRequest,
    },
    /// What a fitted player should change.
    Advise {
        /// The folder of the fit.
        name: String,
    },
    /// The page and the posters of a team, over the places of the court.
    Team {
        /// The folder of the results.
        name: String,
        /// The folders of the players' fits.
        fits: Vec<String>,
    },
    /// Two sessions compared.
    Compare {
        /// The folder of the results.
        name: String,
        /// The uploaded file.
        file: String,
        /// The two sessions, the earlier one first.
        sessions: Vec<String>,
        /// The player, for a file with several.
        #[serde(default)]
        shooter: Option<String>,
        /// What the file does not say by itself.
        #[serde(default)]
        shots: ShotFileRequest,
    },
    /// The best shots at every place of half the court.
    Sweep {
        /// The folder of the results.
        name: String,
        /// The shooter.
        profile: ProfileRequest,
        /// The spacing of the places, such as `3 ft`.
        step: String,
        /// Whether places beyond the three-point line are left out.
        inside_three: bool,
        /// Whether the gain from spin is computed too.
        #[serde(default)]
        spin: bool,
    },
    /// The rest of a sweep that was stopped.
    Continue {
        /// The name of the sweep.
        name: String,
    },
    /// A launcher's table, as text, CSV and sources.
    Table {
        /// The folder of the results.
        name: String,
        /// The launcher.
        profile: ProfileRequest,
        /// Distances, such as `7 ft to 20 ft by 1 ft`.
        distances: String,
        /// The kind of the shots: `direct`, `bank` or `best`.
        kind: String,
        /// A fixed angle.
        #[serde(default)]
        pitch: Option<String>,
        /// A fixed backspin.
        #[serde(default)]
        backspin: Option<String>,
        /// A first look without checks between the places.
        #[serde(default)]
        draft: bool,
        /// Whether an older table of this name is replaced.
        #[serde(default)]
        replace: bool,
    },
}

/// How far a job is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub(super) enum Stage {
    Waiting,
    Running,
    Done,
    Failed,
    Stopped,
}

/// A job as the page shows it.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Job {
    /// Its number.
    id: u64,
    /// What was asked for.
    request: JobRequest,
    /// How far it is.
    stage: Stage,
    /// What it does now, such as `simulating`.
    step: String,
    /// Units of this step that are done, and all.
    done: u64,
    total: u64,
    /// The exit code of the command.
    exit_code: Option<u8>,
    /// What the command prints.
    answer: String,
    /// What it says beside: warnings, and the error if there is one.
    remarks: String,
    /// The folder of the results.
    folder: String,
    #[serde(skip)]
    #[cfg_attr(test, schemars(skip))]
    is_stopped: Arc<AtomicBool>,
}

#[derive(Default)]
struct List {
    jobs: VecDeque<Job>,
    next_id: u64,
}

/// All jobs of this start.
pub(super) struct Jobs {
    inner: Arc<Inner>,
}

struct Inner {
    commands: Commands,
    folder: PathBuf,
    list: Mutex<List>,
    wake: Condvar,
    changes: watch::Sender<u64>,
}

impl Inner {
    fn list(&self) -> MutexGuard<'_, List> {
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn changed(&self) {
        self.changes.send_modify(|count| *count += 1);
    }

    /// Changes a job, if it is still remembered.
    fn change(&self, id: u64, change: impl FnOnce(&mut Job)) {
        if let Some(job) = self.list().jobs.iter_mut().find(|job| job.id == id) {
            change(job);
        }
        self.changed();
    }

    /// Runs one job after the other.
    fn work(self: Arc<Self>) {
        loop {
            let (id, request, is_stopped) = {
                let mut list = self.list();
                loop {
                    let waiting = list.jobs.iter_mut().find(|job| job.stage == Stage::Waiting);
                    if let Some(job) = waiting {
                        job.stage = Stage::Running;
                        break (job.id, job.request.clone(), Arc::clone(&job.is_stopped));
                    }
                    list = self.wake.wait(list).unwrap_or_else(PoisonError::into_inner);
                }
            };
            self.changed();
            let progress: Arc<dyn Progress + Send> = Arc::new(JobProgress {
                id,
                jobs: Arc::clone(&self),
                is_stopped: Arc::clone(&is_stopped),
                last: Mutex::new(std::time::Instant::now()),
            });
            let finished = self.run(&request, &progress);
            self.change(id, |job| {
                job.stage = match finished.exit_code {
                    _ if is_stopped.load(Ordering::Relaxed) => Stage::Stopped,
                    // Less precise than wanted, or rows left out: there is a result.
                    0 | 1 | 3 => Stage::Done,
                    _ => Stage::Failed,
                };
                job.exit_code = Some(finished.exit_code);
                job.answer = String::from_utf8_lossy(&finished.answer).into_owned();
                job.remarks = finished.remarks;
            });
        }
    }

    fn run(&self, request: &JobRequest, progress: &Arc<dyn Progress + Send>) -> Finished {
        let run = |arguments: &[String]| {
            let program = std::iter::once("bankshot".to_owned());
            let all: Vec<String> = program.chain(arguments.iter().cloned()).collect();
            (self.commands.run)(&all, Arc::clone(progress))
        };
        let arguments = match request.arguments(&self.folder) {
            Ok(arguments) => arguments,
            Err(remarks) => {
                return Finished {
                    exit_code: 74,
                    answer: Vec::new(),
                    remarks,
                };
            }
        };
        let mut finished = run(&arguments);
        let keep = |answer: &[u8], file: PathBuf| match atomic_file::write(&file, answer) {
            Ok(()) => String::new(),
            Err(error) => format!("{}: {error}\n", file.display()),
        };
        let folder = self.folder.join(request.folder());
        match request {
            _ if ![0, 3].contains(&finished.exit_code) => {}
            JobRequest::Players { .. } => {
                let moved = replace(&self.folder.join(request.staging()), &folder);
                if let Err(error) = moved {
                    finished.exit_code = 74;
                    finished.remarks += &format!("{}: {error}\n", folder.display());
                    return finished;
                }
                let players = format!("{}/", request.folder());
                let fits = Content::of(&self.folder).fits.into_iter();
                for fit in fits.filter(|fit| fit.starts_with(&players)) {
                    let folder = self.folder.join(&fit);
                    let advice = run(&["advise".into(), text(&folder), "--json".into()]);
                    finished.remarks += &match advice.exit_code {
                        0 => keep(&advice.answer, folder.join(ADVICE_FILE)),
                        _ => advice.remarks,
                    };
                }
            }
            JobRequest::Advise { .. } => {
                finished.remarks += &keep(&finished.answer, folder.join(ADVICE_FILE));
            }
            JobRequest::Compare { .. } => {
                finished.remarks += &keep(&finished.answer, folder.join("sessions.txt"));
            }
            _ => {}
        }
        finished
    }
}

/// Moves a folder to a place where an older one may be.
fn replace(new: &Path, old: &Path) -> std::io::Result<()> {
    if old.exists() {
        std::fs::remove_dir_all(old)?;
    }
    std::fs::rename(new, old)
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

/// Writes a file that a command reads.
fn write(path: &Path, content: &str) -> Result<(), String> {
    let refuse = |error: std::io::Error| format!("{}: {error}", path.display());
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(refuse)?;
    }
    atomic_file::write(path, content.as_bytes()).map_err(refuse)
}

impl JobRequest {
    /// Whether everything is as it must be.
    fn check(&self, site: &Site) -> Result<(), Refusal> {
        if let Self::Continue { name } = self {
            let file = site.folder.join(format!("sweeps/{name}/sweep.toml"));
            check_new_name("name", name)?;
            return match file.is_file() {
                true => Ok(()),
                false => Err(Refusal::not_found(name)),
            };
        }
        if let Self::Advise { name } = self {
            return fit_folder(site, name).map(drop);
        }
        check_new_name("name", self.name())?;
        // The studio was killed before it had written what a sweep is to do.
        let folder = site.folder.join(self.folder());
        let is_empty = matches!(self, Self::Sweep { .. }) && !folder.join("sweep.toml").exists();
        if !self.replaces() && !is_empty && folder.exists() {
            return Err(Refusal::new(
                StatusCode::CONFLICT,
                format!(
                    "there are results named {} already; choose another name",
                    self.name()
                ),
            ));
        }
        let text_of = |profile: &ProfileRequest| -> Result<(), Refusal> {
            let text = profile.text()?;
            crate::config::parse_profile(&text, "the profile")
                .map_err(crate::answers::requests::RequestError::from)?;
            Ok(())
        };
        match self {
            Self::Players { files, shots, .. } => {
                if files.is_empty() {
                    return Err(Refusal::field("files", "must name a file at least"));
                }
                shot_flags(shots)?;
                files
                    .iter()
                    .try_for_each(|file| upload(&site.folder, file).map(drop))
            }
            Self::Compare {
                file,
                shots,
                sessions,
                ..
            } => {
                if !matches!(sessions.len(), 0 | 2) {
                    return Err(Refusal::field("sessions", "must be two"));
                }
                shot_flags(shots)?;
                upload(&site.folder, file).map(drop)
            }
            Self::Team { fits, .. } => {
                let known = Content::of(&site.folder).fits;
                match fits.iter().find(|fit| !known.contains(fit)) {
                    Some(unknown) => Err(Refusal::not_found(unknown)),
                    None if fits.is_empty() => {
                        Err(Refusal::field("fits", "must name a player at least"))
                    }
                    None => Ok(()),
                }
            }
            Self::Sweep { profile, step, .. } => {
                text_of(profile)?;
                crate::units::parse(step, crate::units::Dimension::Length)
                    .map_err(|error| Refusal::field("step", error.to_string()))?;
                Ok(())
            }
            Self::Table { profile, .. } => text_of(profile),
            Self::Continue { .. } | Self::Advise { .. } => Ok(()),
        }
    }

    /// Whether older results of the name may be there.
    fn replaces(&self) -> bool {
        match self {
            Self::Players { replace, .. } | Self::Table { replace, .. } => *replace,
            Self::Sweep { .. } => false,
            Self::Compare { .. } | Self::Team { .. } | Self::Continue { .. } => true,
            Self::Advise { .. } => true,
        }
    }

    fn name(&self) -> &str {
        match self {
            Self::Players { name, .. }
            | Self::Advise { name }
            | Self::Team { name, .. }
            | Self::Compare { name, .. }
            | Self::Sweep { name, .. }
            | Self::Continue { name }
            | Self::Table { name, .. } => name,
        }
    }

    /// The folder of the results, from the folder of the studio.
    fn folder(&self) -> String {
        let parent = match self {
            // The folder of the fit itself.
            Self::Advise { name } => return name.clone(),
            Self::Players { .. } => "players",
            Self::Team { .. } => "teams",
            Self::Compare { .. } => "sessions",
            Self::Sweep { .. } | Self::Continue { .. } => "sweeps",
            Self::Table { .. } => "launchers",
        };
        format!("{parent}/{}", self.name())
    }

    /// Where the fits of players are written before they replace older ones: a hidden folder.
    fn staging(&self) -> String {
        format!("players/.{}.new", self.name())
    }

    /// What to type.
    fn arguments(&self, base: &Path) -> Result<Vec<String>, String> {
        let folder = base.join(self.folder());
        let within = |name: &str| text(&folder.join(name));
        let in_words = |refusal: Refusal| refusal.to_string();
        let mut all: Vec<String> = Vec::new();
        match self {
            Self::Players {
                files,
                sessions,
                shots,
                ..
            } => {
                // Older results stay until the new ones are whole.
                let staging = base.join(self.staging());
                if staging.exists() {
                    std::fs::remove_dir_all(&staging)
                        .map_err(|error| format!("{}: {error}", staging.display()))?;
                }
                let files = files
                    .iter()
                    .map(|file| text(&base.join(UPLOADS).join(file)));
                all.push("coach".into());
                all.extend(files);
                all.extend(["--no-court".into(), "--accept".into()]);
                all.extend(sessions.iter().map(|name| format!("--session={name}")));
                all.extend(shot_flags(shots).map_err(in_words)?);
                all.push(format!("--output={}", text(&staging)));
            }
            Self::Advise { .. } => {
                all.extend(["advise".into(), text(&folder), "--json".into()]);
            }
            Self::Compare {
                file,
                sessions,
                shooter,
                shots,
                ..
            } => {
                std::fs::create_dir_all(&folder)
                    .map_err(|error| format!("{}: {error}", folder.display()))?;
                all.extend(["compare".into(), text(&base.join(UPLOADS).join(file))]);
                all.push("--accept".into());
                all.extend(sessions.iter().map(|name| format!("--session={name}")));
                all.extend(shooter.iter().map(|name| format!("--shooter={name}")));
                all.extend(shot_flags(shots).map_err(in_words)?);
                all.push(format!("--plot={}", within("sessions.svg")));
            }
            Self::Team { fits, .. } => {
                let sweep = folder.join("sweep.toml");
                write(
                    &sweep,
                    &format!(
                        include_str!("../cli/commands/new_templates/coach_sweep.toml"),
                        court = "ncaa",
                        units = "imperial"
                    ),
                )?;
                all.push("team".into());
                all.extend(fits.iter().map(|fit| text(&base.join(fit))));
                all.push(format!("--sweep={}", text(&sweep)));
                all.push(format!("--output={}", text(&folder)));
            }
            Self::Sweep {
                name,
                profile,
                step,
                inside_three,
                spin,
            } => {
                let profile = profile.text().map_err(|error| error.to_string())?;
                write(&folder.join("shooter.toml"), &profile)?;
                let mut sweep = format!(
                    "# Written by the studio.\n[sweep]\nname = {}\nshooter = \"shooter.toml\"\n\
                     compute = [\"direct\", \"bank\"{}]\nregion = \"half_court\"\nstep = {}\n",
                    toml_string(name),
                    if *spin { ", \"spin\"" } else { "" },
                    toml_string(step),
                );
                if *inside_three {
                    sweep += "within = \"three_point_line\"\n";
                }
                sweep += "\n[search]\nstandard_error = 0.002\n";
                write(&folder.join("sweep.toml"), &sweep)?;
                all.extend(["sweep".into(), within("sweep.toml")]);
                all.push(format!("--output={}", within("results")));
            }
            Self::Continue { .. } => {
                all.extend(["sweep".into(), within("sweep.toml")]);
                all.push(format!("--output={}", within("results")));
            }
            Self::Table {
                profile,
                distances,
                kind,
                pitch,
                backspin,
                draft,
                ..
            } => {
                let profile = profile.text().map_err(|error| error.to_string())?;
                write(&folder.join("launcher.toml"), &profile)?;
                all.extend(["table".into(), within("launcher.toml")]);
                all.push(format!("--distances={distances}"));
                all.push(format!("--kind={kind}"));
                all.extend(pitch.iter().map(|value| format!("--pitch={value}")));
                all.extend(backspin.iter().map(|value| format!("--backspin={value}")));
                if *draft {
                    all.push("--draft".into());
                }
                let outputs = ["table.txt", "table.csv", "table.json", "ShotTable.java"];
                let outputs = outputs
                    .into_iter()
                    .chain(["shot_table.hpp", "shot_table.py"]);
                all.extend(outputs.map(|file| format!("--output={}", within(file))));
            }
        }
        Ok(all)
    }
}

/// The progress of the running job.
struct JobProgress {
    id: u64,
    jobs: Arc<Inner>,
    is_stopped: Arc<AtomicBool>,
    /// When the page was told last.
    last: Mutex<std::time::Instant>,
}

impl JobProgress {
    fn check(&self) {
        if self.is_stopped.load(Ordering::Relaxed) {
            (self.jobs.commands.stop)();
        }
    }
}

impl Progress for JobProgress {
    fn begin(&self, stage: &str, total: u64) {
        self.check();
        self.jobs.change(self.id, |job| {
            stage.clone_into(&mut job.step);
            (job.done, job.total) = (0, total);
        });
    }

    fn advance(&self, units: u64) {
        self.check();
        let mut list = self.jobs.list();
        if let Some(job) = list.jobs.iter_mut().find(|job| job.id == self.id) {
            job.done = (job.done + units).min(job.total);
        }
        drop(list);
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() >= PAUSE {
            *last = std::time::Instant::now();
            self.jobs.changed();
        }
    }

    fn end(&self) {}
}

impl Jobs {
    pub(super) fn new(commands: Commands, folder: PathBuf) -> Self {
        let inner = Arc::new(Inner {
            commands,
            folder,
            list: Mutex::default(),
            wake: Condvar::new(),
            changes: watch::channel(0).0,
        });
        let worker = Arc::clone(&inner);
        std::thread::spawn(move || worker.work());
        Self { inner }
    }

    fn all(&self) -> Vec<Job> {
        self.inner.list().jobs.iter().cloned().collect()
    }
}

pub(super) async fn list(State(jobs): State<Arc<Jobs>>) -> Json<Vec<Job>> {
    Json(jobs.all())
}

/// Adds a job behind the others.
pub(super) async fn add(
    State(site): State<Arc<Site>>,
    State(jobs): State<Arc<Jobs>>,
    body: Bytes,
) -> Result<Json<Job>, Refusal> {
    let request: JobRequest = read_json(&body)?;
    request.check(&site)?;
    let inner = &jobs.inner;
    let mut list = inner.list();
    let is_open = |job: &&Job| matches!(job.stage, Stage::Waiting | Stage::Running);
    let folder = request.folder();
    if list
        .jobs
        .iter()
        .filter(is_open)
        .any(|job| job.folder == folder)
    {
        return Err(Refusal::new(
            StatusCode::CONFLICT,
            format!(
                "{folder}: a job already writes into this folder; wait for it, or choose another name"
            ),
        ));
    }
    if list.jobs.iter().filter(is_open).count() >= MAX_WAITING {
        return Err(Refusal::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "too many jobs wait; stop one, or try again later",
        ));
    }
    list.next_id += 1;
    let job = Job {
        id: list.next_id,
        request,
        stage: Stage::Waiting,
        step: String::new(),
        done: 0,
        total: 0,
        exit_code: None,
        answer: String::new(),
        remarks: String::new(),
        folder,
        is_stopped: Arc::default(),
    };
    list.jobs.push_back(job.clone());
    while list.jobs.len() > MAX_JOBS {
        let oldest = list.jobs.iter().position(|job| !is_open(&job));
        match oldest {
            Some(index) => drop(list.jobs.remove(index)),
            None => break,
        }
    }
    drop(list);
    inner.wake.notify_one();
    inner.changed();
    Ok(Json(job))
}

/// Stops a job. What it has finished stays.
pub(super) async fn stop(
    State(jobs): State<Arc<Jobs>>,
    UrlPath(id): UrlPath<u64>,
) -> Result<StatusCode, Refusal> {
    let mut list = jobs.inner.list();
    let found = list.jobs.iter_mut().find(|job| job.id == id);
    let job = found.ok_or_else(|| Refusal::not_found(&format!("job {id}")))?;
    job.is_stopped.store(true, Ordering::Relaxed);
    if job.stage == Stage::Waiting {
        job.stage = Stage::Stopped;
    }
    drop(list);
    jobs.inner.changed();
    Ok(StatusCode::NO_CONTENT)
}

/// The jobs, again with each change: server-sent events.
pub(super) async fn events(State(jobs): State<Arc<Jobs>>) -> Response {
    let changes = jobs.inner.changes.subscribe();
    let begin = (jobs, changes, true);
    let stream = futures_util::stream::unfold(begin, |(jobs, mut changes, is_first)| async move {
        if !is_first {
            tokio::time::sleep(PAUSE).await;
            // After a pause without change the line is sent again: a dead one is noticed.
            let _ = tokio::time::timeout(HEARTBEAT, changes.changed()).await;
        }
        changes.mark_unchanged();
        let list = serde_json::to_string(&jobs.all()).unwrap_or_default();
        Some((
            Ok::<_, Infallible>(format!("data: {list}\n\n")),
            (jobs, changes, false),
        ))
    });
    let kind = [(header::CONTENT_TYPE, "text/event-stream")];
    (kind, Body::from_stream(stream)).into_response()
}
