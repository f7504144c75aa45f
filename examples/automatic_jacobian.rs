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

use std::{hint::black_box, time::Instant};

use pliant::{
    automatic::{Number, RightHandSide, automatic},
    ode::{Failure, Ode},
    samples::{Brusselator, Hires},
    solve::{Event, Method, Options, Problem, solve},
    sundials::{Cvode, CvodeOptions, Integrator, Jacobian, LinearSolver, Pattern},
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
        for (sphere, sign, rate) in [(0, -1.0, 30.0), (SHELLS, 1.0, 20.0)] {
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

/// HIRES, as [`Hires`] has it with a Jacobian by hand.
struct Plant;

impl RightHandSide for Plant {
    fn rhs<T: Number>(
        &mut self,
        _t: f64,
        y: &[T],
        _p: &[T],
        ydot: &mut [T],
    ) -> Result<(), Failure> {
        let exchange = y[5] * y[7] * 280.0;
        ydot[0] = y[0] * -1.71 + y[1] * 0.43 + y[2] * 8.32 + 0.0007;
        ydot[1] = y[0] * 1.71 - y[1] * 8.75;
        ydot[2] = y[2] * -10.03 + y[3] * 0.43 + y[4] * 0.035;
        ydot[3] = y[1] * 8.32 + y[2] * 1.71 - y[3] * 1.12;
        ydot[4] = y[4] * -1.745 + (y[5] + y[6]) * 0.43;
        ydot[5] = -exchange + y[3] * 0.69 + y[4] * 1.71 - y[5] * 0.43 + y[6] * 0.69;
        ydot[6] = exchange - y[6] * 1.81;
        ydot[7] = -ydot[6];
        Ok(())
    }
}

/// The Brusselator at so many points, as [`Brusselator`] has it.
struct Line(usize);

impl RightHandSide for Line {
    fn rhs<T: Number>(
        &mut self,
        _t: f64,
        y: &[T],
        _p: &[T],
        ydot: &mut [T],
    ) -> Result<(), Failure> {
        let (n, end) = (self.0, (T::from(1.0), T::from(3.0)));
        let c = ((n + 1) * (n + 1)) as f64 / 50.0;
        for i in 0..n {
            let (u, v) = (y[2 * i], y[2 * i + 1]);
            let (left_u, left_v) = if i > 0 { (y[2 * i - 2], y[2 * i - 1]) } else { end };
            let (right_u, right_v) = if i + 1 < n { (y[2 * i + 2], y[2 * i + 3]) } else { end };
            let made = u * u * v;
            ydot[2 * i] = made - u * 4.0 + (left_u - u * 2.0 + right_u) * c + 1.0;
            ydot[2 * i + 1] = u * 3.0 - made + (left_v - v * 2.0 + right_v) * c;
        }
        Ok(())
    }
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

/// Prints a row: steps, evaluations and time of a run by CVODE.
fn row<S: Ode>(
    name: &str,
    make: impl Fn() -> S,
    solver: &LinearSolver,
    y0: &[f64],
    end: f64,
) -> f64 {
    let options = CvodeOptions::new(1e-6, 1e-9).newton(solver.clone());
    let run = || {
        let mut cvode = Cvode::new(make(), 0.0, y0, &options).expect("the options fit");
        cvode.solve_to(end).expect("it comes to its end");
        cvode.statistics()
    };
    let statistics = run();
    let us = time(|| drop(black_box(run())));
    println!(
        "  {name:<14} {:>5} steps {:>4} Jacobians {:>6} evaluations and {:>6} for differences {us:>9.1} us",
        statistics.steps,
        statistics.jacobian_evaluations,
        statistics.evaluations,
        statistics.difference_quotient_evaluations,
    );
    us
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
    let by_hand = row("by hand", Hires::new, &dense(supplied), &Hires::Y0, 321.8122);
    let exact = row("automatic", || automatic(Plant, []), &dense(supplied), &Hires::Y0, 321.8122);
    let quotients = row("differences", Hires::new, &dense(differences), &Hires::Y0, 321.8122);
    ratio(exact, Some(by_hand), quotients);

    let sample = Brusselator::new(500);
    let (pattern, line0) = (sample.pattern(), sample.y0());
    let line = || automatic(Line(500), []).sparse(pattern.clone());
    println!("Brusselator, 1000 unknowns, sparse:");
    let by_hand = row("by hand", || sample.clone(), &klu(pattern, supplied), &line0, 10.0);
    let exact = row("automatic", line, &klu(pattern, supplied), &line0, 10.0);
    let quotients = row("differences", || sample.clone(), &klu(pattern, differences), &line0, 10.0);
    ratio(exact, Some(by_hand), quotients);

    let battery = || automatic(Battery, [current]);
    let pattern = Pattern::ode_by_nan(&mut battery(), 0.0, &y0)?;
    for (name, exact, quotients) in [
        ("dense", dense(supplied), dense(differences)),
        ("sparse", klu(&pattern, supplied), klu(&pattern, differences)),
    ] {
        println!("Battery, {UNKNOWNS} unknowns, {name}:");
        let system = || match name {
            "dense" => battery(),
            _ => battery().sparse(pattern.clone()),
        };
        let exact = row("automatic", system, &exact, &y0, 0.3);
        ratio(exact, None, row("differences", system, &quotients, &y0, 0.3));
    }
    Ok(())
}

fn ratio(automatic: f64, by_hand: Option<f64>, differences: f64) {
    let of_hand =
        by_hand.map_or(String::new(), |time| format!("{:.2} of by hand, ", automatic / time));
    println!("  automatic takes {of_hand}{:.2} of differences", automatic / differences);
}
