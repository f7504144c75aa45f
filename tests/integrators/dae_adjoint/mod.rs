//! Adjoint gradients of DAEs, against closed forms, those of ODEs, forward sensitivities and differences.

mod failures;
mod hessian;
mod krylov;

use faer::MatMut;
use pliant::{
    ode::{
        BandMut, Dae, Failure, Functional, Slopes, dae_with_parameters, with_mass, with_parameters,
    },
    sundials::{
        Adjoint, AdjointOptions, CvodeOptions, DaeAdjoint, Gradient, Ida, IdaOptions,
        InitialCondition, Integrator, Jacobian, LinearSolver, MassForm, Pattern, Sensitivities,
    },
};

use crate::support::End;

/// A functional of closures for g and h with their slopes, without parameters in them.
struct By<G, H>(G, H);

impl<G, H> Functional for By<G, H>
where
    G: FnMut(&[f64], &mut [f64]) -> f64,
    H: FnMut(&[f64], &mut [f64]) -> f64,
{
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        let mut unused = vec![0.0; y.len()];
        Ok((self.1)(y, slopes.map_or(&mut unused[..], |slopes| slopes.y)))
    }

    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        _p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        let mut unused = vec![0.0; y.len()];
        Ok((self.0)(y, slopes.map_or(&mut unused[..], |slopes| slopes.y)))
    }
}

/// All numbers of a gradient.
fn numbers(gradient: &Gradient) -> Vec<f64> {
    [&[gradient.value][..], &gradient.parameters, &gradient.initial_state].concat()
}

/// The largest difference, relative to numbers above 1.
fn difference(found: &Gradient, exact: &[f64]) -> f64 {
    let found = numbers(found);
    assert_eq!(found.len(), exact.len());
    found.iter().zip(exact).map(|(x, e)| (x - e).abs() / e.abs().max(1.0)).fold(0.0, f64::max)
}

/// y' = -p0 y + z, 0 = z - p1 y, whose first equation is the second row.
struct Linear {
    p: [f64; 2],
    /// What the residual does with changed parameters before t = 0.5.
    trouble: Option<fn() -> Result<(), Failure>>,
}

const LINEAR: Linear = Linear { p: [2.0, 0.5], trouble: None };

impl Linear {
    fn entries(&self, cj: f64) -> [[f64; 2]; 2] {
        [[-self.p[1], 1.0], [cj + self.p[0], -1.0]]
    }
}

