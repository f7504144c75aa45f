//! Pulses of formulas after a rest: steps do not pass over them.

use std::f64::consts::PI;
use std::path::Path;

use pliant::{Method, Sampling, SceneFile};

const METHODS: [Method; 6] = [
    Method::Auto,
    Method::CvodeBdf,
    Method::CvodeAdams,
    Method::Ida,
    Method::Arkode,
    Method::Rosenbrock,
];

fn file(until: f64, acting: &str) -> SceneFile {
    let text = format!(
        "[body]\n\
         mesh = {{ kind = \"bar\", length = 0.1, nodes = 4 }}\n\
         area = 1e-4\n\
         material = {{ density = 1000.0, young = 1e6, poisson = 0.3, viscosity = 3e3 }}\n\
         [[phase]]\n\
         until = {until}\n\
         {acting}\n\
         [solver]\n\
         rtol = 1e-6\n"
    );
    SceneFile::parse(&text, Path::new("pulse.toml")).unwrap()
}

/// Momentum (N s) of a free bar of 10 g after a load (N) on its end.
fn momentum(method: Method, load: &str) -> f64 {
    let mut file = file(3.0, &format!("load = {{ nodes = \"right\", total = [\"{load}\"] }}"));
    file.settings.method = method;
    let motion = file.scene.simulate(&file.settings, &Sampling::phase_ends()).unwrap();
    motion.momentum(motion.last())[0]
}

/// Momenta are the integrals of the loads, to a hundred times the tolerance of 1e-6 (measured: 7e-5 by `cvode-adams`, 3e-5 and less
/// by the others).
#[test]
fn loads_that_begin_later_act() {
    // sin^20 has the mean C(20, 10)/2^20
    let mean = 184_756.0 / f64::from(1 << 20);
    for (load, impulse) in [
        ("0.5*step(t - 1)*step(1.002 - t)", 0.001),
        ("500*step(t - 1)*step(1.000002 - t)", 0.001),
        ("0.1*exp(-((t - 2)/0.005)^2)", 0.1 * 0.005 * PI.sqrt()),
        ("0.1*max(0, sin(10*(t - 2)))*step(t - 2)*step(2 + pi/10 - t)", 0.02),
        ("max(0, 0.01 - abs(t - 2))", 1e-4),
        ("0.01*sin(pi*t/3)^20", 0.03 * mean),
        ("0.01*sin(5*pi*t/3)^20 + 0.5*step(t - 1)*step(1.002 - t)", 0.03 * mean + 0.001),
    ] {
        for method in METHODS {
            let found = momentum(method, load);
            assert!((found / impulse - 1.0).abs() < 1e-4, "{method} {load}: {found} {impulse}");
        }
    }
}

/// Prescribed motion goes along as well: a bar that is led by a pulse goes all of its way.
#[test]
fn motion_that_begins_later_is_followed() {
    for method in METHODS {
        let path =
            "path = [{ nodes = \"left\", displacement = [\"0.01*exp(-((t - 2)/0.01)^2)\"] }]";
        let mut file = file(3.0, path);
        file.settings.method = method;
        let motion = file.scene.simulate(&file.settings, &Sampling::every(0.005)).unwrap();
        let most = motion.samples().iter().map(|sample| sample.u[0]).fold(0.0, f64::max);
        // ten times the tolerance (measured: 2e-6)
        assert!((most / 0.01 - 1.0).abs() < 1e-5, "{method}: {most}");
    }
}
