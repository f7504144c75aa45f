//! Estimates of what the mesh does to an equilibrium against closed forms, much finer meshes, and equilibria on the richer meshes.

use std::ops::RangeInclusive;

use pliant::simulate::{Component, Reading};
use pliant::study::Quantity;
use pliant::{
    Axis, Body, Cells, Chamber, Equilibrium, Error, Material, Mesh, MeshEstimate, Obstacle, Phase,
    Scene, Selection, SolidCells, Statics, Strain, samples,
};

type Outcome = Result<(), Error>;

const SOFT: Material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };

fn solve(scene: &Scene) -> Result<Equilibrium, Error> {
    scene.equilibrium(&Statics::default())
}

fn estimate(scene: &Scene, quantity: &str) -> Result<MeshEstimate, Error> {
    MeshEstimate::of(&solve(scene)?, &Quantity::named(quantity, scene, &[])?)
}

/// The scene on the mesh with which the error is estimated.
fn richer(scene: &Scene) -> Result<Scene, Error> {
    Ok(scene.quadratic().or_else(|_| scene.halved())?)
}

/// Columns of 0.2 m under their own weight between smooth walls: u = -rho g (L y - y^2/2)/(lambda + 2 mu), for a bar with
/// E, the mean of which is -rho g L^2/3 of that. Quadratic cells have it, and halves of linear ones a quarter of the error.
#[test]
fn columns_under_their_own_weight() -> Outcome {
    let plane = |cells| Mesh::rectangle([0.05, 0.2], [3, 5], cells);
    let solid = |cells| Mesh::cuboid([0.05, 0.05, 0.2], [2, 3, 5], cells);
    for (mesh, part) in [
        (Mesh::bar(0.2, 5)?, 0.75),
        (plane(Cells::Triangles)?, 1.0),
        (plane(Cells::Crossed)?, 1.0),
        (plane(Cells::Rectangles)?, 1.0),
        (solid(SolidCells::Tetrahedra)?, 1.0),
        (solid(SolidCells::Hexahedra)?, 1.0),
    ] {
        let (kind, d) = (mesh.kind(), mesh.dimension());
        let body = Body::new(mesh, SOFT).strain(Strain::Cauchy);
        let body = match d {
            1 => body.area(1e-3),
            2 => body.thickness(0.01),
            _ => body,
        };
        let mut gravity = vec![0.0; d];
        gravity[d - 1] = -9.8;
        let hold = Phase::until(1.0).hold(["left", "bottom", "bottom"][d - 1]);
        let phase = match d {
            1 => hold,
            2 => hold.hold_axes("all", [Axis::X]),
            _ => hold.hold_axes("all", [Axis::X, Axis::Y]),
        };
        let scene = Scene::new(body.build()?).gravity(gravity).phase(phase);
        let found = estimate(&scene, ["com.x", "com.y", "com.z"][d - 1])?;
        let across = SOFT.young * (1.0 - 0.3) / (1.0 + 0.3) / (1.0 - 2.0 * 0.3);
        let modulus = if d == 1 { SOFT.young } else { across };
        let truth = 0.1 - 1000.0 * 9.8 * 0.2 * 0.2 / (3.0 * modulus);
        let effectivity = found.correction / (truth - found.value);
        // errors of 1.2 to 1.6 % of the motion; found: 7e-12, round-off
        assert!((effectivity - part).abs() < 1e-10, "{kind:?}: {effectivity}");
        assert!(found.relative() > 0.01, "{kind:?}: {found}");
    }
    Ok(())
}

/// A beam of 10 x 2 x 1 cm, clamped at its left end, with a force of `shear` (N) on the face of its right one, on `n` times 10 x 2
/// grid cells.
fn beam(cells: Cells, n: usize, strain: Strain, shear: f64) -> Result<Scene, Error> {
    let mesh = Mesh::rectangle([0.1, 0.02], [10 * n + 1, 2 * n + 1], cells)?;
    let body = Body::new(mesh, SOFT).thickness(0.01).strain(strain).build()?;
    Ok(Scene::new(body).phase(Phase::until(1.0).hold("left").load_total("right", [0.0, -shear])))
}

