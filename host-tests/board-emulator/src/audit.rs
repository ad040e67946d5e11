//! Checks the initialisation by an image against the manuals: clocks, wait states, pulses, converters, bus, pins,
//! watchdog.

use super::can;
use super::chip::Chip;
use super::layout::Layout;
use super::part::{Part, Pin, Port};

/// Shortest and longest time that the watchdog may give, ns: a millisecond is kicked with room to spare, and coils are
/// off 25 ms after the processor has died.
const WATCHDOG_NS: [f64; 2] = [4e6, 25e6];

/// Faults of the initialisation, one line each.
pub fn findings(chip: &Chip) -> Vec<String> {
    let mut findings = clocks(chip);
    findings.extend(chip.pwm.audit(&chip.registers, chip.timer_hz()[1]));
    for (converter, clock_hz) in chip.converters.iter().zip(chip.converter_hz()) {
        findings.extend(converter.audit(&chip.registers, clock_hz, |pin| chip.mode(pin) == 3));
    }
    let apb1_hz = chip.clocks.bus_hz(&chip.registers)[0];
    findings.extend(can::audit(
        chip.part,
        &chip.registers,
        apb1_hz,
        chip.clocks.crystal_hz,
    ));
    findings.extend(pins(chip));
    findings.extend(debug_freezes(chip));
    let period_ns = chip.watchdog.period_ns();
    if !(WATCHDOG_NS[0]..=WATCHDOG_NS[1]).contains(&period_ns) {
        findings.push(format!("the watchdog gives {period_ns} ns"));
    }
    findings.extend(chip.violations.iter().cloned());
    findings
}

fn clocks(chip: &Chip) -> Vec<String> {
    let registers = &chip.registers;
    let mut findings = Vec::new();
    let mut check = |good: bool, what: String| {
        if !good {
            findings.push(what);
        }
    };
    let core_hz = chip.clocks.core_hz(registers);
    check(
        (core_hz - 168e6).abs() < 1e3,
        format!("the core runs at {core_hz} Hz"),
    );
    let [input_hz, internal_hz] = chip.clocks.pll_internal_hz(registers);
    let (inputs, internals, buses) = match chip.part {
        Part::Stm32f405 => (1e6..=2e6, 100e6..=432e6, [42e6, 84e6]),
        Part::Stm32g474 => (2.66e6..=16e6, 96e6..=344e6, [170e6, 170e6]),
    };
    check(
        inputs.contains(&input_hz),
        format!("the PLL gets {input_hz} Hz"),
    );
    check(
        internals.contains(&internal_hz),
        format!("the PLL runs at {internal_hz} Hz"),
    );
    for (bus, (hz, most)) in (1..).zip(chip.clocks.bus_hz(registers).into_iter().zip(buses)) {
        check(hz <= most, format!("APB{bus} runs at {hz} Hz"));
    }
    if chip.part == Part::Stm32g474 {
        check(
            chip.clocks.is_boosted(registers),
            "no boost above 150 MHz".into(),
        );
    }
    let flash = chip.part.addresses().flash;
    let needed = chip.clocks.wait_states_needed(registers);
    let set = registers.field(flash, 0, 4);
    check(
        set >= needed,
        format!("{set} wait states, where {needed} are needed"),
    );
    check(
        registers.field(flash, 8, 3) == 0b111,
        "prefetch or a cache is off".into(),
    );
    let control = match chip.part {
        Part::Stm32f405 => 0x10,
        Part::Stm32g474 => 0x14,
    };
    let control = chip.flash.read_register(control, registers, chip.now_ns);
    check(control >> 31 == 1, "the flash is left unlocked".into());
    check(
        chip.registers.bit(chip.part.addresses().rcc, 19)
            == chip.clocks.pll_uses_crystal(registers),
        "the clock security system is off with the crystal, or on without it".into(),
    );
    findings
}

fn pins(chip: &Chip) -> Vec<String> {
    let mut findings = Vec::new();
    let timer = match chip.part {
        Part::Stm32f405 => 1,
        Part::Stm32g474 => 6,
    };
    for (pin, function) in [
        (Pin::new(Port::A, 8), timer),
        (Pin::new(Port::A, 9), timer),
        (Pin::new(Port::A, 11), 9),
        (Pin::new(Port::A, 12), 9),
    ] {
        let (mode, found) = (chip.mode(pin), chip.function(pin));
        if (mode, found) != (2, function) {
            findings.push(format!(
                "{pin} has mode {mode}, function {found}; it needs 2, {function}"
            ));
        }
    }
    let enable = Pin::new(Port::B, 10);
    if chip.mode(enable) != 1 {
        findings.push(format!("{enable}, the enable line, is no output"));
    }
    for pin in Layout::contact_pins() {
        if chip.mode(pin) != 0 || !chip.is_pulled_up(pin) {
            findings.push(format!("{pin}, a contact, isn't pulled up"));
        }
    }
    // The debugger's pins keep their function.
    for number in [13, 14] {
        let pin = Pin::new(Port::A, number);
        if chip.mode(pin) != 2 {
            findings.push(format!("{pin}, the debugger's, has another mode"));
        }
    }
    findings
}

fn debug_freezes(chip: &Chip) -> Vec<String> {
    let [timer, watchdog] = chip.debug_stops();
    let mut findings = Vec::new();
    if !timer {
        findings.push("a debugger that halts the processor doesn't stop TIM1".into());
    }
    if watchdog {
        findings.push("a debugger that halts the processor stops the watchdog".into());
    }
    findings
}
