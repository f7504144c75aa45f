//! Muscles against closed forms: blocks that contract by the equilibrium of their law, a strip of two layers that
//! bends as Timoshenko's does, and the work of a stress that is constant.

use crate::common::{curvature, run};
use pliant::{
    Body, CellSelection, Cells, Error, Material, Mesh, Method, Muscle, Phase, Plane, Sampling,
    Scene, Settings, SolidCells, Spring, Statics, Strain, simulate::Reading,
};

const YOUNG: f64 = 1e5; // Pa

fn material(poisson: f64, viscosity: f64) -> Material {
    Material { density: 1000.0, young: YOUNG, poisson, viscosity }
}

/// The stretch at which (`YOUNG`/2) (l^3 - l) = -`stress`: a bar of St. Venant and Kirchhoff's material whose force per section
/// is that.
fn stretch_under(stress: f64) -> f64 {
    let mut l = 1.0_f64;
    for _ in 0..50 {
        l -= (0.5 * YOUNG * (l.powi(3) - l) + stress) / (0.5 * YOUNG * (3.0 * l * l - 1.0));
    }
    l
}

/// Under stress along one direction St. Venant and Kirchhoff's material stretches as a bar whatever Poisson's ratio is: a bar, a square in plane
/// stress and a cube, of which pulls along the first axis, in both directions of it, and a push are held against its equation.
#[test]
fn blocks_contract_by_their_law() {
    let plane = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles6).unwrap();
    let solid = Mesh::cuboid([0.1; 3], [3, 3, 3], SolidCells::Hexahedra).unwrap();
    let bodies = [
        Body::new(Mesh::bar(0.1, 3).unwrap(), material(0.3, 0.0)).area(1e-4),
        Body::new(plane, material(0.3, 0.0)).thickness(0.01).plane(Plane::Stress),
        Body::new(solid, material(0.3, 0.0)),
    ];
    for body in bodies {
        let body = body.build().unwrap();
        let d = body.dimension();
        let far = (0..body.mesh().node_count()).find(|node| body.mesh().position(*node)[0] > 0.09);
        let cases = [(2.0, 0.15 * YOUNG), (-2.0, 0.15 * YOUNG), (2.0, -0.3 * YOUNG)];
        for (direction, stress) in cases {
            let mut along = vec![0.0; d];
            along[0] = direction;
            let axes = [pliant::Axis::X, pliant::Axis::Y, pliant::Axis::Z];
            let mut phase = Phase::until(1.0).actuate(["m"], stress);
            for (axis, set) in axes.into_iter().zip(["left", "bottom", "back"]).take(d) {
                let zero = |node: &usize| body.mesh().position(*node)[axis.index()] == 0.0;
                let nodes = (0..body.mesh().node_count()).filter(zero).map(|node| node + 1);
                let nodes: Vec<usize> = nodes.collect();
                assert!(!nodes.is_empty(), "{set}");
                phase = phase.hold_axes(nodes, [axis]);
            }
            let muscle = Muscle::along(along).named("m");
            let scene = Scene::new(body.clone()).muscle(muscle).phase(phase);
            let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
            let stretch = 1.0 + equilibrium.trajectory().last().u[d * far.unwrap()] / 0.1;
            let off = (stretch / stretch_under(stress) - 1.0).abs();
            println!("{d} dimensions, {stress} Pa: {stretch}, off by {off:.1e}");
            assert!(off < 1e-12, "{d} dimensions, {stress} Pa: {stretch}, off by {off:e}");
        }
    }
}

/// A muscle in the upper half of a strip of height h shortens it by s/E against the lower half, which bends it to the curvature 1.5 s/(E h)
/// (S. Timoshenko, Journal of the Optical Society of America 11 (1925) 233-255, two layers of one kind). The same muscle on a mesh
/// that is twice as fine does the same.
#[test]
fn a_strip_bends_as_two_layers_do() {
    let [length, height] = [0.2, 0.01];
    let columns = 41;
    let mesh = Mesh::rectangle([length, height], [columns, 5], Cells::Rectangles9).unwrap();
    let body = Body::new(mesh, material(0.0, 0.0)).thickness(0.01).build().unwrap();
    let upper = CellSelection::inside([0.0, 0.5 * height], [length, height]);
    let stress = 1e-4 * YOUNG;
    let scene = Scene::new(body)
        .muscle(Muscle::along([1.0, 0.0]).within(upper).named("upper"))
        .phase(Phase::until(1.0).hold("left").actuate(["upper"], stress));
    for scene in [scene.clone(), scene.halved().unwrap()] {
        let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
        let curvature = curvature(&equilibrium, [length, height]);
        let off = curvature / (1.5 * stress / (YOUNG * height)) - 1.0;
        println!("curvature {curvature} 1/m, off by {off:.1e}");
        // strains of 1e-4 change St. Venant and Kirchhoff's stiffness by as much
        assert!(off.abs() < 3e-4, "{curvature} 1/m, off by {off:e}");
    }
}

