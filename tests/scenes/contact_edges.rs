//! Edges that cross edges, in space.

use std::error::Error;

use pliant::{Body, Material, Mesh, Phase, Sampling, Scene, Settings, SolidCells, Touch};

type Outcome = Result<(), Box<dyn Error>>;

/// A bar of 20 cm with a square section of 2 cm that stands on edge, with its middle at a height of `up` (m): the edges of its
/// cells are parted at 13 and 3 cm from one end. It lies along x, or along z.
fn bar(name: &str, up: f64, is_across: bool) -> Result<Body, pliant::Error> {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
    let mesh = Mesh::cuboid([0.2, 0.02, 0.02], [3, 2, 2], SolidCells::Hexahedra)?;
    let mesh = mesh.mapped(|x| {
        let ([y, z], root) = ([x[1] - 0.01, x[2] - 0.01], f64::sqrt(0.5));
        let (height, across) = (up + root * (y + z), root * (z - y));
        if is_across { [-across, height, x[0] - 0.08] } else { [x[0] - 0.13, height, across] }
    });
    Ok(Body::new(mesh?, soft).named(name).build()?)
}

/// Two bars that meet with their edges, where no node and no middle of an edge or of a face is nearer than 2 cm: the edges
/// come nearer than the contact distance but never to each other, and momentum and energy are kept.
#[test]
fn edges_do_not_pass_through_edges() -> Outcome {
    let (half, distance) = (0.01 * f64::sqrt(2.0), 2e-3);
    let upper = bar("upper", 2.0 * half + 2.0 * distance, true)?;
    let bodies = Body::join([bar("lower", 0.0, false)?, upper])?;
    let nearest = |x: [f64; 3]| {
        let away = |node: usize| {
            let place = bodies.mesh().position(node);
            (0..3).map(|i| (place[i] - x[i]).powi(2)).sum::<f64>()
        };
        (0..bodies.mesh().node_count()).min_by(|&a, &b| away(a).total_cmp(&away(b))).unwrap_or(0)
    };
    let up = half + 2.0 * distance;
    let ends = [[-0.03, half, 0.0], [0.07, half, 0.0], [0.0, up, -0.08], [0.0, up, 0.02]];
    let ends = ends.map(nearest);
    let masses = bodies.nodal_masses();
    let scene = Scene::new(bodies.clone())
        .touch(Touch::all().distance(distance))
        .initial_velocity(move |x| vec![0.0, if x[1] > up - 1e-9 { -1.0 } else { 0.0 }, 0.0])
        .phase(Phase::until(0.03));
    let settings = Settings { rtol: 1e-5, ..Settings::default() };
    let motion = scene.simulate(&settings, &Sampling::every(5e-4))?;
    let mut least = f64::INFINITY;
    let momentum = |v: &[f64]| -> f64 {
        masses.iter().zip(v.chunks_exact(3)).map(|(mass, v)| mass * v[1]).sum()
    };
    let before = momentum(&motion.samples()[0].v);
    assert!((before + 0.08).abs() < 1e-12, "{before}");
    for sample in motion.samples() {
        let x = ends.map(|node| -> [f64; 3] {
            std::array::from_fn(|i| bodies.mesh().position(node)[i] + sample.u[3 * node + i])
        });
        let [a, b, between] = [[0, 1], [2, 3], [0, 2]]
            .map(|[from, to]| -> [f64; 3] { std::array::from_fn(|i| x[to][i] - x[from][i]) });
        let cross = [0, 1, 2].map(|i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            b[j] * a[k] - b[k] * a[j]
        });
        let dot = |a: &[f64; 3], b: &[f64; 3]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        least = least.min(dot(&between, &cross) / dot(&cross, &cross).sqrt());
        assert!((momentum(&sample.v) - before).abs() < 1e-14, "{}", momentum(&sample.v));
    }
    assert!(0.0 < least && least < 0.5 * distance, "{least}");
    let report = motion.report();
    let off = report.energy_error.abs() / report.energy_scale;
    assert!(off < 1e-4, "{off:e}");
    Ok(())
}
