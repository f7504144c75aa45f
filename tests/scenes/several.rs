//! Several bodies in one scene: each moves as it does alone, and springs and ties join them.

use std::path::Path;

use pliant::body::BodyBuilder;
use pliant::simulate::Reading;
use pliant::{
    Body, Cells, Dilatation, Law, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene,
    SceneFile, Settings, SolidCells, Spring, Statics, Strain, Substance, Trajectory,
};

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 10.0 };

fn block(at: [f64; 2], size: [f64; 2], nodes: [usize; 2], cells: Cells) -> BodyBuilder {
    let mesh = Mesh::rectangle(size, nodes, cells).unwrap().translated(&at).unwrap();
    Body::new(mesh, SOFT).thickness(0.01)
}

/// A square of triangles, and a softer one of rubber with other cells, that fall on the floor apart from each other.
fn falling() -> [Body; 2] {
    let square = block([0.0, 0.01], [0.1, 0.1], [4, 4], Cells::Triangles).named("square");
    let rubber = block([0.3, 0.02], [0.1, 0.05], [3, 3], Cells::Rectangles9)
        .material(Material { poisson: 0.48, ..SOFT }.law(Law::NeoHookean))
        .dilatation(Dilatation::Linear)
        .named("rubber");
    [square, rubber].map(|body| body.build().unwrap())
}

fn on_the_floor(body: Body) -> Scene {
    let floor = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0])
        .stiffness_density(1e7)
        .friction_coefficient(0.4)
        .sticking_speed(0.01);
    Scene::new(body).obstacle(floor).gravity([0.0, -9.8]).phase(Phase::until(0.1))
}

fn run(scene: &Scene, settings: &Settings) -> Trajectory {
    scene.simulate(settings, &Sampling::every(0.05)).unwrap()
}

/// The largest difference of the displacements of each body from those of the body alone.
fn apart(method: Method, bodies: [Body; 2], tolerance: f64) {
    let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
    let each = bodies.clone().map(|body| run(&on_the_floor(body), &settings));
    let both = run(&on_the_floor(Body::join(bodies).unwrap()), &settings);
    let parts: Vec<_> = both.body().parts().collect();
    for (sample, together) in both.samples().iter().enumerate() {
        for (alone, part) in each.iter().zip(&parts) {
            let u = &alone.samples()[sample].u;
            let far = u.iter().zip(&together.u[part.dofs()]).map(|(a, b)| (a - b).abs());
            let far = far.fold(0.0, f64::max);
            assert!(far <= tolerance, "{method}: body {} is {far} m off", part.name);
        }
    }
    assert!(both.last().u.iter().any(|u| u.abs() > 0.01), "{method}: nothing fell");
    let energy = |kind: fn(&Trajectory) -> f64| each.iter().map(kind).sum::<f64>();
    let kinetic = energy(|alone| alone.last().energy.kinetic);
    assert!((both.last().energy.kinetic - kinetic).abs() < 1e-6 * kinetic);
}

/// What does not touch moves as it does alone, by any method; tolerances are those of the methods, some times what
/// was measured.
#[test]
fn each_body_moves_as_it_does_alone() {
    for (method, tolerance) in
        [(Method::CvodeBdf, 3e-9), (Method::Ida, 3e-8), (Method::Arkode, 3e-9)]
    {
        apart(method, falling(), tolerance);
    }
}

