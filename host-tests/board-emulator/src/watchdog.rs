//! The independent watchdog.

/// Cycles of the low-speed oscillator until a written prescaler or reload value has arrived.
const UPDATE_CYCLES: f64 = 6.0;

/// The watchdog.
#[derive(Clone, Debug)]
pub struct Watchdog {
    slow_clock_hz: f64,
    runs: bool,
    unlocked: bool,
    prescaler: u32,
    reload: u32,
    /// Counts left at `since_ns`.
    counts: f64,
    since_ns: f64,
    updated_ns: [f64; 2],
    /// Longest time between two reloads, ns.
    pub longest_ns: f64,
    reloaded_ns: Option<f64>,
    frozen: bool,
}

impl Watchdog {
    /// After a reset, with an oscillator of this frequency.
    #[must_use]
    pub const fn new(slow_clock_hz: f64) -> Self {
        Self {
            slow_clock_hz,
            runs: false,
            unlocked: false,
            prescaler: 0,
            reload: 0xFFF,
            counts: 4096.0,
            since_ns: 0.0,
            updated_ns: [0.0; 2],
            longest_ns: 0.0,
            reloaded_ns: None,
            frozen: false,
        }
    }

    fn count_ns(&self) -> f64 {
        f64::from(4_u32 << self.prescaler.min(6)) / self.slow_clock_hz * 1e9
    }

    /// When it resets the part unless it is reloaded, ns.
    #[must_use]
    pub fn expires_ns(&self) -> f64 {
        if self.runs && !self.frozen {
            self.since_ns + self.counts * self.count_ns()
        } else {
            f64::INFINITY
        }
    }

    /// The time that it gives between reloads as it is set, ns.
    #[must_use]
    pub fn period_ns(&self) -> f64 {
        (f64::from(self.reload) + 1.0) * self.count_ns()
    }

    /// Stops or continues with the processor, if a debugger halts it.
    pub fn freeze(&mut self, frozen: bool, now_ns: f64) {
        self.settle(now_ns);
        self.frozen = frozen;
    }

    fn settle(&mut self, now_ns: f64) {
        if self.runs && !self.frozen {
            self.counts -= (now_ns - self.since_ns) / self.count_ns();
        }
        self.since_ns = now_ns;
    }

    /// A read at `offset`.
    #[must_use]
    pub fn read(&self, offset: u32, now_ns: f64) -> u32 {
        match offset {
            0x04 => self.prescaler,
            0x08 => self.reload,
            0x0C => {
                let pending = |index: usize| u32::from(now_ns < self.updated_ns[index]);
                pending(0) | pending(1) << 1
            }
            _ => 0,
        }
    }

    /// A write at `offset`; returns its fault, if any.
    pub fn write(&mut self, offset: u32, value: u32, now_ns: f64) -> Option<String> {
        self.settle(now_ns);
        let arrival_ns = now_ns + UPDATE_CYCLES / self.slow_clock_hz * 1e9;
        match (offset, value) {
            (0x00, 0xCCCC) => {
                self.runs = true;
                self.reloaded_ns = Some(now_ns);
                self.counts = f64::from(self.reload) + 1.0;
            }
            (0x00, 0x5555) => self.unlocked = true,
            (0x00, 0xAAAA) => {
                self.unlocked = false;
                let before = self.reloaded_ns.replace(now_ns).unwrap_or(now_ns);
                self.longest_ns = self.longest_ns.max(now_ns - before);
                if now_ns < self.updated_ns[1] {
                    return Some(
                        "the watchdog is reloaded before its reload value has arrived".into(),
                    );
                }
                self.counts = f64::from(self.reload) + 1.0;
            }
            (0x00, _) => self.unlocked = false,
            (0x04 | 0x08, _) if !self.unlocked => {
                return Some("a locked register of the watchdog is written".into());
            }
            (0x04, _) => {
                self.prescaler = value & 7;
                self.updated_ns[0] = arrival_ns;
            }
            (0x08, _) => {
                self.reload = value & 0xFFF;
                self.updated_ns[1] = arrival_ns;
            }
            _ => {}
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::Watchdog;

    #[test]
    fn it_expires_after_its_period_unless_it_is_reloaded() {
        let mut watchdog = Watchdog::new(32e3);
        assert_eq!(watchdog.expires_ns(), f64::INFINITY);
        watchdog.write(0, 0xCCCC, 0.0);
        assert!((watchdog.expires_ns() - 512e6).abs() < 1.0);
        watchdog.write(0, 0x5555, 0.0);
        watchdog.write(8, 79, 0.0);
        watchdog.write(0, 0xAAAA, 1e6);
        assert!((watchdog.expires_ns() - 11e6).abs() < 1.0);
        watchdog.freeze(true, 2e6);
        assert_eq!(watchdog.expires_ns(), f64::INFINITY);
        watchdog.freeze(false, 50e6);
        assert!((watchdog.expires_ns() - 59e6).abs() < 1.0);
    }
}
