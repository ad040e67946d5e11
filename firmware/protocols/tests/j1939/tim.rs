//! Tractor Implement Management for the rear hitch: what is refused without authentication, and the states with it.
//!
//! The requests are the bytes that the client of AGRIForward/ROS2ISOBUS (`src/TIMClient/TIMClient.cpp`) sends.

use hitch_protocols::j1939::hitch::StatusMessage;
use hitch_protocols::j1939::{
    Authority, Automation, ExitCode, Limit, Operation, Pgn, Remote, Variant,
};
use hitch_quantities::calibration::design_parameters::RemoteParameters;
use hitch_quantities::units::{Count, PerMille};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::bus::{Bus, OTHER, OURS, implement};

const VERSION: [u8; 8] = [0xF6, 0xFF, 2, 1, 0xFF, 0xFF, 0xFF, 0xFF];
const SUPPORT: [u8; 8] = [0xF4, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF];
const ASSIGN: [u8; 8] = [0xF5, 1, 0x43, 0x3F, 0xFF, 0xFF, 0xFF, 0xFF];
const RELEASE: [u8; 8] = [0xF5, 1, 0x43, 0x1F, 0xFF, 0xFF, 0xFF, 0xFF];
const ASSIGNMENT_STATUS: [u8; 8] = [0xF3, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF];
const READY: u16 = 0xFBFF;
const RELEASED: u16 = 0xFBFD;
/// A second implement.
const THIRD: u8 = 0x27;

fn send_from(bus: &mut Bus, source: u8, bytes: [u8; 8]) {
    bus.receive(Pgn::TIM_CLIENT, OURS, source, &bytes);
}

/// The bytes that the node answers to all within 20 ms.
fn answers(bus: &mut Bus, source: u8, request: [u8; 8]) -> Vec<[u8; 8]> {
    bus.sent.clear();
    send_from(bus, source, request);
    bus.run(20);
    let sent = bus.take(Pgn::TIM_SERVER);
    let replies = sent.iter().filter(|sent| sent.data()[0] != 0xFA);
    replies
        .map(|sent| sent.data().try_into().unwrap())
        .collect()
}

fn request(value: u16, counter: u8) -> [u8; 8] {
    let [low, high] = value.to_le_bytes();
    [0x43, counter, 0xFF, 0xFF, low, high, 0xFF, 0xFF]
}

/// The result of an assignment.
fn assignment(bus: &mut Bus, source: u8, request: [u8; 8]) -> (u8, u8) {
    let answers = answers(bus, source, request);
    assert_eq!(answers.len(), 1);
    assert_eq!(answers[0][..3], [0xF5, 1, request[2]]);
    (answers[0][3] >> 5, answers[0][3] & 0x1F)
}

/// The client of a test: it sends its status and, if it has one, a value every 100 ms.
struct Client {
    bus: Bus,
    heartbeat: u8,
    counter: u8,
}

impl Client {
    /// An implement that is authenticated and sends its heartbeat.
    fn authenticated() -> Self {
        let mut bus = Bus::claimed(Variant::Iso11783);
        bus.hear_claim(THIRD, implement(2));
        bus.node.set_tim_authority(Authority {
            operation: Some(Operation::Normal),
            client: Some(implement(1)),
        });
        let mut client = Self {
            bus,
            heartbeat: 251,
            counter: 0,
        };
        client.run(None, 2);
        client
    }

    fn enabled() -> Self {
        let mut client = Self::authenticated();
        assert_eq!(assignment(&mut client.bus, OTHER, ASSIGN), (1, 0));
        client
    }

    fn active() -> Self {
        let mut client = Self::enabled();
        assert_eq!(client.state(READY), Automation::Enabled);
        client.bus.consent();
        assert_eq!(client.state(READY), Automation::Pending);
        client.run(Some(6_200), 1);
        assert_eq!(client.state(6_200), Automation::Active);
        client
    }

    fn run(&mut self, value: Option<u16>, times: u32) {
        for _ in 0..times {
            self.status();
            if let Some(value) = value {
                self.command(value);
            }
            self.bus.run(100);
        }
    }