impl Dae for Linear {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        if let Some(trouble) = self.trouble.filter(|_| t < 0.5 && self.p != LINEAR.p) {
            trouble()?;
        }
        r[0] = y[1] - self.p[1] * y[0];
        r[1] = yp[0] + self.p[0] * y[0] - y[1];
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let entries = self.entries(cj);
        (0..2).for_each(|i| (0..2).for_each(|j| jacobian[(i, j)] = entries[i][j]));
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        let entries = self.entries(cj);
        (0..2).for_each(|i| (0..2).for_each(|j| jacobian[(i, j)] = entries[i][j]));
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let [[a, b], [c, d]] = self.entries(cj);
        values.copy_from_slice(&[a, c, b, d]);
        Ok(())
    }

    fn adjoint_residual(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        lambda: &[f64],
        mu: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let by_state = self.p[0] * lambda[1] - self.p[1] * lambda[0];
        out.copy_from_slice(&[by_state + mu[1], lambda[0] - lambda[1]]);
        Ok(())
    }

    fn adjoint_parameters(
        &mut self,
        _t: f64,
        y: &[f64],
        _yp: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        out.copy_from_slice(&[y[0] * lambda[1], -y[0] * lambda[0]]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

/// y(T)^2 + z(T) + integral of z y.
fn square_and_more() -> impl Functional {
    By(
        |y: &[f64], slopes: &mut [f64]| {
            slopes.copy_from_slice(&[2.0 * y[0], 1.0]);
            y[0] * y[0] + y[1]
        },
        |y: &[f64], slopes: &mut [f64]| {
            slopes.copy_from_slice(&[y[1], y[0]]);
            y[0] * y[1]
        },
    )
}

/// The same in closed form, from y = 1.5.
fn closed_form([p0, p1]: [f64; 2], t: f64) -> Vec<f64> {
    let (y0, a) = (1.5, p1 - p0);
    let e = (a * t).exp();
    let integral = (e * e - 1.0) / (2.0 * a);
    let by_a = t * e * e / a - (e * e - 1.0) / (2.0 * a * a);
    let by_a = 2.0 * t * y0 * y0 * e * e + p1 * y0 * t * e + p1 * y0 * y0 * by_a;
    let value = y0 * y0 * e * e + p1 * y0 * e + p1 * y0 * y0 * integral;
    let by_y0 = 2.0 * y0 * e * e + p1 * e + 2.0 * p1 * y0 * integral;
    vec![value, -by_a, by_a + y0 * e + y0 * y0 * integral, by_y0, 0.0]
}

#[test]
fn a_linear_dae_in_closed_form() {
    let band = |jacobian| LinearSolver::Band { lower: 1, upper: 1, jacobian };
    let pattern = Pattern::from_entries(2, [(0, 1), (1, 0)]).unwrap();
    let klu = |jacobian| LinearSolver::Klu { pattern: pattern.clone(), jacobian };
    for jacobian in [Jacobian::Supplied, Jacobian::DifferenceQuotients] {
        for solver in [LinearSolver::Dense(jacobian), band(jacobian), klu(jacobian)] {
            let forward = IdaOptions::new(1e-9, 1e-11).newton(solver).differential([true, false]);
            for back in [
                AdjointOptions::new(1e-9, 1e-11),
                AdjointOptions::new(1e-9, 1e-11).checkpoint_steps(7),
                AdjointOptions::new(1e-9, 1e-11).gradient_tolerances(1e-9, [1e-11, 1e-10]),
            ] {
                let functional = square_and_more();
                let (y0, yp0) = ([1.5, 0.0], [0.0; 2]);
                let mut adjoint =
                    DaeAdjoint::new(LINEAR, functional, 0.0, &y0, &yp0, &forward, &back).unwrap();
                for (t, p) in [(1.2, LINEAR.p), (0.3, LINEAR.p), (1.2, [0.7, 1.0])] {
                    adjoint.system_mut().p = p;
                    let gradient = adjoint.gradient(t).unwrap();
                    let error = difference(&gradient, &closed_form(p, t));
                    println!("{error:e}");
                    assert!(error < 1e-7, "{gradient:?} {:?}", closed_form(p, t));
                    assert_eq!(adjoint.system().p, p, "put back to the last bit");
                    // Again: the same run, the same digits.
                    assert_eq!(adjoint.gradient(t).unwrap(), gradient);
                }
            }
        }
    }
}

/// Robertson's reactions with conservation in place of the third.
fn reactions() -> impl Dae {
    let residual = |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
        let (one, two, three) = (p[0] * y[0], p[1] * y[1] * y[2], p[2] * y[1] * y[1]);
        r[0] = yp[0] + one - two;
        r[1] = yp[1] - one + two + three;
        r[2] = y[0] + y[1] + y[2] - 1.0;
        // the integral, for forward sensitivities
        if let Some(integral) = r.get_mut(3) {
            *integral = yp[3] - y[2] - y[0] * y[0];
        }
        Ok(())
    };
    dae_with_parameters(residual, [0.04, 1e4, 3e7])
}

/// 1000 y_1(T) + y_2(T)^2 + integral of y_2 + y_0^2.
fn of_reactions() -> impl Functional {
    By(
        |y: &[f64], slopes: &mut [f64]| {
            slopes.copy_from_slice(&[0.0, 1e3, 2.0 * y[2]]);
            1e3 * y[1] + y[2] * y[2]
        },
        |y: &[f64], slopes: &mut [f64]| {
            slopes.copy_from_slice(&[2.0 * y[0], 0.0, 1.0]);
            y[2] + y[0] * y[0]
        },
    )
}

#[test]
fn robertson_agrees_with_the_ode_and_with_forward_sensitivities() {
    let atol = [1e-12, 1e-16, 1e-12];
    let (y0, yp0) = ([1.0, 0.0, 0.0], [-0.04, 0.04, 0.0]);
    let rates = with_parameters(
        |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
            ydot[0] = -p[0] * y[0] + p[1] * y[1] * y[2];
            ydot[2] = p[2] * y[1] * y[1];
            ydot[1] = -ydot[0] - ydot[2];
            Ok(())
        },
        [0.04, 1e4, 3e7],
    );
    let back = AdjointOptions::new(1e-8, 1e-9);
    let forward = CvodeOptions::new(1e-9, atol);
    let ode = Adjoint::new(rates, of_reactions(), 0.0, &y0, &forward, &back).unwrap();
    let ode = { ode }.gradient(40.0).unwrap();

    // sensitivities by differences, which have not the digits for smaller tolerances
    let options = IdaOptions::new(1e-6, [1e-10, 1e-14, 1e-10, 1e-8])
        .differential([true, true, false, true])
        .sensitivities(Sensitivities::of([0, 1, 2]));
    let mut ida = Ida::new(reactions(), 0.0, &[1.0, 0.0, 0.0, 0.0], &[0.0; 4], &options).unwrap();
    ida.consistent_start(InitialCondition::Algebraic, 40.0).unwrap();
    ida.solve_to(40.0).unwrap();
    let (y, s) = (ida.y(), ida.sensitivities());
    let slopes = [0, 1, 2].map(|j| 1e3 * s[(1, j)] + 2.0 * y[2] * s[(2, j)] + s[(3, j)]);

    let forward = IdaOptions::new(1e-9, atol).differential([true, true, false]);
    let adjoint = DaeAdjoint::new(reactions(), of_reactions(), 0.0, &y0, &yp0, &forward, &back);
    let dae = adjoint.unwrap().gradient(40.0).unwrap();
    let relative = |x: f64, exact: f64| (x / exact - 1.0).abs();
    let mut worst = [relative(dae.value, ode.value), 0.0, 0.0, 0.0];
    for (j, slope) in slopes.into_iter().enumerate() {
        worst[1] = relative(dae.parameters[j], ode.parameters[j]).max(worst[1]);
        worst[2] = relative(dae.parameters[j], slope).max(worst[2]);
    }
    // the third unknown follows from the other two
    for j in 0..2 {
        let exact = ode.initial_state[j] - ode.initial_state[2];
        let size = ode.initial_state[j];
        worst[3] = ((dae.initial_state[j] - exact) / size).abs().max(worst[3]);
    }
    println!("{worst:?}");
    let [value, by_p, by_sensitivities, by_y0] = worst;
    assert!(value.max(by_p).max(by_y0) < 2e-6 && by_sensitivities < 5e-6, "{dae:?} {ode:?}");
    assert_eq!(dae.initial_state[2], 0.0);
}

