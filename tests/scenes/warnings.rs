//! What indicators say on either side of their limits, where the measured number is known in closed form.

use pliant::mesh::CellKind;
use pliant::{
    Axis, Body, Cells, Chamber, Dilatation, Gas, Guide, Law, Material, Mesh, Method, Obstacle,
    Orifice, Phase, Plane, Sampling, Scene, Settings, SolidCells, Spring, Statics, Strain, Verdict,
};

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };

fn square(cells: Cells, material: Material) -> pliant::body::BodyBuilder {
    Body::new(Mesh::rectangle([0.1, 0.1], [3, 3], cells).unwrap(), material)
        .strain(Strain::Cauchy)
        .thickness(0.01)
}

fn scene(body: pliant::body::BodyBuilder) -> Scene {
    Scene::new(body.build().unwrap()).phase(Phase::until(0.1))
}

/// Warnings of the scene, run until its end.
fn run(scene: &Scene, sampling: &Sampling) -> Vec<String> {
    scene.simulate(&Settings::default(), sampling).unwrap().report().warnings()
}

#[track_caller]
fn only(warnings: &[String], parts: &[&str]) {
    let [warning] = warnings else { panic!("not one warning: {warnings:?}") };
    parts.iter().for_each(|part| assert!(warning.contains(part), "no {part} in: {warning}"));
}

const NONE: Vec<String> = Vec::new();

/// A rigid block that is held does not move but by round-off, and no energy of that is warned of, under its weight and under a load
/// that comes on (measured: 1e-16 J and 5e-12 J, all of the energy there is, whatever the tolerance).
#[test]
fn round_off_of_what_is_held_is_not_warned_of() {
    let mesh = Mesh::cuboid([0.1, 0.02, 0.02], [5, 2, 2], SolidCells::Hexahedra).unwrap();
    let body = Body::new(mesh, Material::rigid(1000.0)).build().unwrap();
    let scene = Scene::new(body);
    let held = || Phase::until(0.5).hold("left");
    let weight = scene.clone().gravity([0.0, 0.0, -9.8]).phase(held());
    let load = scene.phase(held().load_with("right", |t| [0.0, 0.1 * t, t]));
    for method in [Method::Auto, Method::CvodeBdf, Method::Arkode, Method::Rosenbrock] {
        for scene in [&weight, &load] {
            let settings = Settings { method, ..Settings::default() };
            let motion = scene.simulate(&settings, &Sampling::every(0.1)).unwrap();
            let report = motion.report();
            println!("{method}: {:e} of {:e}", report.energy_error, report.energy_scale);
            assert!(report.named_warnings().iter().all(|(name, _)| *name != "energy-balance"));
            assert!(report.energy_scale < 1e-8, "{:e}", report.energy_scale);
        }
    }
}

/// Steps of `rk` that the stabilization of constraints bounds are told as that, and those that viscosity bounds as before.
#[test]
fn a_bound_by_alpha_is_no_motion() {
    let told = |alpha: f64, viscosity: f64| {
        let body = square(Cells::Triangles, Material { viscosity, ..SOFT }).build().unwrap();
        let phase = Phase::until(0.02).hold("bottom").move_nodes("top", [0.0, -0.16]);
        let scene = Scene::new(body).phase(phase);
        let settings = Settings { method: Method::Rk, alpha, ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::every(0.01)).unwrap();
        motion.report().phases[0].counts.notice.clone()
    };
    let by_alpha = told(1e5, 0.0).unwrap();
    assert!(by_alpha.starts_with("alpha") && by_alpha.contains("3.30e-5 s"), "{by_alpha}");
    let by_viscosity = told(1e3, 5e3).unwrap();
    assert!(by_viscosity.starts_with("stability, not accuracy"), "{by_viscosity}");
    assert_eq!(told(1e3, 0.0), None);
}

/// Waves of 6 cells along a bar of bricks, of whose energy (k h)^2/12, a tenth, is in jumps between cells (measured: 14 %, as they begin
/// and end), are not told of as bending. The same bar, shaken across, is.
#[test]
fn waves_are_not_what_bends() {
    let told = |loads: [f64; 2]| {
        let mesh = Mesh::rectangle([0.4, 0.02], [41, 3], Cells::Rectangles).unwrap();
        let body = Body::new(mesh, SOFT).strain(Strain::Cauchy);
        let phase = Phase::until(0.04).hold("right");
        let rate = std::f64::consts::TAU * f64::sqrt(SOFT.young / SOFT.density) / 0.06;
        let shaken = phase.load_with("left", move |t| loads.map(|load| load * f64::sin(rate * t)));
        let scene = Scene::new(body.thickness(0.01).build().unwrap()).phase(shaken);
        let settings = Settings { atol_position: Some(1e-9), ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::every(0.002)).unwrap();
        let indicators = motion.report().indicators.clone();
        indicators.into_iter().find(|told| told.name == "stiffness-of-cells").unwrap()
    };
    let along = told([1e-3, 0.0]);
    assert!(!along.is_doubtful() && (1.1..1.2).contains(&along.value), "{along}");
    let across = told([0.0, 1e-3]);
    assert!(across.is_doubtful() && across.text.contains("where it bends"), "{across}");
}

