//! Liquids with a level surface: against closed forms, and one method against another.

use pliant::simulate::Reading;
use pliant::{
    Axis, Body, Cells, Chamber, Error, Gas, Liquid, Material, Mesh, Method, Phase, Sampling, Scene,
    Settings, Signal, Spring, Statics, Strain,
};

use crate::common::{column, settings};

const GRAVITY: f64 = 9.8;
const DENSITY: f64 = 1000.0;
/// Width and height (m) of a vessel, and how deep it is out of the plane.
const WIDTH: f64 = 0.3;
const HEIGHT: f64 = 0.2;
const DEPTH: f64 = 0.1;

/// A rigid vessel of this density (a block, in which the outline of the vessel is drawn), 1 to 4 being its corners row by row, with its lower left corner at the origin.
fn vessel(density: f64) -> Scene {
    let mesh = Mesh::rectangle([WIDTH, HEIGHT], [2, 2], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, Material::rigid(density)).thickness(DEPTH).build().unwrap();
    Scene::new(body).gravity([0.0, -GRAVITY]).chamber(Chamber::within("vessel", [1, 2, 4, 3]))
}

fn water(fill: f64) -> Liquid {
    Liquid::in_chamber("vessel").density(DENSITY).fill(fill).surface()
}

const VOLUME: f64 = WIDTH * HEIGHT * DEPTH;

/// A vessel that hangs from a point below its rim swings as (J) t'' = -K t, with the moment of inertia J of the vessel alone and
///
/// K = g (m_b l_b + m_w l_w) - rho g I,   I = w b^3/12,
///
/// the weights by the distances of the pivot above their centres, less what the surface takes by staying level. Hung lower, that turns it over: it falls as cosh.
#[test]
fn a_vessel_swings_by_its_metacentre() {
    let (density, fill) = (800.0, 0.5);
    let (mass, water_mass) = (density * VOLUME, DENSITY * fill * VOLUME);
    for above in [0.16, 0.1] {
        // a point mass that weighs nothing is where it hangs
        let mesh = Mesh::rectangle([WIDTH, HEIGHT], [3, 21], Cells::Rectangles).unwrap();
        let body = Body::new(mesh, Material::rigid(density)).thickness(DEPTH).build().unwrap();
        let pivot = 3 * (above / 0.01_f64).round() as usize + 2;
        let outline = [1, 2, 3, 63, 62, 61];
        let (arm, inertia) = (above - 0.5 * HEIGHT, (WIDTH.powi(2) + HEIGHT.powi(2)) / 12.0);
        let inertia = mass * (inertia + arm * arm);
        let metacentric = DENSITY * GRAVITY * DEPTH * WIDTH.powi(3) / 12.0;
        let weights = mass * arm + water_mass * (above - 0.5 * fill * HEIGHT);
        let stiffness = GRAVITY * weights - metacentric;
        let rate = (stiffness.abs() / inertia).sqrt();
        let (angle, end) = (1e-3_f64, 2.0 / rate);
        let scene = Scene::new(body)
            .gravity([0.0, -GRAVITY])
            .chamber(Chamber::within("vessel", outline))
            .liquid(water(fill))
            .initial_displacement(|x| {
                let (x, y) = (x[0] - 0.5 * WIDTH, x[1] - above);
                let (sin, cos) = angle.sin_cos();
                vec![cos * x - sin * y - x, sin * x + cos * y - y]
            })
            .phase(Phase::until(end).hold([pivot]));
        for method in [Method::CvodeBdf, Method::Arkode, Method::Rk, Method::Rosenbrock] {
            let sampling = Sampling::every(end / 8.0).read("angle", Reading::rotation());
            let motion = scene.simulate(&settings(method, 1e-8), &sampling).unwrap();
            let apart = motion.samples().iter().zip(column(&motion, 0)).map(|(sample, found)| {
                let t = rate * sample.time;
                let expected = if stiffness > 0.0 { t.cos() } else { t.cosh() };
                (found / angle - expected).abs()
            });
            let apart = apart.fold(0.0, f64::max);
            println!(
                "{above} m, {method}: {rate} rad/s, off by {apart:e}, {:e}",
                motion.report().energy_error
            );
            // measured: up to 6e-5, which absolute tolerances of lengths by the size of the vessel leave
            assert!(apart < 2e-4, "{method}: {apart:e}");
        }
        assert_eq!(stiffness > 0.0, above > 0.15);
    }
}

