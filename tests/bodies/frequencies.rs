//! Natural frequencies of bars and cantilevers, against closed forms.

use std::f64::consts::PI;

use faer::prelude::Solve;
use faer::{Mat, Side};
use pliant::body::BodyBuilder;
use pliant::{Body, Cells, Material, Mesh, Plane, SolidCells, Strain};

const MATERIAL: Material = Material { density: 1000.0, young: 1e6, poisson: 0.0, viscosity: 0.0 };

/// Natural frequencies (rad/s), ascending, of a body whose node set `left` is held.
fn frequencies(body: BodyBuilder) -> Vec<f64> {
    let body = body.build().unwrap();
    let d = body.dimension();
    let held = &body.mesh().sets()["left"];
    let free: Vec<usize> = (0..body.dofs()).filter(|dof| !held.contains(&(dof / d))).collect();
    let n = free.len();
    let k = Mat::from_fn(n, n, |i, j| body.stiffness().get(free[i], free[j]));
    let m = Mat::from_fn(n, n, |i, j| match free[i] % d == free[j] % d {
        true => body.inertia().get(free[i] / d, free[j] / d),
        false => 0.0,
    });
    // L^-1 K L^-T with M = L L^T
    let l = m.llt(Side::Lower).unwrap();
    let half = l.L().to_owned().partial_piv_lu().solve(&k);
    let whole = l.L().to_owned().partial_piv_lu().solve(half.transpose());
    let symmetric = Mat::from_fn(n, n, |i, j| 0.5 * (whole[(i, j)] + whole[(j, i)]));
    let squares = symmetric.self_adjoint_eigenvalues(Side::Lower).unwrap();
    squares.iter().map(|square| square.sqrt()).collect()
}

/// The discrete bar has a closed form of its own: omega = (c/h) sqrt(6 (1 - cos t)/(2 + cos t)),
/// t = (2k - 1) pi/(2N). It holds to round-off (times the spread of the squares, 500).
#[test]
fn bar_of_segments() {
    let cells = 10;
    let body =
        Body::new(Mesh::bar(0.5, cells + 1).unwrap(), MATERIAL).strain(Strain::Cauchy).area(1e-4);
    let (c, h) = (MATERIAL.wave_speed(), 0.5 / cells as f64);
    for (k, omega) in (1..).zip(frequencies(body)) {
        let t = (2 * k - 1) as f64 * PI / (2 * cells) as f64;
        let exact = c / h * (6.0 * (1.0 - t.cos()) / (2.0 + t.cos())).sqrt();
        assert!((omega / exact - 1.0).abs() < 1e-12, "mode {k}: {omega} {exact}");
    }
}

/// Euler and Bernoulli: omega = (bL)^2 sqrt(E I/(rho A L^4)), bL = 1.875104, 4.694091, 7.854757.
fn slender(mode: usize, length: f64, height: f64) -> f64 {
    let b = [1.875104, 4.694091, 7.854757][mode] / length;
    b * b * (MATERIAL.young * height * height / (12.0 * MATERIAL.density)).sqrt()
}

/// Quadratic triangles and quadrilaterals: the slender limit is approached as (height/length)^2, the shear and
/// rotary inertia that it neglects.
#[test]
fn cantilever_of_flat_quadratic_cells() {
    for cells in [Cells::Triangles6, Cells::Rectangles9] {
        let errors = [(10.0, 21), (20.0, 41), (40.0, 81)].map(|(length, nodes)| {
            let mesh = Mesh::rectangle([length, 1.0], [nodes, 2], cells).unwrap();
            let body = Body::new(mesh, MATERIAL).strain(Strain::Cauchy).thickness(1.0);
            let found = frequencies(body.plane(Plane::Stress));
            [0, 1].map(|mode| 1.0 - found[mode] / slender(mode, length, 1.0))
        });
        println!("{cells} below Euler-Bernoulli, at L/h = 10, 20, 40: {errors:?}");
        for mode in [0, 1] {
            let [short, middle, long] = errors.map(|errors| errors[mode]);
            assert!(short > 0.0 && (short / middle - 4.0).abs() < 1.0, "mode {mode}: {errors:?}");
            assert!((middle / long - 4.0).abs() < 1.0, "mode {mode}: {errors:?}");
        }
    }
}

/// Solid cells: a beam of length 10 and square section 1. The first two modes bend alike, along
/// either axis. Quadratic tetrahedra and hexahedra come within 1 % (of which 0.7 % is shear); the
/// trilinear hexahedra lock in bending and come down as h^2 when their length is halved.
#[test]
fn cantilever_of_solid_cells() {
    let first = |cells, nodes| {
        let mesh = Mesh::cuboid([10.0, 1.0, 1.0], nodes, cells).unwrap();
        let found = frequencies(Body::new(mesh, MATERIAL).strain(Strain::Cauchy));
        assert!((found[0] / found[1] - 1.0).abs() < 0.01, "{found:?}");
        found[0] / slender(0, 10.0, 1.0) - 1.0
    };
    let tetrahedra = first(SolidCells::Tetrahedra10, [11, 2, 2]);
    let [quadratic, triquadratic] =
        [SolidCells::Hexahedra20, SolidCells::Hexahedra27].map(|cells| first(cells, [11, 2, 2]));
    let hexahedra = [6, 11, 21].map(|nodes| first(SolidCells::Hexahedra, [nodes, 2, 2]));
    println!(
        "above Euler-Bernoulli: tetrahedra10 {tetrahedra:.4}, hexahedra20 {quadratic:.4}, hexahedra27 \
         {triquadratic:.4}, hexahedra {hexahedra:.4?}"
    );
    for found in [tetrahedra, quadratic, triquadratic] {
        assert!(found.abs() < 0.01, "{found}");
    }
    let [coarse, middle, fine] = hexahedra;
    assert!(coarse > 0.3 && middle < coarse / 2.5 && fine < middle / 2.5, "{hexahedra:?}");
}
