//! The automatic choice: what it picks, that it changes where it must, and that no method creates
//! energy unnoticed.

use pliant::samples::{self, ClampedBeam, RingRoll};
use pliant::{
    Body, CellSelection, Cells, Inertia, Material, Mesh, Method, Obstacle, Phase, Sampling, Scene,
    Settings, Strain, Trajectory,
};

use crate::common::distance;

fn run(scene: &Scene, settings: &Settings) -> Trajectory {
    scene.simulate(settings, &Sampling::every(0.05)).unwrap()
}

fn auto(rtol: f64) -> Settings {
    Settings { method: Method::Auto, rtol, ..Settings::default() }
}

#[test]
fn the_choice_follows_the_damping() {
    let methods = |scene: &Scene| -> Vec<Method> {
        run(scene, &auto(1e-3)).report().phases.iter().map(|phase| phase.method).collect()
    };
    let square = samples::square_jump(4).unwrap();
    assert_eq!(methods(&square)[..2], [Method::Arkode; 2]);
    // fewer steps than a trial of another method waits for
    let ring = RingRoll { until: 0.01, ..RingRoll::default() }.scene().unwrap();
    assert_eq!(methods(&ring), [Method::CvodeBdf]);
    let report = run(&ring, &auto(1e-3)).report().clone();
    let reason = report.phases[0].reason.as_deref().unwrap();
    assert!(reason.contains("0.006 or more"), "{reason}");
    assert!(report.to_string().contains(reason));
}

/// A ring that walks on a floor with damping creeps in its slowest motion, by a damping ratio above
/// 1, and vibrates in others: BDF crawls there at its orders above 2.
#[test]
fn what_creeps_tells_nothing_of_vibrations() {
    let scene = samples::ring_springs(1.0).unwrap().ended_at(2.0);
    let trajectory = run(&scene, &auto(1e-3));
    let walks = &trajectory.report().phases[1];
    assert_eq!(walks.method, Method::Arkode);
    let reason = walks.reason.as_deref().unwrap();
    assert!(reason.contains("overdamped"), "{reason}");
    // at the same tolerance, all of which ARKODE is given
    let bdf = |rtol| Settings { method: Method::CvodeBdf, rtol, ..Settings::default() };
    let by_bdf = run(&scene, &bdf(1e-3));
    let by_bdf = &by_bdf.report().phases[1];
    // a step of ARKODE of order 3 costs about six of BDF; measured: 185 and 2712
    assert!(10 * walks.counts.steps < by_bdf.counts.steps, "{walks:?} {by_bdf:?}");
    // errors die out in a body that creeps; measured: 0.43 and 0.45
    let reference = scene.simulate(&bdf(1e-6), &Sampling::every(0.02 * scene.end())).unwrap();
    let ratios = [1e-3, 1e-4].map(|rtol| error_over_rtol(&scene, rtol, &reference));
    println!("{ratios:?}");
    assert!(ratios.iter().all(|ratio| (0.1..=3.0).contains(ratio)), "{ratios:?}");
}

/// Tight tolerances ask for steps that the explicit method takes as well.
#[test]
fn it_changes_to_the_explicit_method_in_mid_phase() {
    let scene = samples::square_press(4).unwrap();
    let (loose, tight) = (run(&scene, &auto(1e-3)), run(&scene, &auto(1e-9)));
    let last = |run: &Trajectory| run.report().phases.last().unwrap().method;
    assert_eq!((last(&loose), last(&tight)), (Method::Arkode, Method::Rk));
    let reference = Settings { method: Method::CvodeAdams, rtol: 1e-10, ..Settings::default() };
    // measured: 9e-11 m, one rtol of 8 cm of motion
    assert!(distance(&tight, &run(&scene, &reference)) < 3.0 * 1e-9 * 0.08);
}

