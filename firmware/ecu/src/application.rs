//! The application: its parts, and their order within a millisecond.

use embedded_storage::nor_flash::NorFlash;
use heapless::Deque;
use hitch_controller::Controller;
use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{
    MeasuredBroadcast, NameFields, Node, PREFERRED_ADDRESS, Remote, Settings, TroubleFinder,
    Variant,
};
use hitch_protocols::key::{Nonce, Secret};
use hitch_protocols::storage::CalibrationStore;
use hitch_protocols::storage::fault_history::FaultHistory;
use hitch_protocols::xcp::angle_noise::AngleNoise;
use hitch_protocols::xcp::map::IDENTITY;
use hitch_protocols::xcp::measurements::{EcuState, Measurements};
use hitch_protocols::xcp::{Access, EcuMemory, Event, Slave};
use hitch_quantities::signals::charge::CoilCharge;
use hitch_quantities::{Inputs, Outputs, State, ValidCalibration};

use super::adc_code::AdcCode;
use super::arbiter::Arbiter;
use super::bus_watch::BusWatch;
use super::consent::ConsentWatch;
use super::converter::Conversion;
use super::drive::Drive;
use super::enable_line::EnableLine;
use super::hardware::{Contacts, FlashRegions, Hardware};
use super::panel::Contact;
use super::scaling::BoardScaling;
use super::service::{Service, Storing};
use super::set_points::with_set_points;
use super::start_check::StartCheck;
use super::status::status;
use super::task_sequence_monitor::{Kick, Task, TaskSequenceMonitor};
use super::tick_timer::TickTimer;
use crate::service;

/// Largest number of received frames in a millisecond: twice the capacity of a bus of 250 kbit/s.
const MAX_RECEIVED: usize = 8;
/// Largest number of frames created in a millisecond.
const MAX_SENT: usize = 4;
/// Capacity of the transmit queue, frames.
const OUTBOX: usize = 8;
/// The address of a node without address.
const NO_ADDRESS: u8 = 254;

/// The ECU.
#[derive(Debug)]
pub struct Ecu<F> {
    controller: Controller,
    conversion: Conversion,
    pwm_steps: u16,
    enable_line: EnableLine,
    arbiter: Arbiter,
    consent: ConsentWatch,
    /// The operator consents to remote control in this step.
    consents: bool,
    service: Service<F>,
    start_check: StartCheck,
    bus_watch: BusWatch,
    history: FaultHistory<F>,
    node: Node,
    measured: MeasuredBroadcast,
    trouble_finder: TroubleFinder,
    slave: Slave,
    measurements: Measurements,
    charge: CoilCharge,
    angle_noise: AngleNoise,
    nonce: Nonce,
    outbox: Deque<Frame, OUTBOX>,
    tick_timer: TickTimer,
    task_sequence: TaskSequenceMonitor,
    inputs: Inputs,
    outputs: Outputs,
}

impl<F: NorFlash> Ecu<F> {
    /// The ECU as it is after power-up, with the calibration and the fault history that `flash` holds. `serial_number`
    /// tells its node from others on the bus; `scaling` is the board's. The function is not inlined, so that its
    /// stack is released before the loop begins.
    #[must_use]
    #[inline(never)]
    pub fn start(flash: FlashRegions<F>, serial_number: u32, scaling: BoardScaling) -> Self {
        let mut store = CalibrationStore::new(flash.calibration);
        let start = service::load(&mut store, scaling.fitted);
        let mut key = flash.key;
        let history = FaultHistory::open(flash.fault_log);
        let settings = Settings {
            name: NameFields::rear_hitch(serial_number).into(),
            preferred_address: PREFERRED_ADDRESS,
            variant: Variant::J1939,
            occurrences: *history.stored(),
            software: &IDENTITY,
        };
        Self {
            service: Service::new(store, &start),
            start_check: StartCheck::default(),
            bus_watch: BusWatch::default(),
            history,
            controller: Controller::new(start.calibration),
            conversion: Conversion::new(scaling),
            pwm_steps: scaling.pwm_steps,
            enable_line: EnableLine::default(),
            arbiter: Arbiter::default(),
            consent: ConsentWatch::default(),
            consents: false,
            node: Node::new(settings),
            measured: MeasuredBroadcast::default(),
            trouble_finder: TroubleFinder::default(),
            slave: Slave::new(Secret::load(&mut key)),
            measurements: Measurements::default(),
            charge: CoilCharge::default(),
            angle_noise: AngleNoise::default(),
            nonce: Nonce {
                serial_number,
                ..Nonce::default()
            },
            outbox: Deque::new(),
            tick_timer: TickTimer::default(),
            task_sequence: TaskSequenceMonitor::default(),
            inputs: Inputs::default(),
            outputs: Outputs::default(),
        }
    }

