//! Exact Jacobians from equations that are written once, over a number type: a battery, and two standard problems beside Jacobians by hand
//! and by differences.
//!
//! ```console
//! $ cargo run --release --example automatic_jacobian
//! ```
//!
//! The battery is a single-particle model: lithium diffuses in one sphere of each electrode, which is cut into shells; the heat of the
//! reactions and of the film resistance warms the cell, which changes the diffusion; and the film on the negative electrode grows. Of its 42
//! unknowns few occur in each equation, but the temperature in all of them.

mod equations;

use std::{hint::black_box, time::Instant};

use equations::{Line, Plant};
use faer::Mat;
use pliant::{
    automatic::{Number, RightHandSide, automatic},
    ode::{Failure, Ode},
    rosenbrock::{self, Rosenbrock},
    samples::{Brusselator, Hires},
    solve::{Event, Method, Options, Problem, solve},
    sundials::{Cvode, CvodeOptions, Error, Integrator, Jacobian, LinearSolver, Pattern},
};

/// Shells of each sphere.
const SHELLS: usize = 20;
/// Unknowns: filling of the shells of both spheres, from the centres outwards; temperature in units of 298.15 K; thickness of the film
/// (10 nm).
const UNKNOWNS: usize = 2 * SHELLS + 2;
const BATTERY_Y0: fn() -> Vec<f64> =
    || [vec![0.8; SHELLS], vec![0.45; SHELLS], vec![1.0, 0.5]].concat();

/// A cell that is discharged; the parameter is the current (C rate, that is, in units of the capacity per hour).
struct Battery;

impl Battery {
    /// Open-circuit potentials of graphite and of an oxide at a filling (V), as smooth fits of their shapes.
    fn potentials<T: Number>(negative: T, positive: T) -> [T; 2] {
        let graphite = (negative * -40.0).exp() * 0.7 + 0.1
            - ((negative - 0.5) / 0.05).tanh() * 0.02
            - ((negative - 0.2) / 0.03).tanh() * 0.04;
        let oxide = -((positive - 0.55) / 0.15).tanh() * 0.15 - positive * 0.5 + 4.2;
        [graphite, oxide]
    }

    /// Overpotential of a reaction at the surface of a sphere (V): Butler and Volmer's law, inverted.
    fn overpotential<T: Number>(current: T, filling: T, temperature: T) -> T {
        let exchange = (filling * (-filling + 1.0)).sqrt() * arrhenius(temperature, 12.0) * 2.0;
        (current / exchange * 0.5).asinh() * temperature * 0.0514
    }
}

/// How much faster something goes than at 298.15 K, whose activation energy is so many R T there.
fn arrhenius<T: Number>(temperature: T, energy: f64) -> T {
    ((-temperature.recip() + 1.0) * energy).exp()
}

impl RightHandSide for Battery {
    fn rhs<T: Number>(&mut self, _t: f64, y: &[T], p: &[T], ydot: &mut [T]) -> Result<(), Failure> {
        let (current, temperature, film) = (p[0], y[2 * SHELLS], y[2 * SHELLS + 1]);
        // per hour: charge leaves the negative sphere and enters the positive one
        for (sphere, sign, rate) in [(0, -1.0, 90.0), (SHELLS, 1.0, 60.0)] {
            let filling = &y[sphere..sphere + SHELLS];
            let mobility = arrhenius(temperature, 14.0) * rate;
            let radius = |k: usize| k as f64 / SHELLS as f64;
            let mut inflow = T::from(0.0);
            for k in 0..SHELLS {
                let volume = (radius(k + 1).powi(3) - radius(k).powi(3)) / 3.0;
                let outflow = if k + 1 < SHELLS {
                    let mean = (filling[k] + filling[k + 1]) * 0.5;
                    let diffusion = mobility * (mean * (-mean + 1.0) + 0.3);
                    let slope = (filling[k] - filling[k + 1]) * SHELLS as f64;
                    diffusion * slope * radius(k + 1).powi(2)
                } else {
                    current * (-sign / 3.0)
                };
                ydot[sphere + k] = (inflow - outflow) / volume;
                inflow = outflow;
            }
        }
        let (negative, positive) = (y[SHELLS - 1], y[2 * SHELLS - 1]);
        let lost = Self::overpotential(current, negative, temperature)
            + Self::overpotential(current, positive, temperature)
            + current * (film * 0.01 + 0.02);
        ydot[2 * SHELLS] = current * lost * 0.1 - (temperature - 1.0) * 4.0;
        let [graphite, _] = Self::potentials(negative, positive);
        ydot[2 * SHELLS + 1] = (graphite * -4.0).exp() * arrhenius(temperature, 20.0) / film * 1e-3;
        Ok(())
    }
}