/// With lumped inertia it is central differences that take over, and well before that; at a loose
/// tolerance ARKODE steps over all that they would have to follow.
#[test]
fn it_changes_to_central_differences_where_inertia_is_lumped() {
    let scene = ClampedBeam { inertia: Inertia::Lumped, until: 1.0, ..ClampedBeam::default() };
    let scene = scene.scene().unwrap();
    let (loose, tight) = (run(&scene, &auto(1e-3)), run(&scene, &auto(1e-6)));
    let reasons = |run: &Trajectory| run.report().phases[0].reason.clone().unwrap();
    assert!(!reasons(&loose).contains("central-difference"), "{}", reasons(&loose));
    assert!(reasons(&tight).contains("then central-difference"), "{}", reasons(&tight));
    let reference = Settings { method: Method::Rk, rtol: 1e-9, ..Settings::default() };
    let reference = run(&scene, &reference);
    // 6 cm of motion; the phase error of central differences at 0.98 of their longest step is
    // (omega h)^2/24, below 1e-6 even in the tenth mode of bending
    let [loose, tight] = [&loose, &tight].map(|run| distance(run, &reference));
    println!("{loose:e} m, {tight:e} m");
    assert!(tight < 1e-5 * 0.06 && loose > 10.0 * tight, "{loose:e} m, {tight:e} m");
}

#[test]
fn errors_shrink_with_rtol() {
    let scene = samples::square_press(4).unwrap();
    let reference = Settings { method: Method::Rk, rtol: 1e-11, ..Settings::default() };
    let reference = run(&scene, &reference);
    let errors = [1e-3, 1e-5, 1e-7].map(|rtol| distance(&run(&scene, &auto(rtol)), &reference));
    // 8 cm of motion; a factor 100 in rtol gains a factor 10 at least
    assert!(errors[0] < 2e-3, "{errors:?}"); // measured: 7e-4 m
    assert!(errors[1] < 0.1 * errors[0] && errors[2] < 0.1 * errors[1], "{errors:?}");
}

/// The error of the motion over `rtol`: root mean square over nodes and times, beside the motion.
fn error_over_rtol(scene: &Scene, rtol: f64, reference: &Trajectory) -> f64 {
    let times = Sampling::every(0.02 * scene.end());
    let motion = scene.simulate(&auto(rtol), &times).unwrap();
    let [mut error, mut size] = [0.0; 2];
    for (a, b) in motion.samples().iter().zip(reference.samples()) {
        assert_eq!(a.time, b.time);
        error += a.u.iter().zip(&b.u).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        size += b.u.iter().map(|b| b * b).sum::<f64>();
    }
    (error / size).sqrt() / rtol
}

/// Errors of a motion are about what was asked for, whatever its method, its damping and the tolerance.
#[test]
fn rtol_is_the_error_of_the_motion() {
    let clamped = |viscosity| {
        ClampedBeam { viscosity, nodes: [18, 2], until: 1.0, ..ClampedBeam::default() }.scene()
    };
    let scenes = [
        ("pressed square, ARKODE", samples::square_press(4)),
        ("sheared block, BDF", samples::report_8()),
        ("undamped beam, ARKODE", clamped(0.0)),
        ("damped beam, BDF", clamped(4000.0)),
    ];
    for (name, scene) in scenes {
        let scene = scene.unwrap();
        let fine = Settings { method: Method::Arkode, max_order: Some(5), ..auto(1e-7) };
        let reference = scene.simulate(&fine, &Sampling::every(0.02 * scene.end())).unwrap();
        let ratios = [1e-2, 1e-3, 1e-4, 1e-5].map(|rtol| error_over_rtol(&scene, rtol, &reference));
        println!("{name}: {ratios:.2?}");
        assert!(ratios.iter().all(|ratio| (0.1..=3.0).contains(ratio)), "{name}: {ratios:?}");
    }
}

/// An undamped beam under sudden gravity: orders 3 to 5 of BDF are unstable for its vibrations.
fn undamped() -> Scene {
    let mesh = Mesh::rectangle([0.35, 0.02], [36, 3], Cells::Triangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1.4e6, poisson: 0.4, viscosity: 0.0 };
    let body = Body::new(mesh, rubber).thickness(1.0).strain(Strain::Green).build().unwrap();
    Scene::new(body).gravity([0.0, -2.0]).phase(Phase::until(1.0).hold("left"))
}

