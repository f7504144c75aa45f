//! Stick and slip as located events: when closed forms of rigid bodies have them.

use std::f64::consts::PI;

use pliant::{
    ContactEvents, Method, Phase, Sampling, Scene, Settings, SlipEvent, Spring, Touch, Trajectory,
};

use super::friction::{G, assert_balanced, block, plane, stick_slip, tied_block};

const METHODS: [Method; 4] = [Method::CvodeBdf, Method::Ida, Method::Arkode, Method::Rk];

fn settings(method: Method, contact_events: ContactEvents) -> Settings {
    Settings { method, contact_events, max_steps: 200_000, ..Settings::default() }
}

/// Located, at the default tolerance.
fn run(scene: &Scene, method: Method) -> Trajectory {
    let settings = settings(method, ContactEvents::Locate);
    scene.simulate(&settings, &Sampling::phase_ends()).unwrap()
}

fn slips(trajectory: &Trajectory) -> &[SlipEvent] {
    &trajectory.report().phases[0].slips
}

/// Times of what is `sliding` or not.
fn times(slips: &[SlipEvent], sliding: bool) -> Vec<f64> {
    slips.iter().filter(|slip| slip.slides == sliding).map(|slip| slip.time).collect()
}

/// A block thrown onto a plane sticks after v/(mu g), and does nothing else.
#[test]
fn a_sliding_block_sticks_once_it_stops() {
    let (speed, mu) = (1.0, 0.5);
    let scene = Scene::new(block(0.0))
        .gravity([0.0, -G])
        .obstacle(plane(0.0).friction_coefficient(mu))
        .initial_velocity(|_| vec![speed, 0.0])
        .phase(Phase::until(0.4));
    for method in METHODS {
        let trajectory = run(&scene, method);
        let [SlipEvent { time, obstacle, slides: false }] = slips(&trajectory) else {
            panic!("{method}: {:?}", slips(&trajectory))
        };
        let expected = speed / (mu * G);
        println!("{method}: {time} {expected} s, {} steps", trajectory.report().steps());
        // it is bent forward as it stops
        assert!((time / expected - 1.0).abs() < 2e-3, "{method}: {time} {expected}");
        assert_eq!(obstacle, "floor");
        let told = format!("sticks once, first at {time:.4e} s");
        assert!(trajectory.report().to_string().contains(&told));
        assert_balanced(&trajectory, 1e-4);
    }
}

/// On a slope a block sticks, slides, or does nothing, as its angle has it.
#[test]
fn a_slope_tells_stick_from_slip() {
    for (slope, events) in [(0.4_f64, 0), (0.6, 1)] {
        let angle = slope.atan();
        let plane = plane(angle).friction_coefficients(0.5, 0.3);
        let scene = Scene::new(block(angle)).gravity([0.0, -G]).obstacle(plane);
        let scene = scene.phase(Phase::until(0.1));
        for method in METHODS {
            let trajectory = run(&scene, method);
            let slips = slips(&trajectory);
            assert_eq!(slips.len(), events, "{method}: {slips:?}");
            assert!(slips.iter().all(|slip| slip.slides), "{method}");
        }
    }
}

/// The block on the belt at the default tolerance: stepped over, its period was 1 to 6 % off by these methods; located,
/// it is within 0.02 % of that of fine steps over the events.
#[test]
fn stick_slip_has_its_period() {
    let (scene, closed_form, highest) = stick_slip();
    let fine = {
        let fine = Settings { rtol: 1e-7, ..settings(Method::Ida, ContactEvents::StepOver) };
        let motion = scene.simulate(&fine, &Sampling::every(1e-3)).unwrap();
        let x: Vec<f64> = motion.samples().iter().map(|sample| sample.u[2 * 5]).collect();
        // times of the peaks, by parabolas
        let peaks = x.windows(3).enumerate().filter_map(|(i, x)| {
            let is_peak = x[1] > x[0] && x[1] >= x[2] && x[1] > 0.9 * highest;
            let top = 0.5 * (x[0] - x[2]) / (x[0] - 2.0 * x[1] + x[2]);
            is_peak.then_some(1e-3 * (i as f64 + 1.0 + top))
        });
        let peaks: Vec<f64> = peaks.collect();
        assert_eq!(peaks.len(), 4);
        (peaks[3] - peaks[0]) / 3.0
    };
    println!("{fine} {closed_form} s");
    assert!((fine / closed_form - 1.0).abs() < 6e-3, "{fine} {closed_form}");
    for method in METHODS {
        let trajectory = run(&scene, method);
        let [slips, sticks] = [true, false].map(|sliding| times(slips(&trajectory), sliding));
        println!("{method}: {slips:?} {sticks:?}, {} steps", trajectory.report().steps());
        assert_eq!([slips.len(), sticks.len()], [4, 4], "{method}");
        // first, the belt takes it along
        assert!(sticks.iter().zip(&slips).all(|(sticks, slips)| sticks < slips));
        for times in [&slips[1..], &sticks[1..]] {
            let found = (times[2] - times[0]) / 2.0;
            println!("{method}: {:e}", found / fine - 1.0);
            assert!((found / fine - 1.0).abs() < 5e-4, "{method}: {found} {fine}");
        }
        assert_balanced(&trajectory, 3e-3);
    }
}

