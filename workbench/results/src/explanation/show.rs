//! Text form of the results.

use std::fmt;

use hitch_identification::explanation::explain::Verdict;
use hitch_identification::selection::candidate::plausibility;

use super::{
    Alternative, Candidate, ChannelFigures, Diagnosis, Explanation, Head, Next, NotVisible,
    Parameter, Step, Suggested, UNSUITABLE_BASE, Unexplained,
};
use hitch_output::text::colour::{self, by_sigma, sigma};
use hitch_output::text::words;
use hitch_output::text::{Table, indented, joined, known, significant, wrapped};

/// Indentation of the details of a step, characters.
const DETAIL: usize = 5;

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.head)?;
        if let Some(error) = self.error_refitted {
            writeln!(
                f,
                "  error {error:.2} sigma with the effects of the model refitted\n"
            )?;
        }
        if let Some(corrected) = &self.corrected_constants {
            let head = corrected.sentence(self.head.error_before);
            writeln!(f, "{}\n\n{corrected}", wrapped(&head))?;
        }
        for (i, step) in self.steps.iter().enumerate() {
            write!(f, "  {}. {step}", i + 1)?;
        }
        if !self.steps.is_empty() {
            writeln!(f)?;
        }
        for step in &self.doubtful {
            writeln!(f, "{}\n", wrapped(&step.doubt()))?;
        }
        writeln!(
            f,
            "{}",
            wrapped(&format!(
                "Verdict: {}. {}",
                colour::verdict(self.head.verdict),
                self.meaning()
            ))
        )?;
        if self.unfinished {
            let line = "The search reached its limit of time or rounds before its result was stable: there may be more effects.";
            writeln!(f, "{}", wrapped(line))?;
        }
        write!(f, "{}{}", self.unexplained, self.next)?;
        if !self.not_visible.is_empty() {
            let line = format!("{}:", self.blind_spots());
            writeln!(f, "{}", wrapped(&line))?;
        }
        self.not_visible
            .iter()
            .try_for_each(|effect| write!(f, "{effect}"))
    }
}

impl fmt::Display for NotVisible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut line = format!("{}: {}", self.effect, self.shows);
        if !self.missing_channels.is_empty() {
            line += &format!("; no run has {}", self.missing_channels.join(", "));
        }
        writeln!(f, "{}", indented(&line, 2))
    }
}

impl fmt::Display for Next {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.next_experiment {
            Some(sentence) => {
                let line = format!("Next experiment: {sentence}.");
                writeln!(f, "{}", wrapped(&line))
            }
            None => Ok(()),
        }
    }
}

impl fmt::Display for Alternative {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            effect, angle_deg, ..
        } = self;
        write!(
            f,
            "{effect} (angle {angle_deg:.1} deg on this campaign; 0 deg: alike)"
        )
    }
}

impl Explanation {
    /// Text of a comparison of two campaigns that shows no change.
    pub const UNCHANGED: &str = "No change is detectable with these campaigns.";

    /// The campaign and the explained model as the reference of a comparison, with its error in sigma as it is shown.
    pub fn as_reference(&self, error: &str) -> String {
        let added = match joined(self.steps.iter().map(Step::name), ", ") {
            names if names.is_empty() => names,
            names => format!(" with {names}"),
        };
        let Head {
            campaign, model, ..
        } = &self.head;
        format!("Baseline {campaign}: model {model}{added}, error {error} sigma")
    }

    /// Title of the list of effects that are not detectable, without colon.
    pub fn blind_spots(&self) -> &'static str {
        "Effects that are not detectable in this campaign at their typical size"
    }

    /// The verdict as a sentence.
    pub fn meaning(&self) -> &'static str {
        let by_constants = self.corrected_constants.is_some() && self.steps.is_empty();
        match (self.head.verdict, self.steps.is_empty()) {
            ("explained", _) if by_constants => {
                "With fitted constants the model explains the measurements to within the noise. No effect is missing."
            }
            ("nothing-missing", _) => {
                "The model explains the measurements to within the noise of the instruments."
            }
            ("explained", _) => {
                "With the added effects the model explains the measurements to within the noise."
            }
            ("ambiguous", _) => {
                "The model is adequate with the added effects, but an effect is indistinguishable from another one."
            }
            ("unexplained", true) => {
                "The model is not adequate, and no effect of the catalogue improves it."
            }
            ("unexplained", false) => {
                "The added effects improve the model, but the remaining error has no cause in the catalogue."
            }
            _ => "The campaign does not allow a decision.",
        }
    }
}

/// Share of the error from which a candidate has a row; a smaller one is shown as 0.0 %.
const SHOWN: f64 = 0.0005;

