//! Claiming an address (SAE J1939-81, ISO 11783-5).
//!
//! ```text
//!            start            250 ms without a better claim
//!   +------+ claim  +---------+ ------------------------> +---------+
//!   | Idle | -----> | Waiting |                           | Claimed |
//!   +------+        +---------+ <------------------------ +---------+
//!                     |   ^        better claim on our address: claim the next free one
//!                     |   |                                 |
//!         none free,  v   +--- (self-configurable only)     | none free
//!               +-------------+ <---------------------------+
//!               | CannotClaim |   says so from the null address, now and when asked, after a delay
//!               +-------------+   of its own, so that two losers don't collide
//! ```
//!
//! A claim of our address by a NAME of lower priority is answered with our claim; a NAME equal to ours is an echo.

use super::id::{GLOBAL, Id, NULL, Pgn};
use super::name::Name;
use super::time::{is_due, reached, since_ms};
use crate::can::Frame;

/// Waiting time after a claim, ms.
pub const SILENCE_MS: u32 = 250;
/// Minimum interval between answers to claims, ms; it bounds the response to a faulty node.
const LEAST_SPACING_MS: u32 = 5;
/// Minimum interval between claims in response to a node that uses our address without a claim, ms.
const REMINDER_MS: u32 = 5_000;
/// Address range of self-configurable nodes.
const FREE_ADDRESSES: core::ops::RangeInclusive<u8> = 128..=247;
/// Priority of a claim.
const PRIORITY: u8 = 6;

/// State of the claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ClaimState {
    /// Nothing sent yet.
    Idle,
    /// A claim has to be sent, or was sent at `since_ms`.
    Waiting { since_ms: Option<u32> },
    /// The address is claimed.
    Claimed,
    /// No address is available.
    CannotClaim,
}

/// State machine of the claim.
#[derive(Clone, Debug)]
pub struct AddressClaim {
    name: Name,
    address: u8,
    state: ClaimState,
    /// Time at which a claim or "cannot claim" is due, if any.
    due_ms: Option<u32>,
    last_sent_ms: Option<u32>,
    /// One bit for each address claimed by another node.
    taken: [u32; 8],
}

impl AddressClaim {
    /// A node that claims `preferred` at the first [`Self::poll`].
    #[must_use]
    pub const fn new(name: Name, preferred: u8) -> Self {
        Self {
            name,
            address: preferred,
            state: ClaimState::Idle,
            due_ms: None,
            last_sent_ms: None,
            taken: [0; 8],
        }
    }

    /// The address, once it may be used.
    #[must_use]
    pub const fn address(&self) -> Option<u8> {
        match self.state {
            ClaimState::Claimed => Some(self.address),
            _ => None,
        }
    }

    /// The claimed address, or the one being claimed.
    #[must_use]
    pub const fn claimed_or_claiming(&self) -> Option<u8> {
        match self.state {
            ClaimState::Idle | ClaimState::CannotClaim => None,
            ClaimState::Waiting { .. } | ClaimState::Claimed => Some(self.address),
        }
    }

    /// Another node claims `address`.
    pub fn heard_claim(&mut self, address: u8, name: Name, now_ms: u32) {
        if address == NULL || address == GLOBAL || name == self.name {
            return;
        }
        self.mark_taken(address);
        if self.claimed_or_claiming() != Some(address) {
            return;
        }
        if self.name < name {
            self.owe(now_ms);
        } else {
            self.lose(now_ms);
        }
    }

    /// A node requests address claims.
    pub fn asked(&mut self, now_ms: u32) {
        match self.state {
            ClaimState::CannotClaim => self.owe(now_ms.wrapping_add(self.own_delay_ms())),
            ClaimState::Waiting { .. } | ClaimState::Claimed => self.owe(now_ms),
            ClaimState::Idle => {}
        }
    }

    /// A node commands an address. It is ignored if taken or invalid.
    pub fn commanded(&mut self, address: u8, now_ms: u32) {
        let is_new = address < NULL && self.claimed_or_claiming() != Some(address);
        if is_new && !self.is_taken(address) {
            self.address = address;
            self.begin(now_ms);
        }
    }

    /// Our NAME.
    #[must_use]
    pub const fn name(&self) -> Name {
        self.name
    }

    /// Another node sends from our address: the claim is repeated, at a limited rate.
    pub fn address_violated(&mut self, now_ms: u32) {
        if is_due(self.last_sent_ms, REMINDER_MS, now_ms) {
            self.owe(now_ms);
        }
    }

    /// The claim that is due.
    pub fn poll(&mut self, now_ms: u32) -> Option<Frame> {
        match self.state {
            ClaimState::Idle => self.begin(now_ms),
            ClaimState::Waiting {
                since_ms: Some(since),
            } if since_ms(since, now_ms) >= SILENCE_MS => self.state = ClaimState::Claimed,
            _ => {}
        }
        let due = self.due_ms.is_some_and(|due| reached(due, now_ms));
        if !(due && is_due(self.last_sent_ms, LEAST_SPACING_MS, now_ms)) {
            return None;
        }
        self.due_ms = None;
        self.last_sent_ms = Some(now_ms);
        if let ClaimState::Waiting { since_ms } = &mut self.state {
            // A contender was answered; the waiting time for other nodes continues.
            since_ms.get_or_insert(now_ms);
        }
        let source = self.claimed_or_claiming().unwrap_or(NULL);
        let id = Id::broadcast(Pgn::ADDRESS_CLAIMED, PRIORITY, source);
        Some(id.frame(self.name.to_bytes()))
    }

    fn begin(&mut self, now_ms: u32) {
        self.state = ClaimState::Waiting { since_ms: None };
        self.due_ms = Some(now_ms);
    }

    /// Schedules a claim, unless an earlier one is scheduled.
    fn owe(&mut self, at_ms: u32) {
        self.due_ms.get_or_insert(at_ms);
    }

    fn lose(&mut self, now_ms: u32) {
        match self.next_free() {
            Some(address) if self.name.is_self_configurable() => {
                self.address = address;
                self.begin(now_ms);
            }
            _ => {
                self.state = ClaimState::CannotClaim;
                self.due_ms = Some(now_ms.wrapping_add(self.own_delay_ms()));
            }
        }
    }

    /// Pseudo-random delay from the NAME, 0 to 153 ms.
    fn own_delay_ms(&self) -> u32 {
        let sum: u32 = self.name.to_bytes().into_iter().map(u32::from).sum();
        (sum & 0xFF) * 3 / 5
    }

    fn mark_taken(&mut self, address: u8) {
        if let Some(word) = self.taken.get_mut(usize::from(address >> 5)) {
            *word |= 1 << (address & 31);
        }
    }

    fn is_taken(&self, address: u8) -> bool {
        self.taken
            .get(usize::from(address >> 5))
            .is_none_or(|word| word >> (address & 31) & 1 == 1)
    }

    /// The next address after ours without a claim, cyclically.
    fn next_free(&self) -> Option<u8> {
        let after = FREE_ADDRESSES.filter(|&address| address > self.address);
        let before = FREE_ADDRESSES.filter(|&address| address < self.address);
        after.chain(before).find(|&address| !self.is_taken(address))
    }
}
