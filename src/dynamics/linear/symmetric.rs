//! Symmetric systems, solved by the cheaper of conjugate gradients and a factor.
//!
//! On large solids a factor costs as much as hundreds of iterations, while a Newton matrix M + gamma D +
//! gamma^2 K with the small gamma of a step that follows the motion needs ten to a hundred of them. How many
//! is not known beforehand, so iterations are "rented" until they have cost as much as a factor; then the
//! factor is "bought". Work is counted, not timed: a run is independent of the load of the machine.
//!
//! Operations of a factorization follow from the symbolic analysis, and solves that it would have saved are
//! credited. After matrices that needed a factor in spite of the attempt, the amount tried is reduced, down
//! to a tenth. Iterations are tried where a factor costs more than 400 of them: solids of some 9000 unknowns,
//! planes of more than a million. Residuals of 1e-5 of the right-hand side are enough for Newton's iteration,
//! which evaluates the residual again; methods that solve once (Rosenbrock, ARKODE on linear bodies) get
//! 1e-11, general rows and M 1e-13. A direction of negative curvature ends the iterations, and the matrix is
//! factorized. Times are in `docs/notes/costs.md`.

use faer::sparse::SymbolicSparseColMat;

use super::cholesky::{Cholesky, Indefinite};
use super::entry_source::EntrySource;
use super::free_matrix::FreeMatrix;
use super::gradients::Gradients;

/// Operations of a factorization, which uses dense blocks, in the time of one operation of an iteration.
const DENSE_SPEED: f64 = 4.0;
/// Iterations are tried where a factorization takes the time of at least so many: solids of some 9000
/// unknowns, plane bodies of more than a million.
const WORTH_ITERATING: f64 = 400.0;

/// Part of the rent that is always risked.
const LEAST_TRUST: f64 = 0.1;

/// A symmetric matrix X at the free degrees of freedom, with the solvers of its systems.
pub(super) struct Symmetric {
    matrix: FreeMatrix,
    cholesky: Cholesky,
    /// None where a factor is cheap.
    rented: Option<BudgetedCg>,
}

/// Iterations instead of a factor.
struct BudgetedCg {
    gradients: Gradients,
    /// Whether systems with the matrix in force are solved by them.
    is_open: bool,
    /// The number of iterations allowed for one matrix, the part of it that is risked, and the number left
    /// for the matrix in force.
    rent: f64,
    trust: f64,
    left: f64,
    /// Iterations that cost as much as a solve with the factor.
    saved: f64,
    accuracy: f64,
    iterations: usize,
    /// Matrices that were solved without a factor so far.
    matrices: usize,
}

impl Symmetric {
    /// For the lower triangle `pattern`, which is analysed as in [`Cholesky::new`]. `gradients` creates the
    /// iterative solver, if that may pay.
    pub(super) fn new(
        matrix: FreeMatrix,
        pattern: SymbolicSparseColMat<usize>,
        order: Option<Vec<usize>>,
        gradients: Option<impl FnOnce() -> Gradients>,
    ) -> Self {
        let cholesky = Cholesky::new(pattern, order);
        // one product and some vectors; a solve passes twice over the factor
        let iteration = (4 * matrix.values.len() + 12 * matrix.free.len()) as f64;
        let rent = cholesky.work() / DENSE_SPEED / iteration;
        let saved = 4.0 * cholesky.entries() as f64 / iteration;
        let gradients = gradients.filter(|_| rent >= WORTH_ITERATING);
        let rented = gradients.map(|gradients| BudgetedCg::new(gradients(), rent, saved));
        Self { matrix, cholesky, rented }
    }

    /// Has iterations tried before a factor, up to so many more than solves with the factor would cost.
    #[cfg(test)]
    pub(super) fn rent(&mut self, gradients: Gradients, iterations: f64) {
        self.rented = Some(BudgetedCg::new(gradients, iterations, 0.0));
    }

