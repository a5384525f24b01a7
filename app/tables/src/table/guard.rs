//! Decodes tables that may be damaged: the Parquet library panics on some of them.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    /// Whether this thread is decoding a table.
    static DECODES: Cell<bool> = const { Cell::new(false) };
}
/// One hook of the process reports panics; ours forwards those that do not come from decoding.
static HOOK: Once = Once::new();

/// The result of `decode`, or `None` if it panics; such a panic prints nothing.
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
    // The table is not used after a panic.
    let decoded = panic::catch_unwind(AssertUnwindSafe(decode));
    DECODES.set(false);
    decoded.ok()
}
