//! Step size controllers of ARKODE, by the errors of the last steps.

use std::ffi::c_void;

use crate::integrators::sundials::ffi;

/// Chooses the size of the next step from the estimated errors and the sizes of the last ones.
///
/// User guide: "Using ARKODE", time step adaptivity; the digital filters: G. Soederlind, Digital filters in adaptive
/// time-stepping, ACM TOMS 29 (2003), table I.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Controller {
    /// By the last three errors (`ARKStepSetAdaptivityMethod` with 0), the default of ARKODE.
    Pid,
    /// By the last two errors.
    Pi,
    /// By the last error.
    I,
    /// Gustafsson's for explicit methods, by the last two errors.
    ExplicitGustafsson,
    /// Gustafsson's for implicit methods, by the last two errors and step sizes.
    ImplicitGustafsson,
    /// The smaller step of Gustafsson's two.
    ImExGustafsson,
    /// The filter H211b with b = 4 (`ARKStepSetAdaptivityFn`): smooth step sizes.
    H211,
    /// The filter H0211, which answers at once.
    H0211,
    /// The filter H312b with b = 8: the smoothest step sizes.
    H312,
    /// The filter H0321, which answers at once and follows trends.
    H0321,
}

/// Exponents of the last three errors, times the order of the error estimate, and of the last two ratios of step sizes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Filter {
    errors: [f64; 3],
    ratios: [f64; 2],
    /// Factor of the errors, if C does not apply it.
    pub(super) bias: f64,
}

impl Controller {
    /// The controller of ARKODE, by its number, or the filter to be given to it.
    pub(super) fn method(self) -> Result<i32, Filter> {
        let filter = |errors, ratios| Err(Filter { errors, ratios, bias: 1.0 });
        match self {
            Self::Pid => Ok(0),
            Self::Pi => Ok(1),
            Self::I => Ok(2),
            Self::ExplicitGustafsson => Ok(3),
            Self::ImplicitGustafsson => Ok(4),
            Self::ImExGustafsson => Ok(5),
            Self::H211 => filter([0.25, 0.25, 0.0], [-0.25, 0.0]),
            Self::H0211 => filter([0.5, 0.5, 0.0], [-0.5, 0.0]),
            Self::H312 => filter([0.125, 0.25, 0.125], [-0.375, -0.125]),
            Self::H0321 => filter([1.25, 0.5, -0.75], [0.25, 0.75]),
        }
    }
}

/// `ARKAdaptFn`: applies the [`Filter`] that is its data. Sizes and errors are those of the last three steps, the latest
/// first; sizes are 0 where there was none.
pub(super) unsafe extern "C" fn filtered_step(
    _y: ffi::N_Vector,
    _t: f64,
    h: f64,
    h_before: f64,
    h_first: f64,
    error: f64,
    error_before: f64,
    error_first: f64,
    _order: i32,
    embedded_order: i32,
    new: *mut f64,
    data: *mut c_void,
) -> i32 {
    // SAFETY: the data is the filter that was registered, which outlives the memory; the result pointer is valid.
    let (filter, new) = unsafe { (&*data.cast::<Filter>(), &mut *new) };
    let errors = [error, error_before, error_first];
    let order = f64::from(embedded_order + 1);
    *new = h;
    for (error, exponent) in errors.into_iter().zip(filter.errors) {
        *new *= (filter.bias * error).max(1e-10).powf(-exponent / order);
    }
    for ((h, before), exponent) in
        [(h, h_before), (h_before, h_first)].into_iter().zip(filter.ratios)
    {
        if before != 0.0 {
            *new *= (h / before).powf(exponent);
        }
    }
    0
}