    fn status(&mut self) {
        let status = [0xF9, self.heartbeat, 0x3F, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF];
        send_from(&mut self.bus, OTHER, status);
        self.heartbeat = if self.heartbeat >= 250 {
            0
        } else {
            self.heartbeat + 1
        };
    }

    fn command(&mut self, value: u16) {
        self.counter = (self.counter + 1) % 14;
        send_from(&mut self.bus, OTHER, request(value, self.counter));
    }

    /// Sends a value for 100 ms; the state in the answer, which has the same counter.
    fn state(&mut self, value: u16) -> Automation {
        self.bus.sent.clear();
        self.run(Some(value), 1);
        let sent = self.bus.take(Pgn::TIM_SERVER);
        let status = sent.iter().find(|sent| sent.data()[0] == 0x43).unwrap();
        let data = status.data();
        assert_eq!(data[1], 0x10 | self.counter);
        assert_eq!(u16::from_le_bytes([data[4], data[5]]), 6_200);
        let all = [
            Automation::Unavailable,
            Automation::NotReady,
            Automation::ReadyToEnable,
            Automation::Enabled,
            Automation::Pending,
            Automation::Active,
            Automation::ActiveLimitedHigh,
            Automation::ActiveLimitedLow,
            Automation::Fault,
        ];
        let found = all.into_iter().find(|&state| state as u8 == data[2] & 0xF);
        found.unwrap()
    }

    /// The exit code of the next status.
    fn exit(&mut self) -> ExitCode {
        self.bus.sent.clear();
        self.run(None, 2);
        let statuses = self.bus.take(Pgn::REAR_HITCH_STATUS);
        let last = statuses.last().unwrap().data().try_into().unwrap();
        StatusMessage::from_bytes(last).exit
    }
}

#[test]
fn without_an_authority_nothing_is_announced_and_everything_is_refused() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(5_000);
    assert!(bus.take(Pgn::TIM_SERVER).is_empty());
    let version = [0xF6, 0, 1, 1, 0xFF, 0xFF, 0xFF, 0xFF];
    assert_eq!(answers(&mut bus, OTHER, VERSION), [version]);
    // Motion is not supported, position is.
    let support = [0xF4, 1, 0x43, 1, 0x1F, 0xFF, 0xFF, 0xFF];
    assert_eq!(answers(&mut bus, OTHER, SUPPORT), [support]);
    let unassigned = [0xF3, 1, 0x43, 0, 0xFF, 0xFF, 0xFF, 0xFF];
    assert_eq!(answers(&mut bus, OTHER, ASSIGNMENT_STATUS), [unassigned]);
    // Not successful: the client is not certified.
    assert_eq!(assignment(&mut bus, OTHER, ASSIGN), (5, 5));
    assert_eq!(assignment(&mut bus, OTHER, RELEASE), (0, 0));
    // Access denied, to the sender.
    for value in [READY, 6_200, RELEASED] {
        bus.sent.clear();
        send_from(&mut bus, OTHER, request(value, 3));
        bus.consent();
        bus.run(20);
        let denied = bus.take(Pgn::ACKNOWLEDGEMENT);
        assert_eq!(denied.len(), 1);
        assert_eq!(denied[0].id.destination, OTHER);
        assert_eq!(
            denied[0].data(),
            [2, 0x43, 0xFF, 0xFF, OTHER, 0x00, 0x24, 0]
        );
        assert_eq!(bus.node.remote_state(), 0);
    }
    bus.receive(Pgn::AUTHENTICATION_CLIENT, OURS, OTHER, &[0xF9; 8]);
    bus.run(20);
    let unsupported = bus.take(Pgn::ACKNOWLEDGEMENT);
    assert_eq!(
        unsupported[0].data(),
        [1, 0xF9, 0xFF, 0xFF, OTHER, 0x00, 0x6F, 0]
    );
}

