//! Finer meshes against those that generators make, and scenes on them.

use pliant::{
    Axis, Body, Cells, Error, Material, Mesh, Obstacle, Phase, Sampling, Scene, Settings,
    SolidCells, Strain, samples,
};

type Outcome = Result<(), Error>;

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };

fn body(mesh: Mesh) -> Result<Body, Error> {
    let is_plane = mesh.kind().dimension() == 2;
    let body = Body::new(mesh, SOFT).strain(Strain::Cauchy);
    Ok(if is_plane { body.thickness(0.01) } else { body }.build()?)
}

/// The lowest frequency (Hz) of a body that is held on its left side.
fn frequency(mesh: Mesh) -> Result<f64, Error> {
    let scene = Scene::new(body(mesh)?).phase(Phase::until(1.0).hold("left"));
    Ok(scene.summary()?[0].spectrum.lowest_frequency.unwrap())
}

/// New nodes of a ring lie where the generator of the finer ring has them, wherever it is and however it is turned.
#[test]
fn rings_are_halved_on_their_circles() -> Outcome {
    let assert_same = |finer: &Mesh, made: &Mesh, what: &str| {
        assert_eq!(finer.node_count(), made.node_count(), "{what}");
        let places =
            |mesh: &Mesh| mesh.positions().chunks(2).map(<[f64]>::to_vec).collect::<Vec<_>>();
        for place in places(made) {
            let off = |other: &Vec<f64>| (place[0] - other[0]).hypot(place[1] - other[1]);
            let nearest = places(finer).iter().map(off).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-15, "{what}: {place:?} {nearest:e}");
        }
    };
    for cells in [Cells::Triangles, Cells::Crossed, Cells::Rectangles, Cells::Triangles6] {
        let what = format!("{cells:?}");
        let [coarse, fine] = [[16, 2], [32, 3]].map(|nodes| Mesh::ring(0.03, 0.036, nodes, cells));
        assert_same(&coarse?.halved(), &fine?, &what);
        let [coarse, fine] =
            [[9, 3], [17, 5]].map(|nodes| Mesh::half_ring(0.03, 0.036, nodes, cells));
        let placed = |mesh: Mesh| mesh.turned(&[0.7])?.translated(&[0.1, -0.2]);
        assert_same(&placed(coarse?)?.halved(), &placed(fine?)?, &what);
    }
    let ring = |cells| Mesh::ring(0.03, 0.036, [16, 2], cells);
    assert_same(&ring(Cells::Triangles)?.quadratic()?, &ring(Cells::Triangles6)?, "mid nodes");
    // cut at their longest edges
    let triangles = ring(Cells::Triangles)?;
    let cut = triangles.halved_in(&(0..triangles.cell_count()).collect::<Vec<_>>())?;
    let radius = |place: &[f64]| place[0].hypot(place[1]);
    let off = |place: &[f64]| (radius(place) - 0.03).abs().min((radius(place) - 0.036).abs());
    for &node in cut.boundary_nodes() {
        assert!(off(cut.position(node)) < 1e-16, "{:?}", cut.position(node));
    }
    // what a map has bent is no ring any more
    let oval = triangles.mapped(|x| [2.0 * x[0], x[1]])?;
    let middle = oval.halved().position(oval.node_count()).to_vec();
    let corners: Vec<&[f64]> = (0..oval.node_count()).map(|node| oval.position(node)).collect();
    let is_between = |a: &[f64], b: &[f64]| {
        (0.5 * (a[0] + b[0]) - middle[0]).hypot(0.5 * (a[1] + b[1]) - middle[1]) < 1e-15
    };
    assert!(corners.iter().any(|a| corners.iter().any(|b| is_between(a, b))));
    Ok(())
}

