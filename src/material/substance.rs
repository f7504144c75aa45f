//! What a body, or a region of it, is made of: a material and the law that it keeps to when strains are large.

use super::{Material, laws::Law};
use crate::input::InputError;

/// A material with the law of its elasticity.
///
/// [`Material::law`] makes it. A [`Material`] alone counts as one with the law that the body's
/// [`Strain`](crate::Strain) stands for.
///
/// ```
/// use pliant::{Body, Law, Material, Mesh, SolidCells};
///
/// let silicone = Material { density: 1070.0, young: 2.6e5, poisson: 0.49, viscosity: 200.0 };
/// let mesh = Mesh::cuboid([0.1, 0.03, 0.03], [5, 3, 3], SolidCells::Hexahedra20)?;
/// let body = Body::new(mesh, silicone.law(Law::NeoHookean)).build()?;
/// assert!((body.mass() - 0.0963).abs() < 1e-12); // kg
/// # Ok::<(), pliant::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Substance {
    /// Density, moduli at small strains, viscosity.
    pub material: Material,
    /// What becomes of the moduli at large strains; `None` is as the body's [`Strain`](crate::Strain) says.
    pub law: Option<Law>,
}

impl From<Material> for Substance {
    fn from(material: Material) -> Self {
        Self { material, law: None }
    }
}

impl Material {
    /// This material, with `law` for large strains.
    pub fn law(self, law: Law) -> Substance {
        Substance { material: self, law: Some(law) }
    }

    /// The material with the shear modulus `shear` and the bulk modulus `bulk` (Pa), as laws of rubber have them: of
    /// Mooney-Rivlin's law 2 (c1 + c2), of Yeoh's 2 c1.
    ///
    /// ```
    /// let rubber = pliant::Material::of_moduli(1070.0, 1e5, 5e6, 0.0);
    /// assert!((rubber.elastic().mu - 1e5).abs() < 1e-9 && (rubber.poisson - 0.490066).abs() < 1e-6);
    /// ```
    pub fn of_moduli(density: f64, shear: f64, bulk: f64, viscosity: f64) -> Self {
        let young = 9.0 * bulk * shear / (3.0 * bulk + shear);
        let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
        Self { density, young, poisson, viscosity }
    }
}

impl Substance {
    pub(crate) fn validate(&self) -> Result<(), InputError> {
        self.material.validate()?;
        self.law.map_or(Ok(()), |law| law.validate())
    }
}
