//! M y' = f(t, y): mass matrices of ARKODE, and singular ones through IDA.

use std::{f64::consts::PI, fmt::Debug};

use faer::{Mat, MatMut};
use pliant::{
    automatic::{Number, RightHandSide, automatic},
    ode::{
        BandMut, Borrowed, Dae, Failure, MassKind, MassMatrix, Ode, check, with_jacobian, with_mass,
    },
    rk::{self, DormandPrince},
    samples::Robertson,
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Cause, Cvode, CvodeOptions, Error, Ida, IdaOptions,
        Integrator, Jacobian, LinearSolver, MassForm, Pattern,
    },
};

const DENSE: LinearSolver = LinearSolver::Dense(Jacobian::Supplied);

/// Heat along a rod with cold ends, by n + 1 linear finite elements: M u' = -K u, both tridiagonal.
struct Rod {
    n: usize,
    pattern: Pattern,
}

impl Rod {
    fn new(n: usize) -> Self {
        let places = (0..n - 1).flat_map(|i| [(i, i + 1), (i + 1, i)]);
        Self { n, pattern: Pattern::from_entries(n, places).unwrap() }
    }

    /// Length of an element.
    fn h(&self) -> f64 {
        1.0 / (self.n + 1) as f64
    }

    /// The `mode`-th mode at its n nodes, and the rate at which it decays: the closed form of the discrete problem.
    fn mode(&self, mode: f64) -> (Vec<f64>, f64) {
        let angle = mode * PI * self.h();
        let shape = (1..=self.n).map(|i| (angle * i as f64).sin()).collect();
        (shape, 6.0 / self.h().powi(2) * (1.0 - angle.cos()) / (2.0 + angle.cos()))
    }

    /// Calls `put` with the entries of the matrix that has these values on and beside its diagonal.
    fn put(&self, diagonal: f64, beside: f64, mut put: impl FnMut(usize, usize, f64)) {
        for i in 0..self.n {
            put(i, i, diagonal);
            if i > 0 {
                put(i, i - 1, beside);
                put(i - 1, i, beside);
            }
        }
    }

    fn mass(&self, put: impl FnMut(usize, usize, f64)) {
        self.put(self.h() * 2.0 / 3.0, self.h() / 6.0, put);
    }

    fn stiffness(&self, put: impl FnMut(usize, usize, f64)) {
        self.put(-2.0 / self.h(), 1.0 / self.h(), put);
    }
}

impl Ode for Rod {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.fill(0.0);
        self.stiffness(|i, j, value| ydot[i] += value * y[j]);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        self.stiffness(|i, j, value| jacobian[(i, j)] = value);
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        self.stiffness(|i, j, value| jacobian[(i, j)] = value);
        Ok(())
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        self.stiffness(|i, j, value| values[self.pattern.position(i, j).unwrap()] = value);
        Ok(())
    }

    fn mass_kind(&self) -> MassKind {
        MassKind::Constant
    }

    fn dense_mass(&mut self, _t: f64, mut mass: MatMut<'_, f64>) -> Result<(), Failure> {
        self.mass(|i, j, value| mass[(i, j)] = value);
        Ok(())
    }

    fn banded_mass(&mut self, _t: f64, mut mass: BandMut<'_>) -> Result<(), Failure> {
        self.mass(|i, j, value| mass[(i, j)] = value);
        Ok(())
    }

    fn sparse_mass(&mut self, _t: f64, values: &mut [f64]) -> Result<(), Failure> {
        self.mass(|i, j, value| values[self.pattern.position(i, j).unwrap()] = value);
        Ok(())
    }
}

/// The linear solvers that a mass matrix can have the form of.
fn solvers(pattern: &Pattern, half: usize) -> [LinearSolver; 5] {
    let band = |jacobian| LinearSolver::Band { lower: half, upper: half, jacobian };
    [
        DENSE,
        LinearSolver::Dense(Jacobian::DifferenceQuotients),
        band(Jacobian::Supplied),
        band(Jacobian::DifferenceQuotients),
        LinearSolver::Klu { pattern: pattern.clone(), jacobian: Jacobian::Supplied },
    ]
}