fn voltage(y: &[f64], current: f64) -> f64 {
    let (negative, positive) = (y[SHELLS - 1], y[2 * SHELLS - 1]);
    let (temperature, film) = (y[2 * SHELLS], y[2 * SHELLS + 1]);
    let [graphite, oxide] = Battery::potentials(negative, positive);
    let lost = Battery::overpotential(current, negative, temperature)
        + Battery::overpotential(current, positive, temperature)
        + current * (film * 0.01 + 0.02);
    oxide - graphite - lost
}

/// The shortest of many times that `work` takes (us).
fn time(mut work: impl FnMut()) -> f64 {
    let mut shortest = f64::INFINITY;
    let start = Instant::now();
    while start.elapsed().as_secs_f64() < 0.3 {
        let before = Instant::now();
        (0..20).for_each(|_| work());
        shortest = shortest.min(before.elapsed().as_secs_f64() / 20.0);
    }
    1e6 * shortest
}

/// A system with a linear solver: one Jacobian in evaluations of the right-hand side, and the times (us) of runs by BDF, which keeps a Jacobian for
/// many steps, and by a Rosenbrock method, which has one in each.
struct Times {
    jacobian: f64,
    runs: [f64; 2],
}

fn times<S: Ode>(
    name: &str,
    make: impl Fn() -> S,
    solver: &LinearSolver,
    (y0, end): (&[f64], f64),
) -> Result<Times, Box<dyn std::error::Error>> {
    let bdf = CvodeOptions::new(1e-6, 1e-9).newton(solver.clone());
    let rosenbrock = rosenbrock::Options::new(1e-6, 1e-9).newton(solver.clone());
    let integrate = |mut solver: Box<dyn Integrator<System = S>>| {
        solver.solve_to(end)?;
        Ok::<_, Error>(solver.statistics())
    };
    let with_bdf = || integrate(Box::new(Cvode::new(make(), 0.0, y0, &bdf)?));
    let with_rosenbrock = || integrate(Box::new(Rosenbrock::new(make(), 0.0, y0, &rosenbrock)?));
    let (of_bdf, of_rosenbrock) = (with_bdf()?, with_rosenbrock()?);
    let runs = [time(|| drop(black_box(with_bdf()))), time(|| drop(black_box(with_rosenbrock())))];

    let (mut system, mut ydot) = (make(), vec![0.0; y0.len()]);
    let evaluation = time(|| drop(black_box(system.rhs(0.0, black_box(y0), &mut ydot))));
    let jacobian = match solver {
        LinearSolver::Dense(Jacobian::Supplied) => {
            let mut matrix = Mat::zeros(y0.len(), y0.len());
            time(|| drop(system.dense_jacobian(0.0, black_box(y0), &ydot, matrix.as_mut())))
                / evaluation
        }
        LinearSolver::Klu { pattern, jacobian: Jacobian::Supplied } => {
            let mut values = vec![0.0; pattern.entry_count()];
            time(|| drop(system.sparse_jacobian(0.0, black_box(y0), &ydot, &mut values)))
                / evaluation
        }
        _ => of_bdf.difference_quotient_evaluations as f64 / of_bdf.jacobian_evaluations as f64,
    };
    println!(
        "  {name:<12} a Jacobian {jacobian:>5.1} evaluations; BDF {:>4} steps {:>4} Jacobians {:>8.0} us; Rosenbrock {:>4} steps {:>8.0} us",
        of_bdf.steps, of_bdf.jacobian_evaluations, runs[0], of_rosenbrock.steps, runs[1],
    );
    Ok(Times { jacobian, runs })
}

