//! Requests for a parameter group, and their answers (SAE J1939-21, ISO 11783-3).

use heapless::Deque;

use super::id::{GLOBAL, Id, NULL, Pgn};
use super::time::is_due;
use crate::can::Frame;

/// Capacity of the queue of requests; more are dropped, and their senders repeat them.
const QUEUE: usize = 8;
/// Interval between answers, ms; it bounds the bus load. Eight answers are well within the 200 ms time-out of a
/// requester.
const SPACING_MS: u32 = 5;
/// Priority of an acknowledgement.
const PRIORITY: u8 = 6;

/// A request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GroupRequest {
    /// The requested group.
    pub group: Pgn,
    /// Requesting node.
    pub from: u8,
    /// Whether the request was global.
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

impl GroupRequest {
    /// A request whose answer goes to all: one that is queued answers all of its kind.
    #[must_use]
    pub const fn of_all(group: Pgn) -> Self {
        Self {
            group,
            from: GLOBAL,
            global: true,
        }
    }
}

/// Kind of acknowledgement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Acknowledgement {
    /// Done.
    Positive = 0,
    /// The group isn't supported.
    Negative = 1,
    /// The sender may not ask for this.
    AccessDenied = 2,
    /// Busy: repeat the request.
    CannotRespond = 3,
}

/// The acknowledgement of a request, to all, with the address of the requester.
#[must_use]
pub fn acknowledgement(control: Acknowledgement, request: &GroupRequest, source: u8) -> Frame {
    let [a, b, c] = request.group.to_bytes();
    let id = Id::broadcast(Pgn::ACKNOWLEDGEMENT, PRIORITY, source);
    id.frame([control as u8, 0xFF, 0xFF, 0xFF, request.from, a, b, c])
}

/// An acknowledgement; requests to everybody aren't acknowledged.
#[must_use]
pub fn acknowledged(control: Acknowledgement, request: &GroupRequest, source: u8) -> Option<Frame> {
    (!request.global).then(|| acknowledgement(control, request, source))
}

/// Queue of requests.
#[derive(Clone, Debug, Default)]
pub struct RequestQueue {
    waiting: Deque<GroupRequest, QUEUE>,
    answered_ms: Option<u32>,
}

impl RequestQueue {
    /// A request was received. A queued one is not added twice.
    pub fn push(&mut self, request: GroupRequest) {
        if self.waiting.iter().all(|other| *other != request) {
            let _ = self.waiting.push_back(request);
        }
    }

    /// The next request to be answered now.
    pub fn next(&mut self, now_ms: u32) -> Option<GroupRequest> {
        let spaced = is_due(self.answered_ms, SPACING_MS, now_ms);
        let request = self.waiting.front().copied().filter(|_| spaced)?;
        self.waiting.pop_front();
        self.answered_ms = Some(now_ms);
        Some(request)
    }

    /// Clears the queue.
    pub fn clear(&mut self) {
        self.waiting.clear();
    }
}
