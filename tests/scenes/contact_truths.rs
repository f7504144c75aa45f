//! Bodies that touch against the closed forms of Hertz. The example `hertz` has tables.

#[path = "../../examples/hertz/line.rs"]
mod line;
#[path = "../../examples/hertz/sphere.rs"]
mod sphere;

use line::{Hertz, Pressing, Surface};
use pliant::Cells;

const USUAL: Pressing =
    Pressing { cells: Cells::Rectangles, across: 8.0, ratio: 0.77, distance: 0.1, approach: 1.0 };

fn off(found: f64, exact: f64) -> f64 {
    (found / exact - 1.0).abs()
}

/// A parabola on a block with a mesh that does not match: half the width, and the pressures by four readings, within what
/// `limits` say, parts of the closed forms.
fn assert_pressed(pressing: &Pressing, width: f64, limits: [f64; 4]) {
    let found = pressing.pressed().unwrap();
    for lower in [false, true] {
        let surface = Surface::new(found.trajectory(), found.sample(), lower).unwrap();
        let hertz = Hertz::under(surface.presses.iter().sum());
        let of_width = off(surface.half_width(), hertz.half_width);
        let pressures = surface.pressures_off(&hertz);
        println!("lower: {lower}, half the width {of_width}, pressures {pressures:?}");
        assert!(of_width < width, "{of_width}");
        for (pressure, limit) in pressures.into_iter().zip(limits) {
            assert!(pressure < limit, "{pressures:?} {limits:?}");
        }
    }
}

/// With 8 linear cells across half of the contact nodal forces over the lengths that nodes stand for, and the stress in the
/// cells beside the contact, are within 1 % of the largest pressure (found: 0.44 % and 0.9 %), half the width is within 0.5 %
/// (0.36 %). Sums over three nodes smooth what has a corner at the edge (1.8 %); stresses at nodes are extrapolated (5.9 %).
#[test]
fn line_contact_of_linear_cells() {
    assert_pressed(&USUAL, 0.005, [0.005, 0.02, 0.01, 0.065]);
}

/// Quadratic cells load single nodes as their shape functions say, within 1.04 %; three in a row are within 1.5 %, stresses in
/// the cells within 2.1 % and at nodes within 4.1 %, half the width within 0.27 %.
#[test]
fn line_contact_of_quadratic_cells() {
    let pressing = Pressing { cells: Cells::Rectangles9, ..USUAL };
    assert_pressed(&pressing, 0.003, [0.012, 0.017, 0.023, 0.045]);
}

/// A paraboloid on a plate, with 2 cells across the radius of the contact: the force for the way of a point in the body is
/// 14.4 % below that of Hertz, the radius for the force 1.67 % above. The example shows both fall on finer meshes.
#[test]
fn a_sphere_on_a_plate() {
    let found = sphere::pressed(2.0, 0.1, 1.0).unwrap();
    let [force, radius] = [found.force, found.radius].map(|[found, exact]| off(found, exact));
    println!("{} nodes: force {force}, radius {radius}", found.nodes);
    assert!(force < 0.15 && radius < 0.017, "{force} {radius}");
}