/// Displacements of some micrometres, which count as a millimetre. What the warning says to set is enough.
#[test]
fn motions_below_their_tolerance() {
    let told = |gravity: f64, atol_position| {
        let body = square(Cells::Triangles, SOFT).build().unwrap();
        let scene =
            Scene::new(body).gravity([0.0, gravity]).phase(Phase::until(0.2).hold("bottom"));
        let settings = Settings { rtol: 1e-3, atol_position, ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::every(0.02)).unwrap();
        let mut warnings = motion.report().warnings();
        // what is too rough may create energy, too
        warnings.retain(|warning| warning.contains("absolute tolerance"));
        warnings
    };
    let warnings = told(-0.02, None);
    only(&warnings, &["of the travel of nodes (limit: 1 %)", "set atol_position to"]);
    let enough = warnings[0].split("set atol_position to ").nth(1).unwrap();
    let enough: f64 = enough.split(' ').next().unwrap().parse().unwrap();
    assert_eq!(told(-0.02, Some(enough)), NONE);
    // a strong field moves it far enough
    assert_eq!(told(-2.0, None), NONE);
}

/// A square that begins turned by an angle and has no time to move: all cells have turned by that angle.
#[test]
fn rotations_under_cauchy_strain() {
    let turned = |degrees: f64, strain| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let body = square(Cells::Triangles, SOFT).strain(strain).build().unwrap();
        let scene = Scene::new(body)
            .initial_displacement(move |x| {
                vec![(cos - 1.0) * x[0] - sin * x[1], sin * x[0] + (cos - 1.0) * x[1]]
            })
            .phase(Phase::until(1e-7));
        run(&scene, &Sampling::phase_ends())
    };
    assert_eq!(turned(9.9, Strain::Cauchy), NONE);
    assert_eq!(turned(-9.9, Strain::Cauchy), NONE);
    // 1 - cos 60 = 50 %
    let parts = ["60.0 degrees", "a strain of 50.0 %", "limit: 10 degrees, 1.5 %", "\"green\""];
    only(&turned(60.0, Strain::Cauchy), &parts);
    only(&turned(-10.1, Strain::Cauchy), &["10.1 degrees"]);
    assert_eq!(turned(60.0, Strain::Green), NONE);
}

/// What is within its limit is kept as a number, and no warning.
#[test]
fn indicators_within_their_limits() {
    let (sin, cos) = 3.1_f64.to_radians().sin_cos();
    let scene = Scene::new(square(Cells::Triangles, SOFT).build().unwrap())
        .initial_displacement(move |x| {
            vec![(cos - 1.0) * x[0] - sin * x[1], sin * x[0] + (cos - 1.0) * x[1]]
        })
        .phase(Phase::until(1e-7));
    let before = scene.indicators();
    let names: Vec<&str> = before.iter().map(|indicator| indicator.name).collect();
    let units = ["size", "mass", "density", "young", "wave-speed", "thickness"];
    assert_eq!(names[..6], units);
    assert_eq!(names[6..], ["poisson", "conformity", "pieces", "drawn-overlap"]);
    // E 5e4 over density 1000
    assert!((before[4].value - 50_f64.sqrt()).abs() < 1e-12);
    let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends()).unwrap();
    let measured = &motion.report().indicators;
    assert_eq!(measured[..10], before);
    let turn = measured.iter().find(|indicator| indicator.name == "turn").unwrap();
    assert!((turn.value - 3.1).abs() < 1e-3, "{turn}");
    assert_eq!((turn.limits, turn.unit, turn.verdict), ([0.0, 10.0], "degrees", Verdict::Fine));
    assert!(turn.text.contains("3.1 degrees"), "{turn}");
    assert_eq!(motion.report().warnings(), NONE);
}

