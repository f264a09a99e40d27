//! Panics of libraries at damaged files.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    /// This thread is in a library.
    static IN_LIBRARY: Cell<bool> = const { Cell::new(false) };
}

/// Runs a part of a library that panics at some damaged files: `None` then. The message of such a
/// panic is not printed.
pub(super) fn without_panic<T>(read: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |about| {
            if !IN_LIBRARY.get() {
                usual(about);
            }
        }));
    });
    IN_LIBRARY.set(true);
    let result = panic::catch_unwind(AssertUnwindSafe(read));
    IN_LIBRARY.set(false);
    result.ok()
}
