//! The options by which a body is built from a mesh.

use super::dilatation::Dilatation;
use super::inertia::Inertia;
use super::regions::CellSelection;
use super::section::Section;
use crate::base::input::{InputError, positive};
use crate::elements::material::{Plane, Strain, Substance, Viscosity};
use crate::elements::mesh::Mesh;
use crate::elements::rod::Rod;

/// The options of a body.
#[derive(Debug, Clone)]
pub(super) struct Recipe {
    pub(super) name: Option<String>,
    pub(super) material: Substance,
    pub(super) regions: Vec<(CellSelection, Substance)>,
    pub(super) strain: Strain,
    pub(super) viscosity: Option<Viscosity>,
    pub(super) inertia: Inertia,
    /// That of [`Recipe::plane`] if `None`.
    pub(super) plane: Option<Plane>,
    pub(super) dilatation: Dilatation,
    pub(super) thickness: Option<f64>,
    pub(super) area: Option<f64>,
    pub(super) points: Vec<(String, Vec<f64>, f64)>,
    /// The rod whose axis and sections are the mesh.
    pub(super) rod: Option<Rod>,
}

impl Recipe {
    /// The usual options of a body of a material.
    pub(super) fn of(material: Substance) -> Self {
        Self {
            name: None,
            material,
            regions: Vec::new(),
            strain: Strain::default(),
            viscosity: None,
            inertia: Inertia::default(),
            plane: None,
            dilatation: Dilatation::default(),
            thickness: None,
            area: None,
            points: Vec::new(),
            rod: None,
        }
    }

    /// The assumption across the cells of `mesh`, where they have two dimensions: unless one is given, no strain in the plane,
    /// and no stress in space, where nothing keeps a membrane from changing its thickness.
    pub(super) fn plane(&self, mesh: &Mesh) -> Plane {
        let usual = if mesh.dimension() == 3 { Plane::Stress } else { Plane::Strain };
        self.plane.unwrap_or(usual)
    }

    /// Thickness (m) or cross section (m^2) of the cells of `mesh`; 1 for solids.
    ///
    /// # Errors
    /// One that is missing, or that such cells do not have.
    pub(super) fn section(&self, mesh: &Mesh) -> Result<Section, InputError> {
        if self.plane != Some(Plane::Axisymmetric) {
            return self.uniform_section(mesh).map(Section::Uniform);
        }
        let kind = mesh.kind();
        if kind.dimension() != 2 || mesh.dimension() != 2 {
            let value = format!("of {kind:?} cells in {} dimension(s)", mesh.dimension());
            let help = "a body of revolution has cells of two dimensions in the plane (r, z)";
            return Err(InputError::new("axisymmetric body", value, help));
        }
        for (name, given) in [("thickness", self.thickness), ("area", self.area)] {
            if let Some(value) = given {
                let help = "a body of revolution is as thick as its circles are long, 2 pi r: leave it out";
                return Err(InputError::new(name, value, help));
            }
        }
        Ok(Section::Turn)
    }

    /// That of a body that is no body of revolution.
    fn uniform_section(&self, mesh: &Mesh) -> Result<f64, InputError> {
        let kind = mesh.kind();
        let misplaced = |name: &str, value: f64| {
            Err(InputError::new(name, value, format!("a body of {kind:?} cells has no {name}")))
        };
        if mesh.is_surface() {
            // the volumes of the cells then add up to that of the solid
            return match (self.area, self.thickness) {
                (None, None) => self.within(mesh).map(|volume| volume / mesh.area()),
                (Some(value), _) => Err(no_section("area", value)),
                (_, Some(value)) => Err(no_section("thickness", value)),
            };
        }
        if let Some(rod) = &self.rod {
            return Ok(rod.mean_area());
        }
        match (kind.dimension(), self.area, self.thickness) {
            (1, Some(area), None) => positive("area", area, "m^2"),
            (2, None, Some(thickness)) => positive("thickness", thickness, "m"),
            (3, None, None) => Ok(1.0),
            (1 | 3, _, Some(thickness)) => misplaced("thickness", thickness),
            (2 | 3, Some(area), _) => misplaced("area", area),
            (1, None, None) => Err(missing("area", "a one-dimensional body needs its area in m^2")),
            _ => Err(missing("thickness", "a two-dimensional body needs its thickness in m")),
        }
    }

    /// The volume (m^3) of the solid within the closed surface `mesh`.
    ///
    /// # Errors
    /// A solid that is not rigid, or that has regions; a surface that was turned inside out.
    fn within(&self, mesh: &Mesh) -> Result<f64, InputError> {
        if !self.material.is_rigid {
            let help = "a surface alone makes a rigid body (rigid = true in its material); a body that deforms needs a mesh of cells within the \
                        surface, tetrahedra of Gmsh for one";
            return Err(InputError::new("mesh", "the surface of a solid", help));
        }
        if let Some((cells, _)) = self.regions.first() {
            let help = "there are no cells within the surface of a solid: leave regions out, or give mass and inertia by numbers";
            return Err(InputError::new("region", cells, help));
        }
        positive(
            "volume within the surface",
            mesh.enclosed().volume,
            "m^3, as no map that mirrors leaves it",
        )
    }
}

fn no_section(name: &str, value: f64) -> InputError {
    let help = format!("the surface of a solid has no {name}: leave it out");
    InputError::new(name, value, help)
}

fn missing(input: &str, help: &str) -> InputError {
    InputError::new(input, "(missing)", help)
}