#[test]
fn units_of_other_systems() {
    let sheet = |size: f64, material: pliant::Substance, thickness: f64| {
        let mesh = Mesh::rectangle([0.6 * size, 0.8 * size], [2, 2], Cells::Triangles).unwrap();
        scene(Body::new(mesh, material).thickness(thickness))
    };
    let large = |size: f64, density: f64, young: f64| {
        sheet(size, Material { density, young, ..SOFT }.into(), 1e-3).warnings()
    };
    assert_eq!(large(9.9, 1000.0, 1e5), NONE);
    let parts = ["10.100 m", "limit: 10 m", "is the mesh in mm?", "0.001", "unusual = [\"size\"]"];
    only(&large(10.1, 1000.0, 1e5), &parts);
    // 0.48 size^2 h rho
    let heavy = |thickness| sheet(9.0, Material { density: 2e4, ..SOFT }.into(), thickness);
    assert_eq!(heavy(0.0128).warnings(), NONE);
    only(&heavy(0.0129).warnings(), &["1.003e4 kg", "limit: 10000 kg", "is the mesh in mm?"]);
    assert_eq!(large(1.0, 1000.0, 11.0), NONE);
    only(&large(1.0, 1000.0, 9.0), &["9.49e-2 m/s", "0.1 to 10000 m/s", "young is in Pa"]);
    assert_eq!(large(1.0, 10.0, 0.99e9), NONE);
    only(&large(1.0, 10.0, 1.01e9), &["1.00e4 m/s", "density in kg/m^3"]);
    // silicone in g/cm^3, in g/m^3
    only(&large(0.1, 1.07, 2e5), &["density is 1.07 kg/m^3", "limits: 5 to 25000", "g/cm^3"]);
    only(&large(0.1, 1.07e6, 2e5), &["density is 1070000"]);
    // moduli that rubber has not, though plastics and metals have them
    let silicone = |young| Material { density: 1070.0, young, ..SOFT };
    let rubber = |young| sheet(0.1, silicone(young).law(Law::NeoHookean), 0.01).warnings();
    assert_eq!(rubber(0.99e8), NONE);
    only(
        &rubber(2e8),
        &["young is 200000000 Pa", "limit for a law of rubber: 100000000 Pa", "soft silicone"],
    );
    assert_eq!(sheet(0.1, silicone(2e8).into(), 0.01).warnings(), NONE);
    // a thickness in mm, and one that makes results those of a metre
    only(&sheet(0.1, SOFT.into(), 10.0).warnings(), &["10 m thick, 100 times", "in mm?"]);
    assert_eq!(sheet(0.1, SOFT.into(), 2.0).warnings(), NONE);
    assert_eq!(sheet(0.02, SOFT.into(), 1.0).warnings(), NONE);
}

/// A column of height H is strained by rho g H / E at its foot.
#[test]
fn bodies_too_soft_for_their_weight() {
    let hung = |young: f64| {
        let body = square(Cells::Triangles, Material { young, ..SOFT });
        scene(body).gravity([0.0, -9.8])
    };
    // 1000 x 9.8 x 0.1 Pa
    assert_eq!(hung(990.0).warnings(), NONE);
    only(&hung(970.0).warnings(), &["strained by 100 % under its own weight", "limit: 100 %"]);
    let strain = hung(5e4).indicators();
    let strain = strain.iter().find(|indicator| indicator.name == "weight").unwrap();
    assert!((strain.value - 0.0196).abs() < 1e-12, "{strain}");
}

/// What a scene says to be meant keeps its number, and warns of nothing.
#[test]
fn unusual_quantities() {
    let mesh = Mesh::rectangle([15.0, 4.0], [4, 2], Cells::Triangles).unwrap();
    let told = scene(Body::new(mesh, Material { density: 1.07, ..SOFT }).thickness(0.01));
    assert_eq!(told.warnings().len(), 2, "{:?}", told.warnings());
    let meant = told.unusual(["size", "density"]);
    assert_eq!(meant.warnings(), NONE);
    let size = &meant.indicators()[0];
    assert!(size.value > 15.0 && size.text.contains("meant"), "{size}");
    let error = meant.unusual(["sise"]).validate().unwrap_err().to_string();
    assert!(error.contains("unusual = \"sise\"") && error.contains("\"size\""), "{error}");
}

/// A floor through the middle of a square is told before the run, by its depth, and the run that it ruins says so.
#[test]
fn floors_through_the_body_at_the_start() {
    let through = |floor: f64, stiffness: f64| {
        let body = square(Cells::Triangles6, SOFT).strain(Strain::Green);
        let floor = Obstacle::half_plane([0.0, floor], [0.0, 1.0]);
        scene(body).obstacle(floor.stiffness(stiffness))
    };
    let start = through(0.04, 1e7);
    let parts =
        ["begins with 7 node(s)", "obstacle \"floor\"", "by 4.00e-2 m", "leave the obstacle out"];
    only(&start.warnings(), &parts);
    // half a cell is 2.5 cm
    assert_eq!(through(0.024, 1e7).warnings(), NONE);
    let end = start.simulate(&Settings::default(), &Sampling::every(0.01));
    let warnings = match end {
        Ok(motion) => motion.report().warnings(),
        Err(error) => {
            let said = error.to_string();
            parts.iter().for_each(|part| assert!(said.contains(part), "no {part} in: {said}"));
            let pliant::Error::Integration(failure) = error else { panic!("{said}") };
            failure.trajectory.report().warnings()
        }
    };
    assert!(warnings.iter().any(|text| text.contains(parts[0])), "{warnings:?}");
    assert!(!warnings.iter().any(|text| text.contains("raise the stiffness")), "{warnings:?}");
}

