//! One face for all integrators: step, look back into the step, count.

use crate::central_difference::{self, CentralDifference};
use crate::ode::Failure;
use crate::report::Counts;
use crate::rk::{self, DormandPrince};
use crate::settings::Tolerances;
use crate::settings::{Method, Settings};
use crate::state::ENERGIES;
use crate::sundials::{
    Arkode, ArkodeOptions, Cvode, CvodeOptions, Ida, IdaOptions, LinearSolver, Multistep, Pattern,
    Statistics, Table,
};
use crate::system::{DaeForm, Index, SecondOrderForm, System};

pub(super) type Failed = Box<dyn std::error::Error + Send + Sync>;

/// An integrator at work on the equations of one phase.
pub(super) enum Stepper {
    Arkode(Arkode<System>),
    Cvode(Cvode<System>),
    Ida(Ida<DaeForm>),
    Rk(Box<DormandPrince<System>>),
    CentralDifference(Box<CentralDifference<SecondOrderForm>>),
}

impl Stepper {
    /// Starts at `t` with `state` = (u, v, energies) and will stop at `end`.
    pub(super) fn new(
        system: System,
        solver: &Settings,
        atol: &Tolerances,
        t: f64,
        end: f64,
        state: &[f64],
    ) -> Result<Self, Failed> {
        let n = system.dofs();
        let mut tolerances = vec![atol.position; n];
        tolerances.resize(2 * n, atol.velocity);
        tolerances.resize(2 * n + ENERGIES, atol.energy);
        let longest = solver.max_step.unwrap_or(f64::INFINITY);
        match solver.method {
            // a plan names a method of its own
            Method::Auto | Method::CvodeBdf => {
                cvode(system, solver, Multistep::Bdf, tolerances, t, end, state)
            }
            Method::CvodeAdams => {
                cvode(system, solver, Multistep::Adams, tolerances, t, end, state)
            }
            Method::Arkode => arkode(system, solver, tolerances, t, end, state),
            Method::Ida | Method::IdaKlu | Method::IdaIndexTwo => {
                let rows = system.rows().len();
                tolerances.resize(2 * n + ENERGIES + rows, atol.force);
                if solver.method == Method::IdaIndexTwo {
                    tolerances.resize(2 * n + ENERGIES + 2 * rows, atol.momentum);
                }
                ida(system, solver, tolerances, t, end, state)
            }
            Method::Rk => {
                let options = rk::Options::default().rtol(solver.rtol).atol(tolerances);
                let options = options.stop_time(end).max_step(longest);
                Ok(Self::Rk(Box::new(DormandPrince::new(system, t, state, &options)?)))
            }
            Method::CentralDifference => {
                let options = rk::Options::default().rtol(solver.rtol).atol(tolerances);
                let options = options.stop_time(end).max_step(longest);
                let form = SecondOrderForm::new(system);
                let started = CentralDifference::new(form, t, state, &options)?;
                Ok(Self::CentralDifference(Box::new(started)))
            }
        }
    }

    /// Takes one step towards `end` and returns the time reached.
    pub(super) fn step(&mut self, end: f64) -> Result<f64, Failed> {
        match self {
            Self::Arkode(arkode) => {
                let _ = arkode.step(end)?;
                Ok(arkode.t())
            }
            Self::Cvode(cvode) => {
                let _ = cvode.step(end)?;
                Ok(cvode.t())
            }
            Self::Ida(ida) => {
                let _ = ida.step(end)?;
                Ok(ida.t())
            }
            Self::Rk(rk) => {
                let _ = rk.step()?;
                Ok(rk.t())
            }
            Self::CentralDifference(central) => {
                let _ = central.step(end)?;
                Ok(central.t())
            }
        }
    }

    /// The state at a time within the last step.
    pub(super) fn interpolate(&mut self, t: f64, state: &mut [f64]) -> Result<(), Failed> {
        match self {
            Self::Arkode(arkode) => Ok(arkode.interpolate(t, 0, state)?),
            Self::Cvode(cvode) => Ok(cvode.interpolate(t, 0, state)?),
            Self::Ida(ida) => Ok(ida.interpolate(t, 0, state)?),
            Self::Rk(rk) => Ok(rk.interpolate(t, 0, state)?),
            Self::CentralDifference(central) => Ok(central.interpolate(t, state)?),
        }
    }