/// A soft damped bar with an undamped end of modulus `young` (Pa), the outer half of which moves.
fn bar_with_undamped_end(young: f64) -> Scene {
    let soft = Material { density: 1000.0, young: 1e5, poisson: 0.0, viscosity: 400.0 };
    let stiff = Material { young, viscosity: 0.0, ..soft };
    let mesh = Mesh::bar(0.2, 41).unwrap();
    let end = CellSelection::Box { min: vec![0.1], max: vec![0.2] };
    let body =
        Body::new(mesh, soft).strain(Strain::Cauchy).region(end, stiff).area(1e-4).build().unwrap();
    Scene::new(body)
        .initial_velocity(|x| vec![if x[0] > 0.15 { 1.0 } else { 0.0 }])
        .phase(Phase::until(0.5).hold("left"))
}

/// The motion of that bar, and how far from the reference it ends (m); it has no warnings.
fn moved(bar: &Scene, rtol: f64) -> (Trajectory, f64) {
    let motion = run(bar, &auto(rtol));
    assert_eq!(motion.report().warnings(), Vec::<String>::new());
    // within 1e-10 m of what it comes to at tighter tolerances
    let reference = Settings { method: Method::CvodeAdams, rtol: 1e-7, ..Settings::default() };
    let apart = distance(&motion, &run(bar, &reference));
    println!("{:?}: {apart:e} m", motion.report().phases[0]);
    (motion, apart)
}

/// The lowest vibration calls for BDF, which is unstable for those of the end. The run goes back, and on with another
/// method. (A stiffer end would tell beforehand: its fastest motions are damped too little.)
#[test]
fn a_choice_that_creates_energy_is_revoked() {
    let (motion, apart) = moved(&bar_with_undamped_end(1e6), 1e-2);
    let reason = motion.report().phases[0].reason.as_deref().unwrap();
    assert!(reason.contains("created"), "{reason}");
    assert!(apart < 2e-6, "{apart}");
}

/// Samples that are asked for in mid-run are all taken, though the run goes back behind them to another method; and so are those before,
/// of which some or many were taken by then.
#[test]
fn what_is_recorded_before_a_choice_is_revoked_is_complete() {
    let scene = bar_with_undamped_end(1e6);
    let mut revoked = [0; 2];
    for (asked, (number, before)) in
        (1..20).step_by(2).flat_map(|asked| [(asked, (0, 0.05)), (asked, (1, 0.001))])
    {
        let mut bar = scene.start(&auto(1e-2)).unwrap();
        bar.record(&Sampling::every(before)).unwrap();
        let asked = 0.01 * f64::from(asked);
        bar.advance_to(asked).unwrap();
        let before = bar.report().phases[0].reason.clone();
        bar.record(&Sampling::every(0.002)).unwrap();
        bar.advance_to(scene.end()).unwrap();
        revoked[number] += usize::from(before != bar.report().phases[0].reason);
        let motion = bar.into_trajectory();
        let times: Vec<f64> = motion.samples().iter().map(|sample| sample.time).collect();
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{asked}: {times:?}");
        let fine = times.iter().filter(|time| **time > asked + 1e-9).count();
        // the last step of the advance may have led on by some samples, which are not asked for: 14 at most
        let all = ((scene.end() - asked) / 0.002).round() as usize;
        assert!((all - 15..=all).contains(&fine) || number == 1, "{asked}: {fine} of {all}");
        let gaps = times.windows(2).map(|pair| pair[1] - pair[0]);
        let widest = gaps.skip_while(|gap| *gap > 0.0021).fold(0.0, f64::max);
        assert!(widest < 0.0021, "{asked}: {widest} s");
    }
    assert!(revoked.iter().all(|count| *count > 0), "{revoked:?}");
}

/// Where the fastest motions are damped far less than the slowest one, BDF is not even tried.
#[test]
fn the_damping_of_fast_motions_counts() {
    let (motion, apart) = moved(&bar_with_undamped_end(1e7), 1e-2);
    let phase = &motion.report().phases[0];
    let reason = phase.reason.as_deref().unwrap();
    assert!(phase.method == Method::Arkode && !reason.contains("then"), "{reason}");
    assert!(reason.contains("by the fastest motions"), "{reason}");
    assert!(apart < 2e-6, "{apart}");

    // a bent beam that is let go: natural viscosity brakes the turns of its slowest vibration
    let beam = samples::beam_bend(Strain::Green, false).unwrap();
    let (rough, fine) = (run(&beam, &auto(1e-3)), run(&beam, &auto(1e-6)));
    let released = |run: &Trajectory| run.report().phases[1].clone();
    assert_eq!(released(&rough).method, Method::Arkode);
    assert_eq!(released(&fine).method, Method::CvodeBdf);
    let bdf = Settings { method: Method::CvodeBdf, rtol: 1e-4, ..Settings::default() };
    let bdf = released(&run(&beam, &bdf));
    // a step of ARKODE costs about ten of BDF; measured: 263 and 3996
    assert!(12 * released(&rough).counts.steps < bdf.counts.steps, "{bdf:?}");
}