/// Probability of constants that are off from which a diagnosis mentions them.
const MENTIONED: f64 = 0.05;

impl Diagnosis {
    /// A sentence about the constants, if they may be off.
    pub fn constants_hint(&self) -> Option<String> {
        (self.constants_off >= MENTIONED).then(|| {
            format!(
                "The declared constants may be off (probability {:.2}), which lowers the confidences of the effects. Use hitch explain, which weighs both, or fit the constants with hitch model fit.",
                self.constants_off
            )
        })
    }
}

impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.head)?;
        let mut table = Table::new([
            "candidate",
            "explains",
            "error",
            "confidence",
            "detectability",
        ]);
        let (acting, idle): (Vec<&Candidate>, Vec<&Candidate>) = self
            .candidates
            .iter()
            .partition(|candidate| candidate.explains >= SHOWN);
        for candidate in acting {
            table.row([
                candidate.name(),
                format!("{:.1} %", 100.0 * candidate.explains),
                sigma(candidate.error_after),
                words::in_words(candidate.confidence).to_owned(),
                format!("{:.2}", candidate.detectability),
            ]);
            if let Some(parameter) = candidate.parameters.first() {
                table.note(format!("{parameter}: {}", parameter.meaning));
            }
        }
        writeln!(f, "{table}")?;
        if !idle.is_empty() {
            let names = joined(idle.iter().map(|candidate| candidate.name()), ", ");
            let line = format!("They explain nothing: {names}.");
            writeln!(f, "{}", wrapped(&line))?;
        }
        let terms = words::sentences(&[words::EXPLAINS, words::CONFIDENCE, words::DETECTABILITY]);
        writeln!(f, "{}", wrapped(&terms))?;
        for candidate in self
            .candidates
            .iter()
            .filter(|candidate| !candidate.indistinguishable.is_empty())
        {
            let others = candidate.indistinguishable.join(", ");
            let name = candidate.name();
            let line = format!("With these data {name} is indistinguishable from {others}.");
            writeln!(f, "{}", wrapped(&line))?;
        }
        writeln!(
            f,
            "Verdict with the best candidate alone: {}.",
            colour::verdict(self.head.verdict)
        )?;
        if let Some(hint) = self.constants_hint() {
            writeln!(f, "{}", wrapped(&hint))?;
        }
        if self.head.verdict == Verdict::Unexplained.name() {
            let hint = "No single effect explains this campaign: several differences are likely, and the confidences, which \
                        compare single effects, do not apply. Use hitch explain, which searches sets of effects.";
            writeln!(f, "{}", wrapped(hint))?;
        }
        write!(f, "{}", self.next)
    }
}

impl fmt::Display for Head {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.unsuitable_base {
            writeln!(f, "{}\n", wrapped(UNSUITABLE_BASE))?;
        }
        let head = format!("Campaign {}, model {}", self.campaign, self.model);
        writeln!(f, "{}", wrapped(&head))?;
        let [before, after] = [self.error_before, self.error_after].map(sigma);
        writeln!(
            f,
            "  error {before} -> {after} sigma (noise of the instruments: {:.2})\n",
            self.noise_floor
        )?;
        let row = |(channel, values): (&&str, &ChannelFigures)| {
            let [before, after, rest @ ..] = values.cells();
            let [worst, best] = values.sigmas();
            let sigmas = [by_sigma(&before, worst), by_sigma(&after, best)];
            let names = [(*channel).to_owned()].into_iter();
            names.chain(sigmas).chain(rest)
        };
        let header = ["channel"].into_iter().chain(ChannelFigures::HEADINGS);
        write!(f, "{}", Table::of(header, self.channels.iter().map(row)))?;
        for (channel, values) in &self.channels {
            if let Some(parts) = values.delay_ms() {
                let line = format!("{channel} is {parts} behind the currents");
                writeln!(f, "{}", indented(&line, 2))?;
            }
        }
        Ok(())
    }
}

impl Step {
    /// Its effect on held-out runs.
    fn on_held_out(&self) -> String {
        let (before, after) = (self.held_out_before, self.held_out_after);
        if before.is_nan() && after.is_nan() {
            return "no runs held out".to_owned();
        }
        format!(
            "on held-out runs {} -> {}{}",
            known(before, 2),
            known(after, 2),
            self.without_outliers()
        )
    }

    /// The previous size of a changed effect.
    fn change(&self) -> String {
        let Some((from, parameter)) = self.changed_from.zip(self.parameters.first()) else {
            return String::new();
        };
        let space = if parameter.unit.is_empty() { "" } else { " " };
        format!(
            "changed from {}{space}{} to ",
            significant(from, 4),
            parameter.unit
        )
    }

