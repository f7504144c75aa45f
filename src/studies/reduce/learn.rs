//! Training data of each phase from runs with all unknowns: its constraints, and the shapes of its motion.

use std::sync::Arc;

use crate::base::input::InputError;
use crate::base::pod::{Mass, Pod, orthonormal, pod};
use crate::base::simd::add_multiple;
use crate::base::vector::dot;
use crate::dynamics::error::Error;
use crate::dynamics::matrices::Matrices;
use crate::dynamics::statics::Statics;
use crate::dynamics::system::{System, Vibrations};
use crate::dynamics::trajectory::Trajectory;
use crate::elements::body::Body;
use crate::integrators::ode::Failure;
use crate::scene::constraint::{ConstraintRow, PhaseStart};
use crate::scene::reduced_model::ReducedPhase;
use crate::scene::timeline::Scene;

/// A phase in all runs.
pub(super) struct LearnedPhase {
    name: String,
    rows: usize,
    /// The columns of E.
    pub(super) lifts: Vec<Vec<f64>>,
    /// Orthonormal in M: those that are always used, and the others, of which those that belong together follow each other.
    shapes: Vec<Vec<f64>>,
    always: usize,
    together: usize,
    /// Amplitude of each, as the root of the sum of squares over all states.
    pub(super) sizes: Vec<f64>,
    /// M Phi, column by column.
    weighted: Vec<Vec<f64>>,
    pub(super) states: Vec<State>,
}

/// A state in a run.
pub(super) struct State {
    /// Displacements (m) where the phase began.
    origin: Arc<Vec<f64>>,
    u: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// u - u_0 without the motion of the constraints, and that motion: E (b - b_0).
    own: Vec<f64>,
    moved: Vec<f64>,
}

impl LearnedPhase {
    /// Phase `number` of a scene, with its equations `at_rest`, of the `runs` of scenes that have the same body and phases, and of
    /// `displacements` (m) beside those of the runs.
    pub(super) fn new(
        (scene, number): (&Scene, usize),
        at_rest: &mut Undeformed,
        runs: &[&Trajectory],
        displacements: &[Vec<f64>],
        most: usize,
    ) -> Result<Self, Error> {
        let (body, phase) = (scene.body(), &scene.phases()[number]);
        let Undeformed { system, matrices, start } = at_rest;
        let lifts = system.lifts(*start).map_err(|failure| failed(phase.name(), failure))?;
        let states = states_in(runs, number, system, &lifts);

        let mass = |x: &[f64], y: &mut [f64]| {
            y.fill(0.0);
            matrices.inertia.add_product(body.dimension(), 1.0, x, y);
        };
        let is_free = system.rows().is_empty();
        let turns = is_free && body.dimension() == 2;
        let mut snapshots: Vec<Vec<f64>> =
            spread(&states, MOST_SNAPSHOTS).map(|state| state.own.clone()).collect();
        let moved = moving(system);
        snapshots.extend(
            displacements.iter().map(|u| own_part(u.clone(), system, &moved, &lifts)[0].clone()),
        );
        let mut always = Vec::new();
        if is_free {
            // what has turned has turned in the shape that it began with
            let mut begun: Vec<&Arc<Vec<f64>>> = states.iter().map(|state| &state.origin).collect();
            begun.dedup_by(|a, b| Arc::ptr_eq(a, b));
            let begun = begun.into_iter().map(|origin| origin.to_vec()).collect();
            let begun = beyond(&[], begun, turns, &mass).shapes;
            let first = begun.into_iter().take(MOST_BEGUN);
            always = orthonormal(&affine(body).into_iter().chain(first).collect::<Vec<_>>(), &mass);
        }
        let found = beyond(&always, snapshots, turns, &mass);
        let count = most.saturating_sub(always.len()).min(found.shapes.len());
        let shapes = orthonormal(&[&always[..], &found.shapes[..count]].concat(), &mass);
        let weighted = weighted(&shapes, &mass);
        let sizes = weighted[..always.len()].iter().map(|weighted| size(weighted, &states));
        let sizes = sizes.chain(found.sizes);
        Ok(Self {
            name: phase.name().to_owned(),
            rows: system.rows().len(),
            sizes: sizes.take(shapes.len()).collect(),
            always: always.len(),
            together: if turns { 2 } else { 1 },
            lifts,
            shapes,
            weighted,
            states,
        })
    }

    /// The first `count` shapes, and `added` ones of which `displacements` (m) are made beyond these.
    pub(super) fn grow(
        &mut self,
        Undeformed { system, matrices, .. }: &mut Undeformed,
        count: usize,
        displacements: Vec<Vec<f64>>,
        added: usize,
    ) {
        let mass = |x: &[f64], y: &mut [f64]| {
            y.fill(0.0);
            matrices.inertia.add_product(matrices.dimension, 1.0, x, y);
        };
        self.shapes.truncate(count);
        let found = beyond(&self.shapes, displacements, false, &mass);
        let mut new: Vec<Vec<f64>> = found.shapes.into_iter().take(added).collect();
        // a remainder that is small relative to the removed part is round-off
        new.iter_mut().for_each(|shape| system.constrain(shape));
        let all: Vec<Vec<f64>> = self.shapes.drain(..).chain(new).collect();
        self.shapes = orthonormal(&all, &mass);
        self.weighted = weighted(&self.shapes, &mass);
    }

