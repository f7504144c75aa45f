//! Pipes between the liquids of a scene.

use super::gas::OPEN;
use super::{Scene, unique};
use crate::base::input::{InputError, find, unknown_among};
use crate::scene::forces::{Chamber, Liquid, Mouth, Pipe, PipeFlow};

impl Scene {
    /// Adds a pipe between two chambers with liquids, or between one and a [supply](Self::supply) or the atmosphere.
    pub fn pipe(mut self, pipe: Pipe) -> Self {
        self.pipes.push(pipe);
        self
    }

    /// The pipes.
    pub fn pipes(&self) -> &[Pipe] {
        &self.pipes
    }

    /// Number (from 0) of the pipe with a name; `input` is where that was given.
    pub(crate) fn pipe_number(&self, name: &str, input: &str) -> Result<usize, InputError> {
        find(name, self.pipes.iter().map(Pipe::name), input, "pipes")
    }

    /// The flows through all pipes.
    ///
    /// # Errors
    /// Two pipes of the same name; those of [`pipe_flow`](Self::pipe_flow).
    pub(super) fn pipe_flows(&self) -> Result<Vec<PipeFlow>, InputError> {
        unique("pipe", self.pipes.iter().map(Pipe::name))?;
        (0..self.pipes.len()).map(|number| self.pipe_flow(number)).collect()
    }

    /// The flow through the pipe of that number.
    ///
    /// # Errors
    /// Ends that do not exist, are the same, or have liquids of different densities; numbers out of range.
    pub(crate) fn pipe_flow(&self, number: usize) -> Result<PipeFlow, InputError> {
        let pipe = &self.pipes[number];
        let input = format!("pipe \"{}\"", pipe.name());
        let [from, to] = pipe.ends();
        let ends = [self.mouth(from, &input)?, self.mouth(to, &input)?];
        let density = |mouth: &Mouth| match mouth {
            Mouth::Liquid(number) => Some(self.liquids[*number].density),
            Mouth::Given(..) => None,
        };
        let value = format!("from \"{from}\" to \"{to}\"");
        let mut densities = ends.iter().filter_map(density);
        let Some(density) = densities.next().filter(|_| from != to) else {
            let help =
                "it must lead from or to a chamber with a liquid, and from one place to another";
            return Err(InputError::new(input, value, help));
        };
        if let Some(other) = densities.next().filter(|other| *other != density) {
            let help = format!(
                "the liquids there have {density} and {other} kg/m^3, and do not mix: give both the same density"
            );
            return Err(InputError::new(input, value, help));
        }
        drop(densities);
        pipe.flow(ends, density)
    }

    fn mouth(&self, name: &str, input: &str) -> Result<Mouth, InputError> {
        let outside = self.atmosphere;
        if name == OPEN {
            return Ok(Mouth::Given(outside.into(), outside));
        }
        if let Some(supply) = self.supplies.iter().find(|supply| supply.name == name) {
            return Ok(Mouth::Given(supply.pressure.clone(), outside));
        }
        let of = format!("{input} end");
        if self.chambers.iter().map(Chamber::name).any(|chamber| chamber == name) {
            return Ok(Mouth::Liquid(self.liquid_number(name, &of)?));
        }
        let liquids = self.liquids.iter().map(Liquid::chamber);
        let supplies = self.supplies.iter().map(|supply| &*supply.name);
        let known: Vec<&str> = liquids.chain(supplies).chain([OPEN]).collect();
        let help = unknown_among(name, &known, "scene", "ends of pipes");
        Err(InputError::new(of, format!("\"{name}\""), help))
    }
}
