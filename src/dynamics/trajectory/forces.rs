//! Forces that are not stored in a sample but follow from it.

use std::sync::Arc;

use super::{Sample, Trajectory};
use crate::base::input::InputError;
use crate::elements::body::{CellField, Grown, NodalField};
use crate::elements::force::{Force, NodalForces};
use crate::elements::mesh::Selection;
use crate::integrators::ode::Failure;
use crate::scene::constraint::PhaseStart;
use crate::scene::forces::{NodalContact, TouchForce};
use crate::scene::timeline::{ContactReader, Phase};

impl Trajectory {
    /// Forces (N) of all obstacles, and of bodies that touch, on the nodes, dimension components per node; 0 where there
    /// is no contact.
    ///
    /// A stiffness per area acts between the nodes: its forces are distributed to them.
    ///
    /// # Errors
    /// A sample that is not of this trajectory; a distance function of your own that has changed since the
    /// run and is now undefined.
    pub fn contact_forces(&self, sample: &Sample) -> Result<Vec<f64>, InputError> {
        let phase = self.phase_of(sample)?;
        let obstacles = self.scene.contacts(phase)?;
        let touches = self.touch_forces()?.iter().filter(|_| phase.has_touch);
        let touches = touches.map(|touch| touch as &dyn Force);
        self.forces_of(obstacles.iter().map(|contact| contact as _).chain(touches), sample)
    }

    /// Contact at each node by obstacles and touching bodies: contact pressure, contact area, and whether it sticks.
    ///
    /// ```
    /// # use pliant::{Body, Cells, ContactStatus, Material, Mesh, Obstacle, Phase, Scene, Statics};
    /// # let soft = Material { density: 1000.0, young: 1e5, poisson: 0.0, viscosity: 0.0 };
    /// let block = Body::new(Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Rectangles)?, soft);
    /// let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]);
    /// let scene = Scene::new(block.thickness(0.01).build()?)
    ///     .gravity([0.0, -9.8])
    ///     .obstacle(floor.stiffness_density(1e8).friction_coefficient(0.5))
    ///     .phase(Phase::until(1.0).hold_axes([1], [pliant::Axis::X]));
    /// let lying = scene.equilibrium(&Statics::default())?;
    /// let corner = lying.trajectory().nodal_contacts(lying.sample())?[0];
    /// assert!((corner.pressure() / (1000.0 * 9.8 * 0.05) - 1.0).abs() < 0.01);
    /// assert!((corner.area() - 0.0125 * 0.01).abs() < 1e-9);
    /// assert_eq!(corner.status(), ContactStatus::Sticking);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`contact_forces`](Self::contact_forces); surfaces that lie on each other.
    pub fn nodal_contacts(&self, sample: &Sample) -> Result<Vec<NodalContact>, InputError> {
        let phase = self.phase_of(sample)?;
        let obstacles = self.scene.contacts(phase)?;
        let nodal = self.contact()?.read((phase, &obstacles), sample.time, [&sample.u, &sample.v]);
        nodal.map_err(|failure| refused(sample, failure))
    }

    /// Strain, stress and strain energy density of each cell in a `sample`: those of [`Body::cell_fields`](crate::Body::cell_fields), where cells have
    /// [grown](crate::Growth) with the stress and the energy of the elastic part.
    ///
    /// # Errors
    /// A sample of another scene.
    pub fn cell_fields(&self, sample: &Sample) -> Result<Vec<CellField>, InputError> {
        Ok(self.body().cell_fields_of(&sample.u, &self.grown(sample)?))
    }

    /// Strain and stress at each node in a `sample`, likewise: see [`Body::nodal_fields`](crate::Body::nodal_fields).
    ///
    /// # Errors
    /// As [`cell_fields`](Self::cell_fields).
    pub fn nodal_fields(&self, sample: &Sample) -> Result<Vec<NodalField>, InputError> {
        Ok(self.body().nodal_fields_of(&sample.u, &self.grown(sample)?))
    }

    fn grown(&self, sample: &Sample) -> Result<Vec<Grown>, InputError> {
        self.scene.grown(self.phase_of(sample)?, sample.time, &sample.amounts)
    }

    /// The forces of bodies that touch.
    pub(crate) fn touch_forces(&self) -> Result<&[TouchForce], InputError> {
        Ok(&self.contact()?.touches)
    }

