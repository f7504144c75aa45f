//! Direct computation of Green forces against printed numbers and against the sum over cells.

use pliant::force::NodalForces;
use pliant::{Body, CellSelection, Cells, Lame, Material, Mesh, Plane, Strain};

use self::green_polynomial::GreenPolynomial;

#[path = "../../examples/green_polynomial/polynomial.rs"]
mod green_polynomial;

const RUBBER: Material = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };

/// Of one material and thickness 1.
fn polynomial(mesh: &Mesh, material: Material) -> GreenPolynomial {
    GreenPolynomial::new(mesh, 1.0, &vec![material.elastic(); mesh.cell_count()])
}

/// Fig. 2.2: six nodes, four right isosceles triangles with legs of 1 m.
fn six_nodes() -> Mesh {
    Mesh::rectangle([2.0, 1.0], [3, 2], Cells::Triangles).unwrap()
}

#[test]
fn suffixes_as_printed() {
    let polynomial = polynomial(&six_nodes(), RUBBER);
    let pairs = polynomial.quadratic_suffixes();
    let triples = polynomial.cubic_suffixes();
    // n_p + 2 n_e and n_p + 6 n_e + 6 n_t of 6 nodes, 9 edges, 4 triangles
    assert_eq!((pairs.len(), triples.len()), (24, 84));
    let of_pairs = |k: usize| pairs.iter().map(|pair| pair[k]).collect::<Vec<_>>();
    let (c2i, c2j) = (of_pairs(0), of_pairs(1));
    assert_eq!((&c2i[..8], c2i[23]), ([1, 1, 1, 2, 2, 2, 2, 2].as_slice(), 6));
    assert_eq!((&c2j[..8], c2j[23]), ([1, 2, 4, 1, 2, 3, 4, 5].as_slice(), 6));
    let of_triples = |k: usize| triples.iter().map(|triple| triple[k]).collect::<Vec<_>>();
    let (c3i, c3j, c3k) = (of_triples(0), of_triples(1), of_triples(2));
    assert_eq!((&c3i[..10], c3i[83]), ([1, 1, 1, 1, 1, 1, 1, 1, 1, 2].as_slice(), 6));
    assert_eq!((&c3j[..10], c3j[83]), ([1, 1, 1, 2, 2, 2, 4, 4, 4, 1].as_slice(), 6));
    assert_eq!(&c3k[..12], [1, 2, 4, 1, 2, 4, 1, 2, 4, 1, 2, 4]);
    assert!(pairs.is_sorted() && triples.is_sorted());
    // no triangle has nodes 1 and 3, none nodes 1, 2 and 5
    assert!(!pairs.contains(&[1, 3]) && !triples.contains(&[1, 2, 5]));
}

/// The printed 3 x 9 matrix C^{1,lambda}_{2;1,1}: that of legs 10, a thousandth of that of legs 1.
#[test]
fn coefficients_as_printed() {
    #[rustfmt::skip]
    let printed = [
        [-6, 3, 3, 5, -3, -2, 1, 0, -1],
        [4, -3, -1, -3, 3, 0, -1, 0, 1],
        [2, 0, -2, -2, 0, 2, 0, 0, 0],
    ];
    for (leg, factor) in [(10.0, 1.0 / 2000.0), (1.0, 0.5)] {
        // the first triangle alone: P_1, P_2, P_4, here nodes 1, 2, 3
        let a11 = |material: Material| {
            let positions = vec![0.0, 0.0, leg, 0.0, 0.0, leg];
            let mesh = Mesh::new(2, positions, pliant::mesh::CellKind::Triangle, vec![0, 1, 2]);
            polynomial(&mesh.unwrap(), material).quadratic_matrix(0)
        };
        // nu = 0: lambda = 0, mu = E/2; nu = 1/4: lambda = mu = 0.4 E
        let of_mu = a11(Material { young: 2.0, poisson: 0.0, ..RUBBER });
        let of_both = a11(Material { young: 2.5, poisson: 0.25, ..RUBBER });
        let volume = 0.5 * leg * leg;
        for i in 0..3 {
            for j in 0..9 {
                let found = (of_both[(i, j)] - of_mu[(i, j)]) / volume;
                let expected = factor * f64::from(printed[i][j]);
                // differences of numbers of that size: round-off
                assert!((found - expected).abs() < 1e-14 * factor * 10.0, "({i}, {j}) {found}");
            }
        }
    }
}

