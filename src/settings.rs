//! How a scene is integrated: method, tolerances, limits.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use crate::body::Body;
use crate::input::{InputError, positive};

/// An integration method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// Chooses one of the others for each phase, by what the phase asks for; looks at the energy
    /// balance while it runs, and goes on with another method if need be. The report says what
    /// was chosen and why.
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
    /// constraints at each step, within the tolerances, without alpha; velocities jump to what they allow
    /// where a phase begins.
    IdaIndexTwo,
    /// ARKODE, diagonally implicit Runge-Kutta methods of order 2 to 5, L-stable: for vibrations that
    /// steps may go over. `max_order` is their order; default: 4.
    Arkode,
    /// The internal explicit Runge-Kutta method, Dormand-Prince 5(4): for motion that is not stiff,
    /// and as a check of the others.
    Rk,
    /// Explicit central differences, order 2: for bodies with lumped inertia that are hardly damped.
    /// Steps are as long as stability allows, so that at a loose `rtol` errors are far below it.
    CentralDifference,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 9] = [
        Self::Auto,
        Self::CvodeBdf,
        Self::CvodeAdams,
        Self::Ida,
        Self::IdaKlu,
        Self::IdaIndexTwo,
        Self::Arkode,
        Self::Rk,
        Self::CentralDifference,
    ];

    /// Name of the method: `auto`, `cvode-bdf`, `cvode-adams`, `ida`, `ida-klu`,
    /// `ida-index-2`, `arkode`, `rk`, `central-difference`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::CvodeBdf => "cvode-bdf",
            Self::CvodeAdams => "cvode-adams",
            Self::Ida => "ida",
            Self::IdaKlu => "ida-klu",
            Self::IdaIndexTwo => "ida-index-2",
            Self::Arkode => "arkode",
            Self::Rk => "rk",
            Self::CentralDifference => "central-difference",
        }
    }

    /// What it is for.
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
            Self::Rk => {
                "motion that is not stiff: light damping, small alpha (Dormand-Prince 5(4))"
            }
            Self::CentralDifference => {
                "bodies of lumped inertia without much damping (explicit central differences)"
            }
        }
    }

    fn orders(self) -> RangeInclusive<u32> {
        match self {
            Self::CvodeAdams => 1..=12,
            Self::Arkode => 2..=5,
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

/// How contact events are met: nodes that touch an obstacle or leave it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ContactEvents {
    /// Where it is faster: [`Method::Auto`] locates them while it is explicit Runge-Kutta, and with implicit methods
    /// if `rtol` is below 1e-6; where a method was asked for, they are stepped over.
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

/// How a scene is integrated.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Integration method. Default: [`Method::Auto`].
    pub method: Method,
    /// Relative tolerance, above 0 and below 1: the local error of each step is kept below
    /// `rtol |y| + atol` in the root mean square over displacements and velocities. Default: 1e-5.
    pub rtol: f64,
    /// Absolute tolerance of displacements (m). Default: rtol times a hundredth of the body's size,
    /// so that smaller displacements count as that large.
    pub atol_position: Option<f64>,
    /// Absolute tolerance of velocities (m/s). Default: rtol times a hundredth of the speed of
    /// waves in the body, its displacements' counterpart in a vibration.
    pub atol_velocity: Option<f64>,
    /// Rate alpha (1/s) at which errors of the constraints decay, above 0. Default: 1e3. Larger
    /// means less drift; it costs the implicit methods and central differences nothing, `rk` a step
    /// of 3.3/alpha.
    pub alpha: f64,
    /// Highest order of a multistep method (default: 5, Adams: 12); order of ARKODE's (default: 4).
    pub max_order: Option<u32>,
    /// Whether CVODE's BDF looks out for steps that its orders above 2 make unstable, and lowers the
    /// order then (`CVodeSetStabLimDet`). It helps some lightly damped vibrations, not undamped
    /// ones. Default: no.
    pub stability_limit_detection: bool,
    /// Whether contact events are located. Default: where that is faster for the accuracy.
    pub contact_events: ContactEvents,
    /// Longest step (s), above 0. Default: none. Error control needs no bound, and no step leads
    /// through an obstacle; this is for forces that come and go between two steps.
    pub max_step: Option<f64>,
    /// Steps that one phase may take. Default: 10 million, a guard against runs without end.
    pub max_steps: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            rtol: 1e-5,
            atol_position: None,
            atol_velocity: None,
            alpha: 1e3,
            max_order: None,
            stability_limit_detection: false,
            contact_events: ContactEvents::default(),
            max_step: None,
            max_steps: 10_000_000,
        }
    }
}

impl Settings {
    /// Checks what can be known before anything is run.
    ///
    /// # Errors
    /// The first number out of its range.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(self.rtol > 0.0 && self.rtol < 1.0) {
            let mend = "it must lie above 0 and below 1 (1e-3 is rough, 1e-8 fine)";
            return Err(InputError::new("rtol", self.rtol, mend));
        }
        positive("alpha", self.alpha, "1/s")?;
        self.atol_position.map_or(Ok(1.0), |atol| positive("atol_position", atol, "m"))?;
        self.atol_velocity.map_or(Ok(1.0), |atol| positive("atol_velocity", atol, "m/s"))?;
        self.max_step.map_or(Ok(1.0), |step| positive("max_step", step, "s"))?;
        let orders = self.method.orders();
        match self.max_order {
            Some(order) if matches!(self.method, Method::Rk | Method::CentralDifference) => {
                let mend = format!("{} has one order only: leave it out", self.method);
                Err(InputError::new("max_order", order, mend))
            }
            Some(order) if !orders.contains(&order) => {
                let (lowest, highest) = (orders.start(), orders.end());
                let mend = format!("{} has the orders {lowest} to {highest}", self.method);
                Err(InputError::new("max_order", order, mend))
            }
            _ if self.stability_limit_detection
                && !matches!(self.method, Method::Auto | Method::CvodeBdf) =>
            {
                let mend = format!("{} has no such limits: leave it out", self.method);
                Err(InputError::new("stability_limit_detection", true, mend))
            }
            _ if self.max_steps == 0 => {
                Err(InputError::new("max_steps", 0, "allow one step at least"))
            }
            _ => Ok(()),
        }
    }

    /// The absolute tolerances in force for `body`.
    pub fn tolerances(&self, body: &Body) -> Tolerances {
        const SMALL_STRAIN: f64 = 0.01;
        let (size, young) = (body.mesh().size(), body.material().young);
        let volume = body.volume();
        let position = self.rtol * SMALL_STRAIN * size;
        let velocity = self.rtol * SMALL_STRAIN * body.material().wave_speed();
        Tolerances {
            position: self.atol_position.unwrap_or(position),
            velocity: self.atol_velocity.unwrap_or(velocity),
            energy: self.rtol * young * volume,
            force: self.rtol * young * volume / size,
            momentum: self.rtol * young * volume / body.material().wave_speed(),
        }
    }
}

/// Absolute tolerances in force.
///
/// Those of the energies and of the multipliers are loose (as if strain were 1):
/// enough that the Newton iteration looks after them, too little for them to rule the steps.
#[derive(Debug, Clone, Copy)]
pub struct Tolerances {
    /// Displacements (m).
    pub position: f64,
    /// Velocities (m/s).
    pub velocity: f64,
    /// Energies dissipated and supplied (J).
    pub(crate) energy: f64,
    /// Multipliers (N).
    pub(crate) force: f64,
    /// Multipliers of positions in the form of index 2 (kg m/s).
    pub(crate) momentum: f64,
}
