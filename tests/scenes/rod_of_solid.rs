//! Rods in place of slender solids, against these and against closed forms.

use std::f64::consts::PI;
use std::path::Path;

use pliant::simulate::Reading;
use pliant::{
    Axis, Body, Cells, Equilibrium, Error, Law, Material, Mesh, Obstacle, Phase, Plane, Sampling,
    Scene, SceneFile, Settings, SolidCells, Statics, Substance,
};

type Outcome = Result<(), Error>;

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 40.0 };

/// Mean displacement of a set of nodes.
fn moved(rest: &Equilibrium, nodes: &[usize]) -> Vec<f64> {
    let d = rest.trajectory().body().dimension();
    let mean = |i| nodes.iter().map(|node| rest.displacements()[node * d + i]).sum::<f64>();
    (0..d).map(|i| mean(i) / nodes.len() as f64).collect()
}

/// Displacements of the end of a solid and of that of its rod.
fn ends(solid: &Scene, elements: usize) -> Result<[Vec<f64>; 2], Error> {
    let rod = solid.as_rod(elements)?;
    let of = |scene: &Scene, set: &str| -> Result<Vec<f64>, Error> {
        let rest = scene.equilibrium(&Statics::default())?;
        Ok(moved(&rest, &scene.body().mesh().sets()[set]))
    };
    Ok([of(solid, "right")?, of(&rod, "end")?])
}

