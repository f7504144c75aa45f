//! Systems that add to their outputs, which every integrator has to hand over as zeros: against closed forms.
//!
//! `lifecycle` runs them under valgrind, too.

use faer::MatMut;
use pliant::{
    central_difference::{self, CentralDifference},
    ode::{Dae, Failure, Kick, Ode, Rates, SecondOrder, check, with_mass},
    rk::{self, DormandPrince},
    rosenbrock::{self, Rosenbrock},
    solve::{Event, Method, Options, Problem, gradient, solve},
    sundials::{
        Adjoint, AdjointOptions, Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions,
        DaeAdjoint, Gradient, Ida, IdaOptions, InitialCondition, Integrator, Jacobian, Krylov,
        KrylovMethod, LinearSolver, MassForm, Multistep, Pattern, Sensitivities, SensitivitySource,
    },
};

use crate::support::End;

/// y0' = -a y0, y1' = a y0 - b y1, with all that a system can supply; nothing is written but added.
#[derive(Clone)]
struct Decays {
    p: [f64; 2],
    /// Whether the second equation is the explicit part.
    is_split: bool,
    roots: usize,
    /// That of the last `newton_setup`.
    gamma: f64,
}

const START: [f64; 2] = [1.0, 0.0];
const RATES: [f64; 2] = [2.0, 0.5];

fn decays() -> Decays {
    Decays { p: RATES, is_split: false, roots: 1, gamma: 0.0 }
}

/// Without the root function.
fn without_roots() -> Decays {
    Decays { roots: 0, ..decays() }
}

/// Both numbers at time `t`, what they change by with a and with b, and the integral of the first.
fn exact(t: f64) -> ([f64; 2], [[f64; 2]; 2], f64) {
    let [a, b] = RATES;
    let (fast, slow, gap) = ((-a * t).exp(), (-b * t).exp(), a - b);
    let y = [fast, a / gap * (slow - fast)];
    let by_a = [-t * fast, (-b / gap * (slow - fast) + a * t * fast) / gap];
    let by_b = [0.0, (a / gap * (slow - fast) - a * t * slow) / gap];
    (y, [by_a, by_b], (1.0 - fast) / a)
}

/// What small numbers of the call before would hide: outputs are zero on entry.
fn check_cleared(out: &[f64]) {
    assert!(out.iter().all(|x| *x == 0.0), "{out:?}");
}

fn add(out: &mut [f64], values: [f64; 2]) -> Result<(), Failure> {
    out.iter_mut().zip(values).for_each(|(out, value)| *out += value);
    Ok(())
}

