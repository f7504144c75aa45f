//! The simulation context that every constructor of SUNDIALS needs.

use std::ptr;

use super::ffi;
use crate::integrators::common::Error;

/// Owns one `SUNContext`. Contexts are not safe to share between threads, so each solver makes
/// its own and drops it last.
pub(super) struct Context(ffi::SUNContext);

impl Context {
    pub(super) fn new() -> Result<Self, Error> {
        let mut raw = ptr::null_mut();
        // SAFETY: `raw` is a valid place for the result; no communicator means no MPI.
        let code = unsafe { ffi::SUNContext_Create(ffi::comm_no_mpi(), &raw mut raw) };
        if code != 0 || raw.is_null() {
            return Err(Error::call("SUNContext_Create", code));
        }
        Ok(Self(raw))
    }

    pub(super) fn raw(&self) -> ffi::SUNContext {
        self.0
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: made by SUNContext_Create, freed once; every owner declares it as its last
        // SUNDIALS field, so nothing made with it is alive.
        unsafe { ffi::SUNContext_Free(&raw mut self.0) };
    }
}
