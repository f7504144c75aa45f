//! h. Poisson's ratio near 1/2.

use pliant::Cells;

use crate::gallery::locking::{condition, converged, deflection, grid};

#[test]
fn linear_triangles_and_rectangles_lock_and_others_do_not() {
    let nodes = [20, 4];
    let part = |cells, poisson| {
        deflection(cells, grid(cells, nodes), poisson).unwrap() / converged(poisson).unwrap()
    };
    for (cells, range) in [
        (Cells::Triangles, 0.0..0.1),
        (Cells::Rectangles, 0.0..0.1),
        (Cells::Crossed, 0.8..1.0),
        (Cells::Triangles6, 0.9..1.0),
    ] {
        let part = part(cells, 0.4999);
        assert!(range.contains(&part), "{cells:?}: {part}");
    }
    assert!(part(Cells::Rectangles, 0.45) > part(Cells::Triangles, 0.45) + 0.1);
}

/// The converged deflection lies near that of Timoshenko's beam in plane strain: E/(1 - nu^2) for E,
/// and shear with the factor 5/6.
#[test]
fn the_converged_mesh_is_right() {
    let (poisson, load, length): (f64, f64, f64) = (0.48, 0.01, 0.1);
    let (young, shear) = (1e5 / (1.0 - poisson * poisson), 1e5 / (2.0 * (1.0 + poisson)));
    let (area, moment) = (0.02 * 0.01, 0.01 * 0.02_f64.powi(3) / 12.0);
    let bending = load * length.powi(3) / (3.0 * young * moment);
    let exact = bending + load * length / (5.0 / 6.0 * shear * area);
    let part = converged(poisson).unwrap() / exact;
    // the clamped end may not warp or contract, which the beam's theory lets it
    assert!((0.96..1.01).contains(&part), "{part}");
}

#[test]
fn condition_grows_with_the_first_lame_parameter() {
    let grow = |cells| {
        let at = |poisson| condition(cells, grid(cells, [20, 4]), poisson).unwrap();
        at(0.4999) / at(0.499)
    };
    // lambda grows tenfold
    assert!((grow(Cells::Triangles6) - 10.0).abs() < 0.5);
    assert!((grow(Cells::Crossed) - 10.0).abs() < 0.5);
}
