use super::*;

const PARAMETER: Parameter = Parameter {
    name: "scale",
    meaning: "relative change of the flow",
    unit: "",
    value: -0.05,
    low: -0.06,
    high: -0.04,
    at_its_limit: false,
};

#[test]
fn what_is_not_known_is_left_out() {
    let absent = Parameter {
        low: f64::NAN,
        high: f64::NAN,
        ..PARAMETER
    };
    assert_eq!(absent.to_string(), "scale -0.05000");
    let step = Step {
        effect: "lowering-leakage",
        form: Some("thinning"),
        form_undetermined: false,
        other_forms: Vec::new(),
        changed_from: None,
        error_before: 3.0,
        error_after: 1.0,
        held_out_before: f64::NAN,
        held_out_after: f64::NAN,
        held_out_loss_before: f64::NAN,
        held_out_loss_after: f64::NAN,
        confidence: 1.0,
        explained_share: 1.0,
        indistinguishable: Vec::new(),
        alternatives: Vec::new(),
        detectability: 2.0,
        parameters: vec![PARAMETER],
    };
    let text = step.to_string();
    assert!(
        text.starts_with("lowering-leakage/thinning: scale"),
        "{text}"
    );
    assert!(
        text.contains("error 3.00 -> 1.00, no runs held out;"),
        "{text}"
    );
}

#[test]
fn a_parameter_without_a_unit_has_no_stray_space() {
    let parameter = PARAMETER;
    assert_eq!(
        parameter.to_string(),
        "scale -0.05000 (-0.06000 to -0.04000)"
    );
}
