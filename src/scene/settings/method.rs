//! The settings that are words: integration methods, and how contact events are handled.

use std::borrow::Cow;
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use crate::base::input::InputError;
use crate::scene::timeline::Scene;

/// An integration method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// Chooses one of the others for each phase, by what the phase requires; watches the energy balance while
    /// it runs, and goes on with another method if necessary. The report says what was chosen and why.
    #[default]
    Auto,
    /// CVODE, backward differentiation formulas of order 1 to 5: for stiff motion.
    CvodeBdf,
    /// CVODE, Adams-Moulton formulas of order 1 to 12: for motion that is hardly damped.
    CvodeAdams,
    /// IDA on the index-1 form, with the structured Newton matrix.
    Ida,
    /// IDA on the index-1 form, with KLU on the sparse Jacobian of the whole system.
    IdaKlu,
    /// IDA on the stabilized index-2 form (Gear, Gupta, Leimkuhler): positions and velocities meet the
    /// constraints at each step, within the tolerances, without alpha; where a phase begins, velocities jump
    /// to values that the constraints allow.
    IdaIndexTwo,
    /// ARKODE, diagonally implicit Runge-Kutta methods of order 2 to 5, L-stable: for vibrations that steps
    /// need not resolve. `max_order` is their order; default: 4.
    Arkode,
    /// The internal Rosenbrock methods of order 3 and 4, implicit without an iteration, L-stable: for
    /// vibrations that steps need not resolve, and for commands at equal times. `max_order` is their order; default: 4; with 3
    /// one factorization serves many commands.
    Rosenbrock,
    /// The internal explicit Runge-Kutta method, Dormand-Prince 5(4): for motion that is not stiff,
    /// and as a check of the others.
    Rk,
    /// Explicit central differences, order 2: for bodies with lumped inertia that are hardly damped.
    /// Steps are as long as stability allows, so that at a loose `rtol` errors are far below it.
    CentralDifference,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 10] = [
        Self::Auto,
        Self::CvodeBdf,
        Self::CvodeAdams,
        Self::Ida,
        Self::IdaKlu,
        Self::IdaIndexTwo,
        Self::Arkode,
        Self::Rosenbrock,
        Self::Rk,
        Self::CentralDifference,
    ];

    /// Whether it integrates bodies with [Maxwell branches](crate::MaxwellBranch).
    pub(crate) fn takes_branches(self) -> bool {
        !matches!(self, Self::IdaKlu | Self::CentralDifference)
    }

    /// Name of the method: `auto`, `cvode-bdf`, `cvode-adams`, `ida`, `ida-klu`,
    /// `ida-index-2`, `arkode`, `rosenbrock`, `rk`, `central-difference`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::CvodeBdf => "cvode-bdf",
            Self::CvodeAdams => "cvode-adams",
            Self::Ida => "ida",
            Self::IdaKlu => "ida-klu",
            Self::IdaIndexTwo => "ida-index-2",
            Self::Arkode => "arkode",
            Self::Rosenbrock => "rosenbrock",
            Self::Rk => "rk",
            Self::CentralDifference => "central-difference",
        }
    }

    /// Why it has no equations for what is in a scene, if it has none.
    pub(crate) fn why_not(self, scene: &Scene) -> Option<&'static str> {
        match self {
            Self::IdaKlu if !scene.touches().is_empty() => Some(
                "its Jacobian has a fixed pattern, and bodies that touch couple ever other nodes: take ida",
            ),
            Self::IdaKlu | Self::CentralDifference if !scene.orifices().is_empty() => Some(
                "it has no unknowns for the amounts of gas that flow through orifices: take another method, or auto",
            ),
            Self::IdaKlu | Self::CentralDifference if scene.pours() => Some(
                "it has no unknowns for the amounts of liquids that flow into chambers or through pipes: take another method, or auto",
            ),
            Self::IdaKlu | Self::CentralDifference if scene.lags().len() > 0 => Some(
                "it has no unknowns for the states of actuators that lag: take another method, or auto",
            ),
            _ => None,
        }
    }

    /// A scene as it has equations for it: with constant amounts of gas and liquids where it has no unknowns for them.
    pub(crate) fn equations_of(self, scene: &Scene) -> Cow<'_, Scene> {
        match self {
            Self::IdaKlu | Self::CentralDifference
                if scene.orifices().is_empty() && !scene.pours() =>
            {
                scene.with_fixed_amounts()
            }
            _ => Cow::Borrowed(scene),
        }
    }

    /// Purpose of the method, in words.
    pub fn purpose(self) -> &'static str {
        match self {
            Self::Auto => {
                "choosing one of the others for each phase, by what it asks for and how it goes"
            }
            Self::CvodeBdf => {
                "stiff motion: damped bodies, hard contact, fine meshes (CVODE, BDF of order 1 to 5)"
            }
            Self::CvodeAdams => {
                "motion that is hardly damped (CVODE, Adams-Moulton of order 1 to 12)"
            }
            Self::Ida => {
                "a check of CVODE: constraint forces are unknowns, too (IDA on the index-1 form)"
            }
            Self::IdaKlu => {
                "a check of the structured linear solver: IDA with KLU on the whole Jacobian"
            }
            Self::IdaIndexTwo => {
                "constraints met at each step, without alpha (IDA on the stabilized index-2 form)"
            }
            Self::Arkode => {
                "bodies that vibrate with little damping (ARKODE, diagonally implicit, order 2 to 5)"
            }
            Self::Rosenbrock => {
                "bodies that vibrate, without iterations (Rosenbrock methods, linearly implicit, order 3 and 4)"
            }
            Self::Rk => {
                "motion that is not stiff: light damping, small alpha (Dormand-Prince 5(4))"
            }
            Self::CentralDifference => {
                "bodies of lumped inertia without much damping (explicit central differences)"
            }
        }
    }

    pub(super) fn orders(self) -> RangeInclusive<u32> {
        match self {
            Self::CvodeAdams => 1..=12,
            Self::Arkode => 2..=5,
            Self::Rosenbrock => 3..=4,
            _ => 1..=5,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = InputError;

    fn from_str(name: &str) -> Result<Self, InputError> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
            let known = Self::ALL.map(Self::name).join(", ");
            InputError::new("method", format!("\"{name}\""), format!("it is one of {known}"))
        })
    }
}

/// How contact events are handled: nodes touch an obstacle or leave it, and with friction stick or slip.
///
/// Those of a [`Touch`](crate::Touch) are always stepped over: its barrier has no kink.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactEvents {
    /// Locates them where that is faster: [`Method::Auto`] does so while it uses explicit Runge-Kutta, and
    /// with implicit methods if `rtol` is below 1e-6; if the user chose a method, they are stepped over.
    #[default]
    Auto,
    /// Steps go over them; the error control makes those steps small.
    StepOver,
    /// Each is located, a step ends there, and the integration starts anew.
    Locate,
}

impl ContactEvents {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Auto, Self::StepOver, Self::Locate];

    /// `auto`, `step-over` or `locate`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::StepOver => "step-over",
            Self::Locate => "locate",
        }
    }
}

impl fmt::Display for ContactEvents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for ContactEvents {
    type Err = InputError;

    fn from_str(name: &str) -> Result<Self, InputError> {
        Self::ALL.into_iter().find(|way| way.name() == name).ok_or_else(|| {
            let known = Self::ALL.map(Self::name).join(", ");
            InputError::new(
                "contact_events",
                format!("\"{name}\""),
                format!("it is one of {known}"),
            )
        })
    }
}