    /// Order of the last step.
    pub(super) fn last_order(&self) -> u32 {
        match self {
            Self::Arkode(arkode) => arkode.last_order(),
            Self::Cvode(cvode) => cvode.last_order(),
            Self::Ida(ida) => ida.last_order(),
            Self::Rk(_) => rk::ORDER,
            Self::CentralDifference(_) => central_difference::ORDER,
        }
    }

    /// Number of unknowns, all together.
    pub(super) fn size(&self) -> usize {
        self.state().len()
    }

    /// The state at the end of the last step.
    pub(super) fn state(&self) -> &[f64] {
        match self {
            Self::Arkode(arkode) => arkode.y(),
            Self::Cvode(cvode) => cvode.y(),
            Self::Ida(ida) => ida.y(),
            Self::Rk(rk) => rk.y(),
            Self::CentralDifference(central) => central.y(),
        }
    }

    pub(super) fn system(&self) -> &System {
        match self {
            Self::Arkode(arkode) => arkode.system(),
            Self::Cvode(cvode) => cvode.system(),
            Self::Ida(ida) => &ida.system().system,
            Self::Rk(rk) => rk.system(),
            Self::CentralDifference(central) => &central.system().system,
        }
    }

    pub(super) fn system_mut(&mut self) -> &mut System {
        match self {
            Self::Arkode(arkode) => arkode.system_mut(),
            Self::Cvode(cvode) => cvode.system_mut(),
            Self::Ida(ida) => &mut ida.system_mut().system,
            Self::Rk(rk) => rk.system_mut(),
            Self::CentralDifference(central) => &mut central.system_mut().system,
        }
    }

    /// The equations, back from the integrator.
    pub(super) fn into_system(self) -> System {
        match self {
            Self::Arkode(arkode) => arkode.into_system(),
            Self::Cvode(cvode) => cvode.into_system(),
            Self::Ida(ida) => ida.into_system().system,
            Self::Rk(rk) => rk.into_system(),
            Self::CentralDifference(central) => central.into_system().system,
        }
    }

    /// What the integration has cost so far, and what it has to say about itself.
    pub(super) fn counts(&self) -> Counts {
        let sundials = |s: Statistics, factorizations: usize, system: &System| Counts {
            steps: s.steps as usize,
            evaluations: s.evaluations as usize,
            jacobian_evaluations: self.system().tangent_evaluations(),
            factorizations,
            error_test_failures: s.error_test_failures as usize,
            convergence_failures: s.nonlinear_failures as usize,
            contact_events: 0,
            last_step: s.last_step,
            last_order: s.last_order,
            notice: compression(system.indefinite()),
        };
        match self {
            Self::Arkode(arkode) => {
                sundials(arkode.statistics(), arkode.system().factorizations(), self.system())
            }
            Self::Cvode(cvode) => {
                sundials(cvode.statistics(), cvode.system().factorizations(), self.system())
            }
            Self::Ida(ida) => {
                let statistics = ida.statistics();
                let setups = statistics.linear_setups as usize;
                sundials(statistics, setups, self.system())
            }
            Self::Rk(rk) => {
                let s = rk.statistics();
                Counts {
                    steps: s.steps,
                    evaluations: s.rhs_evaluations,
                    jacobian_evaluations: 0,
                    factorizations: 0,
                    error_test_failures: s.rejected_steps,
                    convergence_failures: s.refused_steps,
                    contact_events: 0,
                    last_step: s.last_step,
                    last_order: rk::ORDER,
                    notice: s.stability_limited.map(|limit| limit.to_string()),
                }
            }
            Self::CentralDifference(central) => {
                let s = central.statistics();
                Counts {
                    steps: s.steps,
                    evaluations: s.rhs_evaluations,
                    jacobian_evaluations: central.system().system.tangent_evaluations(),
                    factorizations: 0,
                    error_test_failures: s.rejected_steps,
                    convergence_failures: s.refused_steps,
                    contact_events: 0,
                    last_step: s.last_step,
                    last_order: central_difference::ORDER,
                    notice: central.notice(),
                }
            }
        }
    }
}

