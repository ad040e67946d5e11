//! The catalogue of physical effects: one file an effect, one line in [`CATALOGUE`] each.
//!
//! # Adding an effect
//! 1. A new file beside this one, named like the effect. Its doc comment states the equation, where it comes from and
//!    how large the effect usually is.
//! 2. In it one `pub static` of type `described::Described`: texts, parameters with unit, range, null value and typical
//!    size, the channels in which it shows on a lab campaign, the starting point that it needs if not every one can show
//!    it, how its size is looked for, and `attach`. The first parameter is the size: at its null value the effect is not
//!    there, whatever the others are. `flow_force.rs` is a short example, `pin_backlash.rs` one that remembers.
//! 3. `attach` gets a value for each parameter, in its unit, and what is known of the run ([`RunConditions`]), and puts
//!    numbers, closures or small stateful parts at the [`Sites`] where the physics acts; SI inside. If no site is where
//!    it acts, add one to [`Sites`] and call it from the component concerned.
//! 4. One `mod` and one line in [`CATALOGUE`].
//!
//! Where the literature has two equations for one effect, each is an effect of its own with the same id and a `form`;
//! the usual one has none. A search tries all and keeps the better, as `oil_viscosity.rs` and `spool_stiction.rs` show.
//!
//! Nothing else: plant, model files, identification, reports and `hitch effects` go through the catalogue, and so do
//! the generic tests of `tests/effects.rs`: the null value changes not a bit, next to it the effect is next to nothing,
//! a typical size shows in the channels named. A term that is to be tried without recompiling goes into a model file
//! instead (see `term.rs`).

mod angle_sensor_gain;
mod angle_sensor_lag;
mod bulk_modulus;
mod check_valve_loss;
mod compensator_droop;
mod compensator_margin;
mod coulomb_friction;
mod described;
mod entrained_air;
mod flow_force;
mod flow_scale;
mod ground_contact;
mod hose_compliance;
mod load_arm;
mod load_inertia;
mod lowering_leakage;
mod oil_viscosity;
mod over_the_stroke;
mod pin_backlash;
mod pin_friction;
mod pressure_sensor_offset;
mod pump_flow;
mod pump_leakage;
mod relief_override;
mod return_line_loss;
mod solenoid_hysteresis;
mod spool_lag;
mod spool_stiction;
mod stribeck_friction;
mod term;
mod threshold_shift;
mod viscous_friction;

pub use term::TermEffect;

use crate::campaign::Channel;
use crate::model::Dynamics;
use crate::plant::sites::{RunConditions, Sites};

/// Every effect that the project knows, from the coil to the instruments: where several act at one place, they act in
/// this order.
pub static CATALOGUE: &[&dyn Effect] = &[
    &threshold_shift::LIFT,
    &threshold_shift::LOWERING,
    &flow_scale::LIFT,
    &flow_scale::LIFT_UNEVEN,
    &flow_scale::LOWERING,
    &flow_scale::LOWERING_UNEVEN,
    &solenoid_hysteresis::SolenoidHysteresis,
    &spool_stiction::STICKING,
    &spool_stiction::FOLLOWING,
    &spool_lag::CREEPING,
    &spool_lag::SWINGING,
    &flow_force::ON_FLOW,
    &flow_force::ON_TRAVEL,
    &oil_viscosity::SERIES,
    &oil_viscosity::FLOW_NUMBER,
    &compensator_droop::WITH_LOAD,
    &compensator_droop::WITH_FLOW,
    &compensator_droop::LAGGING,
    &compensator_margin::PRELOAD,
    &compensator_margin::BYPASS,
    &check_valve_loss::THROTTLING,
    &check_valve_loss::LIFTING,
    &pump_leakage::PUMP_LEAKAGE,
    &pump_flow::PUMP_FLOW,
    &relief_override::RELIEF_OVERRIDE,
    &return_line_loss::TURBULENT,
    &return_line_loss::LAMINAR,
    &lowering_leakage::EVEN,
    &lowering_leakage::THINNING,
    &entrained_air::ENTRAINED_AIR,
    &bulk_modulus::BULK_MODULUS,
    &hose_compliance::ELASTIC,
    &hose_compliance::CREEPING,
    &coulomb_friction::SMOOTH,
    &coulomb_friction::BRISTLES,
    &stribeck_friction::STRIBECK_FRICTION,
    &viscous_friction::EVEN,
    &viscous_friction::THICKENING,
    &pin_friction::EVEN,
    &pin_friction::UNEVEN,
    &pin_backlash::PIN_BACKLASH,
    &load_inertia::OF_LOAD,
    &load_inertia::AND_SHAFT,
    &load_arm::WITH_WEIGHT,
    &load_arm::WITH_LOAD,
    &ground_contact::SPRINGY,
    &ground_contact::DAMPED,
    &angle_sensor_gain::ANGLE_SENSOR_GAIN,
    &angle_sensor_lag::FILTERING,
    &angle_sensor_lag::DELAYED,
    &pressure_sensor_offset::PRESSURE_SENSOR_OFFSET,
];

