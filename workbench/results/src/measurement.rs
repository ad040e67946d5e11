//! Faults of the measurement as text.

use std::fmt::Write;

use hitch_measurement::Finding;

use hitch_output::text::indented;

/// The faults with their cures; empty without any.
pub fn text(findings: &[Finding]) -> String {
    if findings.is_empty() {
        return String::new();
    }
    let mut text = "Faults of the measurement, by the logs alone\n".to_owned();
    for finding in findings {
        let seen = indented(&format!("{}: {}", place(finding), finding.seen), 2);
        // Writing to a string does not fail.
        let _ = writeln!(text, "{seen}\n{}", indented(&finding.cure, 4));
    }
    text + "\n"
}

/// Run, channel and time of a fault.
fn place(finding: &Finding) -> String {
    let run = finding.run.as_deref().unwrap_or("all runs");
    let channel = finding.channel.map(|channel| format!(", {channel}"));
    let time = finding.from_s.zip(finding.to_s);
    let time = time.map(|(from_s, to_s)| format!(", {from_s:.2} to {to_s:.2} s"));
    format!(
        "{run}{}{}",
        channel.unwrap_or_default(),
        time.unwrap_or_default()
    )
}

#[cfg(test)]
mod tests {
    use hitch_measurement::{Evidence, Finding, Kind};

    use super::text;

    #[test]
    fn lines_have_80_columns() {
        let finding = Finding {
            kind: Kind::Spikes,
            run: Some("lift_1.5A_050kg.csv".to_owned()),
            channel: Some("cylinder_pressure_bar"),
            from_s: Some(1.0),
            to_s: Some(2.5),
            evidence: Evidence {
                value: 3.0,
                accuracy: 0.3,
                unit: "bar",
            },
            seen: "What is seen. ".repeat(10),
            cure: "What cures it. ".repeat(10),
        };
        let text = text(&[finding]);
        assert!(text.contains("lift_1.5A_050kg.csv, cylinder_pressure_bar, 1.00 to 2.50 s: What"));
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
        assert!(super::text(&[]).is_empty());
    }
}