/// A vessel on springs sinks by the weight of what flows in, over the stiffness. In one that is held, what flows in at the level h brings g h for each kilogram.
#[test]
fn a_vessel_on_a_spring_is_weighed() {
    let (stiffness, damping, first, added) = (2e3, 300.0, 0.2, 2.4e-3);
    let scene = vessel(500.0)
        .liquid(water(first))
        .spring(
            Spring::anchored([1], [0.0, -0.5])
                .named("left")
                .stiffness(stiffness)
                .damping(damping)
                .length(0.5),
        )
        .spring(
            Spring::anchored([2], [WIDTH, -0.5])
                .named("right")
                .stiffness(stiffness)
                .damping(damping)
                .length(0.5),
        );
    let phase = |until: f64| Phase::until(until).hold_axes([1, 3], [Axis::X]);
    let sampling = Sampling::phase_ends()
        .read("height", Reading::displacement([1]))
        .read("level", Reading::liquid_level("vessel"))
        .read("pressure", Reading::pressure("vessel"))
        .read("volume", Reading::liquid_volume("vessel"));
    let flow = Signal::ramp(0.0, added / 2.0, 0.0, 0.5);
    let scene = scene.phase(phase(2.25).flow("vessel", flow)).phase(phase(4.0));
    for method in [Method::CvodeBdf, Method::Ida, Method::Arkode, Method::Rosenbrock] {
        let motion = scene.simulate(&settings(method, 1e-7), &sampling).unwrap();
        let [_, sunk, level, pressure, volume] = motion.last().sensors[..] else { panic!() };
        let inside = (first * VOLUME + added) / (WIDTH * DEPTH);
        let weight = GRAVITY * (500.0 * VOLUME + DENSITY * (first * VOLUME + added));
        let expected = -weight / (2.0 * stiffness);
        let off = [
            sunk / expected - 1.0,
            (level - sunk) / inside - 1.0,
            pressure / (DENSITY * GRAVITY * inside) - 1.0,
            volume / (first * VOLUME + added) - 1.0,
        ];
        let energy = motion.report().energy_error / motion.last().energy.supplied.abs();
        println!("{method}: {off:?}, balance {energy:e}");
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{method}: {off:?}");
        // measured: up to 1.6e-5, by arkode
        assert!(energy < 4e-5, "{method}: {energy:e}");
    }
    let held = vessel(500.0).liquid(water(first));
    let held = held.phase(Phase::until(1.0).hold("all").flow("vessel", added));
    // nothing but the energy would ask for more than one step
    let short = Settings { max_step: Some(0.05), ..settings(Method::Arkode, 1e-7) };
    let motion = held.simulate(&short, &sampling).unwrap();
    let volume = first * VOLUME;
    let lifted =
        DENSITY * GRAVITY * ((volume + added).powi(2) - volume.powi(2)) / (2.0 * WIDTH * DEPTH);
    let supplied = motion.last().energy.supplied;
    println!("{supplied} J, {lifted}");
    assert!((supplied / lifted - 1.0).abs() < 1e-9);
}

/// A ring of rubber that is half full, held below.
fn ring(fill: f64) -> Scene {
    let mesh = Mesh::ring(0.02, 0.03, [24, 3], Cells::Rectangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 200.0 };
    let body = Body::new(mesh, rubber).thickness(0.02).strain(Strain::Green).build().unwrap();
    let liquid = Liquid::in_chamber("bag").density(1200.0).fill(fill).surface();
    Scene::new(body)
        .gravity([0.0, -GRAVITY])
        .chamber(Chamber::within("bag", "inner"))
        .liquid(liquid)
}

