//! Heartbeat: shows that a node is running, and monitors the partner (ISO 11783-7).
//!
//! One byte every 100 ms on request: first 251, then 0 to 250 cyclically; 254 reports an error of the sender, 255 an
//! orderly shutdown. A repeated number, a step of more than three or an interval of more than 300 ms makes the sender
//! invalid, until eight consecutive numbers are valid.

use super::time::since_ms;

/// Interval, ms.
pub const PERIOD_MS: u32 = 100;
const SILENCE_MS: u32 = 300;
const FIRST: u8 = 251;
const LARGEST: u8 = 250;
const STOPS: u8 = 255;
const FURTHEST: u8 = 3;
const MENDED_BY: u8 = 8;

/// Own heartbeat.
#[derive(Clone, Copy, Debug, Default)]
pub struct Heartbeat {
    /// Last number.
    last: u8,
    /// When it was sent; `None` before the first.
    sent_ms: Option<u32>,
    asked: bool,
}

impl Heartbeat {
    /// A node requests it.
    pub fn asked(&mut self) {
        self.asked = true;
    }

    /// The number that is due.
    pub fn poll(&mut self, now_ms: u32) -> Option<u8> {
        self.last = match self.sent_ms {
            _ if !self.asked => return None,
            None => FIRST,
            Some(sent_ms) if since_ms(sent_ms, now_ms) < PERIOD_MS => return None,
            Some(_) => following(self.last),
        };
        self.sent_ms = Some(now_ms);
        Some(self.last)
    }
}

/// The successor of a number.
const fn following(last: u8) -> u8 {
    if last >= LARGEST {
        0
    } else {
        last.saturating_add(1)
    }
}

/// Heartbeat of the implement that commands the hitch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Monitor {
    from: u8,
    last: u8,
    heard_ms: u32,
    /// Consecutive valid numbers, limited to the required count.
    good: u8,
}

impl Monitor {
    /// State after the first number.
    const fn new(from: u8, number: u8, now_ms: u32) -> Self {
        Self {
            from,
            last: number,
            heard_ms: now_ms,
            good: if number == FIRST { MENDED_BY } else { 0 },
        }
    }

    /// `monitor` after a received number. Numbers of other nodes are ignored while one is monitored.
    #[must_use]
    pub fn heard(monitor: Option<Self>, from: u8, number: u8, now_ms: u32) -> Option<Self> {
        match monitor {
            Some(known) if known.from == from => known.goes_on(number, now_ms),
            Some(known) if known.is_alive(now_ms) => Some(known),
            _ => Some(Self::new(from, number, now_ms)),
        }
    }

    fn goes_on(self, number: u8, now_ms: u32) -> Option<Self> {
        if number == STOPS {
            return None;
        }
        let steps = match (self.last, number) {
            (_, FIRST) => 1,
            (FIRST, _) => number.saturating_add(1),
            (last, number) if number <= LARGEST && number < last => number
                .saturating_add(LARGEST.saturating_sub(last))
                .saturating_add(1),
            (last, number) => number.saturating_sub(last),
        };
        let in_order = (1..=FURTHEST).contains(&steps) && number <= FIRST;
        let in_time = since_ms(self.heard_ms, now_ms) <= SILENCE_MS;
        Some(Self {
            last: number,
            heard_ms: now_ms,
            good: if in_order && in_time {
                self.good.saturating_add(1).min(MENDED_BY)
            } else {
                0
            },
            ..self
        })
    }

    /// Whether its sender is valid.
    #[must_use]
    pub const fn is_alive(self, now_ms: u32) -> bool {
        self.good >= MENDED_BY && since_ms(self.heard_ms, now_ms) <= SILENCE_MS
    }

    /// Whether it is that of `node`, and invalid.
    #[must_use]
    pub fn condemns(self, node: u8, now_ms: u32) -> bool {
        self.from == node && !self.is_alive(now_ms)
    }
}
