//! Gas in the chambers of a scene, and its flow in and out of them.

use std::borrow::Cow;
use std::sync::Arc;

use super::input::{Input, Quantity, Target};
use super::{Phase, Scene, unique};
use crate::base::input::{InputError, find, not_negative, unknown_among};
use crate::elements::force::{Force, Forces};
use crate::scene::forces::{
    AmountFlow, Chamber, ChamberFluid, End, FixedAmount, Gas, GasInChamber, Lag, Lagging,
    LiquidInChamber, Orifice, OrificeFlow, Signal, Supply,
};

/// Name of an open end of an orifice or a pipe.
pub(super) const OPEN: &str = "atmosphere";

/// The amounts of a scene, as they stand among its unknowns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Amounts<'a> {
    /// Masses (kg).
    pub(crate) gases: &'a [f64],
    /// Masses (kg).
    pub(crate) liquids: &'a [f64],
    /// States of actuators that lag.
    pub(crate) lags: &'a [f64],
    /// Flows (m^3/s).
    pub(crate) pipes: &'a [f64],
}

impl Scene {
    /// Adds an amount of gas in a chamber, in place of a pressure set by phases.
    pub fn gas(mut self, gas: Gas) -> Self {
        self.gases.push(gas);
        self
    }

    /// Adds an orifice or a valve between a supply or the atmosphere and a chamber with gas, or between two of these.
    ///
    /// ```
    /// use pliant::{Body, Cells, Chamber, Gas, Material, Mesh, Orifice, Phase, Scene, Settings};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };
    /// let ring = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles)?;
    /// let ring = Body::new(ring, rubber).thickness(0.01).build()?;
    /// let scene = Scene::new(ring)
    ///     .chamber(Chamber::within("air", "inner"))
    ///     .gas(Gas::in_chamber("air"))
    ///     .supply("pump", 1.2e5)
    ///     .orifice(Orifice::new("inlet", "pump", "air", 1e-9))
    ///     .orifice(Orifice::new("outlet", "air", "atmosphere", 1e-9))
    ///     .phase(Phase::until(0.2).open("outlet", 0.0))
    ///     .phase(Phase::until(0.4).open("inlet", 0.0));
    /// let mut ring = scene.start(&Settings::default())?;
    /// let before = ring.view().gas_amount("air")?;
    /// ring.advance_to(0.2)?;
    /// assert!(ring.view().gas_amount("air")? > before);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn orifice(mut self, orifice: Orifice) -> Self {
        self.orifices.push(orifice);
        self
    }

    /// Adds a supply for orifices of that absolute pressure (Pa), a number or any other [`Signal`].
    pub fn supply(mut self, name: impl Into<String>, pressure: impl Into<Signal>) -> Self {
        self.supplies.push(Supply { name: name.into(), pressure: pressure.into() });
        self
    }

    /// Absolute pressure (Pa) of the air around chambers with gas. Default: 101325.
    pub fn atmosphere(mut self, pressure: f64) -> Self {
        self.atmosphere = pressure;
        self
    }

    /// The orifices.
    pub fn orifices(&self) -> &[Orifice] {
        &self.orifices
    }

    /// Whether any chamber has gas.
    pub(crate) fn has_gas(&self) -> bool {
        !self.gases.is_empty()
    }

    /// The gases.
    pub(crate) fn gases(&self) -> impl Iterator<Item = &Gas> {
        self.gases.iter()
    }

    /// The supplies, with their absolute pressures (Pa).
    pub(crate) fn supplies(&self) -> impl Iterator<Item = (&str, &Signal)> {
        self.supplies.iter().map(|supply| (&*supply.name, &supply.pressure))
    }

    /// Absolute pressure (Pa) of the air around chambers.
    pub(crate) fn outside(&self) -> f64 {
        self.atmosphere
    }

    /// The chambers with gas, by their names.
    pub(crate) fn gas_chambers(&self) -> impl Iterator<Item = &str> {
        self.gases.iter().map(|gas| &*gas.chamber)
    }

    /// Number of amounts of gas and liquids, of states of actuators that lag and of flows of pipes that are unknowns.
    #[cfg(feature = "checkpoint")]
    pub(crate) fn flowing_amounts(&self) -> usize {
        if self.has_fixed_amounts { 0 } else { self.flowing_count() }
    }

    /// The last unknowns of a state by their owners; none where these are constants.
    pub(crate) fn flowing<'a>(&self, states: &'a [f64]) -> Option<Amounts<'a>> {
        let first = states.len().checked_sub(self.flowing_count())?;
        let (masses, rest) = states[first..].split_at(self.gases.len() + self.liquids.len());
        let (gases, liquids) = masses.split_at(self.gases.len());
        let (lags, pipes) = rest.split_at(self.lags.len());
        Some(Amounts { gases, liquids, lags, pipes })
    }

    fn flowing_count(&self) -> usize {
        self.gases.len() + self.liquids.len() + self.lags.len() + self.pipes.len()
    }

    /// All that gas is and flows through, for comparison with another scene.
    #[cfg(feature = "checkpoint")]
    pub(crate) fn gas_parts(&self) -> impl std::fmt::Debug {
        (&self.gases, &self.orifices, &self.supplies, self.atmosphere)
    }

    /// The same scene with constant amounts of gas and liquids, without orifices, pipes and lags: for methods without unknowns for them.
    pub(crate) fn with_fixed_amounts(&self) -> Cow<'_, Self> {
        if !self.has_gas() && self.liquids.is_empty() && self.lags.is_empty() {
            return Cow::Borrowed(self);
        }
        let mut shut = Self { has_fixed_amounts: true, ..self.clone() };
        shut.orifices.clear();
        shut.pipes.clear();
        let flows = |quantity| matches!(quantity, Quantity::Opening | Quantity::Flow);
        shut.phases.iter_mut().for_each(|phase| phase.without_inputs(flows));
        Cow::Owned(shut)
    }

    /// The same for statics: with actuators, and amounts of gas and liquids, that rise from rest if so asked.
    pub(crate) fn loaded(&self, rises: bool) -> Self {
        Self { rises, ..self.with_fixed_amounts().into_owned() }
    }

    /// The last unknowns of a state of statics, as [`flowing`](Self::flowing) has them, for a `fraction` of the load of `phase`; none where there are neither gases nor liquids. `acting` is the phase under that fraction.
    ///
    /// # Errors
    /// As [`filled`](Self::filled).
    pub(crate) fn amounts_at(
        &self,
        fraction: f64,
        phase: &Phase,
        acting: &Phase,
    ) -> Result<Vec<f64>, InputError> {
        if !self.has_gas() && self.liquids.is_empty() {
            return Ok(Vec::new());
        }
        let (gases, liquids) = (self.filled()?, self.poured(Some(phase))?);
        let whole = self.starting_masses(&gases, &liquids);
        let unloaded = gases
            .iter()
            .map(GasInChamber::unloaded)
            .chain(liquids.iter().map(LiquidInChamber::unloaded));
        let masses = unloaded.zip(whole).map(|(from, whole)| from + fraction * (whole - from));
        let steady = |(name, lag): (&str, &Lag)| lag.gain() * acting.command(name, phase.until)[0];
        let lags = self.lags().map(steady);
        let pipes = self.pipes.iter().map(|_| 0.0);
        Ok(masses.chain(lags).chain(pipes).collect())
    }

    /// Number (from 0) of the orifice with a name; `input` is where that was given.
    pub(crate) fn orifice_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.orifices.iter().map(Orifice::name), input, "orifices")
    }

    /// Number (from 0) of the gas in the chamber with a name; `input` is where that was given.
    pub(crate) fn gas_number(&self, chamber: &str, input: &str) -> Result<usize, InputError> {
        self.chamber_number(chamber, input)?;
        self.gas_in(chamber).ok_or_else(|| {
            let help = "the chamber has no gas: give it some, or name another one";
            InputError::new(input, format!("\"{chamber}\""), help)
        })
    }

    /// Absolute pressure (Pa) and exponent of the gas in a chamber, if there is any.
    pub(super) fn gas_of(&self, chamber: &str) -> Option<[f64; 2]> {
        self.gas_in(chamber).map(|gas| self.gases[gas].law())
    }

    /// Number (from 0) of the gas in a chamber, if there is any.
    pub(crate) fn gas_in(&self, chamber: &str) -> Option<usize> {
        self.gases.iter().position(|gas| gas.chamber == chamber)
    }

    /// The gases within their walls.
    ///
    /// # Errors
    /// A chamber that does not exist, or has two gases; numbers out of range.
    pub(crate) fn filled(&self) -> Result<Vec<GasInChamber>, InputError> {
        unique("gas in chamber", self.gases.iter().map(|gas| &*gas.chamber))?;
        let fill = |gas: &Gas| {
            let chamber = &self.chambers[self.chamber_number(&gas.chamber, "chamber of gas")?];
            let walls = chamber.force(&self.body, Vec::new())?;
            gas.fill(walls, self.body.dofs(), self.atmosphere)
        };
        self.gases.iter().map(fill).collect()
    }

    /// The flow through the orifice of that number in `phase`.
    ///
    /// # Errors
    /// Ends that do not exist, or are the same; numbers out of range.
    pub(crate) fn orifice_flow(
        &self,
        number: usize,
        phase: &Phase,
    ) -> Result<OrificeFlow, InputError> {
        let orifice = &self.orifices[number];
        let input = format!("orifice \"{}\"", orifice.name);
        let end = |name: &String| -> Result<End, InputError> {
            if name == OPEN {
                return Ok(End::Given(self.atmosphere.into()));
            }
            if let Some(supply) = self.supplies.iter().find(|supply| supply.name == *name) {
                return Ok(End::Given(supply.pressure.clone()));
            }
            if let Some(gas) = self.gas_in(name) {
                return Ok(End::Gas(gas));
            }
            let of = format!("{input} end");
            if self.chambers.iter().any(|chamber| chamber.name() == name) {
                return Err(self.gas_number(name, &of).err().unwrap_or_else(|| {
                    InputError::new(of.clone(), format!("\"{name}\""), "it has no gas")
                }));
            }
            let gases = self.gases.iter().map(|gas| &*gas.chamber);
            let supplies = self.supplies.iter().map(|supply| &*supply.name);
            let known: Vec<&str> = gases.chain(supplies).chain([OPEN]).collect();
            let help = unknown_among(name, &known, "scene", "ends of orifices");
            Err(InputError::new(of, format!("\"{name}\""), help))
        };
        let [from, to] = &orifice.ends;
        let ends = [end(from)?, end(to)?];
        if from == to || !ends.iter().any(|end| matches!(end, End::Gas(_))) {
            let help = "it must lead from or to a chamber with gas, and from one place to another";
            return Err(InputError::new(input, format!("from \"{from}\" to \"{to}\""), help));
        }
        let own = phase.signals_of(Quantity::Opening, &orifice.name);
        orifice.flow(ends, own.cloned().collect())
    }

    /// The names of all that may be at an end of an orifice, and of chambers without gas.
    pub(crate) fn places(&self) -> impl Iterator<Item = &str> {
        let supplies = self.supplies.iter().map(|supply| &*supply.name);
        supplies.chain(self.chambers.iter().map(Chamber::name)).chain([OPEN])
    }

    /// Adds the forces of all gases and liquids: together, and with the unknowns of what lags, where their amounts are unknowns, else one by one.
    pub(super) fn add_amounts(
        &self,
        phase: &Phase,
        lagging: Vec<Lagging>,
        forces: &mut Forces,
    ) -> Result<(), InputError> {
        let input = format!("open of phase \"{}\"", phase.name);
        for (name, opening) in phase.signals(Quantity::Opening) {
            self.orifice_number(name, &input)?;
            opening.validate(&input)?;
            if let Some(value) = opening.value().filter(|value| !(0.0..=1.0).contains(value)) {
                return Err(InputError::new(input, value, "an opening is from 0 (shut) to 1"));
            }
        }
        if !self.supplies.is_empty() || !self.orifices.is_empty() {
            unique("supply, chamber or atmosphere", self.places())?;
        }
        for Supply { name, pressure } in &self.supplies {
            let input = format!("supply \"{name}\" pressure");
            pressure.validate(&input)?;
            pressure
                .value()
                .map_or(Ok(0.0), |value| not_negative(&input, value, "Pa, absolute"))?;
        }
        unique("orifice", self.orifices.iter().map(Orifice::name))?;
        let orifices = (0..self.orifices.len()).map(|number| self.orifice_flow(number, phase));
        let (orifices, gases) = (orifices.collect::<Result<Vec<_>, _>>()?, self.filled()?);
        let liquids = self.poured(Some(phase))?;
        let pipes = self.pipe_flows()?;
        let mut start = self.starting_masses(&gases, &liquids);
        if self.has_fixed_amounts {
            let mut masses = start.into_iter();
            for (gas, mass) in gases.into_iter().zip(&mut masses) {
                let from = gas.unloaded();
                forces.push(self.closed(gas, mass, [from, phase.until]));
            }
            for (liquid, mass) in liquids.into_iter().zip(masses) {
                let from = liquid.unloaded();
                forces.push(self.closed(liquid, mass, [from, phase.until]));
            }
        } else if !(gases.is_empty() && liquids.is_empty() && lagging.is_empty()) {
            start.extend(self.starting_lags_and_pipes());
            let flow = AmountFlow::new(gases, orifices, liquids, lagging, pipes, start);
            forces.push(Arc::new(flow));
        }
        Ok(())
    }

    /// The force of an `amount` (kg) that stays, or rises `from` another one up to the time `end` (s).
    fn closed<C: ChamberFluid + 'static>(
        &self,
        content: C,
        amount: f64,
        [from, end]: [f64; 2],
    ) -> Arc<dyn Force> {
        let dofs = self.body.dofs();
        match self.rises {
            true => Arc::new(FixedAmount::rising(content, amount, dofs, [from, end])),
            false => Arc::new(FixedAmount::new(content, amount, dofs)),
        }
    }

    /// Times (s, ascending) at which what `phase` prescribes, the pressure of a supply, the velocity of a fluid and the presets of devices change their laws.
    pub(crate) fn breaks_in(&self, phase: &Phase) -> Vec<f64> {
        let mut breaks = phase.breaks(&self.obstacles);
        let supplies = self.supplies.iter().flat_map(|supply| supply.pressure.breaks());
        breaks.extend(supplies);
        breaks.extend(self.fluids.iter().flat_map(|fluid| fluid.breaks()));
        breaks.extend(self.presets_in(phase).iter().flat_map(|preset| preset.signal.breaks()));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }
}

impl Phase {
    /// How far an orifice is open, from 0 (shut) to 1 (the default), a number or any other [`Signal`].
    pub fn open(self, orifice: impl Into<String>, opening: impl Into<Signal>) -> Self {
        self.with(Input::new(Quantity::Opening, Target::one(orifice), opening.into()))
    }
}