#[test]
fn each_wrong_assignment_has_its_reason() {
    let mut bus = Client::authenticated().bus;
    let of = |function, information| [0xF5, 1, function, information, 0xFF, 0xFF, 0xFF, 0xFF];
    assert_eq!(assignment(&mut bus, OTHER, of(0x44, 0x3F)), (5, 1));
    assert_eq!(assignment(&mut bus, OTHER, of(0x43, 0x5F)), (5, 3));
    assert_eq!(assignment(&mut bus, THIRD, ASSIGN), (5, 5));
    bus.status.exit = ExitCode::LockedOut;
    bus.run(1);
    assert_eq!(assignment(&mut bus, OTHER, ASSIGN), (5, 2));
    for count in [0, 4, 0xFF] {
        let wrong = [0xF5, count, 0x43, 0x3F, 0x41, 0x3F, 0x44, 0x3F];
        let error = [0xF5, 1, 0x43, 0xA4, 0xFF, 0xFF, 0xFF, 0xFF];
        assert_eq!(answers(&mut bus, OTHER, wrong), [error]);
    }
    let two = [0xF5, 2, 0x41, 0x3F, 0x43, 0xFF, 0xFF, 0xFF];
    let first = [0xF5, 2, 0x41, 0xA1, 0x43, 0x00, 0xFF, 0xFF];
    assert_eq!(answers(&mut bus, OTHER, two), [first]);
}

#[test]
fn the_lead_server_announces_itself_with_a_heartbeat() {
    let mut client = Client::active();
    client.bus.sent.clear();
    client.run(Some(6_200), 30);
    let sent = client.bus.take(Pgn::TIM_SERVER);
    let statuses: Vec<_> = sent.iter().filter(|sent| sent.data()[0] == 0xFA).collect();
    assert_eq!(statuses.len(), 30);
    for pair in statuses.windows(2) {
        let next = if pair[0].data()[1] >= 250 {
            0
        } else {
            pair[0].data()[1] + 1
        };
        assert_eq!(pair[1].data()[1], next);
        assert_eq!(pair[1].at_ms.wrapping_sub(pair[0].at_ms), 100);
        // Automation allowed and active; the server is active, the tractor drives.
        assert_eq!(pair[1].data()[2..], [0x15, 0x51, 0xFF, 0xFF, 0xFF, 0xFF]);
        assert_eq!(pair[1].id.priority, 4);
    }
}

#[test]
fn an_authenticated_client_commands_after_assignment_and_consent() {
    let mut client = Client::active();
    assert_eq!(client.bus.node.remote(), Remote::Position(PerMille(620)));
    client.run(Some(7_480), 1);
    assert_eq!(client.bus.node.remote(), Remote::Position(PerMille(748)));
    for (limit, state) in [
        (Limit::High, Automation::ActiveLimitedHigh),
        (Limit::Low, Automation::ActiveLimitedLow),
        (Limit::None, Automation::Active),
    ] {
        client.bus.status.limit = limit;
        client.bus.run(1);
        assert_eq!(client.state(6_200), state);
    }
    // The NAME of who has the hitch goes by a broadcast of 13 bytes.
    client.bus.sent.clear();
    send_from(&mut client.bus, THIRD, ASSIGNMENT_STATUS);
    client.run(Some(6_200), 2);
    let sent = std::mem::take(&mut client.bus.sent);
    let of = |pgn| sent.iter().filter(move |sent| sent.id.pgn == pgn);
    let announced = of(Pgn::TRANSPORT_CONNECTION).next().unwrap();
    assert_eq!(announced.data(), [32, 13, 0, 2, 0xFF, 0x00, 0x23, 0]);
    let packets = of(Pgn::TRANSPORT_DATA).flat_map(|sent| sent.data()[1..].to_vec());
    let mut expected = vec![0xF3, 0, 1];
    expected.extend(implement(1).to_bytes());
    expected.extend([1, 0x43]);
    assert_eq!(packets.take(13).collect::<Vec<u8>>(), expected);
}

#[test]
fn another_client_is_refused_while_one_has_the_hitch() {
    let mut client = Client::active();
    assert_eq!(assignment(&mut client.bus, THIRD, ASSIGN), (5, 5));
    assert_eq!(assignment(&mut client.bus, THIRD, RELEASE), (0, 0));
    send_from(&mut client.bus, THIRD, request(2_000, 1));
    client.bus.run(20);
    assert_eq!(client.bus.take(Pgn::ACKNOWLEDGEMENT).len(), 1);
    assert_eq!(client.bus.node.remote(), Remote::Position(PerMille(620)));
}