#[test]
fn cells_that_lock() {
    let flat = |cells, poisson| square(cells, Material { poisson, ..SOFT });
    for cells in [Cells::Triangles, Cells::Rectangles] {
        assert_eq!(scene(flat(cells, 0.45)).warnings(), NONE);
        let parts = ["ratio 0.46 in linear", "limit: 0.45", "\"triangles6\""];
        only(&scene(flat(cells, 0.46)).warnings(), &parts);
        assert_eq!(scene(flat(cells, 0.46).plane(Plane::Stress)).warnings(), NONE);
    }
    assert_eq!(scene(flat(Cells::Crossed, 0.49)).warnings(), NONE);
    for (cells, name, help) in [
        (Cells::Triangles6, "triangles of 6 nodes", "`bubbles = true`"),
        (Cells::Rectangles9, "quadrilaterals of 9 nodes", "take dilatation = \"linear\""),
    ] {
        assert_eq!(scene(flat(cells, 0.48)).warnings(), NONE);
        let told = format!("ratio 0.49 in {name} (limit: 0.48)");
        only(&scene(flat(cells, 0.49)).warnings(), &[&told, "too stiff", help]);
        assert_eq!(scene(flat(cells, 0.49).plane(Plane::Stress)).warnings(), NONE);
    }
    let flat9 = flat(Cells::Rectangles9, 0.49);
    assert_eq!(scene(flat9.clone().dilatation(Dilatation::Linear)).warnings(), NONE);
    only(&scene(flat9.dilatation(Dilatation::Mean)).warnings(), &["too soft"]);
    let mean = flat(Cells::Triangles6, 0.49).dilatation(Dilatation::Mean);
    assert_eq!(scene(mean).warnings(), NONE);
    // with corners of one triangle and of two
    let crossed = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Crossed).unwrap();
    let crossed = Body::new(crossed, Material { poisson: 0.49, ..SOFT })
        .strain(Strain::Cauchy)
        .thickness(0.01);
    assert_eq!(scene(crossed).warnings(), NONE);
    let ring = |cells| Mesh::ring(0.04, 0.05, [32, 3], cells).unwrap();
    let ring = |cells| {
        Body::new(ring(cells), Material { poisson: 0.49, ..SOFT })
            .strain(Strain::Cauchy)
            .thickness(0.01)
    };
    assert_eq!(scene(ring(Cells::Crossed)).warnings(), NONE);
    only(&scene(ring(Cells::Triangles)).warnings(), &["0.49", "\"crossed\""]);
    for (cells, locks) in [
        (SolidCells::Tetrahedra, true),
        (SolidCells::Hexahedra, true),
        (SolidCells::Tetrahedra10, false),
        (SolidCells::Hexahedra20, false),
        (SolidCells::Hexahedra27, false),
    ] {
        let mesh = Mesh::cuboid([0.1, 0.1, 0.1], [2, 2, 2], cells).unwrap();
        let warnings =
            scene(Body::new(mesh, Material { poisson: 0.46, ..SOFT }).strain(Strain::Cauchy))
                .warnings();
        assert_eq!(warnings.len(), usize::from(locks), "{warnings:?}");
    }
    // what no cell is made of does not count; what some are made of does
    let all = pliant::CellSelection::inside([0.0, 0.0], [0.1, 0.1]);
    let half = pliant::CellSelection::inside([0.0, 0.0], [0.05, 0.1]);
    assert_eq!(scene(flat(Cells::Triangles, 0.49).region(all, SOFT)).warnings(), NONE);
    only(&scene(flat(Cells::Triangles, 0.49).region(half, SOFT)).warnings(), &["0.49"]);
}

/// That the warning is deserved: how much a cantilever sinks on a coarse mesh, compared with 41 x 9 nodes of
/// quadratic triangles. Measured: triangles 0.53 of it at nu = 0.3 and 0.20 at 0.48, crossed ones 0.65 and 0.69.
#[test]
fn locking_cells_are_too_stiff_and_crossed_ones_are_not() {
    let sinks = |cells, nodes: [usize; 2], poisson| {
        let mesh = Mesh::rectangle([0.1, 0.02], nodes, cells).unwrap();
        let body = Body::new(mesh, Material { poisson, ..SOFT })
            .strain(Strain::Cauchy)
            .thickness(0.01)
            .build()
            .unwrap();
        let pull = Phase::until(1.0).hold("left").load_total("right", [0.0, -0.005]);
        let rest = Scene::new(body).phase(pull).equilibrium(&Statics::default()).unwrap();
        -rest.displacements()[2 * nodes[0] - 1]
    };
    let part = |cells, poisson| {
        sinks(cells, [11, 3], poisson) / sinks(Cells::Triangles6, [41, 9], poisson)
    };
    assert!(part(Cells::Triangles, 0.3) > 0.5);
    assert!(part(Cells::Triangles, 0.48) < 0.25);
    assert!((part(Cells::Crossed, 0.48) / part(Cells::Crossed, 0.3) - 1.0).abs() < 0.1);
}