#[test]
fn a_rod_of_finite_elements_cools_as_its_closed_form() {
    let rod = || Rod::new(12);
    let (y0, rate) = rod().mode(3.0);
    let end = 0.02;
    let error = |y: &[f64]| {
        let exact = y0.iter().map(|y0| y0 * (-rate * end).exp());
        y.iter().zip(exact).map(|(y, exact)| (y - exact).abs()).fold(0.0, f64::max)
    };
    let explicit = ButcherTable::explicit(5).unwrap();
    for solver in solvers(&rod().pattern, 1) {
        let options = ArkodeOptions::new(1e-8, 1e-11).newton(solver.clone());
        for options in [options.clone(), options.table(explicit)] {
            let mut arkode = Arkode::new(rod(), 0.0, &y0, &options).unwrap();
            arkode.solve_to(end).unwrap();
            let steps = arkode.statistics().steps;
            println!("ARKODE, {solver:?}: {:.1e} in {steps} steps", error(arkode.y()));
            assert!(error(arkode.y()) < 1e-7, "{}", error(arkode.y()));
        }
        let yp0: Vec<f64> = y0.iter().map(|y0| -rate * y0).collect();
        let options = IdaOptions::new(1e-8, 1e-11).newton(solver.clone());
        let system = MassForm::new(rod(), y0.len(), &solver).unwrap();
        let mut ida = Ida::new(system, 0.0, &y0, &yp0, &options).unwrap();
        ida.solve_to(end).unwrap();
        let statistics = ida.statistics();
        println!("IDA, {solver:?}: {:.1e} in {} steps", error(ida.y()), statistics.steps);
        assert!(error(ida.y()) < 2e-8, "{}", error(ida.y()));
        // a Jacobian with an error of its own would not converge in so few iterations
        assert!(statistics.nonlinear_failures == 0);
    }
}

/// M(t) (y - e)' = -20 (y - e) for e = (cos t, sin t): y = e.
struct Heavy(MassKind);

fn exact(t: f64) -> [f64; 2] {
    [t.cos(), t.sin()]
}

impl Heavy {
    fn mass(&self, t: f64) -> [[f64; 2]; 2] {
        let t = if self.0 == MassKind::TimeDependent { t } else { 0.0 };
        [[3.0 + (3.0 * t).sin(), 0.5], [1.0 - t, 2.0]]
    }
}

impl Ode for Heavy {
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let ([c, s], mass) = (exact(t), self.mass(t));
        for (i, ydot) in ydot.iter_mut().enumerate() {
            let off = y[i] - [c, s][i];
            *ydot = mass[i][0] * -s + mass[i][1] * c - 20.0 * (off + off * off);
        }
        Ok(())
    }

    fn mass_kind(&self) -> MassKind {
        self.0
    }

    fn dense_mass(&mut self, t: f64, mut matrix: MatMut<'_, f64>) -> Result<(), Failure> {
        let mass = self.mass(t);
        (0..2).for_each(|i| (0..2).for_each(|j| matrix[(i, j)] = mass[i][j]));
        Ok(())
    }
}

