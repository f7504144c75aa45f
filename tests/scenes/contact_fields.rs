//! Contact pressure, the area in touch, and what sticks.

use std::error::Error;

use pliant::body::BodyBuilder;
use pliant::simulate::Reading;
use pliant::{
    Axis, Body, Cells, ContactStatus, Material, Mesh, NodalContact, Obstacle, Phase, Sampling,
    Scene, Settings, SolidCells, Statics, Touch, Trajectory,
};

type Outcome = Result<(), Box<dyn Error>>;

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
/// The same without lateral strain.
const UPRIGHT: Material = Material { poisson: 0.0, ..SOFT };
const GRAVITY: f64 = 9.8;
/// Of a block, above what it lies on: what it weighs per area is the pressure below it (Pa).
const HEIGHT: f64 = 0.05;
const PRESSURE: f64 = 1000.0 * GRAVITY * HEIGHT;

fn block(at: [f64; 2], size: [f64; 2], nodes: [usize; 2], cells: Cells) -> BodyBuilder {
    let mesh = Mesh::rectangle(size, nodes, cells).unwrap().translated(&at).unwrap();
    Body::new(mesh, SOFT).thickness(0.01)
}

fn cube(nodes: [usize; 3], cells: SolidCells) -> BodyBuilder {
    Body::new(Mesh::cuboid([0.1, 0.1, HEIGHT], nodes, cells).unwrap(), SOFT)
}

/// What lies on a floor as gravity alone presses it there, held along it as little as it takes.
fn lying(body: &Body, floor: Obstacle) -> Result<Trajectory, pliant::Error> {
    let d = body.dimension();
    let upward: Vec<f64> = (0..d).map(|i| f64::from(i + 1 == d)).collect();
    let phase = match d {
        1 => Phase::until(1.0),
        2 => Phase::until(1.0).hold_axes([1], [Axis::X]),
        _ => Phase::until(1.0).hold_axes([1], [Axis::X, Axis::Y]).hold_axes([2], [Axis::Y]),
    };
    let scene = Scene::new(body.clone())
        .gravity(upward.iter().map(|x| -GRAVITY * x).collect::<Vec<_>>())
        .obstacle(floor)
        .phase(phase);
    Ok(scene.equilibrium(&Statics::default())?.trajectory().clone())
}

fn floor(dimension: usize) -> Obstacle {
    let upward: Vec<f64> = (0..dimension).map(|i| f64::from(i + 1 == dimension)).collect();
    Obstacle::half_plane(vec![0.0; dimension], upward).friction_coefficient(0.5)
}

/// The least and the largest pressure (Pa) of the nodes that touch, and the area (m^2) and the normal force (N) of all.
fn summed<'a>(nodal: impl Iterator<Item = &'a NodalContact>) -> ([f64; 2], f64, f64) {
    let (mut range, mut area, mut force) = ([f64::INFINITY, 0.0], 0.0, 0.0);
    for node in nodal.filter(|node| node.status() != ContactStatus::Open) {
        let given = node.pressure() * node.area();
        assert!((given - node.normal_force()).abs() < 1e-12, "{node:?}");
        range = [range[0].min(node.pressure()), range[1].max(node.pressure())];
        area += node.area();
        force += node.normal_force();
    }
    (range, area, force)
}

/// What sensors read at the last sample: where it is an equilibrium, at the start of a motion from there.
fn read<const N: usize>(motion: &Trajectory, readings: [Reading; N]) -> [f64; N] {
    let scene = motion.scene().clone().starting_from(&motion.state(motion.last()));
    let sampling = Sampling::at([1e-9]);
    let sampling = readings
        .into_iter()
        .enumerate()
        .fold(sampling, |all, (k, one)| all.read(k.to_string(), one));
    let read = scene.simulate(&Settings::default(), &sampling).unwrap();
    std::array::from_fn(|k| read.samples()[0].sensors[k])
}