/// Two halves of a beam that are glued at all nodes where they meet are one beam: in equilibrium, and in motion by
/// the forms with constraints.
#[test]
fn two_tied_halves_are_one_beam() {
    let whole = block([0.0, 0.0], [0.2, 0.02], [21, 3], Cells::Triangles).build().unwrap();
    let half = |name: &str, x: f64| {
        let half = block([x, 0.0], [0.1, 0.02], [11, 3], Cells::Triangles).named(name);
        half.build().unwrap()
    };
    let halves = Body::join([half("base", 0.0), half("tip", 0.1)]).unwrap();
    let hung = |body: Body, clamp: &str| {
        Scene::new(body).gravity([0.0, -2.0]).phase(Phase::until(0.2).hold(clamp))
    };
    // nodes at the same place may be named from both sides
    let tied = hung(halves, "base/left").tie("tip/left", "base").tie("base/right", "tip");
    let whole = hung(whole, "left");
    let end = |motion: &Trajectory, nodes: &str| {
        let node = motion.body().mesh().sets()[nodes][2];
        [motion.last().u[2 * node], motion.last().u[2 * node + 1]]
    };
    let both = |whole: Trajectory, tied: Trajectory| {
        let (a, b) = (end(&whole, "right"), end(&tied, "tip/right"));
        (a[1], (a[0] - b[0]).abs().max((a[1] - b[1]).abs()))
    };
    let at_rest =
        |scene: &Scene| scene.equilibrium(&Statics::default()).unwrap().trajectory().clone();
    let (sag, off) = both(at_rest(&whole), at_rest(&tied));
    assert!(off < 1e-9 * sag.abs() && sag < -0.01, "in equilibrium: {sag} m, {off} m off");
    for (method, tolerance) in [(Method::CvodeBdf, 1e-6), (Method::Ida, 1e-6)] {
        let settings = Settings { method, rtol: 1e-9, ..Settings::default() };
        let (sag, off) = both(run(&whole, &settings), run(&tied, &settings));
        assert!(off < tolerance * sag.abs() && sag.abs() > 1e-3, "{method}: {sag} m, {off} m off");
    }
}

/// A light post on a viscous strip that is bent far: steps are those of the strip alone. (What is held by a tie alone, and is turned by the forces of
/// that tie faster than its own inertia resists, leaves the Newton matrix without the tie indefinite. Steps were 36 times as many where
/// that ended them.)
#[test]
fn a_light_post_on_a_tie_takes_no_more_steps() {
    let viscous = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 2e4 };
    let of = |cells: BodyBuilder, thickness: f64, material: Substance| {
        cells.thickness(thickness).material(material).strain(Strain::Green)
    };
    let strip = block([0.0, 0.0], [0.1, 0.01], [11, 2], Cells::Rectangles9).named("strip");
    let strip = of(strip, 0.02, viscous.into()).build().unwrap();
    let bent = |body: Body, left: &str, bottom: &str| {
        let phase = Phase::until(10.0).hold(left);
        let (times, forces) = (vec![0.0, 10.0], vec![[0.0, 0.0], [0.0, 5e-2]]);
        Scene::new(body).phase(phase.load_total_table(bottom, times, forces))
    };
    let steps = |scene: &Scene, method: Method| {
        let motion = run(scene, &Settings { method, ..Settings::default() });
        (motion.report().phases[0].counts.steps, motion.last().u[21])
    };
    let alone = bent(strip.clone(), "left", "bottom");
    for (material, most) in [(Material::rigid(1000.0), 1.2), (viscous.into(), 2.0)] {
        let post = block([0.083, 0.01], [0.004, 0.01], [2, 2], Cells::Rectangles).named("post");
        let post = of(post, 0.004, material).build().unwrap();
        let both = Body::join([strip.clone(), post]).unwrap();
        let both = bent(both, "strip/left", "strip/bottom").tie("post/bottom", "strip");
        for method in [Method::CvodeBdf, Method::Ida] {
            let [(alone, free), (both, tip)] = [&alone, &both].map(|scene| steps(scene, method));
            println!("{method}: {both} steps for {alone}, {tip} m for {free}");
            // found: 0.87 to 1.67 times as many, tips 1.2e-3 apart
            assert!(both as f64 <= most * alone as f64, "{method}: {both} steps for {alone}");
            assert!(free > 0.02 && (tip / free - 1.0).abs() < 2e-3, "{tip} {free}");
        }
    }
}

