//! Orifices: how much gas flows for which pressures (ISO 6358-1, *Pneumatic fluid power - Determination of flow-rate
//! characteristics of components using compressible fluids*).
//!
//! The root of ISO 6358 has an infinite slope at equal pressures; the cubic in its place, above a ratio of
//! 0.999, has one of 79 times (b = 0.5) the choked flow over the pressure.

use super::{GAS_CONSTANT_TIMES_TEMPERATURE, GasInChamber};
use crate::base::input::{InputError, positive};
use crate::integrators::ode::Failure;
use crate::scene::forces::Signal;

/// An orifice or a valve, through which gas flows from a [supply](crate::Scene::supply), the atmosphere or a chamber to
/// another one, in both directions.
///
/// From the absolute pressure p_1 to the lower p_2 flow
///
/// ```text
/// q = C rho_0 p_1 sqrt(T_0/T_1) sqrt(1 - ((p_2/p_1 - b)/(1 - b))^2)  (kg/s),
/// ```
///
/// without the last root (choked) if p_2/p_1 is below the critical ratio b, and with a cubic in place of it where
/// p_2/p_1 is above 0.999, whose slope is finite. C is the sonic conductance (m^3/(s Pa): 1e-8 are 0.6 l/min for each bar;
/// a short nozzle has some 2e-3 times its area in m^2), rho_0 = 1.185 kg/m^3 and T_0 = 293.15 K those of the reference.
///
/// A [nozzle](Self::nozzle) of the area A has the flow of an ideal gas of exponent k = 1.4 without losses up to its narrowest section (A. J. C. B. de Saint-Venant,
/// L. Wantzel, Journal de l'Ecole Royale Polytechnique 27 (1839) 85-122), times a coefficient of discharge C_d,
///
/// ```text
/// q = C_d A p_1/sqrt(R T_1) sqrt(2 k/(k - 1) (r^(2/k) - r^((k + 1)/k))),   r = p_2/p_1, but not below (2/(k + 1))^(k/(k - 1)) = 0.528,
/// ```
///
/// with a cubic above 0.999, too.
/// [Phases](crate::Phase::open) set its opening.
#[derive(Debug, Clone)]
pub struct Orifice {
    pub(crate) name: String,
    pub(crate) ends: [String; 2],
    opening: Opening,
    critical_ratio: f64,
}

/// How large it is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Opening {
    /// C (m^3/(s Pa))
    Conductance(f64),
    /// A (m^2) and C_d.
    Nozzle(f64, f64),
}

impl Orifice {
    /// An orifice of a sonic `conductance` C (m^3/(s Pa)) between two ends, each the name of a supply, of a chamber with
    /// gas, or `atmosphere`.
    pub fn new(
        name: impl Into<String>,
        from: impl Into<String>,
        to: impl Into<String>,
        conductance: f64,
    ) -> Self {
        let ends = [from.into(), to.into()];
        let opening = Opening::Conductance(conductance);
        Self { name: name.into(), ends, opening, critical_ratio: 0.5 }
    }

    /// A nozzle of an `area` A (m^2) between two ends, as those of [`new`](Self::new), without losses.
    pub fn nozzle(
        name: impl Into<String>,
        from: impl Into<String>,
        to: impl Into<String>,
        area: f64,
    ) -> Self {
        Self { opening: Opening::Nozzle(area, 1.0), ..Self::new(name, from, to, 0.0) }
    }

    /// Coefficient of discharge C_d of a nozzle, above 0 and up to 1: some 0.95 of one that is round, 0.6 to 0.85 of a hole with sharp edges. Default: 1.
    pub fn discharge(mut self, coefficient: f64) -> Self {
        if let Opening::Nozzle(_, discharge) = &mut self.opening {
            *discharge = coefficient;
        }
        self
    }

    /// Critical ratio b of pressures, from 0 to below 1. Default: 0.5. A nozzle has its own.
    pub fn critical_ratio(mut self, ratio: f64) -> Self {
        self.critical_ratio = ratio;
        self
    }

    /// Name of the orifice.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// An orifice through which a `share` of that flows.
    pub(crate) fn times(mut self, share: f64) -> Self {
        let (Opening::Conductance(size) | Opening::Nozzle(size, _)) = &mut self.opening;
        *size *= share;
        self
    }

