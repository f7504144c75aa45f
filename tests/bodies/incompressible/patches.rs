//! Patches: cells of any shape show a constant strain as it is.

use pliant::{Law, Material, Phase, Scene, Statics, Strain};

use super::{Kind, body};

/// Displacement gradients (1) along the axes, small and large.
const GRADIENT: [[f64; 3]; 3] = [[0.11, 0.05, -0.04], [-0.07, -0.06, 0.03], [0.02, 0.08, 0.05]];

/// The nodes of the boundary are moved as a constant gradient says; those within follow it to rounding, and all
/// cells have the same stress. Cells are distorted, with straight edges.
#[test]
fn constant_strain_is_met_exactly() {
    for kind in Kind::ALL {
        for &dilatation in kind.dilatations() {
            let material = |poisson| Material { density: 1e3, young: 1e6, poisson, viscosity: 0.0 };
            for (strain, substance, exact) in [
                (Strain::Cauchy, material(0.3).into(), 1e-11),
                (Strain::Cauchy, material(0.4999).into(), 1e-9),
                (Strain::Green, material(0.3).into(), 1e-11),
                (Strain::Green, material(0.3).law(Law::NeoHookean), 1e-11),
                (Strain::Green, material(0.499).law(Law::NeoHookean), 1e-9),
            ] {
                let cells = if kind.is_plane() { 3 } else { 2 };
                let body = body(kind.distorted(cells), substance, dilatation).strain(strain);
                let body = body.build().unwrap();
                let d = body.dimension();
                let along = |x: &[f64]| -> Vec<f64> {
                    (0..d).map(|i| (0..d).map(|j| GRADIENT[i][j] * x[j]).sum()).collect()
                };
                let mut phase = Phase::until(1.0);
                for &node in body.mesh().boundary_nodes() {
                    phase = phase.move_nodes([node + 1], along(body.mesh().position(node)));
                }
                let scene = Scene::new(body.clone()).phase(phase);
                let name = format!("{kind:?}, {dilatation:?}, {strain:?}");
                let rest = scene.equilibrium(&Statics::default());
                let rest = rest.unwrap_or_else(|error| panic!("{name}: {error}"));
                let expected = body.mesh().positions().chunks(d).flat_map(along);
                let off = rest.displacements().iter().zip(expected).map(|(u, x)| (u - x).abs());
                let off = off.fold(0.0, f64::max);
                let fields = body.cell_fields(rest.displacements());
                let jump =
                    fields.iter().map(|f| (f.von_mises() / fields[0].von_mises() - 1.0).abs());
                let jump = jump.fold(0.0, f64::max);
                println!("{name}: {off:.1e} m, {jump:.1e}");
                assert!(off < exact && jump < 1e3 * exact, "{name}: {off:e} {jump:e}");
            }
        }
    }
}
