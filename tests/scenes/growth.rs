//! Growth against closed forms: what is free is without stress, a bar that is held, Timoshenko's bimetal strip, and the balance of energy while
//! it grows.

use crate::common::{curvature, run};
use pliant::{
    Axis, Body, CellSelection, Cells, Error, Growth, Law, Material, Mesh, Method, Phase, Plane,
    Sampling, Scene, Settings, Signal, SolidCells, Statics, Strain, simulate::Reading,
};

const YOUNG: f64 = 1e5; // Pa

fn material(poisson: f64, viscosity: f64) -> Material {
    Material { density: 1000.0, young: YOUNG, poisson, viscosity }
}

/// The phase in which nodes at 0 along an axis stay there.
fn on_planes(body: &Body, phase: Phase) -> Phase {
    [Axis::X, Axis::Y, Axis::Z].into_iter().take(body.dimension()).fold(phase, |phase, axis| {
        let zero = |node: &usize| body.mesh().position(*node)[axis.index()] == 0.0;
        let nodes = (0..body.mesh().node_count()).filter(zero).map(|node| node + 1);
        phase.hold_axes(nodes.collect::<Vec<usize>>(), [axis])
    })
}

/// What is free grows without stress, whatever its law, its cells and its dilatation: a bar, squares in plane stress and cubes.
#[test]
fn free_growth_has_no_stress() {
    let plane = || Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Rectangles).unwrap();
    let solid = |cells| Mesh::cuboid([0.1; 3], [3, 3, 3], cells).unwrap();
    let own = || material(0.45, 0.0);
    let bodies = [
        Body::new(Mesh::bar(0.1, 3).unwrap(), own()).area(1e-4),
        Body::new(plane(), own()).thickness(0.01).plane(Plane::Stress),
        Body::new(plane(), own().law(Law::NeoHookean)).thickness(0.01).plane(Plane::Stress),
        Body::new(solid(SolidCells::Hexahedra), own().law(Law::Corotated)),
        Body::new(solid(SolidCells::Hexahedra), own().law(Law::NeoHookean))
            .dilatation(pliant::Dilatation::Mean),
        Body::new(solid(SolidCells::Tetrahedra10), own()),
    ];
    for body in bodies {
        let body = body.build().unwrap();
        let d = body.dimension();
        let phase = on_planes(&body, Phase::until(1.0).actuate(["growth 1"], 0.2));
        let scene = Scene::new(body).growth(Growth::everywhere()).phase(phase);
        let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
        let (motion, sample) = (equilibrium.trajectory(), equilibrium.sample());
        let places = scene.body().mesh().positions();
        let apart = sample.u.iter().zip(places).map(|(u, x)| (u - 0.2 * x).abs() / 0.1);
        let apart = apart.fold(0.0, f64::max);
        let of_cells = motion.cell_fields(sample).unwrap().into_iter().map(|field| field.stress);
        let of_nodes = motion.nodal_fields(sample).unwrap().into_iter().map(|field| field.stress);
        let stress = of_cells.chain(of_nodes).flatten().flatten();
        let stress = stress.fold(0.0, |most: f64, s| most.max(s.abs())) / YOUNG;
        let strain = motion.cell_fields(sample).unwrap()[0].strain[0][0];
        println!("{d} dimensions: {apart:.1e} apart, stress {stress:.1e} of young");
        // equilibria have a tolerance of 1e-10; the last step of Newton's method leaves 3e-14
        assert!(apart < 6e-14 && stress < 6e-14, "{d} dimensions: {apart:e}, {stress:e}");
        assert!((strain - 0.22).abs() < 1e-13, "{strain}"); // (1.2^2 - 1)/2
    }
}

