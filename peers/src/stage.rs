//! One phase of a scene as a second-order system of its free displacement components:
//! M u'' = f(t, u, u').
//!
//! Constraints are eliminated, so that no peer has to know of them. pliant pulls prescribed nodes to
//! their paths at the rate alpha; the components that it prescribes thus follow, exactly,
//! b(t) + (p + (q + alpha p) s) exp(-alpha s) with s the time since the phase began and p, q their
//! distance from the path and its rate then. That is put into the equations of the others.

use pliant::ode::Failure;
use pliant::{Equations, InputError, Prescribed, Scene, Settings};

/// Equations of one phase, in its free components.
pub struct Stage {
    equations: Equations,
    start: f64,
    /// Displacement components that are free, ascending.
    pub free: Vec<usize>,
    held: Vec<Held>,
    /// All displacements (m), velocities (m/s) and forces (N).
    u: Vec<f64>,
    v: Vec<f64>,
    f: Vec<f64>,
    /// Columns of M between free components, compressed, as [`Pattern`] has them.
    pub inertia: Pattern,
    pub masses: Vec<f64>,
    /// Places in the tangents of pliant of the entries of `tangents`.
    places: Vec<usize>,
    /// Pattern of -df/du and -df/dv between free components; that of M is within it.
    pub tangents: Pattern,
    /// Entries of M between a free component (position in `free`) and a held one (position in `held`).
    border: Vec<(usize, usize, f64)>,
}

/// A component that is prescribed, and how far from its path it began.
struct Held {
    dof: usize,
    shift: f64,
    rate: f64,
}

/// Which entries a square matrix has, column by column.
#[derive(Debug, Clone, Default)]
pub struct Pattern {
    pub columns: Vec<usize>,
    pub rows: Vec<usize>,
}

impl Pattern {
    /// Number of rows.
    #[must_use]
    pub fn size(&self) -> usize {
        self.columns.len() - 1
    }

    /// The entries of a column, as (index, row).
    pub fn column(&self, column: usize) -> impl Iterator<Item = (usize, usize)> {
        (self.columns[column]..self.columns[column + 1]).map(|entry| (entry, self.rows[entry]))
    }
}

impl Stage {
    /// Phase number `phase` of `scene`, counted from 0, which begins at the displacements `u` (m) and
    /// velocities `v` (m/s).
    ///
    /// # Errors
    /// As [`Scene::equations`].
    pub fn new(scene: &Scene, phase: usize, u: &[f64], v: &[f64]) -> Result<Self, InputError> {
        let equations = scene.equations(phase, u)?;
        let start = phase.checked_sub(1).map_or(0.0, |before| scene.phases()[before].end());
        let mut held: Vec<Held> = equations
            .prescribed(start)
            .map(|(dof, Prescribed { displacement, velocity, .. })| Held {
                dof,
                shift: u[dof] - displacement,
                rate: v[dof] - velocity,
            })
            .collect();
        held.sort_by_key(|held| held.dof);
        let position = |dof: usize| held.binary_search_by_key(&dof, |held| held.dof);
        let free: Vec<usize> = (0..u.len()).filter(|&dof| position(dof).is_err()).collect();

        let dimension = scene.body().dimension();
        let mass = equations.inertia();
        let [mut inertia, mut tangents] =
            [(); 2].map(|()| Pattern { columns: vec![0], rows: vec![] });
        let (mut masses, mut places, mut border) = (vec![], vec![], vec![]);
        for (column, &dof) in free.iter().enumerate() {
            for (entry, node) in mass.pattern().row(dof / dimension) {
                for axis in 0..dimension {
                    let (row_dof, same) = (node * dimension + axis, axis == dof % dimension);
                    match (position(row_dof), free.binary_search(&row_dof)) {
                        (_, Ok(row)) => {
                            // the block of (row, column) is that of the other order, transposed
                            let Some(other) = mass.pattern().find(node, dof / dimension) else {
                                continue;
                            };
                            places.push((other * dimension + axis) * dimension + dof % dimension);
                            tangents.rows.push(row);
                            if same && mass.values()[entry] != 0.0 {
                                inertia.rows.push(row);
                                masses.push(mass.values()[entry]);
                            }
                        }
                        (Ok(held), _) if same && mass.values()[entry] != 0.0 => {
                            border.push((column, held, mass.values()[entry]));
                        }
                        _ => {}
                    }
                }
            }
            tangents.columns.push(tangents.rows.len());
            inertia.columns.push(inertia.rows.len());
        }
        let (u, v, f) = (u.to_vec(), v.to_vec(), vec![0.0; u.len()]);
        Ok(Self {
            equations,
            start,
            free,
            held,
            u,
            v,
            f,
            inertia,
            masses,
            places,
            tangents,
            border,
        })
    }

