//! What happens when there is no more memory: exit code 3, as with everything else that cannot be finished.
//!
//! Without this the process would be aborted, which a build server cannot tell from a crash. Files are not affected: they have no
//! name until they are whole.

#![expect(unsafe_code, reason = "an allocator is the only place where all allocations can be seen to fail")]

use std::alloc::{GlobalAlloc, Layout, System};

#[global_allocator]
static ALLOCATOR: EndsWithoutMemory = EndsWithoutMemory;

/// The system's allocator; where it has nothing left the process ends.
struct EndsWithoutMemory;

// SAFETY: every call is the system allocator's own; what it answers is handed on unless it is null, and then the process ends.
unsafe impl GlobalAlloc for EndsWithoutMemory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        or_end(unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        or_end(unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller promises.
        or_end(unsafe { System.realloc(place, layout, size) })
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(place, layout) }
    }
}

fn or_end(place: *mut u8) -> *mut u8 {
    if place.is_null() { end() } else { place }
}

/// Ends the process without asking for memory: standard error is not buffered, and nothing that waits for the end is called.
#[cold]
#[cfg(unix)]
fn end() -> ! {
    use std::io::Write;

    let _ = std::io::stderr().write_all(b"Error:   \xc3\x97 there is not enough memory\n");
    // SAFETY: it takes any number and does not come back.
    unsafe { libc::_exit(3) }
}

#[cold]
#[cfg(not(unix))]
fn end() -> ! {
    std::process::abort()
}
