//! Systems of equations for other languages: what `scipy/equations.py` calls.
//!
//! Callers answer for the lengths of vectors: that of the state is what [`peers_system_size`] tells, and of the values of a
//! Jacobian what [`peers_system_entries`] tells.

use std::ffi::{CStr, c_char};
use std::ptr::null_mut;
use std::slice::{from_raw_parts, from_raw_parts_mut};

use faer::MatMut;
use pliant::ode::{Boxed, Ode};

use crate::systems::System;

/// A system and its equations at work.
pub struct Handle {
    system: System,
    ode: Boxed<dyn Ode>,
}

/// Opens a system by name. NULL if there is none.
///
/// # Safety
/// `name` is a string that ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_open(name: *const c_char) -> *mut Handle {
    // SAFETY: as the caller promises
    let name = unsafe { CStr::from_ptr(name) };
    match name.to_str().ok().and_then(System::find) {
        Some(system) => Box::into_raw(Box::new(Handle { ode: system.ode(), system })),
        None => null_mut(),
    }
}

/// Number of unknowns.
///
/// # Safety
/// `handle` comes from [`peers_system_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_size(handle: *const Handle) -> usize {
    // SAFETY: as the caller promises
    unsafe { &*handle }.system.y0.len()
}

/// End of the integration.
///
/// # Safety
/// `handle` comes from [`peers_system_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_end(handle: *const Handle) -> f64 {
    // SAFETY: as the caller promises
    unsafe { &*handle }.system.t
}

/// Diagonals on either side of the main one; -1 if the Jacobian is no band.
///
/// # Safety
/// `handle` comes from [`peers_system_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_half_band(handle: *const Handle) -> i64 {
    // SAFETY: as the caller promises
    unsafe { &*handle }.system.half_band.map_or(-1, |half| half as i64)
}

/// Writes the state at the start.
///
/// # Safety
/// `handle` comes from [`peers_system_open`]; there is room for [`peers_system_size`] numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_start(handle: *const Handle, y0: *mut f64) {
    // SAFETY: as the caller promises
    let system = &unsafe { &*handle }.system;
    // SAFETY: as the caller promises
    unsafe { from_raw_parts_mut(y0, system.y0.len()) }.copy_from_slice(&system.y0);
}

/// Writes f(t, y) into `f`. Not 0 if that fails.
///
/// # Safety
/// `handle` comes from [`peers_system_open`]; `y` and `f` have [`peers_system_size`] numbers and do not overlap.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_rhs(
    handle: *mut Handle,
    t: f64,
    y: *const f64,
    f: *mut f64,
) -> i32 {
    // SAFETY: as the caller promises
    let Handle { system, ode } = unsafe { &mut *handle };
    let n = system.y0.len();
    // SAFETY: as the caller promises
    let (y, f) = unsafe { (from_raw_parts(y, n), from_raw_parts_mut(f, n)) };
    i32::from(ode.rhs(t, y, f).is_err())
}

/// Number of values of the Jacobian: those of its pattern, or all of a dense one.
///
/// # Safety
/// `handle` comes from [`peers_system_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_entries(handle: *const Handle) -> usize {
    // SAFETY: as the caller promises
    let system = &unsafe { &*handle }.system;
    let n = system.y0.len();
    system.pattern.as_ref().map_or(n * n, pliant::sundials::Pattern::entry_count)
}

/// Writes the pattern of a sparse Jacobian: ends of columns, rows. Not 0 if it is dense.
///
/// # Safety
/// `handle` comes from [`peers_system_open`]; there is room for one number more than unknowns, and for
/// [`peers_system_entries`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_pattern(
    handle: *const Handle,
    columns: *mut i64,
    rows: *mut i64,
) -> i32 {
    // SAFETY: as the caller promises
    let system = &unsafe { &*handle }.system;
    let Some(pattern) = &system.pattern else { return 1 };
    let (n, entries) = (system.y0.len(), pattern.entry_count());
    // SAFETY: as the caller promises
    let (columns, rows) =
        unsafe { (from_raw_parts_mut(columns, n + 1), from_raw_parts_mut(rows, entries)) };
    columns.copy_from_slice(pattern.column_pointers());
    rows.copy_from_slice(pattern.row_indices());
    0
}

/// Writes the values of the Jacobian at (t, y): column by column. Not 0 if that fails.
///
/// # Safety
/// `handle` comes from [`peers_system_open`]; `y` and `f` have [`peers_system_size`] numbers, and there is room for
/// [`peers_system_entries`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_system_jacobian(
    handle: *mut Handle,
    t: f64,
    y: *const f64,
    values: *mut f64,
) -> i32 {
    // SAFETY: as the caller promises
    let Handle { system, ode } = unsafe { &mut *handle };
    let n = system.y0.len();
    let entries = system.pattern.as_ref().map_or(n * n, pliant::sundials::Pattern::entry_count);
    // SAFETY: as the caller promises
    let (y, values) = unsafe { (from_raw_parts(y, n), from_raw_parts_mut(values, entries)) };
    values.fill(0.0);
    // none of the systems uses f in its Jacobian
    let done = match system.pattern {
        Some(_) => ode.sparse_jacobian(t, y, y, values),
        None => ode.dense_jacobian(t, y, y, MatMut::from_column_major_slice_mut(values, n, n)),
    };
    i32::from(done.is_err())
}
