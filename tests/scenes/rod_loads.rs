//! Magnets, fluids and growth on rods, against closed forms.

use std::f64::consts::PI;

use pliant::{
    Body, Dipole, Fluid, Growth, Magnet, Material, Method, Phase, Rod, RodSection, Sampling, Scene,
    Settings, Signal, Statics,
};

const RADIUS: f64 = 0.001;
const LENGTH: f64 = 0.05;

fn soft() -> Material {
    Material { density: 1500.0, young: 1e6, poisson: 0.3, viscosity: 0.0 }
}

fn body(dimension: usize, elements: usize) -> Body {
    let path = [[0.0; 3], [LENGTH, 0.0, 0.0]].map(|x| x[..dimension].to_vec());
    let rod = Rod::new(path.to_vec(), elements, RodSection::Circle { radius: RADIUS });
    Body::rod(rod, soft()).unwrap().named("rod").build().unwrap()
}

fn tip(scene: &Scene, u: &[f64]) -> [f64; 2] {
    let node = scene.body().mesh().sets()["end"][0];
    let d = scene.body().dimension();
    [0, 1].map(|i| u[d * node + i])
}

/// The angle and the place of the tip of an elastica with E I theta'' = -M B cos theta, theta(0) = 0, theta'(L) = 0, by shooting with steps of fourth order.
fn elastica(ratio: f64) -> [f64; 2] {
    let shoot = |slope: f64| {
        let (n, mut y) = (400, [0.0, slope, 0.0, 0.0]);
        let h = LENGTH / f64::from(n);
        let rate = |y: [f64; 4]| [y[1], -ratio * y[0].cos(), y[0].cos(), y[0].sin()];
        for _ in 0..n {
            let ahead = |k: [f64; 4], by: f64| std::array::from_fn(|i| y[i] + by * k[i]);
            let a = rate(y);
            let b = rate(ahead(a, 0.5 * h));
            let c = rate(ahead(b, 0.5 * h));
            let d = rate(ahead(c, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        y
    };
    let (mut low, mut high) = (0.0, ratio * LENGTH);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if shoot(middle)[1] > 0.0 { high = middle } else { low = middle }
    }
    let [.., x, y] = shoot(low);
    [x - LENGTH, y]
}

/// A rod magnetized along its axis in a field across it is the elastica of a magnetic beam, in the plane and in space; so it is in the field of a dipole that is far away.
#[test]
fn a_magnetic_rod_bends_to_its_elastica() {
    let (remanence, field) = (0.1, 0.01);
    let moment = remanence / 1.256_637_062_12e-6 * PI * RADIUS * RADIUS;
    let ratio = moment * field / (1e6 * PI / 4.0 * RADIUS.powi(4));
    let expected = elastica(ratio);
    let magnet = |d: usize| Magnet::new([remanence, 0.0, 0.0][..d].to_vec());
    let vector = |d: usize| [0.0, field, 0.0][..d].to_vec();
    for d in [2, 3] {
        let scene = Scene::new(body(d, 16)).magnet(magnet(d));
        let hold = || Phase::until(1.0).hold("start-section");
        // B = mu_0/(4 pi) 2 m/r^3 along its axis
        let of = |y: f64| [0.0, y, 0.0][..d].to_vec();
        let far = Dipole::new(of(field * 5e6 * 1e9), of(-1e3));
        let even = scene.clone().phase(hold().magnetic_field(vector(d)));
        let by_dipole = scene.dipole(far).phase(hold());
        for scene in [even, by_dipole] {
            let rest = scene.equilibrium(&Statics::default()).unwrap();
            let found = tip(&scene, rest.displacements());
            let off = (found[0] - expected[0]).hypot(found[1] - expected[1]) / LENGTH;
            println!("{d}: {found:?} of {expected:?}, off by {off:e} of the length");
            assert!(off < 2e-3, "{off:e}");
        }
    }
}

/// A free rod in a fluid at rest loses its speed as v/(1 + k v t), across by its diameter, along by its surface; added mass carries as much of the momentum as its
/// share.
#[test]
fn drag_slows_a_rod() {
    let (density, normal, tangential, speed, time) = (1000.0, 0.9, 0.02, 0.5, 0.1);
    let added = 0.2;
    let mass = 1500.0 * PI * RADIUS * RADIUS;
    for d in [2, 3] {
        let (across, around) = if d == 2 {
            (4.0 * RADIUS, 4.0 * RADIUS)
        } else {
            (8.0 / 3.0 * RADIUS, 2.0 * PI * RADIUS)
        };
        for (axis, per_length) in [(0, tangential * around), (1, normal * across)] {
            let fluid = Fluid::new(density).drag(normal, tangential).added_mass(added);
            let scene = Scene::new(body(d, 3)).fluid(fluid);
            let scene = scene
                .initial_velocity(move |_| {
                    (0..d).map(|i| if i == axis { speed } else { 0.0 }).collect()
                })
                .phase(Phase::until(time));
            let settings = Settings { method: Method::CvodeBdf, rtol: 1e-8, ..Settings::default() };
            let motion = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
            let carried = mass + added * around;
            let k = 0.5 * density * per_length / carried;
            let expected = speed / (1.0 + k * speed * time);
            let off = motion.last().v[axis] / expected - 1.0;
            println!("{d} {axis}: {off:e}");
            assert!(off.abs() < 2e-6, "{off:e}");
        }
    }
}

/// A rod that grows gets longer by its strain, or bends to the circle of its natural curvature, both without stress; what growth supplies becomes strain energy where it is held.
#[test]
fn rods_grow_in_length_and_curvature() {
    for d in [2, 3] {
        let grow = |growth: Growth, strain: f64| {
            let scene = Scene::new(body(d, 8)).growth(growth.named("growth"));
            let phase = Phase::until(1.0).hold("start-section").actuate(["growth"], strain);
            let scene = scene.phase(phase);
            let rest = scene.equilibrium(&Statics::default()).unwrap();
            let energy = rest.sample().energy.strain;
            (tip(&scene, rest.displacements()), energy)
        };
        let (longer, energy) = grow(Growth::everywhere(), 0.3);
        println!("{d}: {longer:?}, {energy:e} J");
        assert!((longer[0] - 0.3 * LENGTH).abs() < 1e-9 && energy.abs() < 1e-15);
        // in space d_1 is z, d_2 is y
        let bending = if d == 2 { [0.0, 1.0] } else { [1.0, 0.0] };
        let curvature = 2.0 * PI / LENGTH;
        let (bent, energy) = grow(Growth::everywhere().bending(bending, 0.0), curvature);
        println!("{d}: {bent:?}, {energy:e} J");
        assert!((bent[0] + LENGTH).abs() < 1e-9 && bent[1].abs() < 1e-9 && energy.abs() < 1e-14);
    }
    // held at both ends it is pressed: E A e^2 L/2, which growth supplied
    let scene = Scene::new(body(2, 4)).growth(Growth::everywhere().named("growth"));
    let ramp = Signal::table([0.0, 0.5], [0.0, 0.05]);
    let held = Phase::until(0.5).hold("start-section").hold("end-section");
    let scene = scene.phase(held.actuate(["growth"], ramp));
    let settings = Settings { method: Method::CvodeBdf, rtol: 1e-8, ..Settings::default() };
    let motion = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
    let expected = 0.5 * 1e6 * PI * RADIUS * RADIUS * 0.0025 * LENGTH;
    let energy = &motion.last().energy;
    println!("{energy:?} of {expected:e} J");
    assert!((energy.supplied / expected - 1.0).abs() < 1e-4, "{energy:?}");
    assert!((energy.strain / expected - 1.0).abs() < 1e-4, "{energy:?}");
}
