//! Halves of scenes with fibres, liquids, fluids, magnets and wind against the whole ones.

use pliant::{
    Axis, Body, CellSelection, Cells, Chamber, FibreDirection, Fibres, Fluid, Liquid, Magnet,
    MagneticField, Mesh, Phase, Pipe, Scene, Selection, Signal, SolidCells, Substance, Wind,
};

use super::halves::{RUBBER, agrees, block, hollow, refusal};

/// Two families of fibres that are images of each other and rings around an axis in the plane, in space.
#[test]
fn fibres_act_on_the_half() {
    let course = |turn: f64| FibreDirection::Along(vec![1.0, turn, 0.0]);
    let ring = |x: f64, pitch: f64| FibreDirection::Around {
        centre: vec![x, 0.01, 0.3],
        axis: vec![0.0, 0.0, 1.0],
        pitch,
    };
    let scene = |courses: [FibreDirection; 3]| {
        let mesh = Mesh::cuboid([0.1, 0.04, 0.02], [3, 2, 2], SolidCells::Hexahedra).unwrap();
        let fibres = courses.map(|course| Fibres { course, young: 3e5, stiffening: 1.0 });
        let made_of = fibres.into_iter().fold(Substance::from(RUBBER), Substance::fibres);
        let body = Body::new(mesh, made_of);
        Scene::new(body.build().unwrap())
            .phase(Phase::until(0.005).hold("bottom").load_total("top", [0.0, 0.5, 2.0]))
    };
    agrees(&scene([course(0.5), course(-0.5), ring(0.05, 0.0)]), Axis::X);
    for other in
        [[course(0.5), course(-0.6), ring(0.05, 0.0)], [course(0.5), course(-0.5), ring(0.05, 0.3)]]
    {
        assert!(refusal(&scene(other), Axis::X).contains("material of cell"));
    }
}

/// The nodes at the bottom of a mesh whose last axis is `axis`.
fn bottom(axis: usize) -> Selection {
    let at = |far: f64| (0..=axis).map(|i| if i == axis { 1e-6 } else { far }).collect();
    let mut min: Vec<f64> = at(1.0);
    min.iter_mut().for_each(|x| *x = -*x);
    Selection::Box { min, max: at(1.0) }
}

/// Water in a chamber that the plane cuts and in two that are images of each other, with pipes between them and a syringe.
#[test]
fn liquids_flow_in_the_half() {
    let around = |from: f64, to: f64| Selection::Box {
        min: vec![from - 1e-6, 0.01 - 1e-6],
        max: vec![to + 1e-6, 0.02 + 1e-6],
    };
    let rooms = [(0.01, 0.02), (0.03, 0.05), (0.06, 0.07)];
    let boxes = rooms.map(|(from, to)| [vec![from, 0.01], vec![to, 0.02]]);
    let mesh = Mesh::rectangle([0.08, 0.03], [9, 4], Cells::Rectangles).unwrap();
    let body = Body::new(hollow(&mesh, &boxes), RUBBER).thickness(0.02).build().unwrap();
    let mut scene = Scene::new(body).gravity([0.0, -9.8]).supply("syringe", 101_325.0 + 2e3);
    for (name, (from, to)) in ["left", "middle", "right"].into_iter().zip(rooms) {
        let liquid = Liquid::in_chamber(name).bulk_modulus(1e6);
        scene = scene.chamber(Chamber::within(name, around(from, to))).liquid(liquid);
    }
    let pipe = |name: &str, from: &str, to: &str| {
        Pipe::new(name, from, to, 0.05, 2e-6).viscosity(0.01).loss(1.0)
    };
    let scene = scene
        .pipe(pipe("inlet", "syringe", "middle").viscosity(0.005))
        .pipe(pipe("to left", "middle", "left"))
        .pipe(pipe("to right", "right", "middle"))
        .pipe(pipe("across", "left", "right"));
    let phase = |own: f64| {
        Phase::until(0.02)
            .hold(bottom(1))
            .flow("middle", Signal::ramp(0.0, 2e-6, 0.0, 0.01))
            .flow("left", 1e-6)
            .flow("right", own)
    };
    agrees(&scene.clone().phase(phase(1e-6)), Axis::X);
    let told = refusal(&scene.clone().phase(phase(2e-6)), Axis::X);
    assert!(told.contains("flow into chamber \"left\""), "{told}");
    let other = scene.pipe(pipe("more", "syringe", "left"));
    assert!(refusal(&other.phase(phase(1e-6)), Axis::X).contains("pipe = \"more\""));
}