fn off(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// A block of 20 x 1 x 1 is bent by a small force: the rod's tip against Euler and Bernoulli with the shear of Timoshenko, F L^3/(3 E I) + F L/(k G A) with
/// k = 5/6, and against quadratic cells. The clamp, which keeps the solid from becoming thicker there, is what they differ by.
#[test]
fn the_tip_of_a_slender_cantilever() -> Outcome {
    let (length, side, force) = (0.2, 0.01, 1e-4);
    let mesh = Mesh::cuboid([length, side, side], [21, 3, 3], SolidCells::Hexahedra20)?;
    let solid = Scene::new(Body::new(mesh, RUBBER).build()?)
        .phase(Phase::until(1.0).hold("left").load_total("right", [0.0, 0.0, -force]));
    let (bending, shear) = (1e6 * side.powi(4) / 12.0, 1e6 / 2.6 * side * side * 5.0 / 6.0);
    let exact = force * length.powi(3) / (3.0 * bending) + force * length / shear;
    let [of_solid, of_rod] = ends(&solid, 10)?.map(|moved| -moved[2]);
    println!("{exact:e}, solid {:e}, rod {:e}", off(of_solid, exact), off(of_rod, exact));
    assert!(off(of_rod, exact) < 4e-3, "{of_rod:e} {exact:e}");
    assert!(off(of_rod, of_solid) < 1e-2, "{of_rod:e} {of_solid:e}");
    Ok(())
}

/// The same in the plane, where plane strain is stiffer by 1/(1 - nu^2), and far bent: by a quarter of the length.
#[test]
fn plane_strain_and_plane_stress_are_bent_far() -> Outcome {
    for plane in [Plane::Strain, Plane::Stress] {
        let mesh = Mesh::rectangle([0.2, 0.01], [41, 3], Cells::Rectangles9)?;
        let body = Body::new(mesh, RUBBER).thickness(0.01).plane(plane).build()?;
        let solid = Scene::new(body)
            .gravity([0.0, -9.81])
            .phase(Phase::until(1.0).hold("left").load_total("right", [0.0, -0.01]));
        let [of_solid, of_rod] = ends(&solid, 20)?;
        let apart = (of_solid[0] - of_rod[0]).hypot(of_solid[1] - of_rod[1]);
        println!("{plane:?}: solid {of_solid:?}, rod {of_rod:?}, {:e} of its length", apart / 0.2);
        assert!(of_solid[1] < -0.05 && apart < 2e-3 * 0.2, "{plane:?}: {apart:e}");
    }
    Ok(())
}

/// A couple of forces twists a square block that lies along a diagonal of space by T L/(G J), J = 0.1406 a^4.
#[test]
fn torsion_of_a_turned_block() -> Outcome {
    let (length, side, force) = (0.3, 0.01, 1e-4);
    let mesh = Mesh::cuboid([length, side, side], [4, 5, 5], SolidCells::Hexahedra)?;
    let corner = |y: f64, z: f64| {
        let mesh = &mesh;
        (0..mesh.node_count())
            .find(|&node| {
                let x = mesh.position(node);
                (x[0] - length).abs() + (x[1] - y).abs() + (x[2] - z).abs() < 1e-9
            })
            .map(|node| node + 1)
    };
    let [low, high] = [corner(0.0, 0.0), corner(side, 0.0)].map(|node| node.into_iter().collect());
    let [low, high]: [Vec<usize>; 2] = [low, high];
    let turn = [0.3, 0.7, -0.2];
    let rotation = nalgebra::Rotation3::new(turn.into());
    let body = Body::new(mesh.clone().turned(&turn)?, RUBBER).build()?;
    // forces along z of the block, a side apart along y
    let up: [f64; 3] = (rotation * nalgebra::Vector3::new(0.0, 0.0, force)).into();
    let down = up.map(|component| -component);
    let phase = Phase::until(1.0).hold("left").load(low, down).load(high, up);
    let rod = Scene::new(body).phase(phase).as_rod(6)?;
    let rest = rod.equilibrium(&Statics::default())?;
    // the node at d_1, seen from that on the axis
    let mesh = rod.body().mesh();
    let [centre, arm] = [mesh.sets()["end-section"][0], mesh.sets()["end-section"][1]];
    let vector = |x: &[f64]| {
        let [a, b]: [&[f64]; 2] = [centre, arm].map(|node| &x[3 * node..][..3]);
        nalgebra::Vector3::new(b[0] - a[0], b[1] - a[1], b[2] - a[2])
    };
    let (d, moved) = (vector(mesh.positions()), vector(rest.displacements()));
    let along = rotation * nalgebra::Vector3::x();
    let angle = along.cross(&d).dot(&moved) / d.norm_squared();
    let exact = force * side * length / (1e6 / 2.6 * 0.140_577 * side.powi(4));
    println!("{angle:e} {exact:e}: {:e}", off(angle, exact));
    assert!(off(angle, exact) < 2e-3, "{angle:e} {exact:e}");
    Ok(())
}

/// A cylinder of curved cells: its rod has the numbers of the circle, though its cuts are polygons of 8 sides, sags as the solid does under its
/// weight, and swings with the lowest frequency of a clamped rod, 1.8751^2/(2 pi) sqrt(E I/(rho A L^4)).
#[test]
fn a_cylinder_sags_and_swings() -> Outcome {
    let (length, radius) = (0.2, 0.005);
    let square = Mesh::cuboid([length, 2.0, 2.0], [9, 3, 3], SolidCells::Hexahedra20)?;
    // squares around the axis become circles
    let round = square.mapped(|x| {
        let [y, z] = [x[1] - 1.0, x[2] - 1.0];
        let (size, length) = (y.abs().max(z.abs()), y.hypot(z));
        let factor = if length > 0.0 { radius * size / length } else { 0.0 };
        [x[0], factor * y, factor * z]
    })?;
    let solid = Scene::new(Body::new(round, RUBBER).build()?)
        .gravity([0.0, 0.0, -0.1])
        .phase(Phase::until(1.5).hold("left"));
    let rod = solid.as_rod(10)?;
    let area = rod.body().mass() / (1000.0 * length);
    let [of_solid, of_rod] = ends(&solid, 10)?.map(|moved| -moved[2]);
    let bending = 1e6 * PI / 4.0 * f64::powi(radius, 4);
    let exact = 0.1 * 1000.0 * PI * radius * radius * length.powi(4) / (8.0 * bending);
    println!(
        "area {:e}, sag {exact:e}: solid {:e}, rod {:e}",
        off(area, PI * radius * radius),
        off(of_solid, exact),
        off(of_rod, exact)
    );
    assert!(off(area, PI * radius * radius) < 5e-3);
    assert!(off(of_rod, exact) < 1e-2, "{of_rod:e} {exact:e}");
    // eight cells along it are too stiff: by 2.4 %, ten times as far bent
    assert!(off(of_rod, of_solid) < 4e-2, "{of_solid:e} {of_rod:e}");
    let settings = Settings { rtol: 1e-6, ..Settings::default() };
    let sampling = Sampling::every(1e-3).read("tip", Reading::velocity("end"));
    let motion = rod.simulate(&settings, &sampling)?;
    // the tip turns around, from its second turn on without the higher modes of the start
    let turns: Vec<f64> = motion
        .samples()
        .windows(2)
        .filter_map(|pair| {
            let [a, b] = [&pair[0], &pair[1]].map(|sample| sample.sensors[2]);
            (a * b < 0.0).then(|| pair[0].time + a / (a - b) * 1e-3)
        })
        .collect();
    let period = 2.0 * (turns[turns.len() - 1] - turns[0]) / (turns.len() - 1) as f64;
    let exact = 2.0 * PI / 1.875_104_f64.powi(2) * (length * length) / (radius / 2.0)
        * (1000.0_f64 / 1e6).sqrt();
    println!("{} turns, period {period} s, exact {exact} s", turns.len());
    assert!(off(period, exact) < 0.02, "{period} {exact}");
    Ok(())
}

/// Readings of the solid are read from the rod: at its end, in its middle, beside the axis.
#[test]
fn sensors_of_a_file_read_the_rod() -> Outcome {
    let text = |solver: &str| {
        format!(
            r#"
            dimension = 3
            gravity = [0.0, 0.0, -9.81]
            [body]
            mesh = {{ kind = "cuboid", size = [0.2, 0.01, 0.01], nodes = [11, 2, 2], cells = "hexahedra20" }}
            material = {{ density = 1000.0, young = 1.0e6, poisson = 0.3, viscosity = 400.0 }}
            [[phase]]
            until = 0.05
            hold = {{ nodes = "left" }}
            [[sensor]]
            name = "tip"
            kind = "position"
            nodes = "right"
            [[sensor]]
            name = "corner"
            kind = "displacement"
            nodes = {{ box = [[0.1, 0.0, 0.0], [0.1, 0.0, 0.0]] }}
            [[sensor]]
            name = "root"
            kind = "constraint-force"
            nodes = "left"
            [solver]
            rtol = 1.0e-5
            {solver}
            "#
        )
    };
    let run = |text: &str| -> Result<Vec<f64>, Error> {
        let file = SceneFile::parse(text, Path::new("."))?;
        let motion = file.scene.simulate(&file.settings, &file.output.sampling())?;
        Ok(motion.last().sensors.clone())
    };
    let [solid, rod] = [run(&text(""))?, run(&text("rod = 10"))?];
    println!("{solid:?}\n{rod:?}");
    // places (m); the force that bears it, on which waves along it have no part
    for (k, (solid, rod)) in solid[..6].iter().zip(&rod).enumerate() {
        assert!((solid - rod).abs() < 5e-4, "{k}: {solid} {rod}");
    }
    assert!(off(rod[8], solid[8]) < 0.1, "{} {}", solid[8], rod[8]);
    // 3 elements have no cross section in the middle
    let said = run(&text("rod = 3")).unwrap_err().to_string();
    assert!(
        said.contains("sensor \"corner\"") && said.contains("choose a number of elements"),
        "{said}"
    );
    Ok(())
}

/// Whatever a rod cannot stand for is refused by its name.
#[test]
fn rods_refuse_what_they_are_not() -> Outcome {
    let mesh = || Mesh::rectangle([0.2, 0.01], [21, 3], Cells::Rectangles);
    let body = |mesh, material: Substance| Body::new(mesh, material).thickness(0.01).build();
    let beam = || Ok::<_, Error>(Scene::new(body(mesh()?, RUBBER.into())?));
    let held = Phase::until(1.0).hold("left");
    let taper = mesh()?.mapped(|x| [x[0], x[1] * (1.0 - 2.0 * x[0])])?;
    let bent = mesh()?.mapped(|x| [x[0], x[1] + x[0] * x[0]])?;
    let short = Mesh::rectangle([0.02, 0.01], [5, 3], Cells::Rectangles)?;
    let floor = Obstacle::half_plane([0.0, -0.1], [0.0, 1.0]).stiffness(1.0);
    for (scene, says) in [
        (
            Scene::new(body(taper, RUBBER.into())?).phase(held.clone()),
            "size of the cross section of the solid",
        ),
        (
            Scene::new(body(bent, RUBBER.into())?).phase(held.clone()),
            "axis of the solid = not straight",
        ),
        (
            Scene::new(body(short, RUBBER.into())?).phase(held.clone()),
            "length of the solid along its axis = 2 times",
        ),
        (
            Scene::new(body(mesh()?, Material::rigid(1000.0))?).phase(Phase::until(1.0)),
            "rigid materials = 1",
        ),
        (beam()?.obstacle(floor).phase(held.clone()), "obstacles = 1"),
        (beam()?.phase(held.clone().pressure_on("top", 10.0)), "moments, followers, pressures"),
        (beam()?.phase(Phase::until(1.0).hold([1])), "these are 1 of the 3 nodes"),
        (beam()?.phase(Phase::until(1.0).hold("bottom")), "in none of the cross sections"),
        (beam()?.initial_velocity(|x| vec![x[0], 0.0]).phase(held.clone()), "initial velocities"),
        (
            beam()?.initial_displacement(|x| vec![0.1 * x[0], 0.0]).phase(held.clone()),
            "initial displacements",
        ),
    ] {
        let said = scene.as_rod(7).unwrap_err().to_string();
        assert!(said.contains(says), "{says}: {said}");
    }
    let elements = beam()?.phase(held.clone()).as_rod(0).unwrap_err().to_string();
    assert!(elements.contains("elements of the rod = 0"), "{elements}");
    // rubber has its moduli at small strains
    let rubber = RUBBER.law(Law::NeoHookean);
    let scene = Scene::new(body(mesh()?, rubber)?).phase(held.hold_axes("right", [Axis::Y]));
    scene.as_rod(10)?.equilibrium(&Statics::default())?;
    Ok(())
}

/// A point beside the axis moves with its cross section.
#[test]
fn places_within_the_solid_are_those_of_its_cross_sections() -> Outcome {
    let mesh = Mesh::rectangle([0.2, 0.02], [41, 5], Cells::Rectangles9)?;
    let solid = Scene::new(Body::new(mesh, RUBBER).thickness(0.01).build()?)
        .gravity([0.0, -9.81])
        .phase(Phase::until(1.0).hold("left"));
    let rest = solid.equilibrium(&Statics::default())?;
    let of_rod = solid.as_rod(10)?;
    let rod = of_rod.equilibrium(&Statics::default())?;
    // the upper corner of the solid is the node of the rod at d_1
    let node = |scene: &Scene| {
        let mesh = scene.body().mesh();
        (0..mesh.node_count())
            .find(|&node| {
                let x = mesh.position(node);
                (x[0] - 0.2).abs() + (x[1] - 0.02).abs() < 1e-9
            })
            .unwrap()
    };
    let [own, marked] = [moved(&rest, &[node(&solid)]), moved(&rod, &[node(&of_rod)])];
    println!("{own:?} {marked:?}");
    let apart = (own[0] - marked[0]).hypot(own[1] - marked[1]);
    assert!(apart < 5e-4, "{apart:e}");
    Ok(())
}
