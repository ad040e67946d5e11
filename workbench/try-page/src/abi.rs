//! The functions that the page calls: a text of JSON in, a text of JSON out.
//!
//! The page gets an address from [`request_place`], writes a request there, calls [`answer`], and reads the answer from
//! [`answer_place`]. All three share one buffer, so that a request or an answer is valid until the next call.
#![allow(
    unsafe_code,
    reason = "functions that are exported by their names; no code here is unsafe otherwise"
)]

use std::cell::RefCell;

use crate::bench::Bench;

/// The buffer and the closed loop of the page, which has one thread.
#[derive(Default)]
struct Page {
    text: Vec<u8>,
    bench: Bench,
}

thread_local! {
    static PAGE: RefCell<Page> = RefCell::default();
}

/// A place for a request of `length` bytes of UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn request_place(length: usize) -> *mut u8 {
    PAGE.with_borrow_mut(|page| {
        page.text.clear();
        page.text.resize(length, 0);
        page.text.as_mut_ptr()
    })
}

/// Answers the request; returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    PAGE.with_borrow_mut(|page| {
        page.text = page.bench.answer(&page.text).into_bytes();
        page.text.len()
    })
}

/// The place of the answer, as UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn answer_place() -> *const u8 {
    PAGE.with_borrow(|page| page.text.as_ptr())
}
