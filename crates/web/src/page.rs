//! The interface to a page: four functions and one import over linear memory.
#![expect(unsafe_code, reason = "functions exported to and imported from the page")]

use std::cell::RefCell;
use std::ops::ControlFlow;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Progress callback; any result but 0 stops the work.
    safe fn progress(done: f64, of: f64) -> i32;
}

thread_local! {
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

fn say(answer: Vec<u8>) {
    ANSWER.with(|kept| *kept.borrow_mut() = answer);
}

/// Allocates memory for a request of `length` bytes and returns its address; discards the last answer.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn room(length: usize) -> *mut u8 {
    std::panic::set_hook(Box::new(|panic| say(panic.to_string().into_bytes())));
    say(Vec::new());
    REQUEST.with(|request| {
        let mut request = request.borrow_mut();
        *request = vec![0; length];
        request.as_mut_ptr()
    })
}

/// Handles the request; returns 0 on success, and 1 if the request is refused.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn run() -> u32 {
    let request = REQUEST.with(RefCell::take);
    let done = crate::answered(&request, &mut |done, of| {
        if progress(done, of) == 0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let status = u32::from(done.is_err());
    say(done.unwrap_or_else(String::into_bytes));
    status
}

/// Returns the address of the answer.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn answer() -> *const u8 {
    ANSWER.with(|answer| answer.borrow().as_ptr())
}

/// Returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn answer_length() -> usize {
    ANSWER.with(|answer| answer.borrow().len())
}
