//! A flooded bus during operation: it does not change a single bit of the controller's outputs.

use fastrand::Rng;
use hitch_ecu::link::Reply;
use hitch_ecu_host::ecu::{Bench, CutFlash, OnHost, Order};
use hitch_protocols::can::{ExtendedId, Frame, StandardId};
use hitch_protocols::j1939::Pgn;
use hitch_protocols::xcp::TOOL_ADDRESS;

const ECU: u8 = 0x80;
const DURATION_MS: u32 = 20_000;
/// Twice the capacity of 250 kbit/s for the shortest frames.
const FRAMES_A_MS: usize = 8;

/// A frame with random content; half of them have an identifier that the ECU receives. Valid commands to the hitch are
/// excluded.
fn nonsense(random: &mut Rng) -> Frame {
    let groups = [
        Pgn::REQUEST,
        Pgn::ADDRESS_CLAIMED,
        Pgn::TRANSPORT_CONNECTION,
        Pgn::TRANSPORT_DATA,
        Pgn::ACKNOWLEDGEMENT,
        Pgn::PROPRIETARY_A,
        Pgn::DM3,
        Pgn::HITCH_COMMANDS,
    ];
    let group = groups[random.usize(..groups.len())];
    let source = [TOOL_ADDRESS, ECU, random.u8(..)][random.usize(..3)];
    let destination = if group.has_destination() {
        u32::from([ECU, 0xFF, random.u8(..)][random.usize(..3)]) << 8
    } else {
        0
    };
    let known = 0x1800_0000 | (group.0 << 8) | destination | u32::from(source);
    let raw = if random.bool() {
        known
    } else {
        random.u32(..1 << 29)
    };
    // Hitch commands come too short.
    let longest = if (raw >> 8) & 0x3_FFFF == Pgn::HITCH_COMMANDS.0 {
        7
    } else {
        8
    };
    let mut data = [0; 8];
    data.fill_with(|| random.u8(..));
    let data = &data[..random.usize(..=longest)];
    if random.u8(..) < 16 {
        let id = StandardId::new(random.u16(..0x800)).unwrap();
        return Frame::data_frame(id.into(), data).unwrap();
    }
    Frame::data_frame(ExtendedId::new(raw).unwrap().into(), data).unwrap()
}

/// Outputs of an ECU during operation, without its frames.
fn work(mut bus: impl FnMut(u32) -> Vec<Frame>) -> (Vec<Reply>, usize) {
    let model = hitch_model_file::named("dynamic").unwrap();
    let mut bench = Bench::new(&model, 150.0, 40.0, 80.0, 5);
    let mut machine = OnHost::start(CutFlash::blank());
    let mut said = Vec::new();
    let mut replies = Vec::new();
    let mut most_said = 0;
    for time_ms in 0..DURATION_MS {
        // Through the hitch, and then up and down every three seconds.
        if time_ms % 3_000 == 600 {
            let up = time_ms / 3_000 % 2 == 0;
            bench
                .operator
                .apply(Order::Lever(if up { 110.0 } else { 70.0 }));
        }
        said.clear();
        let moment = bench.tick(&mut machine, &bus(time_ms), &mut said).unwrap();
        most_said = most_said.max(said.len());
        replies.push(Reply {
            frames: 0,
            ..moment.reply
        });
    }
    (replies, most_said)
}

// REQ-SAFE-08
#[test]
fn a_flood_of_nonsense_changes_nothing_at_the_coils() {
    let (quiet, _) = work(|_| Vec::new());
    let moved = quiet
        .iter()
        .filter(|reply| reply.lift > 0 || reply.lower > 0)
        .count();
    assert!(moved > 2_000, "the hitch works: {moved} ms");
    assert!(quiet.iter().all(|reply| reply.trip == 0));

    let mut random = Rng::with_seed(11);
    let (flooded, most_said) = work(|_| {
        let frames = (0..FRAMES_A_MS / 2).map(|_| nonsense(&mut random));
        // Every frame comes twice.
        frames.flat_map(|frame| [frame, frame]).collect()
    });
    let first = quiet
        .iter()
        .zip(&flooded)
        .position(|(quiet, flooded)| quiet != flooded);
    assert_eq!(first, None, "the first millisecond that differs");
    assert!(most_said <= 8, "{most_said} frames in a millisecond");
}

#[test]
fn a_node_that_repeats_one_frame_changes_nothing() {
    let (quiet, _) = work(|_| Vec::new());
    let request = ExtendedId::new(0x18EA_80F9).unwrap();
    let frame = Frame::data_frame(request.into(), &Pgn::DM1.to_bytes()).unwrap();
    let (babbled, _) = work(|_| vec![frame; FRAMES_A_MS]);
    assert!(quiet == babbled);
}
