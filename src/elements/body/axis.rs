//! Bodies of revolution: checks of their meshes and materials, nodes on the axis, sections around it.

use std::f64::consts::TAU;

use super::assembled::Body;
use super::assembly::Elements;
use super::recipe::Recipe;
use super::section::Section;
use crate::base::input::InputError;
use crate::elements::material::{Plane, Substance};
use crate::elements::mesh::Mesh;

/// Nodes this close to the axis, relative to the size of the body, are on it.
const ON_AXIS: f64 = 1e-9;

/// The nodes on the axis, counted from 0.
fn on_axis(mesh: &Mesh) -> Vec<usize> {
    let near = ON_AXIS * mesh.size();
    (0..mesh.node_count()).filter(|&node| mesh.position(node)[0].abs() <= near).collect()
}

impl Recipe {
    /// Prepares the `mesh` of a body of revolution: edges on the axis are inside of it.
    ///
    /// # Errors
    /// Nodes beyond the axis; materials that axisymmetric bodies do not support.
    pub(super) fn turn(&self, mesh: &mut Mesh) -> Result<(), InputError> {
        let near = ON_AXIS * mesh.size();
        let is_beyond = |node: &usize| mesh.position(*node)[0] < -near;
        let beyond: Vec<usize> = (0..mesh.node_count()).filter(is_beyond).collect();
        if let Some(&first) = beyond.first() {
            let numbers: Vec<usize> = beyond.iter().take(8).map(|node| node + 1).collect();
            let help = format!(
                "{} node(s) of an axisymmetric body lie beyond the axis r = 0 (nodes {numbers:?}{}): x is the radius r, 0 or above. Move the mesh, or \
                 mesh the half at r >= 0 alone",
                beyond.len(),
                if beyond.len() > 8 { ", ..." } else { "" }
            );
            let input = format!("r of node {}", first + 1);
            return Err(InputError::new(input, format!("{} m", mesh.position(first)[0]), help));
        }
        let regions = self.regions.iter().map(|(_, substance)| substance);
        for Substance { branches, fibres, is_rigid, .. } in
            std::iter::once(&self.material).chain(regions)
        {
            let have = |count: usize| (count > 0).then_some(count.to_string());
            for (name, value) in [
                ("material.branch", have(branches.len())),
                ("material.fibres", have(fibres.len())),
                ("material.rigid", is_rigid.then_some("true".into())),
            ] {
                if let Some(value) = value {
                    return Err(not_around(name, value));
                }
            }
        }
        mesh.cut_at(on_axis(mesh));
        Ok(())
    }
}

/// The factor from areas or lengths of cells to their volumes, in the mean of a body of revolution.
pub(super) fn mean_section(section: Section, elements: &dyn Elements) -> f64 {
    let Some(circles) = elements.circles() else { return section.uniform() };
    let volumes = elements.volumes();
    let areas = volumes.iter().zip(circles).map(|(volume, circle)| volume / circle);
    volumes.iter().sum::<f64>() / areas.sum::<f64>()
}

/// The error for features that axisymmetric bodies do not support.
fn not_around(input: &str, value: String) -> InputError {
    let help = "an axisymmetric body does not have it: leave it out, or mesh the body in space";
    InputError::new(input, value, help)
}

impl Body {
    /// Whether it is a body of revolution ([`Plane::Axisymmetric`]): its nodes are circles about the axis, and forces and masses those of a
    /// whole turn.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Plane};
    ///
    /// let soft = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
    /// let rod = Body::new(Mesh::rectangle([0.1, 0.3], [3, 7], Cells::Rectangles)?, soft);
    /// let rod = rod.plane(Plane::Axisymmetric).build()?;
    /// assert!(rod.is_axisymmetric());
    /// assert!((rod.mass() - std::f64::consts::PI * 0.01 * 0.3 * 1000.0).abs() < 1e-12);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn is_axisymmetric(&self) -> bool {
        self.plane() == Some(Plane::Axisymmetric)
    }

    /// The factor from lengths in the plane to areas (m) at the first coordinate `x` (m), beside the thickness: 2 pi r, or 1 of other bodies.
    pub(crate) fn around(&self, x: f64) -> f64 {
        if self.is_axisymmetric() { TAU * x } else { 1.0 }
    }

    /// The nodes of a body of revolution that are on its axis (from 0), and cannot leave it.
    pub(crate) fn nodes_on_axis(&self) -> Vec<usize> {
        if self.is_axisymmetric() { on_axis(&self.mesh) } else { Vec::new() }
    }

    /// For each cell the factor from its length or area to its volume: thickness (m) or cross section (m^2), 1 of solids.
    pub(crate) fn cell_sections(&self) -> Vec<f64> {
        self.by_cell(|of| {
            let uniform = || vec![of.section; of.cells.len()];
            of.elements.circles().unwrap_or_else(uniform)
        })
    }

    /// Refuses `input` of a body of revolution, which does not have it.
    ///
    /// # Errors
    /// A body of revolution.
    pub(crate) fn refuse_around(
        &self,
        input: &str,
        value: impl Into<String>,
    ) -> Result<(), InputError> {
        if self.is_axisymmetric() { Err(not_around(input, value.into())) } else { Ok(()) }
    }
}
