//! Liquids in the chambers of a scene, and their flow in and out of them.

use super::input::{Input, Quantity, Target};
use super::{Phase, Scene, unique};
use crate::base::input::InputError;
use crate::base::vector::norm;
use crate::scene::forces::{Liquid, LiquidInChamber, Signal, Weight};

/// Parts of the time between two breaks of a flow in which it is added up.
const PARTS: usize = 50;

impl Scene {
    /// Adds a liquid that fills a chamber, in place of a pressure set by phases.
    pub fn liquid(mut self, liquid: Liquid) -> Self {
        self.liquids.push(liquid);
        self
    }

    /// The liquids.
    pub fn liquids(&self) -> &[Liquid] {
        &self.liquids
    }

    /// Whether any phase, or a pipe, changes the amount of a liquid.
    pub(crate) fn pours(&self) -> bool {
        !self.pipes.is_empty()
            || self.phases.iter().any(|phase| phase.signals(Quantity::Flow).next().is_some())
    }

    /// Number (from 0) of the liquid in a chamber, if there is any.
    pub(crate) fn liquid_in(&self, chamber: &str) -> Option<usize> {
        self.liquids.iter().position(|liquid| liquid.chamber() == chamber)
    }

    /// Number (from 0) of the liquid in the chamber with a name; `input` is where that was given.
    pub(crate) fn liquid_number(&self, chamber: &str, input: &str) -> Result<usize, InputError> {
        self.chamber_number(chamber, input)?;
        self.liquid_in(chamber).ok_or_else(|| {
            let help = "the chamber has no liquid: give it some, or name another one";
            InputError::new(input, format!("\"{chamber}\""), help)
        })
    }

    /// Number (from 0) of the liquid with a surface in the chamber with a name; `input` is where that was given.
    pub(crate) fn surface_number(&self, chamber: &str, input: &str) -> Result<usize, InputError> {
        let number = self.liquid_number(chamber, input)?;
        match self.liquids[number].has_surface() {
            true => Ok(number),
            false => {
                let help = "its liquid fills it whole, and has no level: let it have a surface, or name another one";
                Err(InputError::new(input, format!("\"{chamber}\""), help))
            }
        }
    }

    /// The liquids within their walls, as they are in a phase; without one they have no weight, and nothing flows.
    ///
    /// # Errors
    /// A chamber that does not exist, or has two contents; numbers out of range; a flow where amounts are constants; a surface without gravity.
    pub(crate) fn poured(&self, phase: Option<&Phase>) -> Result<Vec<LiquidInChamber>, InputError> {
        for (chamber, flow) in phase.into_iter().flat_map(|phase| phase.signals(Quantity::Flow)) {
            let input = format!("flow of phase \"{}\"", phase.map_or("", Phase::name));
            self.liquid_number(chamber, &input)?;
            flow.validate(&input)?;
            if self.has_fixed_amounts {
                let help = "this method has no unknowns for amounts that change: take another one";
                return Err(InputError::new(input, format!("into \"{chamber}\""), help));
            }
        }
        if self.liquids.is_empty() {
            return Ok(Vec::new());
        }
        unique("liquid in chamber", self.liquids.iter().map(Liquid::chamber))?;
        self.liquids.iter().map(|liquid| self.poured_in(phase, liquid)).collect()
    }

