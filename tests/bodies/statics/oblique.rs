//! Bodies that planes of symmetry off the axes hold, or rows that tie several nodes, against the same ones along the axes.

use pliant::{
    Axis, Body, Cells, Equilibrium, Law, Material, Mesh, Phase, Scene, SolidCells, Statics, Strain,
};

use super::frequency;

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.45, viscosity: 0.0 };

type Turn = [[f64; 3]; 3];

fn turned(turn: &Turn, x: &[f64]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| turn[i][j] * x[j]).sum())
}

/// About x, then about z.
fn turn(about_x: f64, about_z: f64) -> Turn {
    let ((p, q), (s, c)) = (about_x.sin_cos(), about_z.sin_cos());
    [[c, -s * q, s * p], [s, c * q, -c * p], [0.0, p, q]]
}

/// An eighth of a cube of 4 cm, pulled along its first axis, turned as a whole.
fn cube(turn: &Turn, pull: f64) -> Equilibrium {
    let mesh = Mesh::cuboid([0.02; 3], [3; 3], SolidCells::Hexahedra20).unwrap();
    let mesh = mesh.mapped(|x| turned(turn, x)).unwrap();
    let body = Body::new(mesh, RUBBER.law(Law::NeoHookean)).build().unwrap();
    let normal =
        |axis: usize| turned(turn, &std::array::from_fn::<_, 3, _>(|i| f64::from(i == axis)));
    let phase = Phase::until(1.0)
        .symmetry("left", normal(0))
        .symmetry("front", normal(1))
        .symmetry("bottom", normal(2))
        .pressure_on("right", -pull);
    Scene::new(body).phase(phase).equilibrium(&Statics::default()).unwrap()
}

/// Planes that lie along the axes but for round-off, a little askew, and wholly: from loads that strain the cube by 1e-5 to 5 %.
#[test]
fn planes_of_symmetry_hold_as_well_off_the_axes() {
    for pull in [1.0, 100.0, 5000.0] {
        let straight = cube(&turn(0.0, 0.0), pull);
        let size = straight.displacements().iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        for (about_x, about_z) in [(0.0, 1e-9), (0.0, 0.1), (0.4, 0.7)] {
            let turn = turn(about_x, about_z);
            let askew = cube(&turn, pull);
            let apart = straight.displacements().chunks(3).zip(askew.displacements().chunks(3));
            let apart = apart.flat_map(|(straight, askew)| {
                let expected = turned(&turn, straight);
                (0..3).map(|i| (askew[i] - expected[i]).abs()).collect::<Vec<_>>()
            });
            let apart = apart.fold(0.0, f64::max) / size;
            let [here, there] = [&straight, &askew].map(frequency);
            println!(
                "{pull} Pa, {about_x} {about_z}: {apart:.1e}, {:.1e}, {askew}",
                there / here - 1.0
            );
            assert!(apart < 1e-9, "{pull} Pa, {about_x} {about_z}: {apart}");
            // where the iteration for it ends, since frequencies of a cube lie close to each other; measured: 1.8e-5
            assert!((there / here - 1.0).abs() < 5e-5, "{here} {there}");
            assert!(askew.iterations <= straight.iterations + 2, "{straight}; {askew}");
        }
    }
}

/// A plate on a pin, which a row of two nodes keeps from turning: the pinned one has no part in it, so that it says what
/// holding the other node does.
#[test]
fn rows_of_several_nodes_hold_a_body() {
    let mesh = Mesh::rectangle([0.1, 0.02], [21, 5], Cells::Triangles6).unwrap();
    for strain in [Strain::Cauchy, Strain::Green] {
        let body = Body::new(mesh.clone(), RUBBER).thickness(0.01).strain(strain).build().unwrap();
        let found = |hold: fn(Phase) -> Phase| {
            let phase = hold(Phase::until(1.0).hold([1])).load_total("right", [0.002, -0.001]);
            Scene::new(body.clone()).phase(phase).equilibrium(&Statics::default()).unwrap()
        };
        let by_node = found(|phase| phase.hold_axes([21], [Axis::Y]));
        let by_row =
            found(|phase| phase.hold_combination([(1, Axis::Y, -1.0), (21, Axis::Y, 1.0)]));
        let [expected, u] = [&by_node, &by_row].map(Equilibrium::displacements);
        let size = expected.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        let apart = u.iter().zip(expected).map(|(u, expected)| (u - expected).abs());
        let apart = apart.fold(0.0, f64::max) / size;
        let [here, there] = [&by_node, &by_row].map(frequency);
        println!("{strain:?}: {apart:.1e}; {by_node}; {by_row}");
        assert!(apart < 1e-9 && (there / here - 1.0).abs() < 1e-6, "{apart} {here} {there}");
    }
}
