//! The result of a draft campaign: as text and JSON.
mod effects;
mod example;
mod interval;
mod show;
mod working;

use hitch_draft::fit::Fit;
use hitch_draft::machine::{at_speed, texture_name};
use hitch_draft::manifest::Campaign;
use schemars::JsonSchema;
use serde::Serialize;

pub use effects::{HiddenEffect, Open};
pub use example::write_example;
pub use interval::Interval;
pub use working::read_working;

/// Result of `hitch draft`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DraftResult {
    /// Name of the campaign.
    pub campaign: String,
    /// Kind of the implement in the table of ASABE D497.5.
    pub implement: String,
    /// Working width in m, or number of tools.
    pub width: f64,
    /// What the width counts: m or tool.
    pub width_unit: String,
    /// Texture of the soil that the standard's coefficients are for.
    pub texture: String,
    /// The coefficients F A, F B and F C of the law D = F (A + B S + C S²) W T, with S in km/h and T in cm.
    pub coefficients: Vec<Coefficient>,
    /// Draft over that of the standard at the campaign's mean speed, 1. The standard's factors are F times this one: a campaign
    /// in one soil does not separate implement and soil.
    pub over_standard: Interval,
    /// Soil factor F of the standard's implement that has this draft, 1.
    pub soil_factor: Interval,
    /// Range of the standard for a single field, ±%.
    pub standard_range_percent: f64,
    /// Mean speed in the soil, km/h.
    pub mean_speed_km_h: f64,
    /// Mean depth in the soil, cm.
    pub mean_depth_cm: f64,
    /// Draft at the mean speed per cm of depth, over the whole width, N/cm.
    pub draft_per_cm: Interval,
    /// Draft at the mean speed and depth, N.
    pub mean_draft: Interval,
    /// Variation of the soil.
    pub soil: SoilVariation,
    /// Effects that the law lacks, the most probable first.
    pub effects: Vec<HiddenEffect>,
    /// What the campaign leaves open; nothing if every effect is present or absent.
    pub open: Option<Open>,
    /// What follows is drawn in the report.
    #[serde(skip)]
    pub fit: Fit,
}

/// A coefficient.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Coefficient {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The value of the standard.
    pub standard: f64,
    /// The value of the campaign.
    #[serde(flatten)]
    pub value: Interval,
}

/// How the strength of the soil varies.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct SoilVariation {
    /// Coefficient of variation of the draft between metres, %.
    pub variation_percent: f64,
    /// Correlation length that is most probable, m, among lengths that are powers of two.
    pub correlation_length_m: f64,
    /// Metres in work.
    pub metres: usize,
    /// Number of independent samples that determine the level of the draft as well as these metres.
    pub effective_samples: f64,
}

impl DraftResult {
    /// The result of a campaign's fit.
    #[must_use]
    pub fn of(campaign: &Campaign, fit: Fit) -> Self {
        let machine = &fit.machine;
        let width_unit = machine.width_unit();
        let reference = fit.reference;
        let standard = machine.standard();
        let named = ["F A", "F B", "F C"]
            .into_iter()
            .zip(["", " (km/h)", " (km/h)2"]);
        let coefficients = named.enumerate().map(|(power, (name, per))| Coefficient {
            name: name.to_owned(),
            unit: format!("N/(cm {width_unit}{per})"),
            standard: standard[power],
            value: fit.coefficients[power].into(),
        });
        let over_standard = Interval::from(fit.over_the_standard());
        let specific = Interval::from(fit.specific_draft(reference.speed_km_h));
        let draft_per_cm = specific.times(machine.width);
        let row = &machine.kind.row;
        Self {
            campaign: campaign.name.clone(),
            implement: machine.kind.name.to_owned(),
            width: machine.width,
            width_unit: width_unit.to_owned(),
            texture: texture_name(machine.texture).to_owned(),
            coefficients: coefficients.collect(),
            over_standard,
            soil_factor: over_standard.times(row.soil_factor(machine.texture)),
            standard_range_percent: row.range_percent,
            mean_speed_km_h: reference.speed_km_h,
            mean_depth_cm: reference.depth_cm,
            draft_per_cm,
            mean_draft: draft_per_cm.times(reference.depth_cm),
            soil: SoilVariation {
                variation_percent: 100.0 * fit.variation,
                correlation_length_m: fit.shape.length_m,
                metres: fit.blocks.iter().filter(|block| block.in_soil).count(),
                effective_samples: fit.effective_samples,
            },
            effects: effects::of(&fit),
            open: effects::open(&fit),
            fit,
        }
    }

    /// Draft of the law of a fit, N, with its interval.
    #[must_use]
    pub fn draft(fit: &Fit, depth_cm: f64, speed_km_h: f64) -> Interval {
        Interval::from(fit.specific_draft(speed_km_h)).times(fit.machine.width * depth_cm)
    }

    /// Draft of the standard, N.
    #[must_use]
    pub fn standard_draft(fit: &Fit, depth_cm: f64, speed_km_h: f64) -> f64 {
        at_speed(&fit.machine.standard(), speed_km_h) * fit.machine.width * depth_cm
    }
}
