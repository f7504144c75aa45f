//! The beam as a model: half of it, on one side of its plane of symmetry.

use pliant::{
    Axis, Body, Dilatation, Law, Material, Mesh, Phase, Sampling, Scene, Selection, Settings,
    SolidCells, Spring, Statics,
};

use super::Outcome;
use super::capture::{MARKERS, Place};

/// Length, half of the width, and height (m).
const SIZE: [f64; 3] = [0.1, 0.015, 0.03];
/// Mass that hangs from the upper edge of the free end (kg).
const HUNG: f64 = 0.052;
/// Length of the thread (m), where it counts as one.
const THREAD: f64 = 0.05;
const GRAVITY: f64 = 9.807;
/// As the article has it (kg/m^3).
const DENSITY: f64 = 1070.0;

/// Discretization and settings of the model.
#[derive(Debug, Clone, Copy)]
pub struct Model {
    pub cells: SolidCells,
    /// Corner nodes along the axes.
    pub nodes: [usize; 3],
    pub law: Law,
    pub poisson: f64,
    pub dilatation: Dilatation,
    /// Tolerance of the runs.
    pub rtol: f64,
}

/// Fitted material parameters.
#[derive(Debug, Clone, Copy)]
pub struct Matter {
    /// Young's modulus (Pa).
    pub young: f64,
    /// Viscous modulus (Pa s): damping in proportion to stiffness.
    pub viscosity: f64,
    /// Damping in proportion to mass (1/s).
    pub drag: f64,
    /// Shares of stiffness and times (s) of Maxwell branches; a share of 0 is none.
    pub branches: [[f64; 2]; 2],
}

/// Load that hangs from the upper edge of the free end.
#[derive(Debug, Clone, Copy)]
pub enum Hung {
    Nothing,
    /// Its weight alone.
    Weight,
    /// A mass that moves with the edge.
    Mass,
    /// A mass on a thread, by its stiffness (N/m) and damping (N s/m). The thread bears nothing at first.
    Thread(f64, f64),
}

/// How the beam was let go.
#[derive(Debug, Clone, Copy)]
pub struct Release {
    /// When (s).
    pub time: f64,
    /// How high (m) its lower edge lay, over that of the straight beam.
    pub lift: f64,
}

impl Model {
    /// How far the markers of the free end have come at `times` (s), in ascending order.
    pub fn moved(
        &self,
        matter: &Matter,
        hung: Hung,
        release: &Release,
        times: &[f64],
    ) -> Outcome<Vec<[Place; 3]>> {
        let [x, y, z] = SIZE;
        let mesh = Mesh::cuboid(SIZE, self.nodes, self.cells)?;
        let edge = numbers(&mesh, [x, 0.0, z], [x, y, z])?;
        let end = End::of(&mesh)?;
        let material = Material {
            density: DENSITY,
            young: matter.young,
            poisson: self.poisson,
            viscosity: matter.viscosity,
        };
        let branches = matter.branches.into_iter().filter(|[share, _]| *share > 0.0);
        let substance = branches.fold(material.law(self.law), |substance, [share, time]| {
            substance.maxwell(share, time)
        });
        let mut body =
            Body::new(mesh, substance.mass_damping(matter.drag)).dilatation(self.dilatation);
        // all that acts node by node is halved
        body = match hung {
            Hung::Nothing | Hung::Weight => body,
            Hung::Mass => body.point_mass("mass", [x, 0.0, z], 0.5 * HUNG),
            Hung::Thread(..) => body.point_mass("mass", [x, 0.0, z - THREAD], 0.5 * HUNG),
        };
        let body = body.build()?;
        let mass = body.mesh().node_count();
        let held = |phase: Phase| {
            let phase = phase
                .hold(near([0.0; 3], [0.0, y, z]))
                .symmetry(near([0.0; 3], [x, 0.0, z]), [0.0, 1.0, 0.0]);
            match hung {
                Hung::Nothing | Hung::Weight | Hung::Thread(..) => phase,
                Hung::Mass => phase.hold_axes("mass", [Axis::X]),
            }
        };
        let has_mass = matches!(hung, Hung::Mass | Hung::Thread(..));
        let scene = Scene::new(body).gravity([0.0, 0.0, -GRAVITY]);

        let lower = near([x, 0.0, 0.0], [x, y, 0.0]);
        let resting = held(Phase::until(1.0)).move_axis(lower, Axis::Z, release.lift);
        let resting = if has_mass { resting.hold("mass") } else { resting };
        let rest = scene.clone().phase(resting).equilibrium(&Statics::default())?;
        let state = rest.trajectory().state(rest.sample());

        // samples lie apart from the start by more than round-off
        let after: Vec<f64> =
            times.iter().map(|time| time - release.time).filter(|time| *time > 1e-6).collect();
        let before = times.len() - after.len();
        let falling = held(Phase::until(after.last().copied().unwrap_or(1.0)));
        let scene = scene.starting_from(&state);
        let scene = match hung {
            Hung::Nothing => scene.phase(falling),
            Hung::Weight => {
                scene.phase(falling.load_total(edge, [0.0, 0.0, -0.5 * HUNG * GRAVITY]))
            }
            Hung::Mass => {
                let part = -1.0 / edge.len() as f64;
                let edge = edge.iter().map(|&node| (node, Axis::Z, part));
                scene.phase(falling.hold_combination(edge.chain([(mass, Axis::Z, 1.0)])))
            }
            Hung::Thread(stiffness, damping) => {
                let above = rest.displacements()[3 * (edge[0] - 1) + 2];
                let thread = Spring::between([edge[0]], "mass")
                    .stiffness(0.5 * stiffness)
                    .damping(0.5 * damping)
                    .length(THREAD + above);
                scene.spring(thread).phase(falling)
            }
        };
        let motion = scene
            .simulate(&Settings { rtol: self.rtol, ..Settings::default() }, &Sampling::at(after))?;
        let start = end.markers(rest.displacements());
        let falling = motion.samples()[1..].iter().map(|sample| {
            let now = end.markers(&sample.u);
            std::array::from_fn(|marker| now[marker] - start[marker])
        });
        Ok(vec![[Place::zeros(); 3]; before].into_iter().chain(falling).collect())
    }

