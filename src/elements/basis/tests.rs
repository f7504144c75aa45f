//! Every cell by the same checks: shape functions, derivatives, rules.

use super::*;
use crate::elements::mesh::CellKind;

/// Polynomials that a quadrature rule of a cell integrates exactly.
#[derive(Clone, Copy)]
enum Exact {
    /// Polynomials of this degree over the simplex.
    Simplex(usize),
    /// Polynomials of this degree in each coordinate over the unit cube.
    Cube(usize),
    /// Polynomials of this degree over the unit cube.
    WholeCube(usize),
}

#[test]
fn segment() {
    check::<Segment, 2, 1>(CellKind::Segment, [Exact::Cube(1), Exact::Cube(3)]);
}

/// A face only, which is no kind of cell.
#[test]
fn segment3() {
    for (a, x) in Segment3::NODES.into_iter().enumerate() {
        let one_at_its_node = std::array::from_fn(|b| if a == b { 1.0 } else { 0.0 });
        assert_eq!(Segment3::values(x), one_at_its_node);
    }
    [0.2, 0.5, 0.31].into_iter().for_each(|x| shapes_at::<Segment3, 3, 1>([x]));
    rule_is_exact(Segment3::STIFFNESS_RULE, Exact::Cube(3));
    rule_is_exact(Segment3::MASS_RULE, Exact::Cube(5));
}

#[test]
fn triangle() {
    check::<Triangle, 3, 2>(CellKind::Triangle, [Exact::Simplex(1), Exact::Simplex(2)]);
}

#[test]
fn triangle6() {
    check::<Triangle6, 6, 2>(CellKind::Triangle6, [Exact::Simplex(2), Exact::Simplex(4)]);
}

#[test]
fn triangle7() {
    check::<Triangle7, 7, 2>(CellKind::Triangle7, [Exact::Simplex(4), Exact::Simplex(6)]);
}

#[test]
fn quadrilateral() {
    check::<Quadrilateral, 4, 2>(CellKind::Quadrilateral, [Exact::Cube(3); 2]);
}

#[test]
fn quadrilateral9() {
    check::<Quadrilateral9, 9, 2>(CellKind::Quadrilateral9, [Exact::Cube(5); 2]);
}

#[test]
fn tetrahedron() {
    check::<Tetrahedron, 4, 3>(CellKind::Tetrahedron, [Exact::Simplex(1), Exact::Simplex(2)]);
}

#[test]
fn tetrahedron10() {
    check::<Tetrahedron10, 10, 3>(CellKind::Tetrahedron10, [Exact::Simplex(2), Exact::Simplex(5)]);
}

#[test]
fn tetrahedron15() {
    check::<Tetrahedron15, 15, 3>(CellKind::Tetrahedron15, [Exact::Simplex(5), Exact::Simplex(6)]);
}

#[test]
fn hexahedron() {
    check::<Hexahedron, 8, 3>(CellKind::Hexahedron, [Exact::Cube(3); 2]);
}

#[test]
fn hexahedron20() {
    let exact = [Exact::WholeCube(5), Exact::Cube(5)];
    check::<Hexahedron20, 20, 3>(CellKind::Hexahedron20, exact);
}

#[test]
fn hexahedron27() {
    check::<Hexahedron27, 27, 3>(CellKind::Hexahedron27, [Exact::Cube(5); 2]);
}

/// A face only, which is no kind of cell.
#[test]
fn quadrilateral8() {
    for (a, x) in Quadrilateral8::NODES.into_iter().enumerate() {
        let one_at_its_node = std::array::from_fn(|b| if a == b { 1.0 } else { 0.0 });
        assert_eq!(Quadrilateral8::values(x), one_at_its_node);
    }
    [[0.2, 0.5], [0.31, 0.9]].into_iter().for_each(shapes_at::<Quadrilateral8, 8, 2>);
    rule_is_exact(Quadrilateral8::STIFFNESS_RULE, Exact::Cube(3));
    rule_is_exact(Quadrilateral8::MASS_RULE, Exact::Cube(5));
}