#[test]
fn methods_keep_their_orders_with_a_mass_matrix() {
    let implicit = [2, 3, 4, 5].map(|order| ButcherTable::implicit(order).unwrap());
    let explicit = [2, 4].map(|order| ButcherTable::explicit(order).unwrap());
    for kind in [MassKind::Constant, MassKind::TimeDependent] {
        for table in implicit.into_iter().chain(explicit) {
            let error = |steps: u32| {
                let options = ArkodeOptions::new(1e-12, 1e-12)
                    .table(table)
                    .fixed_step(1.0 / f64::from(steps))
                    .convergence_coefficient(1e-3)
                    .max_steps_between_setups(1)
                    .max_steps_between_jacobians(1)
                    .max_iterations(20);
                let mut solver = Arkode::new(Heavy(kind), 0.0, &exact(0.0), &options).unwrap();
                for _ in 0..steps {
                    solver.step(2.0).unwrap();
                }
                let exact = exact(solver.t());
                solver.y().iter().zip(exact).map(|(y, e)| (y - e).abs()).fold(0.0, f64::max)
            };
            let steps = if table.is_implicit() && table.order() > 3 { 30 } else { 100 };
            let (few, many) = (error(steps), error(2 * steps));
            let order = (few / many).log2();
            println!("{kind:?}, {table}: {few:.1e}, {many:.1e}, order {order:.2}");
            assert!((order - f64::from(table.order())).abs() < 0.15);
        }
        let solver = LinearSolver::Dense(Jacobian::DifferenceQuotients);
        let system = MassForm::new(Heavy(kind), 2, &solver).unwrap();
        let options = IdaOptions::new(1e-8, 1e-10);
        let mut ida = Ida::new(system, 0.0, &exact(0.0), &[0.0, 1.0], &options).unwrap();
        ida.solve_to(1.0).unwrap();
        let error = (ida.y()[0] - 1f64.cos()).hypot(ida.y()[1] - 1f64.sin());
        println!("{kind:?}, IDA: {error:.1e}");
        assert!(error < 5e-8);
    }
}

/// The equations of the sample with the sum of all three in place of the last: M = diag(1, 1, 0).
#[test]
fn robertson_with_a_singular_mass_matrix() {
    let sum = |_t: f64, y: &[f64], f: &mut [f64]| {
        Robertson::new().rhs(0.0, y, f)?;
        f[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    };
    let jacobian = |_t: f64, y: &[f64], f: &[f64], mut jacobian: MatMut<'_, f64>| {
        Ode::dense_jacobian(&mut Robertson::new(), 0.0, y, f, jacobian.as_mut())?;
        (0..3).for_each(|j| jacobian[(2, j)] = 1.0);
        Ok(())
    };
    let system = with_mass(with_jacobian(sum, jacobian), [1.0, 1.0, 0.0]);
    let mut system = MassForm::new(system, 3, &DENSE).unwrap();
    assert_eq!(system.differential(0.0).unwrap(), Robertson::DIFFERENTIAL);
    let options = IdaOptions::new(1e-8, [1e-14, 1e-19, 1e-10]).newton(DENSE);
    let mut ida = Ida::new(system, 0.0, &Robertson::Y0, &Robertson::YP0, &options).unwrap();
    ida.solve_to(Robertson::REFERENCE.t).unwrap();
    let error = Robertson::REFERENCE.error(ida.y());
    println!("error {error:.1e}, {} steps", ida.statistics().steps);
    // as the DAE of the sample
    assert!(error < 1e-5);
}

