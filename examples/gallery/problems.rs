//! The problems of the gallery.

use clap::ValueEnum;
use pliant::samples::{self, ClampedBeam, RingRoll};
use pliant::study::{Problem, Scenes, all_methods};
use pliant::{
    Body, Cells, Dilatation, Error, Inertia, InputError, Law, Material, Mesh, Phase, Scene,
    Settings, SolidCells, Strain,
};

/// In the order of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Sample {
    BeamJump,
    SquarePress,
    SquareJump,
    SquareJump10,
    Membrane,
    MembraneArch,
    BeamBend,
    BeamBendCauchy,
    RingRoll,
    RingSprings,
    RingJump,
    Report8,
    ClampedBeam,
    ClampedBeamDamped,
    ClampedBeamLumped,
    ClampedBeamLumpedDamped,
    ClampedBeamMeshes,
    RubberStVenantKirchhoff,
    RubberNeoHookean,
}

/// Viscosity of the damped clamped beam (Pa s): 1 % of critical damping in its lowest mode.
const LIGHT: f64 = 4000.0;

impl Sample {
    /// As in arguments and names of files.
    pub fn name(self) -> String {
        self.to_possible_value().expect("none is skipped").get_name().to_owned()
    }

    /// Over chart and section.
    pub fn title(self) -> &'static str {
        match self {
            Self::BeamJump => "Jumping beam",
            Self::SquarePress => "Pressed square, 4 x 4 nodes",
            Self::SquareJump => "Jumping square, 4 x 4 nodes",
            Self::SquareJump10 => "Jumping square, 10 x 10 nodes",
            Self::Membrane => "Membrane",
            Self::MembraneArch => "Arched membrane",
            Self::BeamBend => "Bent beam, Green strain",
            Self::BeamBendCauchy => "Bent beam, Cauchy strain",
            Self::RingRoll => "Rolling ring",
            Self::RingSprings => "Ring with springs, walking",
            Self::RingJump => "Ring with springs, jumping",
            Self::Report8 => "Sheared block",
            Self::ClampedBeam => "Clamped beam, undamped",
            Self::ClampedBeamDamped => "Clamped beam, lightly damped",
            Self::ClampedBeamLumped => "Clamped beam, undamped, lumped inertia",
            Self::ClampedBeamLumpedDamped => "Clamped beam, lightly damped, lumped inertia",
            Self::ClampedBeamMeshes => "Clamped beam, mesh by mesh",
            Self::RubberStVenantKirchhoff => {
                "Bent rubber, St. Venant and Kirchhoff's law, mesh by mesh"
            }
            Self::RubberNeoHookean => "Bent rubber, neo-Hookean, mesh by mesh",
        }
    }

    /// Whether its lines are methods, and not meshes.
    pub fn compares_methods(self) -> bool {
        use Sample::{ClampedBeamMeshes, RubberNeoHookean, RubberStVenantKirchhoff};
        !matches!(self, ClampedBeamMeshes | RubberStVenantKirchhoff | RubberNeoHookean)
    }

    /// To be solved at these `tolerances`.
    pub fn problem(self, tolerances: &[f64]) -> Result<Box<dyn Problem>, Error> {
        let beam = |inertia, viscosity| {
            ClampedBeam { inertia, viscosity, ..ClampedBeam::default() }.scene()
        };
        let scene = match self {
            Self::BeamJump => samples::beam_jump(),
            Self::SquarePress => samples::square_press(4),
            Self::SquareJump => samples::square_jump(4),
            Self::SquareJump10 => samples::square_jump(10),
            Self::Membrane => samples::membrane(),
            Self::MembraneArch => samples::membrane_arch(),
            Self::BeamBend => samples::beam_bend(Strain::Green, false),
            Self::BeamBendCauchy => samples::beam_bend(Strain::Cauchy, false),
            Self::RingRoll => RingRoll::default().scene(),
            Self::RingSprings => samples::ring_springs(1.0),
            Self::RingJump => samples::ring_jump(),
            Self::Report8 => samples::report_8(),
            Self::ClampedBeam => beam(Inertia::Consistent, 0.0),
            Self::ClampedBeamDamped => beam(Inertia::Consistent, LIGHT),
            Self::ClampedBeamLumped => beam(Inertia::Lumped, 0.0),
            Self::ClampedBeamLumpedDamped => beam(Inertia::Lumped, LIGHT),
            Self::ClampedBeamMeshes => return Ok(Box::new(meshes(self.title())?)),
            Self::RubberStVenantKirchhoff => return Ok(Box::new(rubber(self.title(), None)?)),
            Self::RubberNeoHookean => return Ok(Box::new(rubber(self.title(), Law::NeoHookean)?)),
        };
        let scenes = Scenes::new(self.title(), scene?).tolerances(tolerances);
        let lines = all_methods().into_iter();
        Ok(Box::new(lines.fold(scenes, |scenes, (name, settings)| scenes.line(name, settings))))
    }
}

