//! Stepping allocates nothing: not by itself, and a run of a scene with thousands of steps more makes as many
//! allocations.

use allocation_counter::measure;
use pliant::rk::{DormandPrince, Integrator, Options};
use pliant::samples::square_jump;
use pliant::{ContactEvents, Method, Sampling, Settings};

#[test]
fn steps_do_not_allocate() {
    let scene = square_jump(10).unwrap();
    for method in Method::ALL {
        let run = |rtol: f64| {
            // an event that is located starts the integration anew
            let contact_events = ContactEvents::StepOver;
            let settings =
                Settings { method, rtol, alpha: 1e4, contact_events, ..Settings::default() };
            let mut steps = 0;
            let allocated = measure(|| {
                let trajectory = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
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

#[test]
fn runge_kutta_allocates_nothing_after_its_start() {
    let rhs = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        (ydot[0], ydot[1]) = (y[1], -y[0].cos());
        Ok(())
    };
    let mut settings = DormandPrince::new(rhs, 0.0, &[0.0, 0.0], &Options::default()).unwrap();
    let mut y = [0.0; 2];
    let allocated = measure(|| {
        for period in 1..20 {
            settings.solve_to(2.0 * f64::from(period)).unwrap();
            settings.step(f64::MAX).unwrap();
            settings.interpolate(settings.t(), 0, &mut y).unwrap();
        }
        settings.reinit(0.0, &[0.0, 0.0]).unwrap();
        settings.solve_to(2.0).unwrap();
    });
    assert_eq!(allocated.count_total, 0);
}