/// V = sin t over a resistor to node 1, a capacitor from there to node 2, a resistor to earth:
/// M = C [1 -1; -1 1]. By hand: w = u1 - u2 and the current i = C w' = (V - w) / (R1 + R2).
#[test]
fn a_circuit_whose_mass_matrix_is_singular_and_not_diagonal() {
    let [c, r1, r2] = [1e-3, 50.0, 200.0];
    let circuit = move |t: f64, u: &[f64], f: &mut [f64]| {
        f[0] = (t.sin() - u[0]) / r1;
        f[1] = -u[1] / r2;
        Ok(())
    };
    let tau = c * (r1 + r2);
    let exact = |t: f64| {
        let w = (t.sin() - tau * (t.cos() - (-t / tau).exp())) / (1.0 + tau * tau);
        let i = (t.sin() - w) / (r1 + r2);
        [t.sin() - r1 * i, r2 * i]
    };
    let pattern = Pattern::from_entries(2, [(0, 1), (1, 0)]).unwrap();
    let entries = [(0, 0, c), (0, 1, -c), (1, 0, -c), (1, 1, c)];
    let values = pattern.values(entries).unwrap();
    let dense = Mat::from_fn(2, 2, |i, j| if i == j { c } else { -c });
    let sparse_jacobian = |_t: f64, _u: &[f64], _f: &[f64], values: &mut [f64]| {
        values.copy_from_slice(&[-1.0 / 50.0, 0.0, 0.0, -1.0 / 200.0]);
        Ok(())
    };
    // both nodes follow the source at first, as the capacitor is empty
    let slope = r2 / (r1 + r2);
    let error = |system: MassForm<_>, options: &IdaOptions| {
        let mut ida = Ida::new(system, 0.0, &[0.0; 2], &[slope; 2], options).unwrap();
        ida.solve_to(2.0).unwrap();
        let exact = exact(2.0);
        let error = (ida.y()[0] - exact[0]).hypot(ida.y()[1] - exact[1]);
        println!("{error:.1e} in {} steps", ida.statistics().steps);
        error
    };
    let quotients = LinearSolver::Dense(Jacobian::DifferenceQuotients);
    let mut with_dense = with_mass(circuit, dense);
    let system: Borrowed<'_, dyn Ode> = Borrowed(&mut with_dense);
    let mut system = MassForm::new(system, 2, &quotients).unwrap();
    assert_eq!(system.differential(0.0).unwrap(), [true; 2]);
    let options = IdaOptions::new(1e-8, 1e-10);
    assert!(error(system, &options) < 1e-9);

    let klu = LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied };
    let system = pliant::ode::with_sparse_jacobian(circuit, sparse_jacobian);
    let mut with_sparse = with_mass(system, MassMatrix::Sparse(values));
    let system: Borrowed<'_, dyn Ode> = Borrowed(&mut with_sparse);
    let system = MassForm::new(system, 2, &klu).unwrap();
    assert!(error(system, &options.newton(klu)) < 1e-9);
}

fn decay(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot.copy_from_slice(y);
    ydot.iter_mut().for_each(|f| *f = -*f);
    Ok(())
}

#[test]
fn unusable_mass_matrices_are_named() {
    fn refused<T: Debug>(result: Result<T, Error>) -> String {
        let Err(Error::Input(error)) = result else { panic!("{result:?} is not an input error") };
        println!("{error}");
        error.input
    }
    let y0 = [1.0, 2.0];
    let system = || with_mass(decay, [1.0, 2.0]);
    let cvode = Cvode::new(system(), 0.0, &y0, &CvodeOptions::new(1e-6, 1e-9));
    assert_eq!(refused(cvode), "mass matrix");
    let explicit = DormandPrince::new(system(), 0.0, &y0, &rk::Options::new(1e-6, 1e-9));
    assert_eq!(refused(explicit.map(|_| ())), "mass matrix");
    let good = ArkodeOptions::new(1e-6, 1e-9);
    let arkode = |options: ArkodeOptions| Arkode::new(system(), 0.0, &y0, &options);
    assert_eq!(refused(arkode(good.clone().fixed_point(0))), "nonlinear solver");
    assert_eq!(refused(arkode(good.clone().newton(LinearSolver::Custom))), "linear solver");
    let form = MassForm::new(system(), 2, &LinearSolver::Custom);
    assert_eq!(refused(form.map(|_| ())), "linear solver");
    assert_eq!(refused(MassForm::new(decay, 2, &DENSE).map(|_| ())), "mass matrix");
    let form = MassForm::new(with_mass(decay, [1.0; 3]), 2, &DENSE);
    assert_eq!(refused(form.unwrap().differential(0.0)), "mass matrix");
    let pattern = Pattern::from_entries(2, []).unwrap();
    assert_eq!(refused(pattern.values([(0, 1, 1.0)]).map_err(Error::from)), "entry");

    let stopped = |mass: MassMatrix, options: &ArkodeOptions| {
        let mut solver = Arkode::new(with_mass(decay, mass), 0.0, &y0, options).unwrap();
        match solver.solve_to(1.0) {
            Err(Error::Integration(error)) => {
                println!("{error}");
                let source = error.source.map(|source| source.to_string());
                (error.cause, source.unwrap_or_default())
            }
            other => panic!("{other:?} is not an integration error"),
        }
    };
    let explicit = good.clone().table(ButcherTable::explicit(4).unwrap());
    let band = LinearSolver::Band { lower: 0, upper: 0, jacobian: Jacobian::DifferenceQuotients };
    for options in [good.clone(), explicit.clone(), good.clone().newton(band.clone())] {
        assert_eq!(stopped([1.0, 0.0].into(), &options).0, Cause::MassMatrix);
        let (cause, source) = stopped([1.0].into(), &options);
        assert_eq!(cause, Cause::Fatal(pliant::sundials::Callback::Mass));
        assert!(source.contains("1 numbers on its diagonal, where 2"), "{source}");
    }
    let klu = explicit.clone().newton(LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied });
    assert_eq!(stopped(MassMatrix::Sparse(vec![1.0, 0.0]), &klu).0, Cause::MassMatrix);
    assert!(
        stopped([1.0; 2].into(), &klu).1.contains("is sparse, but the mass matrix is a diagonal")
    );
    let dense = Mat::<f64>::identity(2, 2);
    assert!(stopped(dense.into(), &good.newton(band)).1.contains("of band form"));
}

