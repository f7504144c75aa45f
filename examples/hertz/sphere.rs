//! A quarter of an elastic block whose lower side is a paraboloid, pressed on a plate that is held.

use std::f64::consts::PI;

use pliant::{Axis, Body, Error, Material, Mesh, Phase, Scene, SolidCells, Statics, Strain, Touch};

use super::line::{ABOUT, HEIGHT, RADIUS, graded, graded_end};

/// Side of the block (m).
const SIZE: f64 = 8.0 * ABOUT;
const SOFT: Material = Material { density: 1000.0, young: 1e6, poisson: 0.3, viscosity: 0.0 };
/// E* of one soft side.
const E_STAR: f64 = SOFT.young / (1.0 - SOFT.poisson * SOFT.poisson);

/// Results of a pressing, beside those of Hertz for the same approach.
pub struct Found {
    pub nodes: usize,
    /// Radius of the contact (m) by the second moment of the pressure, and that of Hertz for the force found.
    pub radius: [f64; 2],
    /// Force (N) of the whole, and that of Hertz for the way of a point within the block.
    pub force: [f64; 2],
}

/// Presses with cells of `ABOUT/across` beside the contact, a contact distance of `distance` times `HEIGHT`, and an
/// approach of `part` times that which makes the contact about `ABOUT` wide.
pub fn pressed(across: f64, distance: f64, part: f64) -> Result<Found, Error> {
    let (wide, high) = (1.5 * ABOUT, 0.5 * ABOUT);
    let [ex, ez] = [wide, high].map(|first| graded_end(SIZE, first));
    let side = ABOUT / across;
    let [columns, layers] = [ex * wide, ez * high].map(|length| (length / side).round() as usize);
    let gap = distance * HEIGHT;
    let mesh =
        Mesh::cuboid([ex, ex, ez], [columns + 1, columns + 1, layers + 1], SolidCells::Hexahedra)?
            .mapped(|s| {
                let ([x, y], z) = ([s[0], s[1]].map(|s| graded(s, wide)), graded(s[2], high));
                let bottom = (x * x + y * y) / (2.0 * RADIUS);
                [x, y, gap + z + bottom * (1.0 - z / SIZE)]
            })?;
    let upper = Body::new(mesh, SOFT).strain(Strain::Cauchy).named("upper").build()?;
    let plate = Mesh::cuboid([3.0 * SIZE, 3.0 * SIZE, SIZE], [2, 2, 2], SolidCells::Hexahedra)?
        .translated(&[-SIZE, -SIZE, -SIZE])?;
    let plate = Body::new(plate, SOFT).strain(Strain::Cauchy).named("plate").build()?;
    let approach = part * 2.0 * HEIGHT * (1.0 - 0.5 * ABOUT / SIZE);
    let scene = Scene::new(Body::join([plate, upper])?)
        .touch(Touch::between(["plate", "upper"]).distance(gap))
        .phase(
            Phase::until(1.0)
                .hold("plate")
                .hold_axes("upper/left", [Axis::X])
                .hold_axes("upper/front", [Axis::Y])
                .move_axis("upper/top", Axis::Z, -approach),
        );
    let found = scene.equilibrium(&Statics { rtol: 1e-8, ..Statics::default() })?;
    let (motion, sample) = (found.trajectory(), found.sample());
    let mesh = motion.body().mesh();
    let forces = motion.contact_forces(sample)?;
    let (mut force, mut moment) = (0.0, 0.0);
    for node in mesh.select(&"upper".into())? {
        let x = mesh.position(node);
        force += 4.0 * forces[3 * node + 2];
        moment += 4.0 * forces[3 * node + 2] * (x[0] * x[0] + x[1] * x[1]);
    }
    // the way of a point on the axis, as a block that is held at its top is stiffer than one without end
    let is_on_axis = |node: &usize| mesh.position(*node)[..2] == [0.0, 0.0];
    let deep = |node: &usize| (mesh.position(*node)[2] - 2.0 * ABOUT).abs();
    let nodes = mesh.select(&"upper".into())?;
    let axis = nodes.iter().copied().filter(is_on_axis);
    let node = axis.min_by(|a, b| deep(a).total_cmp(&deep(b))).unwrap_or(nodes[0]);
    let (depth, way) = (mesh.position(node)[2] - gap, -sample.u[3 * node + 2]);
    let radius = radius_for(way, depth);
    Ok(Found {
        nodes: mesh.node_count(),
        radius: [(2.5 * moment / force).sqrt(), (0.75 * force * RADIUS / E_STAR).cbrt()],
        force: [force, 4.0 * E_STAR * radius.powi(3) / (3.0 * RADIUS)],
    })
}

/// The radius (m) of Hertz's contact in which a point `depth` (m) below the surface has come nearer by `way` (m).
fn radius_for(way: f64, depth: f64) -> f64 {
    let (mut least, mut most) = (0.0, 10.0 * ABOUT);
    for _ in 0..60 {
        let a = 0.5 * (least + most);
        if a * a / RADIUS - sinking(a, depth) < way { least = a } else { most = a }
    }
    0.5 * (least + most)
}

/// How far (m) Hertz's pressure p0 sqrt(1 - r^2/a^2) moves a point on the axis, `depth` (m) below the surface: Boussinesq's
/// solution for a force on a point, in the sum over the contact.
fn sinking(a: f64, depth: f64) -> f64 {
    const RINGS: usize = 2000;
    let peak = 2.0 * a * E_STAR / (PI * RADIUS);
    let ring = |k: usize| {
        // r = a sin t, p = p0 cos t
        let t = 0.5 * PI * (k as f64 + 0.5) / RINGS as f64;
        let r = a * t.sin();
        let far = r.hypot(depth);
        let by_force = 2.0 * (1.0 - SOFT.poisson) / far + depth * depth / far.powi(3);
        peak * t.cos() * by_force * r * a * t.cos() * 0.5 * PI / RINGS as f64
    };
    (1.0 + SOFT.poisson) / SOFT.young * (0..RINGS).map(ring).sum::<f64>()
}
