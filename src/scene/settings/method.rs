//! The settings that are words: integration methods with their facts, one row for each, and how contact events are handled.

use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use crate::base::input::InputError;
use crate::scene::timeline::Scene;

/// An integration method: [`information`](Self::information) has the facts of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// Chooses one of the others for each phase, by what the phase requires; watches the energy balance while
    /// it runs, and goes on with another method if necessary. The report says what was chosen and why.
    #[default]
    Auto,
    /// CVODE, backward differentiation formulas: for stiff motion.
    CvodeBdf,
    /// CVODE, Adams-Moulton formulas: for motion that is hardly damped.
    CvodeAdams,
    /// IDA on the index-1 form, with the structured Newton matrix.
    Ida,
    /// IDA on the stabilized index-2 form (Gear, Gupta, Leimkuhler): positions and velocities meet the
    /// constraints at each step, within the tolerances, without alpha; where a phase begins, velocities jump
    /// to values that the constraints allow.
    IdaIndexTwo,
    /// ARKODE, diagonally implicit Runge-Kutta methods, L-stable: for vibrations that steps need not resolve.
    Arkode,
    /// The internal Rosenbrock methods, implicit without an iteration, L-stable: for vibrations that steps need not
    /// resolve, and for commands at equal times; with order 3 one factorization serves many commands.
    Rosenbrock,
    /// The internal explicit Runge-Kutta method, Dormand-Prince 5(4): for motion that is not stiff,
    /// and as a check of the others.
    Rk,
    /// Explicit central differences: for bodies with lumped inertia that are hardly damped.
    /// Steps are as long as stability allows, so that at a loose `rtol` errors are far below it.
    CentralDifference,
}

/// Facts of a [`Method`]. Words of scene files and flags, messages, the reference page, and lines and colours of charts
/// follow from them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct MethodInformation {
    /// Name in scene files, flags and reports.
    pub name: &'static str,
    /// The method in full.
    pub long_name: &'static str,
    /// Motion that it suits, in words.
    pub purpose: &'static str,
    /// Lowest and highest order that [`Settings::max_order`](crate::Settings::max_order) may name.
    pub orders: [u32; 2],
    /// Order, the highest of a multistep method, where none is named.
    pub default_order: Option<u32>,
    /// The form of the equations that it integrates.
    pub form: MotionForm,
    /// Whether it solves linear systems, with the Newton matrix; else stability bounds its steps.
    pub is_implicit: bool,
    /// Whether it has unknowns besides displacements and velocities: strains of Maxwell branches, amounts of gas and liquids,
    /// states of lags.
    pub has_internal_unknowns: bool,
    /// When [`Method::Auto`] takes it; empty if never.
    pub automatic: &'static str,
    /// Orders that charts compare with that by default.
    pub(crate) charted_orders: &'static [u32],
    /// Number of its colour in charts: methods of one integrator share it.
    pub(crate) colour: usize,
}

/// A form of the equations of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MotionForm {
    /// Ordinary differential equations of first order; constraints are eliminated.
    Ode,
    /// Differential-algebraic equations of index 1, multipliers among the unknowns.
    IndexOne,
    /// Stabilized differential-algebraic equations of index 2.
    IndexTwo,
    /// Ordinary differential equations of second order; constraints are eliminated.
    SecondOrder,
}

