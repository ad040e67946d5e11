//! Reads a model file.

use std::collections::HashSet;

use hitch_input::input_error::{InputError, quote};
use hitch_input::naming::offer_names;
use hitch_input::source_file::SourceFile;
use hitch_input::toml_reader::TomlTable;
use hitch_plant::units::m3_s_from_lpm;
use hitch_plant::{
    AddedEffect, Constants, Dynamics, Effect, LinkageError, Model, Parameter, ValveCurve,
};

use crate::constants::{
    CURRENT, CURVES, Constant, Curve, FLOW, TABLES, Variant, clear_others, unset,
};
use crate::{terms, variant};

/// Range of the currents of a flow curve, A.
const CURRENT_A: std::ops::RangeInclusive<f64> = 0.0..=20.0;
/// Range of the flows of a flow curve, l/min.
const FLOW_LPM: std::ops::RangeInclusive<f64> = 0.0..=1000.0;

/// The model of a file, whose base `starting_point` finds by its name.
pub fn model(
    source: &SourceFile,
    starting_point: impl Fn(&str) -> Option<Model>,
) -> Result<Model, InputError> {
    let top = TomlTable::parse(source)?;
    top.check_format()?;
    top.only(
        &[
            &["format", "name", "base", "dynamics", "term", "effect"],
            &TABLES[..],
        ]
        .concat(),
    )?;
    let base = base(&top, starting_point)?;
    let complete = base.is_some();
    let mut constants = base.map_or_else(unset, |base| base.constants().clone());
    constants.dynamics = dynamics(&top, complete.then_some(constants.dynamics))?;
    variant::read(&top, &mut constants)?;
    for table in TABLES {
        read_table(&top, table, &mut constants, complete)?;
    }
    clear_others(&mut constants);
    let name = top
        .text("name")?
        .map_or_else(|| file_stem(source), str::to_owned);
    let model = Model::new(name, constants).map_err(|error| linkage_fault(&top, &error))?;
    let model = model.with_terms(terms::read(&top)?);
    let effects = added_effects(&top, &hitch_effects::available(&model))?;
    Ok(model.with_effects(effects))
}

/// The base model of the file.
fn base(
    top: &TomlTable<'_>,
    starting_point: impl Fn(&str) -> Option<Model>,
) -> Result<Option<Model>, InputError> {
    let Some(name) = top.text("base")? else {
        return Ok(None);
    };
    let unknown = || {
        top.error_at(
            "base",
            format!("base {} is not known", quote(name)),
            "use \"nominal\" or \"dynamic\"",
        )
    };
    starting_point(name).map(Some).ok_or_else(unknown)
}

fn dynamics(top: &TomlTable<'_>, inherited: Option<Dynamics>) -> Result<Dynamics, InputError> {
    match (top.text("dynamics")?, inherited) {
        (Some("steady"), _) => Ok(Dynamics::Steady),
        (Some("dynamic"), _) => Ok(Dynamics::Dynamic),
        (None, Some(inherited)) => Ok(inherited),
        (None, None) => Err(top.missing("dynamics")),
        (Some(other), _) => {
            let what = format!("dynamics {} is not known", quote(other));
            Err(top.error_at("dynamics", what, "use \"steady\" or \"dynamic\""))
        }
    }
}

/// Reads one table into the constants. Missing keys keep the values of the constants; they are faults if there are none.
fn read_table(
    top: &TomlTable<'_>,
    name: &str,
    constants: &mut Constants,
    complete: bool,
) -> Result<(), InputError> {
    let Some(table) = top.table(name)? else {
        return if complete || has_values(constants, name) {
            Ok(())
        } else {
            Err(missing_table(top, name, Variant::of(constants)))
        };
    };
    let variant = Variant::of(constants);
    table.only(&variant.keys(name))?;
    for constant in variant.constants_of(name) {
        read_constant(&table, constant, constants)?;
    }
    for curve in CURVES.iter().filter(|curve| curve.table == name) {
        read_curve(&table, curve, constants, complete)?;
    }
    Ok(())
}

/// Whether every key of a table already has a value.
fn has_values(constants: &mut Constants, table: &str) -> bool {
    let mut numbers = Variant::of(constants).constants_of(table);
    !CURVES.iter().any(|curve| curve.table == table)
        && numbers.all(|constant| !(constant.place)(constants).is_nan())
}