    /// One of them.
    pub(crate) fn poured_in(
        &self,
        phase: Option<&Phase>,
        liquid: &Liquid,
    ) -> Result<LiquidInChamber, InputError> {
        let name = liquid.chamber();
        let chamber = &self.chambers[self.chamber_number(name, "chamber of liquid")?];
        if self.gas_in(name).is_some() {
            let help = "it has gas already: leave one of them out";
            return Err(InputError::new("chamber of liquid", format!("\"{name}\""), help));
        }
        let walls = chamber.force(&self.body, Vec::new())?;
        let gravity =
            phase.and_then(|phase| self.gravity_in(phase)).map(|gravity| (gravity, norm(gravity)));
        let weight = match (gravity.filter(|(_, strength)| *strength > 0.0), phase) {
            (Some((along, gravity)), _) => {
                let down = |axis: usize| along.get(axis).map_or(0.0, |g| g / gravity);
                let down = std::array::from_fn(down);
                match liquid.has_surface() {
                    true => {
                        let basin = chamber.basin(&self.body, &walls, down)?;
                        Weight::OfSurface { basin, gravity }
                    }
                    false => {
                        let moment = chamber.moment(&self.body, &walls, down)?;
                        Weight::Whole { moment, gravity }
                    }
                }
            }
            (None, Some(phase)) if liquid.has_surface() => {
                let help = "there is no gravity, by which it is level: give the scene gravity, or leave the surface out";
                let input = format!(
                    "surface of the liquid in chamber \"{name}\" in phase \"{}\"",
                    phase.name
                );
                return Err(InputError::new(input, true, help));
            }
            (None, _) => Weight::None,
        };
        let flows = phase.into_iter().flat_map(|phase| phase.signals_of(Quantity::Flow, name));
        let flows = flows.cloned().collect();
        liquid.pour(walls, self.body.dofs(), weight, flows)
    }

    /// Lines along which surfaces of liquids meet the walls (m) under the displacements `u` (m); `states` are the last unknowns of a state, or none where amounts are
    /// constants.
    #[cfg(feature = "output")]
    pub(crate) fn waterlines(
        &self,
        phase: &Phase,
        u: &[f64],
        states: &[f64],
    ) -> Vec<[[f64; 3]; 2]> {
        let flowing = self.flowing(states);
        let each = self.liquids.iter().enumerate().filter(|(_, liquid)| liquid.has_surface());
        let lines = each.filter_map(|(number, liquid)| {
            // errors were found when the phase began
            let poured = self.poured_in(Some(phase), liquid).ok()?;
            let amount = match flowing {
                Some(all) => all.liquids[number],
                None => self.starting_liquid(liquid, &poured),
            };
            Some(poured.waterline(u, amount))
        });
        lines.flatten().collect()
    }

    /// Checks that no flow empties a chamber.
    ///
    /// # Errors
    /// A phase in which more flows out than there is.
    pub(super) fn check_flows(&self) -> Result<(), InputError> {
        if !self.pours() {
            return Ok(());
        }
        for (liquid, full) in self.liquids.iter().zip(self.poured(None)?) {
            let whole = full.natural(self.starting_liquid(liquid, &full));
            let (mut start, mut volume) = (0.0, whole);
            for phase in &self.phases {
                let flows = phase.signals_of(Quantity::Flow, liquid.chamber());
                for end in self.breaks_in(phase).into_iter().chain([phase.until]) {
                    // `start` is off by round-off
                    let part = (end.min(phase.until) - start).max(0.0) / PARTS as f64;
                    for _ in 0..PARTS {
                        let end = start + part;
                        let flows = flows.clone().map(|flow| added(flow, [start, end]));
                        volume += flows.sum::<f64>();
                        start = end;
                        // what is not finite is told as it goes
                        if volume <= 0.0 {
                            let help = format!(
                                "by t = {end:.4} s all of the {whole:.4e} m^3 in it have flowed out: let less flow, or shorter"
                            );
                            let input = format!("flow of phase \"{}\"", phase.name);
                            let value = format!("out of chamber \"{}\"", liquid.chamber());
                            return Err(InputError::new(input, value, help));
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// Inflow (m^3) by a `flow` between two times (s), by Simpson's rule.
fn added(flow: &Signal, [start, end]: [f64; 2]) -> f64 {
    let middle = start + 0.5 * (end - start);
    (end - start) * (flow.at(start) + 4.0 * flow.at(middle) + flow.at(end)) / 6.0
}

impl Phase {
    /// The flow (m^3/s, of natural volume) of liquid into a chamber, a number or any other [`Signal`]; negative for outflow. Liquid that flows in has the
    /// pressure of the chamber, and its energy counts as supplied. Flows into the same chamber add up. Default: none.
    pub fn flow(self, chamber: impl Into<String>, flow: impl Into<Signal>) -> Self {
        self.with(Input::new(Quantity::Flow, Target::one(chamber), flow.into()))
    }
}
