//! Standard systems of equations without bodies, for pliant, diffsol and, through [`crate::system_ffi`], SciPy.

use pliant::ode::{Boxed, Ode};
use pliant::samples::{
    Brusselator, HeatedSquare, Hires, Oregonator, Pollution, Reference, Robertson,
    TransistorAmplifier, VanDerPol,
};
use pliant::sundials::Pattern;

/// A system y' = f(t, y) from t = 0, or M y' = f(t, y) with a dense matrix M.
pub struct System {
    pub title: &'static str,
    pub y0: Vec<f64>,
    /// The end.
    pub t: f64,
    /// The state there, and its relative error; none if it has to be computed.
    pub truth: Option<(Vec<f64>, f64)>,
    /// Where the Jacobian may be nonzero; none if it is dense.
    pub pattern: Option<Pattern>,
    /// Diagonals on either side of the main one, of a band.
    pub half_band: Option<usize>,
    make: Box<dyn Fn() -> Box<dyn Ode>>,
}

/// All of them.
pub const NAMES: [&str; 8] = [
    "hires",
    "robertson",
    "van-der-pol",
    "oregonator",
    "pollution",
    "transistor-amplifier",
    "brusselator",
    "heated-square",
];

impl System {
    /// The one of this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Some(match name {
            "hires" => Self::small("HIRES", Hires::new(), &Hires::Y0, Hires::REFERENCE),
            "robertson" => {
                Self::small("Robertson", Robertson::new(), &Robertson::Y0, Robertson::REFERENCE)
            }
            "van-der-pol" => {
                Self::small("Van der Pol", VanDerPol::new(), &VanDerPol::Y0, VanDerPol::REFERENCE)
            }
            "oregonator" => {
                Self::small("Oregonator", Oregonator::new(), &Oregonator::Y0, Oregonator::REFERENCE)
            }
            "pollution" => {
                Self::small("Pollution", Pollution::new(), &Pollution::Y0, Pollution::REFERENCE)
            }
            "transistor-amplifier" => Self::small(
                "Transistor amplifier",
                TransistorAmplifier,
                &TransistorAmplifier::Y0,
                TransistorAmplifier::REFERENCE,
            ),
            "brusselator" => {
                let system = Brusselator::new(500);
                Self {
                    title: "Brusselator, 1000 unknowns",
                    y0: system.y0(),
                    t: 10.0,
                    truth: None,
                    pattern: Some(system.pattern().clone()),
                    half_band: Some(Brusselator::BANDWIDTH),
                    make: Box::new(move || Box::new(system.clone())),
                }
            }
            "heated-square" => {
                let system = HeatedSquare::new(100);
                Self {
                    title: "Heated square, 10 000 unknowns",
                    y0: system.exact(0.0),
                    t: 0.1,
                    truth: Some((system.exact(0.1), 1e-13)),
                    pattern: Some(system.pattern().clone()),
                    half_band: Some(100),
                    make: Box::new(move || Box::new(system.clone())),
                }
            }
            _ => return None,
        })
    }

    fn small(
        title: &'static str,
        system: impl Ode + Clone + 'static,
        y0: &[f64],
        Reference { t, y, digits, .. }: Reference,
    ) -> Self {
        Self {
            title,
            y0: y0.to_vec(),
            t,
            truth: Some((y.to_vec(), 10_f64.powi(-(digits as i32)))),
            pattern: None,
            half_band: None,
            make: Box::new(move || Box::new(system.clone())),
        }
    }

    /// The equations.
    #[must_use]
    pub fn ode(&self) -> Boxed<dyn Ode> {
        Boxed((self.make)())
    }
}
