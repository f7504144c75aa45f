//! The multirate methods that come with ARKODE.

use crate::integrators::sundials::ffi;

/// A multirate method, by the table that couples slow stages with the fast part.
///
/// User guide: "Using ARKODE", MRIStep coupling tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Coupling {
    /// Explicit slow part, order 3: the multirate infinitesimal step method of Knoth and Wolke (`MIS_KW3`).
    MisKw3,
    /// Explicit slow part, order 3 (`MRI_GARK_ERK33a`).
    Erk33a,
    /// Explicit slow part, order 4 (`MRI_GARK_ERK45a`).
    Erk45a,
    /// Implicit slow part, order 2 (`MRI_GARK_IRK21a`).
    Irk21a,
    /// Implicit slow part, order 3 (`MRI_GARK_ESDIRK34a`).
    Esdirk34a,
    /// Implicit slow part, order 4 (`MRI_GARK_ESDIRK46a`).
    Esdirk46a,
    /// Slow part split into an implicit and an explicit one, order 3 (`IMEX_MRI_GARK3a`).
    ImEx3a,
    /// The same, order 3 (`IMEX_MRI_GARK3b`).
    ImEx3b,
    /// The same, order 4 (`IMEX_MRI_GARK4`).
    ImEx4,
}

impl Coupling {
    /// Order of the method, if that of the fast part is no lower.
    #[must_use]
    pub fn order(self) -> u32 {
        match self {
            Self::Irk21a => 2,
            Self::MisKw3 | Self::Erk33a | Self::Esdirk34a | Self::ImEx3a | Self::ImEx3b => 3,
            Self::Erk45a | Self::Esdirk46a | Self::ImEx4 => 4,
        }
    }

    /// Whether slow stages are equations to be solved.
    #[must_use]
    pub fn is_implicit(self) -> bool {
        !matches!(self, Self::MisKw3 | Self::Erk33a | Self::Erk45a)
    }

    /// Whether the slow part is [split](crate::integrators::ode::Ode::is_split).
    #[must_use]
    pub fn is_imex(self) -> bool {
        matches!(self, Self::ImEx3a | Self::ImEx3b | Self::ImEx4)
    }

    /// Its number in C.
    pub(super) fn id(self) -> i32 {
        match self {
            Self::MisKw3 => ffi::ARKODE_MIS_KW3,
            Self::Erk33a => ffi::ARKODE_MRI_GARK_ERK33a,
            Self::Erk45a => ffi::ARKODE_MRI_GARK_ERK45a,
            Self::Irk21a => ffi::ARKODE_MRI_GARK_IRK21a,
            Self::Esdirk34a => ffi::ARKODE_MRI_GARK_ESDIRK34a,
            Self::Esdirk46a => ffi::ARKODE_MRI_GARK_ESDIRK46a,
            Self::ImEx3a => ffi::ARKODE_IMEX_MRI_GARK3a,
            Self::ImEx3b => ffi::ARKODE_IMEX_MRI_GARK3b,
            Self::ImEx4 => ffi::ARKODE_IMEX_MRI_GARK4,
        }
    }
}
