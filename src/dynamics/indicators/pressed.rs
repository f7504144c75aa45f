//! Bodies that begin nearer to each other than the distance of their touch.

use super::units::as_meant;
use crate::base::input::four_digits;
use crate::base::vector::{dot, largest, norm};
use crate::dynamics::report::Indicator;
use crate::elements::force::Force;
use crate::scene::forces::TouchForce;
use crate::scene::timeline::Scene;

/// Energy of a touch at the start, over that of bodies which lie on each other.
const MOST: f64 = 3.0;

/// Energy with which touches begin; those that the scene declares as [meant](Scene::unusual) count as within their limits.
pub(super) fn pressed(scene: &Scene) -> Vec<Indicator> {
    let forces = scene.touch_forces().unwrap_or_default();
    let all = forces.iter().filter_map(|force| of_touch(scene, force));
    as_meant(scene, all.collect())
}

/// Bodies that lie on each other have the pressure that carries them, and an energy below weight times distance, as pressures
/// only grow during the approach; motions or drifts beyond the distance are not affected either.
fn of_touch(scene: &Scene, force: &TouchForce) -> Option<Indicator> {
    let (body, u) = (scene.body(), scene.initial_displacements());
    let (gap, nodes) = force.nearest(u)?;
    let energy = force.potential(0.0, u);
    let distance = force.distance();
    let masses: Vec<f64> = body.parts().map(|part| part.body.mass()).collect();
    let total: f64 = masses.iter().sum();
    // the heaviest of several supports the others
    let mass = if masses.len() > 1 { total - largest(&masses) } else { total };
    let weight = mass * scene.acceleration().map_or(0.0, norm);
    let drift = mass * distance / scene.end().powi(2);
    let v = scene.initial_velocities().unwrap_or_default();
    let mut momentum = vec![0.0; v.len()];
    body.inertia().add_product(body.dimension(), 1.0, &v, &mut momentum);
    let lying = (weight + drift) * distance + 0.5 * dot(&v, &momentum);
    let part = energy / lying;
    let names = nodes.map(|node| body.part_of(node).name);
    let said = format!(
        "touch \"{}\" begins with {energy:.1e} J, {} times the energy of bodies at rest on each other (limit: {MOST} times): node {} of \"{}\" and \
         node {} of \"{}\" are {gap:.1e} m apart, within its distance of {distance:.2e} m",
        force.name,
        four_digits(part),
        nodes[0] + 1,
        names[0],
        nodes[1] + 1,
        names[1],
    );
    let beyond = || {
        let speed = (2.0 * energy / mass).sqrt();
        format!(
            "{said}, and are thrown apart at up to {speed:.1e} m/s; give the touch a distance below {gap:.1e} m, or begin farther apart"
        )
    };
    Some(Indicator::trusted("touch-start", (part, "1"), [0.0, MOST], || said.clone(), beyond))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::elements::body::Body;
    use crate::elements::material::Material;
    use crate::elements::mesh::{Cells, Mesh};
    use crate::scene::forces::Touch;
    use crate::scene::timeline::Phase;

    const DISTANCE: f64 = 2e-4;

    /// A block that lies on a wide one, this far apart (m), with a touch of `DISTANCE`.
    pub(crate) fn touching(gap: f64) -> Scene {
        let soft = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
        // faces of 4 mm, which end at the same places
        let block = |name, size: [f64; 2], corner: [f64; 2]| {
            let nodes = [1 + (size[0] / 0.004).round() as usize, 2];
            let mesh = Mesh::rectangle(size, nodes, Cells::Rectangles)?.translated(&corner)?;
            Body::new(mesh, soft).thickness(0.01).named(name).build()
        };
        let upper = block("upper", [0.02, 0.02], [0.0, gap]).unwrap();
        let lower = block("lower", [0.1, 0.02], [-0.04, -0.02]).unwrap();
        Scene::new(Body::join([upper, lower]).unwrap())
            .gravity([0.0, -9.8])
            .touch(Touch::all().distance(DISTANCE))
            .phase(Phase::until(1.0).hold("bottom"))
    }

    /// The gap in which the pressure k (D - d)^2 (D + 2 d)/(3 d^2) carries 0.004 kg on 2e-4 m^2, k = 0.1 E/D: 196 Pa.
    fn resting() -> f64 {
        let hard = 0.1 * 1e5 / DISTANCE;
        let pressure =
            |d: f64| hard * (DISTANCE - d).powi(2) * (DISTANCE + 2.0 * d) / (3.0 * d * d);
        let (mut low, mut high) = (0.0, DISTANCE);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if pressure(middle) > 0.004 * 9.8 / 2e-4 { low = middle } else { high = middle }
        }
        low
    }

    #[test]
    fn what_lies_is_not_told_and_what_is_thrown_is() {
        let beyond = |gap: f64| pressed(&touching(gap)).iter().any(Indicator::is_beyond);
        assert!(!beyond(resting()) && !beyond(0.9 * DISTANCE));
        assert!(beyond(0.05 * DISTANCE));
        assert!(pressed(&touching(1.1 * DISTANCE)).is_empty());
    }

    /// The energy is the pressure times the area, integrated over the distance by rectangles.
    #[test]
    fn the_energy_is_that_of_the_touch() {
        let told = &pressed(&touching(0.05 * DISTANCE))[0];
        let depth = 0.95 * DISTANCE;
        let hard = 0.1 * 1e5 / DISTANCE;
        let d = 0.05 * DISTANCE;
        // the integral of the pressure from d to D
        let (mut energy, parts) = (0.0, 20_000);
        for k in 0..parts {
            let x = d + (f64::from(k) + 0.5) / f64::from(parts) * depth;
            energy += hard * (DISTANCE - x).powi(2) * (DISTANCE + 2.0 * x) / (3.0 * x * x);
        }
        // the end nodes stand for a twelfth of a face, also of the faces beyond the upper body, whose other half is that of the other body. Its
        // corners stand for the mean of the faces below and beside them, by their lengths
        let corner = (0.004_f64.powi(2) + 0.02_f64.powi(2)) / (0.004 + 0.02);
        let length = 0.02 + 0.5 * (2.0 * (corner - 0.004) + 2.0 * 0.004) / 12.0;
        energy *= depth / f64::from(parts) * length * 0.01;
        let (mass, end) = (1000.0 * 0.02 * 0.02 * 0.01, 1.0);
        let lying = mass * (9.8 + DISTANCE / end / end) * DISTANCE;
        let expected = energy / lying;
        assert!((told.value / expected - 1.0).abs() < 1e-3, "{} {expected}", told.value);
    }
}
