//! Substance of a body, or of a region of it: a material, its law at large strains, damping, branches and fibres.

use std::fmt;

use super::{Fibres, Material, MaxwellBranch, RigidMass, laws::Law};
use crate::base::input::{InputError, not_negative};

/// A material with its elastic law, damping in proportion to its mass, springs that relax, and fibres.
///
/// [`Material::law`], [`Material::mass_damping`] and [`Material::maxwell`] make it. A [`Material`] alone
/// counts as one with the law that the body's [`Strain`](crate::Strain) stands for, without the others.
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
#[derive(Clone, PartialEq)]
pub struct Substance {
    /// Density, moduli at small strains, viscosity.
    pub material: Material,
    /// The law at large strains; `None` is the one of the body's [`Strain`](crate::Strain).
    pub law: Option<Law>,
    /// Rate a of the force -a M v (1/s), 0 or above.
    pub mass_damping: f64,
    /// Maxwell branches, parallel to the elasticity.
    pub branches: Vec<MaxwellBranch>,
    /// Families of fibres in it.
    pub fibres: Vec<Fibres>,
    /// Whether cells of it are [rigid](Material::rigid).
    pub is_rigid: bool,
    /// Mass, centre and moments of inertia of a rigid body, where they do not follow from a density: see
    /// [`Material::rigid_of`].
    pub mass: Option<RigidMass>,
}

impl fmt::Debug for Substance {
    /// Fields of rigid substances are written only where they are set: the text identifies a scene, and that of others must not
    /// change.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { material, law, mass_damping, branches, fibres, is_rigid, mass } = self;
        let mut fields = f.debug_struct("Substance");
        fields.field("material", material).field("law", law);
        fields.field("mass_damping", mass_damping);
        fields.field("branches", branches).field("fibres", fibres);
        if *is_rigid {
            fields.field("is_rigid", is_rigid);
        }
        if let Some(mass) = mass {
            fields.field("mass", mass);
        }
        fields.finish()
    }
}

impl From<Material> for Substance {
    fn from(material: Material) -> Self {
        Self {
            material,
            law: None,
            mass_damping: 0.0,
            branches: Vec::new(),
            fibres: Vec::new(),
            is_rigid: false,
            mass: None,
        }
    }
}

impl Material {
    /// This material, with `law` for large strains.
    pub fn law(self, law: Law) -> Substance {
        Substance::from(self).law(law)
    }

    /// This material, with the force -a M v at the rate `a` = `rate` (1/s): see [`Substance::mass_damping`].
    pub fn mass_damping(self, rate: f64) -> Substance {
        Substance::from(self).mass_damping(rate)
    }

    /// This material, with the viscosity `time` (s) times Young's modulus: see
    /// [`Substance::stiffness_damping`].
    pub fn stiffness_damping(self, time: f64) -> Substance {
        Substance::from(self).stiffness_damping(time)
    }

    /// This material, with a Maxwell branch of the share of stiffness `share` (1) and the relaxation time
    /// `time` (s): see [`Substance::maxwell`].
    pub fn maxwell(self, share: f64, time: f64) -> Substance {
        Substance::from(self).maxwell(share, time)
    }

    /// This material, with a family of [fibres](Fibres).
    pub fn fibres(self, fibres: Fibres) -> Substance {
        Substance::from(self).fibres(fibres)
    }

    /// This material, with a Maxwell branch that flows only above a yield stress (Pa): see
    /// [`Substance::yielding`].
    pub fn yielding(self, share: f64, time: f64, yield_stress: f64) -> Substance {
        Substance::from(self).yielding(share, time, yield_stress)
    }