/// The same of the warning of quadratic cells, one of which is across: triangles -20 %, quadrilaterals -12 %, with the mean dilatation 96 % too
/// soft; with the linear one -3.0 and -0.7 %.
#[test]
fn quadratic_cells_lock_by_a_fifth() {
    let sinks = |mesh: Mesh, dilatation| {
        let tip = mesh.sets()["right"][0];
        let body = Body::new(mesh, Material { poisson: 0.49, ..SOFT }).thickness(0.01);
        let body = body.strain(Strain::Cauchy).dilatation(dilatation).build().unwrap();
        let pull = Phase::until(1.0).hold("left").load_total("right", [0.0, -0.005]);
        let rest = Scene::new(body).phase(pull).equilibrium(&Statics::default()).unwrap();
        -rest.displacements()[2 * tip + 1]
    };
    let grid = |cells, nodes| Mesh::rectangle([0.1, 0.02], nodes, cells).unwrap();
    let (points, mean, linear) = (Dilatation::AtPoints, Dilatation::Mean, Dilatation::Linear);
    let exact = sinks(grid(Cells::Rectangles9, [81, 17]), linear);
    let found = [
        sinks(grid(Cells::Triangles6, [6, 2]), points),
        sinks(grid(Cells::Rectangles9, [6, 2]), points),
        sinks(grid(Cells::Rectangles9, [6, 2]), mean),
        sinks(grid(Cells::Triangles6, [6, 2]).with_bubbles().unwrap(), linear),
        sinks(grid(Cells::Rectangles9, [6, 2]), linear),
    ];
    let off = found.map(|found| found / exact - 1.0);
    println!("{off:?}");
    assert!(off[0] < -0.18 && off[1] < -0.1 && off[2] > 0.9, "{off:?}");
    assert!(off[3].abs() < 0.035 && off[4].abs() < 0.01, "{off:?}");
}

/// A cantilever of 10 x 2 cm under a force on its end: how far that sinks (m), and the warnings. `nodes` along
/// it and through it.
fn cantilever(cells: Cells, nodes: [usize; 2], poisson: f64, strain: Strain) -> (f64, Vec<String>) {
    let mesh = Mesh::rectangle([0.1, 0.02], nodes, cells).unwrap();
    let body = Body::new(mesh, Material { poisson, ..SOFT }).thickness(0.01).strain(strain);
    let pull = Phase::until(1.0).hold("left").load_total("right", [0.0, -0.01]);
    let rest = Scene::new(body.build().unwrap()).phase(pull);
    let rest = rest.equilibrium(&Statics::default()).unwrap();
    let told = rest.trajectory().report().warnings();
    (-rest.displacements()[2 * nodes[0] - 1], told)
}

/// The factor in "the body is some 1.8 times too stiff".
fn too_stiff(warning: &str) -> f64 {
    let (_, rest) = warning.split_once("the body is some ").unwrap();
    rest.split_once(" times").unwrap().0.parse().unwrap()
}

/// How many times too stiff a coarse mesh is, against 81 x 17 nodes of quadratic triangles. Measured at nu = 0.3 (the true
/// factor, the estimate): one triangle thick 3.43 and 3.42 (51 nodes long), two thick 1.90 and 1.76 (11 nodes long), four
/// 1.24 and 1.20, eight 1.06 and 1.05; two rectangles 1.16 and 1.14. Where cells lock, it is a lower bound: at
/// nu = 0.48 two triangles thick 5.0 and 2.3, eight 1.34 and 1.29.
#[test]
fn cells_too_coarse_for_bending() {
    for (cells, nodes, poisson, warns) in [
        (Cells::Triangles, [51, 2], 0.3, true),
        (Cells::Triangles, [11, 3], 0.3, true),
        (Cells::Triangles, [21, 5], 0.3, false),
        (Cells::Crossed, [11, 3], 0.3, true),
        (Cells::Crossed, [21, 5], 0.48, false),
        (Cells::Rectangles, [6, 2], 0.3, true),
        (Cells::Rectangles, [11, 3], 0.3, true),
        (Cells::Rectangles, [21, 5], 0.3, false),
        (Cells::Triangles, [41, 9], 0.45, false),
        (Cells::Triangles, [41, 9], 0.48, true),
        (Cells::Triangles6, [11, 3], 0.48, false),
        (Cells::Rectangles9, [6, 2], 0.48, false),
    ] {
        let (sinks, mut warnings) = cantilever(cells, nodes, poisson, Strain::Cauchy);
        warnings.retain(|warning| !warning.contains("they lock"));
        if !warns {
            assert_eq!(warnings, NONE, "{cells:?} {nodes:?} {poisson}");
            continue;
        }
        let limit =
            if cells == Cells::Rectangles { "limit: 1.1 times" } else { "limit: 1.25 times" };
        only(&warnings, &[limit, "at t = 1 s", "\"triangles6\"", "times as fine"]);
        let fine = cantilever(Cells::Triangles6, [81, 17], poisson, Strain::Cauchy).0;
        let part = too_stiff(&warnings[0]) / (fine / sinks);
        // one decimal is told; one cell through the thickness of a short beam is told least well, 0.81 of it
        assert!((0.8..1.05).contains(&part), "{cells:?} {nodes:?} {poisson}: {part}");
    }
    let green = |nodes| cantilever(Cells::Triangles, nodes, 0.3, Strain::Green).1;
    only(&green([11, 3]), &["1.76 times too stiff"]);
    assert_eq!(green([21, 5]), NONE);
    for (cells, nodes, warns) in [
        (SolidCells::Tetrahedra, [11, 3, 3], true),
        (SolidCells::Tetrahedra, [21, 5, 5], false),
        (SolidCells::Hexahedra, [6, 2, 2], true),
        (SolidCells::Hexahedra, [11, 3, 3], true),
        (SolidCells::Hexahedra, [21, 5, 5], false),
        (SolidCells::Tetrahedra10, [6, 2, 2], false),
        (SolidCells::Hexahedra20, [6, 2, 2], false),
        (SolidCells::Hexahedra27, [6, 2, 2], false),
    ] {
        let mesh = Mesh::cuboid([0.1, 0.02, 0.02], nodes, cells).unwrap();
        let pull = Phase::until(1.0).hold("left").load_total("right", [0.0, -0.005, 0.0]);
        let body = Body::new(mesh, SOFT).strain(Strain::Cauchy).build().unwrap();
        let rest = Scene::new(body).phase(pull);
        let rest = rest.equilibrium(&Statics::default()).unwrap();
        let warnings = rest.trajectory().report().warnings();
        match warns {
            true => only(&warnings, &["too coarse", "\"tetrahedra10\""]),
            false => assert_eq!(warnings, NONE, "{cells:?}"),
        }
    }
}

