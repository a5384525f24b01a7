//! A process that runs out of memory ends with exit code 3, as every command that cannot finish.
//!
//! Without this the process would abort, which a build server cannot tell from a crash; on systems other than Unix it
//! still does. The files that it has written are left as if it had been killed.

#![expect(unsafe_code, reason = "an allocator is the only place where all allocations can be seen to fail")]

use std::alloc::{GlobalAlloc, Layout, System};

#[global_allocator]
static ALLOCATOR: EndsWithoutMemory = EndsWithoutMemory;

/// The system's allocator; where it has nothing left the process ends.
struct EndsWithoutMemory;

// SAFETY: every call goes to the system allocator. Its result is returned unless it is null; then the process ends.
unsafe impl GlobalAlloc for EndsWithoutMemory {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller fulfils the contract of `GlobalAlloc`.
        or_end(unsafe { System.alloc(layout) })
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller fulfils the contract of `GlobalAlloc`.
        or_end(unsafe { System.alloc_zeroed(layout) })
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller fulfils the contract of `GlobalAlloc`.
        or_end(unsafe { System.realloc(place, layout, size) })
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: the caller fulfils the contract of `GlobalAlloc`.
        unsafe { System.dealloc(place, layout) }
    }
}

fn or_end(place: *mut u8) -> *mut u8 {
    if place.is_null() { end() } else { place }
}

/// Ends the process without asking for memory: the message goes straight to standard error, and nothing that waits for the end is
/// called.
#[cold]
#[cfg(unix)]
fn end() -> ! {
    const MESSAGE: &[u8] = b"Error:   \xc3\x97 there is not enough memory\n";
    const EXIT_CODE: i32 = 3;
    // SAFETY: the message has the stated length; `_exit` accepts any number and does not return.
    unsafe {
        libc::write(libc::STDERR_FILENO, MESSAGE.as_ptr().cast(), MESSAGE.len());
        libc::_exit(EXIT_CODE)
    }
}

#[cold]
#[cfg(not(unix))]
fn end() -> ! {
    std::process::abort()
}
