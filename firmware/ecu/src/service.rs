//! Changing and keeping the calibration: what tools write, what teaching finds, and the copies in flash.

use embedded_storage::nor_flash::NorFlash;
use hitch_controller::Controller;
use hitch_protocols::j1939::{Trouble, Troubles};
use hitch_protocols::storage::{CalibrationStore, Copy, Progress, Source};
use hitch_protocols::xcp::{CalibrationPages, Slave};
use hitch_quantities::units::Count;
use hitch_quantities::{Calibration, ValidCalibration};

/// Time in which the bus takes the answer to whoever wants to store: many a processor stands still for seconds then.
const ANSWER_MS: u8 = 20;

/// What became of a step of storing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storing {
    /// Nothing is being stored.
    Idle,
    /// Flash was read through, erased or programmed, which takes its time; many a processor stands still meanwhile.
    Busy,
}

/// The calibration's keeper.
#[derive(Debug)]
pub struct Service<F> {
    /// What tools see.
    pub pages: CalibrationPages,
    store: CalibrationStore<F>,
    storing: bool,
    /// Milliseconds until storing begins to change the flash.
    until_change: u8,
    /// A tool waits for the end of storing.
    tool_waits: bool,
    /// What teaching found has been looked at.
    taught_seen: bool,
    /// It waits to be stored.
    taught_waits: bool,
    troubles: Troubles,
}

/// Reads what is stored, and what is wrong with it.
///
/// Without anything stored, the factory's calibration watches the angle's second track where there is one.
pub fn load<F: NorFlash>(
    store: &mut CalibrationStore<F>,
    second_track: bool,
) -> (ValidCalibration, Troubles) {
    let loaded = store.load();
    let troubles = if loaded.source == Source::Factory {
        Trouble::CalibrationLost.into()
    } else if loaded.copies.contains(&Copy::Damaged) {
        Trouble::CalibrationCopyLost.into()
    } else {
        Troubles::NONE
    };
    let calibration = match loaded.source {
        Source::Factory => factory(loaded.calibration, second_track),
        Source::Stored { .. } => loaded.calibration,
    };
    (calibration, troubles)
}

fn factory(nominal: ValidCalibration, second_track: bool) -> ValidCalibration {
    let mut calibration: Calibration = (*nominal).clone();
    calibration.sensors.second_track = Count(i32::from(second_track));
    calibration.seal().unwrap_or(nominal)
}

impl<F: NorFlash> Service<F> {
    /// The keeper of `calibration`, which `store` gave with these troubles.
    pub fn new(
        store: CalibrationStore<F>,
        calibration: &ValidCalibration,
        troubles: Troubles,
    ) -> Self {
        Self {
            pages: CalibrationPages::new(calibration),
            store,
            storing: false,
            until_change: 0,
            tool_waits: false,
            taught_seen: false,
            taught_waits: false,
            troubles,
        }
    }

    /// True while something is being stored; the hitch has to be locked meanwhile.
    #[must_use]
    pub const fn is_storing(&self) -> bool {
        self.storing
    }

    /// What is wrong with what is stored.
    #[must_use]
    pub const fn troubles(&self) -> Troubles {
        self.troubles
    }

    /// The keeper's part of a millisecond. `at_rest`: both coils are off and the lock is shut.
    pub fn update(
        &mut self,
        controller: &mut Controller,
        slave: &mut Slave,
        at_rest: bool,
    ) -> Storing {
        if self.storing && self.until_change > 0 {
            self.until_change = self.until_change.saturating_sub(1);
            return Storing::Idle;
        }
        if self.storing {
            return self.store_on(slave);
        }
        let mut wanted = at_rest && (self.take_taught(controller) || self.taught_waits);
        if let Some(change) = self.pages.take_change() {
            if let Ok(calibration) = change {
                controller.apply(calibration);
            }
            // Checking a calibration takes half a millisecond: whoever wants to store it waits for the next one.
            self.taught_waits = wanted;
            return Storing::Idle;
        }
        if slave.take_store_request() {
            self.tool_waits = true;
            wanted = true;
        }
        if wanted {
            self.taught_waits = false;
            self.begin(slave, at_rest);
            return Storing::Busy;
        }
        Storing::Idle
    }

    /// Puts what teaching found on the working page, once; true if there was something.
    fn take_taught(&mut self, controller: &Controller) -> bool {
        let Some(result) = controller.taught() else {
            self.taught_seen = false;
            return false;
        };
        if core::mem::replace(&mut self.taught_seen, true) {
            return false;
        }
        let calibration =
            result.map(|taught| taught.applied_to(controller.calibration()).validate());
        match calibration {
            Ok(Ok(calibration)) => {
                self.pages.replace_working(&calibration);
                true
            }
            _ => false,
        }
    }

    fn begin(&mut self, slave: &mut Slave, at_rest: bool) {
        let begun = match self.pages.to_store() {
            Ok(calibration) if at_rest => self.store.begin(&calibration).is_ok(),
            _ => false,
        };
        self.storing = begun;
        self.until_change = ANSWER_MS;
        if !begun {
            self.end(slave, false);
        }
    }

    fn store_on(&mut self, slave: &mut Slave) -> Storing {
        match self.store.step() {
            Ok(Progress::Busy) => {}
            Ok(Progress::Done | Progress::Idle) => {
                // Nothing could be written to the page meanwhile, so it is what was stored.
                if let Ok(calibration) = self.pages.to_store() {
                    self.pages.stored(&calibration);
                }
                self.troubles = Troubles::NONE;
                self.end(slave, true);
            }
            Err(_) => {
                self.troubles.insert(Trouble::CalibrationCopyLost);
                self.end(slave, false);
            }
        }
        Storing::Busy
    }

    fn end(&mut self, slave: &mut Slave, success: bool) {
        self.storing = false;
        if core::mem::take(&mut self.tool_waits) {
            slave.stored(success);
        }
    }
}
