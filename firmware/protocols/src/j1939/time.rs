//! Time on a millisecond counter that wraps after 49 days.

/// Milliseconds from `earlier` to `now`.
pub(super) const fn since_ms(earlier: u32, now: u32) -> u32 {
    now.wrapping_sub(earlier)
}

/// True once `now` has reached `due`, which is at most 24 days ahead.
pub(super) const fn reached(due: u32, now: u32) -> bool {
    now.wrapping_sub(due) < 1 << 31
}