    /// Number of free components.
    #[must_use]
    pub fn size(&self) -> usize {
        self.free.len()
    }

    /// The part of `all` that is free.
    #[must_use]
    pub fn free_part(&self, all: &[f64]) -> Vec<f64> {
        self.free.iter().map(|&dof| all[dof]).collect()
    }

    /// All displacements and velocities when the free ones are `u` and `v`.
    pub fn complete(&mut self, t: f64, u: &[f64], v: &[f64]) -> [&[f64]; 2] {
        for ((&dof, u), v) in self.free.iter().zip(u).zip(v) {
            (self.u[dof], self.v[dof]) = (*u, *v);
        }
        for (k, (dof, b)) in prescribed(&self.equations, &self.held, t) {
            let [shift, rate, _] = self.held[k].relaxed(t - self.start);
            (self.u[dof], self.v[dof]) = (b.displacement + shift, b.velocity + rate);
        }
        [&self.u, &self.v]
    }

    /// The forces `f` (N) of the free components, those of the motion of held neighbours included.
    ///
    /// # Errors
    /// As [`Equations::forces`].
    pub fn forces(&mut self, t: f64, u: &[f64], v: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        self.complete(t, u, v);
        self.equations.forces(t, &self.u, &self.v, &mut self.f)?;
        f.iter_mut().zip(&self.free).for_each(|(f, &dof)| *f = self.f[dof]);
        for &(free, held, mass) in &self.border {
            f[free] -= mass * self.held[held].relaxed(t - self.start)[2];
        }
        Ok(())
    }

    /// Writes -df/du and -df/dv, entry by entry of [`tangents`](Self::tangents).
    pub fn write_tangents(&mut self, t: f64, u: &[f64], v: &[f64], k: &mut [f64], d: &mut [f64]) {
        self.complete(t, u, v);
        let [stiffness, damping] = self.equations.tangents(t, &self.u, &self.v);
        for ((k, d), &place) in k.iter_mut().zip(d).zip(&self.places) {
            (*k, *d) = (stiffness.values()[place], damping.values()[place]);
        }
    }

    /// Components that are held, and the velocity of their paths (m/s) at the start.
    #[must_use]
    pub fn paths(&self) -> Vec<(usize, f64)> {
        self.equations.prescribed(self.start).map(|(dof, b)| (dof, b.velocity)).collect()
    }
}

/// What is prescribed at time `t`, with positions in `held`.
fn prescribed(
    equations: &Equations,
    held: &[Held],
    t: f64,
) -> impl Iterator<Item = (usize, (usize, Prescribed))> {
    equations.prescribed(t).filter_map(|(dof, b)| {
        Some((held.binary_search_by_key(&dof, |held| held.dof).ok()?, (dof, b)))
    })
}

impl Held {
    /// Distance from the path, and its first and second derivative, `s` seconds after the start.
    /// Paths of the cases move at constant speed: the second is the whole acceleration.
    fn relaxed(&self, s: f64) -> [f64; 3] {
        let alpha = Settings::default().alpha;
        let (p, q, decay) = (self.shift, self.rate, (-alpha * s).exp());
        let slope = q + alpha * p;
        [
            (p + slope * s) * decay,
            (q - alpha * slope * s) * decay,
            alpha * (alpha * slope * s - slope - q) * decay,
        ]
    }
}
