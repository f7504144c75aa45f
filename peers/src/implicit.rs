//! Generalized-alpha with fixed steps (J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375), the
//! method of implicit structural codes. With rho = 1 it takes forces in the middle of the step and
//! is the implicit midpoint rule.

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};

use pliant_peers::motion::{GaveUp, Span};
use pliant_peers::stage::{Pattern, Stage};

/// Newton's iteration ends when its change, root mean square, is below this fraction of the size of
/// the body.
const CHANGE: f64 = 1e-9;
/// Iterations before the tangent is renewed, and in all.
const ITERATIONS: [usize; 2] = [6, 20];

/// Coefficients of the method for a spectral radius rho at infinite frequency.
struct Coefficients {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
}

impl Coefficients {
    fn new(rho: f64) -> Self {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let gamma = 0.5 - alpha_m + alpha_f;
        Self { alpha_m, alpha_f, beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2), gamma }
    }
}

/// The matrix of Newton's iteration, by Cholesky.
struct Newton {
    /// Lower triangle.
    lower: Pattern,
    /// Entries of the tangents it is made of, and those the other way round; entry of M, if any.
    sources: Vec<(usize, usize, Option<usize>)>,
    values: Vec<f64>,
    symbolic: SymbolicLlt<usize>,
    factor: Option<Llt<usize, f64>>,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

impl Newton {
    fn new(stage: &Stage) -> Result<Self, GaveUp> {
        let find = |pattern: &Pattern, row: usize, column: usize| {
            pattern.column(column).find(|entry| entry.1 == row).map(|entry| entry.0)
        };
        let mut lower = Pattern { columns: vec![0], rows: vec![] };
        let mut sources = Vec::new();
        for column in 0..stage.size() {
            for (entry, row) in stage.tangents.column(column).filter(|entry| entry.1 >= column) {
                let other = find(&stage.tangents, column, row).unwrap_or(entry);
                lower.rows.push(row);
                sources.push((entry, other, find(&stage.inertia, row, column)));
            }
            lower.columns.push(lower.rows.len());
        }
        let symbolic = SymbolicLlt::try_new(symbolic(&lower), Side::Lower)
            .map_err(|error| GaveUp(format!("{error:?}")))?;
        let entries = stage.tangents.rows.len();
        let [values, stiffness, damping] =
            [sources.len(), entries, entries].map(|count| vec![0.0; count]);
        Ok(Self { lower, sources, values, symbolic, factor: None, stiffness, damping })
    }

    /// Factorizes mass M + damping D + stiffness K at this state.
    fn renew(
        &mut self,
        stage: &mut Stage,
        [t, mass, damping, stiffness]: [f64; 4],
        u: &[f64],
        v: &[f64],
    ) -> Result<(), GaveUp> {
        stage.write_tangents(t, u, v, &mut self.stiffness, &mut self.damping);
        for (value, &(entry, other, inertia)) in self.values.iter_mut().zip(&self.sources) {
            let part = |x: &[f64]| 0.5 * (x[entry] + x[other]);
            *value = mass * inertia.map_or(0.0, |entry| stage.masses[entry])
                + damping * part(&self.damping)
                + stiffness * part(&self.stiffness);
        }
        let matrix = SparseColMatRef::new(symbolic(&self.lower), &self.values);
        let factor = Llt::try_new_with_symbolic(self.symbolic.clone(), matrix, Side::Lower);
        self.factor = Some(factor.map_err(|error| GaveUp(format!("Newton matrix: {error:?}")))?);
        Ok(())
    }
}

fn symbolic(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, usize> {
    let n = pattern.size();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.columns, None, &pattern.rows)
}

/// Integrates one phase in `steps` steps.
pub fn integrate(
    mut stage: Stage,
    mut span: Span,
    rho: f64,
    steps: usize,
    size: f64,
) -> Result<Stage, GaveUp> {
    let Coefficients { alpha_m, alpha_f, beta, gamma } = Coefficients::new(rho);
    let (n, h) = (stage.size(), (span.to - span.from) / steps as f64);
    let mut newton = Newton::new(&stage)?;
    let (mut u, mut v) = (span.u.clone(), span.v.clone());
    let mut a = initial_acceleration(&mut stage, span.from, &u, &v)?;
    let [mut f, mut r, mut u1, mut v1, mut a1, mut um, mut vm] = [(); 7].map(|()| vec![0.0; n]);
    for step in 0..steps {
        span.clock.check()?;
        let t0 = span.from + step as f64 * h;
        let t = t0 + (1.0 - alpha_f) * h;
        // the acceleration stays as it is, to begin with
        for i in 0..n {
            a1[i] = a[i];
            u1[i] = u[i] + h * v[i] + 0.5 * h * h * a[i];
            v1[i] = v[i] + h * a[i];
        }
        let mut iteration = 0;
        loop {
            for i in 0..n {
                um[i] = (1.0 - alpha_f) * u1[i] + alpha_f * u[i];
                vm[i] = (1.0 - alpha_f) * v1[i] + alpha_f * v[i];
            }
            let (mass, damping, stiffness) = (
                (1.0 - alpha_m) / (beta * h * h),
                (1.0 - alpha_f) * gamma / (beta * h),
                1.0 - alpha_f,
            );
            if iteration % ITERATIONS[0] == 0 {
                newton.renew(&mut stage, [t, mass, damping, stiffness], &um, &vm)?;
                span.solved.factorizations += 1;
            }
            let inverted = |_| GaveUp("a cell was turned inside out".into());
            stage.forces(t, &um, &vm, &mut f).map_err(inverted)?;
            span.solved.evaluations += 1;
            r.copy_from_slice(&f);
            for column in 0..n {
                let acceleration = (1.0 - alpha_m) * a1[column] + alpha_m * a[column];
                for (entry, row) in stage.inertia.column(column) {
                    r[row] -= stage.masses[entry] * acceleration;
                }
            }
            let Some(factor) = &newton.factor else { break };
            factor.solve_in_place(faer::ColMut::from_slice_mut(&mut r).as_mat_mut());
            for i in 0..n {
                u1[i] += r[i];
                v1[i] += gamma / (beta * h) * r[i];
                a1[i] += r[i] / (beta * h * h);
            }
            let change = (r.iter().map(|x| x * x).sum::<f64>() / n as f64).sqrt();
            if change < CHANGE * size {
                break;
            }
            iteration += 1;
            if !change.is_finite() || iteration == ITERATIONS[1] {
                return Err(GaveUp(format!("Newton's iteration does not converge at t = {t} s")));
            }
        }
        span.solved.steps += 1;
        let t1 = if step + 1 == steps { span.to } else { t0 + h };
        span.sample_step([t0, t1], [[&u, &v], [&u1, &v1]]);
        (u, u1) = (u1, u);
        (v, v1) = (v1, v);
        (a, a1) = (a1, a);
    }
    (*span.u, *span.v) = (u, v);
    Ok(stage)
}

/// a with M a = f.
pub fn initial_acceleration(
    stage: &mut Stage,
    t: f64,
    u: &[f64],
    v: &[f64],
) -> Result<Vec<f64>, GaveUp> {
    let mut a = vec![0.0; stage.size()];
    stage.forces(t, u, v, &mut a).map_err(|_| GaveUp("it begins inside out".into()))?;
    let inertia = SparseColMatRef::new(symbolic(&stage.inertia), &stage.masses);
    let factor = inertia.sp_cholesky(Side::Lower).map_err(|e| GaveUp(format!("{e:?}")))?;
    factor.solve_in_place(faer::ColMut::from_slice_mut(&mut a).as_mat_mut());
    Ok(a)
}
