//! Inequality constraints: unknowns that keep their sign.

use std::{fmt, ptr};

use super::{
    ffi,
    serial::{slice, slice_mut},
};
use crate::base::input::InputError;
use crate::integrators::common::{Error, check_length};

/// The values that an unknown may have: an inequality constraint, for the option `sign_constraints`.
///
/// The numbers are those of C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Sign {
    /// All.
    Free = 0,
    /// y >= 0, such as a concentration.
    NonNegative = 1,
    /// y <= 0
    NonPositive = -1,
    /// y > 0, such as the argument of a logarithm.
    Positive = 2,
    /// y < 0
    Negative = -2,
}

impl Sign {
    pub(super) fn allows(self, y: f64) -> bool {
        match self {
            Self::Free => true,
            Self::NonNegative => y >= 0.0,
            Self::NonPositive => y <= 0.0,
            Self::Positive => y > 0.0,
            Self::Negative => y < 0.0,
        }
    }
}

impl fmt::Display for Sign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Free => "any number",
            Self::NonNegative => ">= 0",
            Self::NonPositive => "<= 0",
            Self::Positive => "> 0",
            Self::Negative => "< 0",
        })
    }
}

/// Checks that there is a sign for each unknown, if for any.
pub(super) fn check_signs(signs: &[Sign], n: usize) -> Result<(), InputError> {
    if signs.is_empty() {
        Ok(())
    } else {
        check_length("length of sign_constraints", signs.len(), n)
    }
}

/// Checks that the state `y`, given by the input of this name, has the required signs.
pub(super) fn check_state(signs: &[Sign], input: &str, y: &[f64]) -> Result<(), InputError> {
    match signs.iter().zip(y).position(|(sign, y)| !sign.allows(*y)) {
        None => Ok(()),
        Some(i) => {
            let help = format!("sign_constraints ask for {} there", signs[i]);
            Err(InputError::new(input, format!("{:?} in component {i}", y[i]), help))
        }
    }
}

/// An unknown that C found beyond its bound.
#[derive(Clone, Copy)]
pub(super) struct Violation {
    pub(super) unknown: usize,
    pub(super) value: f64,
    /// Ends of steps that were checked since.
    age: u32,
}

impl Violation {
    /// Whether it was in the step last tried, or in one of the two before. (Close to a bound that the
    /// equations cross, every other step is repeated.)
    pub(super) fn is_recent(&self) -> bool {
        self.age <= 2
    }
}

/// The content of a vector of signs: that of a serial vector, and a pointer to the last result of [`mask`]. C
/// offers no other storage for it.
#[repr(C)]
struct Content {
    serial: ffi::_N_VectorContent_Serial,
    found: *mut Option<Violation>,
}

/// Makes `vector` and all its later clones vectors of signs, for which [`mask`] stores its result in
/// `found`.
///
/// # Safety
/// `vector` is a live serial vector; `found` may be written to whenever [`mask`] gets `vector` or a clone.
pub(super) unsafe fn note_in(
    vector: ffi::N_Vector,
    found: *mut Option<Violation>,
) -> Result<(), Error> {
    // SAFETY: the content of a serial vector was allocated by malloc, as N_VDestroy frees it; where realloc
    // fails, it is still there. The operations table of a live vector is writable.
    unsafe {
        let content = libc::realloc((*vector).content, size_of::<Content>());
        if content.is_null() {
            return Err(Error::out_of_memory("realloc"));
        }
        (*content.cast::<Content>()).found = found;
        (*vector).content = content;
        (*(*vector).ops).nvclone = Some(clone);
    }
    Ok(())
}

/// `N_VClone` of vectors of signs.
unsafe extern "C" fn clone(signs: ffi::N_Vector) -> ffi::N_Vector {
    // SAFETY: SUNDIALS passes a live vector, which has this function from `note_in`, hence such a content.
    unsafe {
        let clone = ffi::N_VClone_Serial(signs);
        if clone.is_null() {
            return clone;
        }
        let found = (*(*signs).content.cast::<Content>()).found;
        if note_in(clone, found).is_err() {
            ffi::N_VDestroy(clone);
            return ptr::null_mut();
        }
        clone
    }
}

/// `N_VConstrMask` of serial vectors, which stores its result, too: writes 1 to `mask` where `y` does not
/// have the sign that `signs` requires, else 0. Returns whether all have it.
pub(super) unsafe extern "C" fn mask(
    signs: ffi::N_Vector,
    y: ffi::N_Vector,
    mask: ffi::N_Vector,
) -> i32 {
    // SAFETY: SUNDIALS passes three different live vectors of equal length, and nothing else uses them here.
    // The first is a vector of signs, as no other is registered, and its place for what is found is not used
    // during a call of C.
    let (signs, y, mask, found) = unsafe {
        let found = &mut *(*(*signs).content.cast::<Content>()).found;
        (slice(signs), slice(y), slice_mut(mask), found)
    };
    let mut first = None;
    for (i, mask) in mask.iter_mut().enumerate() {
        let product = signs[i] * y[i];
        // 1 allows zero, 2 does not
        let beyond = product < 0.0 || (signs[i].abs() > 1.5 && product == 0.0);
        *mask = f64::from(u8::from(beyond));
        if beyond && first.is_none() {
            first = Some(Violation { unknown: i, value: y[i], age: 0 });
        }
    }
    let older = |old: Violation| Violation { age: old.age.saturating_add(1), ..old };
    *found = first.or(found.map(older));
    i32::from(first.is_none())
}

/// `N_VMinQuotient` of serial vectors, for the fraction of a step at whose end the unknowns are at their
/// bounds.
///
/// CVODE forms quotients of predicted values, which may be beyond the bound itself: where that gives no
/// fraction of a step, but no quotient at all or more than one step, C would let the step grow, to infinity.
/// Half a step is taken then.
pub(super) unsafe extern "C" fn least_part(dividend: ffi::N_Vector, divisor: ffi::N_Vector) -> f64 {
    // SAFETY: SUNDIALS passes two live vectors of equal length, and nothing writes to them here.
    let (dividend, divisor) = unsafe { (slice(dividend), slice(divisor)) };
    let quotients = dividend.iter().zip(divisor).filter(|(_, d)| **d != 0.0).map(|(n, d)| n / d);
    let least = quotients.fold(f64::INFINITY, f64::min);
    if least <= 1.0 { least } else { 0.5 }
}
