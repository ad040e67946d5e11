//! The hitches of a page at work on a field.

use std::time::Instant;

use hitch_closed_loop::driven::{
    FieldOrders, FieldView, FunctionOrder, GroundOrder, HitchView, Machine, Models, Orders, Pair,
    SoilOrder,
};
use hitch_closed_loop::field::{LINK_DEPTH_M, RAISED_DEG, TOUCH_DEG};
use hitch_model_file::{dynamic, nominal};

/// Set point of the draft, N: that of a plough at 25 cm in loam.
const DRAFT_N: f64 = 18_200.0;

fn machine() -> Machine {
    Models::new(nominal(), dynamic())
        .machine()
        .expect("a machine")
}

fn orders(lever_deg: f64, function: FunctionOrder) -> Orders {
    Orders {
        lever_deg,
        button: None,
        hold: false,
        quick_lift: false,
        load_kg: 150.0,
        oil_temperature_c: 40.0,
        fault: None,
        field: Some(FieldOrders {
            soil: SoilOrder::Medium,
            varies: true,
            ground: GroundOrder::Flat,
            soft_patches: 0,
            speed_m_s: 1.8,
            function,
            draft_n: DRAFT_N,
            depth_m: 0.25,
            mix: 0.5,
            slip_limit: 0.2,
            engage: false,
        }),
    }
}

fn working_deg(machine: &Machine) -> f64 {
    hitch_closed_loop::field::Coupling::new(&machine.plant, TOUCH_DEG, 0.0).angle_deg(LINK_DEPTH_M)
}

/// Advances by whole seconds; the views of the second hitch.
fn drive(pair: &mut Pair<'_>, orders: &Orders, seconds: usize) -> Vec<HitchView> {
    (0..seconds)
        .map(|_| {
            let [_, second] = pair.advance(orders, 1000);
            second
        })
        .collect()
}

fn field(view: &HitchView) -> &FieldView {
    view.field.as_ref().expect("a field")
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let all: Vec<f64> = values.collect();
    all.iter().sum::<f64>() / all.len() as f64
}

fn mean_of(views: &[HitchView], of: fn(&FieldView) -> &Vec<f64>) -> f64 {
    mean(
        views
            .iter()
            .flat_map(|view| of(field(view)).iter().copied()),
    )
}

/// What determined the set point at the end of each view.
fn reasons(views: &[HitchView]) -> impl Iterator<Item = &'static str> {
    let now = views.iter().filter_map(|view| field(view).now.as_ref());
    now.filter_map(|now| now.reason)
}

#[test]
fn draft_control_settles_at_its_set_point_and_says_so() {
    let machine = machine();
    let raised = orders(RAISED_DEG, FunctionOrder::Draft);
    let mut pair = Pair::new(&machine, &raised, RAISED_DEG);
    let above = drive(&mut pair, &raised, 5);
    let now = field(&above[4]).now.as_ref().expect("a state");
    assert_eq!(now.reason, Some("above-ground"));
    assert!(now.draft_kn == 0.0 && now.depth_m < 0.0, "{now:?}");
    let lowered = orders(working_deg(&machine), FunctionOrder::Draft);
    drive(&mut pair, &lowered, 15);
    let work = drive(&mut pair, &lowered, 30);
    let draft_kn = mean_of(&work, |field| &field.draft_kn);
    assert!((draft_kn * 1e3 / DRAFT_N - 1.0).abs() < 0.05, "{draft_kn}");
    let by_draft = reasons(&work).filter(|reason| *reason == "draft").count();
    println!("mean draft {draft_kn:.2} kN, by the draft in {by_draft} of 30 s");
    assert!(by_draft > 15, "{by_draft}");
}

#[test]
fn a_soft_patch_comes_in_front_and_the_slip_raises_the_implement_on_it() {
    let machine = machine();
    let mut wanted = orders(working_deg(&machine), FunctionOrder::Draft);
    let mut pair = Pair::new(&machine, &wanted, RAISED_DEG);
    drive(&mut pair, &wanted, 20);
    let before = drive(&mut pair, &wanted, 5);
    wanted.field.as_mut().expect("a field").soft_patches += 1;
    let [_, pressed] = pair.advance(&wanted, 100);
    let now = field(&pressed).now.as_ref().expect("a state");
    let first = now.ground.soft.iter().position(|soft| *soft);
    let first_m = now.ground.from_m + now.ground.step_m * first.expect("a soft patch") as f64;
    assert!((3.5..=4.2).contains(&first_m), "{first_m} m ahead");
    let on_it = drive(&mut pair, &wanted, 10);
    let [shallow, deep] =
        [&on_it[5..], &before].map(|views| mean_of(views, |field| &field.depth_cm));
    let reasons: Vec<_> = reasons(&on_it).collect();
    println!("depth {deep:.1} cm before the patch, {shallow:.1} cm on it; {reasons:?}");
    assert!(reasons.contains(&"slip"), "{reasons:?}");
    assert!(shallow < deep - 2.0, "{shallow} {deep}");
}

#[test]
fn another_texture_begins_in_front_of_the_tractor() {
    let machine = machine();
    let mut wanted = orders(working_deg(&machine), FunctionOrder::Position);
    wanted.field.as_mut().expect("a field").varies = false;
    let mut pair = Pair::new(&machine, &wanted, RAISED_DEG);
    let loam = drive(&mut pair, &wanted, 20);
    wanted.field.as_mut().expect("a field").soil = SoilOrder::Coarse;
    let [_, turned] = pair.advance(&wanted, 100);
    let ground = &field(&turned).now.as_ref().expect("a state").ground;
    assert_eq!(ground.texture[0], "medium");
    assert_eq!(ground.texture.last(), Some(&"coarse"));
    let sand = drive(&mut pair, &wanted, 15);
    let kn_per_cm = [&loam[15..], &sand[10..]].map(|views| {
        let draft_kn = mean_of(views, |field| &field.draft_kn);
        draft_kn / mean_of(views, |field| &field.depth_cm)
    });
    // D497.5: the factors of coarse and medium soil are 0.45 and 0.70.
    let ratio = kn_per_cm[1] / kn_per_cm[0];
    println!("draft per depth in sand over loam: {ratio:.3}");
    assert!((ratio - 0.45 / 0.70).abs() < 0.01, "{kn_per_cm:?}");
}

#[test]
fn orders_outside_their_range_are_refused() {
    let mut wanted = orders(90.0, FunctionOrder::Draft);
    assert_eq!(wanted.fault(), None);
    wanted.field.as_mut().expect("a field").speed_m_s = 9.0;
    let fault = wanted.fault().expect("a fault");
    assert!(fault.contains("speed_m_s is 9"), "{fault}");
}

/// Prints the computing time of a millisecond of both hitches.
#[test]
fn both_hitches_on_a_field_keep_up_with_the_clock() {
    let machine = machine();
    let mut wanted = orders(working_deg(&machine), FunctionOrder::Draft);
    wanted.field.as_mut().expect("a field").ground = GroundOrder::Rough;
    let mut pair = Pair::new(&machine, &wanted, RAISED_DEG);
    let began = Instant::now();
    for _ in 0..200 {
        pair.advance(&wanted, 60);
    }
    let taken_us = began.elapsed().as_secs_f64() / (200.0 * 60.0) * 1e6;
    println!("a millisecond of both hitches on a rough field takes {taken_us:.0} us");
    assert!(taken_us < 1000.0, "{taken_us} us");
}
