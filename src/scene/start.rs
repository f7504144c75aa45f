//! How a scene starts: displacements and velocities at t = 0.

use super::Scene;
use super::phase::check_vector;
use crate::body::Body;
use crate::constraint::angular;
use crate::input::{InputError, finite};
use crate::mesh::Selection;
use crate::vector::cross;

/// The start as the user of a scene gives it.
#[derive(Debug, Clone)]
pub(super) struct Start {
    /// Displacements (m).
    pub(super) displacements: Vec<f64>,
    /// Velocities (m/s), but for what follows.
    velocities: Vec<f64>,
    /// Angular velocity (rad/s) about the centre of mass, on top of them.
    spin: Option<Vec<f64>>,
    /// Velocities (m/s) of some nodes, instead of all that.
    of_nodes: Vec<(Selection, Vec<f64>)>,
}

impl Start {
    /// At rest in the natural shape.
    pub(super) fn rest(body: &Body) -> Self {
        let rest = vec![0.0; body.dofs()];
        Self { displacements: rest.clone(), velocities: rest, spin: None, of_nodes: Vec::new() }
    }
}

/// # The start
///
/// Velocities that the constraints of the first phase do not allow are projected on the nearest, in the
/// sense of kinetic energy, that they do allow: an inelastic impact at t = 0. In statics nothing moves.
impl Scene {
    /// Displacements at t = 0 (m): `field` gives one for each natural position. Default: none.
    pub fn initial_displacement(mut self, field: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        self.start.displacements = self.body.mesh().field(field);
        self
    }

    /// Velocities at t = 0 (m/s): `field` gives one for each natural position. Default: rest.
    ///
    /// ```
    /// # use pliant::{Body, Cells, Material, Mesh, Phase, Scene};
    /// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    /// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    /// # let body = Body::new(mesh, rubber).build()?;
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

    /// Velocity (m/s) of some nodes at t = 0, instead of what [`initial_velocity`](Self::initial_velocity) and
    /// [`spin`](Self::spin) give them.
    pub fn initial_velocity_of(
        mut self,
        nodes: impl Into<Selection>,
        velocity: impl Into<Vec<f64>>,
    ) -> Self {
        self.start.of_nodes.push((nodes.into(), velocity.into()));
        self
    }

    /// Angular velocity (rad/s) at t = 0 about the centre of mass, on top of
    /// [`initial_velocity`](Self::initial_velocity): one component in the plane, counter-clockwise, three in
    /// space. Default: none.
    pub fn spin(mut self, angular_velocity: impl Into<Vec<f64>>) -> Self {
        self.start.spin = Some(angular_velocity.into());
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
        let (body, dimension) = (self.body(), self.body.dimension());
        let Start { displacements, velocities, spin, of_nodes } = &self.start;
        for (name, vector) in
            [("initial displacement", displacements), ("initial velocity", velocities)]
        {
            if vector.len() != body.dofs() {
                let mend = format!("it needs {dimension} components at each node");
                let value = format!("{} numbers in all", vector.len());
                return Err(InputError::new(name, value, mend));
            }
            finite(name, vector)?;
        }
        let mut v = velocities.clone();
        if let Some(spin) = spin {
            let omega = angular("spin", spin, dimension)?;
            let positions = body.mesh().positions().iter();
            let x: Vec<f64> = positions.zip(displacements).map(|(x, u)| x + u).collect();
            let centre = body.mass_average(&x);
            for (v, x) in v.chunks_exact_mut(dimension).zip(x.chunks_exact(dimension)) {
                let mut arm = [0.0; 3];
                arm.iter_mut().zip(x.iter().zip(&centre)).for_each(|(arm, (x, c))| *arm = x - c);
                v.iter_mut().zip(cross(&omega, &arm)).for_each(|(v, turning)| *v += turning);
            }
        }
        for (nodes, velocity) in of_nodes {
            check_vector("initial velocity", velocity, dimension, "m/s")?;
            finite("initial velocity", velocity)?;
            for node in body.mesh().select(nodes)? {
                v[node * dimension..][..dimension].copy_from_slice(velocity);
            }
        }
        Ok(v)
    }
}
