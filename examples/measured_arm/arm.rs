//! The arm as a model, and where its tip is at rest under pressure.

use pliant::{
    Body, CellSelection, Dilatation, Equilibrium, Error, Fibres, Law, Material, Mesh,
    NoEquilibrium, Phase, Sample, Scene, SolidCells, Spring, Stability, Statics,
};

use super::Outcome;
use super::section::{AROUND, Division, Shape, distance, mesh, ribs};

/// Quadratic, lest nearly incompressible rubber locks.
const CELLS: SolidCells = SolidCells::Hexahedra20;
/// As the data's notes have it (kg/m^3).
const DENSITY: f64 = 1070.0;
/// Viscous by Young's modulus (s), as the silicone of the beam was found to have: 654 Pa s, 268.9 kPa.
const RETARDATION: f64 = 654.0 / 268.9e3;
/// How far the markers of the tip are taken to stand off its face (m).
const STAND_OFF: f64 = 0.004;
/// One mbar, in Pa.
const MBAR: f64 = 100.0;

/// Reinforcement of the chambers against widening, in addition to the rubber, and its modulus (Pa).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reinforcement {
    /// Ribs across the chambers, which join their inner and outer walls: the modulus is that of the ribs times the part of the
    /// chamber's length that they fill.
    Ribs(f64),
    /// Rings of fibres around the arm's axis, everywhere.
    Rings(f64),
}

/// A model, but for what is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// But for the walls between the chambers.
    pub shape: Shape,
    pub reinforcement: Reinforcement,
    pub poisson: f64,
    pub division: Division,
    pub dilatation: Dilatation,
}

/// Fitted material parameters.
#[derive(Debug, Clone, Copy)]
pub struct Matter {
    /// Young's modulus of the rubber (Pa).
    pub young: f64,
    /// Thickness of the walls between the chambers (m).
    pub web: f64,
}

/// Where the tip is, from where it was: in the plane of bending away from the inflated chamber, and along the arm (m), and its turn (rad).
#[derive(Debug, Clone, Copy)]
pub struct Tip {
    pub lateral: f64,
    pub axial: f64,
    pub turn: f64,
}

/// An equilibrium.
#[derive(Debug, Clone, Copy)]
pub struct State {
    /// Pressure in the chamber (mbar).
    pub pressure: f64,
    pub tip: Tip,
    /// How much higher, from the duct outwards, the chamber is half-way along it (1), and how much wider the duct is there (1).
    pub higher: f64,
    pub wider: f64,
}

/// Equilibria of the arm under a rising pressure.
pub struct Bent {
    pub states: Vec<State>,
    /// The last equilibrium, or why there is none under the whole pressure.
    pub found: Result<Equilibrium, Box<NoEquilibrium>>,
}

/// Small vibrations about the unloaded shape.
pub struct Ringing {
    /// Hz.
    pub frequency: f64,
    pub damping: f64,
}

impl Model {
    fn shape(&self, matter: &Matter) -> Shape {
        Shape { web: matter.web, ..self.shape }
    }

    fn body(&self, matter: &Matter) -> Result<Body, Error> {
        let mesh = mesh(&self.shape(matter), self.division, CELLS)?;
        let rubber = Material {
            density: DENSITY,
            young: matter.young,
            poisson: self.poisson,
            viscosity: RETARDATION * matter.young,
        };
        let rubber = rubber.law(Law::NeoHookean);
        let mut body = Body::new(mesh, rubber.clone()).dilatation(self.dilatation);
        if let Reinforcement::Rings(modulus) = self.reinforcement {
            for name in AROUND {
                let rings = Fibres::around([0.0; 3], [0.0, 0.0, 1.0], modulus);
                body = body.region(CellSelection::from(name), rubber.clone().fibres(rings));
            }
        }
        Ok(body.build()?)
    }

    fn scene(&self, matter: &Matter, pressure: f64) -> Result<Scene, Error> {
        let phase = Phase::until(1.0).hold("base").symmetry("mirror", [0.0, 1.0, 0.0]);
        let phase = match pressure > 0.0 {
            true => phase.pressure_on("chamber", MBAR * pressure),
            false => phase,
        };
        let body = self.body(matter)?;
        let mut springs = Vec::new();
        if let Reinforcement::Ribs(modulus) = self.reinforcement {
            let mesh = body.mesh();
            let place = |node: usize| [0, 1, 2].map(|axis| mesh.position(node - 1)[axis]);
            for (inner, outer, area) in ribs(mesh, &self.shape(matter), self.division, CELLS)? {
                let stiffness = modulus * area / distance(place(inner), place(outer));
                springs.push(Spring::between([inner], [outer]).stiffness(stiffness));
            }
        }
        Ok(springs.into_iter().fold(Scene::new(body).phase(phase), Scene::spring))
    }