/// Two layers of hexahedra in bending, the nearer to incompressible the stiffer, against quadratic ones of half the size (at 0.49 with
/// a linear dilatation). Measured, the true factor and the estimate: 1.146 and 1.129 at nu = 0.3, 1.285 and 1.219 at 0.44, 1.316 and
/// 1.239 at 0.45, 1.769 and 1.543 at 0.49; jumps alone had 1.204 at 0.45 and 1.264 at 0.49.
#[test]
fn hexahedra_that_resist_a_change_of_volume() {
    let bent = |cells: SolidCells, nodes: [usize; 3], poisson: f64, dilatation: Dilatation| {
        let mesh = Mesh::cuboid([0.1, 0.02, 0.02], nodes, cells).unwrap();
        let end = mesh.sets()["right"].clone();
        let pull = Phase::until(1.0).hold("left").load_total("right", [0.0, 0.0, -1e-5]);
        let body = Body::new(mesh, Material { poisson, ..SOFT }).dilatation(dilatation);
        let scene = Scene::new(body.build().unwrap()).phase(pull);
        let rest = scene.equilibrium(&Statics::default()).unwrap();
        let sinks = end.iter().map(|node| -rest.displacements()[3 * node + 2]).sum::<f64>();
        let indicators = rest.trajectory().report().indicators.clone();
        let told = indicators.into_iter().find(|told| told.name == "stiffness-of-cells");
        (sinks / end.len() as f64, told)
    };
    for (poisson, least) in [(0.3, 0.97), (0.44, 0.93), (0.45, 0.92), (0.49, 0.85)] {
        let (fine, _) = match poisson > 0.48 {
            true => bent(SolidCells::Hexahedra27, [11, 5, 5], poisson, Dilatation::Linear),
            false => bent(SolidCells::Hexahedra20, [11, 5, 5], poisson, Dilatation::AtPoints),
        };
        let (coarse, told) = bent(SolidCells::Hexahedra, [11, 3, 3], poisson, Dilatation::AtPoints);
        let told = told.unwrap();
        let part = told.value / (fine / coarse);
        assert!((least..1.0).contains(&part) && told.is_doubtful(), "{poisson}: {part} {told}");
    }
}

/// What any cells can follow: a uniform stretch, also of two materials; a rotation, which leaves nothing
/// but round-off in Green's strain, in the undeformed shape or on its way.
#[test]
fn cells_fine_enough_for_anything() {
    let half = pliant::CellSelection::inside([0.0, 0.0], [0.05, 0.1]);
    for cells in [Cells::Triangles, Cells::Crossed, Cells::Rectangles] {
        let stretched = Phase::until(1.0)
            .hold_axes("left", [Axis::X])
            .hold_axes([1], [Axis::Y])
            .move_axis("right", Axis::X, 0.01);
        // one after the other: without contraction their strains are uniform, and ten times as large in the one
        let soft = Material { poisson: 0.0, ..SOFT };
        let stiff = Material { young: 10.0 * soft.young, ..soft };
        for body in [square(cells, SOFT), square(cells, soft).region(half.clone(), stiff)] {
            let body = body.strain(Strain::Green).build().unwrap();
            let rest = Scene::new(body).phase(stretched.clone());
            let rest = rest.equilibrium(&Statics::default()).unwrap();
            assert_eq!(rest.trajectory().report().warnings(), NONE, "{cells:?}");
        }
        // three turns in a second
        let body = square(cells, SOFT).strain(Strain::Green).build().unwrap();
        let spin = std::f64::consts::TAU * 3.0;
        let spinning = Scene::new(body.clone())
            .initial_velocity(move |x| vec![-spin * x[1], spin * x[0]])
            .phase(Phase::until(0.3));
        assert_eq!(run(&spinning, &Sampling::every(0.01)), NONE, "{cells:?}");
        let turned = Scene::new(body)
            .initial_displacement(|x| vec![-x[0] - x[1], x[0] - x[1]])
            .phase(Phase::until(1e-7));
        assert_eq!(run(&turned, &Sampling::phase_ends()), NONE, "{cells:?}");
    }
}

