//! Hashes that identify a scene.

use std::fmt::{self, Write};
use std::hash::{DefaultHasher, Hasher};

use crate::dynamics::error::Error;
use crate::integrators::ode::call;
use crate::scene::constraint::PhaseStart;
use crate::scene::timeline::Scene;

/// A hash of all data of a scene, of what its functions of time do at a few
/// times, and of the version of this library.
pub(crate) fn of_scene(scene: &Scene) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write(env!("CARGO_PKG_VERSION").as_bytes());
    add_text(&mut hasher, format_args!("{scene:?}"));
    // A scene that cannot be run has no accelerations; running it will say why.
    let _ = add_accelerations(&mut hasher, scene);
    hasher.finish()
}

/// A hash of `text` and of other hashes.
pub(crate) fn of_text(text: fmt::Arguments<'_>, others: &[u64]) -> u64 {
    let mut hasher = DefaultHasher::new();
    add_text(&mut hasher, text);
    others.iter().for_each(|other| hasher.write_u64(*other));
    hasher.finish()
}

fn add_text(hasher: &mut DefaultHasher, text: fmt::Arguments<'_>) {
    struct Text<'a>(&'a mut DefaultHasher);
    impl Write for Text<'_> {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.write(text.as_bytes());
            Ok(())
        }
    }
    Text(hasher).write_fmt(text).expect("hashing does not fail");
}

/// Accelerations of the body at rest in its undeformed shape, at a few times of each phase: loads,
/// pressures, actuation and paths are functions, whose code cannot be compared.
fn add_accelerations(hasher: &mut DefaultHasher, scene: &Scene) -> Result<(), Error> {
    let rest = vec![0.0; scene.body().dofs()];
    let forces = scene.forces()?;
    let matrices = scene.matrices(&forces);
    let mut time = 0.0;
    for (phase, forces) in scene.phases().iter().zip(forces) {
        let start = PhaseStart { time, u: &rest };
        let mut system = scene.system(&matrices, phase, forces, &start, 1.0)?;
        let state = vec![0.0; system.layout().unknowns()];
        let mut change = state.clone();
        for k in 0..=4 {
            let t = time + 0.25 * f64::from(k) * (phase.end() - time);
            if call::rhs(&mut system, t, &state, &mut change).is_ok() {
                change.iter().for_each(|x| hasher.write_u64(x.to_bits()));
            }
        }
        time = phase.end();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::of_scene;
    use crate::scene::timeline::Phase;
    use crate::studies::samples::{beam_jump, clamped_beam};

    #[test]
    fn scenes_that_differ_have_different_fingerprints() {
        let beam = |viscosity| clamped_beam([6, 2], viscosity).unwrap();
        let mut seen = vec![of_scene(&beam(0.0)), of_scene(&beam(1.0))];
        seen.push(of_scene(&beam_jump().unwrap()));
        for force in [1.0, 2.0] {
            let load = Phase::until(3.0).load_with("right", move |t| [0.0, force * t]);
            seen.push(of_scene(&beam(0.0).phase(load)));
        }
        let all = seen.len();
        assert_eq!(seen[0], of_scene(&beam(0.0)));
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), all);
    }
}