    /// Reports what the board has found at its start, and locks the hitch if that demands it. Called before the first
    /// millisecond.
    pub const fn report(&mut self, check: StartCheck) {
        self.start_check = check;
    }

    /// One millisecond. Returns the permission to reset the watchdog, if all tasks have run. Not inlined: the stack
    /// depth is computed separately from that of the start.
    #[inline(never)]
    pub fn tick(&mut self, contacts: &Contacts, hardware: &mut impl Hardware) -> Option<Kick> {
        self.sample(contacts);
        self.task_sequence.passed(Task::Sample);
        self.controller.control(&self.inputs);
        self.task_sequence.passed(Task::Control);
        self.outputs = self.controller.protect(&self.inputs);
        let wanted = Drive::new(&self.outputs, self.pwm_steps);
        let has_feedback = contacts.enable_feedback.is_some();
        hardware.drive(self.enable_line.pass(wanted, has_feedback));
        self.task_sequence.passed(Task::Drive);
        self.serve_bus(contacts, hardware);
        self.task_sequence.passed(Task::Bus);
        self.task_sequence.end()
    }

    /// Whether a calibration is being stored, with both coils off and locked: a millisecond then takes as long as the
    /// flash operation.
    #[must_use]
    pub const fn is_storing(&self) -> bool {
        self.service.is_storing()
    }

    /// The calibration in use.
    #[must_use]
    pub fn calibration(&self) -> &ValidCalibration {
        self.controller.calibration()
    }

    /// Inputs of the controller in the last millisecond.
    #[must_use]
    pub const fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Outputs of the controller in the last millisecond.
    #[must_use]
    pub const fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    fn sample(&mut self, contacts: &Contacts) {
        let samples = &contacts.samples;
        let inputs = self.conversion.inputs(samples);
        let dial = self.conversion.set_point_dial(samples);
        let mut inputs = with_set_points(inputs, dial, self.controller.calibration());
        inputs = contacts.panel.added_to(inputs);
        inputs.step_time = self.tick_timer.begin(contacts.clock_us);
        inputs.clock_ratio = contacts.clock_ratio;
        inputs.engine_speed = self.node.engine_speed(self.tick_timer.now_ms());
        inputs.ground_speed = self.node.take_ground_speed();
        inputs.wheel_speed = self.node.take_wheel_speed();
        inputs.enable_line_fault = self.enable_line.read(contacts.enable_feedback);
        // Some microcontrollers stop while their flash is erased: no motion is allowed then, nor without safety values,
        // nor on a board whose start has found something that forbids it.
        inputs.switches.transport_lock |= self.service.has_to_lock() || self.start_check.locks;
        let calibration = self.controller.calibration();
        self.consents = self.consent.update(&inputs, calibration.remote.consent);
        self.inputs = self
            .arbiter
            .decide(inputs, self.node.remote(), &calibration.position);
    }

    fn serve_bus(&mut self, contacts: &Contacts, hardware: &mut impl Hardware) {
        let access = self.access(contacts);
        self.nonce.safety_sequence = self.service.safety_sequence();
        self.nonce.stir(contacts.samples.codes().map(AdcCode::get));
        let frames_dropped = hardware.frames_dropped();
        self.bus_watch.update(hardware.is_bus_off(), frames_dropped);
        self.measure(frames_dropped);
        self.receive(access, contacts.clock_us, hardware);
        self.sample_for_tool(access, contacts.clock_us);
        let at_rest = is_at_rest(&self.outputs);
        let stored = self
            .service
            .update(&mut self.controller, &mut self.slave, at_rest);
        self.send(hardware);
        // One flash operation per millisecond.
        let kept = stored == Storing::Idle && at_rest && self.keep_history();
        if stored == Storing::Busy || kept {
            self.tick_timer.skip_interval();
            self.bus_watch.excuse();
        }
    }

    /// Updates the fault history in flash, and returns whether flash was programmed. Nothing is written while the
    /// supply is out of its limits: failing power would tear the entry, and each power-off would be recorded as low
    /// supply.
    fn keep_history(&mut self) -> bool {
        let limits = &self.controller.calibration().safety;
        let is_supplied = self
            .inputs
            .supply
            .is_some_and(|supply| (limits.supply_min..=limits.supply_max).contains(&supply));
        is_supplied && !self.service.is_storing() && self.history.update(self.node.occurrences())
    }

