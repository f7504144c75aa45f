//! The C interface: what `sundials-sys` binds, and what `build.rs` adds (ARKODE, KLU, versions).

#![allow(
    non_upper_case_globals,
    non_camel_case_types,
    non_snake_case,
    unused_imports,
    dead_code,
    clippy::all
)]

pub use sundials_sys::*;

include!(concat!(env!("OUT_DIR"), "/sundials_extra.rs"));

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
