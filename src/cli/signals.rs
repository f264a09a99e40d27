//! What happens when the program is told to stop: unfinished files go, what is safe is said.

use super::failure::code;
use super::terminal::tell;
use bankshot::output::files;
use std::sync::Mutex;

/// What to say on leaving.
static PARTING: Mutex<Option<Box<dyn Fn() -> String + Send>>> = Mutex::new(None);

/// From now on, says this when the program is stopped.
pub(crate) fn say_on_leaving(parting: impl Fn() -> String + Send + 'static) {
    if let Ok(mut slot) = PARTING.lock() {
        *slot = Some(Box::new(parting));
    }
}

fn leave(exit_code: u8) -> ! {
    files::discard_pending();
    if let Ok(slot) = PARTING.try_lock()
        && let Some(parting) = slot.as_ref()
    {
        tell(&parting());
    }
    std::process::exit(i32::from(exit_code));
}

/// Ctrl-C, a polite end and a closed terminal remove the files that are not finished and end the program.
#[cfg(unix)]
pub(crate) fn watch() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    // Without a handler the default one ends the program too; only temporary files would stay.
    // A hang-up that the shell has us ignore, as `nohup` does, stays ignored; who sends the others means them.
    let heeded = [SIGINT, SIGTERM, SIGHUP]
        .into_iter()
        .filter(|&signal| signal != SIGHUP || !is_ignored(signal));
    let Ok(mut signals) = signal_hook::iterator::Signals::new(heeded) else {
        return;
    };
    // Where this thread cannot start, no other can, and the program ends by itself.
    let _ = std::thread::Builder::new().spawn(move || {
        if let Some(signal) = signals.forever().next() {
            leave(if signal == SIGINT {
                code::INTERRUPTED
            } else {
                code::STOPPED
            });
        }
    });
}

/// Is a signal ignored? The system tells on Linux; elsewhere none is taken to be.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// As there, for Ctrl-C alone.
#[cfg(not(unix))]
pub(crate) fn watch() {
    let _ = ctrlc::set_handler(|| leave(code::INTERRUPTED));
}

/// Leaves a mark in a file if the program aborts.
#[cfg(unix)]
pub(crate) fn note_aborts(path: &std::path::Path) {
    let file = std::fs::File::options()
        .create(true)
        .append(true)
        .open(path);
    if let Ok(file) = file {
        // Where it cannot be noted, an abort counts as a kill.
        let _ = signal_hook::low_level::pipe::register(signal_hook::consts::SIGABRT, file);
    }
}

/// Leaves a mark in a file if the program aborts.
#[cfg(not(unix))]
pub(crate) fn note_aborts(_path: &std::path::Path) {}