    /// Number of shapes of a model of at most `unknowns`.
    pub(super) fn count(&self, unknowns: usize) -> usize {
        let others = unknowns.min(self.shapes.len()).saturating_sub(self.always);
        (self.always + others / self.together * self.together).min(self.shapes.len())
    }

    /// Number of shapes that are always used: all linear displacements, where nothing holds the body.
    pub(super) fn least(&self) -> usize {
        self.always
    }

    /// Number of all shapes.
    pub(super) fn most(&self) -> usize {
        self.shapes.len()
    }

    /// The first `count` shapes, and those that the constraints move.
    pub(super) fn all_shapes(&self, count: usize) -> Vec<Vec<f64>> {
        self.shapes[..count].iter().chain(&self.lifts).cloned().collect()
    }

    /// Displacements (m) of a state as the first `count` shapes have it.
    pub(super) fn projected(&self, state: &State, count: usize) -> Vec<f64> {
        let start = state.origin.iter().zip(&state.moved).map(|(origin, moved)| origin + moved);
        let mut u: Vec<f64> = start.collect();
        for (shape, weighted) in self.shapes.iter().zip(&self.weighted).take(count) {
            let amplitude = dot(weighted, &state.own);
            add_multiple(amplitude, shape, &mut u);
        }
        u
    }

