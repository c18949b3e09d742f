//! Setup that must run before the Rust runtime starts.
//!
//! If standard output is closed (`>&-`), the runtime opens `/dev/null` in its place, and results
//! would be lost without an error. If a file exceeds the size limit of the process (`ulimit -f`), a
//! signal kills the process and leaves an incomplete file. Therefore a function that the loader calls
//! tests standard output, and makes the process ignore this signal. On systems whose loader calls no
//! such function, neither condition is detected.

use std::sync::atomic::{AtomicBool, Ordering};

static CLOSED: AtomicBool = AtomicBool::new(false);

/// Returns `true` if standard output was closed when the program started.
pub(crate) fn output_was_closed() -> bool {
    CLOSED.load(Ordering::Relaxed)
}

#[cfg(all(target_os = "linux", any(target_arch = "x86_64", target_arch = "aarch64")))]
#[expect(unsafe_code, reason = "a loader section and a C library function")]
mod before_main {
    use std::os::fd::AsFd as _;
    use std::sync::atomic::Ordering;

    /// Error number for a descriptor that is not open (EBADF).
    const NOT_OPEN: i32 = 9;

    /// Number of the signal for a file that exceeds the size limit (SIGXFSZ).
    const FILE_TOO_LARGE: i32 = 25;

    /// Handler that ignores a signal (`SIG_IGN`).
    const IGNORE: usize = 1;

    // SAFETY: declared as in <signal.h>; a handler is an address.
    unsafe extern "C" {
        safe fn signal(number: i32, handler: usize) -> usize;
    }

    // SAFETY: the section holds addresses of functions like this one.
    #[used]
    #[unsafe(link_section = ".init_array")]
    static ARRANGE: extern "C" fn() = arrange;

    extern "C" fn arrange() {
        signal(FILE_TOO_LARGE, IGNORE);
        if let Err(error) = std::io::stdout().as_fd().try_clone_to_owned() {
            super::CLOSED.store(error.raw_os_error() == Some(NOT_OPEN), Ordering::Relaxed);
        }
    }
}
