//! The plant at rest, at the start of a run.

use crate::constants::Dynamics;
use crate::hooks::place::Place;
use crate::plant::Plant;
use crate::solver::root;
use crate::state::{HitchRig, MechanicalState, Rig};

/// Distance from ground contact, m of travel, within which a hitch at rest counts as standing on the ground: 0.15
/// degree, the accuracy of its sensor. On a stiff floor this distance makes the difference of the whole weight.
const CONTACT_TOLERANCE_M: f64 = 0.3e-3;

impl Plant<'_> {
    /// The plant at rest at the angle that its sensor shows.
    pub(crate) fn state_at_rest(&self) -> MechanicalState {
        match self.rig {
            Rig::Flow { port_pressure_pa } => MechanicalState {
                pressure_pa: port_pressure_pa,
                ..self.idle()
            },
            Rig::Hitch(rig) => {
                let piston_m = self.piston_at_rest_m(&rig);
                self.held_at(&rig, piston_m)
            }
        }
    }

    /// Pressure, Pa, by which the cylinder at the present travel may be above or below that of the weight, while dry
    /// friction holds the piston; zero on a flow bench.
    #[must_use]
    pub fn dry_friction_pa(&self) -> f64 {
        let Rig::Hitch(rig) = self.rig else {
            return 0.0;
        };
        let forces = self.forces(&rig);
        let weight_n = forces.weight_n(self.state.piston_m);
        let at_rest = MechanicalState {
            speed_m_s: 0.0,
            ..self.state
        };
        forces.dry_friction_n(&at_rest, weight_n) / self.model.constants().cylinder.area_m2()
    }

    /// Places a hitch at rest on the ground if its sensor shows it below or slightly above. In the quasi-static plant
    /// it stays at the shown position: below the ground it stands in a hollow, and slightly above the ground carries it
    /// as well.
    pub(crate) fn place_on_ground(&mut self, rig: &HitchRig) {
        let dynamic = self.model.constants().dynamics == Dynamics::Dynamic;
        let off_m = self.state.piston_m - self.lowest_m;
        if self.hooks.ground.is_some() && dynamic && off_m < CONTACT_TOLERANCE_M {
            self.state = self.held_at(rig, self.lowest_m);
        }
        self.lowest_m = self.lowest_m.min(self.state.piston_m);
    }

    /// The hitch held at a piston travel.
    fn held_at(&self, rig: &HitchRig, piston_m: f64) -> MechanicalState {
        let forces = self.forces(rig);
        let held_n = forces.weight_n(piston_m) - forces.ground_n(piston_m, 0.0);
        MechanicalState {
            piston_m,
            speed_m_s: 0.0,
            pressure_pa: held_n.max(0.0) / self.model.constants().cylinder.area_m2(),
            ..self.idle()
        }
    }

    /// State without motion; the pump's flow passes the compensator.
    fn idle(&self) -> MechanicalState {
        MechanicalState {
            compensator_pa: self.idle_pressure_pa(),
            ..MechanicalState::default()
        }
    }

    /// Piston travel, m, at which the angle sensor shows the start angle.
    fn piston_at_rest_m(&self, rig: &HitchRig) -> f64 {
        let linkage = self.model.linkage();
        let shown_deg = rig.start_angle_rad.to_degrees();
        let angle_behind_rad = |shown_deg: f64| {
            let stages = self.hooks.sensors.iter().rev();
            let angle_deg = stages.fold(shown_deg, |deg, stage| stage.angle_behind_deg(deg));
            angle_deg.to_radians()
        };
        if !self.hooks.has_term(Place::AngleSensor) {
            return linkage.piston_m(angle_behind_rad(shown_deg));
        }
        let excess_rad = |piston_m: f64| {
            let signals = self.moment().signals(&self.held_at(rig, piston_m));
            let term_deg = self.hooks.term(Place::AngleSensor, &signals).to_degrees();
            signals.rocker_angle_rad - angle_behind_rad(shown_deg - term_deg)
        };
        let stroke_m = self.model.constants().cylinder.stroke_m;
        root::rising(excess_rad, 0.0, stroke_m, 1e-7)
    }
}
