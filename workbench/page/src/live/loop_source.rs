//! The source of the closed loops of the page: host, ECU, or ECU on the bus; and the closed loop of a tab.

use std::sync::Arc;
use std::sync::mpsc::Receiver;

use axum::http::StatusCode;
use hitch_closed_loop::driven::{Machine, Orders};
use hitch_quantities::ValidCalibration;

use super::answer::LoopAnswer;
use super::bench::{Bench, failed};
use super::bus::{BusMonitor, Place};
use super::emulated::{EcuSocket, NoEcu, RunningEcu};
use crate::refusal::Refusal;
use hitch_ecu_host::ecu::Runner;
use hitch_ecu_host::xcp_tool::{BusAddress, Written};
use hitch_output::error::Error;
use hitch_results::comparison::Evaluated;

/// The source of the closed loops of a server.
#[derive(Debug)]
pub enum LoopSource {
    /// The controller on the host: each tab has its own, and time passes as the tab requests it.
    Host,
    /// The ECU: one for all tabs, in real time.
    Ecu(EcuSocket),
    /// A real ECU on the bus: all tabs only listen to it.
    Bus(BusMonitor),
}

/// The closed loop of a tab.
#[derive(Debug)]
pub struct TabLoop {
    /// The present model at the start.
    pub of: Arc<Evaluated>,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    Host(Bench),
    Ecu(RunningEcu),
    Bus(Place),
}

/// The result of an advance, when it is ready.
pub enum Pending {
    /// It is ready.
    Ready(LoopAnswer),
    /// The simulation computes it.
    Computed(Receiver<LoopAnswer>),
}

impl LoopSource {
    /// The ECU that `runner` runs.
    pub fn ecu(runner: Runner) -> Self {
        Self::Ecu(EcuSocket::new(runner))
    }

    /// The ECU on a bus; a tab may have a calibration written to it if `may_write`.
    ///
    /// # Errors
    /// If the adapter cannot be opened.
    pub fn bus(address: BusAddress, may_write: bool) -> Result<Self, Error> {
        Ok(Self::Bus(BusMonitor::start(address, may_write)?))
    }

    /// Whether a tab may have a calibration written to the ECU.
    pub const fn may_write(&self) -> bool {
        matches!(self, Self::Bus(monitor) if monitor.may_write)
    }

    /// Writes a calibration to the ECU on the bus.
    ///
    /// # Errors
    /// If the server only listens, or the ECU refuses.
    pub(crate) fn write(&self, calibration: &ValidCalibration) -> Result<Written, Refusal> {
        match self {
            Self::Bus(monitor) if monitor.may_write => Ok(monitor.write(calibration)?),
            _ => Err(Refusal::conflict(
                "this page writes to no ECU; start it with hitch serve --can BUS --tune",
            )),
        }
    }

    /// Its name for the page.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Host => "host",
            Self::Ecu(_) => "ecu",
            Self::Bus(_) => "bus",
        }
    }

    /// Starts a closed loop at rest at an angle, degree; or follows the ECU on the bus.
    ///
    /// # Errors
    /// If it cannot be started, or another tab has the ECU.
    pub(crate) fn start(
        &self,
        of: Arc<Evaluated>,
        machine: Machine,
        orders: Orders,
        angle_deg: f64,
    ) -> Result<TabLoop, Refusal> {
        let kind = match self {
            Self::Host => {
                let no_thread =
                    |error| Error::Failed(format!("the simulation cannot be started: {error}"));
                Kind::Host(Bench::start(machine, orders, angle_deg).map_err(no_thread)?)
            }
            Self::Ecu(socket) => {
                let refused = |error: NoEcu| Refusal::conflict(&error.to_string());
                Kind::Ecu(socket.start(machine, orders, angle_deg).map_err(refused)?)
            }
            Self::Bus(monitor) => Kind::Bus(monitor.place()),
        };
        Ok(TabLoop { of, kind })
    }

    /// Ends what would outlive the server.
    pub fn close(&self) {
        match self {
            Self::Host => {}
            Self::Ecu(socket) => socket.close(),
            Self::Bus(monitor) => monitor.close(),
        }
    }
}

impl TabLoop {
    /// Requests an advance by `steps` milliseconds; an ECU runs in real time, and one on the bus gets no orders.
    ///
    /// # Errors
    /// If the previous one has not ended, or the simulation or the ECU has ended.
    pub(crate) fn advance(&self, orders: Orders, steps: u32) -> Result<Pending, Refusal> {
        match &self.kind {
            Kind::Host(bench) => bench.advance(orders, steps).map(Pending::Computed),
            Kind::Ecu(ecu) => match ecu.exchange(orders) {
                Ok(view) => Ok(Pending::Ready(view)),
                Err(reason) => Err(Refusal::of(StatusCode::GONE, &reason)),
            },
            Kind::Bus(place) => Ok(Pending::Ready(place.advance())),
        }
    }
}

impl Pending {
    /// Waits for the result.
    ///
    /// # Errors
    /// If the simulation has failed.
    pub(crate) fn wait(self) -> Result<LoopAnswer, Refusal> {
        match self {
            Self::Ready(view) => Ok(view),
            Self::Computed(answer) => answer.recv().map_err(|_| failed()),
        }
    }
}