    /// Write permission of a tool: none unless the service switch is on.
    fn access(&self, contacts: &Contacts) -> Access {
        if self.service.is_storing() || !contacts.panel.is_closed(Contact::Service) {
            return Access::Locked;
        }
        if is_at_rest(&self.outputs) {
            Access::AtRest
        } else {
            Access::Moving
        }
    }

    fn measure(&mut self, frames_dropped: u16) {
        self.charge = self.charge.after(&self.inputs);
        self.angle_noise.update(self.inputs.rocker_angle);
        let state = EcuState {
            remote_set_point: match self.node.remote() {
                Remote::Position(position) => position.0,
                Remote::Idle => -1,
            },
            remote_state: self.node.remote_state(),
            address: self.node.address().unwrap_or(NO_ADDRESS),
            charge: self.charge,
            calibration_state: self.service.pages.applied() as u8,
            longest_step_us: self.tick_timer.longest_us(),
            frames_dropped,
            angle_squares: self.angle_noise.sum_of_squares(),
        };
        self.measurements
            .sample(&self.inputs, &self.outputs, &state);
    }

    fn receive(&mut self, access: Access, now_us: u32, hardware: &mut impl Hardware) {
        self.slave.set_address(self.node.address());
        let calibration = self.controller.calibration();
        self.node.bound_remote_control(calibration.remote);
        let bus = &calibration.bus;
        let engines = [bus.engine_address, bus.second_engine_address];
        self.node.accept_engine_speed_from(
            engines.map(|address| u8::try_from(address.0).unwrap_or(NO_ADDRESS)),
        );
        // What was received before the controller left the bus is out of date.
        let is_off = hardware.is_bus_off();
        for _ in 0..MAX_RECEIVED {
            let Some(frame) = hardware.receive() else {
                return;
            };
            if is_off {
                continue;
            }
            self.node.receive(&frame, self.tick_timer.now_ms());
            let mut memory = EcuMemory {
                pages: &mut self.service.pages,
                measurements: &self.measurements,
                access,
                nonce: self.nonce,
            };
            self.slave.receive(&frame, &mut memory, now_us);
        }
    }

    fn sample_for_tool(&mut self, access: Access, now_us: u32) {
        let now_ms = self.tick_timer.now_ms();
        let memory = EcuMemory {
            pages: &mut self.service.pages,
            measurements: &self.measurements,
            access,
            nonce: self.nonce,
        };
        let events = [
            (1, Event::Every1Ms),
            (10, Event::Every10Ms),
            (100, Event::Every100Ms),
        ];
        for (period_ms, event) in events {
            if now_ms.is_multiple_of(period_ms) {
                self.slave.event(event, &memory, now_us);
            }
        }
    }

    /// Creates the frames that are due and passes them to the bus as far as it accepts them.
    fn send(&mut self, hardware: &mut impl Hardware) {
        let calibration = self.controller.calibration();
        let found = self.trouble_finder.update(
            &self.inputs,
            &self.outputs,
            &calibration.lock,
            &calibration.operator,
        );
        let status = status(
            &self.inputs,
            &self.outputs,
            self.controller.calibration(),
            self.service
                .troubles()
                .union(self.start_check.troubles)
                .union(self.bus_watch.troubles())
                .union(found),
            self.arbiter.is_overridden(),
            self.consents,
        );
        // The node is polled even if the bus is blocked: new frames then replace old ones.
        for _ in 0..MAX_SENT {
            let Some(frame) = self.node.poll(self.tick_timer.now_ms(), &status) else {
                break;
            };
            self.push(frame);
        }
        self.send_measured();
        while self.outbox.len() < OUTBOX
            && let Some(frame) = self.slave.poll()
        {
            self.push(frame);
        }
        while let Some(frame) = self.outbox.front()
            && hardware.send(frame)
        {
            self.outbox.pop_front();
        }
    }

    /// Sends the measured values if they are due and the node has an address.
    fn send_measured(&mut self) {
        let Some(source) = self.node.address() else {
            return;
        };
        let period = self.controller.calibration().bus.measured_period;
        let now_ms = self.tick_timer.now_ms();
        let frames = self
            .measured
            .poll(source, now_ms, period, &self.inputs, self.charge);
        frames
            .into_iter()
            .flatten()
            .for_each(|frame| self.push(frame));
    }

    fn push(&mut self, frame: Frame) {
        if self.outbox.is_full() {
            self.outbox.pop_front();
        }
        // There is room now.
        let _ = self.outbox.push_back(frame);
    }
}

/// Both coils are off until the lever capture.
const fn is_at_rest(outputs: &Outputs) -> bool {
    matches!(
        outputs.state,
        State::Locked | State::TransportLock | State::Fault
    )
}
