//! Random commands: no panic, no write out of range or without permission, a bounded queue.

use hitch_protocols::xcp::{Access, Event};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::client::{Desk, scalars};

/// Commands with a higher share of valid addresses and arguments than random ones.
fn command() -> impl Strategy<Value = Vec<u8>> {
    let codes = prop_oneof![4 => 0xD0..=0xFF_u8, 1 => any::<u8>()];
    let argument = prop_oneof![4 => 0..5_u8, 1 => any::<u8>(), 1 => Just(0x10), 1 => Just(0xFF)];
    (codes, prop::collection::vec(argument, 0..=7)).prop_map(|(code, mut rest)| {
        rest.insert(0, code);
        rest
    })
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(3), ..ProptestConfig::with_cases(200) })]

    #[test]
    fn whatever_is_sent_every_parameter_stays_in_its_range(
        commands in prop::collection::vec(command(), 300),
        access in prop::sample::select(vec![Access::Locked, Access::Moving, Access::AtRest]),
    ) {
        let mut desk = Desk::connected();
        desk.access = access;
        for command in &commands {
            desk.send(command);
            desk.event(Event::Every1Ms);
            prop_assert!(desk.packets().len() <= 4 + 32);
        }
        desk.send(&[0xFF, 0]);
        desk.send(&[0xEB, 2, 0, 0]);
        desk.packets();
        for (_, parameter, address, live) in scalars() {
            let value = desk.read(address).unwrap();
            prop_assert!((parameter.min..=parameter.max).contains(&value));
            let writable = match access {
                Access::Locked => false,
                Access::Moving => live,
                Access::AtRest => true,
            };
            prop_assert!(writable || value == parameter.nominal);
        }
    }
}
