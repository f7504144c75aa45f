use super::*;

/// a' of Thelen's law by hand, at full and at no activation, and in between.
#[test]
fn activation_rises_faster_than_it_falls() {
    let lag = Lag::activation(0.015, 0.05);
    for (drives, state, expected) in [
        (2.0, 0.0, 2.0 / (0.015 * 0.5)),
        (2.0, 1.0, 1.0 / (0.015 * 1.25)),
        (0.0, 2.0, -2.0 / (0.05 / 2.0)),
        (1.0, 1.5, -0.5 / (0.05 / 1.625)),
    ] {
        let rate = lag.rate(drives, state, 2.0);
        assert!((rate / expected - 1.0).abs() < 1e-14, "{drives} {state}: {rate} {expected}");
    }
}

/// The derivative of a force that is linear in its state is the force of a state of 1.
#[test]
fn derivatives_of_linear_forces_are_exact() {
    struct Linear(Signal);
    impl Force for Linear {
        fn add_forces(
            &self,
            t: f64,
            _u: &[f64],
            _v: &[f64],
            forces: &mut NodalForces,
        ) -> Result<(), Failure> {
            forces.applied[0] += 3.0 * self.0.at(t);
            forces.dissipative[1] -= 0.5 * self.0.rate(t);
            Ok(())
        }
    }
    let mut lagging =
        Lagging::new("a", &Lag::first_order(0.1), None, 1e3, vec![Signal::constant(40.0)]);
    lagging.drive(Arc::new(Linear(lagging.signal())));
    let (mut trial, mut gradient) = ([NodalForces::zeros(2), NodalForces::zeros(2)], [0.0; 2]);
    let [slope, power] =
        lagging.linearize(0.0, [&[0.0; 2], &[2.0; 2]], 20.0, &mut trial, &mut gradient);
    // the rate is 10 (40 - a)
    for (found, expected) in [(slope, -10.0), (power, 6.0), (gradient[0], 3.0), (gradient[1], 5.0)]
    {
        assert!((found - expected).abs() < 1e-7 * expected.abs(), "{found} {expected}");
    }
}