/// The same, of 10 x 2 x 2 cm in space.
fn block(cells: SolidCells, n: usize, strain: Strain, shear: f64) -> Result<Scene, Error> {
    let mesh = Mesh::cuboid([0.1, 0.02, 0.02], [5 * n + 1, n + 1, n + 1], cells)?;
    let body = Body::new(mesh, SOFT).strain(strain).build()?;
    let phase = Phase::until(1.0).hold("left").load_total("right", [0.0, -shear, 0.0]);
    Ok(Scene::new(body).phase(phase))
}

/// The estimate over the error, as the finest of the meshes has it, and the same for the equilibrium on the richer mesh.
fn effectivities(scene: &Scene, truth: f64) -> Result<[f64; 2], Error> {
    let (found, next) = (estimate(scene, "com.y")?, solve(&richer(scene)?)?);
    let there = next.trajectory().centre_of_mass(next.sample())[1];
    let error = truth - found.value;
    let [effectivity, of_pair] = [found.correction / error, (there - found.value) / error];
    // found: 0.96 to 1.09, where the remainder is as large as that of beams bent far on coarse meshes or smaller
    let off = effectivity / of_pair - 1.0;
    assert!(!found.is_reliable() || off.abs() < 0.1, "{found}: {effectivity} {of_pair}");
    Ok([effectivity, of_pair])
}

fn assert_within(found: f64, range: &RangeInclusive<f64>, what: &str) {
    assert!(range.contains(&found), "{what}: {found}");
}

/// Bent beams on two meshes each against quadratic triangles on 8 times as many cells along each axis. What the estimate misses are the errors of the
/// richer mesh (the corners that are clamped are singular, so that those of quadratic cells fall slowly) and, under Green's
/// strain, what Newton's first step does: at 0.2 N the tip sinks by half the length, and the coarsest triangles are off by 63 %.
#[test]
fn beams_in_the_plane() -> Outcome {
    use Cells::{Crossed, Rectangles, Triangles, Triangles6};
    // found: 0.93 to 0.99, 0.92 to 1.15, 0.92 to 1.38; quadratic triangles 0.65 to 0.74
    for (strain, shear, first, second) in [
        (Strain::Cauchy, 0.1, 0.92..=1.0, 0.92..=1.0),
        (Strain::Green, 0.1, 0.94..=1.16, 0.92..=1.07),
        (Strain::Green, 0.2, 0.96..=1.4, 0.91..=1.11),
    ] {
        let finest = solve(&beam(Triangles6, 8, strain, shear)?)?;
        let truth = finest.trajectory().centre_of_mass(finest.sample())[1];
        for cells in [Triangles, Crossed, Rectangles, Triangles6] {
            for (n, range) in [(1, &first), (2, &second)] {
                let scene = beam(cells, n, strain, shear)?;
                let [effectivity, of_pair] = effectivities(&scene, truth)?;
                let what = format!("{strain:?}, {shear} N, {cells:?} {n}");
                let range = if cells == Triangles6 { &(0.64..=0.75) } else { range };
                assert_within(effectivity, range, &what);
                match strain {
                    // one linear solve has it all; round-off is 2e-9
                    Strain::Cauchy => assert!((effectivity / of_pair - 1.0).abs() < 1e-7, "{what}"),
                    // found: 0.89 to 0.99 by 8 to 10 factorizations instead of one
                    Strain::Green if cells != Triangles6 => {
                        assert_within(of_pair, &(0.88..=1.0), &what);
                        assert!(solve(&richer(&scene)?)?.factorizations >= 8, "{what}");
                    }
                    Strain::Green => assert_within(of_pair, &(0.66..=0.74), &what),
                }
            }
        }
    }
    Ok(())
}

/// The slides' beam of triangles that lock, bent by 5 cm: on halved cells it sinks by more than half as much again, of which the linear
/// problem sees less than a tenth. It is told.
#[test]
fn an_estimate_that_misses_is_not_reliable() -> Outcome {
    let scene = samples::beam_static(Strain::Green)?;
    let (found, next) = (solve(&scene)?, solve(&scene.halved()?)?);
    let sinks = |found: &Equilibrium| found.displacements()[2 * 21 + 1];
    let estimate = of(&found, &Reading::position([22]).component(Component::Y))?;
    assert!(estimate.correction / (sinks(&next) - sinks(&found)) < 0.1, "{estimate}");
    assert!(!estimate.is_reliable() && estimate.to_string().contains("WARNING"), "{estimate}");
    Ok(())
}

