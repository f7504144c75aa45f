//! Chambers whose walls pass through each other: what is told of them, and where a run ends.

use pliant::mesh::CellKind;
use pliant::{
    Body, Cells, Chamber, Error, Law, Material, Mesh, Method, Phase, Plane, Sampling, Scene,
    Settings, Strain, Trajectory,
};

/// A thin tube, clamped at one node, with `pressure` (Pa) in it.
fn tube(pressure: f64) -> Scene {
    let mesh = Mesh::ring(0.009, 0.01, [16, 2], Cells::Triangles6).unwrap();
    let rubber = Material { density: 1000.0, young: 1e5, poisson: 0.45, viscosity: 500.0 };
    let body = Body::new(mesh, rubber.law(Law::NeoHookean)).thickness(0.01);
    let body = body.plane(Plane::Stress).strain(Strain::Green).build().unwrap();
    Scene::new(body)
        .chamber(Chamber::within("air", "inner"))
        .phase(Phase::until(0.1).hold([1]).pressure("air", pressure))
}

fn volumes(trajectory: &Trajectory) -> Vec<f64> {
    trajectory.samples().iter().map(|sample| sample.sensors[0]).collect()
}

/// A tube that is drawn in until its walls meet, and would go on through each other: the run ends there, with all before it. Less
/// does no harm, and is told to do none.
#[test]
fn a_chamber_is_not_turned_inside_out_in_silence() {
    let sampling = Sampling::every(1e-3)
        .sensor("volume", "m^3", |view, _| view.chamber_volume("air").unwrap_or(f64::NAN));
    for method in [Method::Auto, Method::CvodeBdf, Method::Arkode] {
        for pressure in [-300.0, -1000.0] {
            let settings = Settings { method, rtol: 1e-3, ..Settings::default() };
            let Err(Error::Integration(end)) = tube(pressure).simulate(&settings, &sampling) else {
                panic!("{method}: it went on")
            };
            let message = end.to_string();
            println!("{message}");
            for said in ["chamber \"air\"", "m^3 at t = ", "passed through each other", "[[touch]]"]
            {
                assert!(message.contains(said), "{method}: {message}");
            }
            assert!(volumes(&end.trajectory).iter().all(|volume| *volume > 0.0), "{method}");
            assert!(end.trajectory.report().steps() < 3000, "{method}");
        }
        let settings = Settings { method, rtol: 1e-3, ..Settings::default() };
        let motion = tube(-10.0).simulate(&settings, &sampling).unwrap();
        let told = motion.report().indicators.iter().find(|told| told.name == "chamber-volume");
        let told = told.unwrap();
        println!("{told}");
        assert!(!told.is_doubtful(), "{told}");
        let least = volumes(&motion).into_iter().fold(f64::INFINITY, f64::min);
        assert_eq!(told.value, least);
    }
}

/// A frame of four strings, two corners of which are moved through the others: without pressure the motion goes on, and the
/// volume in the end is that of the frame turned over.
#[test]
fn a_chamber_without_pressure_is_warned_of() {
    let positions = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let cells = vec![0, 1, 1, 2, 2, 3, 3, 0];
    let mesh = Mesh::new(2, positions, CellKind::Segment, cells).unwrap();
    let string = Material { density: 1000.0, young: 1e5, poisson: 0.0, viscosity: 0.0 };
    let body = Body::new(mesh, string).area(1e-4).strain(Strain::Green).build().unwrap();
    let scene = Scene::new(body)
        .chamber(Chamber::within("air", [1, 2, 3, 4]).thickness(0.01))
        .phase(Phase::until(0.1).hold([1, 2]).move_nodes([3, 4], [1.0, -15.0]));
    let motion = scene.simulate(&Settings::default(), &Sampling::every(0.01)).unwrap();
    let warnings = motion.report().warnings();
    println!("{warnings:?}");
    let warning = warnings.iter().find(|warning| warning.contains("chamber \"air\"")).unwrap();
    for said in ["at t = 0.1 s", "limit: 0", "passed through each other"] {
        assert!(warning.contains(said), "{warning}");
    }
    let told = motion.report().indicators.iter().find(|told| told.name == "chamber-volume");
    let volume = told.unwrap().value;
    // a parallelogram, 1 m long and -0.5 m high
    assert!((volume / (-0.5 * 0.01) - 1.0).abs() < 1e-6, "{volume}");
}
