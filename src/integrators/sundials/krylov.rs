//! Krylov methods: linear systems of the Newton iteration solved without their matrix.

use super::{jacobian::Jacobian, pattern::Pattern};
use crate::base::input::InputError;

/// A Krylov method, which needs only products of the Newton matrix with vectors.
///
/// It is for systems with too many unknowns for a factorization.
///
/// ```
/// use pliant::sundials::{
///     CvodeOptions, Jacobian, Krylov, KrylovMethod, LinearSolver, Pattern, Preconditioner, Side,
/// };
///
/// let ilu = Preconditioner::Ilu {
///     pattern: Pattern::band(1000, 1, 1)?,
///     jacobian: Jacobian::DifferenceQuotients,
/// };
/// let gmres = Krylov::new(KrylovMethod::Gmres { dimension: 10, restarts: 2 })
///     .preconditioner(Side::Left, ilu);
/// let options = CvodeOptions::new(1e-6, 1e-9).newton(LinearSolver::Krylov(gmres));
/// # Ok::<(), pliant::InputError>(())
/// ```
///
/// User guide: chapter "Linear Algebraic Solvers", `SUNLinSol_SPGMR` and the others.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Krylov {
    pub(super) method: KrylovMethod,
    pub(super) products: Jacobian,
    pub(super) preconditioner: Option<(Side, Preconditioner)>,
    pub(super) tolerance_factor: Option<f64>,
}

/// The Krylov methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum KrylovMethod {
    /// Minimizes the residual in a subspace (`SUNLinSol_SPGMR`): one product for each of its dimensions,
    /// whose vectors are all kept.
    Gmres {
        /// Dimensions of the subspace, 1 to 1000; the default of C is 5.
        dimension: u32,
        /// Largest number of restarts from the reached point, at most 1000; 0: none.
        restarts: u32,
    },
    /// The stabilized method of biconjugate gradients (`SUNLinSol_SPBCGS`): two products for each iteration,
    /// and six vectors.
    BiCgStab {
        /// Iterations allowed, 1 to 1000; the default of C is 5.
        iterations: u32,
    },
    /// The flexible GMRES (`SUNLinSol_SPFGMR`): its preconditioner, on the [right](Side::Right), may change from
    /// one iteration to the next, as where it iterates itself. Twice the vectors of GMRES.
    Fgmres {
        /// Dimensions of the subspace, 1 to 1000; the default of C is 5.
        dimension: u32,
        /// Largest number of restarts from the reached point, at most 1000; 0: none.
        restarts: u32,
    },
    /// The quasi-minimal residual method without products with the transposed matrix (`SUNLinSol_SPTFQMR`): two
    /// products for each iteration, and eleven vectors.
    Tfqmr {
        /// Iterations allowed, 1 to 1000; the default of C is 5.
        iterations: u32,
    },
    /// Conjugate gradients (`SUNLinSol_PCG`): one product for each iteration, and four vectors. For symmetric
    /// definite Newton matrices with a symmetric preconditioner, whose side does not matter.
    ConjugateGradients {
        /// Iterations allowed, 1 to 1000; the default of C is 5.
        iterations: u32,
    },
}

/// The side of the matrix A on which a preconditioner P is applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Side {
    /// P^-1 A x = P^-1 b: the residual is measured after P^-1.
    Left,
    /// A P^-1 (P x) = b: the residual is that of the equations. CVODE and ARKODE alone.
    Right,
}

/// The preconditioner of a Krylov method: an approximation of its linear systems that is solved directly.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Preconditioner {
    /// The system's own `newton_setup` and `newton_solve`, which may be approximate here. A `newton_rhs` of
    /// the system is not called: all terms have to be in `rhs`.
    Custom,
    /// Incomplete LU factorization without fill, ILU(0), of the Newton matrix on a sparsity pattern: exact
    /// where factors have no fill, as on a full band ([`Pattern::band`]).
    ///
    /// There is no pivoting. After a zero on the diagonal the step is tried again with another size: the
    /// equations of a DAE have to be in an order where equation i contains unknown i.
    Ilu {
        /// The entries that are used; the Jacobian may have others if its values are supplied.
        pattern: Pattern,
        /// Source of the values.
        jacobian: Jacobian,
    },
}