/// The motion of a hexahedron of 20 nodes whose strain is 0 at Gauss's points, two along each axis, but not
/// at the points of its own rule: u = (x (3 y^2 - 1), -y (3 x^2 - 1), 0) (1 + z), in coordinates from -1
/// to 1.
#[test]
fn hexahedron20_needs_more_than_8_points() {
    let u = Hexahedron20::NODES.map(|node| {
        let [x, y, z] = node.map(|x| 2.0 * x - 1.0);
        [x * (3.0 * y * y - 1.0) * (1.0 + z), -y * (3.0 * x * x - 1.0) * (1.0 + z), 0.0]
    });
    let largest = |rule: &[([f64; 3], f64)]| {
        let mut largest = 0.0_f64;
        for (xi, _) in rule {
            let slopes = Hexahedron20::derivatives(*xi);
            let slope = |i: usize, j: usize| -> f64 {
                u.iter().zip(&slopes).map(|(u, slopes)| u[i] * slopes[j]).sum()
            };
            for (i, j) in (0..9).map(|k| (k % 3, k / 3)) {
                largest = largest.max((slope(i, j) + slope(j, i)).abs());
            }
        }
        largest
    };
    assert!(largest(Hexahedron::STIFFNESS_RULE) < 1e-14);
    assert!(largest(Hexahedron20::STIFFNESS_RULE) > 1.0);
}

/// Number of motions of a reference cell without energy at the points of a rule, beside the rigid ones.
fn free_motions<C: ReferenceCell<N, M>, const N: usize, const M: usize>(
    rule: &[([f64; M], f64)],
) -> usize {
    let n = N * M;
    let mut stiffness = faer::Mat::<f64>::zeros(n, n);
    for (xi, weight) in rule {
        let slopes = C::derivatives(*xi);
        for (row, column) in (0..n).flat_map(|row| (0..n).map(move |column| (row, column))) {
            let (a, i, b, j) = (row / M, row % M, column / M, column % M);
            // of the energy sum e_ij^2
            let along: f64 = slopes[a].iter().zip(&slopes[b]).map(|(a, b)| a * b).sum();
            let same = if i == j { along } else { 0.0 };
            stiffness[(row, column)] += weight * (same + slopes[a][j] * slopes[b][i]);
        }
    }
    let energies = stiffness.self_adjoint_eigenvalues(faer::Side::Lower).unwrap();
    let most = energies.iter().fold(0.0, |most: f64, energy| most.max(*energy));
    energies.iter().filter(|energy| **energy < 1e-9 * most).count() - M * (M + 1) / 2
}

/// Biquadratic cells and those with bubbles need their rules: with fewer points there are motions without energy.
#[test]
fn free_motions_of_cells_with_nodes_in_their_middle() {
    let flat = free_motions::<Triangle7, 7, 2>;
    assert_eq!(flat(Triangle7::STIFFNESS_RULE), 0);
    assert_eq!(flat(Triangle6::STIFFNESS_RULE), 2);
    let solid = free_motions::<Tetrahedron15, 15, 3>;
    assert_eq!(solid(Tetrahedron15::STIFFNESS_RULE), 0);
    assert!(solid(Tetrahedron10::STIFFNESS_RULE) > 3);
    let flat = free_motions::<Quadrilateral9, 9, 2>;
    assert_eq!(flat(Quadrilateral9::STIFFNESS_RULE), 0);
    assert_eq!(flat(Quadrilateral::STIFFNESS_RULE), 3);
    let solid = free_motions::<Hexahedron27, 27, 3>;
    assert_eq!(solid(Hexahedron27::STIFFNESS_RULE), 0);
    assert_eq!(solid(Hexahedron20::STIFFNESS_RULE), 3);
}

fn check<C: ReferenceCell<N, M>, const N: usize, const M: usize>(
    kind: CellKind,
    [stiffness, mass]: [Exact; 2],
) {
    assert_eq!((kind.nodes(), kind.dimension()), (N, M));
    functions_are_one_at_their_node::<C, N, M>(kind, stiffness);
    for xi in [[0.2, 0.3, 0.4], [0.5, 0.1, 0.05], [0.31, 0.44, 0.17]] {
        shapes_at::<C, N, M>(std::array::from_fn(|i| xi[i]));
    }
    rule_is_exact(C::STIFFNESS_RULE, stiffness);
    rule_is_exact(C::MASS_RULE, mass);
}

