//! Whether Maxwell branches are as stiff as their share at large strains.

use crate::dynamics::report::Indicator;
use crate::elements::body::Body;

/// The stretch at which the stress of branches is compared with their share.
const STRETCH: f64 = 1.1;
/// The most that they may resist, in parts of their share. Of all Poisson's ratios up to 0.45 it is less.
const MOST: f64 = 1.25;

/// Branches beside a law other than Hooke's: their own is Hooke's law for Green's strain, which takes a stretch that keeps the volume
/// for a change of it.
pub(super) fn stiffening(body: &Body) -> Option<Indicator> {
    let [lambda, mu] = body.stiffest_branch()?;
    let times = times_their_share(lambda / mu, STRETCH);
    let told = format!(
        "Maxwell branches resist a sudden stretch of {STRETCH} with {times:.3} times their share (limit: {MOST} times)"
    );
    let beyond = || {
        format!(
            "{told}: they are springs of Hooke's law for Green's strain, to which nearly incompressible rubber that is stretched \
             changes its volume, by the square of its strain; keep fast strains below some per cent, take a smaller Poisson's ratio, \
             or law = \"st-venant-kirchhoff\""
        )
    };
    let limits = [0.0, MOST];
    Some(Indicator::trusted("branches", (times, "1"), limits, || told.clone(), beyond))
}

/// The stress of a branch with this ratio lambda/mu in a bar that keeps its volume at a sudden `stretch`, over that of neo-Hookean
/// rubber of the same mu: mu (l^2 - 1/l).
fn times_their_share(ratio: f64, stretch: f64) -> f64 {
    let (along, across) = (stretch * stretch, 1.0 / stretch);
    let strains = [0.5 * (along - 1.0), 0.5 * (across - 1.0)];
    let dilatation = strains[0] + 2.0 * strains[1];
    let of_shear = 2.0 * (strains[0] * along - strains[1] * across) / (along - across);
    ratio * dilatation + of_shear
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::material::{Law, Material};
    use crate::elements::mesh::{Mesh, SolidCells};

    fn block(poisson: f64, law: Option<Law>) -> Body {
        let material = Material { density: 1e3, young: 1e5, poisson, viscosity: 0.0 };
        let mut substance = material.maxwell(0.2, 1.0);
        substance.law = law;
        let mesh = Mesh::cuboid([1.0; 3], [2; 3], SolidCells::Hexahedra).unwrap();
        Body::new(mesh, substance).build().unwrap()
    }

    /// The formula is what a cell does: Kirchhoff stress along less that across, to round-off.
    #[test]
    fn a_cell_resists_as_the_formula_says() {
        for (poisson, stretch) in [(0.4, 1.5), (0.49, 1.1), (0.499, 0.7), (0.49, 2.0)] {
            let body = block(poisson, Some(Law::NeoHookean));
            let branches = body.branches().unwrap();
            let width = f64::powf(stretch, -0.5);
            let factors = [stretch, width, width];
            let positions = body.mesh().positions();
            let u: Vec<f64> =
                positions.iter().enumerate().map(|(i, x)| (factors[i % 3] - 1.0) * x).collect();
            let zeros = vec![0.0; branches.unknowns()];
            let (mut forces, mut rates) = (vec![0.0; u.len()], zeros.clone());
            branches.add_forces(&u, &zeros, &mut forces, &mut rates);
            // the first Piola stress along an axis, by the forces on the face at its end
            let stress = |axis: usize| {
                let ends = positions.chunks(3).zip(forces.chunks(3));
                -ends.filter(|(x, _)| x[axis] > 0.5).map(|(_, f)| f[axis]).sum::<f64>()
            };
            let kirchhoff = stress(0) * stretch - stress(1) * width;
            let mu = 0.2 * body.material().elastic().mu;
            let times = kirchhoff / (mu * (stretch * stretch - 1.0 / stretch));
            let expected = times_their_share(2.0 * poisson / (1.0 - 2.0 * poisson), stretch);
            assert!(
                (times / expected - 1.0).abs() < 1e-9,
                "{poisson} {stretch}: {times} {expected}"
            );
        }
    }

    /// Of rubber beside branches it is told, and of what keeps its share it is not.
    #[test]
    fn branches_of_silicone_are_told() {
        let beyond = |poisson, law| stiffening(&block(poisson, law)).map(|own| own.is_beyond());
        for law in [Law::NeoHookean, Law::Yeoh { second: 0.1, third: 0.0 }, Law::Corotated] {
            assert_eq!(beyond(0.49, Some(law)), Some(true));
            assert_eq!(beyond(0.45, Some(law)), Some(false));
        }
        assert_eq!(beyond(0.49, None), None);
        assert_eq!(beyond(0.49, Some(Law::StVenantKirchhoff)), None);
    }
}
