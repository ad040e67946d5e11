//! The hitch as a node on the bus: what it hears, and what it says when.

use hitch_quantities::calibration::design_parameters::RemoteParameters;
use hitch_quantities::units::{MillimetrePerSecond, RevolutionPerMinute};

use super::address_book::AddressBook;
use super::asking::Asking;
use super::claim::AddressClaim;
use super::diagnostics::{Diagnostics, LONGEST_MESSAGE, Message, Occurrences, Variant};
use super::engine::EngineSpeed;
use super::ground_speed::GroundSpeed;
use super::heartbeat::{Heartbeat, Monitor};
use super::hitch::{
    Draft, HitchCommand, HitchStatus, InWork, StatusMessage, facilities, time_until_work,
};
use super::id::{GLOBAL, Id, NULL, Pgn};
use super::machine_speed::MachineSpeed;
use super::name::Name;
use super::reception::Reception;
use super::remote::{Remote, RemoteControl, Surroundings};
use super::request::{Acknowledgement, GroupRequest, RequestQueue, acknowledged};
use super::tim::{Authority, Said, Tim, View};
use super::time::{is_due, since_ms};
use super::transport::Transport;
use crate::can::Frame;

/// The rear hitch status is repeated this often, ms.
const STATUS_PERIOD_MS: u32 = 100;
/// A status that has changed comes no closer to the last one than this, ms: a moving hitch changes it all the time.
const STATUS_SPACING_MS: u32 = 20;
/// Characters of the software's identification at most.
const LONGEST_IDENTIFICATION: usize = 40;
/// Priority of the rear hitch status and of the facilities.
const STATUS_PRIORITY: u8 = 3;
/// Priority of the heartbeat.
const HEARTBEAT_PRIORITY: u8 = 3;
/// Priority of diagnostic messages and of whatever else has no hurry.
const DIAGNOSTIC_PRIORITY: u8 = 6;

/// The address that a node asks for first unless told otherwise: the first that self-configurable nodes may take.
pub const PREFERRED_ADDRESS: u8 = 128;

/// What a node is told once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Its NAME; two nodes on a bus must differ in it.
    pub name: Name,
    /// The address that it asks for first.
    pub preferred_address: u8,
    /// How trouble codes are reported.
    pub variant: Variant,
    /// How often each trouble has occurred before this start.
    pub occurrences: Occurrences,
    /// What answers a request for the software's identification, at most 40 characters and no `*`.
    pub software: &'static [u8],
}

/// The node.
#[derive(Clone, Debug)]
pub struct Node {
    claim: AddressClaim,
    addresses: AddressBook,
    ground_speed: GroundSpeed,
    speed_by_ground: MachineSpeed,
    speed_by_wheels: MachineSpeed,
    remote: RemoteControl,
    remote_permitted: bool,
    diagnostics: Diagnostics,
    software: &'static [u8],
    requests: RequestQueue,
    transport: Transport,
    reception: Reception,
    engine: EngineSpeed,
    heartbeat: Heartbeat,
    /// The heartbeat of an implement.
    monitor: Option<Monitor>,
    asking: Asking,
    last_status: Option<([u8; 8], u32)>,
    /// When the time until in-work was sent last.
    work_sent_ms: Option<u32>,
    /// The facilities were queued after the start.
    facilities_told: bool,
    tim: Tim,
}