/// A constant stress s supplies -s V (l - 1) while a body of the volume V vibrates, the stretch l being the mean over its fibres, whatever
/// the integrator: here rings that close a disc.
#[test]
fn a_constant_stress_supplies_its_potential() {
    let mesh = Mesh::ring(0.02, 0.04, [24, 4], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, material(0.3, 20.0)).thickness(0.01).build().unwrap();
    let volume = body.volume();
    let stress = 5e3;
    let scene = Scene::new(body)
        .muscle(Muscle::around([0.0, 0.0], []).named("ring"))
        .phase(Phase::until(0.05).actuate(["ring"], stress));
    let sampling = Sampling::phase_ends()
        .read("stretch", Reading::muscle_stretch("ring"))
        .read("stress", Reading::muscle_stress("ring"));
    for method in [Method::CvodeBdf, Method::Arkode, Method::Rk, Method::Rosenbrock] {
        let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
        let motion = scene.simulate(&settings, &sampling).unwrap();
        let last = motion.last();
        assert_eq!(last.sensors[1], stress);
        let expected = -stress * volume * (last.sensors[0] - 1.0);
        let off = last.energy.supplied / expected - 1.0;
        println!("{method}: stretch {}, supplied off by {off:.1e}", last.sensors[0]);
        assert!(last.sensors[0] < 0.98 && off.abs() < 2e-8, "{method}: {off:e}");
    }
}

/// A command that sets the stress of a muscle does what a phase with it does, and a checkpoint keeps it.
#[test]
fn muscles_are_driven() {
    let mesh = Mesh::rectangle([0.1, 0.01], [11, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, material(0.3, 200.0)).thickness(0.01).build().unwrap();
    let upper = CellSelection::Numbers((11..=20).collect());
    let scene = |phase: Phase| {
        Scene::new(body.clone())
            .muscle(Muscle::along([1.0, 0.0]).within(upper.clone()))
            .phase(phase.hold("left"))
    };
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let given = run(&scene(Phase::until(0.1).actuate(["muscle 1"], 2e3)), &settings, &[]);
    let mut driven = scene(Phase::until(0.1)).start(&settings).unwrap();
    driven.actuate("muscle 1", 2e3).unwrap();
    driven.advance_to(0.05).unwrap();
    let kept = driven.checkpoint();
    driven.actuate("muscle 1", -1e3).unwrap();
    driven.advance_to(0.1).unwrap();
    driven.restore(&kept).unwrap();
    assert_eq!(driven.view().actuation("muscle 1").unwrap(), 2e3);
    driven.advance_to(0.1).unwrap();
    let tip = 2 * 32 + 1;
    let [a, b] = [given.last().u[tip], driven.view().displacements()[tip]];
    println!("{a} m and {b} m");
    assert!(a > 1e-3 && (a - b).abs() < 1e-9 * a, "{a} {b}");
}

#[test]
fn muscles_that_cannot_be() {
    let mesh = || Mesh::rectangle([0.02, 0.02], [3, 3], Cells::Rectangles).unwrap();
    let body = |strain| Body::new(mesh(), material(0.3, 1.0)).thickness(0.01).strain(strain);
    let refused = |body: pliant::body::BodyBuilder, muscle: Muscle, parts: &[&str]| {
        let scene = Scene::new(body.build().unwrap()).muscle(muscle.named("m"));
        let error: Error = scene.phase(Phase::until(0.1)).validate().unwrap_err().into();
        assert!(parts.iter().all(|part| error.to_string().contains(part)), "{error}");
    };
    let soft = || body(Strain::Green);
    let along = || Muscle::along([1.0, 0.0]);
    refused(soft(), Muscle::along([0.0, 0.0]), &["muscle \"m\" fibres.along", "above 0"]);
    refused(soft(), Muscle::along([1.0]), &["muscle \"m\" fibres.along", "2 numbers"]);
    refused(soft(), along().within("biceps"), &["muscle \"m\"", "\"biceps\"", "no groups"]);
    refused(body(Strain::Cauchy), along(), &["muscle \"m\" strain", "Green's"]);
    let rigid = soft().region(CellSelection::Numbers(vec![2]), Material::rigid(1e3));
    refused(rigid, along(), &["muscle \"m\" cell = 2", "rigid"]);
    let scene = || Scene::new(soft().build().unwrap()).muscle(along().named("m"));
    let says = |scene: Scene, parts: &[&str]| {
        let error = scene.validate().unwrap_err().to_string();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    };
    let phase = || Phase::until(0.1);
    says(scene().phase(phase().actuate(["n"], 1.0)), &["\"n\"", "actuators \"m\""]);
    let spring = Spring::between([1], [9]).named("m").stiffness(1.0);
    says(scene().spring(spring).phase(phase()), &["muscle name = \"m\"", "taken"]);
    says(scene().phase(phase().actuate(["m"], f64::NAN)), &["NaN"]);
}