impl Ode for Decays {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        check_cleared(ydot);
        let [a, b] = self.p;
        let second = if self.is_split { 0.0 } else { a * y[0] - b * y[1] };
        add(ydot, [-a * y[0], second])
    }

    fn is_split(&self) -> bool {
        self.is_split
    }

    fn explicit_rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        check_cleared(ydot);
        add(ydot, [0.0, self.p[0] * y[0] - self.p[1] * y[1]])
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        _y: &[f64],
        _ydot: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.rhs(t, v, jv)
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let [a, b] = self.p;
        jacobian[(0, 0)] += -a;
        jacobian[(1, 0)] += a;
        jacobian[(1, 1)] += -b;
        Ok(())
    }

    fn newton_setup(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        gamma: f64,
        _reuse: bool,
    ) -> Result<bool, Failure> {
        self.gamma = gamma;
        Ok(true)
    }

    fn newton_solve(&mut self, _gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        let ([a, b], gamma) = (self.p, self.gamma);
        r[0] /= 1.0 + gamma * a;
        r[1] = (r[1] + gamma * a * r[0]) / (1.0 + gamma * b);
        Ok(())
    }

    fn root_count(&self) -> usize {
        self.roots
    }

    fn roots(&mut self, _t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        check_cleared(g);
        g[0] += y[0] - 0.5;
        Ok(())
    }

    fn quadrature_count(&self) -> usize {
        1
    }

    fn quadratures(&mut self, _t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        check_cleared(qdot);
        qdot[0] += y[0];
        Ok(())
    }

    fn sensitivity_rhs(
        &mut self,
        t: f64,
        y: &[f64],
        _ydot: &[f64],
        parameter: usize,
        s: &[f64],
        sdot: &mut [f64],
    ) -> Result<(), Failure> {
        self.rhs(t, s, sdot)?;
        add(sdot, [[-y[0], y[0]], [0.0, -y[1]]][parameter])
    }

    fn adjoint_rhs(
        &mut self,
        _t: f64,
        _y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        check_cleared(out);
        let [a, b] = self.p;
        add(out, [a * (lambda[1] - lambda[0]), -b * lambda[1]])
    }

    fn adjoint_parameters(
        &mut self,
        _t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        check_cleared(out);
        add(out, [y[0] * (lambda[1] - lambda[0]), -y[1] * lambda[1]])
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

/// The same as F(t, y, y') = f(t, y) - y' = 0.
impl Dae for Decays {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.rhs(t, y, residual)?;
        add(residual, [-yp[0], -yp[1]])
    }

    fn jacobian_times(
        &mut self,
        t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        self.rhs(t, v, jv)?;
        add(jv, [-cj * v[0], -cj * v[1]])
    }

    fn root_count(&self) -> usize {
        self.roots
    }

    fn roots(&mut self, t: f64, y: &[f64], _yp: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        Ode::roots(self, t, y, g)
    }

    fn quadrature_count(&self) -> usize {
        1
    }

    fn quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        Ode::quadratures(self, t, y, qdot)
    }

    fn sensitivity_residual(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        parameter: usize,
        s: &[f64],
        sp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        self.sensitivity_rhs(t, y, &[], parameter, s, residual)?;
        add(residual, [-sp[0], -sp[1]])
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

/// Errors of a run at rtol 1e-8 are up to 4e-7 here, those of integrals and sensitivities alike.
const TOLERANCE: f64 = 2e-6;

fn close(what: &str, numbers: &[f64], expected: &[f64]) {
    assert_eq!(numbers.len(), expected.len(), "{what}");
    for (number, expected) in numbers.iter().zip(expected) {
        assert!((number - expected).abs() < TOLERANCE, "{what}: {number} for {expected}");
    }
}

/// The root at y0 = 1/2, and the end.
fn run(what: &str, solver: &mut impl Integrator) {
    let half = 2f64.ln() / RATES[0];
    solver.solve_to(1.5).unwrap();
    close(what, &[solver.t()], &[half]);
    close(what, solver.y(), &exact(half).0);
    solver.solve_to(1.5).unwrap();
    close(what, solver.y(), &exact(1.5).0);
}

fn linear_solvers() -> Vec<LinearSolver> {
    let pattern = || Pattern::from_entries(2, [(0, 0), (1, 0), (1, 1)]).unwrap();
    let jacobian = Jacobian::DifferenceQuotients;
    let krylov = || Krylov::new(KrylovMethod::Gmres { dimension: 2, restarts: 1 });
    vec![
        LinearSolver::Dense(jacobian),
        LinearSolver::Band { lower: 1, upper: 0, jacobian },
        LinearSolver::Klu { pattern: pattern(), jacobian },
        LinearSolver::Krylov(krylov()),
        LinearSolver::Krylov(krylov().products(Jacobian::Supplied)),
    ]
}

fn sensitivities() -> [Sensitivities; 3] {
    let both = || Sensitivities::of([0, 1]);
    [
        both(),
        both().source(SensitivitySource::ForwardDifferences),
        both().source(SensitivitySource::Supplied),
    ]
}

fn check_sensitivities(what: &str, s: faer::MatRef<'_, f64>) {
    let (_, [by_a, by_b], _) = exact(1.5);
    let columns: Vec<f64> = s.col_iter().flat_map(|column| column.iter().copied()).collect();
    close(what, &columns, &[by_a, by_b].concat());
}

fn check_gradient(what: &str, found: &Gradient) {
    let (y, [by_a, by_b], _) = exact(1.5);
    close(what, &[found.value], &y[..1]);
    close(what, &found.parameters, &[by_a[0], by_b[0]]);
    close(what, &found.initial_state, &[y[0], 0.0]);
}

fn cvode() {
    let options = || CvodeOptions::new(1e-8, 1e-10);
    for solver in linear_solvers() {
        let what = format!("CVODE, {solver:?}");
        let mut solver = Cvode::new(decays(), 0.0, &START, &options().newton(solver)).unwrap();
        run(&what, &mut solver);
        close(&what, solver.quadratures(), &[exact(1.5).2]);
    }
    let own = options().newton(LinearSolver::Custom);
    run("CVODE, its own solver", &mut Cvode::new(decays(), 0.0, &START, &own).unwrap());
    let adams = options().method(Multistep::Adams).fixed_point(2);
    run("Adams", &mut Cvode::new(decays(), 0.0, &START, &adams).unwrap());
    for choice in sensitivities() {
        let what = format!("CVODES, {choice:?}");
        let options = options().sensitivities(choice);
        let mut solver = Cvode::new(decays(), 0.0, &START, &options).unwrap();
        run(&what, &mut solver);
        check_sensitivities(&what, solver.sensitivities());
    }
    let back = || AdjointOptions::new(1e-8, 1e-10);
    let supplied = back().supplied_rhs().supplied_parameters();
    for (jacobian, back) in [
        (Jacobian::Supplied, back()),
        (Jacobian::DifferenceQuotients, back()),
        (Jacobian::Supplied, supplied),
    ] {
        let forward = options().newton(LinearSolver::Dense(jacobian));
        let adjoint = Adjoint::new(without_roots(), End, 0.0, &START, &forward, &back);
        check_gradient("adjoint", &adjoint.unwrap().gradient(1.5).unwrap());
    }
}

fn arkode() {
    for table in [ButcherTable::implicit(4), ButcherTable::explicit(4)] {
        let options = ArkodeOptions::new(1e-8, 1e-10).table(table.unwrap());
        run("ARKODE", &mut Arkode::new(decays(), 0.0, &START, &options).unwrap());
    }
    let table = ButcherTable::implicit(4).unwrap();
    let own = ArkodeOptions::new(1e-8, 1e-10).table(table).newton(LinearSolver::Custom);
    run("ARKODE, its own solver", &mut Arkode::new(decays(), 0.0, &START, &own).unwrap());
    let options = ArkodeOptions::new(1e-8, 1e-10).table(ButcherTable::imex(4).unwrap());
    let split = Decays { is_split: true, ..decays() };
    run("ImEx", &mut Arkode::new(split, 0.0, &START, &options).unwrap());
}

fn ida() {
    let options = || IdaOptions::new(1e-8, 1e-10).differential([true, true]);
    for solver in linear_solvers() {
        let what = format!("IDA, {solver:?}");
        let options = options().newton(solver.clone());
        let mut dae = Ida::new(decays(), 0.0, &START, &[0.0; 2], &options).unwrap();
        dae.consistent_start(InitialCondition::Algebraic, 1.5).unwrap();
        close(&what, dae.yp(), &[-RATES[0], RATES[0]]);
        dae.check_index().unwrap();
        run(&what, &mut dae);
        close(&what, dae.quadratures(), &[exact(1.5).2]);
        if matches!(solver, LinearSolver::Dense(_) | LinearSolver::Band { .. }) {
            let system = with_mass(decays(), [1.0, 1.0]);
            let form = MassForm::new(system, 2, &solver).unwrap();
            let slope = [-RATES[0], RATES[0]];
            run("mass form", &mut Ida::new(form, 0.0, &START, &slope, &options).unwrap());
        }
    }
    for choice in sensitivities() {
        let what = format!("IDAS, {choice:?}");
        let options = options().sensitivities(choice);
        let mut solver = Ida::new(decays(), 0.0, &START, &[0.0; 2], &options).unwrap();
        solver.consistent_start(InitialCondition::Algebraic, 1.5).unwrap();
        run(&what, &mut solver);
        check_sensitivities(&what, solver.sensitivities());
    }
    let (back, slope) = (AdjointOptions::new(1e-8, 1e-10), [-RATES[0], RATES[0]]);
    let mut adjoint =
        DaeAdjoint::new(without_roots(), End, 0.0, &START, &slope, &options(), &back).unwrap();
    check_gradient("adjoint of a DAE", &adjoint.gradient(1.5).unwrap());
}

/// The methods of this crate.
fn own_methods() {
    let options = rk::Options::new(1e-8, 1e-10);
    run("Dormand-Prince", &mut DormandPrince::new(decays(), 0.0, &START, &options).unwrap());
    let options = rosenbrock::Options::new(1e-8, 1e-10);
    run("Rosenbrock", &mut Rosenbrock::new(decays(), 0.0, &START, &options).unwrap());
    let own = options.newton(LinearSolver::Custom);
    run("Rosenbrock, its own solver", &mut Rosenbrock::new(decays(), 0.0, &START, &own).unwrap());

    let options = central_difference::Options::new(1e-6, 1e-9).max_step(1e-3);
    let mut solver = CentralDifference::new(Spring, 0.0, &[1.0, 0.0, 0.0], &options).unwrap();
    solver.solve_to(1.0).unwrap();
    // of order 2: half a step squared
    let expected = [1f64.cos(), -1f64.sin(), 0.5 - 2f64.sin() / 4.0];
    close("central differences", solver.y(), &expected);
}

/// u'' = -u, and the integral of u'^2.
struct Spring;

impl SecondOrder for Spring {
    fn forces(&mut self, _t: f64, u: &[f64], _v: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        check_cleared(f);
        f[0] += -u[0];
        Ok(())
    }

    fn accelerations(&mut self, kick: &Kick<'_>, a: &mut [f64]) {
        check_cleared(a);
        a[0] += kick.force[0];
    }

    fn rates(&mut self, _t: f64, _u: &[f64], _v: &[f64]) -> Rates {
        Rates { frequency: 1.0, decay: 0.0 }
    }

    fn integrals(&self) -> usize {
        1
    }

    fn powers(&self, v: &[f64], powers: &mut [f64]) {
        check_cleared(powers);
        powers[0] += v[0] * v[0];
    }
}

/// What asks the equations before a run, and around jumps.
fn questions() {
    let (t, y, v) = (0.3, [0.7, 0.4], [0.2, -0.1]);
    let mut system = decays();
    let found = Pattern::ode_by_nan(&mut system, t, &y).unwrap();
    assert_eq!(found.entry_count(), 3);
    let by_sampling = Pattern::ode_by_sampling(&mut system, t, &y, &[0.1; 2], 3).unwrap();
    assert_eq!(by_sampling.entry_count(), 3);
    check::jacobian(&mut system, t, &y, check::Storage::Dense).unwrap();
    check::sensitivity_rhs(&mut system, t, &y, &v).unwrap();
    check::sensitivity_residual(&mut system, t, (&y, &v), (&v, &y)).unwrap();
    check::adjoint_rhs(&mut system, t, &y, &v).unwrap();
    check::adjoint_parameters(&mut system, t, &y, &v).unwrap();

    let jump = || Event::new(|_, y| y[0] - 0.5).action(|jump| jump.y[1] += 1.0);
    let options = Options::new(1e-8, 1e-10);
    let with_sensitivities = options.clone().sensitivities(Sensitivities::of([0, 1]));
    let problem = Problem::ode(without_roots(), START).event(jump());
    let solution = solve(problem, Method::Bdf, (0.0, 1.5), &with_sensitivities).unwrap();
    let forward = solution.sensitivities(solution.t().len() - 1);
    let problem = Problem::ode(without_roots(), START).event(jump());
    let back = AdjointOptions::new(1e-8, 1e-10);
    let backward = gradient(problem, End, Method::Bdf, (0.0, 1.5), &options, &back).unwrap();
    close("around a jump", &backward.parameters, &[forward[(0, 0)], forward[(0, 1)]]);
    check_gradient("gradient across a jump", &backward);
}

/// Every way in which a system is called.
pub fn every_call() {
    cvode();
    arkode();
    ida();
    own_methods();
    questions();
}

#[test]
fn systems_may_add_to_their_outputs() {
    every_call();
}