/// Share of the end of a parameter's range, or of its typical value, within which a value counts as at that end.
const AT_A_LIMIT: f64 = 1e-3;

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name, without the unit.
    pub name: &'static str,
    /// Unit as it is written in reports; empty for a pure number.
    pub unit: &'static str,
    /// Key in a model file: the name with the unit in it.
    pub key: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// Value that turns the effect off exactly; of no account for a parameter that is not the size.
    pub null: f64,
    /// A size that is often met, for starting values, signatures and tests.
    pub typical: f64,
    /// Smallest value that makes sense.
    pub low: f64,
    /// Largest value that makes sense.
    pub high: f64,
}

impl Parameter {
    /// Whether a value is at an end of the range, and that end does not turn the effect off.
    #[must_use]
    pub fn is_at_a_limit(&self, value: f64) -> bool {
        let near = |end: f64| AT_A_LIMIT * end.abs().max(self.typical.abs());
        let is_at = |end: f64| end != self.null && (value - end).abs() <= near(end);
        is_at(self.low) || is_at(self.high)
    }
}

/// How the size of an effect is looked for before it is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Search {
    /// Along a few secants: from most sizes a fit leads to the best one.
    Secants,
    /// In fine steps: a size that is a few percent off can be worse than none, for what jumps or bounces does so at
    /// another time then.
    Jumps,
    /// Along secants as well, but the cost comes down to the best size over ledges: whether a spool moves on a step of
    /// the current is the same for all bands that are less, and slopes over small steps are those of the noise. The
    /// first shape is a share of the size, and it is the rest of the size that shows.
    Ledges,
    /// Place by place: the size is where something is met, and nothing tells of it before.
    Places,
}

impl Search {
    /// Whether the cost has many valleys along the size.
    #[must_use]
    pub fn is_rough(self) -> bool {
        self != Self::Secants
    }
}

/// Ratio of the ends of a range from which a parameter is taken by its order of magnitude.
const DECADE: f64 = 10.0;

impl Parameter {
    /// Whether its range covers so much that its order of magnitude is what counts.
    #[must_use]
    pub fn is_by_magnitude(&self) -> bool {
        self.low > 0.0 && self.high.is_finite() && self.high > DECADE * self.low
    }

    /// The value that lies a share of its range above another, evenly or by its order of magnitude, within the range.
    #[must_use]
    pub fn moved(&self, value: f64, share: f64) -> f64 {
        let moved = if self.is_by_magnitude() {
            value * (self.high / self.low).powf(share)
        } else {
            value + share * (self.high - self.low)
        };
        moved.clamp(self.low, self.high)
    }

    /// A natural size of a step of it, in its unit: from nothing to the typical value, or what there is of that.
    #[must_use]
    pub fn scale(&self) -> f64 {
        let width = self.high - self.low;
        [self.typical - self.null, self.typical, 0.1 * width, 1.0]
            .into_iter()
            .map(f64::abs)
            .find(|size| *size > 0.0 && size.is_finite())
            .unwrap_or(1.0)
    }
}

