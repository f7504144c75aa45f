//! diffsol (<https://github.com/martinjrobins/diffsol>), with its KLU solver, the mass matrix, and
//! the Jacobian that pliant's tangents make.
//!
//! Mass matrix, pattern and entries of the Jacobian are handed over as diffsol stores them, so that it has
//! no work with them but to copy. What it is given beyond its defaults: more failures of Newton's
//! iteration than 50 in a whole run, and u' and v' at the start, which it takes to be f where M is
//! not singular.

use std::cell::{Cell, RefCell};
use std::fs;

use diffsol::{
    ConstantOp, FaerContext, FaerSparseMat, FaerVec, KLU, LaError, LaLinearOp, LinearOp, Matrix,
    NonLinearOp, NonLinearOpJacobian, OdeBuilder, OdeEquations, OdeEquationsRef, OdeSolverMethod,
    OdeSolverState, OdeSolverStopReason, Op, UnitCallable, Vector, VectorCommon,
};
use diffsol_la::LinearSolver;
use faer::sparse::SymbolicSparseColMat;

use pliant::study::Failed;
use pliant::{Inertia, Settings};

use crate::implicit::initial_acceleration;
use pliant_peers::motion::{ENOUGH, GaveUp, REPETITIONS, Span, solve};
use pliant_peers::scenes::Case;
use pliant_peers::stage::{Pattern, Stage};

type M = FaerSparseMat<f64>;
type V = FaerVec<f64>;

/// diffsol's KLU solver, never moved.
#[derive(Default)]
pub struct Klu(Box<KLU<M>>);

impl LinearSolver<M> for Klu {
    fn set_linearisation<C: LaLinearOp<V = V, T = f64, M = M, C = FaerContext>>(&mut self, op: &C) {
        self.0.set_linearisation(op);
    }

    fn set_sparsity<C: LaLinearOp<V = V, T = f64, M = M, C = FaerContext>>(&mut self, op: &C) {
        self.0.set_sparsity(op);
    }

    fn solve_in_place(&self, b: &mut V) -> Result<(), LaError> {
        self.0.solve_in_place(b)
    }

    fn solve_transpose_in_place(&self, b: &mut V) -> Result<(), LaError> {
        self.0.solve_transpose_in_place(b)
    }
}

/// Which of its methods.
#[derive(Debug, Clone, Copy)]
enum Kind {
    TrBdf2,
    Esdirk34,
    Bdf,
}

/// M y' = f(t, y) with y = (u, v).
struct Equations {
    stage: RefCell<Stage>,
    n: usize,
    start: V,
    mass: M,
    /// Pattern of the Jacobian, column by column.
    jacobian: SymbolicSparseColMat<usize>,
    tangents: RefCell<[Vec<f64>; 2]>,
    /// Numbers of entries of -K in the columns of u.
    counts: Vec<usize>,
    evaluations: Cell<usize>,
    context: FaerContext,
}

struct Rhs<'a>(&'a Equations);
struct Mass<'a>(&'a Equations);
struct Start<'a>(&'a Equations);

fn slice(v: &V) -> &[f64] {
    v.inner().col_as_slice(0)
}

fn slice_mut(v: &mut V) -> &mut [f64] {
    v.inner_mut().col_as_slice_mut(0)
}

impl Equations {
    fn new(stage: Stage, u: &[f64], v: &[f64]) -> Result<Self, GaveUp> {
        let n = stage.size();
        let context = FaerContext::default();
        let (mut columns, mut rows) = (vec![0], Vec::new());
        let mut counts = Vec::new();
        for column in 0..2 * n {
            if column >= n {
                rows.push(column - n);
            }
            let before = rows.len();
            rows.extend(stage.tangents.column(column % n).map(|entry| n + entry.1));
            counts.push(rows.len() - before);
            columns.push(rows.len());
        }
        let jacobian = SymbolicSparseColMat::new_checked(2 * n, 2 * n, columns, None, rows);
        let mut entries: Vec<(usize, usize)> = (0..n).map(|i| (i, i)).collect();
        let mut values = vec![1.0; n];
        for column in 0..n {
            for (entry, row) in stage.inertia.column(column) {
                entries.push((n + row, n + column));
                values.push(stage.masses[entry]);
            }
        }
        let mass = M::try_from_triplets(2 * n, 2 * n, entries, values, context)
            .map_err(|error| GaveUp(error.to_string()))?;
        let Pattern { rows, .. } = &stage.tangents;
        let tangents = RefCell::new([vec![0.0; rows.len()], vec![0.0; rows.len()]]);
        let start = V::from_vec([u, v].concat(), context);
        let stage = RefCell::new(stage);
        let evaluations = Cell::new(0);
        Ok(Self { stage, n, start, mass, jacobian, tangents, counts, evaluations, context })
    }
}