/// Positions of the nodes in the reference cell: corners, then the middles of the edges, of faces and of the cell.
fn reference_nodes<const M: usize>(kind: CellKind, shape: Exact) -> Vec<[f64; M]> {
    let unit = |axis: usize| std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 });
    let mut nodes: Vec<[f64; M]> = match shape {
        Exact::Simplex(_) => [[0.0; M]].into_iter().chain((0..M).map(unit)).collect(),
        Exact::Cube(_) | Exact::WholeCube(_) => {
            let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let corner = |k: usize| {
                let [x, y] = square[k % 4];
                std::array::from_fn(|i| [x, y, (k / 4) as f64][i])
            };
            (0..1 << M).map(corner).collect()
        }
    };
    for edge in kind.edges() {
        if let [a, b, middle] = **edge {
            assert_eq!(middle, nodes.len(), "mid nodes stand in the order of the edges");
            nodes.push(std::array::from_fn(|i| (nodes[a][i] + nodes[b][i]) / 2.0));
        }
    }
    for ends in kind.middles() {
        let sum = |i: usize| ends.iter().map(|&end| nodes[end][i]).sum::<f64>();
        nodes.push(std::array::from_fn(|i| sum(i) / ends.len() as f64));
    }
    nodes
}

fn functions_are_one_at_their_node<C: ReferenceCell<N, M>, const N: usize, const M: usize>(
    kind: CellKind,
    shape: Exact,
) {
    let nodes = reference_nodes::<M>(kind, shape);
    assert_eq!(nodes, C::NODES);
    for (a, &node) in nodes.iter().enumerate() {
        for (b, value) in C::values(node).into_iter().enumerate() {
            let exact = if a == b { 1.0 } else { 0.0 };
            // thirds are rounded
            let limit = if node.contains(&(1.0 / 3.0)) { 1e-14 } else { 0.0 };
            assert!((value - exact).abs() <= limit, "N_{b} at node {a}: {value}");
        }
    }
}

fn shapes_at<C: ReferenceCell<N, M>, const N: usize, const M: usize>(xi: [f64; M]) {
    let total: f64 = C::values(xi).iter().sum();
    assert!((total - 1.0).abs() < 1e-14, "partition of unity: {total}");
    let step = 1e-5;
    for axis in 0..M {
        let shifted = |by: f64| {
            let mut xi = xi;
            xi[axis] += by;
            C::values(xi)
        };
        let (ahead, behind) = (shifted(step), shifted(-step));
        for (a, derivative) in C::derivatives(xi).iter().enumerate() {
            // central differences of quadratics are exact but for round-off; bubbles have third derivatives of some 300
            let difference = (ahead[a] - behind[a]) / (2.0 * step);
            let error = (derivative[axis] - difference).abs();
            assert!(
                error < if N == 7 || N == 15 { 1e-8 } else { 1e-10 },
                "dN_{a}/dxi_{axis} at {xi:?}: {error:e}"
            );
        }
    }
}

fn rule_is_exact<const M: usize>(rule: &[([f64; M], f64)], exact: Exact) {
    assert!(rule.iter().all(|(_, weight)| *weight > 0.0));
    let degree = match exact {
        Exact::Simplex(degree) | Exact::Cube(degree) | Exact::WholeCube(degree) => degree,
    };
    let mut beyond = 0.0_f64;
    for index in 0..(degree + 2).pow(M as u32) {
        let powers: [usize; M] =
            std::array::from_fn(|i| index / (degree + 2).pow(i as u32) % (degree + 2));
        let total: usize = powers.iter().sum();
        let (integral, degree_of) = match exact {
            Exact::Simplex(_) => {
                // a! b! c! / (a + b + c + M)!
                let product: f64 = powers.iter().map(|&k| factorial(k)).product();
                (product / factorial(total + M), total)
            }
            Exact::Cube(_) => (over_cube(powers), powers.into_iter().fold(0, usize::max)),
            Exact::WholeCube(_) => (over_cube(powers), total),
        };
        let monomial = |xi: &[f64; M]| -> f64 {
            xi.iter().zip(powers).map(|(x, k)| x.powi(k as i32)).product()
        };
        let sum: f64 = rule.iter().map(|(xi, weight)| weight * monomial(xi)).sum();
        let error = (sum - integral).abs();
        if degree_of <= degree {
            assert!(error < 1e-15, "powers {powers:?}: {sum} instead of {integral}");
        } else {
            beyond = beyond.max(error);
        }
    }
    assert!(beyond > 1e-6, "the rule is exact beyond degree {degree}");
}

/// The integral of a monomial over the unit cube.
fn over_cube<const M: usize>(powers: [usize; M]) -> f64 {
    powers.iter().map(|&k| 1.0 / (k + 1) as f64).product()
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}