    /// The reason for adding it although the error on held-out runs did not decrease: a few outliers dominate that
    /// error while the next effect is missing.
    fn without_outliers(&self) -> String {
        if self.held_out_after >= self.held_out_before {
            format!(
                " ({:.2} -> {:.2} with the robust loss of the fit)",
                self.held_out_loss_before, self.held_out_loss_after
            )
        } else {
            String::new()
        }
    }
}

/// What the parameters of an effect are, in a few words.
pub fn meanings(parameters: &[Parameter]) -> String {
    let one = |parameter: &Parameter| format!("{}: {}", parameter.name, parameter.meaning);
    joined(parameters.iter().map(one), "; ")
}

/// A step without its number; lines after the first are indented.
impl Step {
    /// Why an effect that reduces the error is not named, as a sentence.
    pub fn doubt(&self) -> String {
        format!(
            "Not named: {}, {}. The error with it is {:.2} sigma, but it is {}.",
            self.name(),
            self.sizes(),
            self.error_after,
            words::probable(self.confidence)
        )
    }

    /// Its parameters, and the size that it had before.
    fn sizes(&self) -> String {
        format!("{}{}", self.change(), joined(&self.parameters, ", "))
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = format!("{}: {}", self.name(), self.sizes());
        // The number that precedes it takes the place of the indentation.
        writeln!(f, "{}", indented(&head, DETAIL).trim_start())?;
        let mut detail = |line: &str| writeln!(f, "{}", indented(line, DETAIL));
        detail(&meanings(&self.parameters))?;
        detail(&format!(
            "error {:.2} -> {}, {}; confidence: {}; detectability {:.2}",
            self.error_before,
            sigma(self.error_after),
            self.on_held_out(),
            words::probable(self.confidence),
            self.detectability
        ))?;
        if plausibility(self.explained_share) < 0.5 {
            let share = 100.0 * self.explained_share;
            detail(&format!(
                "explains {share:.0} % of the error where it acts: probably another effect, outside the catalogue, acts there"
            ))?;
        }
        if self.form_undetermined {
            let forms = self.other_forms.iter();
            let forms = forms.map(|form| form.unwrap_or("default"));
            detail(&format!(
                "form undetermined: {} explains the campaign equally well",
                joined(forms, ", ")
            ))?;
        }
        if !self.alternatives.is_empty() {
            let others = joined(&self.alternatives, ", ");
            detail(&format!("indistinguishable from: {others}"))?;
        }
        Ok(())
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            unit,
            value,
            low,
            high,
            at_its_limit,
            ..
        } = self;
        let space = if unit.is_empty() { "" } else { " " };
        let number = |value: f64| significant(value, 4);
        write!(f, "{name} {}{space}{unit}", number(*value))?;
        if low.is_nan() || high.is_nan() {
            return Ok(());
        }
        write!(f, " ({} to {})", number(*low), number(*high))?;
        if *at_its_limit {
            write!(f, ", at its limit")?;
        }
        Ok(())
    }
}

impl fmt::Display for Unexplained {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.share < 0.005 && self.depends_on.is_empty() {
            return Ok(());
        }
        let mut line = format!(
            "{:.1} % of the squared error above the noise remains",
            100.0 * self.share
        );
        if !self.depends_on.is_empty() {
            line += &format!("; it correlates with {}", self.depends_on.join(", "));
        }
        writeln!(f, "{}", indented(&line, 2))?;
        if let Some(place) = &self.whereabouts {
            let line = format!("It is largest at {place}.");
            writeln!(f, "{}", indented(&line, 2))?;
        }
        self.suggested
            .as_ref()
            .map_or(Ok(()), |term| write!(f, "{term}"))
    }
}

impl fmt::Display for Suggested {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut head = format!(
            "Suggested term: it reduces the error on held-out runs from {} to {}",
            known(self.held_out_before, 2),
            known(self.held_out_after, 2)
        );
        if !self.replaces.is_empty() {
            head += &format!(", in place of {}", self.replaces.join(", "));
        }
        writeln!(f, "\n{}:\n", indented(&head, 2))?;
        let formula = format!("{} = {}", self.place, self.formula);
        writeln!(f, "{}", indented(&formula, 4))?;
        writeln!(f, "{}\n", indented(&joined(&self.parameters, ", "), 4))?;
        let line = "It describes the error; it is not an identified cause. For a model file:";
        writeln!(f, "{}", indented(line, 2))?;
        for line in self.model_file.lines() {
            let indent = if line.is_empty() { "" } else { "    " };
            writeln!(f, "{indent}{line}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
