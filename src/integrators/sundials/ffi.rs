//! The C interface: the bindings of `sundials-sys`, and declarations that it lacks.

pub use sundials_sys::*;

pub use super::arkode_ffi::*;

/// The code of a linear solver for a failure that no retry mends, by its name in SUNDIALS 6.
#[cfg(not(sundials_major = "6"))]
pub const SUNLS_PACKAGE_FAIL_UNREC: i32 = SUN_ERR_EXT_FAIL;

// The layer hands `&[f64]` and `&[i64]` to C: both assumptions are checked here.
const _: () = {
    let _: fn(realtype) -> f64 = |x| x;
    let _: fn(sunindextype) -> i64 = |i| i;
    assert!(
        cfg!(sundials_major = "6") == (SUNDIALS_VERSION_MAJOR == 6),
        "two versions of SUNDIALS"
    );
};