    /// The equilibria under parts of a pressure (mbar), `steps` of the same height.
    pub fn bent(&self, matter: &Matter, pressure: f64, steps: usize) -> Result<Bent, Error> {
        let scene = self.scene(matter, pressure)?;
        let statics = Statics {
            load_steps: steps,
            rtol: 1e-7,
            min_load_step: 0.02,
            max_iterations: 30,
            ..Statics::default()
        };
        let found = match scene.equilibrium(&statics) {
            Ok(found) => Ok(found),
            Err(Error::Statics(none)) => Err(none),
            Err(error) => return Err(error),
        };
        let trajectory = match &found {
            Ok(found) => found.trajectory(),
            Err(none) => &none.trajectory,
        };
        let points = Points::of(trajectory.body().mesh(), &self.shape(matter))?;
        let rest = points.tip(&trajectory.samples()[0]);
        let at = |sample: &Sample| {
            let tip = points.tip(sample);
            State {
                pressure: pressure * sample.sensors.first().copied().unwrap_or(1.0),
                tip: Tip {
                    lateral: rest.lateral - tip.lateral,
                    axial: tip.axial - rest.axial,
                    turn: tip.turn - rest.turn,
                },
                higher: points.stretch(sample, points.chamber) - 1.0,
                wider: points.stretch(sample, points.duct) - 1.0,
            }
        };
        let states = trajectory.samples()[1..].iter().map(at).collect();
        Ok(Bent { states, found })
    }

    /// How it rings without pressure.
    pub fn ringing(&self, matter: &Matter) -> Outcome<Ringing> {
        let spectrum = self.scene(matter, 0.0)?.spectrum()?[0];
        let omega = spectrum.lowest_frequency.ok_or("nothing vibrates")?;
        Ok(Ringing {
            frequency: omega / std::f64::consts::TAU,
            damping: spectrum.lowest_damping_ratio,
        })
    }

    /// The number of its unknowns, and its mass (kg) as a whole arm.
    pub fn size(&self, matter: &Matter) -> Outcome<(usize, f64)> {
        let body = self.body(matter)?;
        Ok((body.dofs(), 2.0 * body.mass()))
    }
}

impl Bent {
    /// The state under a pressure (mbar), if there is one.
    pub fn at(&self, pressure: f64) -> Option<&State> {
        self.states.iter().find(|state| (state.pressure - pressure).abs() < 1e-6)
    }

    /// The lowest natural frequency (Hz) under the last pressure, if the arm is stable there.
    pub fn frequency(&self) -> Option<f64> {
        match &self.found {
            Ok(Equilibrium { stability: Stability::Stable { frequency }, .. }) => Some(*frequency),
            _ => None,
        }
    }
}

/// A node, and where it is along x and z (m).
type Placed = (usize, [f64; 2]);

/// Observed nodes, with their positions.
struct Points {
    /// Nodes of the tip's face, and where they are (m).
    tip: Vec<Placed>,
    /// Nodes half-way along it, at both ends of the height of the chamber, and of the width of the duct.
    chamber: [Placed; 2],
    duct: [Placed; 2],
}

impl Points {
    fn of(mesh: &Mesh, shape: &Shape) -> Result<Self, Error> {
        let place = |node: usize| [0, 2].map(|axis| mesh.position(node)[axis]);
        let tip = mesh.sets()["tip"].iter().map(|&node| (node, place(node))).collect();
        let mirror = &mesh.sets()["mirror"];
        let nearest = |x: f64| {
            let distance = |node: &&usize| {
                let [own, z] = place(**node);
                (own - x).hypot(z - 0.5 * (shape.length - shape.bottom))
            };
            let node = mirror.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let node = *node.unwrap_or(&0);
            (node, place(node))
        };
        let Shape { duct, inner_wall, radius, outer_wall, .. } = *shape;
        Ok(Self {
            tip,
            chamber: [nearest(duct + inner_wall), nearest(radius - outer_wall)],
            duct: [nearest(-duct), nearest(duct)],
        })
    }

    /// The rigid motion of the tip's face: of the place at which it meets the axis, along x and z, and about y.
    fn tip(&self, sample: &Sample) -> Tip {
        let moved = |node: usize| [sample.u[3 * node], sample.u[3 * node + 2]];
        let count = self.tip.len() as f64;
        let mean = |of: &dyn Fn(&Placed) -> [f64; 2]| {
            let sum = self.tip.iter().map(of).fold([0.0; 2], |[x, z], [dx, dz]| [x + dx, z + dz]);
            sum.map(|sum| sum / count)
        };
        let natural = mean(&|(_, place)| *place);
        let shift = mean(&|(node, _)| moved(*node));
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (node, place) in &self.tip {
            let [ux, uz] = moved(*node);
            let [x, z] = [place[0] - natural[0], place[1] - natural[1]];
            let [x_now, z_now] = [x + ux - shift[0], z + uz - shift[1]];
            cosine += x * x_now + z * z_now;
            sine += x * z_now - z * x_now;
        }
        let turn = sine.atan2(cosine);
        // from the middle of the nodes to the axis, and to the plane of the markers
        let (sine, cosine) = turn.sin_cos();
        let [x, z] = [-natural[0], STAND_OFF];
        Tip {
            lateral: shift[0] + x * (cosine - 1.0) - z * sine,
            axial: shift[1] + x * sine + z * (cosine - 1.0),
            turn,
        }
    }

    /// The distance of two nodes by what it was.
    fn stretch(&self, sample: &Sample, [a, b]: [Placed; 2]) -> f64 {
        let now = |(node, [x, z]): Placed| [x + sample.u[3 * node], z + sample.u[3 * node + 2]];
        let length = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        length(now(a), now(b)) / length(a.1, b.1)
    }
}