/// A finer mesh that is glued to a coarser one and pulled is strained evenly, as is the other: the patch test.
#[test]
fn glued_meshes_that_do_not_match_are_strained_evenly() {
    let coarse = block([0.0, 0.0], [0.1, 0.1], [4, 4], Cells::Rectangles).named("coarse");
    let fine = block([0.1, 0.0], [0.1, 0.1], [4, 7], Cells::Triangles).named("fine");
    let linear = |body: BodyBuilder| body.strain(Strain::Cauchy).build().unwrap();
    let scene = Scene::new(Body::join([linear(coarse), linear(fine)]).unwrap())
        .tie("fine/left", "coarse")
        .phase(
            Phase::until(1.0)
                .hold_axes("coarse/left", [pliant::Axis::X])
                .hold_axes([1], [pliant::Axis::Y])
                .traction("fine/right", [100.0, 0.0]),
        );
    let found = scene.equilibrium(&Statics::default()).unwrap().trajectory().clone();
    for field in found.body().cell_fields(&found.last().u) {
        assert!((field.stress[0][0] - 100.0).abs() < 1e-8, "{}", field.stress[0][0]);
        assert!(field.stress[1][1].abs() < 1e-8 && field.stress[0][1].abs() < 1e-8);
    }
}

/// Which surface of a tie follows the other does not depend on which was named: the finer one does, so that a coarse one does not
/// leave nodes of it free. A stretched pair of bodies whose nodes do not match, and whose cells are of different kinds, is as long as
/// one body (measured: to 6e-5 of its end's way; 0.10 of it where the coarse nodes followed).
#[test]
fn the_finer_surface_follows_the_coarser_one() {
    let coarse = block([0.0, 0.0], [0.05, 0.02], [6, 3], Cells::Rectangles).named("coarse");
    let fine = block([0.05, 0.0], [0.05, 0.02], [8, 6], Cells::Rectangles9).named("fine");
    let linear =
        |body: BodyBuilder| body.strain(Strain::Cauchy).plane(pliant::Plane::Stress).build();
    let both = Body::join([linear(coarse).unwrap(), linear(fine).unwrap()]).unwrap();
    let stretched = |nodes: &str, to: &str| {
        let scene = Scene::new(both.clone()).tie(nodes, to).phase(
            Phase::until(1.0)
                .hold_axes("coarse/left", [pliant::Axis::X])
                .hold_axes([1], [pliant::Axis::Y])
                .traction("fine/right", [100.0, 0.0]),
        );
        scene.equilibrium(&Statics::default()).unwrap().displacements().to_vec()
    };
    let u = stretched("fine/left", "coarse");
    let other = stretched("coarse/right", "fine");
    let largest = u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let apart = u.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-12 * largest, "{apart} of {largest}");
    // as one body of 10 cm: 100 Pa over E = 5e4 Pa, and nu of it across
    let exact = |x: &[f64]| [2e-3 * x[0], -0.3 * 2e-3 * x[1]];
    let exact: Vec<f64> = both.mesh().positions().chunks(2).flat_map(exact).collect();
    let off = u.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("{}", off / largest);
    assert!(off < 5e-3 * largest, "{off} of {largest}");
}

