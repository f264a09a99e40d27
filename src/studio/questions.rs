//! Questions that are answered at once. A page's newer question of a kind ends the older one.

use super::folder::fit_folder;
use super::refusal::{Fault, Refusal};
use super::site::Site;
use crate::answers::nominal_shot::NominalRequest;
use crate::answers::requests::{Answered, ProfileRequest, Request, RequestError};
use crate::present::shot_note_text::note_text;
use crate::probability::Progress;
use crate::store::fit::Fit;
use axum::body::{Body, Bytes};
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::convert::Infallible;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::Semaphore;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

/// Questions that are computed at a time.
const AT_A_TIME: usize = 4;
/// Questions that may wait.
const MAX_WAITING: usize = 64;
/// Pages whose questions are remembered.
const MAX_PAGES: usize = 256;

/// The running questions.
pub(super) struct Questions {
    /// Of each page and kind of question, whether the last one is out of date.
    latest: Mutex<HashMap<String, Arc<AtomicBool>>>,
    places: Arc<Semaphore>,
    waiting: Arc<Semaphore>,
}

impl Default for Questions {
    fn default() -> Self {
        Self {
            latest: Mutex::default(),
            places: Arc::new(Semaphore::new(AT_A_TIME)),
            waiting: Arc::new(Semaphore::new(MAX_WAITING)),
        }
    }
}

impl Questions {
    /// Begins a question of a page, which ends the one before.
    fn begin(&self, page: Option<&str>, question: &Request) -> Arc<AtomicBool> {
        let is_old = Arc::new(AtomicBool::new(false));
        let Some(page) = page else {
            return is_old;
        };
        let key = format!("{page} {:?}", std::mem::discriminant(question));
        let mut latest = self.latest.lock().unwrap_or_else(PoisonError::into_inner);
        if latest.len() >= MAX_PAGES {
            latest.clear();
        }
        if let Some(before) = latest.insert(key, Arc::clone(&is_old)) {
            before.store(true, Ordering::Relaxed);
        }
        is_old
    }
}

/// The payload with which a question is ended.
struct Ended;

/// Ends a question that nobody waits for any more.
struct EndIfOld {
    is_old: Arc<AtomicBool>,
    lines: UnboundedSender<Line>,
}

impl EndIfOld {
    fn check(&self) {
        if self.is_old.load(Ordering::Relaxed) || self.lines.is_closed() {
            std::panic::resume_unwind(Box::new(Ended));
        }
    }
}

impl Progress for EndIfOld {
    fn begin(&self, _stage: &str, _total: u64) {
        self.check();
    }
    fn advance(&self, _units: u64) {
        self.check();
    }
    fn end(&self) {}
}

/// One line of an answer, or why there is none.
type Line = Result<Value, Refusal>;

impl From<RequestError> for Refusal {
    fn from(error: RequestError) -> Self {
        match error {
            RequestError::Fields(errors) => {
                let fault = |error: crate::answers::nominal_shot::FieldError| Fault {
                    field: Some(error.field.to_owned()),
                    message: error.message,
                };
                Self::fields(errors.into_iter().map(fault).collect())
            }
            RequestError::Config(error) => {
                let faults = error.diagnostics.into_iter().map(|diagnostic| Fault {
                    field: Some(diagnostic.key).filter(|key| !key.is_empty()),
                    message: diagnostic.message,
                });
                Self::fields(faults.collect())
            }
            other => Self::bad(other.to_string()),
        }
    }
}

/// Reads a JSON body.
pub(super) fn read_json<T: serde::de::DeserializeOwned>(body: &Bytes) -> Result<T, Refusal> {
    serde_json::from_slice(body).map_err(|error| Refusal::bad(format!("the request: {error}")))
}

