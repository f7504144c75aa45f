//! Initial conditions of a scene.

use std::sync::Arc;

use super::{Scene, SceneState};
use crate::base::input::InputError;
use crate::elements::mesh::Selection;

/// # The start
///
/// Velocities that the constraints of the first phase do not allow are projected onto the nearest, in the
/// norm of kinetic energy, that they do allow: an inelastic impact at t = 0. In statics nothing moves, and the search for an
/// equilibrium begins at the displacements of the start: see [`Scene::equilibrium`].
impl Scene {
    /// Starts from a state of an earlier motion, or from an equilibrium, of bodies with the same meshes.
    ///
    /// It sets all unknowns at t = 0 by name: displacements, velocities and Maxwell branches of each body, masses of gas
    /// and liquid in chambers, states of lags, flow rates of pipes, and whole turns of sensors of angles. If scene and
    /// state have one body each, their names may differ. Everything else may differ, such as material,
    /// strain, loads and obstacles. Time and energies restart at 0, and so do signals and paths, which are functions of time:
    /// an obstacle has its position of the scene at t = 0.
    ///
    /// Unknowns that only the scene has start as without a state, and those that only the state has are
    /// not used: a [warning](Self::warnings) names both. Branches of a body are used if the cells have branches of the same
    /// kinds.
    ///
    /// The search for an equilibrium begins at the displacements of the state, with its masses of gas and liquid; branches and lags are
    /// at rest.
    ///
    /// [`initial_displacement`](Self::initial_displacement), called after it, replaces its displacements, with branches
    /// that have relaxed, and [`initial_velocity`](Self::initial_velocity) its velocities; [`spin`](Self::spin) is
    /// added to these.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings, Statics};
    ///
    /// let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Triangles)?;
    /// let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 4.0 };
    /// let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// let bent = Scene::new(body.clone()).phase(Phase::until(1.0).hold("left").load([22], [0.0, -0.01]));
    /// let bent = bent.equilibrium(&Statics::default())?;
    /// // let go
    /// let scene = Scene::new(body)
    ///     .starting_from(&bent.trajectory().state(bent.sample()))
    ///     .phase(Phase::until(0.1).hold("left"));
    /// let motion = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
    /// assert_eq!(motion.samples()[0].u, bent.displacements());
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Errors of [`validate`](Self::validate) and of runs are a state of another mesh, a state none of whose bodies the scene has, and
    /// gas or liquid of a chamber in which the scene has none.
    pub fn starting_from(mut self, state: &SceneState) -> Self {
        let start = &mut self.start;
        match state.whole() {
            Some(whole) => {
                start.displacements.clone_from(&whole.displacements);
                start.velocities.clone_from(&whole.velocities);
            }
            None => {
                let is_single = self.body.is_single();
                for part in self.body.parts() {
                    let Some(own) = state.of(&part, is_single) else { continue };
                    for (all, field) in [
                        (&mut start.displacements, &own.displacements),
                        (&mut start.velocities, &own.velocities),
                    ] {
                        // another number is an error of `validate`
                        if let Some(all) = all.get_mut(part.dofs())
                            && all.len() == field.len()
                        {
                            all.copy_from_slice(field);
                        }
                    }
                }
            }
        }
        start.state = Some(Arc::new(state.clone()));
        self
    }

    /// Displacements at t = 0 (m): `field` gives one for each undeformed position. Default: none.
    pub fn initial_displacement(mut self, field: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        self.start.displacements = self.body.mesh().field(field);
        if let Some(state) = &mut self.start.state {
            Arc::make_mut(state).bodies.iter_mut().for_each(|body| body.branches = None);
        }
        self
    }

    /// Velocities at t = 0 (m/s): `field` gives one for each undeformed position. Default: rest.
    ///
    /// ```
    /// # use pliant::{Body, Cells, Material, Mesh, Phase, Scene};
    /// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    /// # let body = Body::new(mesh, rubber).thickness(0.01).build()?;
    /// // thrown upwards, turning once a second
    /// let scene = Scene::new(body)
    ///     .initial_velocity(|_| vec![0.0, 5.0])
    ///     .spin([std::f64::consts::TAU])
    ///     .gravity([0.0, -9.8])
    ///     .phase(Phase::until(1.0));
    /// # scene.validate()?;
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn initial_velocity(mut self, field: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        self.start.velocities = self.body.mesh().field(field);
        self
    }

    /// Velocity (m/s) of some nodes at t = 0, in place of that by [`initial_velocity`](Self::initial_velocity)
    /// and [`spin`](Self::spin).
    pub fn initial_velocity_of(
        mut self,
        nodes: impl Into<Selection>,
        velocity: impl Into<Vec<f64>>,
    ) -> Self {
        self.start.of_nodes.push((nodes.into(), velocity.into()));
        self
    }

    /// Angular velocity (rad/s) at t = 0 about the centre of mass, in addition to
    /// [`initial_velocity`](Self::initial_velocity): one component in the plane, counter-clockwise, three in
    /// space. Default: none.
    pub fn spin(mut self, angular_velocity: impl Into<Vec<f64>>) -> Self {
        self.start.spin = Some(angular_velocity.into());
        self
    }

    /// Angular velocity (rad/s) at t = 0 of one of several [bodies](crate::Body::join) about its own centre of mass, in
    /// addition to all other velocities.
    pub fn spin_of(
        mut self,
        body: impl Into<String>,
        angular_velocity: impl Into<Vec<f64>>,
    ) -> Self {
        self.start.of_bodies.push((body.into(), angular_velocity.into()));
        self
    }

    /// Displacements at t = 0.
    pub(crate) fn initial_displacements(&self) -> &[f64] {
        &self.start.displacements
    }

    /// Velocities at t = 0.
    ///
    /// # Errors
    /// Numbers of components that do not fit the body, numbers that are not finite, unknown nodes.
    pub(crate) fn initial_velocities(&self) -> Result<Vec<f64>, InputError> {
        self.start.velocities(&self.body)
    }
}