fn missing_table(top: &TomlTable<'_>, name: &str, variant: Variant) -> InputError {
    let hint = format!(
        "add it, or a line base = \"nominal\" to use the nominal values for missing keys: {}",
        variant.keys(name).join(", ")
    );
    top.error(format!("table [{name}] is missing"), hint)
}

fn read_constant(
    table: &TomlTable<'_>,
    constant: &Constant,
    constants: &mut Constants,
) -> Result<(), InputError> {
    match table.number(constant.key, constant.range.clone())? {
        Some(value) => *(constant.place)(constants) = value * constant.unit,
        // A base has no value for a variant that it is not.
        None if !(constant.place)(constants).is_nan() => {}
        None => return Err(table.missing(constant.key)),
    }
    Ok(())
}

fn read_curve(
    table: &TomlTable<'_>,
    curve: &Curve,
    constants: &mut Constants,
    complete: bool,
) -> Result<(), InputError> {
    let current_a = table.numbers(CURRENT, CURRENT_A)?;
    let flow_lpm = table.numbers(FLOW, FLOW_LPM)?;
    match (current_a, flow_lpm) {
        (Some(current_a), Some(flow_lpm)) => {
            let flow_m3_s = flow_lpm.into_iter().map(m3_s_from_lpm).collect();
            let fault = |error: hitch_plant::ValveCurveError| {
                table.error_at(CURRENT, error.to_string(), "")
            };
            (curve.place)(constants).curve =
                ValveCurve::new(current_a, flow_m3_s).map_err(fault)?;
            Ok(())
        }
        (None, None) if complete => Ok(()),
        (None, _) => Err(table.missing(CURRENT)),
        (_, None) => Err(table.missing(FLOW)),
    }
}

fn added_effects(
    top: &TomlTable<'_>,
    catalogue: &[&'static dyn Effect],
) -> Result<Vec<AddedEffect>, InputError> {
    let mut added: Vec<AddedEffect> = Vec::new();
    for table in &top.tables("effect")? {
        let effect = effect_of(table, catalogue)?;
        if added.iter().any(|other| other.effect.id() == effect.id()) {
            let what = format!("{} is duplicated", effect.id());
            return Err(table.error_at("id", what, "delete one of the two [[effect]] blocks"));
        }
        let parameters = effect.parameters();
        let known: Vec<&str> = ["id", "form"]
            .into_iter()
            .chain(parameters.iter().map(|parameter| parameter.key))
            .collect();
        table.only(&known)?;
        let value = |parameter: &Parameter| {
            table.required_number(parameter.key, parameter.low..=parameter.high)
        };
        added.push(AddedEffect {
            effect,
            values: parameters.iter().map(value).collect::<Result<_, _>>()?,
        });
    }
    Ok(added)
}

fn effect_of(
    table: &TomlTable<'_>,
    catalogue: &[&'static dyn Effect],
) -> Result<&'static dyn Effect, InputError> {
    let id = table.required_text("id")?;
    let forms: Vec<&'static dyn Effect> = catalogue
        .iter()
        .copied()
        .filter(|effect| effect.id() == id)
        .collect();
    if forms.is_empty() {
        let mut seen = HashSet::new();
        let ids = catalogue.iter().map(|effect| effect.id());
        let known: Vec<&str> = ids.filter(|id| seen.insert(*id)).collect();

        let what = format!("effect {} is not known", quote(id));
        return Err(table.error_at("id", what, offer_names(id, &known)));
    }
    let form = table.text("form")?;
    let found = forms.iter().find(|effect| effect.form() == form);
    found.copied().ok_or_else(|| {
        let known: Vec<&str> = forms.iter().filter_map(|effect| effect.form()).collect();
        let what = format!("{id} has no form {}", quote(form.unwrap_or_default()));
        let help = if known.is_empty() {
            "omit the line".to_owned()
        } else {
            format!("omit the line, or write one of: {}", known.join(", "))
        };
        table.error_at("form", what, help)
    })
}

/// Position of the first key in the file among the constants that the error may be about.
fn linkage_fault(top: &TomlTable<'_>, fault: &LinkageError) -> InputError {
    let (what, hint) = (fault.to_string(), fault.hint());
    for (table, key) in fault.keys() {
        if let Ok(Some(table)) = top.table(table)
            && table.has(key)
        {
            return table.error_at(key, format!("{key}: {what}"), hint);
        }
    }
    top.error(what, hint)
}

fn file_stem(source: &SourceFile) -> String {
    source.path.file_stem().map_or_else(
        || "model".to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}
