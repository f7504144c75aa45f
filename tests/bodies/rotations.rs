//! How far cells have turned: bodies that are stretched and then turned rigidly, by a known angle.

use pliant::mesh::CellKind;
use pliant::{Body, Cells, Material, Mesh, SolidCells, Strain};

const SOFT: Material = Material { density: 1000.0, young: 5e4, poisson: 0.3, viscosity: 0.0 };
/// Of length 1, along no axis.
const AXIS: [f64; 3] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];
const ANGLES: [f64; 6] = [0.0, 1e-5, 0.3, 1.7, 3.0, -2.0];

/// Rodrigues' formula: x turned about AXIS.
fn turned(x: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let [a, b, c] = AXIS;
    let across = [b * x[2] - c * x[1], c * x[0] - a * x[2], a * x[1] - b * x[0]];
    let along = (1.0 - cos) * (a * x[0] + b * x[1] + c * x[2]);
    std::array::from_fn(|i| cos * x[i] + sin * across[i] + along * AXIS[i])
}

fn displacements(mesh: &Mesh, map: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let moved = |x: &[f64]| map(x).iter().zip(x).map(|(y, x)| y - x).collect::<Vec<_>>();
    mesh.positions().chunks(mesh.dimension()).flat_map(moved).collect()
}

#[track_caller]
fn assert_all(body: &Body, u: &[f64], expected: f64) {
    let angles = body.cell_rotations(u);
    assert_eq!(angles.len(), body.mesh().cell_count());
    for angle in angles {
        // sines of angles near pi and cosines of those near 0 lose half their digits in strings alone
        let tolerance = if body.mesh().kind() == CellKind::Segment { 3e-8 } else { 1e-13 };
        assert!((angle - expected.abs()).abs() < tolerance, "{body:?}: {angle}, not {expected}");
    }
}

#[test]
fn in_the_plane() {
    for cells in [Cells::Triangles, Cells::Triangles6, Cells::Rectangles, Cells::Rectangles9] {
        let mesh = Mesh::rectangle([0.2, 0.1], [3, 3], cells).unwrap();
        let body =
            Body::new(mesh.clone(), SOFT).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
        for angle in ANGLES {
            let (sin, cos) = f64::sin_cos(angle);
            // stretched, sheared by a symmetric map, turned
            let u = displacements(&mesh, |x| {
                let y = [1.3 * x[0] + 0.2 * x[1], 0.2 * x[0] + 0.8 * x[1]];
                vec![cos * y[0] - sin * y[1], sin * y[0] + cos * y[1]]
            });
            assert_all(&body, &u, angle);
        }
    }
}

#[test]
fn in_space() {
    for cells in SolidCells::ALL {
        let mesh = Mesh::cuboid([0.2, 0.1, 0.1], [2, 2, 2], cells).unwrap();
        let body = Body::new(mesh.clone(), SOFT).strain(Strain::Cauchy).build().unwrap();
        for angle in ANGLES {
            let u = displacements(&mesh, |x| {
                let y = [1.3 * x[0] + 0.2 * x[1], 0.2 * x[0] + 0.8 * x[1], 1.1 * x[2]];
                turned(y, angle).to_vec()
            });
            assert_all(&body, &u, angle);
        }
    }
}

#[test]
fn of_lower_dimension() {
    for cells in [Cells::Triangles, Cells::Rectangles] {
        let flat = Mesh::rectangle([0.2, 0.1], [3, 3], cells).unwrap();
        let mesh = flat.mapped(|x| [x[0], x[1], 0.0]).unwrap();
        let body =
            Body::new(mesh.clone(), SOFT).strain(Strain::Cauchy).thickness(0.01).build().unwrap();
        for angle in ANGLES {
            let u = displacements(&mesh, |x| turned([1.3 * x[0], 0.9 * x[1], 0.0], angle).to_vec());
            assert_all(&body, &u, angle);
        }
    }
    // on a line nothing turns
    let bar = Body::new(Mesh::bar(0.1, 2).unwrap(), SOFT)
        .strain(Strain::Cauchy)
        .area(1e-4)
        .build()
        .unwrap();
    assert_eq!(bar.cell_rotations(&[0.0, -0.3]), [0.0]);
    // a string tells the angle between its tangents: e_x and R e_x
    let string = Mesh::bar(0.1, 4).unwrap().mapped(|x| [x[0], 0.0, 0.0]).unwrap();
    let body = Body::new(string.clone(), SOFT).strain(Strain::Cauchy).area(1e-4).build().unwrap();
    for angle in ANGLES {
        let u = displacements(&string, |x| turned([1.3 * x[0], 0.0, 0.0], angle).to_vec());
        assert_all(&body, &u, turned([1.0, 0.0, 0.0], angle)[0].clamp(-1.0, 1.0).acos());
    }
}

/// A block that is stretched along its axes and turned has these stretches, by Green's strain; and the pressure is a third of the trace
/// of the stress, which is that of St. Venant and Kirchhoff: S = lambda tr(E) + 2 mu E, sigma = F S F^T / J.
#[test]
fn stretches_and_pressure_of_a_turned_block() {
    let stretches = [1.5, 1.1, 0.8];
    let mesh = Mesh::cuboid([1.0, 1.0, 1.0], [2, 2, 2], SolidCells::Hexahedra).unwrap();
    let map = |x: &[f64]| turned([0, 1, 2].map(|i| stretches[i] * x[i]), 1.7).to_vec();
    let u = displacements(&mesh, map);
    let body = Body::new(mesh, SOFT).strain(Strain::Green).build().unwrap();
    let field = body.cell_fields(&u)[0];
    let found = field.stretches(Strain::Green);
    let apart = found.iter().zip(stretches).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-14, "{found:?}");
    let (lambda, mu) = (5e4 * 0.3 / (1.3 * 0.4), 5e4 / 2.6);
    let green = stretches.map(|l: f64| 0.5 * (l * l - 1.0));
    let trace: f64 = green.iter().sum();
    let normal = |(e, l): (f64, f64)| l * l * (lambda * trace + 2.0 * mu * e);
    let pressure = -green.into_iter().zip(stretches).map(normal).sum::<f64>()
        / (3.0 * stretches.iter().product::<f64>());
    assert!((field.pressure() / pressure - 1.0).abs() < 1e-12, "{} {pressure}", field.pressure());
}
