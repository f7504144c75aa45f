//! Krylov methods whose products and preconditioners are functions of Python.

use pliant::sundials::{
    Jacobian, Krylov, KrylovMethod, LinearSolver, Pattern, Preconditioner, Side,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::equations::Iterative;

/// A Krylov method: the dict from `pliant/krylov.py`.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct AskedKrylov {
    method: String,
    iterations: u32,
    restarts: u32,
    products: Option<Py<PyAny>>,
    preconditioner: Option<Py<PyAny>>,
    transposed: Option<Py<PyAny>>,
    /// Whether the preconditioner is the incomplete factorization.
    ilu: bool,
    /// Whether the preconditioner is applied on the right.
    right: bool,
    tolerance_factor: Option<f64>,
}

impl AskedKrylov {
    /// The method, with the pattern of an incomplete factorization and the source of its values.
    pub fn solver(&self, pattern: Option<(Pattern, Jacobian)>) -> PyResult<LinearSolver> {
        let (iterations, restarts) = (self.iterations, self.restarts);
        let method = match self.method.as_str() {
            "gmres" => KrylovMethod::Gmres { dimension: iterations, restarts },
            "fgmres" => KrylovMethod::Fgmres { dimension: iterations, restarts },
            "bicgstab" => KrylovMethod::BiCgStab { iterations },
            "tfqmr" => KrylovMethod::Tfqmr { iterations },
            "cg" => KrylovMethod::ConjugateGradients { iterations },
            other => {
                let message = format!(
                    "the method of a Krylov is \"gmres\", \"fgmres\", \"bicgstab\", \"tfqmr\" or \"cg\", not \"{other}\""
                );
                return Err(PyValueError::new_err(message));
            }
        };
        let mut krylov = Krylov::new(method);
        if self.products.is_some() {
            krylov = krylov.products(Jacobian::Supplied);
        }
        let side = if self.right { Side::Right } else { Side::Left };
        if self.ilu {
            let Some((pattern, jacobian)) = pattern else {
                return Err(PyValueError::new_err(
                    "the preconditioner \"ilu\" needs the places of entries: `jac_sparsity`, a sparse `jac`, or `lband` and `uband`",
                ));
            };
            krylov = krylov.preconditioner(side, Preconditioner::Ilu { pattern, jacobian });
        } else if self.preconditioner.is_some() {
            krylov = krylov.preconditioner(side, Preconditioner::Custom);
        }
        krylov = self.tolerance_factor.into_iter().fold(krylov, Krylov::tolerance_factor);
        Ok(LinearSolver::Krylov(krylov))
    }

    /// Its functions of Python.
    pub fn functions(self) -> Iterative {
        let Self { products, preconditioner, transposed, .. } = self;
        Iterative { products, preconditioner, prepared: None, transposed }
    }
}
