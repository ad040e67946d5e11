//! GET_SEED and UNLOCK: the session's right to loosen safety values.

use super::error::Refusal;
use super::map::EcuMemory;
use super::packet::{Answer, MOST_BYTES, response};
use crate::key::{RESPONSE_BYTES, SEED_BYTES, Secret, Seed};

/// Bytes of seed or key in a packet, after code and length.
const PIECE: usize = MOST_BYTES - 2;
/// Time after a wrong key until the next challenge, ms.
const DELAY_MS: u16 = 10_000;
/// The resource that the key opens: calibrating and paging.
pub(super) const CALIBRATION: u8 = 0x01;

/// A challenge that waits for its response.
#[derive(Clone, Copy, Debug)]
struct Challenge {
    seed: Seed,
    sent: usize,
    response: [u8; RESPONSE_BYTES],
    received: usize,
}

impl Challenge {
    const fn new(seed: Seed) -> Self {
        Self {
            seed,
            sent: 0,
            response: [0; RESPONSE_BYTES],
            received: 0,
        }
    }

    /// The next piece of the seed, after the number of bytes that are left with it.
    fn next_piece(&mut self) -> Answer {
        let rest = self.seed.get(self.sent..).unwrap_or(&[]);
        let mut packet = [0; 1 + PIECE];
        let left = u8::try_from(rest.len()).unwrap_or(0);
        let bytes = [left].into_iter().chain(rest.iter().copied());
        packet
            .iter_mut()
            .zip(bytes)
            .for_each(|(target, byte)| *target = byte);
        let length = rest.len().min(PIECE);
        self.sent = self.sent.saturating_add(length);
        response(packet.get(..length.saturating_add(1)).unwrap_or(&[]))
    }

    /// Takes a piece of the response, whose length tells the bytes that are left with it.
    fn take_piece(&mut self, left: u8, bytes: &[u8]) -> Result<(), Refusal> {
        let rest = self.response.get_mut(self.received..).unwrap_or(&mut []);
        if usize::from(left) != rest.len() {
            return Err(Refusal::Sequence);
        }
        let length = rest.len().min(PIECE);
        let bytes = bytes.get(..length).ok_or(Refusal::Syntax)?;
        rest.iter_mut()
            .zip(bytes)
            .for_each(|(target, byte)| *target = *byte);
        self.received = self.received.saturating_add(length);
        Ok(())
    }
}

/// State of the key in a session. The right ends with the session, when tuning is no longer enabled on the machine,
/// and with a storing.
#[derive(Clone, Debug, Default)]
pub(super) struct Unlocking {
    secret: Option<Secret>,
    challenge: Option<Challenge>,
    is_open: bool,
    wait_ms: u16,
}

impl Unlocking {
    /// Locked; for good without a secret.
    pub(super) fn new(secret: Option<Secret>) -> Self {
        Self {
            secret,
            ..Self::default()
        }
    }

    pub(super) const fn is_open(&self) -> bool {
        self.is_open
    }

    /// Locks. The time after a wrong key goes on.
    pub(super) const fn close(&mut self) {
        self.is_open = false;
        self.challenge = None;
    }

    /// A millisecond.
    pub(super) fn step(&mut self, memory: &EcuMemory<'_>) {
        self.wait_ms = self.wait_ms.saturating_sub(1);
        if !memory.may_calibrate() {
            self.close();
        }
    }

    /// GET_SEED: mode, resource. Each first request makes a new challenge. A seed of no bytes means unlocked.
    pub(super) fn seed(&mut self, rest: &[u8], memory: &EcuMemory<'_>, now_us: u32) -> Answer {
        match *rest {
            [0, CALIBRATION, ..] => {
                if self.is_open {
                    return response(&[0]);
                }
                self.challenge = None;
                let is_ready = memory.may_calibrate() && self.wait_ms == 0;
                if !is_ready || self.secret.is_none() {
                    return Err(Refusal::AccessLocked);
                }
                let challenge = Challenge::new(memory.nonce.seed(now_us));
                self.challenge.insert(challenge).next_piece()
            }
            [0, _, ..] => response(&[0]),
            [1, ..] => match &mut self.challenge {
                Some(challenge) if challenge.sent < SEED_BYTES => challenge.next_piece(),
                _ => Err(Refusal::Sequence),
            },
            [_, _, ..] => Err(Refusal::OutOfRange),
            _ => Err(Refusal::Syntax),
        }
    }

    /// UNLOCK: number of bytes that are left, then the next ones. Answers with the resources that are protected; none
    /// is while tuning is enabled. A wrong key is [`Refusal::AccessLocked`], and the caller ends the session.
    pub(super) fn unlock(&mut self, rest: &[u8]) -> Answer {
        let [left, bytes @ ..] = rest else {
            return Err(Refusal::Syntax);
        };
        // A refusal uses the challenge up.
        let challenge = self.challenge.take();
        let mut challenge = challenge
            .filter(|challenge| challenge.sent == SEED_BYTES)
            .ok_or(Refusal::Sequence)?;
        challenge.take_piece(*left, bytes)?;
        if challenge.received < RESPONSE_BYTES {
            self.challenge = Some(challenge);
            return response(&[0]);
        }
        self.is_open = self
            .secret
            .as_ref()
            .is_some_and(|secret| secret.accepts(&challenge.seed, &challenge.response));
        if !self.is_open {
            self.wait_ms = DELAY_MS;
            return Err(Refusal::AccessLocked);
        }
        response(&[0])
    }
}
