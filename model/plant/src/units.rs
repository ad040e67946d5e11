//! Conversions between SI and the units of instruments and data sheets.
//!
//! The plant computes in SI; logs, model files and reports use bar, l/min and degree.

/// One bar in pascal.
pub const PA_PER_BAR: f64 = 1e5;
/// One litre a minute in cubic metres a second.
pub const M3_S_PER_LPM: f64 = 1e-3 / 60.0;
/// Standard gravity, m/s2, rounded as in the paper's statics.
pub const GRAVITY_M_S2: f64 = 9.81;

/// Pascal from bar.
#[must_use]
pub const fn pa_from_bar(bar: f64) -> f64 {
    bar * PA_PER_BAR
}

/// Bar from pascal.
#[must_use]
pub const fn bar_from_pa(pa: f64) -> f64 {
    pa / PA_PER_BAR
}

/// Cubic metres a second from litres a minute.
#[must_use]
pub const fn m3_s_from_lpm(lpm: f64) -> f64 {
    lpm * M3_S_PER_LPM
}

/// Litres a minute from cubic metres a second.
#[must_use]
pub const fn lpm_from_m3_s(m3_s: f64) -> f64 {
    m3_s / M3_S_PER_LPM
}
