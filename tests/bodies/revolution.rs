//! Bodies of revolution against closed forms: Lamé's thick walls, balloons of rubber, masses and volumes, a bar that vibrates, and tangents
//! against finite differences.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use pliant::{
    Axis, Body, Cells, Chamber, Dilatation, Equilibrium, Law, Material, Mesh, Obstacle, Phase,
    Plane, Scene, Statics, Strain, Substance, Viscosity, body::BodyBuilder,
};

fn turned(mesh: Mesh, substance: impl Into<Substance>) -> BodyBuilder {
    Body::new(mesh, substance).plane(Plane::Axisymmetric)
}

/// The upper half of a hollow sphere between two radii (m): `left` is the inside, `bottom` the plane z = 0, and `top` the axis.
fn hemisphere([inner, outer]: [f64; 2], nodes: [usize; 2], cells: Cells) -> Mesh {
    let at = |x: &[f64]| {
        let (rho, angle) = (inner + (outer - inner) * x[0], FRAC_PI_2 * x[1]);
        [rho * angle.cos(), rho * angle.sin()]
    };
    Mesh::rectangle([1.0, 1.0], nodes, cells).unwrap().mapped(at).unwrap()
}

fn equilibrium(body: Body, phase: Phase, chamber: Option<Chamber>, steps: usize) -> Equilibrium {
    let scene = chamber.into_iter().fold(Scene::new(body), Scene::chamber);
    scene.phase(phase).equilibrium(&Statics { load_steps: steps, ..Statics::default() }).unwrap()
}

/// Displacement (m) along r of the first node of a set.
fn radial(found: &Equilibrium, set: &str) -> f64 {
    found.displacements()[2 * found.trajectory().body().mesh().sets()[set][0]]
}

/// A hollow cylinder between smooth plates and a hollow sphere under a pressure p inside (S. Timoshenko, J. Goodier, *Theory of Elasticity*,
/// sections 28 and 136). Quadratic cells, 12 through the wall, are off by 1e-5 or so; the pressure follows the wall, by p/E = 1e-7.
#[test]
fn lame_s_walls() {
    let (a, b, young, poisson, p) = (0.01, 0.02, 1e6, 0.3, 0.1);
    let material = Material { density: 1000.0, young, poisson, viscosity: 0.0 };
    for cells in [Cells::Rectangles9, Cells::Triangles6] {
        let tube = Mesh::rectangle([b - a, 0.01], [25, 5], cells).unwrap();
        let tube = turned(tube.translated(&[a, 0.0]).unwrap(), material).strain(Strain::Cauchy);
        let phase = Phase::until(1.0).pressure_on("left", p);
        let phase = phase.hold_axes("bottom", [Axis::Y]).hold_axes("top", [Axis::Y]);
        let found = equilibrium(tube.build().unwrap(), phase, None, 1);
        let scale = (1.0 + poisson) * p * a * a / (young * (b * b - a * a));
        for (set, r) in [("left", a), ("right", b)] {
            let expected = scale * ((1.0 - 2.0 * poisson) * r + b * b / r);
            let off = radial(&found, set) / expected - 1.0;
            println!("tube {cells:?} {set}: {off:e}");
            assert!(off.abs() < 2e-5, "{set}: {off:e}");
        }
        // around: p a^2 / (b^2 - a^2) (1 + b^2 / r^2)
        let nodes = found.trajectory().body().mesh().sets()["right"][0];
        let stress = found.trajectory().body().nodal_fields(found.displacements())[nodes].stress;
        let expected = 2.0 * p * a * a / (b * b - a * a);
        println!("around: {:e}", stress[2][2] / expected - 1.0);
        assert!((stress[2][2] / expected - 1.0).abs() < 2e-3, "{stress:?}");

        let sphere = turned(hemisphere([a, b], [25, 25], cells), material).strain(Strain::Cauchy);
        let phase = Phase::until(1.0).pressure("air", p).hold_axes("bottom", [Axis::Y]);
        let air = Chamber::within("air", "left").closed_by_line();
        let found = equilibrium(sphere.build().unwrap(), phase, Some(air), 1);
        let scale = p * a.powi(3) / (young * (b.powi(3) - a.powi(3)));
        for (set, r) in [("left", a), ("right", b)] {
            let outer = (1.0 + poisson) * b.powi(3) / (2.0 * r * r);
            let expected = scale * ((1.0 - 2.0 * poisson) * r + outer);
            let off = radial(&found, set) / expected - 1.0;
            println!("sphere {cells:?} {set}: {off:e}");
            assert!(off.abs() < 2e-5, "{set}: {off:e}");
        }
    }
}

