//! Thick shells of rubber under inner pressure: they swell as the integrals over their walls say.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use pliant::mesh::CellKind;
use pliant::{
    Axis, Body, Cells, Dilatation, Law, Material, Mesh, Phase, Scene, SolidCells, Statics, Strain,
    Substance,
};

const SHEAR: f64 = 1e5;

fn rubber() -> Substance {
    let poisson = 0.4995;
    let young = 2.0 * SHEAR * (1.0 + poisson);
    Material { density: 1e3, young, poisson, viscosity: 0.0 }.law(Law::NeoHookean)
}

/// The integral from `from` to `to` by Simpson's rule.
fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let n = 1000;
    let h = (to - from) / n as f64;
    let weight = |k| if k == 0 || k == n { 1.0 } else { f64::from(2 * (k % 2) + 2) };
    (0..=n).map(|k| weight(k) * f(from + h * f64::from(k)) * h / 3.0).sum()
}

/// Inner pressure of an incompressible tube of radii 1 and 2 m, its inner radius `a` (m): the integral over the wall of the hoop
/// stress less the radial one, mu (l^2 - l^-2) with l = r/R, over r.
fn pressure_in_tube(a: f64) -> f64 {
    let grown = a * a - 1.0;
    integral(a, (4.0 + grown).sqrt(), |r| {
        let square = r * r / (r * r - grown);
        SHEAR * (square - 1.0 / square) / r
    })
}

/// The same of a hollow ball: 2 mu (l^2 - l^-4).
fn pressure_in_ball(a: f64) -> f64 {
    let grown = a.powi(3) - 1.0;
    integral(a, (8.0 + grown).cbrt(), |r| {
        let stretch = r / (r.powi(3) - grown).cbrt();
        2.0 * SHEAR * (stretch.powi(2) - stretch.powi(-4)) / r
    })
}

/// Triangles with bubbles, if those of `mesh` are to have a linear dilatation.
fn able(mesh: Mesh, dilatation: Dilatation) -> Mesh {
    let is_simplex = [CellKind::Triangle6, CellKind::Tetrahedron10].contains(&mesh.kind());
    match dilatation {
        Dilatation::Linear if is_simplex => mesh.with_bubbles().unwrap(),
        _ => mesh,
    }
}

/// A quarter of a tube in plane strain: its inner radius (m) under this pressure.
fn radius_of_tube(cells: Cells, nodes: [usize; 2], dilatation: Dilatation, pressure: f64) -> f64 {
    let mesh = Mesh::rectangle([1.0, FRAC_PI_2], nodes, cells).unwrap();
    let mesh = mesh.mapped(|x| [(1.0 + x[0]) * x[1].cos(), (1.0 + x[0]) * x[1].sin()]).unwrap();
    let mesh = able(mesh, dilatation);
    let body = Body::new(mesh, rubber()).thickness(1.0).strain(Strain::Green);
    let body = body.dilatation(dilatation).build().unwrap();
    let phase = Phase::until(1.0)
        .hold_axes("bottom", [Axis::Y])
        .hold_axes("top", [Axis::X])
        .pressure_on("left", pressure);
    let scene = Scene::new(body).phase(phase);
    let rest = scene.equilibrium(&Statics { load_steps: 4, ..Statics::default() }).unwrap();
    1.0 + rest.displacements()[0]
}

/// A 24th of a hollow ball, between planes of symmetry.
fn radius_of_ball(cells: SolidCells, nodes: usize, dilatation: Dilatation, pressure: f64) -> f64 {
    let mesh = Mesh::cuboid([1.0, FRAC_PI_4, FRAC_PI_4], [nodes; 3], cells).unwrap();
    let mesh = mesh.mapped(|x| {
        let (y, z) = (x[1].tan(), x[2].tan());
        let length = (1.0 + x[0]) / (1.0 + y * y + z * z).sqrt();
        [length, length * y, length * z]
    });
    let mesh = able(mesh.unwrap(), dilatation);
    let body = Body::new(mesh, rubber()).dilatation(dilatation).build().unwrap();
    let phase = Phase::until(1.0)
        .symmetry("front", [0.0, 1.0, 0.0])
        .symmetry("back", [1.0, -1.0, 0.0])
        .symmetry("bottom", [0.0, 0.0, 1.0])
        .symmetry("top", [1.0, 0.0, -1.0])
        .pressure_on("left", pressure);
    let scene = Scene::new(body).phase(phase);
    let rest = scene.equilibrium(&Statics { load_steps: 4, ..Statics::default() }).unwrap();
    1.0 + rest.displacements()[0]
}

/// The inner radius grows by a half. The closed form is that of a body without any change of volume: this one has a bulk modulus of 1000
/// shear moduli, and a pressure of the size of one.
#[test]
fn a_tube_swells_as_its_integral_says() {
    let (mean, linear, points) = (Dilatation::Mean, Dilatation::Linear, Dilatation::AtPoints);
    for (cells, nodes, dilatation, most) in [
        (Cells::Rectangles, [9, 13], mean, 1e-3),
        (Cells::Rectangles, [17, 25], mean, 3e-4),
        (Cells::Triangles6, [5, 7], mean, 1e-3),
        (Cells::Triangles6, [9, 13], mean, 5e-4),
        (Cells::Triangles6, [9, 13], points, 3e-4),
        (Cells::Triangles6, [3, 4], linear, 5e-4),
        (Cells::Triangles6, [5, 7], linear, 3.5e-4),
        (Cells::Triangles6, [9, 13], linear, 3e-4),
        (Cells::Rectangles9, [3, 4], linear, 5e-4),
        (Cells::Rectangles9, [5, 7], linear, 3.5e-4),
        (Cells::Rectangles9, [9, 13], linear, 3e-4),
    ] {
        let found = radius_of_tube(cells, nodes, dilatation, pressure_in_tube(1.5));
        println!("{cells:?} {nodes:?} {dilatation:?}: {found}");
        assert!((found / 1.5 - 1.0).abs() < most, "{cells:?} {nodes:?} {dilatation:?}: {found}");
    }
}

/// The inner radius grows by three tenths.
#[test]
fn a_ball_swells_as_its_integral_says() {
    let (mean, linear) = (Dilatation::Mean, Dilatation::Linear);
    for (cells, nodes, dilatation, most) in [
        (SolidCells::Hexahedra, 5, mean, 5e-3),
        (SolidCells::Hexahedra, 7, mean, 2e-3),
        (SolidCells::Hexahedra20, 3, mean, 8e-4),
        (SolidCells::Hexahedra20, 3, linear, 2.5e-4),
        (SolidCells::Hexahedra20, 4, linear, 2e-4),
        (SolidCells::Hexahedra27, 3, linear, 5e-4),
        (SolidCells::Tetrahedra10, 2, linear, 1.4e-2),
        (SolidCells::Tetrahedra10, 3, linear, 4e-3),
    ] {
        let found = radius_of_ball(cells, nodes, dilatation, pressure_in_ball(1.3));
        println!("{cells:?} {nodes:?} {dilatation:?}: {found}");
        assert!((found / 1.3 - 1.0).abs() < most, "{cells:?} {nodes:?} {dilatation:?}: {found}");
    }
}
