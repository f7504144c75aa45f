//! Start of a scene from the state of another one: all but displacements and velocities.

use std::collections::BTreeMap;

use super::scene_state::INPUT;
use super::{Scene, SceneState};
use crate::base::input::{InputError, four_digits};
use crate::base::vector::norm;
use crate::elements::body::Branches;
use crate::scene::forces::{ChamberFluid, GasInChamber, Liquid, LiquidInChamber, Obstacle, Pipe};

/// Distances (as fractions of the size of the body) below which an obstacle is where it was.
const SAME_PLACE: f64 = 1e-6;

impl Scene {
    /// Masses (kg) at the start of the gases and then of the liquids, which are these.
    pub(crate) fn starting_masses(
        &self,
        gases: &[GasInChamber],
        liquids: &[LiquidInChamber],
    ) -> Vec<f64> {
        let gases = self.gases.iter().zip(gases).map(|(gas, filled)| {
            self.mass_in_state(|state| &state.gases, &gas.chamber).unwrap_or(filled.amount())
        });
        let liquids = self.liquids.iter().zip(liquids);
        gases.chain(liquids.map(|(liquid, poured)| self.starting_liquid(liquid, poured))).collect()
    }

    /// The mass (kg) of a liquid at the start, whose chamber has it as `poured`.
    pub(super) fn starting_liquid(&self, liquid: &Liquid, poured: &LiquidInChamber) -> f64 {
        self.mass_in_state(|state| &state.liquids, liquid.chamber()).unwrap_or(poured.amount())
    }

    /// The mass (kg) in a chamber that the state from which the scene starts has, of gases or of liquids.
    fn mass_in_state(
        &self,
        of: fn(&SceneState) -> &BTreeMap<String, f64>,
        chamber: &str,
    ) -> Option<f64> {
        of(self.start.state.as_deref()?).get(chamber).copied()
    }

    /// States of all lags and flow rates (m^3/s) of all pipes at the start.
    pub(super) fn starting_lags_and_pipes(&self) -> Vec<f64> {
        let Some(state) = self.start.state.as_deref() else {
            return vec![0.0; self.lags.len() + self.pipes.len()];
        };
        let lags = self.lags.iter().map(|(name, _)| state.lags.get(name));
        let pipes = self.pipes.iter().map(|pipe| state.pipes.get(pipe.name()));
        lags.chain(pipes).map(|kept| kept.copied().unwrap_or(0.0)).collect()
    }

    /// Writes the branches of the state to the internal strains of all bodies, which have relaxed, where they fit.
    pub(crate) fn start_branches(&self, branches: &Branches, internal: &mut [f64]) {
        let Some(state) = self.start.state.as_deref() else { return };
        let is_single = self.body.is_single();
        for (number, part) in self.body.parts().enumerate() {
            let own = state.of(&part, is_single).and_then(|body| body.branches.as_ref());
            if let Some(own) = own {
                branches.set_state(number, own, internal);
            }
        }
    }

    /// Angles (turns) that sensors of angles read at the start, by their names.
    pub(crate) fn starting_angles(&self) -> impl Iterator<Item = (&str, f64)> {
        let angles = self.start.state.iter().flat_map(|state| &state.angles);
        angles.map(|(name, turns)| (&**name, *turns))
    }

    /// The state from which the scene starts, if it has more than displacements and velocities of bodies.
    #[cfg(feature = "checkpoint")]
    pub(crate) fn starting_state(&self) -> Option<&SceneState> {
        self.start.state.as_deref().filter(|state| {
            let SceneState { bodies, gases, liquids, lags, pipes, .. } = state;
            bodies.iter().any(|body| body.branches.is_some())
                || [gases, liquids, lags, pipes].iter().any(|all| !all.is_empty())
        })
    }

    /// # Errors
    /// Gas or liquid in the state in a chamber where the scene has none.
    pub(super) fn check_start_state(&self) -> Result<(), InputError> {
        let Some(state) = self.start.state.as_deref() else { return Ok(()) };
        let gas = state.gases.iter().find(|(name, _)| self.gas_in(name).is_none());
        let liquid = state.liquids.iter().find(|(name, _)| self.liquid_in(name).is_none());
        let (what, (chamber, amount)) = match (gas, liquid) {
            (Some(gas), _) => ("gas", gas),
            (None, Some(liquid)) => ("liquid", liquid),
            (None, None) => return Ok(()),
        };
        let help = format!(
            "the scene has no {what} in a chamber of that name: give it `[[{what}]]`, or remove \"{chamber}\" from `{}` of the state",
            if what == "gas" { "gases" } else { "liquids" }
        );
        let value = format!("{} kg of {what} in chamber \"{chamber}\"", four_digits(*amount));
        Err(InputError::new(INPUT, value, help))
    }

