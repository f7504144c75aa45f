//! The equations for other languages: what `scipy/solve.py` calls.
//!
//! A handle is a scene and its present phase. Vectors have the lengths that [`peers_size`] and
//! [`peers_entries`] tell; callers answer for that.

use std::ffi::{CStr, c_char};
use std::ptr::null_mut;
use std::slice::{from_raw_parts, from_raw_parts_mut};

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use pliant::{Inertia, Scene};

use crate::scenes::Case;
use crate::stage::{Pattern, Stage};

/// A scene and its present phase.
pub struct Handle {
    scene: Scene,
    stage: Option<Stage>,
    /// Cholesky factor of M.
    inertia: Option<Llt<usize, f64>>,
}

/// Opens a case by name, with lumped inertia if `lumped` is not 0. NULL if there is none.
///
/// # Safety
/// `name` is a string that ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_open(name: *const c_char, lumped: i32) -> *mut Handle {
    // SAFETY: as the caller promises
    let name = unsafe { CStr::from_ptr(name) };
    let inertia = if lumped == 0 { Inertia::Consistent } else { Inertia::Lumped };
    let scene = name.to_str().ok().and_then(Case::find).and_then(|case| case.scene(inertia).ok());
    match scene {
        Some(scene) => Box::into_raw(Box::new(Handle { scene, stage: None, inertia: None })),
        None => null_mut(),
    }
}

/// Absolute tolerances of displacements (m) and velocities (m/s) that pliant has at `rtol`.
///
/// # Safety
/// `handle` comes from [`peers_open`]; there is room for two numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_tolerances(handle: *const Handle, rtol: f64, atol: *mut f64) {
    // SAFETY: as the caller promises
    let (handle, atol) = unsafe { (&*handle, from_raw_parts_mut(atol, 2)) };
    let solver = pliant::Settings { rtol, ..pliant::Settings::default() };
    let tolerances = solver.tolerances(&handle.scene);
    atol.copy_from_slice(&[tolerances.position, tolerances.velocity]);
}

/// Number of all displacement components.
///
/// # Safety
/// `handle` comes from [`peers_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_dofs(handle: *const Handle) -> usize {
    // SAFETY: as the caller promises
    unsafe { &*handle }.scene.body().dofs()
}

/// Number of phases.
///
/// # Safety
/// `handle` comes from [`peers_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_phases(handle: *const Handle) -> usize {
    // SAFETY: as the caller promises
    unsafe { &*handle }.scene.phases().len()
}

/// End of a phase (s).
///
/// # Safety
/// `handle` comes from [`peers_open`]; the scene has that phase.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_end(handle: *const Handle, phase: usize) -> f64 {
    // SAFETY: as the caller promises
    unsafe { &*handle }.scene.phases()[phase].end()
}

/// Begins a phase at the displacements `u` and velocities `v` of all nodes. Not 0 if that fails.
///
/// # Safety
/// `handle` comes from [`peers_open`], `u` and `v` have [`peers_dofs`] numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_begin(
    handle: *mut Handle,
    phase: usize,
    u: *const f64,
    v: *const f64,
) -> i32 {
    // SAFETY: as the caller promises
    let handle = unsafe { &mut *handle };
    let dofs = handle.scene.body().dofs();
    // SAFETY: as the caller promises
    let [u, v] = [u, v].map(|x| unsafe { from_raw_parts(x, dofs) });
    let Ok(stage) = Stage::new(&handle.scene, phase, u, v) else { return 1 };
    let (Pattern { columns, rows }, n) = (&stage.inertia, stage.size());
    let symbolic = SymbolicSparseColMatRef::new_checked(n, n, columns, None, rows);
    let inertia = SparseColMatRef::new(symbolic, &stage.masses).sp_cholesky(Side::Lower);
    let Ok(inertia) = inertia else { return 2 };
    (handle.stage, handle.inertia) = (Some(stage), Some(inertia));
    0
}

/// Number of free components in the present phase; 0 before the first.
///
/// # Safety
/// `handle` comes from [`peers_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_size(handle: *const Handle) -> usize {
    // SAFETY: as the caller promises
    unsafe { &*handle }.stage.as_ref().map_or(0, Stage::size)
}

/// Writes which components are free.
///
/// # Safety
/// `handle` is in a phase; there is room for [`peers_size`] numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_free(handle: *const Handle, free: *mut usize) {
    // SAFETY: as the caller promises
    let Some(stage) = &unsafe { &*handle }.stage else { return };
    // SAFETY: as the caller promises
    unsafe { from_raw_parts_mut(free, stage.size()) }.copy_from_slice(&stage.free);
}