#[test]
fn it_ends_with_the_reasons_of_remote_control() {
    let mut released = Client::active();
    released.command(RELEASED);
    assert_eq!(released.exit(), ExitCode::Released);
    // "Ready", motion commands and reserved values are invalid while the client commands.
    for value in [READY, 0xFB01, 0xFB02, 0xFBFE, 10_001, 0xFFFF] {
        let mut invalid = Client::active();
        invalid.command(value);
        assert_eq!(invalid.exit(), ExitCode::OutOfRange, "{value:#x}");
    }
    let mut silent = Client::active();
    silent.run(None, 4);
    assert_eq!(silent.exit(), ExitCode::Timeout);
    let mut overridden = Client::active();
    overridden.bus.status.remote_permitted = false;
    assert_eq!(overridden.exit(), ExitCode::OperatorOverride);
}

#[test]
fn a_client_loses_the_hitch_with_its_heartbeat_its_release_and_its_authentication() {
    let lost = |client: &mut Client| {
        for _ in 0..4 {
            client.command(6_200);
            client.bus.run(100);
        }
        assert_eq!(client.bus.node.remote(), Remote::Idle);
        client.bus.sent.clear();
        client.command(6_200);
        client.bus.run(20);
        let denied = client.bus.take(Pgn::ACKNOWLEDGEMENT);
        assert_eq!(denied[0].data()[..2], [2, 0x43]);
    };
    let mut silent = Client::active();
    for _ in 0..4 {
        silent.command(6_200);
        silent.bus.run(100);
    }
    lost(&mut silent);
    let mut released = Client::active();
    assert_eq!(assignment(&mut released.bus, OTHER, RELEASE), (0, 0));
    lost(&mut released);
    let mut revoked = Client::active();
    revoked.bus.node.set_tim_authority(Authority::default());
    lost(&mut revoked);
    // Somebody else has its address.
    let mut replaced = Client::active();
    replaced.bus.hear_claim(OTHER, implement(0));
    lost(&mut replaced);
}

#[test]
fn faults_and_locks_come_before_the_state_of_the_client() {
    for (exit, state) in [
        (ExitCode::FunctionFault, Automation::Fault),
        (ExitCode::ControlFault, Automation::Fault),
        (ExitCode::LockedOut, Automation::Unavailable),
        (ExitCode::OperatorOverride, Automation::Unavailable),
    ] {
        let mut client = Client::enabled();
        client.bus.status.exit = exit;
        client.bus.run(1);
        assert_eq!(client.state(READY), state, "{exit:?}");
    }
    let mut client = Client::enabled();
    client.bus.node.bound_remote_control(RemoteParameters {
        consent: Count(0),
        ..RemoteParameters::NOMINAL
    });
    client.bus.run(1);
    assert_eq!(client.state(READY), Automation::Unavailable);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(57),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn no_message_of_tim_moves_the_hitch_without_authentication(
        frames in proptest::collection::vec(
            (
                prop_oneof![Just(0x43), 0xF3_u8..=0xFA, any::<u8>()],
                any::<[u8; 7]>(),
                prop_oneof![Just(OTHER), Just(THIRD)],
                prop_oneof![Just(Pgn::TIM_CLIENT), Just(Pgn::AUTHENTICATION_CLIENT)],
            ),
            1..200,
        ),
        announced in any::<bool>(),
    ) {
        let mut bus = Bus::claimed(Variant::Iso11783);
        bus.hear_claim(THIRD, implement(2));
        bus.node.set_tim_authority(Authority {
            operation: announced.then_some(Operation::Standstill),
            client: None,
        });
        for (code, rest, source, group) in frames {
            let [a, b, c, d, e, f, g] = rest;
            bus.receive(group, OURS, source, &[code, a, b, c, d, e, f, g]);
            bus.status.consents = a & 1 == 1;
            bus.run(20);
            prop_assert_eq!(bus.node.remote_state(), 0);
        }
        let counted = bus.sent.iter().filter(|sent| sent.id.pgn == Pgn::TIM_SERVER);
        for sent in counted {
            // Neither assigned to its requester, nor enabled.
            let data = sent.data();
            prop_assert!(data[0] != 0x43);
            prop_assert!(data[0] != 0xF5 || data[3] >> 5 != 1);
            prop_assert!(data[0] != 0xFA || matches!(data[3] >> 4, 0 | 1));
        }
    }
}