    /// The phase in a model of `count` shapes.
    pub(super) fn reduced(&self, count: usize) -> ReducedPhase {
        let range = |weighted: &Vec<f64>| {
            let all = self.states.iter().flat_map(|state| [&state.u, &*state.origin]);
            let all = all.map(|u| dot(weighted, u));
            all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        ReducedPhase {
            name: self.name.clone(),
            rows: self.rows,
            shapes: self.shapes[..count].to_vec(),
            lifts: self.lifts.clone(),
            range: self.weighted[..count].iter().map(range).collect(),
        }
    }
}

/// Most shapes of where a phase begins that are always taken: a few runs begin alike.
const MOST_BEGUN: usize = 4;

/// Most states that shapes are found from.
const MOST_SNAPSHOTS: usize = 600;

/// At most `most` of all, evenly spread.
pub(super) fn spread<T>(all: &[T], most: usize) -> impl Iterator<Item = &T> {
    let count = most.min(all.len());
    (0..count).map(move |k| &all[(2 * k + 1) * all.len() / (2 * count)])
}

/// M Phi, column by column.
fn weighted(shapes: &[Vec<f64>], mass: Mass) -> Vec<Vec<f64>> {
    let product = |shape: &Vec<f64>| {
        let mut product = vec![0.0; shape.len()];
        mass(shape, &mut product);
        product
    };
    shapes.iter().map(product).collect()
}

/// Amplitude of a shape in all states, as the root of the sum of squares.
fn size(weighted: &[f64], states: &[State]) -> f64 {
    states.iter().map(|state| dot(weighted, &state.own).powi(2)).sum::<f64>().sqrt()
}

/// The equations of a phase with all unknowns, where the body is at rest in its undeformed shape.
pub(super) struct Undeformed {
    system: System,
    matrices: Arc<Matrices>,
    /// The time (s) at which the phase begins.
    start: f64,
}

impl Undeformed {
    pub(super) fn new(scene: &Scene, number: usize) -> Result<Self, Error> {
        let phase = &scene.phases()[number];
        let start = number.checked_sub(1).map_or(0.0, |before| scene.phases()[before].end());
        let forces = scene.forces()?;
        let matrices = scene.matrices(&forces);
        let rest = vec![0.0; scene.body().dofs()];
        let at = PhaseStart { time: start, u: &rest };
        let own = forces.into_iter().nth(number).unwrap_or_default();
        let system = scene.system(&matrices, phase, own, &at, 0.0)?;
        Ok(Self { system, matrices, start })
    }
}

/// Displacements (m) along the path to the equilibrium of phase `number` of a scene, as its loads grow; none where there is none.
pub(super) fn equilibria(scene: &Scene, number: usize) -> Vec<Vec<f64>> {
    let statics = Statics { load_steps: LOAD_STEPS, rtol: 1e-6, ..Statics::default() };
    let Ok(found) = scene.equilibrium_of(scene.phases()[number].name(), &statics) else {
        return Vec::new();
    };
    let samples = found.trajectory().samples();
    let ways = samples.iter().map(|sample| sample.u.iter().zip(&samples[0].u));
    ways.map(|way| way.map(|(u, first)| u - first).collect()).collect()
}

/// Steps of the loads along the path to an equilibrium.
const LOAD_STEPS: usize = 8;

/// The displacements (m) that are expected in phase `number` of a scene by what is linear and of second order, no larger than `most` (m) if
/// that is known, with the vibrations that are `known` of another scene.
pub(super) fn expected(
    (scene, number): (&Scene, usize),
    most: Option<f64>,
    known: &mut Option<Vibrations>,
) -> Result<Vec<Vec<f64>>, Error> {
    let phase = &scene.phases()[number];
    let Undeformed { mut system, start, .. } = Undeformed::new(scene, number)?;
    let velocities = match number {
        0 => scene.initial_velocities()?,
        _ => vec![0.0; scene.body().dofs()],
    };
    let lifts = system.lifts(start);
    let times = [start, phase.end()];
    let found =
        lifts.and_then(|lifts| system.expected_motions(times, &velocities, &lifts, most, known));
    found.map_err(|failure| failed(phase.name(), failure))
}

/// The states of all runs in phase `number`, whose constraints move by `lifts`.
fn states_in(
    runs: &[&Trajectory],
    number: usize,
    system: &mut System,
    lifts: &[Vec<f64>],
) -> Vec<State> {
    let moved = moving(system);
    runs.iter().flat_map(|run| states_of(run, number, system, &moved, lifts)).collect()
}

/// The rows that move.
fn moving(system: &System) -> Vec<ConstraintRow> {
    system.rows().iter().filter(|row| row.moves()).cloned().collect()
}

/// The part of a displacement that constraints leave free, and that which those that are `moved` make by their `lifts`.
fn own_part(
    mut own: Vec<f64>,
    system: &mut System,
    moved: &[ConstraintRow],
    lifts: &[Vec<f64>],
) -> [Vec<f64>; 2] {
    let mut by_rows = vec![0.0; own.len()];
    for (row, lift) in moved.iter().zip(lifts) {
        add_multiple(row.apply(&own), lift, &mut by_rows);
    }
    own.iter_mut().zip(&by_rows).for_each(|(x, moved)| *x -= moved);
    // without the drift of the constraints
    system.constrain(&mut own);
    [own, by_rows]
}

/// The states of a run in phase `number`, whose constraints move by `lifts`.
fn states_of(
    run: &Trajectory,
    number: usize,
    system: &mut System,
    moved: &[ConstraintRow],
    lifts: &[Vec<f64>],
) -> Vec<State> {
    let samples = run.samples();
    let first = samples.partition_point(|sample| sample.phase < number);
    let origin = Arc::new(samples[first.saturating_sub(1)].u.clone());
    let states = samples[first..].iter().take_while(|sample| sample.phase == number);
    states
        .map(|sample| {
            let way = sample.u.iter().zip(&*origin).map(|(u, u0)| u - u0).collect();
            let [own, by_rows] = own_part(way, system, moved, lifts);
            let (u, v) = (sample.u.clone(), sample.v.clone());
            State { origin: origin.clone(), u, v, own, moved: by_rows }
        })
        .collect()
}

/// All displacements that are linear in the position: with them a body turns by any angle.
fn affine(body: &Body) -> Vec<Vec<f64>> {
    let (d, positions) = (body.dimension(), body.mesh().positions());
    let mut all = Vec::new();
    for axis in 0..d {
        for of in 0..=d {
            let value = |x: &[f64]| if of < d { x[of] } else { 1.0 };
            let along =
                |x: &[f64]| (0..d).map(|i| if i == axis { value(x) } else { 0.0 }).collect();
            let field: Vec<Vec<f64>> = positions.chunks_exact(d).map(along).collect();
            all.push(field.concat());
        }
    }
    all
}

/// A displacement in the plane, turned by a quarter.
fn quarter_turned(x: &[f64]) -> Vec<f64> {
    x.as_chunks::<2>().0.iter().flat_map(|&[x, y]| [-y, x]).collect()
}

/// Proper orthogonal decomposition of `displacements` outside the span of orthonormal shapes; with `turns`, also of their quarter turns.
fn beyond(shapes: &[Vec<f64>], mut displacements: Vec<Vec<f64>>, turns: bool, mass: Mass) -> Pod {
    displacements.iter_mut().for_each(|x| remove(shapes, mass, x));
    if turns {
        let turned: Vec<Vec<f64>> = displacements.iter().map(|x| quarter_turned(x)).collect();
        displacements.extend(turned);
    }
    pod(&displacements, mass)
}

/// Removes from `x` its projection onto orthonormal shapes.
fn remove(shapes: &[Vec<f64>], mass: &dyn Fn(&[f64], &mut [f64]), x: &mut [f64]) {
    let mut momentum = vec![0.0; x.len()];
    mass(x, &mut momentum);
    for shape in shapes {
        let amplitude = dot(shape, &momentum);
        x.iter_mut().zip(shape).for_each(|(x, shape)| *x -= amplitude * shape);
    }
}

/// The error of a phase that cannot be evaluated at rest.
fn failed(phase: &str, failure: Failure) -> Error {
    let help = "its moving constraints have no equilibrium in the undeformed shape";
    Error::from(InputError::new(format!("phase \"{phase}\""), failure.into_error(), help))
}
