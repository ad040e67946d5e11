//! A random day of operation of the ECU: an operator, an implement, a tool, a noisy bus, faults and power cuts.
//!
//! It runs on the host with the plant in closed loop. The inputs and outputs of the ECU are recorded, so that the
//! emulated ECU can be run with the same inputs.

use anyhow::Result;
use fastrand::Rng;
use hitch_ecu::link::{Reply, Request, frame_to_bytes};
use hitch_ecu::{AdcCode, Contact, Contacts, Panel, Samples};
use hitch_ecu_host::ecu::{Bench, CutFlash, EcuMachine, OnHost, Operator};
use hitch_protocols::can::{ExtendedId, Frame, Id, StandardId};
use hitch_quantities::{State, Trip};

/// Inputs and outputs of the ECU as bytes on its link, and its flash at the end.
#[derive(Debug, Default)]
pub struct Day {
    /// Requests.
    pub requests: Vec<u8>,
    /// Replies.
    pub replies: Vec<u8>,
    /// Flash at the end.
    pub flash: Vec<u8>,
    /// How often each state was seen, by its code.
    pub states: [u64; 16],
    /// How often each fault was seen, by its code.
    pub faults: [u64; 16],
    /// Frames that the ECU said.
    pub frames: u64,
    /// Milliseconds with a coil on.
    pub moving_ms: u64,
    /// The ECU has tripped until it is restarted.
    is_dead: bool,
    /// The lever has to pick the hitch up.
    is_locked: bool,
}

/// Lives through `milliseconds` of a day that `seed` settles. The flash is as it was delivered.
///
/// # Errors
/// If the model is none.
pub fn live(seed: u64, milliseconds: u64, flash: Vec<u8>) -> Result<Day> {
    let model = hitch_model_file::named("dynamic")?;
    let mut random = Rng::with_seed(seed);
    let mut bench = Bench::new(&model, random.f64() * 250.0, 40.0, 90.0, seed);
    let cells = CutFlash::holding(flash);
    let mut machine = OnHost::start(cells.clone());
    let mut day = Day::default();
    let mut fault = Tampering::default();
    let mut habits = Habits::default();
    let mut said = Vec::new();
    for _ in 0..milliseconds {
        let here_deg = bench.angle_deg();
        habits.act(&mut bench.operator, here_deg, day.is_locked, &mut random);
        fault.change(&mut random);
        // Some faults are permanent; the power is then switched off and on.
        let often = if day.is_dead { 3_000 } else { 120_000 };
        if random.u32(0..often) == 0 {
            machine.power_cycle()?;
            day.requests.extend(Request::PowerCycle.to_bytes());
        }
        let served = bench.operator.panel.is_closed(Contact::Service);
        let heard = traffic(&mut random, here_deg, served);
        said.clear();
        let moment = bench.tick_with(&mut machine, &heard, &mut said, |contacts| {
            fault.tamper(contacts);
        })?;
        day.note(&moment.contacts, &heard, &moment.reply, &said);
    }
    day.flash = cells.bytes();
    Ok(day)
}

impl Day {
    fn note(&mut self, contacts: &Contacts, heard: &[Frame], reply: &Reply, said: &[Frame]) {
        let request = Request::Tick {
            contacts: *contacts,
            frames: heard.len(),
        };
        self.requests.extend(request.to_bytes());
        self.requests.extend(heard.iter().flat_map(frame_to_bytes));
        self.replies.extend(reply.to_bytes());
        self.replies.extend(said.iter().flat_map(frame_to_bytes));
        self.states[usize::from(reply.state) % 16] += 1;
        self.faults[usize::from(reply.fault) % 16] += 1;
        self.frames += said.len() as u64;
        self.moving_ms += u64::from(reply.enable);
        self.is_locked = reply.state == State::Locked as u8;
        self.is_dead = Trip::ALL
            .into_iter()
            .any(|trip| trip as u8 == reply.trip && trip.is_final());
    }
}

/// The operator acts every other second. Each switch is switched back some seconds later.
#[derive(Default)]
struct Habits {
    undone_in_ms: u32,
}

impl Habits {
    fn act(&mut self, operator: &mut Operator, here_deg: f64, locked: bool, random: &mut Rng) {
        if locked && random.u32(0..500) == 0 {
            // Picks the hitch up, from wherever the lever is.
            operator.lever_target_deg = here_deg + random.f64() * 20.0 - 10.0;
        }
        self.undone_in_ms = self.undone_in_ms.saturating_sub(1);
        if self.undone_in_ms == 1 {
            *operator = Operator {
                panel: Panel::FIELD,
                lowering_dial: 1.0,
                upper_limit_deg: 145.0,
                ..*operator
            };
        }
        if random.u32(0..2_000) != 0 {
            return;
        }
        match random.u8(0..16) {
            0..=10 => operator.lever_target_deg = 42.0 + random.f64() * 96.0,
            11 => operator.lowering_dial = random.f64(),
            12 => operator.upper_limit_deg = 60.0 + random.f64() * 85.0,
            // A mechanic has come: locked, and service on.
            13 => {
                let locked = operator.panel.with(Contact::FieldMode, false);
                operator.panel = locked.with(Contact::Service, true);
            }
            // Teaching by a mechanic, with an interruption.
            14 => {
                let served = operator.panel.with(Contact::Service, true);
                operator.panel = served.with_buttons(true, false);
            }
            _ => {
                let contact = Panel::CONTACTS[random.usize(0..Panel::CONTACTS.len())];
                let panel = operator.panel;
                operator.panel = match contact {
                    Contact::Up => panel.with_buttons(true, false),
                    Contact::Down => panel.with_buttons(false, true),
                    _ => panel.with(contact, !Panel::FIELD.is_closed(contact)),
                };
            }
        }
        if self.undone_in_ms == 0 {
            self.undone_in_ms = random.u32(500..6_000);
        }
    }
}