/// A bar of St. Venant and Kirchhoff's material, held at its length while it would grow by the factor g: its elastic stretch is 1/g, at which it presses with
/// g^2 times the force per section of a bar of this stretch.
#[test]
fn a_held_bar_presses() {
    let (area, growth) = (1e-4, 0.1);
    let body =
        Body::new(Mesh::bar(0.1, 4).unwrap(), material(0.3, 0.0)).area(area).build().unwrap();
    let phase = Phase::until(1.0).hold([1, 4]).actuate(["growth 1"], growth);
    let scene = Scene::new(body).growth(Growth::everywhere()).phase(phase);
    let sampling = Sampling::phase_ends()
        .read("force", Reading::constraint_force([4]))
        .read("stress", Reading::stress([2]));
    let settings = Settings { rtol: 1e-9, ..Settings::default() };
    let motion = scene.simulate(&settings, &sampling).unwrap();
    let stretch = 1.0 / (1.0 + growth);
    let per_section = 0.5 * YOUNG * stretch * (stretch * stretch - 1.0);
    let [force, stress] = motion.last().sensors[..2] else { panic!("two sensors") };
    let expected = area * (1.0 + growth).powi(2) * per_section;
    println!("{force} N, expected {expected} N, {stress} Pa, expected {per_section} Pa");
    assert!((force / expected - 1.0).abs() < 1e-12, "{force} {expected}");
    assert!((stress / per_section - 1.0).abs() < 1e-12, "{stress} {per_section}");
}

/// A strip of two layers as thick as each other, of moduli E and 3 E, of which the stiffer one below grows by e, bends to the curvature
/// 24 e/(h (12 + (1 + n)(1 + 1/n))), n = 3 (S. Timoshenko, Journal of the Optical Society of America 11 (1925) 233-255), whether it grows alike in all directions or
/// along alone. In plane strain growth across adds nu e to e.
#[test]
fn a_bimetal_strip_bends() {
    let along = |growth: Growth| growth.along([1.0, 0.0]);
    bimetal(Plane::Stress, |growth| growth, 1.0);
    bimetal(Plane::Stress, along, 1.0);
    bimetal(Plane::Stress, |growth| along(growth).keeping_volume(), 1.0);
    bimetal(Plane::Strain, |growth| growth, 1.3);
    bimetal(Plane::Strain, along, 1.0);
}

/// Compares the curvature of a strip with `share` times that of growth along it.
fn bimetal(plane: Plane, directed: impl Fn(Growth) -> Growth, share: f64) {
    let [length, height, growth] = [0.2, 0.01, 1e-4];
    let mesh = Mesh::rectangle([length, height], [41, 5], Cells::Rectangles9).unwrap();
    let lower = CellSelection::inside([0.0, 0.0], [length, 0.5 * height]);
    let stiff = Material { young: 3.0 * YOUNG, ..material(0.3, 0.0) };
    let body = Body::new(mesh, material(0.3, 0.0)).region(lower.clone(), stiff).thickness(0.01);
    let body = body.plane(plane).build().unwrap();
    let scene = Scene::new(body)
        .growth(directed(Growth::within(lower).named("hot")))
        .phase(Phase::until(1.0).hold("left").actuate(["hot"], growth));
    for scene in [scene.clone(), scene.halved().unwrap()] {
        let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
        let curvature = curvature(&equilibrium, [length, height]);
        let expected = share * 24.0 * growth / (height * (12.0 + 4.0 * (4.0 / 3.0)));
        let off = curvature / expected - 1.0;
        println!("curvature {curvature} 1/m, off by {off:.1e}");
        assert!(off.abs() < 2e-4, "{curvature} 1/m, off by {off:e}");
    }
}

/// While a ring that is held inside grows smoothly, along a ramp, and in a jump between two phases, no energy is created.
#[test]
fn energy_is_balanced() {
    let mesh = Mesh::ring(0.02, 0.04, [24, 4], Cells::Rectangles).unwrap();
    let soft = material(0.3, 50.0).law(Law::NeoHookean);
    let body = Body::new(mesh, soft).thickness(0.01).plane(Plane::Stress).build().unwrap();
    let cells = CellSelection::Numbers((1..=48).collect());
    for (signal, tolerance) in [
        (Signal::formula("0.15*sin(100*t)").unwrap(), 5e-7),
        (Signal::ramp(0.0, 0.15, 0.0, 0.02), 3e-6),
    ] {
        let scene = Scene::new(body.clone())
            .growth(Growth::within(cells.clone()).named("half"))
            .phase(Phase::until(0.03).hold("inner").actuate(["half"], signal))
            .phase(Phase::until(0.05).hold("inner").actuate(["half"], -0.05));
        for method in [Method::CvodeBdf, Method::Arkode, Method::Rk, Method::Rosenbrock] {
            let settings = Settings { method, rtol: 1e-7, ..Settings::default() };
            let report = run(&scene, &settings, &[]).report().clone();
            let off = report.energy_error / report.energy_scale;
            println!("{method}: {off:.1e} of {} J", report.energy_scale);
            assert!(report.energy_scale > 1e-5 && off < tolerance, "{method}: {off:e}");
        }
    }
}

