//! Constraints R = A^T u - b(t) = 0: what is held and what is moved, and how.
//!
//! A constraint on one displacement component of one node (a *nodal* row) is the common case; a
//! general linear row may involve several. R = 0 is stabilized as R'' + 2 alpha R' + alpha^2 R = 0
//! (Hirai (4.1.3)); the equations are those of `system`.

mod prescribed;
mod spline;
mod turn;

use std::fmt;
use std::sync::Arc;

pub use prescribed::{Path, Prescribed};
pub(crate) use spline::Spline;
pub(crate) use turn::angular;

use crate::formula::Formula;
use crate::input::InputError;
use crate::mesh::{Mesh, Selection};

/// An axis of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Axis {
    /// First coordinate.
    X,
    /// Second coordinate.
    Y,
    /// Third coordinate.
    Z,
}

impl Axis {
    /// Position of the axis among the components of a node: 0, 1 or 2.
    pub fn index(self) -> usize {
        self as usize
    }

    /// All axes of a space.
    pub(crate) fn all(dimension: usize) -> &'static [Axis] {
        &[Self::X, Self::Y, Self::Z][..dimension]
    }
}

/// A constraint as the user of a phase gives it.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    pub(crate) what: Constrained,
    pub(crate) how: Motion,
}

#[derive(Clone, Debug)]
pub(crate) enum Constrained {
    /// Components of nodes, each a row of its own.
    Nodes(Selection, Axes),
    /// One general row: (node number from 1, axis, coefficient).
    Row(Vec<(usize, Axis, f64)>),
}

#[derive(Clone, Debug)]
pub(crate) enum Axes {
    All,
    These(Vec<Axis>),
}

#[derive(Clone)]
pub(crate) enum Motion {
    /// Stay where the phase begins.
    Hold,
    /// Move from there with constant velocity (m/s), one per axis (one in all for a general row).
    Velocity(Vec<f64>),
    /// Follow a path (all axes alike).
    Path(Path),
    /// Follow a smooth path through points (all axes alike).
    Spline(Arc<Spline>),
    /// Follow a formula of time without kinks (m; all axes alike).
    #[cfg_attr(not(any(feature = "checkpoint", feature = "scene-file")), allow(dead_code))]
    Formula(Arc<Formula>),
}

impl fmt::Debug for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hold => f.write_str("Hold"),
            Self::Velocity(velocity) => f.debug_tuple("Velocity").field(velocity).finish(),
            Self::Path(_) => f.write_str("Path"),
            Self::Spline(spline) => spline.fmt(f),
            Self::Formula(formula) => formula.fmt(f),
        }
    }
}

impl Motion {
    /// Times (s) at which the motion changes its law.
    pub(crate) fn breaks(&self) -> &[f64] {
        match self {
            Self::Spline(spline) => spline.times(),
            Self::Hold | Self::Velocity(_) | Self::Path(_) | Self::Formula(_) => &[],
        }
    }
}

/// One row of A^T with its b(t), resolved for one phase.
#[derive(Clone)]
pub(crate) struct Row {
    /// Degrees of freedom, ascending, and coefficients; a single one makes a nodal row.
    pub(crate) terms: Vec<(usize, f64)>,
    motion: RowMotion,
}

#[derive(Clone)]
enum RowMotion {
    Linear { start: f64, since: f64, velocity: f64 },
    Path(Path),
    Spline(Arc<Spline>),
    Formula(Arc<Formula>),
}

impl Row {
    /// b, b', b'' at time `t`.
    #[inline]
    pub(crate) fn prescribed(&self, t: f64) -> Prescribed {
        match &self.motion {
            RowMotion::Linear { start, since, velocity } => Prescribed {
                displacement: start + velocity * (t - since),
                velocity: *velocity,
                acceleration: 0.0,
            },
            RowMotion::Path(path) => path(t),
            RowMotion::Spline(spline) => spline.at(t),
            RowMotion::Formula(formula) => {
                let [displacement, velocity, acceleration] = formula.at(t).0;
                Prescribed { displacement, velocity, acceleration }
            }
        }
    }

    /// b', if it never changes.
    pub(crate) fn constant_velocity(&self) -> Option<f64> {
        match self.motion {
            RowMotion::Linear { velocity, .. } => Some(velocity),
            RowMotion::Path(_) | RowMotion::Spline(_) | RowMotion::Formula(_) => None,
        }
    }