/// A thick balloon of neo-Hookean rubber that keeps its volume, blown to 1.6 times its radius inside: p = int 2 mu (l - l^-5) / (l^3 - 1) dl from the
/// stretch around at the outside to that at the inside. The bulk modulus is 1e5 times mu.
#[test]
fn a_balloon_of_rubber() {
    let (a, b, mu) = (0.01, 0.03, 1e5);
    let rubber = Material::of_moduli(1000.0, mu, 1e5 * mu, 0.0).law(Law::NeoHookean);
    let inside = 1.6_f64;
    let outside = f64::cbrt(1.0 + f64::powi(a / b, 3) * (inside.powi(3) - 1.0));
    let slope = |l: f64| 2.0 * mu * (l - l.powi(-5)) / (l.powi(3) - 1.0);
    let (n, h) = (1000, (inside - outside) / 2000.0);
    let at = |k: usize| slope(outside + h * k as f64);
    let simpson = |k: usize| at(2 * k) + 4.0 * at(2 * k + 1) + at(2 * k + 2);
    let p = h / 3.0 * (0..n).map(simpson).sum::<f64>();
    for (cells, nodes, tolerance) in
        [(Cells::Rectangles9, [9, 9], 1e-4), (Cells::Rectangles, [13, 13], 4e-3)]
    {
        let dilatation = match cells {
            Cells::Rectangles9 => Dilatation::Linear,
            _ => Dilatation::Mean,
        };
        let body = turned(hemisphere([a, b], nodes, cells), rubber.clone()).dilatation(dilatation);
        let phase = Phase::until(1.0).pressure("air", p).hold_axes("bottom", [Axis::Y]);
        let air = Chamber::within("air", "left").closed_by_line();
        let found = equilibrium(body.build().unwrap(), phase, Some(air), 8);
        let [inner, outer] =
            [("left", a), ("right", b)].map(|(set, r)| 1.0 + radial(&found, set) / r);
        println!("{cells:?}: {:e} {:e}", inner / inside - 1.0, outer / outside - 1.0);
        assert!((inner / inside - 1.0).abs() < tolerance, "{cells:?}: {inner} {inside}");
        assert!((outer / outside - 1.0).abs() < tolerance, "{cells:?}: {outer} {outside}");
    }
}

/// A cone of air, in its natural shape and in one that is stretched alike along r and along z, and the force on it; masses.
#[test]
fn volumes_and_masses() {
    let material = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 0.0 };
    for cells in [Cells::Triangles, Cells::Rectangles, Cells::Triangles6, Cells::Rectangles9] {
        let at = |x: &[f64]| {
            let size = 0.01 + 0.01 * x[0];
            [size * (1.0 - x[1]), 2.0 * size * x[1]]
        };
        let cone = Mesh::rectangle([1.0, 1.0], [5, 7], cells).unwrap().mapped(at).unwrap();
        let body = turned(cone, material).build().unwrap();
        let cone = |size: f64| PI / 3.0 * size * size * 2.0 * size;
        let mass = 1000.0 * (cone(0.02) - cone(0.01));
        assert!((body.mass() / mass - 1.0).abs() < 1e-14, "{cells:?}: {}", body.mass());
        assert!((body.volume() * 1000.0 / mass - 1.0).abs() < 1e-14);
        let air = Chamber::within("air", "left").closed_by_line();
        let moved: Vec<f64> =
            body.mesh().positions().chunks(2).flat_map(|x| [0.2 * x[0], -0.1 * x[1]]).collect();
        let centre = body.centre_of_mass(&moved);
        assert!(centre[0] == 0.0 && centre[1] > 0.0);
        let ratios = body.volume_ratios(&moved);
        assert!(ratios.iter().all(|ratio| (ratio / (1.44 * 0.9) - 1.0).abs() < 1e-13));
        let scene =
            Scene::new(body).chamber(air).initial_displacement(|x| vec![0.2 * x[0], -0.1 * x[1]]);
        let scene = scene.phase(Phase::until(1.0));
        let start = scene.start(&Default::default()).unwrap();
        let volume = start.view().chamber_volume("air").unwrap();
        assert!((volume / (1.44 * 0.9 * cone(0.01)) - 1.0).abs() < 1e-13, "{cells:?}: {volume}");
    }
}

/// A rod of nu = 0 that is free in space vibrates along itself with c / 2L, and is still along r: quadratic cells, 20 along it, are off by 1e-6 or so.
/// The consistent mass is that of a rod, too.
#[test]
fn a_free_rod_rings() {
    let material = Material { density: 1000.0, young: 1e6, poisson: 0.0, viscosity: 0.0 };
    let rod = Mesh::rectangle([0.01, 0.2], [3, 41], Cells::Rectangles9).unwrap();
    let scene = Scene::new(turned(rod, material).build().unwrap()).phase(Phase::until(1.0));
    let found = scene.spectrum().unwrap()[0].lowest_frequency.unwrap() / TAU;
    let expected = (1e6_f64 / 1000.0).sqrt() / (2.0 * 0.2);
    println!("{:e}", found / expected - 1.0);
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
}

