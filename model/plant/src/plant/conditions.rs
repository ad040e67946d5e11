//! Changes of load and oil temperature during a run.

use crate::components::lag::Lag;
use crate::components::oil;
use crate::hooks::acting::kinds;
use crate::plant::{Plant, attached};
use crate::state::Rig;

impl Plant<'_> {
    /// Changes the load of a hitch, kg; the piston keeps its travel and speed. No effect on a flow bench.
    pub fn set_load_kg(&mut self, load_kg: f64) {
        let Rig::Hitch(mut rig) = self.rig else {
            return;
        };
        rig.load_kg = load_kg;
        self.rig = Rig::Hitch(rig);
        self.signals.load_kg = load_kg;
        self.changed();
    }

    /// Changes the oil temperature, C; piston, oil and spools keep their state. Effects with memory, for example
    /// hysteresis, start at rest at the present currents.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.hooks = attached(self.model, oil_temperature_c);
        self.kinds = kinds(&self.hooks);
        let stages = self.hooks.currents.iter_mut();
        stages.fold(self.input, |currents, stage| stage.rest(currents));
        let lag_s = (self.model.spool_lag_s() + self.hooks.spool_lag_extra_s).max(0.0);
        let spools = self.spool_currents;
        self.spools = [spools.lift_a, spools.lower_a].map(|a| Lag::at_rest(lag_s, a));
        self.signals.oil_temperature_c = oil_temperature_c;
        self.signals.viscosity_m2_s = oil::viscosity_m2_s(oil_temperature_c);
        let mut reading = self.truth();
        for sensor in &mut self.hooks.sensors {
            sensor.rest(&mut reading);
        }
        self.changed();
    }

    /// Updates what follows from the conditions.
    fn changed(&mut self) {
        self.stands = false;
        if let Rig::Hitch(rig) = self.rig {
            self.lowest_m = self.forces(&rig).lowest_m().min(self.state.piston_m);
        }
    }
}
