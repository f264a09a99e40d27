//! What a command says while it runs inside another program, such as the Python package: its answer
//! is kept instead of printed, its progress is reported, and it can be stopped.

use crate::probability::Progress;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What a command said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CommandAnswer {
    /// The exit code that the program would have.
    pub exit_code: u8,
    /// What it would print on standard output.
    pub answer: Vec<u8>,
    /// What it would print on standard error: remarks, and the error if there is one.
    pub remarks: String,
}

/// The payload with which [`stop`] ends a command.
struct Stopped;

/// What the running command has said, and where its progress goes.
struct Session {
    answer: Vec<u8>,
    remarks: String,
    progress: Arc<dyn Progress + Send>,
}

static SESSION: Mutex<Option<Session>> = Mutex::new(None);
/// Held while a command runs: one at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// The lock of a mutex that guards no invariant a panic could break.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs `command`, which returns its exit code, and keeps what it says.
pub(super) fn run(
    progress: Arc<dyn Progress + Send>,
    command: impl FnOnce() -> u8,
) -> CommandAnswer {
    let _one = lock(&ONE_AT_A_TIME);
    *lock(&SESSION) = Some(Session {
        answer: Vec::new(),
        remarks: String::new(),
        progress,
    });
    let exit_code = command();
    let session = lock(&SESSION).take();
    session.map_or_else(CommandAnswer::default, |session| CommandAnswer {
        exit_code,
        answer: session.answer,
        remarks: session.remarks,
    })
}

/// Ends the command from within a call of its progress. Files that are not finished are removed; a
/// sweep keeps what is saved.
pub fn stop() -> ! {
    // No message: it is no bug.
    std::panic::resume_unwind(Box::new(Stopped))
}

/// Whether a caught panic is that of [`stop`].
pub(super) fn is_stop(payload: &(dyn std::any::Any + Send)) -> bool {
    payload.is::<Stopped>()
}

/// Takes an answer if a command runs embedded.
pub(super) fn take_answer(bytes: &[u8]) -> bool {
    let mut session = lock(&SESSION);
    session
        .as_mut()
        .map(|session| session.answer.extend_from_slice(bytes))
        .is_some()
}

/// Takes a remark if a command runs embedded.
pub(super) fn take_remark(text: &str) -> bool {
    let mut session = lock(&SESSION);
    session
        .as_mut()
        .map(|session| {
            session.remarks.push_str(text.trim_end());
            session.remarks.push('\n');
        })
        .is_some()
}

/// Where the progress of an embedded command goes.
pub(super) fn progress() -> Option<Arc<dyn Progress + Send>> {
    lock(&SESSION)
        .as_ref()
        .map(|session| Arc::clone(&session.progress))
}