/// Halved grids are those of half the spacing, and triangles with mid nodes those of 6 nodes.
#[test]
fn finer_meshes_are_those_of_the_generators() -> Outcome {
    let grid = |nodes, cells| Mesh::rectangle([0.2, 0.1], nodes, cells);
    let block = |nodes, cells| Mesh::cuboid([0.2, 0.1, 0.1], nodes, cells);
    for (finer, made) in [
        (grid([4, 3], Cells::Rectangles)?.halved(), grid([7, 5], Cells::Rectangles)?),
        (grid([4, 3], Cells::Triangles)?.halved(), grid([7, 5], Cells::Triangles)?),
        (grid([4, 3], Cells::Triangles6)?.halved(), grid([7, 5], Cells::Triangles6)?),
        (grid([4, 3], Cells::Rectangles9)?.halved(), grid([7, 5], Cells::Rectangles9)?),
        (grid([4, 3], Cells::Triangles)?.quadratic()?, grid([4, 3], Cells::Triangles6)?),
        (
            block([3, 3, 2], SolidCells::Hexahedra)?.halved(),
            block([5, 5, 3], SolidCells::Hexahedra)?,
        ),
        (
            block([3, 3, 2], SolidCells::Tetrahedra)?.quadratic()?,
            block([3, 3, 2], SolidCells::Tetrahedra10)?,
        ),
        (
            block([3, 3, 2], SolidCells::Hexahedra)?.quadratic()?,
            block([3, 3, 2], SolidCells::Hexahedra20)?,
        ),
        (
            grid([4, 3], Cells::Triangles6)?.with_bubbles()?.halved(),
            grid([7, 5], Cells::Triangles)?.with_bubbles()?,
        ),
        (
            block([3, 2, 2], SolidCells::Tetrahedra)?.with_bubbles()?.halved(),
            block([3, 2, 2], SolidCells::Tetrahedra)?.halved().with_bubbles()?,
        ),
        (
            block([3, 2, 2], SolidCells::Hexahedra20)?.halved(),
            block([5, 3, 3], SolidCells::Hexahedra20)?,
        ),
        (
            block([3, 2, 2], SolidCells::Hexahedra27)?.halved(),
            block([5, 3, 3], SolidCells::Hexahedra27)?,
        ),
    ] {
        assert_eq!(
            (finer.node_count(), finer.cell_count()),
            (made.node_count(), made.cell_count())
        );
        let sizes = |mesh: &Mesh| -> Vec<_> {
            mesh.sets().iter().map(|(name, nodes)| (name.clone(), nodes.len())).collect()
        };
        assert_eq!(sizes(&finer), sizes(&made));
        let kind = finer.kind();
        let frequencies = [frequency(finer)?, frequency(made)?];
        // found: 2e-11 to 1.7e-9, which is where the iteration for the lowest vibration ends
        let off = frequencies[0] / frequencies[1] - 1.0;
        assert!(off.abs() < 5e-9, "{kind:?}: {frequencies:?}");
    }
    Ok(())
}

/// Every kind, twice: no cell is turned over, the mass stays, but for that of rings, which is that of finer polygons, or of parabolas over
/// their sides; old nodes stay where they are.
#[test]
fn cells_are_divided_into_cells() -> Outcome {
    let mut meshes = vec![
        Mesh::ring(0.04, 0.05, [12, 2], Cells::Crossed)?,
        Mesh::ring(0.04, 0.05, [12, 2], Cells::Triangles6)?,
        Mesh::ring(0.04, 0.05, [12, 2], Cells::Rectangles)?,
        Mesh::ring(0.04, 0.05, [12, 2], Cells::Rectangles9)?,
    ];
    meshes.push(meshes[1].with_bubbles()?);
    for cells in SolidCells::ALL {
        meshes.push(Mesh::cuboid([0.2, 0.1, 0.1], [3, 2, 2], cells)?);
    }
    meshes.push(Mesh::cuboid([0.2, 0.1, 0.1], [3, 2, 2], SolidCells::Tetrahedra)?.with_bubbles()?);
    for mesh in meshes {
        let mass = body(mesh.clone())?.mass();
        let mut finer = mesh.clone();
        for _ in 0..2 {
            finer = finer.halved();
        }
        assert_eq!(finer.cell_count(), mesh.cell_count() << (2 * mesh.kind().dimension()));
        let area = |around: f64| {
            let half = std::f64::consts::PI / around;
            let over = if mesh.kind().nodes() > 4 {
                4.0 / 3.0 * half.sin() * (1.0 - half.cos())
            } else {
                0.0
            };
            around * (half.sin() * half.cos() + over)
        };
        let grows = if mesh.dimension() == 2 { area(48.0) / area(12.0) } else { 1.0 };
        let off = body(finer.clone())?.mass() / mass / grows - 1.0;
        // sides of quadratic cells are curved: their quadrature sees that a little better when divided (1.3e-5)
        let curved = [6, 7].contains(&mesh.kind().nodes());
        // others are off by the round-off of some 1e4 terms, 4.4e-13 with 27 nodes
        assert!(off.abs() < if curved { 3e-5 } else { 1e-12 }, "{:?}: {off:.1e}", mesh.kind());
        assert_eq!(finer.positions()[..mesh.positions().len()], *mesh.positions());
        // the sets of rings run around: each node is next to the one before
        if let Some(inner) = finer.sets().get("inner") {
            let step = |a: usize, b: usize| {
                let (a, b) = (finer.position(a), finer.position(b));
                (a[0] - b[0]).hypot(a[1] - b[1])
            };
            let longest = inner.windows(2).map(|pair| step(pair[0], pair[1])).fold(0.0, f64::max);
            assert!(longest < 0.04 * std::f64::consts::TAU / 48.0 * 1.01, "{:?}", mesh.kind());
        }
    }
    Ok(())
}

