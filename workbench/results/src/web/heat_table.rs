//! A table of figures, coloured by size.
use maud::{Markup, html};

/// Colour scale of a table.
#[derive(Debug, Clone, Copy, Default)]
pub enum Shade {
    /// An error in sigma: without colour at one (noise), darkest at thirty and above, as on the page of `hitch serve`.
    #[default]
    Sigmas,
    /// A figure with a limit: white at the ideal value, yellow at the limit, orange as far above it.
    Bar {
        /// Ideal value.
        best: f64,
        /// Limit.
        bar: f64,
    },
}

impl Shade {
    /// From 0 (ideal) to 1.
    fn heat(self, value: f64) -> f64 {
        let heat = match self {
            Self::Sigmas => value.max(1e-9).ln() / DARKEST_SIGMA.ln(),
            Self::Bar { best, bar } => 0.5 * (value - best) / (bar - best),
        };
        heat.clamp(0.0, 1.0)
    }

    /// Style of a cell; its text is legible in both themes.
    fn style(self, value: f64) -> String {
        let heat = self.heat(value);
        match self {
            Self::Sigmas => format!("background:rgba(var(--heat), {:.2})", OPAQUE * heat),
            Self::Bar { .. } => format!("background:{};color:#1b1f24", colour(heat)),
        }
    }
}

/// Error with the darkest colour, sigma.
const DARKEST_SIGMA: f64 = 30.0;

/// Opacity of the darkest colour.
const OPAQUE: f64 = 0.5;

/// Figures by row and column.
#[derive(Debug, Clone, Default)]
pub struct HeatTable {
    /// Name of the rows' column.
    pub corner: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Name and cells of each row; `None` where nothing was measured.
    pub rows: Vec<(String, Vec<Option<f64>>)>,
    /// Colour scale.
    pub shade: Shade,
}

impl HeatTable {
    /// The table as HTML. Every cell has its value as text; the colour is redundant.
    pub fn table(&self) -> Markup {
        html! { div.scroll tabindex="0" role="group" aria-label="Table" { table {
            thead { tr {
                th scope="col" { (self.corner) }
                @for name in &self.columns { th scope="col" { (name) } }
            } }
            tbody { @for (name, cells) in &self.rows { tr {
                th scope="row" { (name) }
                @for cell in cells { (heat_cell(*cell, self.shade)) }
            } } }
        } } }
    }
}

fn heat_cell(value: Option<f64>, shade: Shade) -> Markup {
    match value.filter(|value| value.is_finite()) {
        None => html! { td.none { "–" } },
        Some(value) => {
            html! { td style=(shade.style(value)) { (number(value)) } }
        }
    }
}

/// From white over yellow (a half) to orange; light enough for dark text.
fn colour(heat: f64) -> String {
    const WHITE: [f64; 3] = [255.0, 255.0, 255.0];
    const YELLOW: [f64; 3] = [255.0, 236.0, 170.0];
    const ORANGE: [f64; 3] = [247.0, 160.0, 90.0];
    let (from, to, share) = if heat < 0.5 {
        (WHITE, YELLOW, heat * 2.0)
    } else {
        (YELLOW, ORANGE, heat * 2.0 - 1.0)
    };
    let mix = |i: usize| from[i] + (to[i] - from[i]) * share;
    format!(
        "#{:02x}{:02x}{:02x}",
        mix(0) as u8,
        mix(1) as u8,
        mix(2) as u8
    )
}

fn number(value: f64) -> String {
    if value < 99.95 {
        format!("{value:.2}")
    } else {
        format!("{value:.0}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_no_colour_and_errors_are_not() {
        let style = |sigmas| Shade::Sigmas.style(sigmas);
        assert_eq!(style(0.9), style(1.0));
        assert!(style(1.0).ends_with(" 0.00)"));
        assert_eq!(style(30.0), style(1e6));
        assert_ne!(style(3.0), style(1.0));
    }

    #[test]
    fn a_bar_is_half_way() {
        let shade = Shade::Bar {
            best: 1.0,
            bar: 1.4,
        };
        let heats = [0.9, 1.0, 1.4, 1.8, 9.0].map(|ratio| shade.heat(ratio));
        for (heat, expected) in heats.into_iter().zip([0.0, 0.0, 0.5, 1.0, 1.0]) {
            assert!((heat - expected).abs() < 1e-9, "{heats:?}");
        }
    }

    #[test]
    fn missing_cells_are_dashes() {
        let row = ("lifting".to_owned(), vec![None, Some(f64::NAN), Some(2.0)]);
        let table = HeatTable {
            rows: vec![row],
            ..HeatTable::default()
        };
        let text = table.table().into_string();
        assert_eq!(text.matches('–').count(), 2);
        assert!(text.contains("2.00"));
    }
}