    /// Its properties but for its name and its ends, as a text.
    pub(crate) fn likeness(&self) -> String {
        let (name, ends) = (String::new(), [const { String::new() }; 2]);
        format!("{:?}", Self { name, ends, ..self.clone() })
    }

    /// Its flow between `ends`, open by the sum of `opening`, or wholly without any.
    ///
    /// # Errors
    /// Numbers out of range.
    pub(crate) fn flow(
        &self,
        ends: [End; 2],
        opening: Vec<Signal>,
    ) -> Result<OrificeFlow, InputError> {
        let input = |key: &str| format!("orifice \"{}\" {key}", self.name);
        let ratio = self.critical_ratio;
        if !(0.0..1.0).contains(&ratio) {
            let help = "it must be from 0 to below 1; 0.5 suits most valves";
            return Err(InputError::new(input("critical_ratio"), ratio, help));
        }
        let (scale, law) = match self.opening {
            Opening::Conductance(conductance) => {
                let conductance = positive(&input("conductance"), conductance, "m^3/(s Pa)")?;
                // C rho_0, with rho_0 = p_0/(R T_0)
                (conductance * 1e5 / GAS_CONSTANT_TIMES_TEMPERATURE, OrificeLaw::Standard { ratio })
            }
            Opening::Nozzle(area, discharge) => {
                let area = positive(&input("area"), area, "m^2")?;
                if !(discharge > 0.0 && discharge <= 1.0) {
                    let help =
                        "it must be above 0 and up to 1; 0.6 to 0.85 suit a hole with sharp edges";
                    return Err(InputError::new(input("discharge"), discharge, help));
                }
                let choked = nozzle(CRITICAL).sqrt();
                (
                    discharge * area * choked / GAS_CONSTANT_TIMES_TEMPERATURE.sqrt(),
                    OrificeLaw::Nozzle,
                )
            }
        };
        Ok(OrificeFlow { name: self.name.clone(), ends, scale, law, opening })
    }
}

/// Supply of gas at a given absolute pressure (Pa).
#[derive(Debug, Clone)]
pub(crate) struct Supply {
    pub(crate) name: String,
    pub(crate) pressure: Signal,
}

/// Boundary at an end of an orifice.
pub(crate) enum End {
    /// The gas of that number, among those of the scene.
    Gas(usize),
    /// A supply or the atmosphere, of this absolute pressure (Pa).
    Given(Signal),
}

/// Ratio of pressures above which the flow follows a cubic.
const LAMINAR: f64 = 0.999;

/// Exponent k of air without heat.
const AIR: f64 = 1.4;

/// (2/(k + 1))^(k/(k - 1)), the ratio of pressures below which a nozzle is choked.
const CRITICAL: f64 = 0.528_281_787_717_174_3;

/// How the flow depends on the ratio of pressures.
enum OrificeLaw {
    /// That of ISO 6358, of this critical ratio.
    Standard {
        ratio: f64,
    },
    Nozzle,
}

/// The flow through an orifice.
pub(crate) struct OrificeFlow {
    name: String,
    pub(super) ends: [End; 2],
    /// Choked flow over the pressure (kg/(s Pa)): C rho_0 or that of a nozzle.
    scale: f64,
    law: OrificeLaw,
    opening: Vec<Signal>,
}

impl OrificeFlow {
    /// Area (m^2) of the nozzle without losses that lets as much pass where it is choked.
    pub(crate) fn area(&self) -> f64 {
        self.scale * GAS_CONSTANT_TIMES_TEMPERATURE.sqrt() / nozzle(CRITICAL).sqrt()
    }

    /// Its ends: chambers, supplies or the open.
    pub(crate) fn ends(&self) -> &[End; 2] {
        &self.ends
    }