impl MotionForm {
    /// The form, in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ode => "ODE",
            Self::IndexOne => "DAE of index 1",
            Self::IndexTwo => "DAE of index 2",
            Self::SecondOrder => "ODE of second order",
        }
    }
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 9] = [
        Self::Auto,
        Self::CvodeBdf,
        Self::CvodeAdams,
        Self::Ida,
        Self::IdaIndexTwo,
        Self::Arkode,
        Self::Rosenbrock,
        Self::Rk,
        Self::CentralDifference,
    ];

    /// The facts of the method, its row.
    pub fn information(self) -> &'static MethodInformation {
        match self {
            Self::Auto => &MethodInformation {
                name: "auto",
                long_name: "automatic choice",
                purpose: "one of the others, chosen for each phase and revised while it runs",
                orders: [1, 5],
                default_order: None,
                form: MotionForm::Ode,
                is_implicit: true,
                has_internal_unknowns: true,
                automatic: "",
                charted_orders: &[],
                colour: 6,
            },
            Self::CvodeBdf => &MethodInformation {
                name: "cvode-bdf",
                long_name: "CVODE, backward differentiation formulas",
                purpose: "stiff motion: damped bodies, hard contact, fine meshes",
                orders: [1, 5],
                default_order: Some(5),
                form: MotionForm::Ode,
                is_implicit: true,
                has_internal_unknowns: true,
                automatic: "the lowest vibration is strongly damped",
                charted_orders: &[2],
                colour: 0,
            },
            Self::CvodeAdams => &MethodInformation {
                name: "cvode-adams",
                long_name: "CVODE, Adams-Moulton formulas",
                purpose: "motion that is hardly damped",
                orders: [1, 12],
                default_order: Some(12),
                form: MotionForm::Ode,
                is_implicit: true,
                has_internal_unknowns: true,
                automatic: "",
                charted_orders: &[],
                colour: 1,
            },
            Self::Ida => &MethodInformation {
                name: "ida",
                long_name: "IDA, backward differentiation formulas",
                purpose: "a check of CVODE: constraint forces are unknowns, too",
                orders: [1, 5],
                default_order: Some(5),
                form: MotionForm::IndexOne,
                is_implicit: true,
                has_internal_unknowns: true,
                automatic: "",
                charted_orders: &[],
                colour: 3,
            },
            Self::IdaIndexTwo => &MethodInformation {
                name: "ida-index-2",
                long_name: "IDA, backward differentiation formulas",
                purpose: "constraints met at each step, without alpha",
                orders: [1, 5],
                default_order: Some(5),
                form: MotionForm::IndexTwo,
                is_implicit: true,
                has_internal_unknowns: true,
                automatic: "",
                charted_orders: &[],
                colour: 3,
            },
            Self::Arkode => &MethodInformation {
                name: "arkode",
                long_name: "ARKODE, diagonally implicit Runge-Kutta methods",
                purpose: "bodies that vibrate with little damping",
                orders: [2, 5],
                default_order: Some(4),
                form: MotionForm::Ode,
                is_implicit: true,
                has_internal_unknowns: true,
                automatic: "the lowest vibration is lightly damped",
                charted_orders: &[3, 5],
                colour: 4,
            },
            Self::Rosenbrock => &MethodInformation {
                name: "rosenbrock",
                long_name: "Rosenbrock methods, linearly implicit",
                purpose: "bodies that vibrate, without iterations; commands at equal times",
                orders: [3, 4],
                default_order: Some(4),
                form: MotionForm::Ode,
                is_implicit: true,
                has_internal_unknowns: true,
                automatic: "commands change forces again and again",
                charted_orders: &[3],
                colour: 7,
            },
            Self::Rk => &MethodInformation {
                name: "rk",
                long_name: "Dormand-Prince 5(4), explicit",
                purpose: "motion that is not stiff: light damping, small alpha",
                orders: [5, 5],
                default_order: Some(5),
                form: MotionForm::Ode,
                is_implicit: false,
                has_internal_unknowns: true,
                automatic: "accuracy asks for steps little longer than its longest stable ones",
                charted_orders: &[],
                colour: 2,
            },
            Self::CentralDifference => &MethodInformation {
                name: "central-difference",
                long_name: "central differences, explicit",
                purpose: "bodies of lumped inertia without much damping",
                orders: [2, 2],
                default_order: Some(2),
                form: MotionForm::SecondOrder,
                is_implicit: false,
                has_internal_unknowns: false,
                automatic: "with lumped inertia, where its stable steps cost less",
                charted_orders: &[],
                colour: 5,
            },
        }
    }

    /// Name of the method in scene files, flags and reports.
    pub fn name(self) -> &'static str {
        self.information().name
    }

    /// Whether `max_order` chooses among several orders.
    pub(crate) fn has_orders(self) -> bool {
        let [lowest, highest] = self.information().orders;
        lowest < highest
    }

    /// The first method of the same colour in charts.
    pub(crate) fn family(self) -> Self {
        let colour = self.information().colour;
        let shares_it = |method: &Self| method.information().colour == colour;
        Self::ALL.into_iter().find(shares_it).unwrap_or(self)
    }

    /// Names of the methods that `suits`, for messages.
    pub(crate) fn names(suits: impl Fn(&MethodInformation) -> bool) -> String {
        let rows = Self::ALL.into_iter().map(Self::information).filter(|row| suits(row));
        rows.map(|row| row.name).collect::<Vec<_>>().join(", ")
    }

    /// Reason for which it has no equations for a scene, if it has none.
    pub(crate) fn why_not(self, scene: &Scene) -> Option<&'static str> {
        if self.information().has_internal_unknowns {
            return None;
        }
        if !scene.orifices().is_empty() {
            Some(
                "it has no unknowns for the amounts of gas that flow through orifices: take another method, or auto",
            )
        } else if scene.pours() {
            Some(
                "it has no unknowns for the amounts of liquids that flow into chambers or through pipes: take another method, or auto",
            )
        } else if scene.lags().len() > 0 {
            Some(
                "it has no unknowns for the states of actuators that lag: take another method, or auto",
            )
        } else {
            None
        }
    }

    /// A scene as it has equations for it: with constant amounts of gas and liquids where it has no unknowns for them.
    pub(crate) fn equations_of(self, scene: &Scene) -> Cow<'_, Scene> {
        let is_constant = scene.orifices().is_empty() && !scene.pours();
        match self.information().has_internal_unknowns || !is_constant {
            true => Cow::Borrowed(scene),
            false => scene.with_fixed_amounts(),
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
            let help = format!("it is one of {}", Self::names(|_| true));
            InputError::new("method", format!("\"{name}\""), help)
        })
    }
}

/// Treatment of contact events: nodes touch an obstacle or leave it, and with friction stick or slip.
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
