//! Benchmarks of rubber in large motion, which other programs compute, too.

use std::f64::consts::PI;

use crate::base::input::InputError;
use crate::elements::body::{Body, Dilatation};
use crate::elements::material::{Law, Material};
use crate::elements::mesh::{Mesh, Selection, SolidCells};
use crate::scene::timeline::{Phase, Scene};

/// A cantilever under a sudden load.
///
/// It is a block of 0.2 x 0.2 x 2 m (E = 15.293 MPa, nu = 0.3, 1000 kg/m^3, neo-Hookean), clamped at its
/// `bottom`, on whose `top` a traction of (50, 50, 0) kPa of constant direction acts at once, along the
/// diagonal of the cross section; undamped. It bends until the end has moved by more than its length, and
/// swings back. (Ž. Tuković, H. Jasak, Transactions of FAMENA 31 (2007) 55-70.)
///
/// The displacement of the loaded end has a first peak, which is published as 2.80 m at 0.318 s, and is at
/// its least again at 0.646 s. Here the middle of the end has its peak of 2.795 m at 0.3177 s, and its least
/// at 0.644 s; methods agree on all of these digits, and meshes on three (`docs/benchmarks.md` has all
/// numbers).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadedCantilever {
    /// Corner nodes along the axes. Default: 3 x 3 x 21.
    pub nodes: [usize; 3],
    /// Default: hexahedra of 20 nodes.
    pub cells: SolidCells,
    /// Default: at points.
    pub dilatation: Dilatation,
    /// End (s). Default: 0.7.
    pub until: f64,
}

impl Default for LoadedCantilever {
    fn default() -> Self {
        Self {
            nodes: [3, 3, 21],
            cells: SolidCells::Hexahedra20,
            dilatation: Dilatation::AtPoints,
            until: 0.7,
        }
    }
}

impl LoadedCantilever {
    /// The scene.
    ///
    /// # Errors
    /// Fewer than 2 nodes along a side; an end out of range; a mean dilatation of cells that cannot have one.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let &Self { nodes, cells, dilatation, until } = self;
        let rubber = Material { density: 1000.0, young: 15.293e6, poisson: 0.3, viscosity: 0.0 };
        let mesh = Mesh::cuboid([0.2, 0.2, 2.0], nodes, cells)?;
        let body = Body::new(mesh, rubber.law(Law::NeoHookean)).dilatation(dilatation).build()?;
        let swings = Phase::until(until).named("swings").hold("bottom");
        let scene = Scene::new(body).phase(swings.traction("top", [5e4, 5e4, 0.0]));
        scene.validate().map(|()| scene)
    }
}

/// A column that twists.
///
/// It measures 6 x 1 x 1 m, around the x axis (E = 17 MPa, 1100 kg/m^3, neo-Hookean), clamped at x = 0, whose
/// cross sections turn at first about the axis, with the angular velocity 105 rad/s sin(pi x / 12); undamped.
/// (A. J. Gil, C. H. Lee, J. Bonet, M. Aguirre, Computer Methods in Applied Mechanics and Engineering 276
/// (2014) 659-690.) Cells that can lock or break down do so here.
///
/// An edge of the free end has turned by 4.39 rad after 0.05 s (nu = 0.45; 4.43 with 0.495), within 0.02; at
/// most by 5.9 rad (6.0), two digits, after 0.09 s. Methods agree on five digits on each mesh, so the
/// remaining error is that of the meshes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwistingColumn {
    /// Poisson's ratio. Default: 0.45; 0.495 is published, too.
    pub poisson: f64,
    /// Corner nodes along the axes, those across odd for a node on the axis. Default: 13 x 3 x 3.
    pub nodes: [usize; 3],
    /// Default: hexahedra of 20 nodes.
    pub cells: SolidCells,
    /// Default: the mean over cells.
    pub dilatation: Dilatation,
    /// End (s). Default: 0.2.
    pub until: f64,
}

impl Default for TwistingColumn {
    fn default() -> Self {
        Self {
            poisson: 0.45,
            nodes: [13, 3, 3],
            cells: SolidCells::Hexahedra20,
            dilatation: Dilatation::Mean,
            until: 0.2,
        }
    }
}

