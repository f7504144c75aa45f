//! States of a motion from which other scenes can start.

use super::{Sample, Trajectory};
use crate::elements::body::{Branches, Part};
use crate::scene::forces::{Liquid, Pipe};
use crate::scene::timeline::{BodyState, SceneState};

impl Trajectory {
    /// The state at a sample, which another scene can [start from](crate::Scene::starting_from).
    ///
    /// That of the last sample is whole. Those of others are without Maxwell branches and without whole turns of sensors
    /// of angles, which motions do not keep.
    pub fn state(&self, sample: &Sample) -> SceneState {
        let (scene, phase) = (self.scene(), self.phase_of(sample).ok());
        let branches = self.body().branches();
        let known = branches.as_ref().filter(|branches| {
            !sample.internal_strains.is_empty()
                && sample.internal_strains.len() == branches.unknowns()
        });
        let of_body = |(number, part): (usize, Part)| BodyState {
            name: part.name.to_owned(),
            positions: part.body.mesh().positions().to_vec(),
            displacements: sample.u.get(part.dofs()).unwrap_or_default().to_vec(),
            velocities: sample.v.get(part.dofs()).unwrap_or_default().to_vec(),
            branches: known.and_then(|branches: &Branches| {
                branches.state_of(number, &sample.internal_strains)
            }),
        };
        let flowing = scene.flowing(&sample.amounts);
        let masses = flowing.map(|all| [all.gases, all.liquids].concat()).or_else(|| {
            let (gases, liquids) = (scene.filled().ok()?, scene.poured(None).ok()?);
            Some(scene.starting_masses(&gases, &liquids))
        });
        let mut masses = masses.unwrap_or_default().into_iter();
        let named = |name: &str, value: f64| (name.to_owned(), value);
        let gases = scene.gas_chambers().zip(&mut masses).map(|(name, x)| named(name, x)).collect();
        let liquids = scene.liquids().iter().map(Liquid::chamber);
        let liquids = liquids.zip(masses).map(|(name, x)| named(name, x)).collect();
        let lags = phase.into_iter().flat_map(|phase| {
            let named = |(name, _)| Some((name, scene.actuator_named(name)?));
            let state = |own| scene.drive_at(own, phase, sample.time, &sample.amounts)[0];
            scene.lags().filter_map(named).map(move |(name, own)| (name.to_owned(), state(own)))
        });
        let pipes = scene
            .pipes()
            .iter()
            .map(Pipe::name)
            .enumerate()
            .map(|(number, name)| named(name, flowing.map_or(0.0, |all| all.pipes[number])));
        let is_last = sample.time == self.last().time;
        let angles = self.angles.iter().filter(|_| is_last).cloned();
        SceneState {
            bodies: self.body().parts().enumerate().map(of_body).collect(),
            gases,
            liquids,
            lags: lags.collect(),
            pipes: pipes.collect(),
            obstacles: phase
                .map(|phase| scene.moved_obstacles(phase, sample.time))
                .unwrap_or_default(),
            angles: angles.collect(),
        }
    }
}