/// The columns to which the first triangle contributes: 1, 2, 3, 4, 5, 7, 13, 14 and 15. Row 1 has
/// no others, as only that triangle has node 1.
#[test]
fn columns_as_printed() {
    let polynomial = polynomial(&six_nodes(), RUBBER);
    let a12 = polynomial.quadratic_matrix(1);
    let columns: Vec<usize> = (0..24).filter(|&j| a12[(0, j)] != 0.0).map(|j| j + 1).collect();
    assert!(columns.iter().all(|j| [1, 2, 3, 4, 5, 7, 13, 14, 15].contains(j)), "{columns:?}");
    let pairs = polynomial.quadratic_suffixes();
    let of_first = [1, 2, 3, 4, 5, 7, 13, 14, 15].map(|column| pairs[column - 1]);
    let expected = [1, 2, 4].map(|i| [1, 2, 4].map(|j| [i, j])).concat();
    assert_eq!(of_first.as_slice(), expected);
    // C in its first three columns is that of u1 u1 u1, u1 u1 u2, u1 u1 u4
    let c = polynomial.cubic_matrix();
    assert_eq!((c.nrows(), c.ncols()), (6, 84));
    assert!((0..3).all(|j| c[(0, j)] != 0.0));
}

/// Numbers between -`size` and `size` without a pattern.
fn noise(length: usize, size: f64, seed: usize) -> Vec<f64> {
    (0..length)
        .map(|i| size * (12.9898 * (i + 1000 * seed) as f64).sin().mul_add(43.758, 0.3).sin())
        .collect()
}

fn meshes() -> Vec<(Mesh, f64)> {
    let grid = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles).unwrap();
    let shifted = grid.positions().iter().zip(noise(32, 0.02, 77)).map(|(x, by)| x + by);
    let connectivity = grid.cells().flatten().copied().collect();
    let irregular = Mesh::new(2, shifted.collect(), grid.kind(), connectivity).unwrap();
    let strip = Mesh::rectangle([0.1, 0.02], [21, 5], Cells::Triangles).unwrap();
    vec![(grid, 0.1), (irregular, 0.06), (strip, 0.005), (six_nodes(), 1.0)]
}

#[test]
fn forces_are_those_of_the_sum_over_cells() {
    for (mesh, cell) in meshes() {
        for (plane, with_point) in [(Plane::Strain, false), (Plane::Stress, true)] {
            let stiff = Material { young: 7e6, poisson: 0.3, ..RUBBER };
            let mut body = Body::new(mesh.clone(), RUBBER)
                .thickness(0.01)
                .strain(Strain::Green)
                .plane(plane)
                .region(CellSelection::Numbers(vec![2, 3]), stiff);
            if with_point {
                body = body.point_mass("hub", [9.0, 9.0], 1.0);
            }
            let body = body.build().unwrap();
            let pair = |cell: usize| {
                let Lame { lambda, mu } =
                    if matches!(cell, 1 | 2) { stiff } else { RUBBER }.elastic();
                match plane {
                    Plane::Stress => Lame { lambda: 2.0 * lambda * mu / (lambda + 2.0 * mu), mu },
                    _ => Lame { lambda, mu },
                }
            };
            let lame: Vec<Lame> = (0..body.mesh().cell_count()).map(pair).collect();
            let mut polynomial = GreenPolynomial::new(body.mesh(), 0.01, &lame);
            for seed in 0..10 {
                let u = noise(body.dofs(), 0.15 * cell, seed);
                let mut sum = NodalForces::zeros(body.dofs());
                body.add_elastic_forces(&u, &mut sum).unwrap();
                let mut forces = vec![f64::NAN; body.dofs()];
                polynomial.forces(&u, &mut forces);
                let largest = sum.conservative.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
                for (found, expected) in forces.iter().zip(sum.conservative.iter()) {
                    // round-off of the largest force
                    assert!((found - expected).abs() < 1e-13 * largest, "{found} {expected}");
                }
            }
        }
    }
}