/// A physical effect that a plant can have beyond the paper's model.
pub trait Effect: Sync {
    /// Its name in files, commands and reports.
    fn id(&self) -> &'static str;
    /// Which of several equations it is where one effect is known in more than one form; `None` for the usual one.
    fn form(&self) -> Option<&'static str> {
        None
    }
    /// Its name in words.
    fn title(&self) -> &'static str;
    /// Its equation, as text.
    fn equation(&self) -> &'static str;
    /// Where the equation and the typical size come from.
    fn source(&self) -> &'static str;
    /// Where it shows and what it is easily taken for.
    fn shows(&self) -> &'static str;
    /// Its parameters; the first one is its size, and at its null value the effect is off whatever the others are.
    fn parameters(&self) -> &'static [Parameter];
    /// The channels that it changes directly on a lab campaign.
    fn channels(&self) -> &'static [Channel];
    /// The starting point that it needs, if not every one can show it.
    fn needs(&self) -> Option<Dynamics> {
        None
    }
    /// How its size is looked for before it is fitted.
    fn search(&self) -> Search {
        Search::Secants
    }
    /// Whether it only says more of what its effect's usual form says: it is looked for from what that one finds.
    fn refines(&self) -> bool {
        false
    }
    /// Puts it into a plant, with a value for each parameter.
    fn attach(&self, values: &[f64], conditions: RunConditions<'_>, sites: &mut Sites);
}

impl std::fmt::Debug for dyn Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.id())
    }
}

/// The name of an effect with its form, as commands take it: `id`, or `id/form`.
#[must_use]
pub fn full_name(effect: &dyn Effect) -> String {
    let id = effect.id();
    effect
        .form()
        .map_or_else(|| id.to_owned(), |form| format!("{id}/{form}"))
}

/// Whether two effects are the same in the same form.
#[must_use]
pub fn is_same(one: &dyn Effect, other: &dyn Effect) -> bool {
    one.id() == other.id() && one.form() == other.form()
}

/// Looks an effect up by its id, in its usual form.
#[must_use]
pub fn find(id: &str) -> Option<&'static dyn Effect> {
    CATALOGUE.iter().copied().find(|effect| effect.id() == id)
}

/// An effect with values for its parameters, as a model holds it.
#[derive(Debug, Clone)]
pub struct AddedEffect {
    /// Which effect.
    pub effect: &'static dyn Effect,
    /// One value a parameter, in the parameter's unit.
    pub values: Vec<f64>,
}

impl AddedEffect {
    /// The effect at its typical size.
    #[must_use]
    pub fn typical(effect: &'static dyn Effect) -> Self {
        let values = effect.parameters().iter().map(|p| p.typical).collect();
        Self { effect, values }
    }

    /// The same effect in another form: what both have keeps its value, the rest has its typical one.
    #[must_use]
    pub fn in_form(&self, form: &'static dyn Effect) -> Self {
        let own = self.effect.parameters().iter().zip(&self.values);
        let value = |other: &Parameter| {
            let same = own.clone().find(|(own, _)| own.name == other.name);
            same.map_or(other.typical, |(_, &value)| value)
        };
        Self {
            effect: form,
            values: form.parameters().iter().map(value).collect(),
        }
    }

    /// The effect turned off.
    #[must_use]
    pub fn null(effect: &'static dyn Effect) -> Self {
        let mut added = Self::typical(effect);
        added.values[0] = effect.parameters()[0].null;
        added
    }

    /// Whether its size is the null value.
    #[must_use]
    pub fn is_null(&self) -> bool {
        self.values[0] == self.effect.parameters()[0].null
    }

    /// Puts it into a plant; an effect at its null value is not there at all.
    pub fn attach(&self, conditions: RunConditions<'_>, sites: &mut Sites) {
        if !self.is_null() {
            self.effect.attach(&self.values, conditions, sites);
        }
    }
}
