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
//! A claim on our address by a higher NAME is answered with our own; the NAME that is equal to ours is an echo.

use super::id::{GLOBAL, Id, NULL, Pgn};
use super::name::Name;
use super::time::{reached, since_ms};
use crate::can::Frame;

/// Silence after a claim, ms.
pub const SILENCE_MS: u32 = 250;
/// Answers to claims come no closer than this, ms: a node that babbles claims is not joined by another one.
const LEAST_SPACING_MS: u32 = 5;
/// Who uses our address without a claim is reminded no more often than this, ms.
const REMINDER_MS: u32 = 5_000;
/// Addresses that self-configurable nodes choose from.
const FREE_ADDRESSES: core::ops::RangeInclusive<u8> = 128..=247;
/// Priority of a claim.
const PRIORITY: u8 = 6;

/// Where a node stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ClaimState {
    /// Nothing was sent yet.
    Idle,
    /// A claim is to be sent, or was sent at `since_ms`.
    Waiting { since_ms: Option<u32> },
    /// The address is ours.
    Claimed,
    /// There is none for us.
    CannotClaim,
}

/// The machine that claims.
#[derive(Clone, Debug)]
pub struct AddressClaim {
    name: Name,
    address: u8,
    state: ClaimState,
    /// When a claim or "cannot claim" is due, if one is owed.
    due_ms: Option<u32>,
    last_sent_ms: Option<u32>,
    /// A bit for each address that somebody has claimed.
    taken: [u32; 8],
}

impl AddressClaim {
    /// A node that will claim `preferred` with the first [`Self::poll`].
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

    /// Our address, once it may be used.
    #[must_use]
    pub const fn address(&self) -> Option<u8> {
        match self.state {
            ClaimState::Claimed => Some(self.address),
            _ => None,
        }
    }

    /// The address that is ours or that we are claiming.
    #[must_use]
    pub const fn claimed_or_claiming(&self) -> Option<u8> {
        match self.state {
            ClaimState::Idle | ClaimState::CannotClaim => None,
            ClaimState::Waiting { .. } | ClaimState::Claimed => Some(self.address),
        }
    }

    /// Somebody claims `address`.
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

    /// Somebody asks who is there.
    pub fn asked(&mut self, now_ms: u32) {
        match self.state {
            ClaimState::CannotClaim => self.owe(now_ms.wrapping_add(self.own_delay_ms())),
            ClaimState::Waiting { .. } | ClaimState::Claimed => self.owe(now_ms),
            ClaimState::Idle => {}
        }
    }

    /// Somebody commands us to take an address. One that is taken, or none at all, is not worth losing ours.
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

    /// Somebody else sends from our address: our claim reminds them, now and then.
    pub fn address_violated(&mut self, now_ms: u32) {
        let reminded = self
            .last_sent_ms
            .is_some_and(|last| since_ms(last, now_ms) < REMINDER_MS);
        if !reminded {
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
        let spaced = self
            .last_sent_ms
            .is_none_or(|last| since_ms(last, now_ms) >= LEAST_SPACING_MS);
        if !(due && spaced) {
            return None;
        }
        self.due_ms = None;
        self.last_sent_ms = Some(now_ms);
        if let ClaimState::Waiting { since_ms } = &mut self.state {
            // A contender was answered: the wait is for those who haven't heard us yet, so it goes on.
            since_ms.get_or_insert(now_ms);
        }
        let source = self.claimed_or_claiming().unwrap_or(NULL);
        let id = Id {
            priority: PRIORITY,
            pgn: Pgn::ADDRESS_CLAIMED,
            destination: GLOBAL,
            source,
        };
        Some(id.frame(self.name.to_bytes()))
    }

    fn begin(&mut self, now_ms: u32) {
        self.state = ClaimState::Waiting { since_ms: None };
        self.due_ms = Some(now_ms);
    }

    /// Puts a claim on the list, unless one is there that is due earlier.
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

    /// Milliseconds from 0 to 153, different for different NAMEs.
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

    /// The next address after ours that nobody has claimed, going round.
    fn next_free(&self) -> Option<u8> {
        let after = FREE_ADDRESSES.filter(|&address| address > self.address);
        let before = FREE_ADDRESSES.filter(|&address| address < self.address);
        after.chain(before).find(|&address| !self.is_taken(address))
    }
}