/// A fault of a wire or a sensor, for a while.
#[derive(Default)]
struct Tampering {
    left_ms: u32,
    channel: usize,
    kind: u8,
    stuck: Option<AdcCode>,
}

impl Tampering {
    fn change(&mut self, random: &mut Rng) {
        self.left_ms = self.left_ms.saturating_sub(1);
        if self.left_ms == 0 && random.u32(0..20_000) == 0 {
            *self = Self {
                left_ms: random.u32(1..1_500),
                channel: random.usize(0..Samples::CHANNELS),
                kind: random.u8(0..5),
                stuck: None,
            };
        }
    }

    fn tamper(&mut self, contacts: &mut Contacts) {
        if self.left_ms == 0 {
            return;
        }
        if self.kind == 4 {
            // A late step, by the other clock.
            contacts.clock_us = contacts.clock_us.wrapping_add(700);
            return;
        }
        let mut codes = contacts.samples.codes();
        let code = &mut codes[self.channel];
        *code = match self.kind {
            0 => AdcCode::default(),
            1 => AdcCode::MAX,
            2 => *self.stuck.get_or_insert(*code),
            _ => AdcCode::new(code.get().wrapping_mul(self.left_ms as u16)),
        };
        contacts.samples = Samples::from_codes(codes);
    }
}

/// Frames of other nodes in a millisecond: mostly none, more while a tool is connected (`served`).
fn traffic(random: &mut Rng, angle_deg: f64, served: bool) -> Vec<Frame> {
    let busy = if served { 200 } else { 20 };
    // A storm now and then: more than the bus can carry.
    let count = match random.u16(0..1_000) {
        500.. if random.u16(0..500) < busy => 1,
        20 => random.usize(1..=8),
        _ => 0,
    };
    (0..count).map(|_| frame(random, angle_deg)).collect()
}

fn frame(random: &mut Rng, angle_deg: f64) -> Frame {
    let mut bytes: [u8; 8] = random.u64(..).to_le_bytes();
    let bits = match random.u8(0..10) {
        // An implement that commands the hitch, often from where it is.
        0..=2 => {
            let here = ((angle_deg - 45.0) / 90.0 * 250.0).clamp(0.0, 250.0) as u8;
            bytes[1] = *random
                .choice(&[here, here, bytes[1], 0xFF])
                .unwrap_or(&here);
            0x0CFE_42F0
        }
        // A tool, with commands that mean something.
        3..=6 => {
            bytes = tool_command(random, bytes);
            0x18EF_80F9
        }
        // Another node claims our address: the tool gets no answers until the next start.
        7 if random.u8(0..100) == 0 => 0x18EE_FF80,
        7 => *random
            .choice(&[0x18EA_80F9, 0x18EE_FF85, 0x18EC_80F0, 0x18EB_80F0])
            .unwrap_or(&0),
        _ => random.u32(..) & 0x1FFF_FFFF,
    };
    let length = if random.u8(0..8) == 0 {
        random.usize(0..=8)
    } else {
        8
    };
    let id = match random.u8(0..12) {
        0 => Id::Standard(StandardId::new((bits & 0x7FF) as u16).unwrap_or(StandardId::ZERO)),
        _ => Id::Extended(ExtendedId::new(bits).unwrap_or(ExtendedId::ZERO)),
    };
    match random.u8(0..40) {
        0 => Frame::remote_frame(id, length),
        _ => Frame::data_frame(id, &bytes[..length]),
    }
    .expect("a length of at most eight")
}

/// A command of XCP.
fn tool_command(random: &mut Rng, bytes: [u8; 8]) -> [u8; 8] {
    let [_, a, b, c, d, e, f, g] = bytes;
    let word = random.u32(0..320) * 4;
    let [w0, w1, w2, _] = word.to_le_bytes();
    match random.u8(0..12) {
        0..=2 => [0xFF, 0, 0, 0, 0, 0, 0, 0],
        3 => [0xF6, 0, 0, 0, w0, w1, w2, 0x10],
        // A small change of some number.
        4 => [0xF0, 4, a, b & 0x0F, 0, 0, 0, 0],
        5 => [0xF4, 4, 0, 0, w0, w1, w2, 0x20],
        6 => [0xF9, 1, 0, 0, 0, 0, 0, 0],
        7 => [0xE4, 0, 1, 0, 0, 0, 0, 0],
        8 => [0xFD, 0, 0, 0, 0, 0, 0, 0],
        9 => [0xD5, 0, 2, 0, 0, 0, 0, 0],
        _ => [0xD0 | (a & 0x2F), b, c, d, e, f, g, 0],
    }
}
