//! What the node asks others for: a heartbeat of who commands the hitch, and the claim of who is unknown.

use super::heartbeat;
use super::id::{Id, Pgn};
use super::time::is_due;
use crate::can::Frame;

/// Nobody is asked for a heartbeat, or for a claim, more often than this, ms.
const SPACING_MS: u32 = 1_000;
/// Priority of a request.
const PRIORITY: u8 = 6;

/// Who is to be asked now.
fn next(whom: &mut Option<u8>, asked_ms: &mut Option<u32>, now_ms: u32) -> Option<u8> {
    let is_spaced = is_due(*asked_ms, SPACING_MS, now_ms);
    let node = whom.take_if(|_| is_spaced)?;
    *asked_ms = Some(now_ms);
    Some(node)
}

/// The two questions: who is to be asked, and when somebody was asked last.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asking {
    unwatched: Option<u8>,
    heartbeat_ms: Option<u32>,
    unknown: Option<u8>,
    claim_ms: Option<u32>,
}

impl Asking {
    /// The node is to be asked for its heartbeat.
    pub const fn for_heartbeat(&mut self, node: u8) {
        self.unwatched = Some(node);
    }

    /// The node is to be asked for its claim.
    pub const fn for_claim(&mut self, node: u8) {
        self.unknown = Some(node);
    }

    /// The node has claimed its address.
    pub fn claimed(&mut self, node: u8) {
        self.unknown = self.unknown.filter(|&unknown| unknown != node);
    }

    /// Nobody is to be asked any more.
    pub const fn forget(&mut self) {
        self.unwatched = None;
        self.unknown = None;
    }

    /// The next question that is due.
    pub fn poll(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        let to = |pgn, node| Id::broadcast(pgn, PRIORITY, source).to(node);
        if let Some(node) = next(&mut self.unwatched, &mut self.heartbeat_ms, now_ms) {
            let [a, b, c] = Pgn::HEARTBEAT.to_bytes();
            let period = heartbeat::PERIOD_MS as u8;
            let id = to(Pgn::REPETITION_RATE, node);
            return Some(id.frame([a, b, c, period, 0, 0xFF, 0xFF, 0xFF]));
        }
        let node = next(&mut self.unknown, &mut self.claim_ms, now_ms)?;
        let id = to(Pgn::REQUEST, node).pack();
        Frame::data_frame(id.into(), &Pgn::ADDRESS_CLAIMED.to_bytes())
    }
}
