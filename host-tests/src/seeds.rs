//! Number of drawn cases of a test.

/// Environment variable with the number of seeds of every test that draws its cases.
const VARIABLE: &str = "HITCH_SEEDS";

/// Environment variable for the large sets of cases, which the nightly workflow sets.
const THOROUGH: &str = "HITCH_THOROUGH";

/// Number of seeds: that of the environment variable `HITCH_SEEDS`, or a small number, which keeps the whole suite short.
#[must_use]
pub fn seeds(few: u64) -> u64 {
    let text = std::env::var(VARIABLE).ok();
    text.and_then(|text| text.parse().ok()).unwrap_or(few)
}

/// The small set of cases, or the large one if the environment variable `HITCH_THOROUGH` is set.
#[must_use]
pub fn cases<T>(small: T, large: T) -> T {
    if std::env::var_os(THOROUGH).is_some() {
        large
    } else {
        small
    }
}
