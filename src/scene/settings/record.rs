//! The record of all settings, and the tolerances that follow from it.
//!
//! The error norm is the root mean square over all unknowns, the same in all methods. A tolerance of more
//! than a hundredth of the motion is a warning. A method that is asked for by name controls the error of each
//! step by `rtol`; `Method::Auto` aims at that error of the whole motion (`docs/notes/automatic-choices.md`).

use std::cell::LazyCell;

use super::method::{ContactEvents, Method};
use crate::base::input::{InputError, positive};
use crate::scene::forces::way;
use crate::scene::timeline::Scene;

/// Settings of the integration of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Integration method. Default: [`Method::Auto`].
    pub method: Method,
    /// Relative tolerance, above 0 and below 1.
    ///
    /// The local error of each step is kept below `rtol |y| + atol` in the root mean square over
    /// displacements and velocities. Errors of steps add up: that of the whole motion may be twenty times as
    /// large. [`Method::Auto`] gives the method that it chooses a part of the tolerances, mostly a fifth or
    /// less, so that the motion is about as precise as `rtol` says. Default: 1e-5.
    pub rtol: f64,
    /// Absolute tolerance of displacements (m). Default: rtol times a hundredth of the size of the body, the
    /// largest of several, so that smaller displacements count as that large.
    pub atol_position: Option<f64>,
    /// Absolute tolerance of velocities (m/s).
    ///
    /// Default: rtol times a hundredth of the speed of waves in the body, the fastest of several, which
    /// corresponds to that of displacements in a vibration; but at most 1/400 of the
    /// [sticking speed](crate::Obstacle::sticking_speed) of an obstacle or a touch with friction, as with more a
    /// step does not notice what breaks loose.
    pub atol_velocity: Option<f64>,
    /// Rate alpha (1/s) at which errors of the constraints decay, above 0. Default: 1e3. Larger means less
    /// drift; it costs implicit methods and central differences nothing, but limits the steps of `rk` to
    /// 3.3/alpha.
    pub alpha: f64,
    /// Order of the method, the highest one of a multistep method. Default: that of
    /// [`Method::information`].
    pub max_order: Option<u32>,
    /// Whether CVODE's BDF detects where the stability of its orders above 2 limits the steps, and lowers the
    /// order there (`CVodeSetStabLimDet`).
    ///
    /// It helps some lightly damped vibrations, not undamped ones. Default: no.
    pub stability_limit_detection: bool,
    /// Whether contact events are located. Default: where that is faster at the same accuracy.
    pub contact_events: ContactEvents,
    /// Longest step (s), above 0. Default: none. Error control needs no bound, and no step leads through an
    /// obstacle without its force; this is for short forces that might begin and end within one step.
    pub max_step: Option<f64>,
    /// Steps that one phase may take. Default: 10 million, a guard against runs without end.
    pub max_steps: usize,
    /// Wall-clock time (s) that a run may take, above 0; each of them where there are several, as in a sweep. It is looked at
    /// between steps, so a run ends by the step in which it is reached; time in which nobody advances a simulation does not
    /// count. Default: none.
    pub max_time: Option<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            method: Method::default(),
            rtol: 1e-5,
            atol_position: None,
            atol_velocity: None,
            alpha: 1e3,
            max_order: None,
            stability_limit_detection: false,
            contact_events: ContactEvents::default(),
            max_step: None,
            max_steps: 10_000_000,
            max_time: None,
        }
    }
}