/// A vessel in space, half full, of which half is half full.
#[test]
fn surfaces_of_liquids_are_level_in_the_half() {
    let room = [vec![0.01; 3], vec![0.03, 0.02, 0.02]];
    let mesh = Mesh::cuboid([0.04, 0.03, 0.03], [5, 4, 4], SolidCells::Hexahedra).unwrap();
    let body = Body::new(hollow(&mesh, std::slice::from_ref(&room)), RUBBER).build().unwrap();
    let wider = |x: &[f64], by: f64| x.iter().map(|x| x + by).collect::<Vec<f64>>();
    let walls = Selection::Box { min: wider(&room[0], -1e-6), max: wider(&room[1], 1e-6) };
    let scene = Scene::new(body)
        .gravity([0.0, 0.0, -9.8])
        .chamber(Chamber::within("bottle", walls))
        .liquid(Liquid::in_chamber("bottle").fill(0.5).density(1e4).surface())
        .phase(Phase::until(0.004).hold(bottom(2)).flow("bottle", 2e-5));
    agrees(&scene, Axis::X);
}

/// A block that floats in a current, and in a wind on two of its sides.
#[test]
fn fluids_and_wind_drag_the_half() {
    let water = |flow: [f64; 2]| {
        Fluid::new(1000.0).drag(1.0, 0.1).added_mass(5.0).level(0.06).velocity(flow)
    };
    let side = |name: &str, node: &str| Fluid::new(800.0).named(name).drag(1.0, 0.0).on(node);
    let scene = |flow: [f64; 2], wind: [f64; 2]| {
        Scene::new(block(|body| body))
            .gravity([0.0, -9.8])
            .fluid(water(flow))
            .fluid(side("left", "left").velocity([1.0, 0.2]))
            .fluid(side("right", "right").velocity([-1.0, 0.2]))
            .device(Wind::new("gust").drag(0.8, 0.1).density(50.0).on("top"))
            .phase(Phase::until(0.05).device_input("gust", &Wind::VELOCITY, wind))
    };
    agrees(&scene([0.0, 0.5], [0.0, -10.0]), Axis::X);
    let told = refusal(&scene([0.1, 0.5], [0.0, -10.0]), Axis::X);
    assert!(told.contains("component = \"fluid 1\""), "{told}");
    let told = refusal(&scene([0.0, 0.5], [1.0, -10.0]), Axis::X);
    assert!(told.contains("device \"gust\" = its velocity"), "{told}");
    let lonely = scene([0.0; 2], [0.0; 2]).device(Wind::new("draught").drag(1.0, 0.0).on("left"));
    assert!(refusal(&lonely, Axis::X).contains("device \"draught\" = on \"left\""));
}

/// Remanences are mirrored as arrows are in a field along the plane, and as moments are in one across it.
#[test]
fn magnets_pull_the_half() {
    let magnet = |b: [f64; 2], from: f64| {
        let cells = CellSelection::inside([from, 0.0], [from + 0.1, 0.1]);
        Magnet::new(b).within(cells)
    };
    let scene = |left: [f64; 2], right: [f64; 2], field: MagneticField| {
        Scene::new(block(|body| body))
            .magnet(magnet(left, 0.0))
            .magnet(magnet(right, 0.1))
            .phase(Phase::until(0.02).hold("bottom").magnetic_field(field))
    };
    let odd = |x: f64| {
        MagneticField::uniform([0.0, 0.004]).gradient([[0.1, 0.0], [0.0, -0.05]], [x, 0.0])
    };
    let across =
        |x: f64| MagneticField::uniform([0.004, 0.0]).gradient([[0.0, 0.1], [0.1, 0.0]], [x, 0.0]);
    agrees(&scene([0.2, 0.3], [-0.2, 0.3], odd(0.1)), Axis::X);
    agrees(&scene([0.2, 0.3], [0.2, -0.3], across(0.1)), Axis::X);
    for (left, right, field, part) in [
        ([0.2, 0.3], [0.2, 0.3], odd(0.1), "remanence of cell = 1"),
        ([0.2, 0.3], [-0.2, 0.3], across(0.1), "magnetic field = of phase"),
        ([0.2, 0.3], [-0.2, 0.3], odd(0.05), "magnetic field = of phase"),
    ] {
        assert!(refusal(&scene(left, right, field), Axis::X).contains(part));
    }
}