/// Unknowns (z, y, w, x), of which z and w are algebraic, in equations of which the first and the third are:
/// parameters also in dF/dy', and nonlinear.
fn mixed(_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]) -> Result<(), Failure> {
    r[0] = y[3] - y[2] - 0.3 * y[2].powi(3);
    r[1] = 2.0 * yp[1] + p[0] * yp[3] + p[1] * y[1] - y[0];
    r[2] = y[0] - p[2] * y[1].sin() - y[2];
    r[3] = yp[1] + 3.0 * yp[3] + y[3] + y[2] * y[0];
    // the integral, for differences
    if let Some(integral) = r.get_mut(4) {
        *integral = yp[4] - y[2] * y[2] - p[1] * y[1];
    }
    Ok(())
}

const OF_MIXED: [f64; 3] = [0.7, 1.3, -0.4];

/// z^2 + w x + p_2 at the end, and the integral of w^2 + p_1 y.
struct OfMixed;

impl Functional for OfMixed {
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            (slopes.y[2], slopes.y[1], slopes.p[1]) = (2.0 * y[2], p[1], y[1]);
        }
        Ok(y[2] * y[2] + p[1] * y[1])
    }

    fn terminal(
        &mut self,
        _t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            (slopes.y[0], slopes.y[2], slopes.y[3], slopes.p[2]) = (2.0 * y[0], y[3], y[2], 1.0);
        }
        Ok(y[0] * y[0] + y[2] * y[3] + p[2])
    }
}