impl Node {
    /// A node that will claim its address with the first [`Self::poll`].
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self {
            claim: AddressClaim::new(settings.name, settings.preferred_address),
            addresses: AddressBook::default(),
            ground_speed: GroundSpeed::default(),
            speed_by_ground: MachineSpeed::default(),
            speed_by_wheels: MachineSpeed::default(),
            remote: RemoteControl::default(),
            remote_permitted: false,
            diagnostics: Diagnostics::new(settings.variant, &settings.occurrences),
            software: settings.software,
            requests: RequestQueue::default(),
            transport: Transport::default(),
            reception: Reception::default(),
            engine: EngineSpeed::default(),
            heartbeat: Heartbeat::default(),
            monitor: None,
            asking: Asking::default(),
            last_status: None,
            work_sent_ms: None,
            facilities_told: false,
            tim: Tim::default(),
        }
    }

    /// The node's address, once it may be used. It changes when another node wins it.
    #[must_use]
    pub const fn address(&self) -> Option<u8> {
        self.claim.address()
    }

    /// What an implement asks of the hitch just now.
    #[must_use]
    pub fn remote(&self) -> Remote {
        self.remote.remote()
    }

    /// State of remote control: 0 idle, 1 requested, 2 consented, 3 active.
    #[must_use]
    pub const fn remote_state(&self) -> u8 {
        self.remote.state_code()
    }

    /// Takes the bounds of remote control; those of the nominal calibration unless told otherwise.
    pub fn bound_remote_control(&mut self, parameters: RemoteParameters) {
        self.remote.set_parameters(parameters);
    }

    /// Sets who may command the hitch by Tractor Implement Management; without a call nobody may.
    pub fn set_tim_authority(&mut self, authority: Authority) {
        self.tim.set_authority(authority);
    }

    /// Engine speed; none while no engine tells it.
    #[must_use]
    pub fn engine_speed(&self, now_ms: u32) -> Option<RevolutionPerMinute> {
        self.engine.speed(now_ms)
    }

    /// Accepts the engine speed from these addresses only; 0 and 1 unless told otherwise.
    pub fn accept_engine_speed_from(&mut self, sources: [u8; 2]) {
        self.engine.accept_from(sources);
    }

    /// Speed over the ground, if it was received since the last call.
    pub const fn take_ground_speed(&mut self) -> Option<MillimetrePerSecond> {
        self.speed_by_ground.take()
    }

    /// Speed of the driven wheels, if it was received since the last call.
    pub const fn take_wheel_speed(&mut self) -> Option<MillimetrePerSecond> {
        self.speed_by_wheels.take()
    }

    /// How often each trouble has occurred.
    #[must_use]
    pub const fn occurrences(&self) -> &Occurrences {
        self.diagnostics.occurrences()
    }

    /// Takes a frame from the bus. What isn't J1939, isn't for this node or is malformed changes nothing.
    pub fn receive(&mut self, frame: &Frame, now_ms: u32) {
        let Some(id) = frame.extended_data_id().map(Id::unpack) else {
            return;
        };
        if id.pgn == Pgn::REQUEST {
            if let Some(request) = GroupRequest::from_message(&id, frame.data()) {
                self.requested(request, id.destination, now_ms);
            }
        } else if let (Pgn::HEARTBEAT, &[number]) = (id.pgn, frame.data()) {
            self.monitor = Monitor::heard(self.monitor, id.source, number, now_ms);
        } else if let Some(bytes) = frame.eight() {
            self.receive_eight(&id, bytes, now_ms);
        }
    }

    fn receive_eight(&mut self, id: &Id, bytes: &[u8; 8], now_ms: u32) {
        if id.pgn == Pgn::ADDRESS_CLAIMED {
            let name = Name::from_bytes(*bytes);
            self.addresses.claimed(id.source, name);
            self.asking.claimed(id.source);
            self.remote.claimed(id.source, name, now_ms);
            return self.claim.heard_claim(id.source, name, now_ms);
        }
        if id.source >= NULL {
            return;
        }
        if Some(id.source) == self.address() {
            return self.claim.address_violated(now_ms);
        }
        let for_us = Some(id.destination) == self.address();
        let for_all = id.destination == GLOBAL;
        match id.pgn {
            Pgn::HITCH_COMMANDS => {
                self.commanded(HitchCommand::from_bytes(bytes), id.source, now_ms);
            }
            Pgn::WHEEL_SPEED | Pgn::GROUND_SPEED => {
                let limit = self.remote.parameters().ground_speed;
                self.ground_speed.receive(bytes, limit, now_ms);
                match id.pgn {
                    Pgn::GROUND_SPEED => self.speed_by_ground.receive(bytes, id.source, now_ms),
                    _ => self.speed_by_wheels.receive(bytes, id.source, now_ms),
                }
            }
            Pgn::ENGINE => self.engine.receive(bytes, id.source, now_ms),
            Pgn::TRANSPORT_CONNECTION if for_us || for_all => {
                self.reception.manage(bytes, id.source, for_all, now_ms);
                if for_us {
                    self.transport.receive(bytes, id.source, now_ms);
                }
            }
            Pgn::TRANSPORT_DATA if for_us || for_all => {
                let message = self.reception.packet(bytes, id.source, for_all, now_ms);
                // Nothing else is received: a NAME and the address that it has to take.
                if let Some([name @ .., address]) =
                    message.and_then(|bytes| bytes.into_array::<9>().ok())
                    && Name::from_bytes(name) == self.claim.name()
                {
                    self.claim.commanded(address, now_ms);
                }
            }
            Pgn::REPETITION_RATE if for_us || for_all => {
                let [a, b, c, ..] = *bytes;
                if Pgn::from_bytes([a, b, c]) == Pgn::HEARTBEAT {
                    self.heartbeat.asked();
                }
            }
            Pgn::TIM_CLIENT | Pgn::AUTHENTICATION_CLIENT if for_us => {
                let name = self.addresses.name(id.source);
                if let Some(command) = self.tim.receive(id, bytes, name, now_ms) {
                    self.commanded(command, id.source, now_ms);
                }
            }
            Pgn::REQUIRED_FACILITIES if self.address().is_some() => {
                self.requests
                    .push(GroupRequest::of_all(Pgn::TRACTOR_FACILITIES));
            }
            _ => {}
        }
    }

    /// A node commands the hitch. Who begins to is asked for a heartbeat, and so is one whose heartbeat is broken. Who
    /// is unknown is asked for its claim.
    fn commanded(&mut self, command: HitchCommand, source: u8, now_ms: u32) {
        let condemned = self.is_condemned(source, now_ms);
        let before = self.remote.owner();
        let too_fast = self.ground_speed.is_exceeded(now_ms);
        let permitted =
            self.remote_permitted && self.address().is_some() && !condemned && !too_fast;
        let name = self.addresses.name(source);
        if name.is_none() {
            self.asking.for_claim(source);
        }
        let implement = name.filter(|name| name.is_implement());
        self.remote
            .command(command, source, implement, permitted, now_ms);
        let begins = before.is_none() && self.remote.owner().is_some();
        if begins || condemned {
            self.asking.for_heartbeat(source);
        }
    }

    /// True if the heartbeat of a node says that it doesn't think any more.
    fn is_condemned(&self, node: u8, now_ms: u32) -> bool {
        self.monitor
            .is_some_and(|monitor| monitor.condemns(node, now_ms))
    }

    fn requested(&mut self, request: GroupRequest, destination: u8, now_ms: u32) {
        if !request.global && Some(destination) != self.claim.claimed_or_claiming() {
        } else if request.group == Pgn::ADDRESS_CLAIMED {
            self.claim.asked(now_ms);
        } else if self.address().is_some() {
            self.requests.push(request);
        }
    }

    /// The next frame that is due. Called once a millisecond or more, until it gives none.
    pub fn poll(&mut self, now_ms: u32, status: &HitchStatus) -> Option<Frame> {
        self.remote_permitted = status.remote_permitted;
        self.engine.update(now_ms);
        self.speed_by_ground.update(now_ms);
        self.speed_by_wheels.update(now_ms);
        let owner = self.remote.owner();
        let around = Surroundings {
            condemned: owner.is_some_and(|owner| self.is_condemned(owner, now_ms)),
            too_fast: self.ground_speed.is_exceeded(now_ms),
            has_address: self.address().is_some(),
        };
        self.remote.update(status, around, now_ms);
        self.diagnostics.update(status.troubles);
        self.tim.update(self.tim_view(status), now_ms);
        let claim = self.claim.poll(now_ms);
        let Some(source) = self.claim.address() else {
            // What was begun under an address ends with it.
            self.transport.reset();
            self.requests.clear();
            self.reception = Reception::default();
            self.heartbeat = Heartbeat::default();
            self.asking.forget();
            self.tim.reset();
            return claim;
        };
        if !self.facilities_told {
            self.facilities_told = true;
            self.requests
                .push(GroupRequest::of_all(Pgn::TRACTOR_FACILITIES));
        }
        claim
            .or_else(|| self.hitch_status(source, now_ms, status))
            .or_else(|| self.hitch_work(source, now_ms, status))
            .or_else(|| self.beat(source, now_ms))
            .or_else(|| self.tim(source, now_ms))
            .or_else(|| self.transport.poll(source, now_ms))
            .or_else(|| self.periodic_dm1(source, now_ms))
            .or_else(|| self.reception.poll(source, now_ms))
            .or_else(|| self.asking.poll(source, now_ms))
            .or_else(|| self.answer(source, now_ms, status))
    }

    fn hitch_status(&mut self, source: u8, now_ms: u32, status: &HitchStatus) -> Option<Frame> {
        let message = self.status_message(status, now_ms);
        let bytes = message.to_bytes();
        if let Some((last, sent_ms)) = self.last_status {
            let age_ms = since_ms(sent_ms, now_ms);
            let changed = StatusMessage::differs(&bytes, &last) && age_ms >= STATUS_SPACING_MS;
            if !changed && age_ms < STATUS_PERIOD_MS {
                return None;
            }
        }
        self.last_status = Some((bytes, now_ms));
        self.remote.reported(message.position);
        Some(Id::broadcast(Pgn::REAR_HITCH_STATUS, STATUS_PRIORITY, source).frame(bytes))
    }

    /// Time until the implement is in work, if there is a threshold.
    fn hitch_work(&mut self, source: u8, now_ms: u32, status: &HitchStatus) -> Option<Frame> {
        let is_due = is_due(self.work_sent_ms, STATUS_PERIOD_MS, now_ms);
        if status.in_work == InWork::NotAvailable || !is_due {
            return None;
        }
        self.work_sent_ms = Some(now_ms);
        let id = Id::broadcast(Pgn::HITCH_WORK, DIAGNOSTIC_PRIORITY, source);
        Some(id.frame(time_until_work(status.time_until_work)))
    }

    fn status_message(&self, status: &HitchStatus, now_ms: u32) -> StatusMessage {
        StatusMessage::new(
            status,
            self.remote.limit_status(status),
            self.remote.exit_code(status, now_ms),
        )
    }

    fn periodic_dm1(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        if !self.diagnostics.due(now_ms) || !self.transport.has_room(GLOBAL) {
            return None;
        }
        self.diagnostics.sent(now_ms);
        let message = self.diagnostics.dm1();
        self.send(Pgn::DM1, &message, GLOBAL, source, now_ms)
    }

    fn beat(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        let number = self.heartbeat.poll(now_ms)?;
        let id = Id::broadcast(Pgn::HEARTBEAT, HEARTBEAT_PRIORITY, source).pack();
        Frame::data_frame(id.into(), &[number])
    }

    fn tim_view(&self, status: &HitchStatus) -> View {
        let owner = self.remote.owner();
        let name = owner.and_then(|owner| self.addresses.name(owner));
        let is_client = name.is_some() && name == self.tim.client();
        View {
            exit: status.exit,
            is_offered: self.remote.is_offered(),
            stage: if is_client { self.remote_state() } else { 0 },
            limit: self.remote.limit_status(status),
            position: status
                .position
                .and_then(|position| u16::try_from(position.0).ok()),
            reported: self.remote.last_reported(),
        }
    }

    /// Not inlined, so that the frame of `poll` does not hold its message.
    #[inline(never)]
    fn tim(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        let has_room = self.transport.has_room(GLOBAL);
        match self.tim.poll(source, has_room, now_ms)? {
            Said::Frame(frame) => Some(frame),
            Said::Message(message) => {
                let message = message.into_iter().collect();
                self.send(Pgn::TIM_SERVER, &message, GLOBAL, source, now_ms)
            }
        }
    }

    fn answer(&mut self, source: u8, now_ms: u32, status: &HitchStatus) -> Option<Frame> {
        let request = self.requests.next(now_ms)?;
        let message = match request.group {
            Pgn::REAR_HITCH_STATUS => {
                let bytes = self.status_message(status, now_ms).to_bytes();
                return Some(Id::broadcast(request.group, STATUS_PRIORITY, source).frame(bytes));
            }
            Pgn::TRACTOR_FACILITIES => {
                let bytes = facilities(
                    self.remote.is_offered(),
                    status.draft != Draft::NotFitted,
                    status.in_work != InWork::NotAvailable,
                );
                return Some(Id::broadcast(request.group, STATUS_PRIORITY, source).frame(bytes));
            }
            Pgn::DM1 => self.diagnostics.dm1(),
            Pgn::DM2 => self.diagnostics.dm2(),
            Pgn::SOFTWARE_IDENTIFICATION => identification(self.software),
            Pgn::DM3 => {
                self.diagnostics.clear_previous();
                return acknowledged(Acknowledgement::Positive, &request, source);
            }
            _ => return acknowledged(Acknowledgement::Negative, &request, source),
        };
        let destination = if request.global { GLOBAL } else { request.from };
        if self.transport.has_room(destination) {
            self.send(request.group, &message, destination, source, now_ms)
        } else if request.global {
            // Nobody can be told to ask again, so it waits for the end of the broadcast that is under way.
            self.requests.push(request);
            None
        } else {
            acknowledged(Acknowledgement::CannotRespond, &request, source)
        }
    }

    /// The frame of a message that fits into one, filled up with ones; else the first of a longer transport.
    fn send(
        &mut self,
        group: Pgn,
        message: &Message,
        destination: u8,
        source: u8,
        now_ms: u32,
    ) -> Option<Frame> {
        if message.len() > Frame::MOST_BYTES {
            self.transport
                .send(group, message.clone(), destination, now_ms);
            return self.transport.poll(source, now_ms);
        }
        let mut bytes = [0xFF; Frame::MOST_BYTES];
        for (target, byte) in bytes.iter_mut().zip(message) {
            *target = *byte;
        }
        Some(Id::broadcast(group, DIAGNOSTIC_PRIORITY, source).frame(bytes))
    }
}

/// Software identification: one field, ended by a `*`.
fn identification(software: &[u8]) -> Message {
    const FIELDS: u8 = 1;
    let text = software.iter().take(LONGEST_IDENTIFICATION).copied();
    let message = core::iter::once(FIELDS).chain(text).chain([b'*']);
    message.take(LONGEST_MESSAGE).collect()
}
