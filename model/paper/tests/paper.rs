//! The paper's statements on lifting and lowering times (section 4.3, Figure 12), for both models.

use hitch_paper::travel_time::panel;
use hitch_plant::Valve;

#[test]
fn lifting_time_does_not_depend_on_load() {
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let lifting = panel(&model, Valve::Lift);
        let spread = lifting.spread_over_load().expect("every lift arrives");
        assert!(spread < 0.01, "{}: {spread}", model.name);
        assert!(lifting.falls_with_current(), "{}", model.name);
    }
}

#[test]
fn lowering_time_falls_with_load_and_with_current() {
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let lowering = panel(&model, Valve::Lowering);
        assert!(lowering.falls_with_load(), "{}: {lowering:?}", model.name);
        assert!(
            lowering.falls_with_current(),
            "{}: {lowering:?}",
            model.name
        );
    }
}
