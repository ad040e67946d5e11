//! A board with plant, operator and bus, and the steps that scenarios are made of.

use anyhow::{Result, ensure};
use hitch_ecu::Contacts;
use hitch_ecu_host::ecu::{Bench, Moment, Order};
use hitch_protocols::can::Frame;

use super::setup::Setup;
use crate::audit::findings;
use crate::{Board, Conditions, Contents, ENABLE_READ_BACK, Stop};

/// Time after power-up within which the ECU is ready, ms.
pub const READY_MS: usize = 250;
/// Angle at which the hitch rests at the start, degree.
const START_DEG: f64 = 80.0;

/// Board and surroundings.
pub struct Rig<'m> {
    /// The board.
    pub board: Board,
    /// Plant, sensors and operator.
    pub bench: Bench<'m>,
    /// Frames that the ECU has sent.
    pub said: Vec<Frame>,
    /// A coil was driven at the end of some millisecond.
    pub was_driven: bool,
}

impl<'m> Rig<'m> {
    /// A board with erased flash that is powered up, with the hitch at rest.
    pub fn erased(setup: &'m Setup, conditions: Conditions) -> Result<Self> {
        let board = Board::new(
            &setup.library,
            setup.layout,
            &setup.image,
            Contents::erased(setup.layout.part()),
            conditions,
        )?;
        Ok(Self {
            board,
            bench: Bench::new(&setup.model, 150.0, 40.0, START_DEG, 1),
            said: Vec::new(),
            was_driven: false,
        })
    }

    /// The same in typical conditions.
    pub fn typical(setup: &'m Setup) -> Result<Self> {
        Self::erased(setup, Conditions::typical(setup.layout))
    }

    /// A hitch that is lifted at full speed.
    pub fn lifted(setup: &'m Setup, conditions: Conditions) -> Result<Self> {
        let mut rig = Self::erased(setup, conditions)?;
        rig.pick_up()?;
        rig.lever(125.0, 700)?;
        ensure!(rig.is_driven(), "the hitch isn't lifted");
        Ok(rig)
    }

    /// Some milliseconds in which no coil may be driven; `tamper` knows their number.
    pub fn stays_off(
        &mut self,
        milliseconds: usize,
        mut tamper: impl FnMut(&mut Contacts, usize),
    ) -> Result<()> {
        for step in 0..milliseconds {
            self.tick_with(|contacts| tamper(contacts, step))?;
            ensure!(!self.is_driven(), "a coil is driven {step} ms later");
        }
        Ok(())
    }

    /// Forces the enable line's read-back to a level.
    pub fn force_read_back(&mut self, level: bool) {
        let levels = &mut self.board.chip().conditions.levels;
        levels.insert(ENABLE_READ_BACK, level);
    }

    /// After a fault at `fault_ns` the pins are low in time, and nothing drives a coil while the watchdog resets the part
    /// and the ECU starts again. Returns how long the pins took, ms.
    pub fn restarts(&mut self, fault_ns: f64, most_ms: f64) -> Result<f64> {
        let took_ms = self.off_after_ms(fault_ns, 60, |_| {})?;
        ensure!(
            took_ms < most_ms,
            "off after {took_ms} ms, {most_ms} ms allowed"
        );
        self.stays_off(READY_MS + 400, |_, _| {})?;
        let resets = &self.board.resets;
        ensure!(*resets == [Stop::Watchdog], "{resets:?}");
        Ok(took_ms)
    }

    /// A millisecond in which `tamper` changes the signals of sensors and wires.
    pub fn tick_with(&mut self, tamper: impl FnOnce(&mut Contacts)) -> Result<Moment> {
        let moment = self
            .bench
            .tick_with(&mut self.board, &[], &mut self.said, tamper)?;
        self.was_driven |= self.is_driven();
        Ok(moment)
    }

    /// Some milliseconds.
    pub fn run(&mut self, milliseconds: usize) -> Result<()> {
        for _ in 0..milliseconds {
            self.tick_with(|_| {})?;
        }
        Ok(())
    }

    /// Starts up, and lets the operator pick the hitch up.
    pub fn pick_up(&mut self) -> Result<()> {
        self.run(READY_MS)?;
        let angle_deg = self.bench.angle_deg();
        self.bench.operator.apply(Order::Lever(angle_deg + 3.0));
        self.run(600)
    }

    /// Moves the lever, and lets the hitch follow for some milliseconds.
    pub fn lever(&mut self, angle_deg: f64, milliseconds: usize) -> Result<()> {
        self.bench.operator.apply(Order::Lever(angle_deg));
        self.run(milliseconds)
    }

    /// True if a coil is driven.
    pub fn is_driven(&mut self) -> bool {
        self.board.chip().off_since_ns.is_none()
    }

    /// Time now, ns.
    pub fn now_ns(&mut self) -> f64 {
        self.board.chip().now_ns
    }

    /// Time of the last drive of a coil after `fault_ns`, ms, within `watched_ms`.
    pub fn off_after_ms(
        &mut self,
        fault_ns: f64,
        watched_ms: usize,
        mut tamper: impl FnMut(&mut Contacts),
    ) -> Result<f64> {
        for _ in 0..watched_ms {
            self.tick_with(&mut tamper)?;
        }
        let off_ns = self.board.chip().off_since_ns;
        let off_ns = off_ns.ok_or_else(|| {
            anyhow::anyhow!("a coil is still driven {watched_ms} ms after the fault")
        })?;
        Ok((off_ns - fault_ns).max(0.0) * 1e-6)
    }

    /// Ends a scenario: no reset, nothing forbidden, and everything set up as it should be.
    pub fn finish(&mut self) -> Result<()> {
        ensure!(
            self.board.resets.is_empty(),
            "the ECU was reset: {:?}",
            self.board.resets
        );
        self.finish_after_resets()
    }

    /// The same after resets that belong to the scenario.
    pub fn finish_after_resets(&mut self) -> Result<()> {
        let violations = self.board.violations();
        ensure!(
            violations.is_empty(),
            "the image must not do this: {violations:#?}"
        );
        let findings = findings(self.board.chip());
        ensure!(findings.is_empty(), "the image sets this up: {findings:#?}");
        Ok(())
    }
}
