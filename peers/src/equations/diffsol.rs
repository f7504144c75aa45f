//! diffsol on systems of equations: Jacobians filled in place, dense ones factorized by faer and sparse ones by KLU.

use std::cell::{Cell, RefCell};

use diffsol::{
    ConstantOp, FaerContext, FaerLU, FaerMat, FaerSparseMat, FaerVec, LinearOp, Matrix,
    NonLinearOp, NonLinearOpJacobian, OdeBuilder, OdeEquations, OdeEquationsRef, OdeSolverMethod,
    OdeSolverStopReason, Op, UnitCallable, Vector, VectorCommon,
};
use diffsol_la::{LinearSolver, MatrixRef};
use faer::sparse::SymbolicSparseColMat;
use pliant::ode::{Boxed, MassKind, Ode};
use pliant::study::{EndState, Failed, Goal};
use pliant_peers::motion::Clock;
use pliant_peers::systems::System;

use crate::diffsol_peer::Klu;

type V = FaerVec<f64>;

/// Which of its methods.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    Bdf,
    TrBdf2,
    Esdirk34,
}

/// M y' = f(t, y), with Jacobians in matrices of a kind.
struct Equations<M: Matrix> {
    ode: RefCell<Boxed<dyn Ode>>,
    start: V,
    mass: Option<M>,
    sparsity: Option<M::Sparsity>,
    fill: fn(&mut dyn Ode, f64, &[f64], &mut M),
    evaluations: Cell<usize>,
    context: FaerContext,
}

struct Rhs<'a, M: Matrix>(&'a Equations<M>);
struct Mass<'a, M: Matrix>(&'a Equations<M>);
struct Start<'a, M: Matrix>(&'a Equations<M>);

fn slice(v: &V) -> &[f64] {
    v.inner().col_as_slice(0)
}

/// The matrices that are used.
trait Used: Matrix<T = f64, V = V, C = FaerContext> + Clone {}
impl Used for FaerMat<f64> {}
impl Used for FaerSparseMat<f64> {}

macro_rules! op {
    ($type:ty, $this:ident, $equations:expr) => {
        impl<M: Used> Op for $type {
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
                slice(&$equations.start).len()
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

op!(Equations<M>, this, this);
op!(Rhs<'_, M>, this, this.0);
op!(Mass<'_, M>, this, this.0);
op!(Start<'_, M>, this, this.0);

impl<M: Used> NonLinearOp for Rhs<'_, M> {
    fn call_inplace(&self, y: &V, t: f64, f: &mut V) {
        self.0.evaluations.set(self.0.evaluations.get() + 1);
        let f = f.inner_mut().col_as_slice_mut(0);
        if self.0.ode.borrow_mut().rhs(t, slice(y), f).is_err() {
            // it has no other way to be told
            f.fill(f64::NAN);
        }
    }
}

impl<M: Used> NonLinearOpJacobian for Rhs<'_, M> {
    fn jac_mul_inplace(&self, y: &V, t: f64, x: &V, product: &mut V) {
        self.jacobian(y, t).gemv(1.0, x, 0.0, product);
    }

    fn jacobian_sparsity(&self) -> Option<M::Sparsity> {
        self.0.sparsity.clone()
    }

    fn jacobian_inplace(&self, y: &V, t: f64, jacobian: &mut M) {
        (self.0.fill)(&mut *self.0.ode.borrow_mut().0, t, slice(y), jacobian);
    }
}

impl<M: Used> LinearOp for Mass<'_, M> {
    fn gemv_inplace(&self, x: &V, _t: f64, beta: f64, y: &mut V) {
        if let Some(mass) = &self.0.mass {
            mass.gemv(1.0, x, beta, y);
        }
    }

    fn matrix_inplace(&self, _t: f64, matrix: &mut M) {
        if let Some(mass) = &self.0.mass {
            matrix.copy_from(mass);
        }
    }
}

impl<M: Used> ConstantOp for Start<'_, M> {
    fn call_inplace(&self, _t: f64, y: &mut V) {
        y.copy_from(&self.0.start);
    }
}

impl<'a, M: Used> OdeEquationsRef<'a> for Equations<M> {
    type Mass = Mass<'a, M>;
    type Rhs = Rhs<'a, M>;
    type Root = UnitCallable<M>;
    type Init = Start<'a, M>;
    type Out = UnitCallable<M>;
    type Reset = UnitCallable<M>;
}

impl<M: Used> OdeEquations for Equations<M> {
    fn rhs(&self) -> Rhs<'_, M> {
        Rhs(self)
    }

    fn mass(&self) -> Option<Mass<'_, M>> {
        self.mass.as_ref().map(|_| Mass(self))
    }

    fn init(&self) -> Start<'_, M> {
        Start(self)
    }

    fn set_params(&mut self, _p: &V) {}

    fn get_params(&self, _p: &mut V) {}
}

