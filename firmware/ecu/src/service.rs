//! Changing and keeping the calibration: what tools write, what teaching finds, and the copies in flash.

use embedded_storage::nor_flash::NorFlash;
use hitch_controller::Controller;
use hitch_protocols::j1939::{Trouble, Troubles};
use hitch_protocols::storage::{CalibrationStore, Copy, Progress, SafetySource, Source};
use hitch_protocols::xcp::{CalibrationPages, Slave};
use hitch_quantities::calibration::fitted::Fitted;
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
    /// The board has a second track of the angle sensor.
    fitted: Fitted,
    /// The present calibration has other safety values than the factory's.
    differs: bool,
    /// A tool had the key in the last millisecond.
    was_unlocked: bool,
}

/// A calibration as it was loaded.
#[derive(Debug)]
pub struct Start {
    /// What to run on.
    pub calibration: ValidCalibration,
    /// What is wrong with what is stored.
    troubles: Troubles,
    fitted: Fitted,
}

/// Reads what is stored, and what is wrong with it.
///
/// The factory's calibration monitors what is fitted.
pub fn load<F: NorFlash>(store: &mut CalibrationStore<F>, fitted: Fitted) -> Start {
    let loaded = store.load();
    let mut troubles = if loaded.source == Source::Factory {
        Trouble::CalibrationLost.into()
    } else if loaded.copies.contains(&Copy::Damaged) {
        Trouble::CalibrationCopyLost.into()
    } else {
        Troubles::NONE
    };
    if loaded.safety == SafetySource::Lost {
        troubles.insert(Trouble::SafetyValuesLost);
    }
    Start {
        calibration: match loaded.safety {
            SafetySource::Stored => loaded.calibration,
            SafetySource::Factory | SafetySource::Lost => factory(loaded.calibration, fitted),
        },
        troubles,
        fitted,
    }
}

/// Not inlined: its blocks would take their place on the stack while the store is read.
#[inline(never)]
fn factory(nominal: ValidCalibration, fitted: Fitted) -> ValidCalibration {
    let mut calibration: Calibration = (*nominal).clone();
    calibration.monitor(fitted);
    calibration.seal().unwrap_or(nominal)
}

impl<F: NorFlash> Service<F> {
    /// The keeper of the calibration that `store` gave.
    pub fn new(store: CalibrationStore<F>, start: &Start) -> Self {
        let mut pages = CalibrationPages::new(&start.calibration);
        if start.troubles.contains(Trouble::SafetyValuesLost) {
            pages.require_key_to_store();
        }
        Self {
            pages,
            store,
            storing: false,
            until_change: 0,
            tool_waits: false,
            taught_seen: false,
            taught_waits: false,
            troubles: start.troubles,
            differs: start.calibration.has_other_safety_values(start.fitted),
            fitted: start.fitted,
            was_unlocked: false,
        }
    }

    /// Whether the hitch has to be locked: flash is being changed, or the stored safety values are lost.
    #[must_use]
    pub const fn has_to_lock(&self) -> bool {
        self.storing || self.troubles.contains(Trouble::SafetyValuesLost)
    }

    /// Number of the safety block in use.
    #[must_use]
    pub fn safety_sequence(&self) -> u32 {
        self.store.safety_sequence()
    }

    /// True while something is being stored.
    #[must_use]
    pub const fn is_storing(&self) -> bool {
        self.storing
    }

    /// What is wrong with what is stored, and whether safety values differ from the shipped ones.
    #[must_use]
    pub const fn troubles(&self) -> Troubles {
        let mut troubles = self.troubles;
        if self.differs {
            troubles.insert(Trouble::SafetyValuesDiffer);
        }
        troubles
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
        let is_unlocked = slave.is_unlocked();
        if core::mem::replace(&mut self.was_unlocked, is_unlocked) && !is_unlocked {
            self.pages.revert_loosened();
        }
        let mut wanted = at_rest && (self.take_taught(controller) || self.taught_waits);
        if let Some(change) = self.pages.take_change() {
            if let Ok(calibration) = change {
                self.differs = calibration.has_other_safety_values(self.fitted);
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
