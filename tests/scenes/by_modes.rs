//! Reduced models without a run of all unknowns: what they tell of themselves against runs with all.

use std::ops::ControlFlow;

use pliant::reduce::{Reduced, Training, error, reduce_by_modes};
use pliant::simulate::Reading;
use pliant::{Body, Cells, Material, Mesh, Method, Phase, Sampling, Scene, Settings, Strain};

const RUBBER: Material = Material { density: 1000.0, young: 1e5, poisson: 0.4, viscosity: 100.0 };

fn settings() -> Settings {
    Settings { method: Method::Arkode, rtol: 1e-6, ..Settings::default() }
}

/// A strip of 0.1 x 0.02 m, clamped on the left, that a force (N) at its tip bends, and that is let go.
fn strip(strain: Strain, force: f64) -> Scene {
    let mesh = Mesh::rectangle([0.1, 0.02], [13, 4], Cells::Rectangles).unwrap();
    let body = Body::new(mesh, RUBBER).thickness(0.01).strain(strain).build().unwrap();
    let bent = Phase::until(0.4).named("bent").hold("left").load([52], [0.0, force]);
    Scene::new(body).phase(bent).phase(Phase::until(0.8).named("let go").hold("left"))
}

fn found(scene: &Scene, within: f64) -> Reduced {
    let scenes = vec![scene.clone()];
    let training =
        Training { scenes, held_out: Vec::new(), settings: settings(), within, most_unknowns: 48 };
    reduce_by_modes(&training, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// The error of a model that was found without a run of all unknowns, and the one that it tells; the error that its run tells of the height of the
/// tip, and that one.
fn errors(scene: &Scene, within: f64) -> [[f64; 2]; 2] {
    let reduced = found(scene, within);
    assert!(reduced.is_within && reduced.model.is_estimate(), "{reduced}");
    assert!(reduced.full_seconds.is_none() && reduced.pays_from().is_none());
    let sampling = Sampling::every(0.01).read("tip", Reading::position([52]));
    let full = scene.simulate(&settings(), &sampling).unwrap();
    let short = scene.clone().reduced(reduced.model.clone()).unwrap();
    let short = short.simulate(&settings(), &sampling).unwrap();
    let report = short.report().reduced.clone().unwrap();
    assert!(report.is_estimate);
    let tip = report.readings.iter().find(|told| told.name == "tip.y").unwrap();
    let pairs = full.samples().iter().zip(short.samples());
    let off = pairs.map(|(a, b)| (a.sensors[1] - b.sensors[1]).abs()).fold(0.0, f64::max);
    [[error(&full, &short), reduced.model.error()], [off, tip.error]]
}

/// Of a body with linear strain these are its vibrations and the shape that the load makes, and a few of them are enough.
#[test]
fn vibrations_are_enough_for_linear_strain() {
    let [[off, told], [tip, told_of_tip]] = errors(&strip(Strain::Cauchy, 0.03), 0.01);
    println!("cauchy: {off:e} told {told:e}, tip {tip:e} told {told_of_tip:e}");
    assert!(off < 0.01 && told > 0.3 * off, "{off:e}, told {told:e}");
    assert!(told_of_tip > 0.3 * tip && told_of_tip < 10.0 * tip, "{tip:e}, told {told_of_tip:e}");
}

/// Bent by half of its length: no shape at rest has that, and what runs by the model lack does.
#[test]
fn what_a_model_lacks_makes_it_richer() {
    let [[off, told], [tip, told_of_tip]] = errors(&strip(Strain::Green, 0.06), 0.02);
    println!("green: {off:e} told {told:e}, tip {tip:e} told {told_of_tip:e}");
    assert!(off < 0.02 && told > 0.3 * off, "{off:e}, told {told:e}");
    assert!(told_of_tip > 0.3 * tip && told_of_tip < 10.0 * tip, "{tip:e}, told {told_of_tip:e}");
}