    /// Sets a positive definite matrix, which is factorized only where that is cheap or turns out to be
    /// needed. That it is not positive definite may be found only later: then it is factorized as an
    /// indefinite one. Iterations end at a residual of `accuracy` times the right-hand side.
    pub(super) fn begin(
        &mut self,
        accuracy: f64,
        value: impl Fn(EntrySource) -> f64,
    ) -> Result<(), Indefinite> {
        let Some(rented) = &mut self.rented else { return self.factorize(value, &[]) };
        rented.begin(accuracy);
        if rented.gradients.take(value) { Ok(()) } else { Err(Indefinite) }
    }

    /// Factorizes the positive definite matrix whose entries `value` returns, with `more` added to some of
    /// them.
    pub(super) fn factorize(
        &mut self,
        value: impl Fn(EntrySource) -> f64,
        more: &[(usize, f64)],
    ) -> Result<(), Indefinite> {
        self.rented.iter_mut().for_each(|rented| rented.is_open = false);
        self.matrix.assemble(value);
        more.iter().for_each(|&(at, more)| self.matrix.values[at] += more);
        self.cholesky.factorize(&self.matrix.values)
    }

    /// Factorizes the matrix in force, which has turned out not to be positive definite.
    pub(super) fn factorize_indefinite(&mut self) -> Result<(), Indefinite> {
        self.end_iterations();
        self.cholesky.factorize_indefinite(&self.matrix.values)
    }

    /// Ends iterations, and copies the matrix in force to where it is factorized.
    fn end_iterations(&mut self) {
        if let Some(BudgetedCg { is_open, matrices, gradients, .. }) = &mut self.rented
            && std::mem::take(is_open)
        {
            *matrices = matrices.saturating_sub(1);
            // no node moves with others here
            self.matrix.assemble(|source| gradients.entry(source));
        }
    }

    /// Replaces `x` by the solution of X x' = x; by NaN if X turns out to be singular.
    pub(super) fn solve(&mut self, x: &mut [f64]) {
        if let Some(rented) = &mut self.rented
            && rented.is_open
        {
            if rented.solve(&self.matrix.free, x) {
                return;
            }
            self.end_iterations();
            let factorized = self.cholesky.factorize(&self.matrix.values);
            if factorized.or_else(|_| self.factorize_indefinite()).is_err() {
                return x.fill(f64::NAN);
            }
        }
        self.cholesky.solve(x);
    }

    /// The free degrees of freedom, ascending.
    pub(super) fn free(&self) -> &[usize] {
        &self.matrix.free
    }

    /// Matrices that were never factorized, iterations for them and others, and factorizations of matrices that were not positive
    /// definite.
    pub(super) fn counts(&self) -> [usize; 3] {
        let [matrices, iterations] =
            self.rented.as_ref().map_or([0; 2], |rented| [rented.matrices, rented.iterations]);
        [matrices, iterations, self.cholesky.indefinite]
    }

    /// Has these counts from now on.
    pub(super) fn set_counts(&mut self, [matrices, iterations, indefinite]: [usize; 3]) {
        if let Some(rented) = &mut self.rented {
            (rented.matrices, rented.iterations) = (matrices, iterations);
        }
        self.cholesky.indefinite = indefinite;
    }
}

impl BudgetedCg {
    fn new(gradients: Gradients, rent: f64, saved: f64) -> Self {
        Self {
            gradients,
            is_open: false,
            rent,
            trust: 1.0,
            left: 0.0,
            saved,
            accuracy: 0.0,
            iterations: 0,
            matrices: 0,
        }
    }

    /// Begins with a new matrix. As long as the last ones needed factors in the end, less is risked.
    fn begin(&mut self, accuracy: f64) {
        if self.is_open {
            self.trust = 1.0;
        }
        (self.is_open, self.left, self.accuracy) = (true, self.trust * self.rent, accuracy);
        self.matrices += 1;
    }

    /// Returns whether iterations have solved the system within their number; if not, `x` is unchanged.
    fn solve(&mut self, free: &[usize], x: &mut [f64]) -> bool {
        let most = (self.left + self.saved).max(0.0) as usize;
        let ended = self.gradients.solve(free, x, self.accuracy, most);
        self.iterations += ended.iterations;
        self.left -= ended.iterations as f64 - self.saved;
        if !ended.is_solved {
            self.trust = (0.5 * self.trust).max(LEAST_TRUST);
        }
        ended.is_solved
    }
}
