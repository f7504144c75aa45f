//! Rods in place of slender solids.

use nalgebra::{DMatrix, SymmetricEigen};

use super::assembled::Body;
use crate::base::input::InputError;
use crate::elements::material::{Material, Plane, Substance};
use crate::elements::rod::{SectionNumbers, SolidAxis};

impl Body {
    /// The rod of so many `elements` that replaces a slender solid, a single body, and the axis along which it lies.
    ///
    /// Its section is cut from the cells: area, principal second moments, Saint-Venant's constant of torsion, shear areas. Its law has
    /// the moduli of the solid at small strains; in plane strain that of bending is E/(1 - nu^2).
    ///
    /// # Errors
    /// A solid without a straight axis or with a section that changes along it; options that rods do not have.
    pub(crate) fn as_rod(&self, elements: usize) -> Result<(Self, SolidAxis), InputError> {
        self.single("a rod")?;
        let (mesh, recipe) = (self.mesh(), &self.continua[0].recipe);
        let dimension = mesh.dimension();
        let refused = |input: &str, value: String, help: &str| {
            Err(InputError::new(input, value, format!("{help}: leave it a solid")))
        };
        let is_solid = mesh.cells_with_kinds().all(|(kind, _)| kind.dimension() == dimension);
        if recipe.rod.is_some() || dimension == 1 || !is_solid {
            let help = "a rod stands for a solid alone, with cells that fill its space";
            return refused("cells of the body", mesh.kind().name().into(), help);
        }
        let plane = recipe.plane(mesh);
        if dimension == 2 && plane == Plane::Axisymmetric {
            let help =
                "a rod stands for a body in the plane or in space, not for one of revolution";
            return refused("plane", plane.name().into(), help);
        }
        let substance = &recipe.material;
        let unknown = [
            ("regions", recipe.regions.len()),
            ("point masses", recipe.points.len()),
            ("families of fibres", substance.fibres.len()),
            ("rigid materials", usize::from(substance.is_rigid)),
            ("mass damping", usize::from(substance.mass_damping > 0.0)),
        ];
        if let Some((name, count)) = unknown.iter().find(|(_, count)| *count > 0) {
            return refused(name, count.to_string(), "a rod that stands for a solid has none");
        }
        let thickness = recipe.thickness.unwrap_or(1.0);
        let centre = self.centre_of_mass(&vec![0.0; self.dofs()]);
        let direction = self.longest_axis(&centre);
        let volume = self.mass() / substance.material.density;
        let axis = SolidAxis::new(mesh, [&centre, &direction], [volume, thickness], elements)?;
        let is_strain = dimension == 2 && plane == Plane::Strain;
        let (material, numbers) = match is_strain {
            true => of_plane_strain(&substance.material, axis.numbers()),
            false => (substance.material, axis.numbers()),
        };
        let law = Substance { material, law: None, ..substance.clone() };
        let mut builder = Self::rod(axis.rod(numbers), law)?;
        if let Some(name) = &recipe.name {
            builder = builder.named(name.clone());
        }
        Ok((builder.build()?, axis))
    }

    /// The direction along which its mass reaches farthest.
    fn longest_axis(&self, centre: &[f64]) -> Vec<f64> {
        let (d, positions) = (self.dimension(), self.mesh().positions());
        let arms: Vec<f64> =
            positions.iter().zip(centre.iter().cycle()).map(|(x, c)| x - c).collect();
        let mut weighted = vec![0.0; arms.len()];
        self.inertia().add_product(d, 1.0, &arms, &mut weighted);
        let mut second = DMatrix::zeros(d, d);
        for (arm, weighted) in arms.chunks_exact(d).zip(weighted.chunks_exact(d)) {
            for (i, a) in arm.iter().enumerate() {
                for (j, b) in weighted.iter().enumerate() {
                    second[(i, j)] += a * b;
                }
            }
        }
        let eigen = SymmetricEigen::new(second);
        eigen.eigenvectors.column(eigen.eigenvalues.imax()).iter().copied().collect()
    }
}

/// Material and section with which a rod bends as a plate in plane strain: E/(1 - nu^2) for E, and the same shear stiffness G A.
fn of_plane_strain(of: &Material, numbers: SectionNumbers) -> (Material, SectionNumbers) {
    let stiffer = (1.0 - of.poisson * of.poisson).recip();
    // shear modulus E/2 of the rod's material without Poisson's ratio
    let shear = numbers.shear.map(|area| area * (1.0 - of.poisson));
    let material = Material {
        young: stiffer * of.young,
        viscosity: stiffer * of.viscosity,
        poisson: 0.0,
        ..*of
    };
    (material, SectionNumbers { shear, ..numbers })
}