/// Integrates `system` by a method of diffsol.
///
/// # Errors
/// Why there is no result.
pub fn integrate(system: &System, kind: Kind, goal: &Goal) -> Result<EndState, Failed> {
    let context = FaerContext::default();
    let (mut ode, n) = (system.ode(), system.y0.len());
    let start = V::from_vec(system.y0.clone(), context);
    match &system.pattern {
        None => {
            let mut mass = None;
            if ode.mass_kind() != MassKind::Identity {
                let mut dense = FaerMat::zeros(n, n, context);
                ode.dense_mass(0.0, dense.inner_mut().as_mut())
                    .map_err(|failure| format!("{failure:?}"))?;
                mass = Some(dense);
            }
            let fill = |ode: &mut dyn Ode, t: f64, y: &[f64], jacobian: &mut FaerMat<f64>| {
                let mut matrix = jacobian.inner_mut().as_mut();
                matrix.fill(0.0);
                // none of the systems uses f in its Jacobian
                if ode.dense_jacobian(t, y, y, matrix).is_err() {
                    jacobian.inner_mut().fill(f64::NAN);
                }
            };
            let (ode, evaluations) = (RefCell::new(ode), Cell::new(0));
            let equations =
                Equations { ode, start, mass, sparsity: None, fill, evaluations, context };
            by::<_, FaerLU<f64>>(equations, kind, goal)
        }
        Some(pattern) => {
            let places = |numbers: &[i64]| numbers.iter().map(|&number| number as usize).collect();
            let sparsity = SymbolicSparseColMat::new_checked(
                n,
                n,
                places(pattern.column_pointers()),
                None,
                places(pattern.row_indices()),
            );
            let fill = |ode: &mut dyn Ode, t: f64, y: &[f64], jacobian: &mut FaerSparseMat<f64>| {
                let values = jacobian.inner_mut()[0].val_mut();
                values.fill(0.0);
                if ode.sparse_jacobian(t, y, y, values).is_err() {
                    values.fill(f64::NAN);
                }
            };
            let (ode, evaluations) = (RefCell::new(ode), Cell::new(0));
            let sparsity = Some(sparsity);
            let equations =
                Equations { ode, start, mass: None, sparsity, fill, evaluations, context };
            by::<_, Klu>(equations, kind, goal)
        }
    }
}

fn by<M: Used, S: LinearSolver<M>>(
    equations: Equations<M>,
    kind: Kind,
    goal: &Goal,
) -> Result<EndState, Failed>
where
    for<'b> &'b M: MatrixRef<M>,
{
    let mut problem = OdeBuilder::<M>::new()
        .rtol(goal.rtol)
        .atol(goal.atol.to_vec())
        .build_from_eqn(equations)?;
    problem.ode_options.max_nonlinear_solver_failures = usize::MAX;
    problem.ode_options.max_error_test_failures = 1000;
    problem.ode_options.min_timestep = 1e-30;
    let mut reached = match kind {
        Kind::Bdf => steps(problem.bdf::<S>()?, goal),
        Kind::TrBdf2 => steps(problem.tr_bdf2::<S>()?, goal),
        Kind::Esdirk34 => steps(problem.esdirk34::<S>()?, goal),
    }?;
    reached.evaluations = problem.eqn.evaluations.get();
    Ok(reached)
}

fn steps<'a, M: Used>(
    mut solver: impl OdeSolverMethod<'a, Equations<M>>,
    goal: &Goal,
) -> Result<EndState, Failed> {
    let clock = Clock::new(goal.limit.as_secs_f64());
    solver.set_stop_time(goal.t)?;
    while !matches!(solver.step()?, OdeSolverStopReason::TstopReached) {
        clock.check()?;
    }
    let statistics = solver.get_statistics();
    Ok(EndState {
        y: slice(solver.state().y).to_vec(),
        seconds: None,
        steps: statistics.number_of_steps,
        evaluations: 0,
        factorizations: statistics.number_of_linear_solver_setups,
    })
}