impl TwistingColumn {
    /// The scene.
    ///
    /// # Errors
    /// Poisson's ratio or an end out of range; fewer than 2 nodes along a side; a mean dilatation of cells
    /// that cannot have one.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let &Self { poisson, nodes, cells, dilatation, until } = self;
        let rubber = Material { density: 1100.0, young: 17e6, poisson, viscosity: 0.0 };
        let mesh = Mesh::cuboid([6.0, 1.0, 1.0], nodes, cells)?.translated(&[0.0, -0.5, -0.5])?;
        let body = Body::new(mesh, rubber.law(Law::NeoHookean)).dilatation(dilatation).build()?;
        let turning = |x: &[f64]| {
            let omega = 105.0 * (PI * x[0] / 12.0).sin();
            vec![0.0, -omega * x[2], omega * x[1]]
        };
        let scene = Scene::new(body)
            .initial_velocity(turning)
            .phase(Phase::until(until).named("twists").hold("left"));
        scene.validate().map(|()| scene)
    }
}

/// The L-shaped block of Simo and Tarnow in free flight.
///
/// Its legs are 6 and 10 m long, 3 m wide and 3 m deep (neo-Hookean, shear modulus 997.5 Pa, bulk modulus
/// 5209 Pa, 100 kg/m^3; undamped). Dead loads of (256, 512, 768) N / 9 m^2 times p(t) on the end of its
/// upright leg, `top`, and the opposite ones on the end of the other leg, `right`, set it in motion, p(t)
/// growing to 2.5 at 2.5 s and falling to 0 at 5 s. Then it tumbles and swings, and keeps its momenta,
/// angular momentum and energy. (J. C. Simo, N. Tarnow, Zeitschrift für angewandte Mathematik und Physik 43
/// (1992) 757-792; programs differ in the moduli and the density.)
///
/// After the loads the angular momentum about the centre of mass is (355.3, 203.4, -254.0) 10^2 N m s and the
/// energy 141.1 10^2 J, each trusted to three digits; the edge at (0, 10, 0) m has moved by (1.29, 0.29,
/// 4.95) m, within 0.01 m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TumblingBlock {
    /// Cells along a metre. Default: 1, which is 117 cells of a grid.
    pub cells_per_metre: usize,
    /// Default: hexahedra of 20 nodes.
    pub cells: SolidCells,
    /// End (s), after 5. Default: 20.
    pub until: f64,
}

impl Default for TumblingBlock {
    fn default() -> Self {
        Self { cells_per_metre: 1, cells: SolidCells::Hexahedra20, until: 20.0 }
    }
}

impl TumblingBlock {
    /// The scene.
    ///
    /// # Errors
    /// No cells along a metre; an end out of range.
    pub fn scene(&self) -> Result<Scene, InputError> {
        let &Self { cells_per_metre, cells, until } = self;
        let nodes = [6, 10, 3].map(|length| length * cells_per_metre + 1);
        let mesh = l_of(Mesh::cuboid([6.0, 10.0, 3.0], nodes, cells)?)?;
        let rubber = Material::of_moduli(100.0, 997.5, 5209.0, 0.0);
        let body = Body::new(mesh, rubber.law(Law::NeoHookean)).build()?;
        let peak = [256.0, 512.0, 768.0].map(|load| 2.5 * load / 9.0);
        let load = |sign: f64| [0.0, sign, 0.0].map(|part| peak.map(|load| part * load).to_vec());
        let times = [0.0, 2.5, 5.0];
        let pushed = Phase::until(5.0)
            .named("pushed")
            .traction_table("top", times, load(1.0))
            .traction_table("right", times, load(-1.0));
        let scene = Scene::new(body).phase(pushed).phase(Phase::until(until).named("tumbles"));
        scene.validate().map(|()| scene)
    }
}

/// A cuboid of 6 x 10 x 3 m without its cells where x and y are above 3 m.
fn l_of(cuboid: Mesh) -> Result<Mesh, InputError> {
    let is_left = |cell: &&[usize]| {
        cell.iter().all(|&node| cuboid.position(node)[0] < 3.001)
            || cell.iter().all(|&node| cuboid.position(node)[1] < 3.001)
    };
    let cells: Vec<&[usize]> = cuboid.cells().filter(is_left).collect();
    let mut numbers = vec![usize::MAX; cuboid.node_count()];
    let mut positions = Vec::new();
    let mut nodes = cells.concat();
    nodes.sort_unstable();
    nodes.dedup();
    for (number, node) in nodes.into_iter().enumerate() {
        numbers[node] = number;
        positions.extend_from_slice(cuboid.position(node));
    }
    let within = |min: [f64; 3], max: [f64; 3]| Selection::Box { min: min.into(), max: max.into() };
    let connectivity = cells.into_iter().flatten().map(|&node| numbers[node]).collect();
    Mesh::new(3, positions, cuboid.kind(), connectivity)?
        .name_nodes("top", within([-1.0, 9.999, -1.0], [7.0, 11.0, 4.0]))?
        .name_nodes("right", within([5.999, -1.0, -1.0], [7.0, 11.0, 4.0]))
}
