//! Growth by direction and active stretch against closed forms: what is free is without stress, a sector of a ring whose arcs grow, a whole ring, bars that pull,
//! what is pressed in plane strain, and the balance of energy.

use crate::common::run;
use pliant::{
    Axis, Body, CellSelection, Cells, Dilatation, Equilibrium, Error, Growth, Law, Material, Mesh,
    Method, Phase, Plane, Scene, Settings, Signal, SolidCells, Statics, body::BodyBuilder,
};

const YOUNG: f64 = 1e5; // Pa

fn material(poisson: f64) -> Material {
    Material { density: 1000.0, young: YOUNG, poisson, viscosity: 0.0 }
}

fn rubber(poisson: f64) -> pliant::Substance {
    material(poisson).law(Law::NeoHookean)
}

fn rectangle(size: [f64; 2], nodes: [usize; 2], cells: Cells) -> Mesh {
    Mesh::rectangle(size, nodes, cells).unwrap()
}

/// The phase in which nodes at 0 along an axis stay there, and those at the `end` of the first axis, if it is given.
fn on_planes(body: &Body, phase: Phase, end: Option<f64>) -> Phase {
    let axes = [Axis::X, Axis::Y, Axis::Z].into_iter().take(body.dimension());
    axes.fold(phase, |phase, axis| {
        let is_held = |node: &usize| {
            let x = body.mesh().position(*node)[axis.index()];
            x == 0.0 || axis == Axis::X && end == Some(x)
        };
        let nodes = (0..body.mesh().node_count()).filter(is_held).map(|node| node + 1);
        phase.hold_axes(nodes.collect::<Vec<usize>>(), [axis])
    })
}

/// The equilibrium of a body all of which grows by a `strain`, between planes of symmetry.
fn grown(body: Body, growth: Growth, strain: f64, end: Option<f64>) -> Equilibrium {
    let phase = on_planes(&body, Phase::until(1.0).actuate(["g"], strain), end);
    let scene = Scene::new(body).growth(growth.named("g")).phase(phase);
    scene.equilibrium(&Statics::default()).unwrap()
}

