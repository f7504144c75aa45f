//! Thousands of solvers at once, made, moved and dropped by many threads: no solver knows of another.

use std::{collections::VecDeque, sync::Mutex, thread};

use pliant::{
    integrate::Integrator,
    ode::Failure,
    rk::{self, DormandPrince},
    samples::Robertson,
    sundials::{
        Arkode, ArkodeOptions, ButcherTable, Cvode, CvodeOptions, Ida, IdaOptions, Jacobian,
        LinearSolver, Sign,
    },
};

const SOLVERS: usize = 4000;
const THREADS: usize = 8;
const STEPS: usize = 12;

type Solver = Box<dyn Integrator<System = Robertson> + Send>;

/// The solver of number k: four integrators in turn, each with tolerances of its own, so that no two have the same answers.
fn solver(k: usize) -> Solver {
    let (rtol, atol) = (1e-4 * (1.0 + k as f64 / SOLVERS as f64), [1e-8, 1e-14, 1e-6]);
    let (system, y0) = (Robertson::new(), &Robertson::Y0);
    let klu = || LinearSolver::Klu {
        pattern: Robertson::new().pattern().clone(),
        jacobian: Jacobian::Supplied,
    };
    let signs = [Sign::NonNegative; 3];
    match k % 5 {
        0 => {
            let options = CvodeOptions::new(rtol, atol).newton(klu()).sign_constraints(signs);
            Box::new(Cvode::new(system, 0.0, y0, &options).unwrap())
        }
        1 => Box::new(Cvode::new(system, 0.0, y0, &CvodeOptions::new(rtol, atol)).unwrap()),
        2 => {
            let table = ButcherTable::implicit(3).unwrap();
            let options = ArkodeOptions::new(rtol, atol).table(table).newton(klu());
            Box::new(Arkode::new(system, 0.0, y0, &options).unwrap())
        }
        3 => {
            let options = IdaOptions::new(rtol, atol).sign_constraints(signs);
            Box::new(Ida::new(system, 0.0, y0, &Robertson::YP0, &options).unwrap())
        }
        _ => {
            let options = rk::Options::new(rtol, atol);
            Box::new(DormandPrince::new(system, 0.0, y0, &options).unwrap())
        }
    }
}

/// One step; some calls are refused on the way, and some solvers start anew.
fn step(solver: &mut Solver, k: usize, count: usize) {
    if (k + count).is_multiple_of(11) {
        solver.solve_to(f64::NAN).unwrap_err();
    }
    if count == 6 && k.is_multiple_of(7) {
        solver.reinit(0.0, &Robertson::Y0).unwrap();
    }
    solver.step(40.0).unwrap();
}

/// How many steps solver k makes before it is dropped.
fn steps(k: usize) -> usize {
    if k.is_multiple_of(13) { 3 } else { STEPS }
}

/// Time and state, to the last bit.
fn bits(solver: &Solver) -> Vec<u64> {
    [solver.t()].iter().chain(solver.y()).map(|x| x.to_bits()).collect()
}

#[test]
fn thousands_of_solvers_on_many_threads_compute_what_each_does_alone() {
    // each thread takes the solver that waited longest, makes one step and puts it back: all are alive at once, and next
    // to no step is made by the thread of the one before
    let waiting: VecDeque<(usize, usize, Option<Solver>)> =
        (0..SOLVERS).map(|k| (k, 0, None)).collect();
    let waiting = Mutex::new(waiting);
    let ends = Mutex::new(vec![Vec::new(); SOLVERS]);
    thread::scope(|scope| {
        for _ in 0..THREADS {
            scope.spawn(|| {
                loop {
                    let Some((k, count, made)) = waiting.lock().unwrap().pop_front() else { break };
                    let mut solver = made.unwrap_or_else(|| solver(k));
                    step(&mut solver, k, count);
                    if count + 1 == steps(k) {
                        ends.lock().unwrap()[k] = bits(&solver);
                    } else {
                        waiting.lock().unwrap().push_back((k, count + 1, Some(solver)));
                    }
                }
            });
        }
    });
    for (k, end) in ends.into_inner().unwrap().into_iter().enumerate() {
        let mut alone = solver(k);
        (0..steps(k)).for_each(|count| step(&mut alone, k, count));
        assert_eq!(end, bits(&alone), "solver {k}");
    }
}

/// No integrator takes a system without unknowns.
#[test]
fn empty_systems_are_refused_by_all() {
    fn nothing(_t: f64, _y: &[f64], _ydot: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }
    fn nothing_implicit(_t: f64, _y: &[f64], _yp: &[f64], _r: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }
    let refusals = [
        Cvode::new(nothing, 0.0, &[], &CvodeOptions::new(1e-6, 1e-9)).unwrap_err(),
        Arkode::new(nothing, 0.0, &[], &ArkodeOptions::new(1e-6, 1e-9)).unwrap_err(),
        DormandPrince::new(nothing, 0.0, &[], &rk::Options::new(1e-6, 1e-9)).err().unwrap(),
        Ida::new(nothing_implicit, 0.0, &[], &[], &IdaOptions::new(1e-6, 1e-9)).unwrap_err(),
    ];
    for error in refusals {
        assert!(error.to_string().contains("length of y0"), "{error}");
    }
}