/// A command lets cells grow as a phase does, and the energy that it adds at once is supplied.
#[test]
fn growth_is_driven() {
    let mesh = Mesh::rectangle([0.1, 0.01], [11, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, material(0.3, 200.0)).thickness(0.01).plane(Plane::Stress);
    let body = body.build().unwrap();
    let lower = CellSelection::Numbers((1..=10).collect());
    let scene = |phase: Phase| {
        Scene::new(body.clone()).growth(Growth::within(lower.clone())).phase(phase.hold("left"))
    };
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let given = run(&scene(Phase::until(0.1).actuate(["growth 1"], 0.02)), &settings, &[]);
    let mut driven = scene(Phase::until(0.1)).start(&settings).unwrap();
    driven.actuate("growth 1", 0.02).unwrap();
    driven.advance_to(0.1).unwrap();
    let tip = 2 * 32 + 1;
    let [a, b] = [given.last().u[tip], driven.view().displacements()[tip]];
    let report = driven.report();
    let off = report.energy_error / report.energy_scale;
    println!("{a} m and {b} m, energy off by {off:.1e}");
    assert!(a > 1e-3 && (a - b).abs() < 1e-12 * a && off < 1e-8, "{a} {b} {off:e}");
}

#[test]
fn growth_that_cannot_be() {
    let mesh = || Mesh::rectangle([0.02, 0.02], [3, 3], Cells::Rectangles).unwrap();
    let body = |plane| Body::new(mesh(), material(0.3, 1.0)).thickness(0.01).plane(plane);
    let phase = || Phase::until(0.1);
    let refused = |scene: Scene, parts: &[&str]| {
        let error: Error = scene.validate().unwrap_err().into();
        assert!(parts.iter().all(|part| error.to_string().contains(part)), "{error}");
    };
    let with = |body: pliant::body::BodyBuilder, growth: Growth| {
        Scene::new(body.build().unwrap()).growth(growth.named("g")).phase(phase())
    };
    let soft = || body(Plane::Stress);
    refused(
        with(soft().strain(Strain::Cauchy), Growth::everywhere()),
        &["growth \"g\" strain", "Green's"],
    );
    refused(with(soft(), Growth::within("core")), &["growth \"g\"", "\"core\""]);
    let rigid = soft().region(CellSelection::Numbers(vec![2]), Material::rigid(1e3));
    refused(with(rigid, Growth::everywhere()), &["growth \"g\" cell = 2", "rigid"]);
    let relaxing = Body::new(mesh(), material(0.3, 1.0).maxwell(0.2, 0.1)).thickness(0.01);
    let relaxing = relaxing.plane(Plane::Stress);
    refused(
        with(relaxing, Growth::everywhere()),
        &["growth \"g\" material.branch", "do not support growth"],
    );
    let twice = with(soft(), Growth::everywhere()).growth(Growth::everywhere().named("h"));
    refused(
        twice.phase(Phase::until(0.2).actuate(["g", "h"], 0.1)),
        &["growth \"h\" cell = 1", "\"g\""],
    );
    let gone = with(soft(), Growth::everywhere());
    refused(
        gone.phase(Phase::until(0.2)).ended_at(0.1).phase(Phase::until(0.3).actuate(["x"], 0.1)),
        &["\"x\"", "\"g\""],
    );
    let nothing = Scene::new(soft().build().unwrap()).growth(Growth::everywhere().named("g"));
    refused(nothing.phase(phase().actuate(["g"], -1.0)), &["growth \"g\" is -1", "above -1"]);
}
