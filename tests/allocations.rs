//! Stepping allocates nothing: a run with thousands of steps more makes as many allocations.

use allocation_counter::measure;
use pliant::samples::square_jump;
use pliant::{ContactEvents, Method, Sampling, Settings};

#[test]
fn steps_do_not_allocate() {
    let scene = square_jump(10).unwrap();
    for method in Method::ALL {
        let run = |rtol: f64| {
            // an event that is located starts the integration anew
            let contact_events = ContactEvents::StepOver;
            let solver =
                Settings { method, rtol, alpha: 1e4, contact_events, ..Settings::default() };
            let mut steps = 0;
            let allocated = measure(|| {
                let trajectory = scene.simulate(&solver, &Sampling::phase_ends()).unwrap();
                steps = trajectory.report().steps();
            });
            (steps, allocated.count_total)
        };
        let ((few, allocations_of_few), (many, allocations_of_many)) = (run(1e-3), run(1e-9));
        println!("{method}: {allocations_of_few} in {few} steps, {allocations_of_many} in {many}");
        assert!(many > few + 3000, "{method}: {few} and {many} steps");
        // one path may set up something at first use; each change of method makes an integrator
        let slack = if method == Method::Auto { (many - few) as u64 / 20 } else { 5 };
        assert!(allocations_of_many <= allocations_of_few + slack, "{method}");
    }
}