/// The same with these parameters from these differential unknowns, y and x.
fn mixed_value([p0, p1, p2, y, x]: [f64; 5]) -> f64 {
    let options = IdaOptions::new(1e-11, 1e-13).differential([false, true, false, true, true]);
    let system = dae_with_parameters(mixed, [p0, p1, p2]);
    let mut ida = Ida::new(system, 0.0, &[0.0, y, 0.0, x, 0.0], &[0.0; 5], &options).unwrap();
    ida.consistent_start(InitialCondition::Algebraic, 2.0).unwrap();
    ida.solve_to(2.0).unwrap();
    let y = ida.y();
    y[0] * y[0] + y[2] * y[3] + p2 + y[4]
}

#[test]
fn rows_in_any_order_and_parameters_in_the_mass_matrix() {
    let at = [OF_MIXED[0], OF_MIXED[1], OF_MIXED[2], 1.2, -0.8];
    // differences of fourth order
    let by = |i: usize| {
        let moved = |step: f64| {
            let mut moved = at;
            moved[i] += step;
            mixed_value(moved)
        };
        let h = 2e-3;
        (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h)
    };
    let exact = [mixed_value(at), by(0), by(1), by(2), 0.0, by(3), 0.0, by(4)];
    let jacobian = Jacobian::DifferenceQuotients;
    let entries = [(0, 3), (1, 0), (1, 3), (2, 0), (2, 1), (3, 0), (3, 1), (3, 2), (0, 2)];
    let pattern = Pattern::from_entries(4, entries).unwrap();
    for solver in [
        LinearSolver::Dense(jacobian),
        LinearSolver::Band { lower: 3, upper: 3, jacobian },
        LinearSolver::Klu { pattern, jacobian },
    ] {
        let forward =
            IdaOptions::new(1e-9, 1e-11).newton(solver).differential([false, true, false, true]);
        let system = dae_with_parameters(mixed, OF_MIXED);
        let back = AdjointOptions::new(1e-9, 1e-11);
        let (y0, yp0) = ([0.0, 1.2, 0.0, -0.8], [0.0; 4]);
        let adjoint = DaeAdjoint::new(system, OfMixed, 0.0, &y0, &yp0, &forward, &back);
        let gradient = adjoint.unwrap().gradient(2.0).unwrap();
        let error = difference(&gradient, &exact);
        println!("{error:e}");
        assert!(error < 5e-8, "{gradient:?} {exact:?}");
    }
}

/// x'' = -9 x as a DAE F = y' - f with an algebraic copy of x: lambda of the differential unknowns along the backward run
/// is the slope of x(T) by the state there, in closed form.
#[test]
fn the_adjoint_along_the_way_in_closed_form() {
    let oscillator = |_t: f64, y: &[f64], yp: &[f64], r: &mut [f64]| {
        r.copy_from_slice(&[yp[0] - y[1], yp[1] + 9.0 * y[2], y[2] - y[0]]);
        Ok(())
    };
    let forward = IdaOptions::new(1e-9, 1e-11).differential([true, true, false]);
    let back = AdjointOptions::new(1e-9, 1e-11);
    let (y0, yp0) = ([1.0, 0.5, 0.0], [0.0; 3]);
    let made = DaeAdjoint::new(oscillator, End, 0.0, &y0, &yp0, &forward, &back);
    let times = [2.0, 1.4, 0.3, 0.0];
    let mut seen = Vec::new();
    let gradient = made
        .unwrap()
        .gradient_along(2.0, &times, |t, lambda| {
            let (sin, cos) = f64::sin_cos(3.0 * (2.0 - t));
            let error = f64::max((lambda[0] - cos).abs(), (lambda[1] - sin / 3.0).abs());
            println!("{error:e}");
            assert!(error < 1e-7, "{t}: {error:e}");
            seen.push(t);
        })
        .unwrap();
    assert_eq!(seen, times);
    assert!((gradient.initial_state[0] - 6f64.cos()).abs() < 1e-7);
}

