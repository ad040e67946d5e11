//! Regular conversions of a converter, one channel each, started by software.

use std::collections::BTreeSet;

/// Regular conversions.
#[derive(Clone, Debug)]
pub struct Regular {
    /// A write demands a conversion.
    demanded: bool,
    running: Option<Conversion>,
    /// The code of the last conversion, and whether its end has not been cleared.
    code: u32,
    ended: bool,
    /// Conversions do not end any more: a fault.
    pub is_stuck: bool,
    /// Channels that have been converted.
    pub channels: BTreeSet<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Conversion {
    code: u32,
    done_ns: f64,
    duration_ns: f64,
}

impl Regular {
    /// After a reset.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            demanded: false,
            running: None,
            code: 0,
            ended: false,
            is_stuck: false,
            channels: BTreeSet::new(),
        }
    }

    /// A write demands a conversion.
    pub const fn demand(&mut self) {
        self.demanded = true;
    }

    /// Whether a conversion is demanded, once.
    pub const fn take_demand(&mut self) -> bool {
        std::mem::replace(&mut self.demanded, false)
    }

    /// Starts a conversion of this channel with its code.
    pub fn start(&mut self, channel: u32, code: u32, from_ns: f64, duration_ns: f64) {
        self.channels.insert(channel);
        self.running = Some(Conversion {
            code,
            done_ns: from_ns + duration_ns,
            duration_ns,
        });
    }

    /// An injected sequence runs until then: a conversion that has not ended is repeated after it.
    pub fn interrupt(&mut self, until_ns: f64) {
        if let Some(running) = &mut self.running {
            running.done_ns = until_ns + running.duration_ns;
        }
    }

    /// The sequence has changed: a conversion is repeated with the new one.
    pub const fn begin_anew(&mut self) {
        if self.running.take().is_some() {
            self.demanded = true;
        }
    }

    /// Ends a conversion whose time has come.
    pub fn settle(&mut self, now_ns: f64) {
        let due = |running: &mut Conversion| now_ns >= running.done_ns;
        if self.is_stuck {
            return;
        }
        if let Some(running) = self.running.take_if(due) {
            self.code = running.code;
            self.ended = true;
        }
    }

    /// Whether a conversion runs.
    #[must_use]
    pub const fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Whether the end of a conversion has not been cleared.
    #[must_use]
    pub const fn has_ended(&self) -> bool {
        self.ended
    }

    /// Keeps or clears the end of a conversion.
    pub const fn keep_end(&mut self, keep: bool) {
        self.ended &= keep;
    }

    /// The code in the data register; reading it clears the end.
    pub const fn take_code(&mut self) -> u32 {
        self.ended = false;
        self.code
    }
}