    fn contact(&self) -> Result<&ContactReader, InputError> {
        match self.contact.get() {
            Some(known) => Ok(known),
            None => {
                let reader = Arc::new(ContactReader::new(&self.scene)?);
                Ok(self.contact.get_or_init(|| reader))
            }
        }
    }

    /// The sum (N) of some forces on the nodes.
    pub(crate) fn forces_of<'a>(
        &self,
        forces_of_it: impl IntoIterator<Item = &'a dyn Force>,
        sample: &Sample,
    ) -> Result<Vec<f64>, InputError> {
        let mut forces = NodalForces::zeros(self.body().dofs());
        for force in forces_of_it {
            let added = force.add_forces(sample.time, &sample.u, &sample.v, &mut forces);
            added.map_err(|failure| refused(sample, failure))?;
        }
        let mut total = vec![0.0; self.body().dofs()];
        forces.add_up(&mut total);
        Ok(total)
    }

    /// Forces (N) of the constraints on the nodes, dimension components per node; 0 where nothing is
    /// held or moved.
    ///
    /// # Errors
    /// A sample that is not of this trajectory.
    pub fn constraint_forces(&self, sample: &Sample) -> Result<Vec<f64>, InputError> {
        let phase = self.phase_of(sample)?;
        let mut forces = vec![0.0; self.body().dofs()];
        // the start of the rows affects their prescribed values, not the coupled components
        let before = self.scene.phases()[..sample.phase].last();
        let start = PhaseStart { time: before.map_or(0.0, Phase::end), u: &forces };
        let rows = self.scene.rows(phase, &start)?;
        if rows.len() != sample.multipliers.len() {
            return Err(foreign(sample));
        }
        for (row, multiplier) in rows.iter().zip(&sample.multipliers) {
            for &(dof, coefficient) in &row.terms {
                forces[dof] += coefficient * multiplier;
            }
        }
        Ok(forces)
    }

    /// The force (N), one component per dimension, with which constraints act on the nodes of `selection`
    /// together.
    ///
    /// A probe that holds or moves them reads it with the opposite sign.
    ///
    /// ```
    /// # use pliant::{Body, Material, Mesh, Phase, Sampling, Scene, Settings};
    /// # let soft = Material { density: 1000.0, young: 5e4, poisson: 0.0, viscosity: 200.0 };
    /// # let bar = Body::new(Mesh::bar(0.1, 6)?, soft).area(2e-4).build()?;
    /// let scene = Scene::new(bar).phase(Phase::until(1.0).hold("left").load("right", [2.0]));
    /// let trajectory = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
    /// let held = trajectory.constraint_force(trajectory.last(), "left")?;
    /// assert!((held[0] - -2.0).abs() < 1e-3); // it has nearly come to rest
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`constraint_forces`](Self::constraint_forces); a selection without nodes.
    pub fn constraint_force(
        &self,
        sample: &Sample,
        selection: impl Into<Selection>,
    ) -> Result<Vec<f64>, InputError> {
        let nodes = self.body().mesh().select(&selection.into())?;
        let forces = self.constraint_forces(sample)?;
        let dimension = self.body().dimension();
        let along = |axis| nodes.iter().map(|node| forces[node * dimension + axis]).sum();
        Ok((0..dimension).map(along).collect())
    }

    /// The phase in force at a sample.
    pub(crate) fn phase_of<'a>(&'a self, sample: &'a Sample) -> Result<&'a Phase, InputError> {
        let dofs = self.body().dofs();
        let phase = sample.commanded.0.as_deref();
        let phase = phase.or_else(|| self.scene.phases().get(sample.phase));
        let fits = sample.u.len() == dofs && sample.v.len() == dofs;
        phase.filter(|_| fits).ok_or_else(|| foreign(sample))
    }
}

fn foreign(sample: &Sample) -> InputError {
    let help = "it is not a sample of this trajectory: take one from Trajectory::samples";
    InputError::new("sample", format!("that at {} s", sample.time), help)
}

fn refused(sample: &Sample, failure: Failure) -> InputError {
    let reason = match failure {
        Failure::Recoverable(reason) => reason,
        Failure::Fatal(error) => error.to_string(),
    };
    InputError::new("sample", format!("that at {} s", sample.time), reason)
}