macro_rules! op {
    ($type:ty, $this:ident, $equations:expr) => {
        impl Op for $type {
            type T = f64;
            type V = V;
            type M = M;
            type C = FaerContext;

            fn context(&self) -> &FaerContext {
                let $this = self;
                &$equations.context
            }

            fn nstates(&self) -> usize {
                let $this = self;
                2 * $equations.n
            }

            fn nout(&self) -> usize {
                self.nstates()
            }

            fn nparams(&self) -> usize {
                0
            }
        }
    };
}

op!(Equations, this, this);
op!(Rhs<'_>, this, this.0);
op!(Mass<'_>, this, this.0);
op!(Start<'_>, this, this.0);

impl NonLinearOp for Rhs<'_> {
    fn call_inplace(&self, y: &V, t: f64, f: &mut V) {
        let n = self.0.n;
        let (u, v) = slice(y).split_at(n);
        let (rates, forces) = slice_mut(f).split_at_mut(n);
        rates.copy_from_slice(v);
        self.0.evaluations.set(self.0.evaluations.get() + 1);
        if self.0.stage.borrow_mut().forces(t, u, v, forces).is_err() {
            // it has no other way to be told
            forces.fill(f64::NAN);
        }
    }
}

impl NonLinearOpJacobian for Rhs<'_> {
    fn jac_mul_inplace(&self, y: &V, t: f64, x: &V, product: &mut V) {
        let jacobian = self.jacobian(y, t);
        jacobian.gemv(1.0, x, 0.0, product);
    }

    fn jacobian_sparsity(&self) -> Option<SymbolicSparseColMat<usize>> {
        Some(self.0.jacobian.clone())
    }

    fn jacobian_inplace(&self, y: &V, t: f64, jacobian: &mut M) {
        let Equations { stage, n, tangents, counts, .. } = self.0;
        let (u, v) = slice(y).split_at(*n);
        let [stiffness, damping] = &mut *tangents.borrow_mut();
        stage.borrow_mut().write_tangents(t, u, v, stiffness, damping);
        let values = jacobian.inner_mut()[0].val_mut();
        let (by_u, mut by_v) = values.split_at_mut(stiffness.len());
        by_u.iter_mut().zip(&*stiffness).for_each(|(x, k)| *x = -k);
        let mut damping = &damping[..];
        for &count in &counts[*n..] {
            let (column, rest) = by_v.split_at_mut(1 + count);
            let (own, others) = damping.split_at(count);
            column[0] = 1.0;
            column[1..].iter_mut().zip(own).for_each(|(x, d)| *x = -d);
            (by_v, damping) = (rest, others);
        }
    }
}

impl LinearOp for Mass<'_> {
    fn gemv_inplace(&self, x: &V, _t: f64, beta: f64, y: &mut V) {
        self.0.mass.gemv(1.0, x, beta, y);
    }

    fn matrix_inplace(&self, _t: f64, matrix: &mut M) {
        matrix.copy_from(&self.0.mass);
    }

    fn sparsity(&self) -> Option<SymbolicSparseColMat<usize>> {
        self.0.mass.sparsity().map(|sparsity| sparsity.to_owned().expect("memory"))
    }
}

impl ConstantOp for Start<'_> {
    fn call_inplace(&self, _t: f64, y: &mut V) {
        y.copy_from(&self.0.start);
    }
}

impl<'a> OdeEquationsRef<'a> for Equations {
    type Mass = Mass<'a>;
    type Rhs = Rhs<'a>;
    type Root = UnitCallable<M>;
    type Init = Start<'a>;
    type Out = UnitCallable<M>;
    type Reset = UnitCallable<M>;
}

impl OdeEquations for Equations {
    fn rhs(&self) -> Rhs<'_> {
        Rhs(self)
    }

    fn mass(&self) -> Option<Mass<'_>> {
        Some(Mass(self))
    }

    fn init(&self) -> Start<'_> {
        Start(self)
    }

    fn set_params(&mut self, _p: &V) {}

    fn get_params(&self, _p: &mut V) {}
}