/// A block at rest presses with its weight on the area of its side, at each node as in the sum, whether the floor has a
/// stiffness per node or per area; so does a bar on a plate, and a block in space. Poisson's ratio is 0: others bend the
/// bottom of a block that hangs in its own weight.
#[test]
fn a_block_at_rest_has_the_pressure_of_its_weight() -> Outcome {
    let size = [0.1, HEIGHT];
    let bar = Body::new(Mesh::bar(HEIGHT, 5)?, SOFT).area(1e-3);
    let plane = |cells| block([0.0; 2], size, [6, 4], cells);
    // how far pressures at nodes may be from rho g h, a quarter more than measured. A stiffness per node is more at the
    // rim, in relation to what rests there
    let cases = [
        ("bar", bar, 1e-3, [1e-9, 1e-9]),
        ("rectangles", plane(Cells::Rectangles), 1e-3, [1.1e-2, 1e-9]),
        ("triangles", plane(Cells::Triangles), 1e-3, [4e-2, 2.4e-2]),
        ("triangles6", plane(Cells::Triangles6), 1e-3, [1.2e-3, 2e-6]),
        ("rectangles9", plane(Cells::Rectangles9), 1e-3, [4e-4, 1e-9]),
        ("hexahedra", cube([5, 4, 3], SolidCells::Hexahedra), 1e-2, [6.5e-3, 1e-9]),
        ("tetrahedra", cube([5, 4, 3], SolidCells::Tetrahedra), 1e-2, [5.4e-2, 4.3e-2]),
        ("hexahedra27", cube([3, 3, 3], SolidCells::Hexahedra27), 1e-2, [3.2e-4, 3e-5]),
    ];
    for (name, body, side, uneven) in cases {
        let body = body.material(UPRIGHT).build()?;
        let weight = body.mass() * GRAVITY;
        let count = body.mesh().select(&"all".into())?.len() as f64;
        let per_node = floor(body.dimension()).stiffness(1e8 * side / count.sqrt());
        let per_area = floor(body.dimension()).stiffness_density(1e8);
        for (floor, uneven) in [per_node, per_area].into_iter().zip(uneven) {
            let motion = lying(&body, floor)?;
            let nodal = motion.nodal_contacts(motion.last())?;
            let ([least, most], area, force) = summed(nodal.iter());
            // as seen under deformed faces
            assert!((area / side - 1.0).abs() < 3e-6, "{name}: {area} m^2");
            assert!((force / weight - 1.0).abs() < 1e-9, "{name}: {force} N");
            let off = f64::max(most / PRESSURE - 1.0, 1.0 - least / PRESSURE);
            println!("{name}: pressures off by {off:.1e}");
            assert!(off < uneven, "{name}: {least} to {most} Pa");
            let sticks = |node: &&NodalContact| node.status() == ContactStatus::Sticking;
            let touching = nodal.iter().filter(|node| node.normal_force() > 0.0).count();
            assert_eq!(nodal.iter().filter(sticks).count(), touching);
            let readings = [Reading::contact_area("floor"), Reading::contact_pressure("floor")];
            assert_eq!(read(&motion, readings), [area, most], "{name}");
        }
    }
    Ok(())
}

/// A block on a block, with nodes in other places: what one presses on the other comes back, as pressure and area of
/// both, and sensors read them.
#[test]
fn blocks_press_on_each_other_alike() -> Outcome {
    let upright = |body: BodyBuilder| body.material(UPRIGHT);
    let lower = upright(block([0.0; 2], [0.05, 0.03], [8, 4], Cells::Rectangles)).named("lower");
    let upper = block([0.0, 0.03025], [0.05, HEIGHT], [6, 6], Cells::Rectangles);
    let upper = upright(upper).named("upper");
    let scene = Scene::new(Body::join([lower.build()?, upper.build()?])?)
        .touch(Touch::between(["lower", "upper"]).distance(5e-4))
        .gravity([0.0, -GRAVITY])
        .phase(Phase::until(1.0).hold("lower/bottom").hold_axes("upper/top", [Axis::X]));
    let found = scene.equilibrium(&Statics::default())?;
    let (motion, side) = (found.trajectory(), 0.05 * 0.01);
    let nodal = motion.nodal_contacts(found.sample())?;
    for part in motion.body().parts() {
        let ([least, most], area, force) = summed(nodal[part.nodes.clone()].iter());
        // measured: 0.6 % below to 0.8 % above
        assert!(least > 0.992 * PRESSURE && most < 1.01 * PRESSURE, "{least} to {most} Pa");
        assert!((area / side - 1.0).abs() < 1e-6, "{area} m^2");
        assert!((force / (PRESSURE * side) - 1.0).abs() < 1e-6, "{force} N");
        let readings = [Reading::touch_area("touch"), Reading::touch_pressure("touch")]
            .map(|reading| reading.of_body(part.name));
        assert_eq!(read(motion, readings), [area, most]);
    }
    Ok(())
}

