//! Vectors owned by SUNDIALS, seen from Rust as slices.

use std::slice;

use super::{context::Context, ffi, kernels};
use crate::integrators::common::Error;

/// Owns a serial `N_Vector` of `len` numbers.
pub(super) struct Vector {
    raw: ffi::N_Vector,
    len: usize,
}

impl Vector {
    /// A vector with a copy of `values`.
    pub(super) fn from_slice(values: &[f64], context: &Context) -> Result<Self, Error> {
        // SAFETY: the context is alive.
        let raw = unsafe { ffi::N_VNew_Serial(values.len() as i64, context.raw()) };
        if raw.is_null() {
            return Err(Error::out_of_memory("N_VNew_Serial"));
        }
        // SAFETY: the vector is serial and just made.
        unsafe { kernels::install(raw) };
        let mut vector = Self { raw, len: values.len() };
        vector.as_mut_slice().copy_from_slice(values);
        Ok(vector)
    }

    pub(super) fn raw(&self) -> ffi::N_Vector {
        self.raw
    }

    pub(super) fn as_slice(&self) -> &[f64] {
        // SAFETY: the vector is serial and has `len` numbers; `&self` keeps it alive, and
        // SUNDIALS writes to it only in calls made through `&mut` of the owner.
        unsafe { slice(self.raw, self.len) }
    }

    pub(super) fn as_mut_slice(&mut self) -> &mut [f64] {
        // SAFETY: as in `as_slice`, and `&mut self` makes the access unique.
        unsafe { slice_mut(self.raw, self.len) }
    }
}

impl Drop for Vector {
    fn drop(&mut self) {
        // SAFETY: made by N_VNew_Serial and freed once.
        unsafe { ffi::N_VDestroy(self.raw) };
    }
}

/// The numbers of a vector that SUNDIALS hands to a callback.
///
/// # Safety
/// `vector` is a live serial vector of length `len`, and nobody writes to it during `'a`.
pub(super) unsafe fn slice<'a>(vector: ffi::N_Vector, len: usize) -> &'a [f64] {
    // SAFETY: the caller vouches for the vector; serial vectors are contiguous.
    unsafe { slice::from_raw_parts(ffi::N_VGetArrayPointer(vector), len) }
}

/// The numbers of a vector that a callback has to fill.
///
/// # Safety
/// `vector` is a live serial vector of length `len`, and nobody else uses it during `'a`.
pub(super) unsafe fn slice_mut<'a>(vector: ffi::N_Vector, len: usize) -> &'a mut [f64] {
    // SAFETY: the caller vouches for the vector; serial vectors are contiguous.
    unsafe { slice::from_raw_parts_mut(ffi::N_VGetArrayPointer(vector), len) }
}