    /// Unknowns that either the scene or the state from which it starts does not have, in words; none without a state.
    pub(crate) fn lacking_in_state(&self) -> Vec<String> {
        let Some(state) = self.start.state.as_deref() else { return Vec::new() };
        let mut said = Vec::new();
        self.compare_bodies(state, &mut said);
        let gases = self.gases.iter().map(|gas| &*gas.chamber);
        let liquids = self.liquids.iter().map(Liquid::chamber);
        let pipes = self.pipes.iter().map(Pipe::name);
        let filled = "it starts with the mass that the scene gives it";
        for name in missing(gases, &state.gases) {
            said.push(format!("the state has no gas in chamber \"{name}\": {filled}"));
        }
        for name in missing(liquids, &state.liquids) {
            said.push(format!("the state has no liquid in chamber \"{name}\": {filled}"));
        }
        let lags: Vec<&str> = self.lags.iter().map(|(name, _)| &**name).collect();
        for name in missing(lags.iter().copied(), &state.lags) {
            said.push(format!("the state has no lag of \"{name}\": it starts from 0"));
        }
        for name in missing(pipes.clone(), &state.pipes) {
            said.push(format!("the state has no flow in pipe \"{name}\": it starts from 0"));
        }
        for name in state.lags.keys().filter(|name| !lags.contains(&&***name)) {
            said.push(format!(
                "the lag of \"{name}\" in the state is not used: the scene has none"
            ));
        }
        for name in state.pipes.keys().filter(|name| !pipes.clone().any(|own| own == *name)) {
            said.push(format!(
                "the flow of pipe \"{name}\" in the state is not used: the scene has none"
            ));
        }
        for (name, place) in &state.obstacles {
            let own = self.obstacles.iter().find(|obstacle| obstacle.name() == name);
            let Some(here) = own.and_then(|obstacle| obstacle.place_at(0.0)) else { continue };
            let apart: Vec<f64> = here.iter().zip(place).map(|(a, b)| a - b).collect();
            if here.len() != place.len() || norm(&apart) > SAME_PLACE * self.body.size() {
                said.push(format!(
                    "obstacle \"{name}\" was at {place:.4?} in the state and is at {here:.4?} m here: give its shape where it was, \
                     and its path from there"
                ));
            }
        }
        said
    }

    fn compare_bodies(&self, state: &SceneState, said: &mut Vec<String>) {
        let is_single = self.body.is_single();
        let branches = self.body.branches();
        let mut internal = vec![0.0; branches.as_ref().map_or(0, Branches::unknowns)];
        let relaxed = "they start relaxed, without stress";
        for (number, part) in self.body.parts().enumerate() {
            let of = match is_single {
                true => String::new(),
                false => format!(" of body \"{}\"", part.name),
            };
            let own = state.of(&part, is_single);
            if own.is_none() && state.whole().is_none() && !state.bodies.is_empty() {
                said.push(format!(
                    "the state has no body \"{}\": it starts undeformed, at rest",
                    part.name
                ));
                continue;
            }
            let kept = own.and_then(|body| body.branches.as_ref());
            let has = branches.as_ref().is_some_and(|branches| branches.are_of(number));
            match (kept, has) {
                (None, true) => said.push(format!("the state has no branches{of}: {relaxed}")),
                (Some(_), false) => said
                    .push(format!("the branches{of} in the state are not used: the body has none")),
                (Some(kept), true) => {
                    let fits = branches
                        .as_ref()
                        .is_some_and(|branches| branches.set_state(number, kept, &mut internal));
                    if !fits {
                        said.push(format!(
                            "the branches{of} in the state are of other kinds or in other cells: {relaxed}"
                        ));
                    }
                }
                (None, false) => {}
            }
        }
        if !is_single && state.whole().is_none() {
            for body in &state.bodies {
                if !self.body.parts().any(|part| part.name == body.name) {
                    said.push(format!(
                        "body \"{}\" in the state is not used: the scene has none of that name",
                        body.name
                    ));
                }
            }
        }
    }

    /// Positions (m) at time `t` (s) of the obstacles that have moved, as `phase` has them.
    pub(crate) fn moved_obstacles(
        &self,
        phase: &super::Phase,
        t: f64,
    ) -> BTreeMap<String, Vec<f64>> {
        let own = self.obstacles.iter().map(|obstacle| phase.moving(obstacle));
        let moved = own.filter(|obstacle| obstacle.displacement(t) != [0.0; 3]);
        let place = |obstacle: &Obstacle| Some((obstacle.name().to_owned(), obstacle.place_at(t)?));
        moved.filter_map(place).collect()
    }
}

/// Those of the `names` that a state does not have.
fn missing<'a>(
    names: impl Iterator<Item = &'a str>,
    state: &BTreeMap<String, f64>,
) -> Vec<&'a str> {
    names.filter(|name| !state.contains_key(*name)).collect()
}