impl Settings {
    /// Checks what can be known before anything is run.
    ///
    /// # Errors
    /// The first number out of its range.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(self.rtol > 0.0 && self.rtol < 1.0) {
            let help = "it must lie above 0 and below 1 (1e-3 is rough, 1e-8 fine)";
            return Err(InputError::new("rtol", self.rtol, help));
        }
        positive("alpha", self.alpha, "1/s")?;
        self.atol_position.map_or(Ok(1.0), |atol| positive("atol_position", atol, "m"))?;
        self.atol_velocity.map_or(Ok(1.0), |atol| positive("atol_velocity", atol, "m/s"))?;
        self.max_step.map_or(Ok(1.0), |step| positive("max_step", step, "s"))?;
        self.max_time.map_or(Ok(1.0), |time| positive("max_time", time, "s"))?;
        let [lowest, highest] = self.method.information().orders;
        match self.max_order {
            Some(order) if !self.method.has_orders() => {
                let help = format!("{} has one order only: leave it out", self.method);
                Err(InputError::new("max_order", order, help))
            }
            Some(order) if !(lowest..=highest).contains(&order) => {
                let help = format!("{} has the orders {lowest} to {highest}", self.method);
                Err(InputError::new("max_order", order, help))
            }
            _ if self.stability_limit_detection
                && !matches!(self.method, Method::Auto | Method::CvodeBdf) =>
            {
                let help = format!("{} has no such limits: leave it out", self.method);
                Err(InputError::new("stability_limit_detection", true, help))
            }
            _ if self.max_steps == 0 => {
                Err(InputError::new("max_steps", 0, "allow one step at least"))
            }
            _ => Ok(()),
        }
    }

    /// The same with all tolerances times `part`.
    pub(crate) fn tightened(&self, part: f64) -> Self {
        Self {
            rtol: part * self.rtol,
            atol_position: self.atol_position.map(|atol| part * atol),
            atol_velocity: self.atol_velocity.map(|atol| part * atol),
            ..self.clone()
        }
    }

    /// The absolute tolerances in force for `scene`.
    pub fn tolerances(&self, scene: &Scene) -> AbsoluteTolerances {
        self.tolerances_by(&Scales::of(scene))
    }

    /// Those for a scene of these `scales`.
    pub(crate) fn tolerances_by(&self, scales: &Scales) -> AbsoluteTolerances {
        const SMALL_STRAIN: f64 = 0.01;
        const SMALL_CREEP: f64 = 1.0 / 400.0;
        let &Scales { size, young, volume, wave_speed, sticking_speed } = scales;
        let position = self.rtol * SMALL_STRAIN * size;
        let velocity = (self.rtol * SMALL_STRAIN * wave_speed).min(SMALL_CREEP * sticking_speed);
        AbsoluteTolerances {
            position: self.atol_position.unwrap_or(position),
            velocity: self.atol_velocity.unwrap_or(velocity),
            strain: self.atol_position.unwrap_or(position) / size,
            energy: self.rtol * young * volume,
            force: self.rtol * young * volume / size,
            momentum: self.rtol * young * volume / wave_speed,
        }
    }
}

/// The scales of default tolerances. To find them all cells are visited, so a run keeps them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    size: f64,
    young: f64,
    volume: f64,
    wave_speed: f64,
    /// The smallest of all obstacles and touches; infinite without friction.
    sticking_speed: f64,
}

impl Scales {
    pub(crate) fn of(scene: &Scene) -> Self {
        let body = scene.body();
        let size = body.size();
        let obstacles = scene.obstacles().iter().filter_map(|obstacle| obstacle.sticks_below(size));
        let way = LazyCell::new(|| way(body, &scene.initial_velocities().unwrap_or_default()));
        let touches = scene.touches().iter().filter_map(|touch| touch.sticks_below(*way));
        Self {
            size,
            young: body.largest_young(),
            volume: body.volume(),
            wave_speed: body.largest_wave_speed(),
            sticking_speed: obstacles.chain(touches).fold(f64::INFINITY, f64::min),
        }
    }
}

/// Absolute tolerances in force.
///
/// Those of the energies and of the multipliers are loose (as if strain were 1): tight enough that the Newton
/// iteration converges in them, too loose for them to determine the steps.
#[derive(Debug, Clone, Copy)]
pub struct AbsoluteTolerances {
    /// Displacements (m).
    pub position: f64,
    /// Velocities (m/s).
    pub velocity: f64,
    /// Internal strains (1).
    pub(crate) strain: f64,
    /// Energies dissipated and supplied (J).
    pub(crate) energy: f64,
    /// Multipliers (N).
    pub(crate) force: f64,
    /// Multipliers of positions in the form of index 2 (kg m/s).
    pub(crate) momentum: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::body::Body;
    use crate::elements::material::Material;
    use crate::elements::mesh::{Cells, Mesh};

    /// Whichever of several bodies comes first, the stiffest and the fastest are the scales, as if each were alone.
    #[test]
    fn scales_of_several_bodies_are_the_largest() {
        let body = |young: f64, density: f64, name: &str| {
            // apart from each other
            let mesh = Mesh::rectangle([0.1, 0.1], [2, 2], Cells::Triangles).unwrap();
            let mesh = mesh.translated(&[density, 0.0]).unwrap();
            let material = Material { density, young, poisson: 0.3, viscosity: 0.0 };
            Body::new(mesh, material).thickness(0.01).named(name).build().unwrap()
        };
        let [soft, fast, stiff] =
            [body(1e5, 1000.0, "soft"), body(1e7, 10.0, "fast"), body(1e8, 1e4, "stiff")];
        let of = |body: Body| Scales::of(&Scene::new(body));
        let (speed, young) = (of(fast.clone()).wave_speed, of(stiff.clone()).young);
        assert_eq!([speed, young], [1e3, 1e8]);
        for bodies in [[&soft, &fast, &stiff], [&stiff, &soft, &fast], [&fast, &stiff, &soft]] {
            let scales = of(Body::join(bodies.map(Clone::clone)).unwrap());
            assert_eq!([scales.wave_speed, scales.young], [speed, young]);
            assert!((scales.size - 0.02_f64.sqrt()).abs() < 1e-9, "{}", scales.size);
            let settings = Settings::default();
            let tolerances = settings.tolerances_by(&scales);
            assert_eq!(tolerances.velocity, 0.01 * settings.rtol * speed);
        }
    }
}