impl Krylov {
    /// A method with products by difference quotients and without a preconditioner.
    pub fn new(method: KrylovMethod) -> Self {
        let products = Jacobian::DifferenceQuotients;
        Self { method, products, preconditioner: None, tolerance_factor: None }
    }

    /// Source of the products of the Jacobian with vectors (`CVodeSetJacTimes`). Default: difference
    /// quotients; supplied ones are `jacobian_times`.
    pub fn products(mut self, products: Jacobian) -> Self {
        self.products = products;
        self
    }

    /// The preconditioner (`CVodeSetPreconditioner`). Default: none, which suffices where steps are hardly
    /// longer than the fastest time scale.
    pub fn preconditioner(mut self, side: Side, preconditioner: Preconditioner) -> Self {
        self.preconditioner = Some((side, preconditioner));
        self
    }

    /// The error allowed to a linear system, relative to that allowed to Newton's iteration
    /// (`CVodeSetEpsLin`). Default: 0.05.
    pub fn tolerance_factor(mut self, factor: f64) -> Self {
        self.tolerance_factor = Some(factor);
        self
    }

    /// Checks that `n` equations can be solved so.
    pub(super) fn check(&self, n: usize) -> Result<(), InputError> {
        const MOST: u32 = 1000;
        let (input, size, restarts) = match self.method {
            KrylovMethod::Gmres { dimension, restarts }
            | KrylovMethod::Fgmres { dimension, restarts } => ("dimension", dimension, restarts),
            KrylovMethod::BiCgStab { iterations }
            | KrylovMethod::Tfqmr { iterations }
            | KrylovMethod::ConjugateGradients { iterations } => ("iterations", iterations, 0),
        };
        if !(1..=MOST).contains(&size) {
            return Err(InputError::new(input, size, format!("it lies between 1 and {MOST}")));
        }
        if restarts > MOST {
            return Err(InputError::new("restarts", restarts, format!("it is at most {MOST}")));
        }
        if let Some(factor) = self.tolerance_factor
            && !(factor > 0.0 && factor.is_finite())
        {
            return Err(InputError::new(
                "tolerance_factor",
                factor,
                "it is positive, such as 0.05",
            ));
        }
        if let (KrylovMethod::Fgmres { .. }, Some((Side::Left, _))) =
            (self.method, &self.preconditioner)
        {
            let help = "FGMRES has preconditioners on the right alone";
            return Err(InputError::new("side of the preconditioner", "Side::Left", help));
        }
        match self.ilu() {
            Some((pattern, _)) => pattern.check(n),
            None => Ok(()),
        }
    }

    /// The same method for the transposed matrices of a backward run, with products by the system. A preconditioner
    /// is the incomplete factorization on the transposed pattern.
    pub(super) fn transposed(&self) -> Result<Self, InputError> {
        let preconditioner = match &self.preconditioner {
            Some((_, Preconditioner::Custom)) => {
                let help =
                    "an adjoint gradient needs one for the transposed matrix: choose Ilu, or none";
                return Err(InputError::new("preconditioner", "Custom", help));
            }
            Some((side, Preconditioner::Ilu { pattern, .. })) => {
                let (pattern, jacobian) = (pattern.transposed(), Jacobian::Supplied);
                Some((*side, Preconditioner::Ilu { pattern, jacobian }))
            }
            None => None,
        };
        Ok(Self { products: Jacobian::Supplied, preconditioner, ..self.clone() })
    }

    /// Refuses the right side: IDA takes the preconditioned residual as the solution if no iteration is
    /// needed.
    pub(super) fn check_for_dae(&self) -> Result<(), InputError> {
        match &self.preconditioner {
            Some((Side::Right, _)) => {
                let help = "IDA has preconditioners on the left alone";
                Err(InputError::new("side of the preconditioner", "Side::Right", help))
            }
            _ => Ok(()),
        }
    }

    /// Pattern and entries of an incomplete factorization.
    // If inlined, its test is made before the one whether there is a Krylov method at all, and its value is
    // dropped: valgrind takes that for an error.
    #[inline(never)]
    pub(super) fn ilu(&self) -> Option<(&Pattern, Jacobian)> {
        match &self.preconditioner {
            Some((_, Preconditioner::Ilu { pattern, jacobian })) => Some((pattern, *jacobian)),
            _ => None,
        }
    }
}
