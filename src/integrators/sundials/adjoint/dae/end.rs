//! The initial values of the backward run.

use super::system::{AdjointDae, uneven};
use crate::integrators::{
    common::{Error, check_finite},
    ode::{Dae, Failure, Functional},
    sundials::{
        adjoint::{backward::Point, equations::refused, gradient::Gradient},
        context::Context,
        linear::Linear,
        vector::Vector,
    },
};

/// Finds lambda and lambda' at the end from the slopes of g in `end`, and adds to dG/dp the part that g gets
/// through the algebraic unknowns.
///
/// Let K be dF/dy' in the differential equations and dF/dy in the algebraic ones; it is regular if the index
/// is 1. First K^T (lambda_d, mu) = dg/dy, where mu is the change of g with the algebraic equations, so that
/// dG/dp gets -mu^T dF_a/dp. Then K^T (lambda'_d, -lambda_a) = (dF_d/dy)^T lambda_d - dh/dy, the equations of
/// the backward run.
pub(super) fn start_of_backward_problem<S: Dae, F: Functional>(
    system: &mut AdjointDae<S, F>,
    (t, y, yp): Point<'_>,
    end: &mut Gradient,
    linear: &mut Linear,
    context: &Context,
) -> Result<(Vector, Vector), Error> {
    let failed = |failure| refused("IDA", t, failure);
    system.equations.evaluate_slopes(t, y).map_err(failed)?;
    check_finite("dh/dy at the end", &system.equations.slopes_y)?;
    if system.products.is_none() {
        system.update_jacobian((t, y, yp)).map_err(failed)?;
        check_finite("dF/dy at the end", system.equations.jacobian.values())?;
        if !factorize(system, linear, context)? {
            return Err(failed(singular()));
        }
    }
    let mut solve = |system: &mut AdjointDae<S, F>, b: &mut Vector| match system.products {
        Some(_) => match system.solve_by_products((t, y, yp), b.as_mut_slice())? {
            true => Ok(()),
            false => Err(unsolved()),
        },
        None => solve(linear, b),
    };

    let mut first = Vector::from_slice(&end.initial_state, context)?;
    solve(system, &mut first).map_err(failed)?;
    let (mut lambda, mut mu) = (first.as_slice().to_vec(), first.as_slice().to_vec());
    for (i, algebraic) in system.algebraic.iter().enumerate() {
        *(if *algebraic { &mut lambda[i] } else { &mut mu[i] }) = 0.0;
    }
    let mut by_p = vec![0.0; end.parameters.len()];
    system.by_parameters((t, y, yp), &mu, &mut by_p).map_err(failed)?;
    check_finite("dF/dp at the end", &by_p)?;
    end.parameters.iter_mut().zip(by_p).for_each(|(slope, by_p)| *slope -= by_p);

    let mut rhs = vec![0.0; y.len()];
    system.by_state((t, y, yp), &lambda, &mut rhs).map_err(failed)?;
    rhs.iter_mut().zip(&system.equations.slopes_y).for_each(|(rhs, slope)| *rhs -= slope);
    let mut second = Vector::from_slice(&rhs, context)?;
    solve(system, &mut second).map_err(failed)?;
    let mut slope = second.as_slice().to_vec();
    for (i, _) in system.algebraic.iter().enumerate().filter(|(_, algebraic)| **algebraic) {
        (lambda[i], slope[i]) = (-slope[i], 0.0);
    }
    Ok((Vector::from_slice(&lambda, context)?, Vector::from_slice(&slope, context)?))
}

/// Factorizes K^T. Returns whether it is regular beyond rounding, tested by a known solution.
fn factorize<S, F: Functional>(
    system: &AdjointDae<S, F>,
    linear: &mut Linear,
    context: &Context,
) -> Result<bool, Error> {
    let AdjointDae { equations, mass, algebraic, .. } = system;
    let (jacobian, n) = (&equations.jacobian, algebraic.len());
    let (by_slope, by_state) = (mass.values(), jacobian.values());
    let value = |i: usize, position: usize| match algebraic[i] {
        true => by_state[position],
        false => by_slope[position],
    };
    // SAFETY: the linear solver was made as that of the backward run.
    let factorized = unsafe {
        linear.factorize(&equations.backward, n, |entries| {
            jacobian.write_transposed(&equations.backward, entries, value);
        })
    };
    // the known solution: a number for each equation, in its units
    let mut known = vec![0.0; n];
    jacobian.each_position(|i, _, position| known[i] = value(i, position).abs().max(known[i]));
    known.iter_mut().enumerate().for_each(|(i, largest)| *largest = uneven(i) / *largest);
    let mut vector = Vector::from_slice(&vec![0.0; n], context)?;
    let rhs = vector.as_mut_slice();
    jacobian.each_position(|i, j, position| rhs[j] += value(i, position) * known[i]);
    let solved = factorized && solve(linear, &mut vector).is_ok();
    let found = vector.as_slice().iter().zip(known);
    let mut errors = found.map(|(x, known)| (x / known - 1.0).abs());
    Ok(solved && errors.all(|error| error < 1e-6))
}

fn solve(linear: &mut Linear, b: &mut Vector) -> Result<(), Failure> {
    let is_solved = linear.solve(b) && b.as_slice().iter().all(|x| x.is_finite());
    if is_solved { Ok(()) } else { Err(singular()) }
}

fn unsolved() -> Failure {
    let why = "the linear system where the backward run starts is not solved by 200 iterations of GMRES: choose an \
               incomplete factorization as the preconditioner, or a linear solver with a matrix; or the equations are \
               not of index 1";
    Failure::Fatal(why.into())
}

fn singular() -> Failure {
    let why = "the equations with derivatives do not determine those of the differential unknowns, or the equations \
               without do not determine the algebraic unknowns (index 2 or higher): an adjoint gradient needs both";
    Failure::Fatal(why.into())
}
