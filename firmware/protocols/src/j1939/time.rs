//! Time on a millisecond counter that wraps after 49 days.

/// Milliseconds from `earlier` to `now`.
pub(super) const fn since_ms(earlier: u32, now: u32) -> u32 {
    now.wrapping_sub(earlier)
}

/// True once `now` has reached `due`, which is at most 24 days ahead.
pub(super) const fn reached(due: u32, now: u32) -> bool {
    now.wrapping_sub(due) < 1 << 31
}

/// Whether what was done last at a time may be done again: `spacing_ms` have passed since then, or it was never done.
pub(super) fn is_due(last_ms: Option<u32>, spacing_ms: u32, now_ms: u32) -> bool {
    last_ms.is_none_or(|last| since_ms(last, now_ms) >= spacing_ms)
}
