//! Bar chart of errors from zero, with the noise as lower limit.
use maud::{Markup, html};

use super::scale::Scale;
use hitch_output::text::joined;

const WIDTH_PX: f64 = 480.0;
const ROW_PX: f64 = 44.0;
const NAME_PX: f64 = 20.0;
const BAR_PX: f64 = 18.0;
const VALUE_PX: f64 = 60.0;

/// One bar: a step, and the error after it, in sigma.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Title of the step.
    pub name: String,
    /// Root mean square of the error in sigma.
    pub error: f64,
}

/// The bars, from zero on a linear scale, with a line at one sigma.
pub fn staircase(steps: &[Step]) -> Markup {
    let greatest = steps.iter().map(|step| step.error).fold(2.0, f64::max);
    let scale = Scale::new((0.0, greatest), (0.0, WIDTH_PX - VALUE_PX));
    let height = ROW_PX * steps.len() as f64 + 26.0;
    html! { figure.staircase {
        svg viewBox=(format!("0 0 {WIDTH_PX} {height}")) role="img" aria-label=(spoken(steps)) {
            @for (i, step) in steps.iter().enumerate() { (bar(step, i as f64 * ROW_PX, &scale)) }
            text x="0" y=(height - 5.0) { "error in sigma, from zero; line: 1, the noise" }
        }
    } }
}

fn bar(step: &Step, top: f64, scale: &Scale) -> Markup {
    let length = scale.px(step.error).max(1.0);
    let (high, low) = (top + NAME_PX, top + NAME_PX + BAR_PX);
    let middle = (high + low) / 2.0;
    let floor = scale.px(1.0);
    html! {
        text x="0" y=(high - 5.0) { (step.name) }
        rect x="0" y=(high) width=(length) height=(BAR_PX) {}
        line.floor x1=(floor) x2=(floor) y1=(high - 3.0) y2=(low + 3.0) {}
        text x=(length + 6.0) y=(middle) dominant-baseline="middle" { (format!("{:.2}", step.error)) }
    }
}

fn spoken(steps: &[Step]) -> String {
    let told = steps.iter();
    let told = told.map(|step| format!("{} {:.2}", step.name, step.error));
    format!("Error in sigma: {}", joined(told, ", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_a_bar_a_step() {
        let steps = [("nominal", 9.8), ("+ lower-threshold-shift", 1.02)];
        let steps = steps.map(|(name, error)| Step {
            name: name.to_owned(),
            error,
        });
        let text = staircase(&steps).into_string();
        let lengths = text.split("<rect ").skip(1).map(|bar| {
            let (_, rest) = bar.split_once(" width=\"").unwrap();
            rest.split_once('"').unwrap().0.parse::<f64>().unwrap()
        });
        let lengths: Vec<f64> = lengths.collect();
        assert!(
            (lengths[0] / lengths[1] - 9.8 / 1.02).abs() < 1e-6,
            "{lengths:?}"
        );
        assert_eq!(text.matches("<rect").count(), 2);
        assert!(text.contains("9.80") && text.contains("1.02"));
    }
}
