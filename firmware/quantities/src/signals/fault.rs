//! What the controller reports when it refuses to move.

use crate::codes;

codes! {
    /// Why the controller refuses to move, with the code it has on links and in traces.
    Fault: u8 {
        /// The lever signal is missing or out of range.
        Lever = 1, "lever";
        /// The angle signal is missing, out of range or jumps.
        Angle = 2, "angle";
        /// The hitch doesn't stay where it was put: the lowering spool or the check valve leaks.
        Sinking = 3, "sinking";
        /// Flow is demanded and the hitch doesn't move: relief valve, obstacle, valve or angle sensor stuck.
        NotMoving = 4, "not-moving";
        /// The safety envelope tripped on a command or a movement that must not be.
        Envelope = 5, "envelope";
        /// The hitch was moving and seems to have stopped: obstacle, or an angle sensor that no longer follows.
        NotFollowing = 6, "not-following";
        /// A coil, its wire or its driver.
        Coil = 7, "coil";
        /// The supply voltage is outside its limits.
        Supply = 8, "supply";
        /// The controller isn't called in time, or its clock is off.
        Overrun = 9, "overrun";
        /// The converters' reference is off.
        Reference = 10, "reference";
        /// The supply of the sensors is outside its limits.
        SensorSupply = 11, "sensor-supply";
        /// The enable line of the coils' drivers: its read-back differs from its command.
        EnableLine = 12, "enable-line";
        /// The calibration in use has changed in memory.
        Memory = 13, "memory";
    }
}