/// What Newton matrices that are not positive definite tell.
fn compression(indefinite: usize) -> Option<String> {
    (indefinite > 0).then(|| {
        format!(
            "{indefinite} Newton matrices were not positive definite: the body is under strong \
             compression, where it buckles or collapses"
        )
    })
}

fn cvode(
    system: System,
    solver: &Settings,
    method: Multistep,
    tolerances: Vec<f64>,
    t: f64,
    end: f64,
    state: &[f64],
) -> Result<Stepper, Failed> {
    let mut options = CvodeOptions::new(solver.rtol, tolerances)
        .method(method)
        .newton(LinearSolver::Custom)
        .stability_limit_detection(solver.stability_limit_detection);
    if let Some(order) = solver.max_order {
        options = options.max_order(order);
    }
    if let Some(step) = solver.max_step {
        options = options.max_step(step);
    }
    let mut cvode = Cvode::new(system, t, state, &options)?;
    cvode.set_stop_time(Some(end))?;
    Ok(Stepper::Cvode(cvode))
}

/// Steps after which ARKODE has a new Newton matrix, with new tangents, in any case: few enough that
/// iterations converge in one or two, which pays on all Hirai's scenes.
const STEPS_BETWEEN_SETUPS: u32 = 2;

fn arkode(
    system: System,
    solver: &Settings,
    tolerances: Vec<f64>,
    t: f64,
    end: f64,
    state: &[f64],
) -> Result<Stepper, Failed> {
    let table = solver.max_order.map_or(Ok(Table::default()), Table::implicit)?;
    let mut options =
        ArkodeOptions::new(solver.rtol, tolerances).table(table).newton(LinearSolver::Custom);
    options = match system.is_linear() {
        true => options.linear(),
        false => options
            .max_steps_between_setups(STEPS_BETWEEN_SETUPS)
            .max_steps_between_jacobians(STEPS_BETWEEN_SETUPS),
    };
    if let Some(step) = solver.max_step {
        options = options.max_step(step);
    }
    let mut arkode = Arkode::new(system, t, state, &options)?;
    arkode.set_stop_time(Some(end))?;
    Ok(Stepper::Arkode(arkode))
}

fn ida(
    system: System,
    solver: &Settings,
    tolerances: Vec<f64>,
    t: f64,
    end: f64,
    state: &[f64],
) -> Result<Stepper, Failed> {
    let motion = 2 * system.dofs();
    let index = match solver.method {
        Method::IdaIndexTwo => Index::Two,
        _ => Index::One,
    };
    let mut equations = DaeForm::new(system, index);
    let (y, yp) = equations.consistent(t, state).map_err(Failure::into_error)?;
    // What is not marked as differential stays out of the error test: energies and multipliers.
    let differential: Vec<bool> = (0..y.len()).map(|i| i < motion).collect();
    let linear_solver = match solver.method {
        Method::IdaKlu => LinearSolver::Klu(jacobian_pattern(&equations)?),
        _ => LinearSolver::Custom,
    };
    let mut options = IdaOptions::new(solver.rtol, tolerances)
        .newton(linear_solver)
        .differential(differential)
        .suppress_algebraic(true);
    if let Some(order) = solver.max_order {
        options = options.max_order(order);
    }
    if let Some(step) = solver.max_step {
        options = options.max_step(step);
    }
    let mut ida = Ida::new(equations, t, &y, &yp, &options)?;
    ida.set_stop_time(Some(end))?;
    Ok(Stepper::Ida(ida))
}

fn jacobian_pattern(equations: &DaeForm) -> Result<Pattern, Failed> {
    let size = equations.size();
    let (mut offsets, mut row_indices) = (vec![0; size + 1], Vec::new());
    equations.visit_jacobian(1.0, |row, column, _| {
        row_indices.push(row);
        offsets[column + 1] = row_indices.len();
    });
    Ok(Pattern::from_csc(&offsets, &row_indices)?)
}