/// What holds a half full ring of rubber at rest carries the weight of both; methods without unknowns for amounts take it, and all move it the same.
#[test]
fn methods_agree_on_a_ring_that_is_half_full() {
    let held = [1, 2, 3, 4, 5, 6];
    let scene = ring(0.5).phase(Phase::until(0.05).hold(held));
    let sampling = Sampling::phase_ends()
        .read("held", Reading::constraint_force(held))
        .read("liquid", Reading::liquid_volume("bag"));
    let mut rest = scene.equilibrium(&Statics::default()).unwrap();
    rest.read(&sampling).unwrap();
    let [_, up, liquid] = rest.sample().sensors[..] else { panic!("three numbers") };
    let weight = GRAVITY * (scene.body().mass() + 1200.0 * liquid);
    println!("{up} N up, {weight} N");
    assert!((up / weight - 1.0).abs() < 1e-9);
    let sampling = Sampling::every(0.01).read("level", Reading::liquid_level("bag"));
    let run = |method, rtol| scene.simulate(&settings(method, rtol), &sampling).unwrap();
    let truth = run(Method::Rosenbrock, 1e-8);
    let expected = column(&truth, 0);
    let moved = expected.iter().map(|level| (level - expected[0]).abs()).fold(0.0, f64::max);
    for method in [
        Method::CvodeBdf,
        Method::Ida,
        Method::IdaIndexTwo,
        Method::Arkode,
        Method::CentralDifference,
    ] {
        let motion = run(method, 1e-6);
        let apart = column(&motion, 0).into_iter().zip(&expected).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max) / moved;
        println!("{method}: off by {apart:e} of {moved} m, {} steps", motion.report().steps());
        assert!(apart < 1e-3, "{method}: {apart:e}");
    }
}

/// Commands pump; a checkpoint in a file goes on bit by bit. A ring that is filled to the rim, and one without gravity, say so.
#[test]
fn limits_are_told() {
    let held = || Phase::until(0.4).hold([1, 2, 3]);
    let start = || ring(0.5).phase(held()).start(&settings(Method::Arkode, 1e-4)).unwrap();
    let mut bag = start();
    bag.advance_to(0.01).unwrap();
    let first = bag.view().liquid_level("bag").unwrap();
    bag.flow("bag", 1e-5).unwrap();
    bag.advance_to(0.05).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("level.json");
    let kept = bag.checkpoint();
    kept.write(&file).unwrap();
    bag.restore(&kept).unwrap();
    bag.advance_to(0.1).unwrap();
    let level = bag.view().liquid_level("bag").unwrap();
    assert!(level > first);
    let mut other = start();
    let kept = other.read_checkpoint(&file).unwrap();
    other.restore(&kept).unwrap();
    other.advance_to(0.1).unwrap();
    assert_eq!(other.view().liquid_level("bag").unwrap(), level);
    bag.flow("bag", 1e-3).unwrap();
    let told = bag.advance_to(0.4).unwrap_err().to_string();
    println!("{told}");
    assert!(
        told.contains("is full to the rim") && told.contains("leave its surface out"),
        "{told}"
    );
    let with = |scene: Scene| match scene.phase(held()).validate() {
        Err(error) => error.to_string(),
        Ok(()) => panic!("it is taken"),
    };
    for (scene, words) in [
        (ring(0.5).gravity([0.0, 0.0]), "there is no gravity"),
        (ring(1.0), "fill = 1"),
        (ring(0.5).gas(Gas::in_chamber("bag")), "it has gas already"),
    ] {
        let told = with(scene);
        println!("{told}");
        assert!(told.contains(words), "{told}: {words}");
    }
    let whole =
        ring(0.5).chamber(Chamber::within("other", "inner")).liquid(Liquid::in_chamber("other"));
    let sampling = Sampling::every(0.1).read("level", Reading::liquid_level("other"));
    let Err(Error::Input(told)) = whole.phase(held()).simulate(&Settings::default(), &sampling)
    else {
        panic!("it has a level");
    };
    assert!(told.to_string().contains("fills it whole"), "{told}");
}