    /// Where a row without a path starts: b (m) and when (s).
    pub(crate) fn origin(&self) -> [f64; 2] {
        match self.motion {
            RowMotion::Linear { start, since, .. } => [start, since],
            RowMotion::Path(_) | RowMotion::Spline(_) | RowMotion::Formula(_) => [0.0; 2],
        }
    }

    /// Lets a row without a path start elsewhere: see [`origin`](Self::origin).
    pub(crate) fn set_origin(&mut self, origin: [f64; 2]) {
        if let RowMotion::Linear { start, since, .. } = &mut self.motion {
            [*start, *since] = origin;
        }
    }

    /// A^T x for this row.
    pub(crate) fn apply(&self, x: &[f64]) -> f64 {
        self.terms.iter().map(|&(dof, coefficient)| coefficient * x[dof]).sum()
    }

    /// The degree of freedom of a nodal row and its coefficient.
    pub(crate) fn nodal(&self) -> Option<(usize, f64)> {
        match self.terms[..] {
            [term] => Some(term),
            _ => None,
        }
    }

    /// The nodes and axes of the row, nodes counted from 1, for messages.
    pub(crate) fn label(&self, dimension: usize) -> String {
        let name = |&(dof, _): &(usize, f64)| {
            format!("node {} {:?}", dof / dimension + 1, Axis::all(dimension)[dof % dimension])
                .to_lowercase()
        };
        self.terms.iter().map(name).collect::<Vec<_>>().join(" + ")
    }
}

/// Where the rows of a phase start from.
pub(crate) struct PhaseStart<'a> {
    /// Time (s).
    pub(crate) time: f64,
    /// Displacements (m), with what the phase before prescribed put [where it should be](prescribe).
    pub(crate) u: &'a [f64],
}

/// Puts the nodes that `rows` prescribe where they should be at time `t`: a constraint that is
/// continued does not take over the error of the stabilization.
pub(crate) fn prescribe(rows: &[Row], t: f64, u: &mut [f64]) {
    for row in rows {
        if let Some((dof, coefficient)) = row.nodal() {
            u[dof] = row.prescribed(t).displacement / coefficient;
        }
    }
}

/// Turns the constraints of a phase into rows.
///
/// # Errors
/// Unknown nodes, axes that the body does not have, a velocity of the wrong length, numbers that
/// are not finite, a path through points out of order, the same component constrained twice.
pub(crate) fn rows(
    constraints: &[Constraint],
    mesh: &Mesh,
    phase: &str,
    start: &PhaseStart,
) -> Result<Vec<Row>, InputError> {
    let dimension = mesh.dimension();
    let mut rows: Vec<Row> = Vec::new();
    for Constraint { what, how } in constraints {
        match how {
            Motion::Spline(spline) => spline.validate()?,
            Motion::Formula(formula) => check_smooth(formula)?,
            Motion::Hold | Motion::Velocity(_) | Motion::Path(_) => {}
        }
        match what {
            Constrained::Nodes(selection, axes) => {
                let axes: &[Axis] = match axes {
                    Axes::All => Axis::all(dimension),
                    Axes::These(axes) => axes,
                };
                check_axes(axes, dimension)?;
                check_velocity(how, axes.len())?;
                for node in mesh.select(selection)? {
                    for (k, axis) in axes.iter().enumerate() {
                        let terms = vec![(node * dimension + axis.index(), 1.0)];
                        rows.push(row(terms, how, k, start));
                    }
                }
            }
            Constrained::Row(terms) => {
                check_velocity(how, 1)?;
                let terms = general_terms(terms, mesh)?;
                rows.push(row(terms, how, 0, start));
            }
        }
    }
    for row in &rows {
        check_path(row, phase, dimension, start.time)?;
    }
    reject_double_rows(&rows, dimension, phase, start.time)?;
    Ok(rows)
}

/// Checks that b, b' and b'' can be had of a formula.
fn check_smooth(formula: &Formula) -> Result<(), InputError> {
    formula.kink().map_or(Ok(()), |name| {
        let mend = format!(
            "{name} has no velocity at its kink: give a smooth formula, or a path through points"
        );
        Err(InputError::new("path", formula.text(), mend))
    })
}

