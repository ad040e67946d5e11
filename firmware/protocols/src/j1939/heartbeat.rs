//! The heartbeat by which a node shows that it still thinks, and hears whether its partner does (ISO 11783-7).
//!
//! One byte every 100 ms, for who has asked for it: 251 at first, then 0 to 250 round and round; 254 says that the
//! sender is broken, 255 that it stops on purpose. A number that comes again, is further on than three or takes longer
//! than 300 ms is a broken sender's; eight good ones in a row mend it.

use super::time::since_ms;

/// Time between two, ms.
pub const PERIOD_MS: u32 = 100;
const SILENCE_MS: u32 = 300;
const FIRST: u8 = 251;
const LARGEST: u8 = 250;
const STOPS: u8 = 255;
const FURTHEST: u8 = 3;
const MENDED_BY: u8 = 8;

/// Ours.
#[derive(Clone, Copy, Debug, Default)]
pub struct Heartbeat {
    /// What was said last, and when it is said again; `None` if nobody has asked for it.
    last: Option<(u8, u32)>,
    asked: bool,
}

impl Heartbeat {
    /// Somebody asks for it.
    pub fn asked(&mut self) {
        self.asked = true;
    }

    /// The number that is due.
    pub fn poll(&mut self, now_ms: u32) -> Option<u8> {
        let number = match self.last {
            _ if !self.asked => return None,
            None => FIRST,
            Some((_, sent_ms)) if since_ms(sent_ms, now_ms) < PERIOD_MS => return None,
            Some((last, _)) => following(last),
        };
        self.last = Some((number, now_ms));
        Some(number)
    }
}

/// The number after another one.
const fn following(last: u8) -> u8 {
    if last >= LARGEST {
        0
    } else {
        last.saturating_add(1)
    }
}

/// That of an implement which has the hitch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Monitor {
    from: u8,
    last: u8,
    heard_ms: u32,
    /// Good ones in a row, no further than is needed.
    good: u8,
}

impl Monitor {
    /// The first one was heard.
    const fn new(from: u8, number: u8, now_ms: u32) -> Self {
        Self {
            from,
            last: number,
            heard_ms: now_ms,
            good: if number == FIRST { MENDED_BY } else { 0 },
        }
    }

    /// `monitor` after a number was heard. Another node's doesn't count while there is one to watch.
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
            good: match in_order && in_time {
                true => self.good.saturating_add(1).min(MENDED_BY),
                false => 0,
            },
            ..self
        })
    }

    /// True if its sender can be trusted just now.
    #[must_use]
    pub const fn is_alive(self, now_ms: u32) -> bool {
        self.good >= MENDED_BY && since_ms(self.heard_ms, now_ms) <= SILENCE_MS
    }

    /// True if it is that of `node`, which can't be trusted.
    #[must_use]
    pub fn condemns(self, node: u8, now_ms: u32) -> bool {
        self.from == node && !self.is_alive(now_ms)
    }
}