pub(super) async fn answer(
    State(site): State<Arc<Site>>,
    State(questions): State<Arc<Questions>>,
    headers: HeaderMap,
    body: Bytes,
) -> Result<Response, Refusal> {
    let request: Request = read_json(&body)?;
    // The fit that the profile is of, by its name in the folder.
    let fit = match headers.get("x-fit").and_then(|value| value.to_str().ok()) {
        None => None,
        Some(name) => {
            let name = percent_decoded(name);
            let folder = fit_folder(&site, &name)?;
            Some(Fit::read(&folder).map_err(|error| Refusal::bad(error.to_string()))?)
        }
    };
    let page = headers.get("x-page").and_then(|value| value.to_str().ok());
    let page = page.filter(|page| page.len() <= 64);
    let is_old = questions.begin(page, &request);
    let Ok(waiting) = Arc::clone(&questions.waiting).try_acquire_owned() else {
        return Err(Refusal::new(
            StatusCode::SERVICE_UNAVAILABLE,
            "too many questions at once; ask again in a second",
        ));
    };
    let place = Arc::clone(&questions.places).acquire_owned().await;
    drop(waiting);
    let (lines, mut received) = unbounded_channel::<Line>();
    tokio::task::spawn_blocking(move || {
        let _place = place;
        compute((&request, fit.as_ref()), is_old, &lines);
    });
    // What is wrong is known before the first line.
    let first = received.recv().await.unwrap_or_else(stopped)?;
    Ok(stream(first, received))
}

/// A question that a newer one ended.
fn stopped() -> Line {
    Ok(json!({ "stopped": true }))
}

fn compute(
    (request, fit): (&Request, Option<&Fit>),
    is_old: Arc<AtomicBool>,
    lines: &UnboundedSender<Line>,
) {
    let progress = EndIfOld {
        is_old,
        lines: lines.clone(),
    };
    // A receiver that is gone shows in `is_closed`.
    let send = |line: Line| drop(lines.send(line));
    let computed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        progress.check();
        request.answer_with_drafts(fit, &progress, &|draft| send(Ok(json!({ "draft": draft }))))
    }));
    send(match computed {
        Ok(Ok(Answered { document, notes })) => {
            let notes: Vec<String> = notes.iter().map(note_text).collect();
            Ok(json!({ "answer": document, "notes": notes }))
        }
        Ok(Err(error)) => Err(error.into()),
        Err(payload) if payload.is::<Ended>() => stopped(),
        Err(_) => Err(Refusal::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            "this is a bug in bankshot; please report it with the address of this page",
        )),
    });
}

/// The lines as they come. After the first, an error is a line too.
fn stream(first: Value, received: UnboundedReceiver<Line>) -> Response {
    let text = |line: Line| match line {
        Ok(value) => format!("{value}\n"),
        Err(refusal) => format!("{}\n", serde_json::to_value(refusal).unwrap_or_default()),
    };
    let begin = (Some(Ok(first)), received);
    let lines = futures_util::stream::unfold(begin, move |(first, mut received)| async move {
        let line = match first {
            Some(line) => line,
            None => received.recv().await?,
        };
        Some((Ok::<_, Infallible>(text(line)), (None, received)))
    });
    let kind = [(header::CONTENT_TYPE, "application/x-ndjson")];
    (kind, Body::from_stream(lines)).into_response()
}

/// A text whose characters may be written as `%` and two digits: headers have no others.
fn percent_decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, tail)) = rest.split_first() {
        let code = (first == b'%')
            .then(|| std::str::from_utf8(tail.get(..2)?).ok())
            .flatten();
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            None => {
                bytes.push(first);
                rest = tail;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A profile whose text is wanted.
#[derive(Debug, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ProfileText {
    /// The profile, and what is changed.
    profile: ProfileRequest,
    /// The shot that goes into its table `[nominal]`.
    #[serde(default)]
    shot: NominalRequest,
}

/// The text of a profile with the values that are asked for.
pub(super) async fn profile(body: Bytes) -> Result<axum::Json<Value>, Refusal> {
    let request: ProfileText = read_json(&body)?;
    let toml = request.profile.text_with(&request.shot)?;
    Ok(axum::Json(json!({ "toml": toml })))
}
