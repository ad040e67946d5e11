//! Writes a model file.

use std::fmt::Write as _;

use hitch_effects::TermEffect;
use hitch_plant::units::M3_S_PER_LPM;
use hitch_plant::{AddedEffect, Constants, Dynamics, Model, PumpKind, ValveCurve};

use crate::constants::{
    CURRENT, CURVES, CYLINDERS, FLOW, KIND, KINDS, LINKAGE_COLUMNS, M_PER_MM, RAD_PER_DEG, TABLES,
    Variant,
};
use crate::quoted::quoted;
use crate::round_trip::decimal;
use crate::terms;

/// The text of a complete model file. Writing to a string cannot fail, so the results are ignored.
pub fn model(model: &Model) -> String {
    let constants = model.constants().clone();
    let dynamics = dynamics_name(constants.dynamics);
    let mut text = format!(
        "format = 1\nname = {}\ndynamics = \"{dynamics}\"\n",
        quoted(&model.name)
    );
    for table in TABLES {
        let _ = write!(text, "\n[{table}]\n");
        text.extend(
            table_lines(&constants, table, false)
                .into_iter()
                .map(|(_, line)| line),
        );
    }
    for term in model.terms.iter().filter_map(|term| TermEffect::of(*term)) {
        terms::write(&mut text, term);
    }
    for effect in &model.effects {
        write_effect(&mut text, effect);
    }
    text
}

/// Name of the dynamics in a model file.
pub fn dynamics_name(dynamics: Dynamics) -> &'static str {
    match dynamics {
        Dynamics::Steady => "steady",
        Dynamics::Dynamic => "dynamic",
    }
}

/// Name of the kind of a pump in a model file.
pub fn kind_name(kind: PumpKind) -> &'static str {
    let mut kinds = KINDS.iter();
    let named = kinds.find(|(_, known)| *known == kind);
    named.map_or("", |(written, _)| written)
}

/// The lines of a table, each with its key; those that choose a variant with the default only if `all`.
pub fn table_lines(constants: &Constants, table: &str, all: bool) -> Vec<(&'static str, String)> {
    let mut lines = variant_lines(constants, table, all);
    let mut constants = constants.clone();
    for constant in Variant::of(&constants).constants_of(table) {
        let value = decimal(*(constant.place)(&mut constants), constant.unit);
        lines.push((constant.key, format!("{} = {value}\n", constant.key)));
    }
    for curve in CURVES.iter().filter(|curve| curve.table == table) {
        lines.extend(curve_lines(&(curve.place)(&mut constants).curve));
    }
    lines
}

/// The lines of a table that choose a variant of the machine, each with its key; those with the default only if `all`.
fn variant_lines(constants: &Constants, table: &str, all: bool) -> Vec<(&'static str, String)> {
    match (table, &constants.linkage_table) {
        ("pump", _) if all || constants.pump.kind != PumpKind::FixedDisplacement => {
            let kind = kind_name(constants.pump.kind);
            vec![(KIND, format!("{KIND} = \"{kind}\"\n"))]
        }
        ("cylinder", _) if all || constants.cylinder.count != 1 => {
            let count = constants.cylinder.count;
            vec![(CYLINDERS, format!("{CYLINDERS} = {count}\n"))]
        }
        ("linkage", Some(linkage)) => {
            let columns = [
                list(linkage.travel_m(), M_PER_MM),
                list(linkage.angle_rad(), RAD_PER_DEG),
                list(linkage.height_m(), M_PER_MM),
            ];
            let keys = LINKAGE_COLUMNS.into_iter();
            keys.zip(columns)
                .map(|(key, column)| (key, format!("{key} = {column}\n")))
                .collect()
        }
        _ => Vec::new(),
    }
}

/// The two lines of a flow curve, each with its key.
fn curve_lines(curve: &ValveCurve) -> [(&'static str, String); 2] {
    [
        (CURRENT, list(curve.currents_a(), 1.0)),
        (FLOW, list(curve.flows_m3_s(), M3_S_PER_LPM)),
    ]
    .map(|(key, list)| (key, format!("{key} = {list}\n")))
}

fn list(values: &[f64], unit: f64) -> String {
    let items: Vec<String> = values.iter().map(|value| decimal(*value, unit)).collect();
    format!("[{}]", items.join(", "))
}

fn write_effect(text: &mut String, added: &AddedEffect) {
    let _ = write!(text, "\n[[effect]]\nid = \"{}\"\n", added.effect.id());
    if let Some(form) = added.effect.form() {
        let _ = writeln!(text, "form = \"{form}\"");
    }
    for (parameter, value) in added.effect.parameters().iter().zip(&added.values) {
        let _ = writeln!(text, "{} = {}", parameter.key, decimal(*value, 1.0));
    }
}
