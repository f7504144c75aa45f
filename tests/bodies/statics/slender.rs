//! Slender bodies, which resist stretching far more than bending, turn far within a few iterations.

use pliant::mesh::SolidCells;
use pliant::{
    Body, Cells, Equilibrium, Guide, Law, Material, Mesh, Phase, Plane, Scene, Spring, Statics,
    Strain,
};

const LENGTH: f64 = 0.2;

fn rubber(young: f64, poisson: f64) -> Material {
    Material { density: 1000.0, young, poisson, viscosity: 0.0 }
}

/// In so many iterations for each load step at most, without a step that failed.
fn is_soon_found(found: &Equilibrium, most: usize) {
    println!("{found}");
    assert_eq!((found.failed_steps, found.damped_steps), (0, 0), "{found}");
    assert!(found.iterations <= most * found.load_steps, "{found}");
}

/// How far the right end comes down along `down`, and nearer, as parts of the length, under a dead load P of all its nodes
/// with P L^2/(E I) = 10.
fn ends(body: Body, rigidity: f64, down: &[f64], load_steps: usize, most: usize) -> [f64; 2] {
    let load = 10.0 * rigidity / (LENGTH * LENGTH);
    let force: Vec<f64> = down.iter().map(|d| load * d).collect();
    let scene = Scene::new(body).phase(Phase::until(1.0).hold("left").load_total("right", force));
    let found = scene.equilibrium(&Statics { load_steps, ..Statics::default() }).unwrap();
    is_soon_found(&found, most);
    let mesh = scene.body().mesh();
    let (right, d) = (mesh.select(&"right".into()).unwrap(), mesh.dimension());
    let mean = |axis: usize| {
        let sum: f64 = right.iter().map(|node| found.displacements()[d * node + axis]).sum();
        sum / right.len() as f64 / LENGTH
    };
    [(0..d).map(|axis| down[axis] * mean(axis)).sum(), -mean(0)]
}

/// The elastica comes down by 0.81061 L, and nearer by 0.55500 L (K. Mattiasson, *Numerical results from large deflection beam and frame
/// problems analysed by means of elliptic integrals*, Int. J. Numer. Methods Eng. 17, 1981): in the plane, and in space across a square section.
#[test]
fn a_cantilever_is_the_elastica() {
    let ([height, thickness], young) = ([0.002, 0.01], 1e6);
    let mesh = Mesh::rectangle([LENGTH, height], [61, 3], Cells::Rectangles9).unwrap();
    let strip = Body::new(mesh, rubber(young, 0.0)).thickness(thickness).plane(Plane::Stress);
    let strip = strip.strain(Strain::Green).build().unwrap();
    let side = 0.004;
    let mesh = Mesh::cuboid([LENGTH, side, side], [31, 2, 2], SolidCells::Hexahedra20).unwrap();
    let rod = Body::new(mesh, rubber(young, 0.0)).strain(Strain::Green).build().unwrap();
    let moments = [thickness * f64::powi(height, 3) / 12.0, f64::powi(side, 4) / 12.0];
    for load_steps in [1, 4] {
        let in_plane = ends(strip.clone(), young * moments[0], &[0.0, -1.0], load_steps, 10);
        let in_space = ends(rod.clone(), young * moments[1], &[0.0, -0.6, -0.8], load_steps, 12);
        for [down, nearer] in [in_plane, in_space] {
            println!("{down} {nearer}");
            assert!((down - 0.81061).abs() < 2e-3 && (nearer - 0.55500).abs() < 2e-3);
        }
    }
}

/// An arm that tapers to a quarter curls on a tendon: in few steps as in many.
#[test]
fn a_tapered_arm_curls_on_a_tendon() {
    let [base, tip] = [0.02, 0.005];
    let grid = Mesh::rectangle([LENGTH, 1.0], [41, 3], Cells::Rectangles9).unwrap();
    let mut positions = grid.positions().to_vec();
    for place in positions.as_chunks_mut::<2>().0 {
        place[1] = (place[1] - 0.5) * (base + (tip - base) * place[0] / LENGTH);
    }
    let cells = grid.cells().flatten().copied().collect();
    let mut mesh = Mesh::new(2, positions, grid.kind(), cells).unwrap();
    for side in ["left", "top"] {
        let nodes = grid.select(&side.into()).unwrap().into_iter().map(|node| node + 1);
        mesh = mesh.name_nodes(side, nodes.collect::<Vec<_>>()).unwrap();
    }
    let material = rubber(1e5, 0.45).law(Law::NeoHookean);
    let body = Body::new(mesh, material).thickness(0.06).plane(Plane::Stress).build().unwrap();
    let scene = Scene::new(body)
        .spring(Spring::cable([Guide::nodes("top")]).named("tendon"))
        .phase(Phase::until(1.0).hold("left").actuate(["tendon"], 7.7));
    let [few, many] = [4, 32].map(|load_steps| {
        let found = scene.equilibrium(&Statics { load_steps, ..Statics::default() }).unwrap();
        is_soon_found(&found, 17);
        found
    });
    let apart = few.displacements().iter().zip(many.displacements());
    let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{apart} m apart");
    assert!(apart < 1e-8 * LENGTH, "{apart}");
}