    /// The number of its unknowns.
    pub fn unknowns(&self) -> Outcome<usize> {
        Ok(3 * Mesh::cuboid(SIZE, self.nodes, self.cells)?.node_count())
    }
}

/// Nodes in a box.
fn near(min: [f64; 3], max: [f64; 3]) -> Selection {
    Selection::Box { min: min.map(|x| x - 1e-6).into(), max: max.map(|x| x + 1e-6).into() }
}

/// The same by their numbers, from 1, those in the plane of symmetry first.
fn numbers(mesh: &Mesh, min: [f64; 3], max: [f64; 3]) -> Outcome<Vec<usize>> {
    let mut nodes = mesh.select(&near(min, max))?;
    nodes.sort_by(|a, b| mesh.positions()[3 * a + 1].total_cmp(&mesh.positions()[3 * b + 1]));
    Ok(nodes.into_iter().map(|node| node + 1).collect())
}

/// The face of the free end.
struct End {
    nodes: Vec<usize>,
    /// Where they are to its middle (m), along x and z.
    arms: Vec<[f64; 2]>,
    /// Where its markers are to that.
    markers: [[f64; 2]; 3],
}

impl End {
    fn of(mesh: &Mesh) -> Outcome<Self> {
        let [x, y, z] = SIZE;
        let nodes = mesh.select(&near([x, 0.0, 0.0], [x, y, z]))?;
        let at = |node: usize| [0, 2].map(|axis| mesh.positions()[3 * node + axis]);
        let middle = mean(nodes.iter().map(|&node| at(node)));
        let arm = |[x, z]: [f64; 2]| [x - middle[0], z - middle[1]];
        let arms = nodes.iter().map(|&node| arm(at(node))).collect();
        let markers = std::array::from_fn(|k| arm([x + MARKERS[k][0], MARKERS[k][2]]));
        Ok(Self { nodes, arms, markers })
    }

    /// How far the markers are from where they are on the straight beam, at displacements `u`: they follow the face as if it
    /// were rigid, moved with its middle and turned as it is in the mean.
    fn markers(&self, u: &[f64]) -> [Place; 3] {
        let moved = |node: usize| [u[3 * node], u[3 * node + 2]];
        let middle = mean(self.nodes.iter().map(|&node| moved(node)));
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (&node, [x, z]) in self.nodes.iter().zip(&self.arms) {
            let [ux, uz] = moved(node);
            let [x_now, z_now] = [x + ux - middle[0], z + uz - middle[1]];
            cosine += x * x_now + z * z_now;
            sine += z * x_now - x * z_now;
        }
        let (sine, cosine) = sine.atan2(cosine).sin_cos();
        self.markers.map(|[x, z]| {
            let turned = [cosine * x + sine * z, cosine * z - sine * x];
            Place::new(middle[0] + turned[0] - x, 0.0, middle[1] + turned[1] - z)
        })
    }
}

fn mean(values: impl ExactSizeIterator<Item = [f64; 2]>) -> [f64; 2] {
    let count = values.len() as f64;
    values.fold([0.0; 2], |[x, z], [dx, dz]| [x + dx / count, z + dz / count])
}
