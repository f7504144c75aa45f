//! Vectors owned by SUNDIALS, seen from Rust as slices.

use super::{
    context::Context,
    ffi, kernels,
    serial::{slice, slice_mut},
};
use crate::integrators::common::Error;

/// Owns a serial `N_Vector`, which is not empty.
pub(super) struct Vector(ffi::N_Vector);

impl Vector {
    /// A vector with a copy of `values`, of which there is at least one.
    pub(super) fn from_slice(values: &[f64], context: &Context) -> Result<Self, Error> {
        // SAFETY: the context is alive.
        let raw = unsafe { ffi::N_VNew_Serial(values.len() as i64, context.raw()) };
        if raw.is_null() {
            return Err(Error::out_of_memory("N_VNew_Serial"));
        }
        // SAFETY: the vector is serial and just made.
        unsafe { kernels::install(raw) };
        let mut vector = Self(raw);
        vector.as_mut_slice().copy_from_slice(values);
        Ok(vector)
    }

    pub(super) fn raw(&self) -> ffi::N_Vector {
        self.0
    }

    pub(super) fn as_slice(&self) -> &[f64] {
        // SAFETY: the vector is serial; `&self` keeps it alive, and
        // SUNDIALS writes to it only in calls made through `&mut` of the owner.
        unsafe { slice(self.0) }
    }

    pub(super) fn as_mut_slice(&mut self) -> &mut [f64] {
        // SAFETY: as in `as_slice`, and `&mut self` makes the access unique.
        unsafe { slice_mut(self.0) }
    }
}

impl Drop for Vector {
    fn drop(&mut self) {
        // SAFETY: made by N_VNew_Serial and freed once.
        unsafe { ffi::N_VDestroy(self.0) };
    }
}
