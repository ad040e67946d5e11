//! Copies of a plant in motion.

use crate::model::Model;
use crate::plant::{Plant, attached};

impl Plant<'_> {
    /// A copy in the present state that borrows `model`, which has to be equal to the plant's own.
    ///
    /// Functions of effects have no state, so they are attached anew; components with state are copied.
    #[must_use]
    pub fn copied_onto<'n>(&self, model: &'n Model) -> Plant<'n> {
        let mut hooks = attached(model, self.signals.oil_temperature_c);
        hooks.currents.clone_from(&self.hooks.currents);
        hooks.sensors.clone_from(&self.hooks.sensors);
        Plant {
            model,
            rig: self.rig,
            steps: self.steps,
            hooks,
            kinds: self.kinds,
            spools: self.spools,
            spool_currents: self.spool_currents,
            turning_a_s: self.turning_a_s,
            openings: self.openings,
            state: self.state,
            stands: self.stands,
            lowest_m: self.lowest_m,
            flows: self.flows,
            input: self.input,
            reading: self.reading,
            signals: self.signals,
        }
    }
}