/// The program, called as `external` says.
///
/// # Errors
/// Arguments that are wrong, files that cannot be written.
pub fn main(arguments: &[String]) -> Result<(), Failed> {
    let [name, inertia, method, setting, _, times, out] = arguments else {
        return Err("seven arguments".into());
    };
    let kind = match method.as_str() {
        "tr_bdf2" => Kind::TrBdf2,
        "esdirk34" => Kind::Esdirk34,
        _ => Kind::Bdf,
    };
    let inertia = if inertia == "lumped" { Inertia::Lumped } else { Inertia::Consistent };
    let scene = Case::find(name).ok_or("no such case")?.scene(inertia)?;
    let rtol: f64 = setting.parse()?;
    let times: Vec<f64> =
        fs::read_to_string(times)?.lines().map(str::parse).collect::<Result<_, _>>()?;
    let tolerances = Settings { rtol, ..Settings::default() }.tolerances(&scene);
    let atol = [tolerances.position, tolerances.velocity];
    let mut seconds = Vec::new();
    loop {
        let solved = solve(&scene, &times, f64::INFINITY, |stage, span| {
            integrate(stage, span, kind, rtol, atol)
        });
        let solved = match solved {
            Ok(solved) => solved,
            Err(reason) => {
                println!("failed: {}", reason.to_string().replace('\n', " "));
                return Ok(());
            }
        };
        seconds.push(solved.seconds);
        if seconds.len() == REPETITIONS || seconds.iter().sum::<f64>() > ENOUGH {
            let least = seconds.iter().copied().fold(f64::INFINITY, f64::min);
            let bytes: Vec<u8> = solved.u.iter().flat_map(|x| x.to_le_bytes()).collect();
            fs::write(out, bytes)?;
            println!("{least} {} {} {}", solved.steps, solved.evaluations, solved.factorizations);
            return Ok(());
        }
    }
}

/// Integrates one phase. `atol` is that of displacements (m) and velocities (m/s).
fn integrate(
    mut stage: Stage,
    mut span: Span,
    kind: Kind,
    rtol: f64,
    atol: [f64; 2],
) -> Result<Stage, GaveUp> {
    let failed = |error: diffsol::DiffsolError| GaveUp(error.to_string());
    let n = stage.size();
    let acceleration = initial_acceleration(&mut stage, span.from, span.u, span.v)?;
    let slopes = [&**span.v, &acceleration].concat();
    let equations = Equations::new(stage, span.u, span.v)?;
    let atol = [vec![atol[0]; n], vec![atol[1]; n]].concat();
    let mut problem = OdeBuilder::<M>::new()
        .t0(span.from)
        .rtol(rtol)
        .atol(atol)
        .build_from_eqn(equations)
        .map_err(failed)?;
    problem.ode_options.max_nonlinear_solver_failures = usize::MAX;
    problem.ode_options.max_error_test_failures = 1000;

    macro_rules! go {
        ($state:expr, $solver:ident) => {{
            let mut state = $state.map_err(failed)?;
            state.as_mut().dy.copy_from(&V::from_vec(slopes, FaerContext::default()));
            *state.as_mut().h = 1e-5 * (span.to - span.from);
            let solver = problem.$solver::<Klu>(state).map_err(failed)?;
            steps(solver, &mut span)?;
        }};
    }
    match kind {
        Kind::TrBdf2 => {
            go!(diffsol::RkState::new_without_initialise(&problem), tr_bdf2_solver)
        }
        Kind::Esdirk34 => {
            go!(diffsol::RkState::new_without_initialise(&problem), esdirk34_solver)
        }
        Kind::Bdf => go!(diffsol::BdfState::new_without_initialise(&problem), bdf_solver),
    }
    span.solved.evaluations += problem.eqn.evaluations.get();
    Ok(problem.eqn.stage.into_inner())
}

fn steps<'a>(
    mut solver: impl OdeSolverMethod<'a, Equations>,
    span: &mut Span,
) -> Result<(), GaveUp> {
    let failed = |error: diffsol::DiffsolError| GaveUp(error.to_string());
    solver.set_stop_time(span.to).map_err(failed)?;
    let n = span.u.len();
    let mut sample = V::zeros(2 * n, FaerContext::default());
    loop {
        span.clock.check()?;
        let reason = solver.step().map_err(failed)?;
        let t1 = solver.state().t;
        while let Some(&t) = span.times.get(span.samples.len()).filter(|&&t| t <= t1) {
            solver.interpolate_inplace(t, &mut sample).map_err(failed)?;
            span.samples.push(slice(&sample)[..n].to_vec());
        }
        if matches!(reason, OdeSolverStopReason::TstopReached) {
            break;
        }
    }
    let statistics = solver.get_statistics();
    span.solved.steps += statistics.number_of_steps;
    span.solved.factorizations += statistics.number_of_linear_solver_setups;
    let state = solver.state();
    let (u, v) = slice(state.y).split_at(n);
    (*span.u, *span.v) = (u.to_vec(), v.to_vec());
    Ok(())
}