/// A nonlinear rod whose rates are unknowns of their own, against the rod as an ODE.
#[test]
fn a_rod_with_its_rates_as_unknowns() {
    const N: usize = 30;
    fn rate(y: impl Fn(usize) -> f64, i: usize, p: &[f64]) -> f64 {
        let left = if i == 0 { 0.0 } else { y(i - 1) };
        let right = if i + 1 == N { 0.0 } else { y(i + 1) };
        p[0] * (left - 2.0 * y(i) + right) - p[1] * y(i).powi(3) + p[2]
    }
    let p = [200.0, 3.0, 0.5];
    let start = |i: usize| (i as f64 * 0.3).sin();
    let rates = with_parameters(
        |_t: f64, y: &[f64], p: &[f64], ydot: &mut [f64]| {
            (0..N).for_each(|i| ydot[i] = rate(|i| y[i], i, p));
            Ok(())
        },
        p,
    );
    let mean_square = |stride: usize| {
        move |y: &[f64], slopes: &mut [f64]| {
            (0..N).for_each(|i| slopes[stride * i] = 2.0 * y[stride * i] / N as f64);
            (0..N).map(|i| y[stride * i] * y[stride * i]).sum::<f64>() / N as f64
        }
    };
    let back = AdjointOptions::new(1e-8, 1e-10);
    let y0: Vec<f64> = (0..N).map(start).collect();
    let band = LinearSolver::Band { lower: 1, upper: 1, jacobian: Jacobian::DifferenceQuotients };
    let forward = CvodeOptions::new(1e-9, 1e-11).newton(band);
    let functional = By(mean_square(1), mean_square(1));
    let ode = Adjoint::new(rates, functional, 0.0, &y0, &forward, &back).unwrap();
    let ode = { ode }.gradient(0.3).unwrap();

    let residual = |_t: f64, y: &[f64], yp: &[f64], p: &[f64], r: &mut [f64]| {
        for i in 0..N {
            r[2 * i] = y[2 * i + 1] - rate(|i| y[2 * i], i, p);
            r[2 * i + 1] = yp[2 * i] - y[2 * i + 1];
        }
        Ok(())
    };
    let entries = (0..N).flat_map(|i| {
        let next = (i + 1).min(N - 1);
        [(2 * i, 2 * next), (2 * next, 2 * i), (2 * i, 2 * i + 1), (2 * i + 1, 2 * i)]
    });
    let pattern = Pattern::from_entries(2 * N, entries).unwrap();
    let klu = LinearSolver::Klu { pattern, jacobian: Jacobian::DifferenceQuotients };
    let forward = IdaOptions::new(1e-9, 1e-11)
        .newton(klu)
        .differential((0..2 * N).map(|i| i % 2 == 0).collect::<Vec<_>>());
    let start: Vec<f64> = (0..2 * N).map(|i| if i % 2 == 0 { start(i / 2) } else { 0.0 }).collect();
    let system = dae_with_parameters(residual, p);
    let functional = By(mean_square(2), mean_square(2));
    let yp0 = vec![0.0; 2 * N];
    let dae = DaeAdjoint::new(system, functional, 0.0, &start, &yp0, &forward, &back).unwrap();
    let dae = { dae }.gradient(0.3).unwrap();
    let mut exact = numbers(&ode)[..4].to_vec();
    exact.extend(ode.initial_state.iter().flat_map(|slope| [*slope, 0.0]));
    let error = difference(&dae, &exact);
    println!("{error:e}");
    assert!(error < 1e-7);
}

#[test]
fn a_mass_matrix_in_closed_form() {
    let rhs = with_parameters(
        |_t: f64, y: &[f64], p: &[f64], f: &mut [f64]| {
            f.copy_from_slice(&[-p[0] * y[0] + y[1], y[1] - p[1] * y[0]]);
            Ok(())
        },
        LINEAR.p,
    );
    let solver = LinearSolver::Dense(Jacobian::DifferenceQuotients);
    let mut system = MassForm::new(with_mass(rhs, [1.0, 0.0]), 2, &solver).unwrap();
    let differential = system.differential(0.0).unwrap();
    let forward = IdaOptions::new(1e-9, 1e-11).newton(solver).differential(differential);
    let (functional, back) = (square_and_more(), AdjointOptions::new(1e-9, 1e-11));
    let adjoint = DaeAdjoint::new(system, functional, 0.0, &[1.5, 0.0], &[0.0; 2], &forward, &back);
    let gradient = adjoint.unwrap().gradient(1.2).unwrap();
    let error = difference(&gradient, &closed_form(LINEAR.p, 1.2));
    println!("{error:e}");
    assert!(error < 1e-7);
}