/// Largest difference between two vectors.
fn apart(a: impl IntoIterator<Item = f64>, b: impl IntoIterator<Item = f64>) -> f64 {
    a.into_iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// What is free grows by 0.2 along, and by what is told across, without stress: bars, plane stress, plane strain, membranes and solids. Strains are
/// those of the growth, those across the plane included.
#[test]
fn free_growth_has_no_stress() {
    let square = || rectangle([0.1, 0.1], [3, 3], Cells::Rectangles);
    let skin = || square().mapped(|x| [x[0], x[1], 0.0]).unwrap();
    let solid = |cells| Mesh::cuboid([0.1; 3], [3, 3, 3], cells).unwrap();
    let stress = |body: BodyBuilder| body.thickness(0.01).plane(Plane::Stress);
    let x = |d: usize| Growth::everywhere().along([&[2.0, 0.0, 0.0][..d]].concat());
    let keeping = 1.2_f64.powf(-0.5) - 1.0;
    let cases = [
        (Body::new(Mesh::bar(0.1, 3).unwrap(), material(0.45)).area(1e-4), x(1), 0.0),
        (stress(Body::new(square(), material(0.45))), x(2), 0.0),
        (stress(Body::new(square(), rubber(0.45))), x(2).keeping_volume(), keeping),
        (stress(Body::new(skin(), material(0.3))), x(3).across(0.5), 0.1),
        (Body::new(square(), material(0.3)).thickness(0.01), x(2), 0.0),
        (Body::new(solid(SolidCells::Tetrahedra10), material(0.3)), x(3).across(-0.5), -0.1),
        (
            Body::new(solid(SolidCells::Hexahedra), rubber(0.49)).dilatation(Dilatation::Mean),
            x(3).keeping_volume(),
            keeping,
        ),
    ];
    for (number, (body, growth, across)) in cases.into_iter().enumerate() {
        let body = body.build().unwrap();
        let (d, places) = (body.dimension(), body.mesh().positions().to_vec());
        let is_flat = body.mesh().kind().dimension() == 2 && number == 4;
        let equilibrium = grown(body, growth, 0.2, None);
        let (motion, sample) = (equilibrium.trajectory(), equilibrium.sample());
        let by = |i: usize| if i.is_multiple_of(d) { 0.2 } else { across };
        let expected = places.iter().enumerate().map(|(i, x)| by(i) * x);
        let moved = apart(sample.u.clone(), expected) / 0.1;
        let of_cells = motion.cell_fields(sample).unwrap().into_iter();
        let of_cells = of_cells.map(|field| (field.strain, field.stress));
        let of_nodes = motion.nodal_fields(sample).unwrap().into_iter();
        let of_nodes = of_nodes.map(|field| (field.strain, field.stress));
        let green = |e: f64| e + 0.5 * e * e;
        let out = if is_flat { 0.0 } else { green(across) };
        let (mut strain, mut stress) = (0.0_f64, 0.0_f64);
        for (found, left) in of_cells.chain(of_nodes) {
            let expected = [green(0.2), 0.0, 0.0, 0.0, green(across), 0.0, 0.0, 0.0, out];
            strain = strain.max(apart(found.concat(), expected));
            stress = stress.max(apart(left.concat(), [0.0; 9]) / YOUNG);
        }
        println!("{number}: {moved:.1e} apart, strain {strain:.1e}, stress {stress:.1e} of young");
        assert!(moved < 1e-13 && strain < 1e-13 && stress < 1e-12, "{number}: {strain} {stress}");
    }
}

/// A sector of a ring with the radii 0.02 m and 0.03 m from angle 0 to `angle` (rad), and the radius and the angle of each node.
fn sector(angle: f64, nodes: [usize; 2]) -> (Mesh, Vec<[f64; 2]>) {
    let grid = rectangle([1.0, 1.0], nodes, Cells::Rectangles9);
    let polar = |x: &[f64]| [0.02 + 0.01 * x[0], angle * x[1]];
    let places = (0..grid.node_count()).map(|node| polar(grid.position(node))).collect();
    let curved = |x: &[f64]| {
        let [radius, turn] = polar(x);
        [radius * turn.cos(), radius * turn.sin()]
    };
    (grid.mapped(curved).unwrap(), places)
}

/// Numbers of the nodes at an angle.
fn at_angle(polar: &[[f64; 2]], angle: f64) -> Vec<usize> {
    let nodes = polar.iter().enumerate().filter(|(_, polar)| polar[1] == angle);
    nodes.map(|(node, _)| node + 1).collect()
}

/// Half a ring, clamped at one end, whose arcs get 1.3 times as long, turns to 234 degrees without stress: each point by 0.3 of its angle, at its radius.
/// Twice as many cells are nearer to this by 2^3 and more.
#[test]
fn arcs_that_grow_close() {
    let half = std::f64::consts::PI;
    let off = [[5, 17], [9, 33]].map(|nodes| {
        let (mesh, polar) = sector(half, nodes);
        let body = Body::new(mesh, rubber(0.4)).thickness(0.01).plane(Plane::Stress);
        let scene = Scene::new(body.build().unwrap())
            .growth(Growth::everywhere().around([0.0, 0.0], []).named("g"))
            .phase(Phase::until(1.0).hold(at_angle(&polar, 0.0)).actuate(["g"], 0.3));
        let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
        let (motion, sample) = (equilibrium.trajectory(), equilibrium.sample());
        let places = scene.body().mesh().positions().iter().zip(&sample.u).map(|(x, u)| x + u);
        let turned = polar.iter().flat_map(|[r, turn]| {
            let turn = 1.3 * turn;
            [r * turn.cos(), r * turn.sin()]
        });
        let off = apart(places, turned) / 0.03;
        let fields = motion.cell_fields(sample).unwrap();
        let stress = fields.iter().map(|field| field.von_mises() / YOUNG).fold(0.0, f64::max);
        println!("{off:.1e} of the radius apart, stress {stress:.1e} of young");
        [off, stress]
    });
    assert!(off[1][0] < 2e-4 && off[1][0] < off[0][0] / 8.0 && off[1][1] < 1e-4, "{off:?}");
}

/// A whole ring whose arcs grow by e cannot follow: with u'' + u'/r - u/r^2 = -(1 - nu) e/r in plane stress, u = A r + B/r - c r ln r with c = (1 - nu) e/2,
/// without s_r = E/(1 - nu^2) (u' + nu u/r - nu e) at its radii. Strains of 1e-5 change this by as much.
#[test]
fn a_ring_whose_arcs_grow_is_strained() {
    let ([a, b], nu, e) = ([0.02_f64, 0.03_f64], 0.3, 1e-5);
    let quarter = std::f64::consts::FRAC_PI_2;
    let (mesh, polar) = sector(quarter, [9, 17]);
    let body = Body::new(mesh, material(nu)).thickness(0.01).plane(Plane::Stress).build().unwrap();
    let ends = [(0.0, Axis::Y), (quarter, Axis::X)];
    let phase = Phase::until(1.0).actuate(["g"], e);
    let phase = ends
        .into_iter()
        .fold(phase, |phase, (angle, axis)| phase.hold_axes(at_angle(&polar, angle), [axis]));
    let scene = Scene::new(body)
        .growth(Growth::everywhere().around([0.0, 0.0], []).named("g"))
        .phase(phase);
    let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
    let c = 0.5 * (1.0 - nu) * e;
    // (1 + nu) A - (1 - nu) B/r^2 = this at both radii
    let fixed = |r: f64| c * ((1.0 + nu) * r.ln() + 1.0) + nu * e;
    let of_inverse = (fixed(b) - fixed(a)) / ((1.0 - nu) * (1.0 / (a * a) - 1.0 / (b * b)));
    let of_radius = (fixed(a) + (1.0 - nu) * of_inverse / (a * a)) / (1.0 + nu);
    let u = &equilibrium.trajectory().last().u;
    for (node, [r, angle]) in polar.iter().enumerate() {
        let found = u[2 * node] * angle.cos() + u[2 * node + 1] * angle.sin();
        let expected = of_radius * r + of_inverse / r - c * r * r.ln();
        let off = found / expected - 1.0;
        assert!(off.abs() < 5e-5, "{r} {angle}: {found} {expected}, off by {off:e}");
    }
}

/// A bar of nearly incompressible neo-Hookean rubber that shortens by a third and keeps its volume, under a pull: with the stretch l of what is left,
/// mu (l - 1/l^2) / g per undeformed section.
#[test]
fn an_active_bar_pulls() {
    let (area, g, load): (f64, f64, f64) = (1e-4, 2.0 / 3.0, 3.0);
    let body = Body::new(Mesh::bar(0.1, 4).unwrap(), rubber(0.499_999)).area(area);
    let phase = Phase::until(1.0).hold([1]).load([4], [load]).actuate(["g"], g - 1.0);
    let scene = Scene::new(body.build().unwrap())
        .growth(Growth::everywhere().along([1.0]).keeping_volume().named("g"))
        .phase(phase);
    let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
    let length = 0.1 + equilibrium.trajectory().last().u[3];
    let left = length / 0.1 / g;
    let pull = area * YOUNG / 3.0 * (left - left.powi(-2)) / g;
    println!("{left} times as long as it is then, by {pull} N, off by {:.1e}", pull / load - 1.0);
    assert!(left > 1.2 && (pull / load - 1.0).abs() < 1e-5, "{pull}");
    // its section is as much smaller as it is longer
    let fields = equilibrium.trajectory().cell_fields(equilibrium.sample()).unwrap();
    let [stress, strain] = [fields[0].stress, fields[0].strain].map(|tensor| tensor[0][0]);
    let (expected, long) = (load / area * length / 0.1, length / 0.1);
    assert!((stress / expected - 1.0).abs() < 1e-5, "{stress} {expected}");
    println!("strain off by {:.1e}", strain - 0.5 * (long * long - 1.0));
    assert!((strain - 0.5 * (long * long - 1.0)).abs() < 1e-8, "{strain}");
    let thick = (1.0 + 2.0 * fields[0].strain[1][1]) * long;
    assert!((thick - 1.0).abs() < 1e-5, "{thick}");
}

/// What grows by g in plane strain is pressed across the plane, by E_e = (1/g^2 - 1)/2 there. Where it is free in the plane, St. Venant and Kirchhoff's material has
/// E_e = -nu times that in it, the true stress E E_e (1/g) / (1 + 2 E_e in the plane) across it, and its size by g times the root of the latter.
#[test]
fn growth_in_plane_strain_is_pressed() {
    let (nu, g) = (0.3, 1.2);
    let across = 0.5 * (1.0 / (g * g) - 1.0);
    let square = 1.0 - 2.0 * nu * across;
    for (cells, dilatation) in [
        (Cells::Triangles6, Dilatation::AtPoints),
        (Cells::Rectangles9, Dilatation::Linear),
        (Cells::Rectangles, Dilatation::Mean),
    ] {
        let body = Body::new(rectangle([0.1, 0.05], [3, 3], cells), material(nu));
        let body = body.dilatation(dilatation).thickness(0.01).build().unwrap();
        let places = body.mesh().positions().to_vec();
        let equilibrium = grown(body, Growth::everywhere(), g - 1.0, None);
        let (motion, sample) = (equilibrium.trajectory(), equilibrium.sample());
        let moved = apart(sample.u.clone(), places.iter().map(|x| (g * square.sqrt() - 1.0) * x));
        let field = motion.cell_fields(sample).unwrap()[0];
        let [strain, stress] = [field.strain[2][2], field.stress[2][2]];
        let expected = YOUNG * across / (g * square);
        let energy = g.powi(3) * 0.5 * YOUNG * across * across;
        println!("{moved:.1e} m, {strain:.1e}, {stress} Pa, expected {expected}");
        assert!(moved < 3e-15 && strain.abs() < 1e-15, "{moved} {strain}");
        assert!((stress / expected - 1.0).abs() < 1e-12, "{stress} {expected}");
        assert!((field.energy_density / energy - 1.0).abs() < 1e-12, "{}", field.energy_density);
    }
}

/// Held at its ends and free to its side, what grows by a small e in plane strain presses by E e/(1 - nu), and by E e/(1 - nu^2) if it grows along the
/// held direction alone. Strains of 1e-6 change this by some of them.
#[test]
fn growth_held_in_plane_strain() {
    let (nu, e) = (0.3, 1e-6);
    let along = Growth::everywhere().along([1.0, 0.0]);
    for (growth, expected) in
        [(Growth::everywhere(), 1.0 / (1.0 - nu)), (along, 1.0 / (1.0 - nu * nu))]
    {
        let mesh = rectangle([0.1, 0.05], [3, 3], Cells::Rectangles);
        let body = Body::new(mesh, material(nu)).thickness(0.01).build().unwrap();
        let equilibrium = grown(body, growth, e, Some(0.1));
        let fields = equilibrium.trajectory().cell_fields(equilibrium.sample()).unwrap();
        let stress = -fields[0].stress[0][0] / (YOUNG * e);
        println!("{stress} E e, expected {expected}");
        assert!((stress / expected - 1.0).abs() < 1e-5, "{stress} {expected}");
    }
}

/// Plane strain is that of a slab of one cell that is held across: half of a beam of rubber grows, alike in all directions, or around an axis across the plane, and
/// both bend alike.
#[test]
fn plane_strain_is_that_of_a_held_slab() {
    let (nodes, strain) = ([11, 5], 0.05);
    let lower = [0.1, 0.005];
    let law = || material(0.45).law(Law::MooneyRivlin { second: 0.3 });
    let flat = Body::new(rectangle([0.1, 0.01], nodes, Cells::Rectangles), law());
    let flat = flat.dilatation(Dilatation::Mean).thickness(0.01).build().unwrap();
    let thick = Mesh::cuboid([0.1, 0.01, 0.01], [11, 5, 2], SolidCells::Hexahedra).unwrap();
    let slab = Body::new(thick, law()).dilatation(Dilatation::Mean).build().unwrap();
    let tip = |body: &Body, growth: Growth| {
        let mesh = body.mesh();
        let find = |is: &dyn Fn(&[f64]) -> bool| -> Vec<usize> {
            (0..mesh.node_count()).filter(|node| is(mesh.position(*node))).collect()
        };
        let numbers = |nodes: Vec<usize>| nodes.iter().map(|node| node + 1).collect::<Vec<_>>();
        let mut phase =
            Phase::until(1.0).actuate(["g"], strain).hold(numbers(find(&|x| x[0] == 0.0)));
        if body.dimension() == 3 {
            phase = phase.hold_axes(numbers(find(&|_| true)), [Axis::Z]);
        }
        let scene = Scene::new(body.clone()).growth(growth.named("g")).phase(phase);
        let equilibrium = scene.equilibrium(&Statics::default()).unwrap();
        let node = find(&|x| x[0] == 0.1 && x[1] == 0.01)[0];
        let first = node * body.dimension();
        let fields = equilibrium.trajectory().cell_fields(equilibrium.sample()).unwrap();
        let across = fields[0].stress[2][2] / YOUNG;
        [
            equilibrium.trajectory().last().u[first],
            equilibrium.trajectory().last().u[first + 1],
            across,
        ]
    };
    let within =
        |corner: &[f64]| Growth::within(CellSelection::inside(vec![0.0; corner.len()], corner));
    let (plane, space) = (within(&lower), within(&[0.1, 0.005, 0.01]));
    let axis = [0.0, 0.0, 1.0];
    let pairs = [
        [plane.clone(), space.clone()],
        [
            plane.around([0.05, 0.2], []).across(0.4),
            space.around([0.05, 0.2, 0.0], axis).across(0.4),
        ],
    ];
    for [in_plane, in_space] in pairs {
        let (a, b) = (tip(&flat, in_plane), tip(&slab, in_space));
        println!("{a:?} and {b:?}");
        assert!(a[1] > 0.01 && apart(a, b) < 1e-9, "{a:?} {b:?}");
    }
}

/// While an annulus in plane strain that is held inside grows and shrinks around its axis, keeping its volume, and swells and shrinks, no energy is created.
#[test]
fn energy_is_balanced() {
    let mesh = Mesh::ring(0.02, 0.04, [16, 3], Cells::Rectangles).unwrap();
    let soft = Material { viscosity: 50.0, ..material(0.45) }.law(Law::NeoHookean);
    let body = Body::new(mesh, soft).dilatation(Dilatation::Mean).thickness(0.01).build().unwrap();
    let inner = || Growth::within(CellSelection::Numbers((1..=16).collect())).named("inner");
    for growth in [inner(), inner().around([0.0, 0.0], []).keeping_volume()] {
        let scene = Scene::new(body.clone())
            .growth(growth)
            .phase(
                Phase::until(0.015)
                    .hold("inner")
                    .actuate(["inner"], Signal::formula("0.15*sin(200*t)").unwrap()),
            )
            .phase(Phase::until(0.025).hold("inner").actuate(["inner"], -0.05));
        for method in [Method::CvodeBdf, Method::Arkode, Method::Rk, Method::Rosenbrock] {
            // of cells that grow nothing damps waves of pressure
            let settings = Settings { method, rtol: 1e-8, ..Settings::default() };
            let report = run(&scene, &settings, &[]).report().clone();
            let off = report.energy_error / report.energy_scale;
            println!("{method}: {off:.1e} of {} J", report.energy_scale);
            assert!(report.energy_scale > 1e-5 && off < 2e-7, "{method}: {off:e}");
        }
    }
}

#[test]
fn growth_by_direction_that_cannot_be() {
    let body = || {
        let mesh = rectangle([0.02, 0.02], [3, 3], Cells::Rectangles);
        Body::new(mesh, material(0.3)).thickness(0.01).build().unwrap()
    };
    let refused = |growth: Growth, strain: f64, parts: &[&str]| {
        let phase = Phase::until(0.1).actuate(["g"], strain);
        let scene = Scene::new(body()).growth(growth.named("g")).phase(phase);
        let error: Error = scene.validate().unwrap_err().into();
        assert!(parts.iter().all(|part| error.to_string().contains(part)), "{error}");
    };
    let all = Growth::everywhere;
    refused(all().across(0.5), 0.1, &["growth \"g\" across = 0.5", "along or centre"]);
    refused(all().keeping_volume(), 0.1, &["growth \"g\" keeps_volume", "along or centre"]);
    refused(all().along([1.0, 0.0]).across(f64::NAN), 0.1, &["growth \"g\" across = NaN"]);
    refused(all().along([0.0, 0.0]), 0.1, &["along = [0.0, 0.0]", "length above 0"]);
    refused(all().along([1.0]), 0.1, &["along = [1.0]", "2 numbers"]);
    refused(all().around([0.0, 0.0], []).pitch(0.1), 0.1, &["pitch = 0.1"]);
    let shrinks = all().along([1.0, 0.0]).across(4.0);
    refused(shrinks, -0.3, &["is -0.3 at t = 0 s, and -1.2 across", "above -1"]);
}
