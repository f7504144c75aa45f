//! The constraints of a phase as rows.

use std::collections::BTreeMap;
use std::ptr;

use super::prescribed::Prescribed;
use super::rigid_holds::with_directions;
use super::row::{ConstraintRow, NOTHING_NEW, RowMotion, independent_terms};
use super::start::PhaseStart;
use super::turn::Turning;
use super::{Axes, Axis, Constrained, Constraint, Motion};
use crate::base::input::{InputError, finite};
use crate::base::vector::{dot, norm};
use crate::elements::body::{Body, RigidPieces};
use crate::elements::mesh::Mesh;

/// Components of a unit vector below this are round-off of a cosine.
const ROUND_OFF: f64 = 1e-14;

/// Turns the constraints of a phase into rows.
///
/// # Errors
/// Unknown nodes, axes that the body does not have, a velocity of the wrong length, numbers that are not
/// finite, a path through points out of order, constraints that contradict each other.
pub(crate) fn rows<'a>(
    constraints: impl Iterator<Item = &'a Constraint>,
    body: &Body,
    phase: &str,
    start: &PhaseStart,
) -> Result<Vec<ConstraintRow>, InputError> {
    let (mesh, dimension) = (body.mesh(), body.dimension());
    let mut rows: Vec<ConstraintRow> = Vec::new();
    for Constraint { what, how } in constraints {
        match how {
            Motion::Spline(spline) => spline.validate("displacements of a path", "m")?,
            Motion::Formula(formula) => formula.check_smooth()?,
            Motion::Turn(turn) => turn.validate(dimension)?,
            Motion::Hold | Motion::Together | Motion::Velocity(_) | Motion::Path(_) => {}
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
                        rows.push(row(terms, how, k, start, mesh));
                    }
                }
            }
            Constrained::Row(terms) => {
                check_velocity(how, 1)?;
                let terms = general_terms(terms, mesh)?;
                rows.push(row(terms, how, 0, start, mesh));
            }
            Constrained::Along(selection, normal) => {
                let normal = direction(normal, dimension)?;
                for node in mesh.select(selection)? {
                    let terms = normal.iter().map(|&(i, n)| (node * dimension + i, n)).collect();
                    rows.push(row(terms, how, 0, start, mesh));
                }
            }
        }
    }
    for row in &rows {
        check_path(row, phase, dimension, start.time)?;
    }
    let Some(rigid) = body.rigid_pieces() else {
        return without_repetitions(rows, dimension, phase);
    };
    for row in &mut rows {
        row.is_of_rigid = row.terms.iter().any(|(dof, _)| rigid.contains(dof / dimension));
    }
    let rows = without_repetitions(rows, dimension, phase)?;
    let rows = without_rigid_repetitions(rows, rigid, dimension, phase, start.time)?;
    let rows = with_directions(rows, body, rigid, start);
    without_rigid_repetitions(rows, rigid, dimension, phase, start.time)
}

fn row(
    terms: Vec<(usize, f64)>,
    motion: &Motion,
    component: usize,
    start: &PhaseStart,
    mesh: &Mesh,
) -> ConstraintRow {
    let linear = |velocity: f64| RowMotion::Linear {
        start: terms.iter().map(|&(dof, coefficient)| coefficient * start.u[dof]).sum(),
        since: start.time,
        velocity,
    };
    let motion = match motion {
        Motion::Hold => linear(0.0),
        Motion::Together => RowMotion::Linear { start: 0.0, since: 0.0, velocity: 0.0 },
        Motion::Velocity(velocity) => linear(velocity[component]),
        Motion::Path(path) => RowMotion::Path(path.clone()),
        Motion::Spline(spline) => RowMotion::Spline(spline.clone()),
        Motion::Formula(formula) => RowMotion::Formula(formula.clone()),
        Motion::Turn(turn) => RowMotion::Turning(Turning::new(turn, terms[0].0, mesh, start)),
    };
    ConstraintRow { terms, motion, is_of_rigid: false }
}

fn check_axes(axes: &[Axis], dimension: usize) -> Result<(), InputError> {
    match axes.iter().find(|axis| axis.index() >= dimension) {
        Some(axis) => {
            let help = format!("the body has {dimension} dimension(s)");
            Err(InputError::new("axis of a constraint", format!("{axis:?}"), help))
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
    finite("the velocity of moved nodes", velocity)
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
            let help = "it must be a finite number other than 0";
            return Err(InputError::new("coefficient of a constraint row", coefficient, help));
        }
        let node = mesh.select(&[number].into())?[0];
        let dof = node * dimension + axis.index();
        if resolved.iter().any(|&(other, _)| other == dof) {
            let help = "it appears twice in one row; add its coefficients";
            return Err(InputError::new("node of a constraint row", number, help));
        }
        resolved.push((dof, coefficient));
    }
    if resolved.is_empty() {
        return Err(InputError::new("constraint row", "[]", "it needs one term at least"));
    }
    resolved.sort_unstable_by_key(|&(dof, _)| dof);
    Ok(resolved)
}

/// The components of the unit vector along `normal` that are not 0, with their axes; its sign makes the first
/// one positive.
fn direction(normal: &[f64], dimension: usize) -> Result<Vec<(usize, f64)>, InputError> {
    let input = "normal of a symmetry plane";
    finite(input, normal)?;
    let (length, sign) = (norm(normal), normal.iter().find(|n| **n != 0.0).copied());
    if normal.len() != dimension || !(length > 0.0 && length.is_finite()) {
        let help = format!("it needs {dimension} component(s), not all of them 0");
        return Err(InputError::new(input, format!("{normal:?}"), help));
    }
    let length = sign.map_or(1.0, f64::signum) * length;
    let unit = normal.iter().map(|n| n / length).enumerate();
    Ok(unit.filter(|(_, n)| n.abs() > ROUND_OFF).collect())
}