    /// A rigid substance with the `density` (kg/m^3), for rigid bodies and for rigid regions of soft ones.
    ///
    /// The cells of a connected rigid piece give its shape and its inertia. Its nodes move as those of a triangle (in
    /// space a tetrahedron) do, whose edges keep their lengths, so that it has 3 (6) degrees of freedom. Nothing
    /// is stressed in it. In an [equilibrium](crate::Scene::equilibrium) its elasticity keeps its shape instead, by
    /// Young's modulus: [`RIGID_YOUNG`](Self::RIGID_YOUNG), or what is set in its place. Rigid pieces are for
    /// the methods `cvode-bdf`, `cvode-adams`, `arkode`, `rosenbrock` and `rk`, from which `auto` chooses, and for Green's
    /// strain.
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh};
    ///
    /// let mesh = Mesh::rectangle([0.05, 0.05], [3, 3], Cells::Rectangles)?;
    /// let stone = Body::new(mesh, Material::rigid(2500.0)).thickness(0.01).build()?;
    /// assert!((stone.mass() - 0.0625).abs() < 1e-12); // kg
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn rigid(density: f64) -> Substance {
        let young = Self::RIGID_YOUNG;
        let substance = Substance::from(Self { density, young, poisson: 0.0, viscosity: 0.0 });
        Substance { is_rigid: true, ..substance }
    }

    /// A rigid substance of a body with prescribed mass and, if given, centre of mass and moments of inertia.
    ///
    /// They are those of a whole body, which is one piece without regions, in place of a density; the density is their
    /// mean over the volume of the mesh. The mesh still gives the shape. All else is as with [`rigid`](Self::rigid).
    ///
    /// ```
    /// use pliant::{Body, Cells, Material, Mesh, Moments, RigidMass};
    ///
    /// let mesh = Mesh::rectangle([0.05, 0.05], [2, 2], Cells::Rectangles)?;
    /// let wheel = RigidMass::new(0.2).moments(Moments::Plane(9e-5)); // most of it at the rim
    /// let body = Body::new(mesh, Material::rigid_of(wheel)).thickness(0.01).build()?;
    /// assert!((body.mass() - 0.2).abs() < 1e-12); // kg
    /// assert!((body.material().density - 8000.0).abs() < 1e-9); // kg/m^3
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn rigid_of(mass: RigidMass) -> Substance {
        // the body knows its volume
        Substance { mass: Some(mass), ..Self::rigid(1.0) }
    }

    /// Young's modulus (Pa) with which [rigid](Self::rigid) pieces keep their shape in equilibria.
    pub const RIGID_YOUNG: f64 = 1e8;

    /// The material with the shear modulus `shear` and the bulk modulus `bulk` (Pa), as used by laws of
    /// rubber: the shear modulus is 2 (c1 + c2) in Mooney-Rivlin's law, 2 c1 in Yeoh's.
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
    /// The same, with `law` for large strains.
    pub fn law(self, law: Law) -> Self {
        Self { law: Some(law), ..self }
    }

    /// The same, with the force -a M v at the rate a = `rate` (1/s, 0 or above).
    ///
    /// M is the inertia of the cells of this material, consistent or lumped as that of the body; it does not act on
    /// point masses. The force brakes all motion relative to the ground, rigid motion too, which decays as
    /// exp(-a t), and damps a vibration of the angular frequency omega with the ratio a / (2 omega).
    ///
    /// With [`stiffness_damping`](Self::stiffness_damping) this is Rayleigh's damping: the ratio is
    /// (a / omega + beta omega) / 2, so that two numbers can be fitted to the measured ratios of two
    /// vibrations.
    ///
    /// ```
    /// use pliant::{Body, Material, Mesh};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 0.0 };
    /// let damped = rubber.mass_damping(2.1).stiffness_damping(3e-4);
    /// assert_eq!(damped.material.viscosity, 300.0); // Pa s
    /// let body = Body::new(Mesh::bar(0.1, 2)?, damped).area(2e-4).build()?;
    /// assert!(body.damping().get(0, 1) > -2e-4 / 0.1 * 300.0); // less by the part of the mass
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn mass_damping(self, rate: f64) -> Self {
        Self { mass_damping: rate, ..self }
    }

    /// The same, with damping in proportion to its stiffness: the viscosity beta E with beta = `time` (s, 0
    /// or above).
    ///
    /// It is natural (the force -beta K v) or objective, as the [`Viscosity`](crate::Viscosity) of the body
    /// is. A vibration of the angular frequency omega is damped with the ratio beta omega / 2.
    pub fn stiffness_damping(mut self, time: f64) -> Self {
        self.material.viscosity = time * self.material.young;
        self
    }

    /// The same, with one more [Maxwell branch](MaxwellBranch), of the share g = `share` (1, above 0) of
    /// Young's modulus and the relaxation time tau = `time` (s, above 0).
    ///
    /// With branches (g_i, tau_i) the modulus under a strain that is applied suddenly and kept is E (1 + sum
    /// g_i exp(-t/tau_i)), and the complex modulus of a slow vibration with the angular frequency omega is
    ///
    /// ```text
    /// E (1 + sum g_i i omega tau_i / (1 + i omega tau_i)) + i omega c
    /// ```
    ///
    /// At the start of a motion the branches have relaxed, as if the body had been in its first shape for
    /// long; so they have in an equilibrium, which they do not change. Fields of strain and stress are those
    /// of the elasticity alone. A body with branches is integrated by the methods `cvode-bdf`, `cvode-adams`,
    /// `arkode` and `rk`, from which `auto` chooses.
    ///
    /// ```
    /// use pliant::{Body, Material, Mesh};
    ///
    /// let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 0.0 };
    /// let relaxing = rubber.maxwell(0.5, 0.01).maxwell(0.2, 0.3);
    /// assert_eq!(relaxing.branches.len(), 2);
    /// let body = Body::new(Mesh::bar(0.1, 2)?, relaxing).area(2e-4).build()?;
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn maxwell(mut self, share: f64, time: f64) -> Self {
        self.branches.push(MaxwellBranch { share, time, yield_stress: 0.0 });
        self
    }

    /// The same, with one more [branch](MaxwellBranch) that flows only above its `yield_stress` (Pa, 0 or
    /// above).
    ///
    /// Below it the branch is a spring, and its flow remains as a permanent strain. Like dough, the body keeps part of a
    /// deformation: the branch pulls with at most Y against the elasticity E of the material, so that strain
    /// above about Y/E springs back.
    ///
    /// The stress is the von Mises stress of the second Piola stress, which is taken in the axes of the
    /// undeformed body; its deviator relaxes. In a body that is sheared and held, it is Y + (q - Y)
    /// exp(-t/tau); a string takes 1.5/(1 + nu) times as long, as stretching shears it less. Motion and
    /// equilibria begin as with [`maxwell`](Self::maxwell), in a shape in which the branches have no stress.
    ///
    /// ```
    /// use pliant::Material;
    ///
    /// let crumb = Material { density: 1100.0, young: 2e3, poisson: 0.4, viscosity: 10.0 };
    /// let dough = crumb.yielding(4.0, 0.5, 300.0);
    /// assert_eq!(dough.branches[0].yield_stress, 300.0); // Pa
    /// ```
    pub fn yielding(mut self, share: f64, time: f64, yield_stress: f64) -> Self {
        self.branches.push(MaxwellBranch { share, time, yield_stress });
        self
    }

    /// The same, with one more family of [fibres](Fibres).
    pub fn fibres(mut self, fibres: Fibres) -> Self {
        self.fibres.push(fibres);
        self
    }

    pub(crate) fn validate(&self) -> Result<(), InputError> {
        self.material.validate()?;
        if let Some(mass) = &self.mass {
            mass.validate()?;
            if !self.is_rigid {
                let help =
                    "only rigid bodies have a prescribed mass: give a density, or rigid = true";
                return Err(InputError::new("material.mass", mass.mass, help));
            }
        }
        not_negative("material.mass_damping", self.mass_damping, "1/s")?;
        self.branches.iter().try_for_each(MaxwellBranch::validate)?;
        self.fibres.iter().try_for_each(Fibres::validate)?;
        match self.law {
            Some(Law::Own(energy)) => energy.validate(self.material.elastic().mu),
            law => law.map_or(Ok(()), Law::validate),
        }
    }
}