/// Rubber that hangs on a rigid plate which is held is rubber whose top is held, on whichever side the tie was named and however
/// coarse the mesh of the plate is, also where the plate is larger than the rubber.
#[test]
fn rubber_on_a_rigid_plate() {
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 2e3 };
    let mesh = Mesh::cuboid([0.04, 0.04, 0.04], [4, 4, 4], SolidCells::Hexahedra20).unwrap();
    let soft = Body::new(mesh, rubber).named("soft").build().unwrap();
    let hangs = |body: Body, held: &str, tie: Option<(&str, &str)>| {
        let mut scene = Scene::new(body).gravity([0.0, 0.0, -9.8]);
        if let Some((nodes, to)) = tie {
            scene = scene.tie(nodes, to);
        }
        let scene = scene.phase(Phase::until(1.0).hold(held));
        let rest = scene.equilibrium(&Statics::default()).unwrap();
        let part = scene.body().parts().last().unwrap();
        rest.displacements()[part.dofs()].to_vec()
    };
    let alone = hangs(soft.clone(), "top", None);
    let most = alone.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    for (size, at) in [(0.04, 0.0), (0.06, -0.01)] {
        let plate = Mesh::cuboid([size, size, 0.01], [3, 3, 2], SolidCells::Hexahedra).unwrap();
        let plate = plate.translated(&[at, at, 0.04]).unwrap();
        let plate = Body::new(plate, Material::rigid(2000.0)).named("plate").build().unwrap();
        let both = Body::join([plate, soft.clone()]).unwrap();
        for tie in [("plate/bottom", "soft"), ("soft/top", "plate")] {
            if size > 0.04 && tie.1 == "soft" {
                continue; // nodes of the rim are not at the rubber
            }
            let tied = hangs(both.clone(), "plate/top", Some(tie));
            let off = tied.iter().zip(&alone).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // 6.8e-4 were found; the sag was 2.16 times as large where nodes of the plate followed those of the rubber
            println!("{tie:?}, {size} m: {:e}", off / most);
            assert!(off < 1e-3 * most, "{tie:?}: {off} of {most}");
        }
    }
}

/// Momenta of two bodies on a spring: they add up to that of all, which does not change.
#[test]
fn bodies_on_a_spring_exchange_momentum() {
    let scene = Scene::new(Body::join(falling()).unwrap())
        .spring(Spring::between([4], [20]).stiffness(20.0).length(0.1))
        .initial_velocity_of("square", [0.0, 1.0])
        .spin_of("rubber", [5.0])
        .phase(Phase::until(0.3));
    let momentum = |name: &str| Reading::momentum().of_body(name);
    let sampling = Sampling::every(0.1)
        .read("all", Reading::momentum())
        .read("one", momentum("square"))
        .read("other", momentum("rubber"))
        .read("turned", Reading::rotation().of_body("rubber"));
    let settings = Settings { method: Method::CvodeBdf, rtol: 1e-8, ..Settings::default() };
    let motion = scene.simulate(&settings, &sampling).unwrap();
    let first = &motion.samples()[0].sensors;
    // the square weighs 0.1 kg
    assert!((first[1] - 0.1).abs() < 1e-12 && (first[3] - 0.1).abs() < 1e-12);
    // of the square, and of the rectangle of 0.05 kg that turns
    let kinetic = 0.5 * 0.1 + 0.5 * 25.0 * 0.05 * (0.1 * 0.1 + 0.05 * 0.05) / 12.0;
    assert!((motion.samples()[0].energy.kinetic - kinetic).abs() < 1e-12);
    for sample in motion.samples() {
        let [ax, ay, bx, by, cx, cy, _] = sample.sensors[..] else { panic!("seven columns") };
        assert!((ax - bx - cx).abs() < 1e-15 && (ay - by - cy).abs() < 1e-15);
        assert!(ax.abs() < 1e-9 && (ay - 0.1).abs() < 1e-9, "{ax} {ay}");
    }
    let last = &motion.last().sensors;
    assert!(last[4].abs() > 0.01 && last[6].abs() > 1.0, "{last:?}");
}

/// What is measured on the motion of each body is told of that body.
#[test]
fn each_body_is_measured_by_itself() {
    let square = |name: &str, x: f64| {
        let body = block([x, 0.0], [0.1, 0.1], [4, 4], Cells::Triangles).named(name);
        body.strain(Strain::Cauchy).build().unwrap()
    };
    let scene = Scene::new(Body::join([square("still", 0.0), square("turning", 0.5)]).unwrap())
        .spin_of("turning", [5.0])
        .phase(Phase::until(0.02));
    let motion = run(&scene, &Settings::default());
    let turns = motion.report().indicators.iter().filter(|measured| measured.name == "turn");
    let [still, turning] = turns.collect::<Vec<_>>()[..] else { panic!("a turn of each body") };
    assert!(still.text.starts_with("body \"still\": ") && still.value < 1e-6, "{still}");
    assert!(turning.text.starts_with("body \"turning\": "), "{turning}");
    assert!((turning.value - 0.1_f64.to_degrees()).abs() < 0.1, "{turning}");
}

