//! The problems of the gallery.

use clap::ValueEnum;
use pliant::samples::{self, ClampedBeam, RingRoll};
use pliant::study::{Problem, Scenes, all_methods};
use pliant::{Cells, Error, Inertia, InputError, Method, Scene, Settings, Strain};

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
        }
    }

    /// Whether its lines are methods, and not meshes.
    pub fn compares_methods(self) -> bool {
        self != Self::ClampedBeamMeshes
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
        };
        let scenes = Scenes::new(self.title(), scene?).tolerances(tolerances);
        let all = all_methods().into_iter();
        // KLU takes the steps of the structured settings
        let lines = all.filter(|(_, settings)| settings.method != Method::IdaKlu);
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
