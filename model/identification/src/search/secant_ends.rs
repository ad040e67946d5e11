//! One form of an effect at several sizes: the ends of its secants.

use hitch_plant::{AddedEffect, SizeResponse};

use crate::estimation::residual_columns::difference;
use crate::search::dictionary_entry::{Entry, Kind};

/// Further ends of each form that are kept besides the first ones: those of least cost.
const KEPT: usize = 2;

/// Relative distance of sizes below which two ends count as one, for smooth effects and for all others.
const SAME: f64 = 0.3;
const SAME_ROUGH: f64 = 0.005;

/// Bound on the share of a secant in a subset: extrapolation beyond it is unreliable.
pub(crate) const LARGEST_SHARE: f64 = 3.0;

/// The same for switching and located effects, where every size is a separate column. The slack allows for other
/// missing effects.
const ROUGH_SHARES: (f64, f64) = (0.95, 1.05);

/// A simulated effect at one size.
pub(crate) struct End {
    /// The effect.
    pub added: AddedEffect,
    /// Whitened residuals with it, by run.
    pub residuals: Vec<Vec<f64>>,
    /// Cost with it, with the free parameters re-optimised to first order.
    pub cost: f64,
    /// Whether it is one of the first sizes, which are always kept in the dictionary.
    pub first: bool,
}

/// Trust region: the shares of a secant that are nearer to its end than to any other simulated size, within its range.
pub(crate) fn trusted(ends: &[End], index: usize) -> (f64, f64) {
    let own = &ends[index].added;
    let range = &own.effect.parameters()[0];
    let size = own.values[0] - range.null;
    let of_range = [range.low, range.high].map(|end| (end - range.null) / size);
    let mut low = of_range[0].min(of_range[1]).max(-LARGEST_SHARE);
    let mut high = of_range[0].max(of_range[1]).min(LARGEST_SHARE);
    for other in ends {
        if other.added.values[1..] != own.values[1..] {
            continue;
        }
        let share = (other.added.values[0] - range.null) / size;
        if share > 1.0 {
            high = high.min(share.sqrt());
        } else if share < 0.0 {
            low = low.max(0.0);
        } else if share > 0.0 && share < 1.0 {
            low = low.max(share.sqrt());
        }
    }
    (low, high)
}

/// The end with the least cost.
pub(crate) fn best(ends: &[End]) -> Option<&End> {
    ends.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The columns of a form: its first sizes, which show whether it could replace another effect, and the best ones.
pub(crate) fn columns(ends: Vec<End>, here: &[Vec<f64>]) -> Vec<Entry> {
    let trusted: Vec<(f64, f64)> = (0..ends.len()).map(|index| trusted(&ends, index)).collect();
    let mut ends: Vec<(End, (f64, f64))> = ends.into_iter().zip(trusted).collect();
    ends.sort_by(|a, b| a.0.cost.total_cmp(&b.0.cost));
    let mut kept: Vec<(End, (f64, f64))> = Vec::new();
    let mut best = 0;
    for (end, trusted) in ends {
        let same = |(other, _): &(End, (f64, f64))| is_same(&other.added, &end.added);
        let wanted = end.first || (best < KEPT && !kept.iter().any(same));
        best += usize::from(wanted && !end.first);
        if wanted {
            kept.push((end, trusted));
        }
    }
    kept.into_iter()
        .map(|(end, trusted)| column(end, trusted, here))
        .collect()
}

/// Whether two sizes of an effect are close to each other.
fn is_same(one: &AddedEffect, other: &AddedEffect) -> bool {
    let (a, b) = (one.values[0], other.values[0]);
    let same = match one.effect.size_response() {
        SizeResponse::Smooth => SAME,
        SizeResponse::Switching | SizeResponse::Stepped | SizeResponse::Located => SAME_ROUGH,
    };
    one.values[1..] == other.values[1..] && (a - b).abs() <= same * a.abs().max(b.abs())
}

fn column(end: End, trusted: (f64, f64), here: &[Vec<f64>]) -> Entry {
    let share = match end.added.effect.size_response() {
        SizeResponse::Switching | SizeResponse::Located => ROUGH_SHARES,
        SizeResponse::Smooth | SizeResponse::Stepped => trusted,
    };
    Entry {
        kind: Kind::New,
        off: end.added.effect.parameters()[0].null,
        change: difference(here, &end.residuals),
        share,
        added: end.added,
    }
}