/// A block that swings on a spring k over a plane with little friction turns back every pi/omega, each time nearer
/// by 2 mu m g/k, until the spring no longer outweighs friction: it first turns at 45 mm, and comes back from five turns. At each
/// it sticks for a moment.
#[test]
fn a_swinging_block_turns_back_until_it_sticks() {
    let (k, m, mu, speed): (f64, f64, f64, f64) = (200.0, 2.0, 0.05, 0.5);
    let scene = Scene::new(tied_block())
        .gravity([0.0, -G])
        .spring(Spring::between("wall", [6]).stiffness(k))
        .obstacle(plane(0.0).friction_coefficient(mu))
        .initial_velocity(move |x| vec![if x[0] < -0.2 { 0.0 } else { speed }, 0.0])
        .phase(Phase::until(2.2).hold("wall"));
    let half = PI / f64::sqrt(k / m);
    for method in METHODS {
        let trajectory = run(&scene, method);
        let [slips, sticks] = [true, false].map(|sliding| times(slips(&trajectory), sliding));
        println!("{method}: {slips:?} {sticks:?}, {} steps", trajectory.report().steps());
        assert_eq!([slips.len(), sticks.len()], [5, 6], "{method}");
        for pair in sticks[..4].windows(2) {
            let found = (pair[1] - pair[0]) / half;
            assert!((found - 1.0).abs() < 2e-3, "{method}: {found}");
        }
    }
}

/// Velocities are resolved to a part of the sticking speed, where there is friction and nothing else was asked for.
#[test]
fn tolerances_see_what_breaks_loose() {
    let velocity = |settings: Settings, scene: &Scene| settings.tolerances(scene).velocity;
    let (scene, ..) = stick_slip();
    let asked = Settings { atol_velocity: Some(2e-5), ..Settings::default() };
    assert_eq!(velocity(asked, &scene), 2e-5);
    assert!((velocity(Settings::default(), &scene) - 1e-6).abs() < 1e-20);
    let by_waves = 1e-5 * 0.01 * scene.body().material().wave_speed();
    let smooth = Scene::new(tied_block())
        .obstacle(plane(0.0).sticking_speed(1e-9).friction_coefficient(0.0));
    assert_eq!(velocity(Settings::default(), &smooth), by_waves);
    let touching = |mu: f64| {
        let touch = Touch::all().friction_coefficient(mu).sticking_speed(1e-4);
        Scene::new(tied_block()).touch(touch)
    };
    assert!((velocity(Settings::default(), &touching(0.5)) - 2.5e-7).abs() < 1e-20);
    assert_eq!(velocity(Settings::default(), &touching(0.0)), by_waves);
}

/// A simulation that goes back to before an event finds it once more, at the same time to the last digit.
#[test]
fn a_checkpoint_forgets_what_comes_after() {
    let (scene, ..) = stick_slip();
    for method in METHODS {
        let mut block = scene.start(&settings(method, ContactEvents::Locate)).unwrap();
        block.advance_to(0.52).unwrap();
        let checkpoint = block.checkpoint();
        let mut ends = Vec::new();
        for _ in 0..2 {
            block.restore(&checkpoint).unwrap();
            block.advance_to(0.95).unwrap();
            let view = block.view();
            let motion = [view.displacements(), view.velocities()].concat();
            ends.push((motion, block.report().phases[0].slips.clone()));
        }
        assert_eq!(ends[0], ends[1], "{method}");
        assert_eq!(ends[0].1.len(), 3, "{method}: {:?}", ends[0].1);
    }
}
