//! Signals that stop the program: it removes unfinished files and says what is saved.

use super::failure::code;
use super::terminal::print_remark;
use crate::files::atomic_file;
use std::sync::Mutex;

/// The remark to print on a signal.
static EXIT_REMARK: Mutex<Option<Box<dyn Fn() -> String + Send>>> = Mutex::new(None);

/// Sets the remark that a signal prints.
pub(crate) fn set_exit_remark(remark: impl Fn() -> String + Send + 'static) {
    if let Ok(mut slot) = EXIT_REMARK.lock() {
        *slot = Some(Box::new(remark));
    }
}

fn exit(exit_code: u8) -> ! {
    atomic_file::discard_temporary_files();
    if let Ok(slot) = EXIT_REMARK.try_lock()
        && let Some(remark) = slot.as_ref()
    {
        print_remark(&remark());
    }
    std::process::exit(i32::from(exit_code));
}

/// Handles SIGINT (Ctrl-C), SIGTERM and SIGHUP (a closed terminal).
#[cfg(unix)]
pub(crate) fn handle() {
    use signal_hook::consts::signal::SIGXFSZ;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    // If the handler cannot be set, the default one ends the program too, but leaves temporary
    // files. SIGHUP stays ignored if the parent process ignores it, as `nohup` does.
    let handled = [SIGINT, SIGTERM, SIGHUP]
        .into_iter()
        .filter(|&signal| signal != SIGHUP || !is_ignored(signal));
    // A file that grows beyond the limit of the shell is an error of writing, with its message.
    let _ = signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default());
    let Ok(mut signals) = signal_hook::iterator::Signals::new(handled) else {
        return;
    };
    // If this thread cannot start, no other can, and the program ends with an error.
    let _ = std::thread::Builder::new().spawn(move || {
        if let Some(signal) = signals.forever().next() {
            exit(if signal == SIGINT {
                code::INTERRUPTED
            } else {
                code::STOPPED
            });
        }
    });
}

/// Whether a signal is ignored. Known on Linux only; elsewhere the answer is no.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Handles Ctrl-C.
#[cfg(not(unix))]
pub(crate) fn handle() {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    let is_pressed = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&is_pressed);
    if signal_hook::flag::register(signal_hook::consts::SIGINT, flag).is_err() {
        return;
    }
    let _ = std::thread::Builder::new().spawn(move || {
        while !is_pressed.load(Ordering::Relaxed) {
            std::thread::sleep(std::time::Duration::from_millis(50));
        }
        exit(code::INTERRUPTED);
    });
}

/// Writes a byte to a file if the program aborts.
#[cfg(unix)]
pub(crate) fn note_aborts(path: &std::path::Path) {
    let file = std::fs::File::options()
        .create(true)
        .append(true)
        .open(path);
    if let Ok(file) = file {
        // If this fails, an abort counts as a kill.
        let _ = signal_hook::low_level::pipe::register(signal_hook::consts::SIGABRT, file);
    }
}

/// Does nothing on this system.
#[cfg(not(unix))]
pub(crate) fn note_aborts(_path: &std::path::Path) {}