/// A bar pushed by F shortens by F/(E A): at 10 N by all of its length.
#[test]
fn cells_turned_inside_out_under_cauchy_strain() {
    let pushed = |force: f64| {
        let bar = Body::new(Mesh::bar(0.1, 6).unwrap(), SOFT).area(2e-4);
        let body = bar.strain(Strain::Cauchy).build().unwrap();
        let push = Phase::until(0.5).hold("left").load("right", [-force]);
        let rest = Scene::new(body).phase(push).equilibrium(&Statics::default()).unwrap();
        rest.trajectory().report().warnings()
    };
    assert_eq!(pushed(9.99), NONE);
    only(&pushed(10.01), &["5 cell(s)", "at t = 0.5 s", "cell 1 (nodes [1, 2])", "\"green\""]);
    // a corner thrown across its square passes the diagonal after 0.5 s: one cell, at the sample after that
    let body = Body::new(Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Triangles).unwrap(), SOFT);
    let crossing = Phase::until(1.0).hold([1, 2, 3]).move_nodes([4], [-0.1, -0.1]);
    let crossing =
        Scene::new(body.strain(Strain::Cauchy).thickness(0.01).build().unwrap()).phase(crossing);
    let mut warnings = run(&crossing, &Sampling::every(0.2));
    warnings.retain(|warning| warning.contains("cell(s) are inverted"));
    only(&warnings, &["1 cell(s)", "at t = 0.6 s", "cell 2"]);
}

#[test]
fn pieces_that_nothing_joins() {
    // two bars on a line, with nodes 3 and 4 in the same place, as files of meshes have them
    let positions = vec![0.0, 0.1, 0.2, 0.2, 0.3];
    let mesh = Mesh::new(1, positions, CellKind::Segment, vec![0, 1, 1, 2, 3, 4]).unwrap();
    let bars = || Body::new(mesh.clone(), SOFT).strain(Strain::Cauchy).area(1e-4);
    let apart = ["2 pieces", "with node 4, has 2 of 5 nodes", "limit: 1 piece", "springs"];
    only(&scene(bars()).warnings(), &apart);
    let sprung = scene(bars()).spring(Spring::between([2], [5]).stiffness(1.0));
    assert_eq!(sprung.warnings(), NONE);
    let tied = Phase::until(0.2).hold_combination([(3, Axis::X, 1.0), (4, Axis::X, -1.0)]);
    assert_eq!(scene(bars()).phase(tied).warnings(), NONE);

    let bob = || square(Cells::Triangles, SOFT).point_mass("bob", [0.0, 0.3], 0.01);
    only(&scene(bob()).warnings(), &["2 pieces", "with node 10, has 1 of 10 nodes"]);
    let hung = scene(bob()).spring(Spring::between([1], "bob").stiffness(1.0));
    assert_eq!(hung.warnings(), NONE);
}

/// A square falls from 0.1 m above the floor: by g t^2 / 2 it is at 5.1 cm after 0.1 s, and on the floor after
/// 0.143 s.
#[test]
fn obstacles_that_are_never_touched() {
    let body = square(Cells::Triangles, SOFT).strain(Strain::Green).build().unwrap();
    let falling = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(Obstacle::half_plane([0.0, -0.1], [0.0, 1.0]).stiffness(1e3));
    let until = |end| falling.clone().phase(Phase::until(end));
    let parts = ["\"floor\" was never touched", "near as 5.10e-2 m", "move one of them"];
    only(&run(&until(0.1), &Sampling::every(0.01)), &parts);
    assert_eq!(run(&until(0.15), &Sampling::every(0.01)), NONE);
    // what does not act cannot be missed
    let free = falling.clone().phase(Phase::until(0.1).without_contact());
    assert_eq!(run(&free, &Sampling::every(0.01)), NONE);
    // two samples alone cannot tell that it did not jump in between
    assert_eq!(run(&until(0.1), &Sampling::phase_ends()), NONE);
    let stopped = falling.clone().phase(Phase::until(0.1)).phase(Phase::until(9.0));
    let mut steps = 0;
    let end = stopped.simulate_with(&Settings::default(), &Sampling::every(0.01), |progress| {
        steps += 1;
        match progress.time > 0.05 {
            true => std::ops::ControlFlow::Break(()),
            false => std::ops::ControlFlow::Continue(()),
        }
    });
    let Err(pliant::Error::Integration(end)) = end else { panic!("not stopped") };
    assert_eq!(end.trajectory.report().warnings(), NONE);
}

/// A bar that stands on a floor of stiffness k is inside it by its weight over k. Half a cell is 1 cm.
#[test]
fn deep_in_the_floor() {
    let bar = || {
        Body::new(Mesh::bar(0.1, 6).unwrap(), SOFT)
            .strain(Strain::Cauchy)
            .area(2e-4)
            .build()
            .unwrap()
    };
    let weight = 0.02 * 9.8;
    let standing = |depth: f64| {
        let scene = Scene::new(bar())
            .gravity([-9.8])
            .obstacle(Obstacle::half_plane([0.0], [1.0]).stiffness(weight / depth))
            .phase(Phase::until(1.0));
        let rest = scene.equilibrium(&Statics::default()).unwrap();
        let said = rest.to_string();
        let warnings = rest.trajectory().report().warnings();
        warnings.iter().for_each(|warning| assert!(said.contains(warning), "{said}"));
        warnings
    };
    assert_eq!(standing(0.0099), NONE);
    let parts = ["node 1 is 1.01e-2 m inside obstacle \"floor\"", "limit: 1.00e-2 m", "stiffness"];
    only(&standing(0.0101), &parts);
}