/// Bent beams in space against quadratic tetrahedra: their tetrahedra are off by up to three times the motion.
#[test]
fn beams_in_space() -> Outcome {
    for (strain, shear) in [(Strain::Cauchy, 0.1), (Strain::Green, 0.2)] {
        let finest = solve(&block(SolidCells::Tetrahedra10, 4, strain, shear)?)?;
        let truth = finest.trajectory().centre_of_mass(finest.sample())[1];
        for n in [1, 2] {
            // found: 0.945 to 1.09, and 0.895 to 0.967
            for (cells, range) in
                [(SolidCells::Tetrahedra, 0.93..=1.1), (SolidCells::Hexahedra, 0.88..=0.98)]
            {
                let [effectivity, _] = effectivities(&block(cells, n, strain, shear)?, truth)?;
                println!("{strain:?}, {cells:?} {n}: {effectivity:.3}");
                assert_within(effectivity, &range, &format!("{strain:?}, {cells:?} {n}"));
            }
        }
    }
    Ok(())
}

/// What is read on a mesh, by a name of no meaning.
fn of(found: &Equilibrium, reading: &Reading) -> Result<MeshEstimate, Error> {
    MeshEstimate::of(found, &Quantity::reading("it", reading.clone()))
}

/// In a linear problem, held, moved, and on a plane askew, the correction is what the equilibrium on the richer mesh says. The
/// contributions of the cells add up to it (Galerkin orthogonality) unless more of the edge is moved there: a box from 0.03 to 0.07 has
/// nodes at 0.04 and 0.06 on the first mesh, and those on its sides on the richer one.
#[test]
fn linear_problems_leave_no_remainder() -> Outcome {
    for (cells, from, is_nested) in [
        (Cells::Triangles, 0.036, true),
        (Cells::Rectangles, 0.036, true),
        (Cells::Triangles6, 0.036, true),
        (Cells::Triangles, 0.03, false),
    ] {
        let mesh = Mesh::rectangle([0.1, 0.04], [6, 3], cells)?;
        let body = Body::new(mesh, SOFT).thickness(0.01).strain(Strain::Cauchy).build()?;
        let max = vec![0.1 - from + 1e-9, 0.05];
        let top = Selection::Box { min: vec![from - 1e-9, 0.039], max };
        let scene = Scene::new(body).gravity([0.0, -9.8]).phase(
            Phase::until(1.0)
                .hold("left")
                .symmetry("right", [1.0, 2.0])
                .move_nodes(top.clone(), [0.001, -0.004])
                .load_total("bottom", [0.1, -0.2]),
        );
        let (found, next) = (solve(&scene)?, solve(&richer(&scene)?)?);
        let mut readings = vec![
            Reading::position([6]).component(Component::X),
            Reading::displacement([6, 2]).component(Component::Y),
            Reading::centre_of_mass().component(Component::X),
            Reading::constraint_force("left").component(Component::X),
            Reading::constraint_force("right").component(Component::Y),
        ];
        if is_nested {
            readings.push(Reading::constraint_force(top).component(Component::Y));
        }
        for reading in readings {
            let (coarse, fine) = (of(&found, &reading)?, of(&next, &reading)?);
            let remainder = (fine.value - coarse.value) / coarse.correction - 1.0;
            let sum = coarse.cells.iter().sum::<f64>() / coarse.correction - 1.0;
            // found: 1.5e-11, round-off
            assert!(remainder.abs() < 1e-10, "{cells:?}, {reading:?}: {remainder:.1e}");
            assert!(coarse.remainder.abs() < 1e-9 * coarse.correction.abs(), "{coarse}");
            assert_eq!(sum.abs() < 1e-10, is_nested, "{cells:?}, {reading:?}: {sum:.1e}");
            assert_eq!(coarse.cells.len(), scene.body().mesh().cell_count());
        }
    }
    Ok(())
}