/// Bodies do not feel each other yet: a run in which one passes through another says so.
#[test]
fn bodies_that_pass_through_each_other_are_told() {
    let square = |name: &str, x: f64| {
        let body = block([x, 0.0], [0.1, 0.1], [4, 4], Cells::Triangles).named(name);
        body.build().unwrap()
    };
    let scene = Scene::new(Body::join([square("left", 0.0), square("right", 0.15)]).unwrap())
        .initial_velocity_of("left", [1.0, 0.0])
        .phase(Phase::until(0.1));
    assert_eq!(scene.warnings(), [""; 0]);
    let motion = run(&scene, &Settings::default());
    let warnings = motion.report().warnings();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    let told = [
        "body \"left\" passes through body \"right\"",
        "body \"right\" passes through body \"left\"",
    ];
    assert!(told.iter().any(|told| warnings[0].starts_with(told)), "{}", warnings[0]);
}

#[test]
fn bad_ties_are_refused() {
    let bodies = || Body::join(falling()).unwrap();
    let scene = || Scene::new(bodies()).phase(Phase::until(1.0));
    for (scene, told) in [
        (scene().tie("square/right", "rubber"), "distance of tied node 4 = 2.002e-1 m"),
        (
            scene().tie("square/right", "square"),
            "node of a tie = 4 cannot be used: it is a node of body",
        ),
        (scene().tie("square/right", "cube"), "body of a tie = \"cube\""),
        (scene().tie("right", "rubber"), "node set = \"right\""),
        (scene().spin_of("cube", [1.0]), "body of a spin = \"cube\""),
    ] {
        let error = scene.validate().unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
}

const GLUED_ARM: &str = include_str!("../../scenes/glued-arm.toml");
const POINT: &str = "
[[point]]
name = \"tip\"
position = [0.17, 0.0]
mass = 0.01
body = \"hand\"
";

#[test]
fn files_have_several_bodies() {
    let parse = |text: &str| SceneFile::parse(text, Path::new("arm.toml"));
    let text = GLUED_ARM.to_owned() + POINT;
    let file = parse(&text).unwrap();
    let parts: Vec<_> = file.scene.body().parts().collect();
    assert_eq!(parts.iter().map(|part| part.name).collect::<Vec<_>>(), ["arm", "hand", "weight"]);
    // 6 x 2 cells of six nodes along each side of 13 x 5, and the point mass
    assert_eq!(parts[1].nodes.len(), 13 * 5 + 1);
    assert!((parts[1].body.mass() - 1100.0 * 0.06 * 0.02 * 0.02 - 0.01).abs() < 1e-12);
    let mesh = file.scene.body().mesh();
    assert_eq!(mesh.sets()["hand/tip"], [parts[1].nodes.end - 1]);
    let start = file.scene.clone().ended_at(1e-4).simulate(&file.settings, &Sampling::phase_ends());
    let start = start.unwrap().samples()[0].clone();
    let [x, y] = parts[2].body.mean_velocity(&start.v[parts[2].dofs()])[..] else { panic!() };
    assert!((x + 0.3).abs() < 1e-12 && y.abs() < 1e-12);
    assert!(start.v[parts[0].dofs()].iter().all(|v| *v == 0.0), "the arm is at rest");
    for (finer, to) in [
        ("quadratic = true", "bubbles = true, origin = [0.1, 0.0] }\ndilatation = \"linear\"\n#"),
        ("poisson = 0.4, viscosity = 20.0", "poisson = 0.48, viscosity = 20.0"),
    ] {
        let text = text.replace(finer, to).replace("quadratic = true", "bubbles = true");
        let hand = parse(&text).unwrap().scene.body().parts().nth(1).unwrap().body.dilatation();
        assert_eq!(hand, Dilatation::Linear, "{to}");
    }
    for (from, to, told) in [
        (
            "name = \"weight\"\nmesh",
            "name = \"arm\"\nmesh",
            "name of a body = \"arm\" cannot be used: it is taken",
        ),
        ("mass = 0.01\nbody = \"hand\"", "mass = 0.01", "expected the name of the body"),
        ("mass = 0.01\nbody = \"hand\"", "mass = 0.01\nbody = \"foot\"", "\"foot\""),
        ("to = \"arm\"", "to = \"leg\"", "body of a tie = \"leg\""),
        ("quadratic = true", "halved_in = [{ nodes = \"left\" }]", "places of a single body only"),
        ("nodes = \"hand/left\"", "nodes = \"hand/right\"", "distance of tied node"),
        ("body = \"weight\"", "body = \"leg\"", "body of sensor \"weight\" = \"leg\""),
        ("nodes = \"arm/left\"", "nodes = \"left\"", "\"left\""),
        ("\"hand/right/1\"", "\"hand/right/9\"", "one of the nodes 1 to 5 of the set"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = parse(&text.replace(from, to)).unwrap_err().to_string();
        assert!(error.contains(told) && error.contains("arm.toml"), "{told}: {error}");
    }
}

/// On finer meshes a scene of several bodies is the one that is built on the meshes halved, bit by bit: what is rigid keeps its mesh,
/// nodes by number stay where they are, a held edge gets the new nodes between them, ties are found anew.
#[test]
fn several_bodies_on_finer_meshes() {
    let scene = |is_halved: bool| {
        let soft = |name, x: f64| {
            let mesh = Mesh::rectangle([0.1, 0.05], [5, 3], Cells::Rectangles).unwrap();
            let mesh = mesh.translated(&[x, 0.0]).unwrap();
            let mesh = if is_halved { mesh.halved() } else { mesh };
            Body::new(mesh, SOFT).thickness(0.01).strain(Strain::Green).named(name)
        };
        let plate = Mesh::rectangle([0.1, 0.05], [2, 2], Cells::Rectangles).unwrap();
        let plate = Body::new(plate.translated(&[0.1, 0.0]).unwrap(), Material::rigid(500.0));
        let plate = plate.thickness(0.01).strain(Strain::Green).named("plate");
        let bodies = [soft("left", 0.0), plate, soft("right", 0.2)];
        let body = Body::join(bodies.map(|body| body.build().unwrap())).unwrap();
        // nodes of the coarse meshes, row by row
        let first: Vec<usize> = body.parts().map(|part| part.nodes.start + 1).collect();
        let phase = match is_halved {
            true => Phase::until(0.05).hold("left/left"),
            false => Phase::until(0.05).hold([first[0], first[0] + 5, first[0] + 10]),
        };
        Scene::new(body)
            .tie("left/right", "plate")
            .tie("right/left", "plate")
            .spring(Spring::between([first[0] + 12], [first[2] + 2]).stiffness(5.0))
            .gravity([0.0, -9.8])
            .phase(phase.load([first[2] + 14], [0.02, 0.03]))
    };
    let settings = Settings { rtol: 1e-4, ..Settings::default() };
    let finer = run(&scene(false).halved().unwrap(), &settings);
    let built = run(&scene(true), &settings);
    assert_eq!(finer.body().parts().nth(1).unwrap().nodes.len(), 4);
    assert!(finer.last().u.iter().any(|u| u.abs() > 1e-3));
    assert_eq!(finer.last().u, built.last().u);

    let weighted = block([0.0, 0.0], [0.1, 0.1], [2, 2], Cells::Triangles);
    let weighted = weighted.point_mass("weight", [0.2, 0.2], 0.1).named("weighted");
    let other = block([0.3, 0.0], [0.1, 0.1], [2, 2], Cells::Triangles);
    let both = Body::join([weighted, other].map(|body| body.build().unwrap())).unwrap();
    let refused = Scene::new(both).phase(Phase::until(0.1)).halved().unwrap_err().to_string();
    assert!(refused.contains("point mass") && refused.contains("weight"), "{refused}");
}
