//! Commands at equal times, as of a controller: which method takes them, how many factorizations they take.

use pliant::samples::SQUARE_MATERIAL;
use pliant::{
    Body, Cells, Chamber, Mesh, Method, Phase, Scene, Settings, Simulation, SolidCells, Strain,
    Substance,
};

use crate::common::apart;

const PERIOD: f64 = 1e-3;

/// A clamped beam of rubber in the plane, with a chamber.
fn beam() -> Scene {
    beam_of(SQUARE_MATERIAL.into())
}

fn beam_of(substance: Substance) -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.02], [11, 3], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, substance).thickness(0.01).strain(Strain::Green);
    Scene::new(body.build().unwrap())
        .chamber(Chamber::within("inside", [1, 11, 33, 23]))
        .phase(Phase::until(1.0).hold("left"))
}

/// Pressures that rise and fall, or loads on a body in space, one at each tick of `period` (s), and the displacements after all.
fn driven(scene: &Scene, settings: &Settings, ticks: u32, period: f64) -> (Simulation, Vec<f64>) {
    let mut simulation = scene.start(settings).unwrap();
    for tick in 0..ticks {
        let part = 0.5 * (1.0 - (20.0 * f64::from(tick) * PERIOD).cos());
        match scene.body().dimension() {
            2 => simulation.pressure("inside", 200.0 * part).unwrap(),
            _ => simulation.load("right", [0.0, 0.1 * part, 0.0]).unwrap(),
        }
        simulation.advance_to(f64::from(tick + 1) * period).unwrap();
    }
    let u = simulation.view().displacements().to_vec();
    (simulation, u)
}

/// Order 3 needs a new matrix every 20 ticks, or where the error grows; order 4 one a step. Against a run at 1e-9
/// (2.7e-3 and 2.3e-3 off were measured, of motions that the commands set going).
#[test]
fn one_factorization_serves_many_ticks() {
    let settings = |method, rtol| Settings { method, rtol, ..Settings::default() };
    let (_, exact) = driven(&beam(), &settings(Method::Arkode, 1e-9), 100, PERIOD);
    for (order, most) in [(3, 20), (4, 110)] {
        let settings = Settings { max_order: Some(order), ..settings(Method::Rosenbrock, 1e-3) };
        let (simulation, u) = driven(&beam(), &settings, 100, PERIOD);
        let (report, off) = (simulation.report(), apart(&exact, &u));
        let [steps, factorizations] = [report.steps(), report.factorizations()];
        println!("order {order}: {steps} steps, {factorizations} factorizations, {off:.1e} off");
        assert!((100..=110).contains(&steps), "{order}: {steps}");
        assert!(factorizations <= most, "{order}: {factorizations}");
        assert!(off < 4e-3, "{order}: {off:e}");
    }
}

/// The method at the end, with the reason for it.
fn chosen(scene: &Scene, rtol: f64, ticks: u32, period: f64) -> (Method, String) {
    let (simulation, _) = driven(scene, &Settings { rtol, ..Settings::default() }, ticks, period);
    let report = simulation.report();
    let phase = report.phases.last().unwrap();
    (phase.method, phase.reason.clone().unwrap())
}

/// Under commands that keep coming: a Rosenbrock method where tolerances are moderate, with one factorization for many
/// ticks where the body is large and steps are as long as ticks.
#[test]
fn the_method_is_chosen_for_ticks() {
    let (method, reason) = chosen(&beam(), 1e-3, 10, PERIOD);
    assert_eq!(method, Method::Rosenbrock);
    assert!(reason.ends_with("as commands change forces"), "{reason}");
    let (method, _) = chosen(&beam(), 1e-6, 10, PERIOD);
    assert_eq!(method, Method::Arkode);
    let relaxing = Substance::from(SQUARE_MATERIAL).maxwell(0.5, 0.02);
    let (method, _) = chosen(&beam_of(relaxing), 1e-3, 10, PERIOD);
    assert_eq!(method, Method::Rosenbrock);
    let solid = Mesh::cuboid([0.1, 0.02, 0.02], [21, 7, 7], SolidCells::Hexahedra).unwrap();
    let solid = Body::new(solid, SQUARE_MATERIAL).strain(Strain::Green).build().unwrap();
    assert!(solid.dofs() > 3000);
    let solid = Scene::new(solid).phase(Phase::until(1.0).hold("left"));
    let (method, reason) = chosen(&solid, 1e-3, 8, PERIOD);
    assert_eq!(method, Method::Rosenbrock);
    assert!(reason.contains("factorizations are most of the work"), "{reason}");
    let (method, reason) = chosen(&solid, 1e-3, 8, 40.0 * PERIOD);
    assert_eq!(method, Method::Rosenbrock);
    assert!(reason.contains("shorter than the time between commands"), "{reason}");
}

/// Multistep methods start again in their own memory, and go where new integrators go, those of forks, to the last bit; their costs add up.
#[test]
fn a_new_start_in_the_same_memory_is_a_new_start() {
    for method in [Method::CvodeBdf, Method::CvodeAdams] {
        let settings = Settings { method, rtol: 1e-4, ..Settings::default() };
        let mut again = beam().start(&settings).unwrap();
        for tick in 1..=30 {
            let mut fork = again.fork().unwrap();
            for simulation in [&mut again, &mut fork] {
                simulation.pressure("inside", 40.0 * f64::from(tick % 7)).unwrap();
                simulation.advance_to(f64::from(tick) * PERIOD).unwrap();
            }
            let [one, other] = [&again, &fork].map(|simulation| simulation.view());
            assert_eq!(one.displacements(), other.displacements(), "{method} {tick}");
        }
        let report = again.report();
        assert_eq!(report.steps(), again.steps(), "{method}");
        assert!(report.phases[0].counts.evaluations > report.steps(), "{method}");
    }
}