/// Prints the time of automatic Jacobians relative to that of others.
fn ratio(automatic: &Times, name: &str, other: &Times) {
    println!(
        "  automatic : {name}: {:.2} for a Jacobian, {:.2} for BDF, {:.2} for Rosenbrock",
        automatic.jacobian / other.jacobian,
        automatic.runs[0] / other.runs[0],
        automatic.runs[1] / other.runs[1]
    );
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // one discharge by `solve`, which uses the Jacobian without being told
    let (y0, current) = (BATTERY_Y0(), 2.0);
    let empty = Event::new(move |_t, y| voltage(y, current) - 3.2).falling().terminal();
    let problem = Problem::ode(automatic(Battery, [current]), y0.clone()).event(empty);
    let solution = solve(problem, Method::Bdf, (0.0, 1.0), &Options::new(1e-6, 1e-9))?;
    let (t, y) = (solution.t()[solution.t().len() - 1], solution.last());
    println!(
        "discharged at 2C: 3.2 V after {:.1} minutes, at {:.1} C",
        60.0 * t,
        298.15 * y[2 * SHELLS] - 273.15
    );

    let dense = |jacobian| LinearSolver::Dense(jacobian);
    let klu =
        |pattern: &Pattern, jacobian| LinearSolver::Klu { pattern: pattern.clone(), jacobian };
    let (supplied, differences) = (Jacobian::Supplied, Jacobian::DifferenceQuotients);

    println!("HIRES, 8 unknowns, dense:");
    let start = (&Hires::Y0[..], 321.8122);
    let by_hand = times("by hand", Hires::new, &dense(supplied), start)?;
    let exact = times("automatic", || automatic(Plant, []), &dense(supplied), start)?;
    let quotients = times("differences", Hires::new, &dense(differences), start)?;
    ratio(&exact, "by hand", &by_hand);
    ratio(&exact, "differences", &quotients);

    println!("Brusselator, 1000 unknowns, sparse:");
    let sample = Brusselator::new(500);
    let (pattern, line0) = (sample.pattern(), sample.y0());
    let (start, line) = ((&line0[..], 10.0), || automatic(Line(500), []).sparse(pattern.clone()));
    let by_hand = times("by hand", || sample.clone(), &klu(pattern, supplied), start)?;
    let exact = times("automatic", line, &klu(pattern, supplied), start)?;
    let quotients = times("differences", || sample.clone(), &klu(pattern, differences), start)?;
    ratio(&exact, "by hand", &by_hand);
    ratio(&exact, "differences", &quotients);

    let battery = || automatic(Battery, [current]);
    let pattern = Pattern::ode_by_nan(&mut battery(), 0.0, &y0)?;
    let start = (&y0[..], 0.2);
    println!("Battery, {UNKNOWNS} unknowns, dense:");
    let exact = times("automatic", battery, &dense(supplied), start)?;
    ratio(&exact, "differences", &times("differences", battery, &dense(differences), start)?);
    println!("Battery, {UNKNOWNS} unknowns, sparse:");
    let sparse = || battery().sparse(pattern.clone());
    let exact = times("automatic", sparse, &klu(&pattern, supplied), start)?;
    let quotients = times("differences", sparse, &klu(&pattern, differences), start)?;
    ratio(&exact, "differences", &quotients);
    Ok(())
}