/// A bar that stands on a floor with friction, which statics does not know; not so where it does not reach the floor.
#[test]
fn friction_in_statics() {
    let warnings = |floor: f64, coefficient: f64| {
        let bar = Body::new(Mesh::bar(0.1, 6).unwrap(), SOFT).area(2e-4).build().unwrap();
        let floor = Obstacle::half_plane([floor], [1.0]).stiffness(100.0);
        let scene =
            Scene::new(bar).gravity([-9.8]).obstacle(floor.friction_coefficient(coefficient));
        let held =
            if coefficient > 0.5 { Phase::until(1.0).hold("right") } else { Phase::until(1.0) };
        let rest = scene.phase(held).equilibrium(&Statics::default()).unwrap();
        rest.trajectory().report().warnings()
    };
    only(
        &warnings(0.0, 0.5),
        &["\"floor\" has friction", "does not act in statics", "run the scene"],
    );
    assert_eq!(warnings(0.0, 0.0), NONE);
    only(&warnings(-0.05, 0.9), &["never touched"]);
}

/// A well in which a body swings: its potential is below 0 all the time, and by more than the body's kinetic energy is above.
struct Well;

impl pliant::force::Force for Well {
    fn add_forces(
        &self,
        _t: f64,
        u: &[f64],
        _v: &[f64],
        forces: &mut pliant::force::NodalForces,
    ) -> Result<(), pliant::ode::Failure> {
        forces.conservative.iter_mut().zip(u).for_each(|(f, u)| *f -= 10.0 * u);
        Ok(())
    }

    fn reservoir(&self) -> pliant::force::Reservoir {
        pliant::force::Reservoir::Springs
    }

    fn potential(&self, _t: f64, u: &[f64]) -> f64 {
        u.iter().map(|u| 5.0 * u * u).sum::<f64>() - 100.0
    }
}

/// The balance is measured by the size of energies that are below 0, too: an error of round-off is none.
#[test]
fn energies_below_zero_are_energies() {
    let body = square(Cells::Triangles, SOFT).build().unwrap();
    let scene = Scene::new(body).initial_velocity(|_| vec![0.1, 0.0]).force(Well);
    let motion = scene
        .phase(Phase::until(0.3))
        .simulate(&Settings::default(), &Sampling::every(0.02))
        .unwrap();
    let report = motion.report();
    assert!(report.energy_error > 0.0 && motion.samples().iter().all(|s| s.energy.springs < -90.0));
    let warnings = report.warnings();
    assert!(!warnings.iter().any(|warning| warning.contains("energ")), "{warnings:?}");
}

/// Numbers of gas that are gauge pressures, or in other units; what is meant is not warned of. A cable cannot push.
#[test]
fn numbers_of_gas_and_cables_are_looked_at() {
    let ring = || {
        let mesh = Mesh::ring(0.02, 0.03, [16, 3], Cells::Rectangles).unwrap();
        let body = Body::new(mesh, Material { young: 1e6, ..SOFT }).thickness(0.01);
        Scene::new(body.build().unwrap()).chamber(Chamber::within("air", "inner"))
    };
    let gas = |pressure: f64| ring().gas(Gas::in_chamber("air").pressure(pressure));
    let phase = || Phase::until(0.1).hold([1, 2, 3]);
    let warned = |scene: Scene| scene.phase(phase()).warnings();
    assert_eq!(warned(gas(1.2e5)), NONE);
    only(
        &warned(gas(5000.0)),
        &["air", "5000 Pa", "106325 Pa", "unusual = [\"absolute-pressure\"]"],
    );
    assert_eq!(warned(gas(5000.0).unusual(["absolute-pressure"])), NONE);
    let fed = |conductance: f64, supply: f64| {
        let orifice = Orifice::new("in", "pump", "air", conductance);
        gas(1.013e5).supply("pump", supply).orifice(orifice)
    };
    assert_eq!(warned(fed(1e-8, 1.2e5)), NONE);
    only(&warned(fed(1e-8, 2e4)), &["supply \"pump\"", "20000 Pa"]);
    // C rho_0 sqrt(R T)/0.6847 (ISO 6358 and a choked nozzle of k = 1.4)
    let area = 0.5 * 1.185 * (1e5_f64 / 1.185).sqrt() / 0.684_731;
    only(&warned(fed(0.5, 1.2e5)), &["orifice \"in\"", &format!("{area:.1} m^2"), "1e-8"]);

    let tendon = |force: f64| {
        let cable = Spring::cable([Guide::nodes([1]), Guide::nodes([3])]).named("tendon");
        ring().spring(cable).phase(phase().actuate(["tendon"], force)).validate()
    };
    tendon(1.0).unwrap();
    let refused = tendon(-1.0).unwrap_err().to_string();
    assert!(refused.contains("cable \"tendon\"") && refused.contains("-1 N"), "{refused}");
}