/// A square on finer meshes: what acts on it is the same in all, and the motion goes where that of finer and finer
/// meshes goes.
#[test]
fn scenes_move_to_finer_meshes() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Crossed)?;
    let scene = Scene::new(Body::new(mesh, SOFT).thickness(0.01).build()?)
        .initial_velocity(|x| vec![x[1], 0.0])
        .phase(
            Phase::until(0.2)
                .hold_axes("left", [Axis::X])
                .load([8, 12], [0.0, 0.1])
                .load_total("top", [0.0, -0.3]),
        );
    let settings = Settings { rtol: 1e-8, ..Settings::default() };
    let motion = |scene: &Scene| scene.simulate(&settings, &Sampling::phase_ends());
    let halved = scene.halved()?;
    let scenes = [scene.clone(), halved.clone(), halved.halved()?, scene.quadratic()?];
    let motions = scenes.iter().map(motion).collect::<Result<Vec<_>, _>>()?;
    for motion in &motions {
        // two loads of 0.1 N, and 0.3 N, for 0.2 s; nothing holds it along y
        let momentum = motion.momentum(motion.last());
        assert!((momentum[1] + 0.02).abs() < 1e-9, "{momentum:?}");
    }
    let apart = |a: usize, b: usize| -> f64 {
        let pairs = motions[a].last().u[..32].iter().zip(&motions[b].last().u);
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let (first, second) = (apart(0, 1), apart(1, 2));
    // errors of linear cells are of order 2, less at the corners that are held
    assert!(second < 0.5 * first);
    assert!(apart(3, 2) < 0.5 * apart(0, 2));
    Ok(())
}

/// Stiffness per node is shared out among the nodes of the boundary: 12, then 24, of which the floor meets 4, then 7.
#[test]
fn floors_per_node_are_shared_out() -> Outcome {
    let mesh = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Crossed)?;
    let floor = Obstacle::half_plane([0.0, 0.01], [0.0, 1.0]).stiffness(50.0);
    let scene = Scene::new(Body::new(mesh, SOFT).thickness(0.01).build()?)
        .obstacle(floor)
        .phase(Phase::until(1.0));
    for (scene, nodes) in [(scene.clone(), 4.0), (scene.halved()?, 3.5)] {
        let force = scene.start(&Settings::default())?.view().contact_force("floor")?;
        assert!((force[1] - nodes * 50.0 * 0.01).abs() < 1e-12, "{force:?}");
    }
    Ok(())
}

#[test]
fn what_cannot_be_finer_is_told() -> Outcome {
    let bar = Mesh::bar(1.0, 3)?;
    assert_eq!(bar.halved().sets()["right"], [2]);
    let error = bar.quadratic().unwrap_err().to_string();
    assert!(error.contains("segments"), "{error}");
    let scene = samples::beam_jump()?;
    let error = scene.with_body(|body| body.point_mass("bob", [1.0], 1.0)).unwrap_err();
    assert!(error.to_string().contains("only the mesh"), "{error}");
    Ok(())
}
