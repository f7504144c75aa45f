//! Integrals and sensitivities, which CVODES and IDAS integrate in addition to the state.

use std::ptr;

use super::{
    context::Context,
    ffi,
    functions::{QuadratureFunctions, QuadratureSensitivityFunctions, SensitivityFunctions},
    linear::Linear,
    vector::Vector,
};
use crate::integrators::common::Error;

/// Integrals at the present time.
pub(super) struct Quadratures {
    pub(super) functions: &'static QuadratureFunctions,
    pub(super) values: Vector,
    /// A vector of the same length, for integrals at other times.
    pub(super) scratch: Vector,
}

/// Sensitivities at the present time, one vector for each parameter.
pub(super) struct Sensitivity {
    pub(super) functions: &'static SensitivityFunctions,
    pub(super) s: Vectors,
    /// Time derivatives of the sensitivities of a DAE, at the start.
    pub(super) sp: Option<Vectors>,
    /// One sensitivity at another time.
    pub(super) scratch: Vector,
    /// The present sensitivities, one after the other.
    pub(super) values: Vec<f64>,
    /// C's number of the method.
    pub(super) method: i32,
    /// Those of integrals, if they are wanted.
    pub(super) integrals: Option<IntegralSensitivity>,
}

/// Sensitivities of integrals at the present time, one vector for each parameter.
pub(super) struct IntegralSensitivity {
    pub(super) functions: &'static QuadratureSensitivityFunctions,
    pub(super) s: Vectors,
    /// One of them at another time.
    pub(super) scratch: Vector,
    /// The present ones, one after the other.
    pub(super) values: Vec<f64>,
}

impl Sensitivity {
    /// The C vectors of s and of s', which is null for an ODE.
    pub(super) fn raw(&mut self) -> [*mut ffi::N_Vector; 2] {
        [self.s.raw(), self.sp.as_mut().map_or(ptr::null_mut(), Vectors::raw)]
    }
}

/// Vectors of equal length, and the array of them that C requires.
pub(super) struct Vectors {
    owned: Vec<Vector>,
    raw: Vec<ffi::N_Vector>,
}

impl Vectors {
    /// `count` vectors of `n` zeros.
    pub(super) fn zeros(n: usize, count: usize, context: &Context) -> Result<Self, Error> {
        let zeros = vec![0.0; n];
        let owned: Vec<_> =
            (0..count).map(|_| Vector::from_slice(&zeros, context)).collect::<Result<_, _>>()?;
        let raw = owned.iter().map(Vector::raw).collect();
        Ok(Self { owned, raw })
    }

    pub(super) fn raw(&mut self) -> *mut ffi::N_Vector {
        self.raw.as_mut_ptr()
    }

    /// Writes `values`, one vector after the other, into them.
    pub(super) fn set(&mut self, values: &[f64]) {
        for (vector, values) in
            self.owned.iter_mut().zip(values.chunks(values.len() / self.raw.len()))
        {
            vector.as_mut_slice().copy_from_slice(values);
        }
    }

    pub(super) fn fill(&mut self, value: f64) {
        self.owned.iter_mut().for_each(|vector| vector.as_mut_slice().fill(value));
    }

    /// Writes them into `values`, one after the other.
    pub(super) fn copy_to(&self, values: &mut [f64]) {
        let n = values.len() / self.raw.len();
        for (vector, values) in self.owned.iter().zip(values.chunks_mut(n)) {
            values.copy_from_slice(vector.as_slice());
        }
    }
}

/// The backward problem of an adjoint gradient, which C frees together with the forward one, and its
/// data.
pub(super) struct Backward {
    /// C's number of the problem.
    pub(super) which: i32,
    /// Used by C; it is kept here and freed after the memory.
    pub(super) linear: Linear,
    /// Lambda where the backward run starts, then where it ends.
    pub(super) lambda: Vector,
    /// The time derivative of `lambda`, for a DAE only.
    pub(super) slope: Option<Vector>,
    /// Integrals, if there are parameters.
    pub(super) gradient: Option<Vector>,
}

impl Backward {
    /// The C vector of the time derivative; null for an ODE.
    pub(super) fn raw_slope(&self) -> ffi::N_Vector {
        self.slope.as_ref().map_or(ptr::null_mut(), Vector::raw)
    }
}