fn noise(count: usize, size: f64, phase: f64) -> Vec<f64> {
    (0..count).map(|k| size * (1.7 * k as f64 + phase).sin()).collect()
}

/// Tangents of all laws, dilatations and kinds of viscosity, with a chamber, a pressure on an open side, which is not symmetric, and contact,
/// against central differences; forces are the gradient of the energy.
#[test]
fn tangents_are_the_derivatives_of_the_forces() {
    let material = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 30.0 };
    let substances: [Substance; 4] = [
        material.into(),
        material.law(Law::MooneyRivlin { second: 0.3 }),
        material.law(Law::Ogden { exponents: [1.3, 5.0, -2.0], shares: [0.97, 0.01, 0.02] }),
        material.law(Law::Corotated),
    ];
    let cases = [
        (Cells::Triangles, Dilatation::AtPoints),
        (Cells::Rectangles, Dilatation::Mean),
        (Cells::Triangles6, Dilatation::Mean),
        (Cells::Rectangles9, Dilatation::Linear),
    ];
    for ((cells, dilatation), substance) in
        cases.into_iter().flat_map(|case| substances.iter().map(move |own| (case, own.clone())))
    {
        for strain in [Strain::Green, Strain::Cauchy] {
            let natural = strain == Strain::Cauchy;
            if natural && substance.law.is_some() {
                continue;
            }
            let body = turned(hemisphere([0.01, 0.02], [3, 5], cells), substance.clone())
                .strain(strain)
                .viscosity(if natural { Viscosity::Natural } else { Viscosity::Objective })
                .dilatation(dilatation)
                .build()
                .unwrap();
            let (mut u, v) = (noise(body.dofs(), 4e-4, 0.3), noise(body.dofs(), 0.01, 1.0));
            // nodes near the axis stay on their side of it
            for (u, x) in u.chunks_mut(2).zip(body.mesh().positions().chunks(2)) {
                u[0] *= x[0] / 0.02;
            }
            let scene = Scene::new(body)
                .chamber(Chamber::within("air", "left").closed_by_line())
                .obstacle(Obstacle::half_plane([0.0, 0.002], [0.0, 1.0]).stiffness_density(1e8))
                .phase(Phase::until(1.0).pressure("air", 3e3).pressure_on("right", 2e3));
            let mut equations = scene.equations(0, &vec![0.0; u.len()]).unwrap();
            let [k, d] = equations.tangents(0.0, &u, &v).map(|matrix| matrix.to_dense());
            let mut force = |u: &[f64], v: &[f64]| {
                let mut f = vec![0.0; u.len()];
                equations.forces(0.0, u, v, &mut f).unwrap();
                f
            };
            for (tangent, by_u, h) in [(&k, true, 1e-8), (&d, false, 1e-3)] {
                let scale = (0..u.len()).map(|i| tangent[(i, i)].abs()).fold(0.0, f64::max);
                for j in 0..u.len() {
                    let [before, after] = [-h, h].map(|by| {
                        let [mut u, mut v] = [u.clone(), v.clone()];
                        if by_u {
                            u[j] += by
                        } else {
                            v[j] += by
                        }
                        force(&u, &v)
                    });
                    for i in 0..u.len() {
                        let off = -(after[i] - before[i]) / (2.0 * h) - tangent[(i, j)];
                        assert!(
                            off.abs() < 2e-6 * scale,
                            "{cells:?} {strain:?} {:?} ({i}, {j}), by u {by_u}: {off:e} of {scale:e}",
                            substance.law
                        );
                    }
                }
            }
            // what the body stores
            let body = scene.body();
            let energy = |u: &[f64]| {
                let fields = body.cell_fields(u);
                let of_cell =
                    |(field, volume): (&pliant::CellField, f64)| field.energy_density * volume;
                fields.iter().zip(body.cell_volumes()).map(of_cell).sum::<f64>()
            };
            let mut own = pliant::force::NodalForces::zeros(u.len());
            body.add_elastic_forces(&u, &mut own).unwrap();
            let scale = own.conservative.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            for j in 0..u.len() {
                let [before, after] = [-1e-7, 1e-7].map(|by| {
                    let mut u = u.clone();
                    u[j] += by;
                    energy(&u)
                });
                let off = (before - after) / 2e-7 - own.conservative[j];
                assert!(off.abs() < 1e-6 * scale, "{cells:?} {j}: {off:e} of {scale:e}");
            }
        }
    }
}