/// The damped clamped beam on meshes of all kinds, against a fine one of quadratic triangles.
fn meshes(title: &str) -> Result<Scenes, Error> {
    let beam = |cells, [along, across]: [usize; 2]| -> Result<Scene, InputError> {
        let nodes = [along + 1, across + 1];
        ClampedBeam { nodes, cells, viscosity: LIGHT, ..ClampedBeam::default() }.scene()
    };
    // The integration is much more precise than any of these meshes.
    let settings = Settings { rtol: 1e-5, ..Settings::default() };
    let mut scenes = Scenes::new(title, beam(Cells::Triangles6, [140, 8])?)
        .checked_by(beam(Cells::Triangles6, [105, 6])?)
        .finest(1e-3);
    for cells in Cells::ALL {
        let grids = match cells {
            Cells::Triangles6 => vec![[35, 2], [70, 4]],
            _ => vec![[35, 2], [70, 4], [140, 8], [280, 16]],
        };
        let mesh = |[along, across]: [usize; 2]| {
            Ok((format!("{along} x {across}"), beam(cells, [along, across])?))
        };
        let meshes = grids.into_iter().map(mesh).collect::<Result<Vec<_>, Error>>()?;
        scenes = scenes.meshes(cells.name(), meshes, &settings);
    }
    Ok(scenes)
}

/// A cantilever of rubber by a `law`, St. Venant and Kirchhoff's if none, on meshes of all solid cells with and without a mean dilatation.
fn rubber(title: &str, law: impl Into<Option<Law>>) -> Result<Scenes, Error> {
    let law = law.into();
    let settings = Settings { rtol: 1e-4, ..Settings::default() };
    let mean = Dilatation::Mean;
    let mut scenes = Scenes::new(title, bent_rubber(law, SolidCells::Hexahedra20, mean, 6)?)
        .checked_by(bent_rubber(law, SolidCells::Hexahedra20, mean, 5)?)
        .finest(1e-3);
    for (name, cells, dilatation, across) in [
        ("tetrahedra", SolidCells::Tetrahedra, Dilatation::AtPoints, [1, 2, 4]),
        ("hexahedra", SolidCells::Hexahedra, Dilatation::AtPoints, [1, 2, 4]),
        ("hexahedra, mean", SolidCells::Hexahedra, mean, [1, 2, 4]),
        ("tetrahedra10", SolidCells::Tetrahedra10, Dilatation::AtPoints, [1, 2, 3]),
        ("tetrahedra10, mean", SolidCells::Tetrahedra10, mean, [1, 2, 3]),
        ("hexahedra20", SolidCells::Hexahedra20, Dilatation::AtPoints, [1, 2, 3]),
        ("hexahedra20, mean", SolidCells::Hexahedra20, mean, [1, 2, 3]),
    ] {
        let mesh = |n: usize| -> Result<(String, Scene), InputError> {
            Ok((format!("{} x {n} x {n}", 4 * n), bent_rubber(law, cells, dilatation, n)?))
        };
        let meshes = across.into_iter().map(mesh).collect::<Result<Vec<_>, _>>()?;
        scenes = scenes.meshes(name, meshes, &settings);
    }
    Ok(scenes)
}

/// A block of 12 x 3 x 3 cm with `across` cells along its short sides, nearly incompressible and lightly damped, clamped at
/// one end; a load that acts at once on the other one bends it until that has moved by 30 % of its length.
fn bent_rubber(
    law: Option<Law>,
    cells: SolidCells,
    dilatation: Dilatation,
    across: usize,
) -> Result<Scene, InputError> {
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 200.0 };
    let substance = law.map_or(rubber.into(), |law| rubber.law(law));
    let mesh = Mesh::cuboid([0.12, 0.03, 0.03], [4 * across + 1, across + 1, across + 1], cells)?;
    let body = Body::new(mesh, substance).strain(Strain::Green).dilatation(dilatation).build()?;
    let bends = Phase::until(0.05).hold("left").traction("right", [0.0, 0.0, -2400.0]);
    Ok(Scene::new(body).phase(bends))
}