/// With the order capped at 3, BDF runs away, and the run says so; the automatic choice does not.
#[test]
fn energy_out_of_nothing_is_told() {
    let scene = undamped();
    let bdf = Settings { max_order: Some(3), rtol: 1e-3, max_steps: 20_000, ..Settings::default() };
    let bdf = Settings { method: Method::CvodeBdf, ..bdf };
    let warnings = match scene.simulate(&bdf, &Sampling::every(0.05)) {
        Ok(motion) => motion.report().warnings(),
        Err(pliant::Error::Integration(end)) => end.trajectory.report().warnings(),
        Err(other) => panic!("{other}"),
    };
    assert!(warnings.iter().any(|warning| warning.contains("created")), "{warnings:?}");
    let motion = run(&scene, &auto(1e-4));
    assert!(!motion.report().warnings().iter().any(|warning| warning.contains("created")));
}

/// An obstacle whose gradient is not that of its distance drives what lies on it without end: no method
/// can help that, and the run ends the phase with the last resort. What flies freely after it has done
/// nothing wrong, and keeps its method; the warning stays.
#[test]
fn what_an_earlier_phase_created_is_not_held_against_a_later_one() {
    let (sin, cos) = 0.3_f64.sin_cos();
    let crooked = Obstacle::custom(move |x, gradient| {
        gradient.copy_from_slice(&[sin, cos]);
        x[1]
    });
    let mesh = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Triangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };
    let body = Body::new(mesh, rubber).thickness(0.1).strain(Strain::Green).build().unwrap();
    let scene = Scene::new(body)
        .gravity([0.0, -9.8])
        .obstacle(crooked.stiffness(1e4).damping(10.0))
        .phase(Phase::until(0.4).named("driven"))
        .phase(Phase::until(0.8).named("flight").without_contact());
    let motion = run(&scene, &auto(1e-4));
    let [driven, flight] = &motion.report().phases[..] else { panic!("two phases") };
    println!("{:?}\n{:?}", driven.reason, flight.reason);
    let reason = |phase: &pliant::PhaseReport| phase.reason.clone().unwrap();
    assert!(reason(driven).contains("created"), "{}", reason(driven));
    assert!(!reason(flight).contains("created"), "{}", reason(flight));
    let warnings = motion.report().warnings();
    assert!(warnings.iter().any(|warning| warning.contains("created")), "{warnings:?}");
}

/// A floor that begins to act where nodes are inside it already pushes them out by what its springs store
/// then: energy that the phase has brought along, and no method made.
#[test]
fn what_an_obstacle_stores_when_it_begins_to_act_is_supplied() {
    let mesh = Mesh::rectangle([0.1, 0.1], [4, 4], Cells::Triangles).unwrap();
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.3, viscosity: 10.0 };
    let body = Body::new(mesh, rubber).thickness(0.1).strain(Strain::Green).build().unwrap();
    let scene = Scene::new(body)
        .obstacle(Obstacle::half_plane([0.0, 0.01], [0.0, 1.0]).stiffness(1e3))
        .phase(Phase::until(0.1).named("inside").without_contact())
        .phase(Phase::until(0.3).named("pushed out"));
    let motion = run(&scene, &auto(1e-5));
    let report = motion.report();
    assert_eq!(report.warnings(), Vec::<String>::new());
    assert!(!report.phases[1].reason.clone().unwrap().contains("created"));
    // four nodes, 1 cm inside springs of 1 kN/m
    let supplied = motion.last().energy.supplied;
    assert!((supplied - 4.0 * 0.5 * 1e3 * 1e-4).abs() < 1e-15, "{supplied}");
    assert!(report.energy_error < 3e-5 * report.energy_scale, "{:e}", report.energy_error);
}
