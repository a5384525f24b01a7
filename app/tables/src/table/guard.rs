//! Decoding of tables that may be damaged: the library that does it panics at some of them.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    /// Whether this thread decodes a table.
    static DECODES: Cell<bool> = const { Cell::new(false) };
}
/// A panic is reported by one hook for the whole process; ours hands on whatever does not come from a table.
static HOOK: Once = Once::new();

/// What `decode` makes, or nothing if it panics; of such a panic nothing is printed.
pub(super) fn guarded<T>(decode: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let report = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !DECODES.get() {
                report(panic);
            }
        }));
    });
    DECODES.set(true);
    // What is left of a table after a panic is not used any more.
    let decoded = panic::catch_unwind(AssertUnwindSafe(decode));
    DECODES.set(false);
    decoded.ok()
}
