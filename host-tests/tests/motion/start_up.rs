//! From power-up the enable line of the coil drivers is low until the lever capture, under all conditions.

use hitch_ecu::{Contact, Panel};
use hitch_ecu_host::ecu::{Bench, CutFlash, Moment, OnHost, delivered};
use hitch_plant::Model;
use hitch_protocols::can::{ExtendedId, Frame};
use hitch_quantities::{State, ValidCalibration};

const START_DEG: f64 = 90.0;
const IDLE_MS: u32 = 2_000;

/// A hitch and an ECU that has just been switched on.
struct Machine<'m> {
    bench: Bench<'m>,
    ecu: OnHost,
}

impl<'m> Machine<'m> {
    fn switched_on(model: &'m Model, load_kg: f64) -> Self {
        let flash = CutFlash::holding(delivered(&ValidCalibration::nominal()));
        Self {
            bench: Bench::new(model, load_kg, 40.0, START_DEG, 1),
            ecu: OnHost::start(flash),
        }
    }

    /// A millisecond; the watchdog is kicked in each, for all tasks have run in order.
    fn tick(&mut self, heard: &[Frame]) -> Moment {
        let moment = self.bench.tick(&mut self.ecu, heard, &mut Vec::new());
        let moment = moment.unwrap();
        assert!(moment.reply.kicked, "at {} ms", moment.time_ms);
        moment
    }

    fn assert_off(&mut self, heard: &[Frame], what: &str) {
        let reply = self.tick(heard).reply;
        assert!(
            !reply.enable && reply.lift == 0 && reply.lower == 0,
            "{what}: a coil gets something at state {}",
            reply.state
        );
    }
}

// REQ-MODE-01
#[test]
fn nothing_but_the_lever_raises_the_enable_line() {
    let model = hitch_model_file::named("nominal").unwrap();
    // An implement that commands the hitch at once, from where it is and from elsewhere.
    let commands: Vec<Frame> = [125, 200]
        .map(|position| {
            let id = ExtendedId::new(0x0CFE_4226).unwrap();
            Frame::data_frame(id.into(), &[255, position, 255, 255, 255, 255, 255, 255]).unwrap()
        })
        .into();
    for load_kg in [50.0, 250.0] {
        for lever_deg in [45.0, 80.0, 100.0, 140.0] {
            let mut machine = Machine::switched_on(&model, load_kg);
            machine.bench.operator.lever_deg = lever_deg;
            machine.bench.operator.lever_target_deg = lever_deg;
            for millisecond in 0..IDLE_MS {
                let heard = match millisecond % 100 {
                    0 => &commands[..],
                    _ => &[],
                };
                machine.assert_off(heard, "a lever that rests, and commands from the bus");
            }
            // To wherever the hitch is not.
            machine.bench.operator.lever_target_deg = lever_deg + (lever_deg - START_DEG).signum();
            (0..IDLE_MS).for_each(|_| machine.assert_off(&[], "a lever that moves away"));
        }
    }
}

// REQ-MODE-01
#[test]
fn a_button_that_was_held_from_the_start_on_raises_nothing() {
    let model = hitch_model_file::named("nominal").unwrap();
    for panel in [
        Panel::FIELD.with(Contact::Up, true),
        Panel::FIELD.with(Contact::Down, true),
        Panel::FIELD.with_buttons(true, false),
        Panel::FIELD.with_buttons(false, true),
    ] {
        let mut machine = Machine::switched_on(&model, 150.0);
        machine.bench.operator.panel = panel;
        (0..IDLE_MS).for_each(|_| machine.assert_off(&[], "a button that nobody has let go"));
    }
}

#[test]
fn the_line_rises_with_the_first_move_after_the_pick_up() {
    let model = hitch_model_file::named("nominal").unwrap();
    let mut machine = Machine::switched_on(&model, 150.0);
    (0..IDLE_MS).for_each(|_| machine.assert_off(&[], "a lever that rests"));
    // Through the hitch and on.
    machine.bench.operator.lever_target_deg = START_DEG + 20.0;
    let mut picked_up = false;
    for _ in 0..IDLE_MS {
        let reply = machine.tick(&[]).reply;
        assert!(
            picked_up || !reply.enable,
            "locked, and enabled all the same"
        );
        // The lock opens in one millisecond, and the first drive follows in the next one.
        picked_up |= reply.state != State::Locked as u8;
        if reply.enable {
            // Picked up by a lever that is still a little below, the hitch may first be lowered by that.
            let moving = [State::Lifting as u8, State::Lowering as u8];
            assert!(moving.contains(&reply.state), "state {}", reply.state);
            return;
        }
    }
    panic!("the hitch was picked up ({picked_up}) and nothing moves");
}