fn row(terms: Vec<(usize, f64)>, motion: &Motion, component: usize, start: &PhaseStart) -> Row {
    let linear = |velocity: f64| RowMotion::Linear {
        start: terms.iter().map(|&(dof, coefficient)| coefficient * start.u[dof]).sum(),
        since: start.time,
        velocity,
    };
    let motion = match motion {
        Motion::Hold => linear(0.0),
        Motion::Velocity(velocity) => linear(velocity[component]),
        Motion::Path(path) => RowMotion::Path(path.clone()),
        Motion::Spline(spline) => RowMotion::Spline(spline.clone()),
        Motion::Formula(formula) => RowMotion::Formula(formula.clone()),
    };
    Row { terms, motion }
}

fn check_axes(axes: &[Axis], dimension: usize) -> Result<(), InputError> {
    match axes.iter().find(|axis| axis.index() >= dimension) {
        Some(axis) => {
            let mend = format!("the body has {dimension} dimension(s)");
            Err(InputError::new("axis of a constraint", format!("{axis:?}"), mend))
        }
        None => Ok(()),
    }
}

fn check_velocity(motion: &Motion, components: usize) -> Result<(), InputError> {
    let Motion::Velocity(velocity) = motion else { return Ok(()) };
    if velocity.len() != components {
        return Err(InputError::new(
            "velocity of moved nodes",
            format!("{velocity:?}"),
            format!("it needs {components} component(s) (m/s)"),
        ));
    }
    crate::input::finite("the velocity of moved nodes", velocity)
}

fn general_terms(
    terms: &[(usize, Axis, f64)],
    mesh: &Mesh,
) -> Result<Vec<(usize, f64)>, InputError> {
    let dimension = mesh.dimension();
    let mut resolved: Vec<(usize, f64)> = Vec::new();
    for &(number, axis, coefficient) in terms {
        check_axes(&[axis], dimension)?;
        if !coefficient.is_finite() || coefficient == 0.0 {
            let mend = "it must be a finite number other than 0";
            return Err(InputError::new("coefficient of a constraint row", coefficient, mend));
        }
        let node = mesh.select(&[number].into())?[0];
        let dof = node * dimension + axis.index();
        if resolved.iter().any(|&(other, _)| other == dof) {
            let mend = "it appears twice in one row; add its coefficients";
            return Err(InputError::new("node of a constraint row", number, mend));
        }
        resolved.push((dof, coefficient));
    }
    if resolved.is_empty() {
        return Err(InputError::new("constraint row", "[]", "it needs one term at least"));
    }
    resolved.sort_unstable_by_key(|&(dof, _)| dof);
    Ok(resolved)
}

fn check_path(row: &Row, phase: &str, dimension: usize, t: f64) -> Result<(), InputError> {
    let Prescribed { displacement, velocity, acceleration } = row.prescribed(t);
    if [displacement, velocity, acceleration].iter().all(|number| number.is_finite()) {
        return Ok(());
    }
    Err(InputError::new(
        format!("path of {} in phase \"{phase}\"", row.label(dimension)),
        format!("(b, b', b'') = ({displacement}, {velocity}, {acceleration}) at t = {t} s"),
        "it must give finite numbers",
    ))
}

fn reject_double_rows(
    rows: &[Row],
    dimension: usize,
    phase: &str,
    t: f64,
) -> Result<(), InputError> {
    let mut nodal: Vec<&Row> = rows.iter().filter(|row| row.nodal().is_some()).collect();
    nodal.sort_by_key(|row| row.terms[0].0);
    let doubles = || nodal.windows(2).filter(|pair| pair[0].terms[0].0 == pair[1].terms[0].0);
    let contradicts = |pair: &&[&Row]| pair[0].prescribed(t) != pair[1].prescribed(t);
    let (pair, value, mend) = match (doubles().find(contradicts), doubles().next()) {
        (Some(pair), _) => (pair, "two different motions", "they contradict each other: "),
        (None, Some(pair)) => (pair, "the same motion twice", ""),
        (None, None) => return Ok(()),
    };
    Err(InputError::new(
        format!("constraints on {} in phase \"{phase}\"", pair[0].label(dimension)),
        value,
        format!("{mend}leave one of them out"),
    ))
}