/// A block on a rigid plate with larger cells, some of them beyond its sides, is under its weight at all nodes, by all kinds of cells. Its side faces
/// end within the distance of the plate, and bear nothing.
#[test]
fn a_block_presses_evenly_on_a_rigid_plate() -> Outcome {
    let plate = |mesh: Mesh| Body::new(mesh, Material::rigid(1000.0)).named("plate");
    let on_plate = |body: BodyBuilder, plate: BodyBuilder| -> Result<[f64; 3], Box<dyn Error>> {
        let block = body.material(UPRIGHT).named("block").build()?;
        let (d, weight) = (block.dimension(), block.mass() * GRAVITY);
        let upright = &[Axis::X, Axis::Y][..d - 1];
        let upward = (0..d).map(|i| if i + 1 == d { -GRAVITY } else { 0.0 });
        let scene = Scene::new(Body::join([block, plate.build()?])?)
            .touch(Touch::all().distance(1e-4))
            .gravity(upward.collect::<Vec<_>>())
            .phase(Phase::until(1.0).hold("plate").hold_axes("block/top", upright.to_vec()));
        let found = scene.equilibrium(&Statics::default())?;
        let nodal = found.trajectory().nodal_contacts(found.sample())?;
        let block = found.trajectory().body().parts().next().unwrap().nodes;
        let ([least, most], _, force) = summed(nodal[block].iter());
        Ok([least, most, force / weight])
    };
    let plane = |cells| block([0.0, 9e-5], [0.1, HEIGHT], [6, 4], cells);
    let below = || {
        plate(
            Mesh::rectangle([0.2, 0.01], [6, 2], Cells::Rectangles)
                .unwrap()
                .translated(&[-0.043, -0.01])
                .unwrap(),
        )
        .thickness(0.01)
    };
    let space = |nodes, cells| {
        let mesh = Mesh::cuboid([0.1, 0.1, HEIGHT], nodes, cells).unwrap();
        Body::new(mesh.translated(&[0.0, 0.0, 9e-5]).unwrap(), SOFT)
    };
    let table = || {
        let mesh = Mesh::cuboid([0.2, 0.2, 0.01], [5, 5, 2], SolidCells::Hexahedra).unwrap();
        plate(mesh.translated(&[-0.043, -0.043, -0.01]).unwrap())
    };
    // how far pressures at nodes may be from rho g h, a quarter more than measured
    let cases = [
        ("rectangles", plane(Cells::Rectangles), below(), 1.1e-3),
        ("triangles", plane(Cells::Triangles), below(), 2.5e-2),
        ("triangles6", plane(Cells::Triangles6), below(), 4e-4),
        ("rectangles9", plane(Cells::Rectangles9), below(), 3.6e-4),
        ("hexahedra", space([4, 4, 3], SolidCells::Hexahedra), table(), 3.6e-3),
        ("tetrahedra", space([4, 4, 3], SolidCells::Tetrahedra), table(), 3.7e-2),
        ("tetrahedra10", space([3, 3, 2], SolidCells::Tetrahedra10), table(), 1.1e-2),
        ("hexahedra20", space([3, 3, 2], SolidCells::Hexahedra20), table(), 8.3e-3),
        ("hexahedra27", space([3, 3, 2], SolidCells::Hexahedra27), table(), 8.2e-3),
    ];
    for (name, body, plate, uneven) in cases {
        let [least, most, force] = on_plate(body, plate)?;
        assert!((force - 1.0).abs() < 1e-6, "{name}: {force}");
        let off = f64::max(most / PRESSURE - 1.0, 1.0 - least / PRESSURE);
        println!("{name}: pressures off by {off:.1e}");
        assert!(off < uneven, "{name}: {least} to {most} Pa");
    }
    Ok(())
}

/// On a slope below the angle of friction all of a block sticks, on a steeper one all of it slides, on an obstacle as
/// on a body.
#[test]
fn blocks_stick_or_slide_on_a_slope() -> Outcome {
    const FRICTION: f64 = 0.5;
    for (slope, expected) in [(0.3_f64, ContactStatus::Sticking), (0.7, ContactStatus::Sliding)] {
        let angle = slope.atan();
        let gravity = [GRAVITY * angle.sin(), -GRAVITY * angle.cos()];
        let damped = |body: BodyBuilder| body.material(Material { viscosity: 300.0, ..SOFT });
        let block = |at, size, nodes| damped(block(at, size, nodes, Cells::Rectangles));
        let upper = || block([0.02, 4e-4], [0.05, 0.02], [6, 3]).named("upper");
        let floor =
            Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).stiffness_density(1e7).damping(1e4);
        let on_floor = Scene::new(upper().build()?).obstacle(floor.friction_coefficient(FRICTION));
        let lower = block([0.0, -0.02], [0.1, 0.02], [11, 3]).named("lower");
        let touch = Touch::all().distance(5e-4).damping_density(1e3).friction_coefficient(FRICTION);
        let on_body = Scene::new(Body::join([lower.build()?, upper().build()?])?).touch(touch);
        for (name, scene, phase) in [
            ("floor", on_floor, Phase::until(0.2)),
            ("body", on_body, Phase::until(0.2).hold("lower/bottom")),
        ] {
            let scene = scene.gravity(gravity).phase(phase);
            let motion = scene.simulate(&Settings::default(), &Sampling::phase_ends())?;
            let nodal = motion.nodal_contacts(motion.last())?;
            let statuses: Vec<_> = nodal.iter().map(NodalContact::status).collect();
            let touching = statuses.iter().filter(|status| **status != ContactStatus::Open);
            assert!(touching.clone().count() >= 6, "{name}");
            assert!(
                touching.clone().all(|status| *status == expected),
                "{name} at {slope}: {statuses:?}"
            );
        }
    }
    Ok(())
}
