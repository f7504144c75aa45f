//! Green forces by direct computation against the sum over cells, mesh by mesh.

use divan::Bencher;
use divan::counter::ItemsCount;
use pliant::force::NodalForces;
use pliant::samples::SQUARE_MATERIAL;
use pliant::{Body, Cells, Mesh, Strain};

use self::green_polynomial::GreenPolynomial;

#[path = "../examples/green_polynomial/polynomial.rs"]
#[expect(dead_code, reason = "the bench needs no matrices as dense ones")]
mod green_polynomial;

fn main() {
    divan::main();
}

/// Nodes along a side of the square: 2 (n - 1)^2 triangles.
const NODES: [usize; 6] = [4, 10, 32, 100, 316, 708];

fn body(nodes: usize) -> Body {
    let mesh = Mesh::rectangle([0.3, 0.3], [nodes, nodes], Cells::Triangles).unwrap();
    Body::new(mesh, SQUARE_MATERIAL).thickness(0.01).strain(Strain::Green).build().unwrap()
}

/// A shear with some waves, far from turning cells inside out.
fn displacements(body: &Body) -> Vec<f64> {
    let shear = |x: &[f64]| [0.2 * x[1], 0.01 * (20.0 * x[0]).sin()];
    body.mesh().positions().chunks(2).flat_map(shear).collect()
}

fn polynomial(body: &Body) -> GreenPolynomial {
    let lame = vec![body.material().elastic(); body.mesh().cell_count()];
    GreenPolynomial::new(body.mesh(), 0.01, &lame)
}

fn triangles(nodes: usize) -> ItemsCount {
    ItemsCount::new(2 * (nodes - 1).pow(2))
}

#[divan::bench(args = NODES)]
fn sum_over_cells(bencher: Bencher, nodes: usize) {
    let body = body(nodes);
    let (u, mut forces) = (displacements(&body), NodalForces::zeros(body.dofs()));
    bencher.counter(triangles(nodes)).bench_local(|| {
        forces.conservative.fill(0.0);
        body.add_elastic_forces(&u, &mut forces).unwrap();
    });
}

#[divan::bench(args = NODES)]
fn direct_computation(bencher: Bencher, nodes: usize) {
    let body = body(nodes);
    let (u, mut forces) = (displacements(&body), vec![0.0; body.dofs()]);
    let mut polynomial = polynomial(&body);
    bencher.counter(triangles(nodes)).bench_local(|| polynomial.forces(&u, &mut forces));
}

/// Setup cost of direct computation.
#[divan::bench(args = NODES, sample_count = 3)]
fn coefficient_matrices(bencher: Bencher, nodes: usize) {
    let body = body(nodes);
    bencher.counter(triangles(nodes)).bench_local(|| polynomial(&body));
}
