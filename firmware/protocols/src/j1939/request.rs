//! Requests for a parameter group, and their answers (SAE J1939-21, ISO 11783-3).

use heapless::Deque;

use super::id::{GLOBAL, Id, NULL, Pgn};
use super::time::since_ms;
use crate::can::Frame;

/// Requests that wait for their answer. more are dropped, their senders ask again.
const QUEUE: usize = 8;
/// Time between answers, ms: whoever asks all the time gets a bounded share of the bus in return. Eight answers are
/// still far within the 200 ms that a requester waits.
const SPACING_MS: u32 = 5;
/// Priority of an acknowledgement.
const PRIORITY: u8 = 6;

/// A request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GroupRequest {
    /// The group that is asked for.
    pub group: Pgn,
    /// Who asks.
    pub from: u8,
    /// True if everybody was asked.
    pub global: bool,
}

impl GroupRequest {
    /// The request in the data of a request message.
    #[must_use]
    pub fn from_message(id: &Id, data: &[u8]) -> Option<Self> {
        let group = Pgn::from_bytes(*data.first_chunk()?);
        (id.source != NULL && id.source != GLOBAL || group == Pgn::ADDRESS_CLAIMED).then_some(
            Self {
                group,
                from: id.source,
                global: id.destination == GLOBAL,
            },
        )
    }
}

/// How a request is acknowledged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Acknowledgement {
    /// Done.
    Positive = 0,
    /// The group isn't supported.
    Negative = 1,
    /// Not now: ask again.
    CannotRespond = 3,
}

/// The acknowledgement of a request, to everybody, naming who asked.
#[must_use]
pub fn acknowledgement(control: Acknowledgement, request: &GroupRequest, source: u8) -> Frame {
    let [a, b, c] = request.group.to_bytes();
    let id = Id {
        priority: PRIORITY,
        pgn: Pgn::ACKNOWLEDGEMENT,
        destination: GLOBAL,
        source,
    };
    id.frame([control as u8, 0xFF, 0xFF, 0xFF, request.from, a, b, c])
}

/// Requests that wait for their answer.
#[derive(Clone, Debug, Default)]
pub struct RequestQueue {
    waiting: Deque<GroupRequest, QUEUE>,
    answered_ms: Option<u32>,
}

impl RequestQueue {
    /// A request was heard. One that waits already isn't put down twice.
    pub fn push(&mut self, request: GroupRequest) {
        if self.waiting.iter().all(|other| *other != request) {
            let _ = self.waiting.push_back(request);
        }
    }

    /// The next one that is to be answered now.
    pub fn next(&mut self, now_ms: u32) -> Option<GroupRequest> {
        let spaced = self
            .answered_ms
            .is_none_or(|last| since_ms(last, now_ms) >= SPACING_MS);
        let request = self.waiting.front().copied().filter(|_| spaced)?;
        self.waiting.pop_front();
        self.answered_ms = Some(now_ms);
        Some(request)
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.waiting.clear();
    }
}