/// Readings that are not linear, of a ring under loads so small that they are: what is left falls with the load.
#[test]
fn derivatives_of_readings() -> Outcome {
    let load = 1e-4;
    let mesh = Mesh::ring(0.02, 0.05, [12, 2], Cells::Rectangles)?;
    let body = Body::new(mesh, SOFT).thickness(0.01).strain(Strain::Cauchy).build()?;
    let phase = Phase::until(1.0).hold([1, 2, 3]).load_total("outer", [load, 2.0 * load]);
    let ring = Scene::new(body)
        .chamber(Chamber::within("hole", "inner"))
        .phase(phase.pressure("hole", 1e3 * load));
    let block = block(SolidCells::Tetrahedra, 1, Strain::Cauchy, 0.01 * load)?;
    for (scene, reading) in [
        (&ring, Reading::position([20]).component(Component::Norm)),
        (&ring, Reading::distance([7, 8], [20])),
        (&ring, Reading::angle([[1], [20]], [[13], [22]])),
        (&ring, Reading::chamber_volume("hole")),
        (&block, Reading::angle([[1], [4]], [[13], [21]])),
    ] {
        let (found, next) = (solve(scene)?, solve(&richer(scene)?)?);
        let (coarse, fine) = (of(&found, &reading)?, of(&next, &reading)?);
        let remainder = (fine.value - coarse.value) / coarse.correction - 1.0;
        // found: 9e-6 at most, and a hundred times that at a hundred times the load
        assert!(remainder.abs() < 2e-5, "{reading:?}: {remainder:.1e}");
    }
    Ok(())
}

/// The hole of a ring of triangles, at next to no load: on the richer mesh parabolas through the circle stand for the sides of the
/// polygon, and each adds 2/3 of its chord times its height.
#[test]
fn polygons_of_rings() -> Outcome {
    let (radius, around, thickness) = (0.03_f64, 16.0, 0.02);
    let mesh = Mesh::ring(radius, 0.036, [16, 2], Cells::Triangles)?;
    let body = Body::new(mesh, SOFT).thickness(thickness).strain(Strain::Cauchy).build()?;
    let scene = Scene::new(body)
        .chamber(Chamber::within("hole", "inner"))
        .phase(Phase::until(1.0).hold([1, 2]).pressure("hole", 1e-4));
    let found = of(&solve(&scene)?, &Reading::chamber_volume("hole"))?;
    let half = std::f64::consts::PI / around;
    let (chord, height) = (2.0 * radius * half.sin(), radius * (1.0 - half.cos()));
    let lacking = around * thickness * 2.0 / 3.0 * chord * height;
    // 2.6 % of the volume; measured: 1e-7 of it
    assert!((found.correction / lacking - 1.0).abs() < 1e-6, "{} {lacking}", found.correction);
    Ok(())
}

#[test]
fn what_cannot_be_estimated_is_told() -> Outcome {
    let scene = beam(Cells::Triangles, 1, Strain::Cauchy, 0.1)?
        .obstacle(Obstacle::half_plane([0.0, -1.0], [0.0, 1.0]).stiffness(10.0));
    let sensors = [
        ("stress", Reading::stress([1]).component(Component::XX)),
        ("floor", Reading::contact_force("floor").component(Component::Y)),
    ];
    let sensors = sensors.map(|(name, reading)| (name.to_owned(), reading));
    for (quantity, part) in [
        ("motion", "name a reading"),
        ("com", "several components"),
        ("com.y:max", "does not move"),
        ("stress", "positions, displacements"),
        ("rotation", "positions, displacements"),
    ] {
        let quantity = Quantity::named(quantity, &scene, &sensors)?;
        let error = MeshEstimate::check(&scene, &quantity).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
        let error = MeshEstimate::of(&solve(&scene)?, &quantity).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    }
    // what is read has no derivative where two nodes are in one place
    let nowhere = Quantity::reading("nowhere", Reading::distance([1], [1]));
    let error = MeshEstimate::of(&solve(&scene)?, &nowhere).unwrap_err().to_string();
    assert!(error.contains("no derivative"), "{error}");
    let mesh = Mesh::rectangle([0.1, 0.1], [3, 3], Cells::Triangles)?;
    let body = Body::new(mesh, SOFT).thickness(0.01).strain(Strain::Cauchy).build()?;
    let phase = Phase::until(1.0).load_total("top", [0.0, 1.0]).load_total("bottom", [0.0, -1.0]);
    let error = estimate(&Scene::new(body).phase(phase), "top.y").unwrap_err().to_string();
    let words =
        "quantity of a mesh estimate = \"top.y\" of a body that nothing holds cannot be used: ";
    assert!(error.starts_with(words), "{error}");
    Ok(())
}