/// A mass matrix that has changed is asked for again by a new start.
#[test]
fn a_new_start_takes_the_mass_matrix_anew() {
    let y0 = [1.0, 2.0];
    let options = ArkodeOptions::new(1e-9, 1e-12);
    let mut solver = Arkode::new(with_mass(decay, [1.0, 2.0]), 0.0, &y0, &options).unwrap();
    solver.solve_to(1.0).unwrap();
    *solver.system_mut() = with_mass(decay, [4.0, 2.0]);
    solver.reinit(0.0, &y0).unwrap();
    solver.solve_to(1.0).unwrap();
    let exact = [(-0.25f64).exp(), 2.0 * (-0.5f64).exp()];
    let error = (solver.y()[0] - exact[0]).hypot(solver.y()[1] - exact[1]);
    println!("{error:.1e}");
    assert!(error < 1e-7);
}

/// Two equations, written over a number type.
struct Coupled;

impl RightHandSide for Coupled {
    fn rhs<T: Number>(&mut self, t: f64, y: &[T], p: &[T], f: &mut [T]) -> Result<(), Failure> {
        f[0] = y[1] * y[1] - p[0] * y[0] * t;
        f[1] = y[1] - p[1] * y[0] * y[0];
        Ok(())
    }
}

/// Jacobians, products and derivatives by parameters of M y' - f, for a matrix M that is singular and not symmetric, against differences and against
/// each other.
#[test]
fn derivatives_pass_through_a_mass_matrix() {
    let mass = Mat::from_fn(2, 2, |i, j| [[1.0, 0.5], [0.0, 0.0]][i][j]);
    let system = with_mass(automatic(Coupled, [2.0, 0.5]), mass);
    let mut system = MassForm::new(system, 2, &DENSE).unwrap();
    let (t, cj, y, yp) = (0.7, 3.0, [1.2, -0.4], [0.3, 2.0]);
    let (v, w) = ([0.6, -1.3], [-0.8, 0.5]);
    check::dae_jacobian(&mut system, t, cj, &y, &yp, check::Storage::Dense).unwrap();
    check::sensitivity_residual(&mut system, t, (&y, &yp), (&v, &w)).unwrap();
    check::adjoint_residual(&mut system, t, (&y, &yp), (&v, &w)).unwrap();
    check::dae_adjoint_parameters(&mut system, t, (&y, &yp), &v).unwrap();
    let (mut matrix, mut product) = (Mat::zeros(2, 2), [0.0; 2]);
    system.dense_jacobian(t, cj, &y, &yp, matrix.as_mut()).unwrap();
    system.jacobian_times(t, cj, &y, &yp, &v, &mut product).unwrap();
    for i in 0..2 {
        let expected = matrix[(i, 0)] * v[0] + matrix[(i, 1)] * v[1];
        assert!((product[i] - expected).abs() < 1e-14);
    }
}
