//! Contact events: located, they are where the closed form has them, and steps do not suffer.

use pliant::{
    Body, ContactEvents, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene, Settings,
    Strain, Trajectory,
};

/// A short bar that hits a floor of 2000 N/m at 1 m/s: so stiff that it bounces as one mass.
const STIFFNESS: f64 = 2e3;

fn bounce() -> Scene {
    let steel = Material { density: 1000.0, young: 1e9, poisson: 0.0, viscosity: 1e3 };
    let mesh = Mesh::bar(0.1, 2).unwrap().translated(&[0.01]).unwrap();
    let body = Body::new(mesh, steel).strain(Strain::Cauchy).area(2e-4).build().unwrap();
    Scene::new(body)
        .obstacle(Obstacle::half_plane([0.0], [1.0]).stiffness(STIFFNESS))
        .initial_velocity(|_| vec![-1.0])
        .phase(Phase::until(0.1))
}

fn run(method: Method, contact_events: ContactEvents, rtol: f64) -> Trajectory {
    let settings = Settings { method, rtol, contact_events, ..Settings::default() };
    bounce().simulate(&settings, &Sampling::phase_ends()).unwrap()
}

#[test]
fn a_bounce_ends_where_the_closed_form_has_it() {
    // down for 10 ms, half a period of the floor's spring, up again
    let mass: f64 = 1000.0 * 2e-4 * 0.1;
    let contact = std::f64::consts::PI / (STIFFNESS / mass).sqrt();
    let height = 0.1 - 0.01 - contact;
    for method in [Method::CvodeBdf, Method::CvodeAdams, Method::Ida, Method::Rk] {
        let motion = run(method, ContactEvents::Locate, 1e-8);
        assert_eq!(motion.report().phases[0].counts.contact_events, 2, "{method}");
        let (u, v) = (motion.last().u[0] + 0.01, motion.mean_velocity(motion.last())[0]);
        // the bar bends the floor's law by E A/l over K_p, some 1e-6 m (and rings a little)
        assert!((u - height).abs() < 5e-5, "{method}: {u} {height}");
        assert!((v - 1.0).abs() < 5e-6, "{method}: {v}");
    }
}

/// Motion with located events converges to the one without.
#[test]
fn located_or_stepped_over_the_motion_is_the_same() {
    let fine = run(Method::Rk, ContactEvents::StepOver, 1e-11);
    for rtol in [1e-6, 1e-8] {
        for method in [Method::CvodeBdf, Method::Ida, Method::Rk] {
            let motion = run(method, ContactEvents::Locate, rtol);
            let apart = (motion.last().u[0] - fine.last().u[0]).abs();
            // 10 cm of motion
            assert!(apart < 100.0 * rtol * 0.1, "{method} {rtol}: {apart:e}");
        }
    }
}

/// With the kinks at the ends of steps, Runge-Kutta rejects fewer of them.
#[test]
fn located_events_spare_rejected_steps() {
    let rejected = |events| {
        let motion = run(Method::Rk, events, 1e-6);
        motion.report().phases[0].counts.error_test_failures
    };
    let (over, located) = (rejected(ContactEvents::StepOver), rejected(ContactEvents::Locate));
    assert!(located < over, "{located} {over}");
}

/// A scene with many nodes that touch and leave.
#[test]
fn a_rolling_ring_passes_its_events() {
    let scene = pliant::samples::RingRoll { until: 0.5, ..Default::default() }.scene().unwrap();
    let end = |contact_events, rtol| {
        let settings = Settings { contact_events, rtol, ..Settings::default() };
        let motion = scene.simulate(&settings, &Sampling::phase_ends()).unwrap();
        let events = motion.report().phases[0].counts.contact_events;
        let told = format!("{events} contact events located");
        assert_eq!(motion.report().to_string().contains(&told), events > 1);
        (motion.centre_of_mass(motion.last())[0], events)
    };
    let (over, none) = end(ContactEvents::StepOver, 1e-7);
    let (located, events) = end(ContactEvents::Locate, 1e-7);
    assert_eq!(none, 0);
    assert!(events > 2, "{events}");
    // the motion is some centimetres; 100 rtol of it
    assert!((located - over).abs() < 1e-8, "{located} {over}");
    // where nothing was said, fine tolerances have them located
    assert_eq!(end(ContactEvents::Auto, 1e-7), (located, events));
    assert_eq!(end(ContactEvents::Auto, 1e-5).1, 0);
}

/// A bounce with damping, by the law with adhesion (two events: touch, leave) and without (three: the
/// damper is cut off while the bar still touches).
fn damped_bounce(adhesion: bool) -> Scene {
    let steel = Material { density: 1000.0, young: 1e9, poisson: 0.0, viscosity: 1e3 };
    let mesh = Mesh::bar(0.1, 2).unwrap().translated(&[0.01]).unwrap();
    let body = Body::new(mesh, steel).strain(Strain::Cauchy).area(2e-4).build().unwrap();
    let floor = Obstacle::half_plane([0.0], [1.0]).stiffness(STIFFNESS).damping(2.0);
    Scene::new(body)
        .gravity([-9.8])
        .obstacle(floor.adhesion(adhesion))
        .initial_velocity(|_| vec![-1.0])
        .phase(Phase::until(0.06))
}

/// Located, events cost no accuracy: errors fall as the tolerance does, by every method and both laws
/// of contact, against explicit Runge-Kutta that steps over the events at a tolerance far below.
#[test]
fn located_motion_converges_by_every_method_and_law() {
    for adhesion in [true, false] {
        let scene = damped_bounce(adhesion);
        let run = |method, contact_events, rtol| {
            let settings = Settings { method, rtol, contact_events, ..Settings::default() };
            scene.simulate(&settings, &Sampling::phase_ends()).unwrap()
        };
        let fine = run(Method::Rk, ContactEvents::StepOver, 1e-13);
        for method in Method::ALL {
            let error = |rtol: f64| {
                let motion = run(method, ContactEvents::Locate, rtol);
                let events = motion.report().phases[0].counts.contact_events;
                let off = (motion.last().u[0] - fine.last().u[0]).abs();
                println!("{method} {adhesion} {rtol:e}: {off:.1e} m, {events} events");
                assert_eq!(events, if adhesion { 2 } else { 3 }, "{method} {rtol:e}");
                off
            };
            let [rough, fine] = [1e-5, 1e-9].map(error);
            assert!(fine < 1e-2 * rough && fine < 2e-8, "{method} {adhesion}: {rough:e} {fine:e}");
        }
    }
}