/// Number of entries of M (`which` = 0) or the tangents (1).
///
/// # Safety
/// `handle` comes from [`peers_open`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_entries(handle: *const Handle, which: i32) -> usize {
    // SAFETY: as the caller promises
    let stage = unsafe { &*handle }.stage.as_ref();
    stage.map_or(0, |stage| pattern(stage, which).rows.len())
}

fn pattern(stage: &Stage, which: i32) -> &Pattern {
    if which == 0 { &stage.inertia } else { &stage.tangents }
}

/// Writes the starts of the columns and the rows of M (`which` = 0) or the tangents (1).
///
/// # Safety
/// `handle` is in a phase; there is room for [`peers_size`] + 1 and [`peers_entries`] numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_pattern(
    handle: *const Handle,
    which: i32,
    columns: *mut usize,
    rows: *mut usize,
) {
    // SAFETY: as the caller promises
    let Some(stage) = &unsafe { &*handle }.stage else { return };
    let pattern = pattern(stage, which);
    for (from, to) in [(&pattern.columns, columns), (&pattern.rows, rows)] {
        // SAFETY: as the caller promises
        unsafe { from_raw_parts_mut(to, from.len()) }.copy_from_slice(from);
    }
}

/// Writes the entries of M.
///
/// # Safety
/// `handle` is in a phase; there is room for [`peers_entries`] numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_masses(handle: *const Handle, masses: *mut f64) {
    // SAFETY: as the caller promises
    let Some(stage) = &unsafe { &*handle }.stage else { return };
    // SAFETY: as the caller promises
    unsafe { from_raw_parts_mut(masses, stage.masses.len()) }.copy_from_slice(&stage.masses);
}

/// Writes M^-1 f(t, u, v). Not 0 where that has no meaning.
///
/// # Safety
/// `handle` is in a phase; all vectors have [`peers_size`] numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_acceleration(
    handle: *mut Handle,
    t: f64,
    u: *const f64,
    v: *const f64,
    a: *mut f64,
) -> i32 {
    // SAFETY: as the caller promises
    let Handle { stage: Some(stage), inertia: Some(inertia), .. } = (unsafe { &mut *handle })
    else {
        return 1;
    };
    let n = stage.size();
    // SAFETY: as the caller promises
    let [u, v] = [u, v].map(|x| unsafe { from_raw_parts(x, n) });
    // SAFETY: as the caller promises
    let a = unsafe { from_raw_parts_mut(a, n) };
    if stage.forces(t, u, v, a).is_err() {
        return 2;
    }
    inertia.solve_in_place(faer::ColMut::from_slice_mut(a).as_mat_mut());
    0
}

/// Writes -df/du and -df/dv.
///
/// # Safety
/// `handle` is in a phase; states have [`peers_size`] numbers, tangents [`peers_entries`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_tangents(
    handle: *mut Handle,
    t: f64,
    u: *const f64,
    v: *const f64,
    stiffness: *mut f64,
    damping: *mut f64,
) {
    // SAFETY: as the caller promises
    let Some(stage) = &mut unsafe { &mut *handle }.stage else { return };
    let (n, entries) = (stage.size(), stage.tangents.rows.len());
    // SAFETY: as the caller promises
    let [u, v] = [u, v].map(|x| unsafe { from_raw_parts(x, n) });
    // SAFETY: as the caller promises
    let [k, d] = [stiffness, damping].map(|x| unsafe { from_raw_parts_mut(x, entries) });
    stage.write_tangents(t, u, v, k, d);
}

/// Writes the displacements and velocities of all nodes when the free ones are `u` and `v`.
///
/// # Safety
/// `handle` is in a phase; `u` and `v` have [`peers_size`] numbers, the others [`peers_dofs`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_complete(
    handle: *mut Handle,
    t: f64,
    u: *const f64,
    v: *const f64,
    all_u: *mut f64,
    all_v: *mut f64,
) {
    // SAFETY: as the caller promises
    let handle = unsafe { &mut *handle };
    let dofs = handle.scene.body().dofs();
    let Some(stage) = &mut handle.stage else { return };
    let n = stage.size();
    // SAFETY: as the caller promises
    let [u, v] = [u, v].map(|x| unsafe { from_raw_parts(x, n) });
    let all = stage.complete(t, u, v);
    for (from, to) in all.into_iter().zip([all_u, all_v]) {
        // SAFETY: as the caller promises
        unsafe { from_raw_parts_mut(to, dofs) }.copy_from_slice(from);
    }
}

/// Closes a handle.
///
/// # Safety
/// `handle` comes from [`peers_open`] and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn peers_close(handle: *mut Handle) {
    if !handle.is_null() {
        // SAFETY: as the caller promises
        drop(unsafe { Box::from_raw(handle) });
    }
}