    /// The flow (kg/s) from the first end to the second at time `t` (s), and its derivatives by the absolute pressures
    /// of both (kg/(s Pa)). The `gases` of the scene have these `pressures` (Pa).
    ///
    /// # Errors
    /// A supply below 0 Pa, an opening that is not from 0 to 1.
    pub(crate) fn rate(
        &self,
        t: f64,
        gases: &[GasInChamber],
        pressures: &[f64],
    ) -> Result<[f64; 3], Failure> {
        let opening = match self.opening.is_empty() {
            true => 1.0,
            false => self.opening.iter().map(|signal| signal.at(t)).sum(),
        };
        // round-off of formulas
        if !(-1e-9..=1.0 + 1e-9).contains(&opening) {
            let name = &self.name;
            return Err(Failure::Fatal(
                format!("the opening of orifice \"{name}\" is {opening} at t = {t} s: it must be from 0 to 1").into(),
            ));
        }
        let mut sides = [[0.0; 3]; 2];
        for (side, end) in sides.iter_mut().zip(&self.ends) {
            *side = match end {
                End::Gas(number) => {
                    let gas = &gases[*number];
                    let p = pressures[*number];
                    let cooling = 0.5 * gas.cooling();
                    [p, (p / gas.pressure).powf(-cooling), cooling]
                }
                End::Given(pressure) => [pressure.at(t), 1.0, 0.0],
            };
            let p = side[0];
            if !(p >= 0.0 && p.is_finite()) {
                let name = &self.name;
                return Err(Failure::Fatal(
                    format!("the supply of orifice \"{name}\" has {p} Pa at t = {t} s: an absolute pressure is finite and not below 0").into(),
                ));
            }
        }
        let [first, second] = sides;
        let scale = self.scale * opening.clamp(0.0, 1.0);
        Ok(match first[0] >= second[0] {
            true => self.discharge(first, second[0]).map(|x| scale * x),
            false => {
                let [flow, up, down] = self.discharge(second, first[0]);
                [-scale * flow, -scale * down, -scale * up]
            }
        })
    }

    /// The flow of an orifice whose choked flow is p_1 from the pressure p_1, where it is hotter by sqrt(T_0/T_1) = `thinning` with
    /// -d ln thinning/d ln p_1 = `cooling`, to p_2 below it, and its derivatives by both pressures.
    fn discharge(&self, [p1, thinning, cooling]: [f64; 3], p2: f64) -> [f64; 3] {
        if p1 == 0.0 {
            return [0.0; 3];
        }
        let drop = 1.0 - p2 / p1;
        let (span, [share, slope]) = match self.law {
            OrificeLaw::Standard { ratio } => {
                let span = 1.0 - ratio;
                (span, share(drop / span, (1.0 - LAMINAR) / span, standard_share))
            }
            OrificeLaw::Nozzle => (1.0, share(drop, 1.0 - LAMINAR, nozzle_share)),
        };
        let flow = thinning * p1 * share;
        let up = thinning * (share + slope * p2 / (p1 * span)) - cooling * flow / p1;
        [flow, up, -thinning * slope / span]
    }
}

/// Part of the choked flow at d = (1 - p_2/p_1)/(1 - b), and its derivative: sqrt(d (2 - d)).
fn standard_share(d: f64) -> [f64; 2] {
    if d >= 1.0 {
        return [1.0, 0.0];
    }
    let value = (d * (2.0 - d)).sqrt();
    [value, (1.0 - d) / value]
}

/// 2 k/(k - 1) (r^(2/k) - r^((k + 1)/k)), the square of the flow of a nozzle over A p_1/sqrt(R T_1).
fn nozzle(r: f64) -> f64 {
    2.0 * AIR / (AIR - 1.0) * (r.powf(2.0 / AIR) - r.powf((AIR + 1.0) / AIR))
}

/// Part of the choked flow of a nozzle at d = 1 - p_2/p_1, and its derivative.
fn nozzle_share(d: f64) -> [f64; 2] {
    let r = 1.0 - d;
    if r <= CRITICAL {
        return [1.0, 0.0];
    }
    let choked = nozzle(CRITICAL);
    let value = (nozzle(r) / choked).sqrt();
    let slope = (2.0 * r.powf(2.0 / AIR - 1.0) - (AIR + 1.0) * r.powf(1.0 / AIR)) / (AIR - 1.0);
    [value, -slope / (value * choked)]
}

/// Value and derivative of `root` at d; below d = `least`, those of the odd cubic that has the value and the slope of
/// `root` there.
fn share(d: f64, least: f64, root: fn(f64) -> [f64; 2]) -> [f64; 2] {
    match d {
        d if d >= least => root(d),
        d => {
            let [value, slope] = root(least.min(1.0));
            let linear = (3.0 * value - slope * least) / (2.0 * least);
            let cubic = (slope * least - value) / (2.0 * least.powi(3));
            [d * (linear + cubic * d * d), linear + 3.0 * cubic * d * d]
        }
    }
}