fn check_path(
    row: &ConstraintRow,
    phase: &str,
    dimension: usize,
    t: f64,
) -> Result<(), InputError> {
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

/// The rows without those that others imply already: where two sets of nodes meet, at the ends of edges, both
/// may hold the same nodes.
///
/// # Errors
/// Constraints on the same components that are not known to be the same.
fn without_repetitions(
    rows: Vec<ConstraintRow>,
    dimension: usize,
    phase: &str,
) -> Result<Vec<ConstraintRow>, InputError> {
    let contradiction = |row: &ConstraintRow, first: &str, second: &str| {
        let input = format!("constraints on {} in phase \"{phase}\"", row.label(dimension));
        let help = "they contradict each other: leave one of them out";
        InputError::new(input, format!("{first}, and {second}"), help)
    };
    // keyed by the degrees of freedom and, for general rows, the coefficients
    let mut known: BTreeMap<Vec<(usize, u64)>, &ConstraintRow> = BTreeMap::new();
    let key = |row: &ConstraintRow| match row.terms[..] {
        [(dof, _)] => vec![(dof, 0)],
        _ => row.terms.iter().map(|&(dof, x)| (dof, x.to_bits())).collect(),
    };
    let mut is_kept = Vec::with_capacity(rows.len());
    for row in &rows {
        let first = *known.entry(key(row)).or_insert(row);
        is_kept.push(ptr::eq(first, row));
        if !first.motion.is_same(&row.motion) {
            return Err(contradiction(row, &first.motion.label(), &row.motion.label()));
        }
    }
    for (row, is_kept) in rows.iter().zip(&mut is_kept).filter(|(row, _)| row.terms.len() > 1) {
        let of_term = |&(dof, x): &(usize, f64)| {
            let single = known.get(&vec![(dof, 0)])?;
            Some(x * single.constant_velocity()? / single.terms[0].1)
        };
        let velocities = row.terms.iter().map(of_term).collect::<Option<Vec<f64>>>();
        let (Some(velocities), Some(own)) = (velocities, row.constant_velocity()) else { continue };
        let sum: f64 = velocities.iter().sum();
        if (sum - own).abs() > ROUND_OFF * velocities.iter().map(|v| v.abs()).sum::<f64>() {
            let first = format!("moved at {sum} m/s in all, one by one");
            return Err(contradiction(row, &first, &format!("together {}", row.motion.label())));
        }
        *is_kept = false;
    }
    let kept = rows.iter().zip(is_kept).filter(|(_, is_kept)| *is_kept);
    Ok(kept.map(|(row, _)| row.clone()).collect())
}

/// Times (s) after the start of a phase at which motions of the nodes of a rigid piece are compared.
const LOOKS: [f64; 4] = [0.0, 0.013, 0.37, 2.9];

/// The rows without those that others imply because nodes of a rigid piece move together: where a whole edge of it is
/// held, two of its nodes hold the others.
///
/// # Errors
/// Nodes of a rigid piece that are moved in different ways.
fn without_rigid_repetitions(
    rows: Vec<ConstraintRow>,
    rigid: &RigidPieces,
    dimension: usize,
    phase: &str,
    time: f64,
) -> Result<Vec<ConstraintRow>, InputError> {
    let of_row = |row: &ConstraintRow| independent_terms(&row.terms, Some(rigid), dimension);
    let of_rigid = rows.iter().filter(|row| row.is_of_rigid).flat_map(of_row);
    let mut places: Vec<usize> = of_rigid.map(|(dof, _)| dof).collect();
    places.sort_unstable();
    places.dedup();
    // directions that are orthonormal, with what those rows prescribe together
    let mut known: Vec<(Vec<f64>, [f64; 2 * LOOKS.len()])> = Vec::new();
    let mut kept = Vec::with_capacity(rows.len());
    // of all motions, as a node about which a piece turns has none
    let mut largest = 0.0_f64;
    for row in rows {
        let mut rest = vec![0.0; places.len()];
        let terms = of_row(&row);
        let place = |dof: &usize| places.binary_search(dof).ok();
        let is_beside =
            !row.is_of_rigid && row.nodal().is_none_or(|(dof, _)| place(&dof).is_none());
        if is_beside {
            kept.push(row);
            continue;
        }
        for (dof, c) in terms {
            place(&dof).into_iter().for_each(|place| rest[place] = c);
        }
        let size = norm(&rest);
        let mut motion = [0.0; 2 * LOOKS.len()];
        for (at, after) in motion.chunks_exact_mut(2).zip(LOOKS) {
            let Prescribed { displacement, velocity, .. } = row.prescribed(time + after);
            at.copy_from_slice(&[displacement, velocity]);
        }
        largest = motion.iter().fold(largest, |most, b| most.max(b.abs()));
        for _ in 0..2 {
            for (direction, own) in &known {
                let part = dot(direction, &rest);
                rest.iter_mut().zip(direction).for_each(|(x, e)| *x -= part * e);
                motion.iter_mut().zip(own).for_each(|(b, own)| *b -= part * own);
            }
        }
        let left = norm(&rest);
        if left > NOTHING_NEW * size {
            rest.iter_mut().for_each(|x| *x /= left);
            known.push((rest, motion.map(|b| b / left)));
            kept.push(row);
        } else if motion.iter().any(|b| b.abs() > NOTHING_NEW * largest) {
            let input = format!("constraint on {} in phase \"{phase}\"", row.label(dimension));
            let help = "the other nodes of its rigid piece, which are held or moved, too, take it elsewhere: leave one of them out";
            return Err(InputError::new(input, row.motion.label(), help));
        }
    }
    Ok(kept)
}
