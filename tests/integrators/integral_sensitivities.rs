//! Sensitivities of integrals, against closed forms and SUNDIALS' example.

use faer::Mat;
use pliant::{
    ode::{Dae, Failure, Ode},
    sundials::{
        Callback, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions, InitialCondition, Integrator,
        Sensitivities, SensitivityMethod, SensitivitySource,
    },
};

/// y' = -a y, with z = b y as an algebraic unknown of the DAE, and the integrals of b y^2 and of y'.
struct Decay {
    p: [f64; 2],
    /// The integrands with changed parameters beyond t = 0.5.
    trouble: Option<fn() -> Result<(), Failure>>,
}

const P: [f64; 2] = [1.3, 0.6];

fn decay() -> Decay {
    Decay { p: P, trouble: None }
}

impl Ode for Decay {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = -self.p[0] * y[0];
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        2
    }

    fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        if let Some(trouble) = self.trouble.filter(|_| t > 0.5 && self.p != P) {
            trouble()?;
        }
        qdot.copy_from_slice(&[self.p[1] * y[0] * y[0], -self.p[0] * y[0]]);
        Ok(())
    }

    fn sensitivity_rhs(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        parameter: usize,
        s: &[f64],
        sdot: &mut [f64],
    ) -> Result<(), Failure> {
        sdot[0] = -self.p[0] * s[0] - if parameter == 0 { y[0] } else { 0.0 };
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

impl Dae for Decay {
    fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        r.copy_from_slice(&[yp[0] + self.p[0] * y[0], y[1] - self.p[1] * y[0]]);
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        2
    }

    /// The same integrals, by the algebraic unknown and by the derivative.
    fn quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        if let Some(trouble) = self.trouble.filter(|_| t > 0.5 && self.p != P) {
            trouble()?;
        }
        qdot.copy_from_slice(&[y[1] * y[0], yp[0]]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

/// Their derivatives by a and b at time t, and the time derivatives of these.
fn exact(t: f64) -> [Mat<f64>; 2] {
    let ([a, b], y) = (P, (-P[0] * t).exp());
    let by_a = b * (t * y * y / a - (1.0 - y * y) / (2.0 * a * a));
    let of = |values: [[f64; 2]; 2]| Mat::from_fn(2, 2, |i, j| values[i][j]);
    [
        of([[by_a, (1.0 - y * y) / (2.0 * a)], [-t * y, 0.0]]),
        of([[-2.0 * b * t * y * y, y * y], [-y + a * t * y, 0.0]]),
    ]
}

fn far(found: faer::MatRef<'_, f64>, exact: &Mat<f64>) -> f64 {
    (found.to_owned() - exact).norm_max()
}

fn wanted() -> Sensitivities {
    Sensitivities::of([0, 1]).integrals()
}

#[test]
fn integrals_of_an_ode_by_each_method_and_source() {
    let methods = [
        SensitivityMethod::Simultaneous,
        SensitivityMethod::Staggered,
        SensitivityMethod::StaggeredOneByOne,
    ];
    let sources = [
        (SensitivitySource::CentralDifferences, 1e-8),
        (SensitivitySource::Supplied, 1e-8),
        // measured 4e-9: the equations are next to linear
        (SensitivitySource::ForwardDifferences, 2e-8),
    ];
    for method in methods {
        for (source, tolerance) in sources {
            let sensitivities = wanted().method(method).source(source);
            let options = CvodeOptions::new(1e-9, 1e-11).sensitivities(sensitivities);
            let mut cvode = Cvode::new(decay(), 0.0, &[1.0], &options).unwrap();
            assert_eq!(far(cvode.quadrature_sensitivities(), &Mat::zeros(2, 2)), 0.0);
            for t in [0.4, 1.5, 3.0] {
                cvode.solve_to(t).unwrap();
                let error = far(cvode.quadrature_sensitivities(), &exact(t)[0]);
                println!("{method:?}, {source:?}: {error:e}");
                assert!(error < tolerance, "{method:?}, {source:?} at {t}: {error:e}");
            }
            // between the ends of the step, with a derivative, and after a new start from zero
            let (start, end) = cvode.last_step();
            let (middle, mut out) = (0.5 * (start + end), Mat::zeros(2, 2));
            for derivative in [0, 1] {
                let order = derivative as usize;
                cvode
                    .interpolate_quadrature_sensitivities(middle, derivative, out.as_mut())
                    .unwrap();
                let error = far(out.as_ref(), &exact(middle)[order]);
                // the derivative of an interpolant has an order less
                assert!(error < [tolerance, 2e-6][order], "{derivative}: {error:e}");
            }
            cvode.reinit(0.0, &[1.0]).unwrap();
            assert_eq!(far(cvode.quadrature_sensitivities(), &Mat::zeros(2, 2)), 0.0);
            cvode.solve_to(1.0).unwrap();
            assert!(far(cvode.quadrature_sensitivities(), &exact(1.0)[0]) < tolerance);
        }
    }
}

#[test]
fn integrals_of_a_dae() {
    for sensitivities in [wanted(), wanted().staggered()] {
        let options =
            IdaOptions::new(1e-8, 1e-10).differential([true, false]).sensitivities(sensitivities);
        let mut ida = Ida::new(decay(), 0.0, &[1.0, 0.0], &[0.0; 2], &options).unwrap();
        ida.consistent_start(InitialCondition::Algebraic, 3.0).unwrap();
        for t in [0.4, 1.5, 3.0] {
            ida.solve_to(t).unwrap();
            let error = far(ida.quadrature_sensitivities(), &exact(t)[0]);
            println!("{error:e}");
            assert!(error < 3e-8, "{t}: {error:e}");
        }
        let (start, end) = ida.last_step();
        let (middle, mut out) = (0.5 * (start + end), Mat::zeros(2, 2));
        ida.interpolate_quadrature_sensitivities(middle, 0, out.as_mut()).unwrap();
        assert!(far(out.as_ref(), &exact(middle)[0]) < 3e-8);
        assert!(
            ida.interpolate_quadrature_sensitivities(middle, 0, Mat::zeros(1, 2).as_mut()).is_err()
        );
    }
}

/// The forward part of `idasHessian_ASA_FSA` of SUNDIALS 6.4.1: the derivatives of the integral of |y|^2/2 over Robertson's
/// reactions, of which its `.out` prints five digits.
#[test]
fn the_forward_gradient_of_the_example_of_idas() {
    struct Robertson([f64; 2]);
    impl Dae for Robertson {
        fn residual(
            &mut self,
            _t: f64,
            y: &[f64],
            yp: &[f64],
            r: &mut [f64],
        ) -> Result<(), Failure> {
            let exchange = self.0[0] * y[0] - self.0[1] * y[1] * y[2];
            r[0] = yp[0] + exchange;
            r[1] = yp[1] - exchange + 3e7 * y[1] * y[1];
            r[2] = y[0] + y[1] + y[2] - 1.0;
            Ok(())
        }
        fn quadrature_count(&self) -> usize {
            1
        }
        fn quadratures(
            &mut self,
            _t: f64,
            y: &[f64],
            _yp: &[f64],
            q: &mut [f64],
        ) -> Result<(), Failure> {
            q[0] = 0.5 * y.iter().map(|y| y * y).sum::<f64>();
            Ok(())
        }
        fn parameters(&self) -> &[f64] {
            &self.0
        }
        fn set_parameters(&mut self, values: &[f64]) {
            self.0.copy_from_slice(values);
        }
    }
    let options = IdaOptions::new(1e-7, 1e-10)
        .differential([true, true, false])
        .sensitivities(Sensitivities::of([0, 1]).integrals());
    let (y0, yp0) = ([1.0, 0.0, 0.0], [-0.04, 0.04, 0.0]);
    let mut ida = Ida::new(Robertson([0.04, 1e4]), 0.0, &y0, &yp0, &options).unwrap();
    ida.consistent_start(InitialCondition::Algebraic, 80.0).unwrap();
    ida.solve_to(80.0).unwrap();
    let (value, slopes) = (ida.quadratures()[0], ida.quadrature_sensitivities());
    println!("{value} {slopes:?}");
    for (found, printed) in
        [(value, 2.5042e1), (slopes[(0, 0)], -1.3753e2), (slopes[(0, 1)], 4.1552e-4)]
    {
        // half of the last digit that is printed
        assert!((found / printed - 1.0).abs() < 3.7e-5, "{found} {printed}");
    }
}

/// Their errors control the steps where those of integrals do.
#[test]
fn error_control_follows_that_of_the_integrals() {
    let steps = |sensitivities: Sensitivities, on: bool| {
        let options = CvodeOptions::new(1e-6, 1e-9)
            .sensitivities(sensitivities)
            .quadrature_tolerances(1e-10, 1e-12)
            .quadrature_error_control(on);
        let mut cvode = Cvode::new(decay(), 0.0, &[1.0], &options).unwrap();
        cvode.solve_to(3.0).unwrap();
        let found = cvode.quadrature_sensitivities();
        let error = if found.ncols() > 0 { far(found, &exact(3.0)[0]) } else { 0.0 };
        (cvode.statistics().steps, error)
    };
    let (free, controlled) = (steps(wanted(), false), steps(wanted(), true));
    println!("{free:?} {controlled:?}");
    assert!(2 * free.0 < controlled.0 && controlled.1 < 1e-8 && free.1 < 1e-4);
    assert_eq!(steps(Sensitivities::of([0, 1]), false).0, free.0);
}

#[test]
fn troubles_and_unusable_input_are_named() {
    let options = CvodeOptions::new(1e-6, 1e-9).sensitivities(wanted());
    let plain = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    };
    let plain = pliant::ode::with_parameters(
        move |t: f64, y: &[f64], _: &[f64], ydot: &mut [f64]| plain(t, y, ydot),
        [1.0, 2.0],
    );
    match Cvode::new(plain, 0.0, &[1.0], &options) {
        Err(Error::Input(error)) => assert!(error.to_string().contains("quadrature_count")),
        other => panic!("{other:?}"),
    }
    let fails: fn() -> Result<(), Failure> = || Err(Failure::Fatal("no".into()));
    let mut cvode =
        Cvode::new(Decay { p: P, trouble: Some(fails) }, 0.0, &[1.0], &options).unwrap();
    let dae = IdaOptions::new(1e-6, 1e-9).differential([true, false]).sensitivities(wanted());
    let start = ([1.0, P[1]], [-P[0], -P[0] * P[1]]);
    let mut ida =
        Ida::new(Decay { p: P, trouble: Some(fails) }, 0.0, &start.0, &start.1, &dae).unwrap();
    for outcome in [cvode.solve_to(1.0), ida.solve_to(1.0)] {
        match outcome {
            Err(Error::Integration(error)) => {
                assert_eq!(error.cause, Cause::Fatal(Callback::Quadratures));
            }
            other => panic!("{other:?}"),
        }
    }
    assert_eq!((cvode.system().p, ida.system().p), (P, P), "put back to the last bit");
    // without them there are none
    let options = CvodeOptions::new(1e-6, 1e-9).sensitivities(Sensitivities::of([0]));
    let cvode = Cvode::new(decay(), 0.0, &[1.0], &options).unwrap();
    assert_eq!(cvode.quadrature_sensitivities().ncols(), 0);
}
