//! Central differences on systems of second order, against closed forms and their own promises.

use std::f64::consts::PI;

use pliant::central_difference::{CentralDifference, Integrator, Options, longest_step};
use pliant::ode::{EnergyBalance, Failure, Kick, Rates, SecondOrder};
use pliant::sundials::Reached;

/// Unit masses in a row, with springs of 1 N/m and dampers of `damping` (N s/m) between neighbours and
/// from the last one to a wall. Without `path`, the first one is tied to a wall, too; else it follows
/// displacement and velocity of the path. The integrals are the heat of the dampers and the work of
/// the path.
#[derive(Clone)]
struct Chain {
    masses: usize,
    damping: f64,
    path: Option<fn(f64) -> [f64; 2]>,
    /// Rate that kicks lead the first mass to.
    aim: f64,
    /// Factor on the highest frequency and rate of decay.
    claim: f64,
    watches_energy: bool,
    /// Beyond this time the forces have no meaning.
    ends: f64,
}

fn chain(masses: usize, damping: f64) -> Chain {
    let (path, ends) = (None, f64::INFINITY);
    Chain { masses, damping, path, aim: 0.0, claim: 1.0, watches_energy: false, ends }
}

impl Chain {
    /// Frequency (rad/s) of the k-th vibration, from 1.
    fn frequency(&self, k: usize) -> f64 {
        2.0 * (PI * k as f64 / (2 * self.masses + 2) as f64).sin()
    }

    fn longest_step(&self) -> f64 {
        let frequency = self.frequency(self.masses);
        longest_step(&Rates { frequency, decay: self.damping * frequency * frequency })
    }

    /// Elongations of the springs, or how fast they grow.
    fn elongations<'x>(&self, x: &'x [f64]) -> impl Iterator<Item = f64> + 'x {
        let first = if self.path.is_some() { 0.0 } else { x[0] };
        let between = x.windows(2).map(|pair| pair[1] - pair[0]);
        std::iter::once(first).chain(between).chain([-x[x.len() - 1]])
    }

    fn heat(&self, v: &[f64]) -> f64 {
        self.elongations(v).map(|rate| self.damping.max(0.0) * rate * rate).sum()
    }

    fn stored(&self, u: &[f64], v: &[f64]) -> f64 {
        let springs: f64 = self.elongations(u).map(|e| e * e).sum();
        0.5 * springs + 0.5 * v.iter().map(|v| v * v).sum::<f64>()
    }
}

impl SecondOrder for Chain {
    fn forces(&mut self, t: f64, u: &[f64], v: &[f64], f: &mut [f64]) -> Result<(), Failure> {
        if t > self.ends {
            return Err(Failure::Recoverable("behind the end".into()));
        }
        f.fill(0.0);
        let pulls = self.elongations(u).zip(self.elongations(v));
        for (k, pull) in pulls.map(|(e, rate)| e + self.damping * rate).enumerate() {
            if k < f.len() {
                f[k] -= pull;
            }
            if k > 0 {
                f[k - 1] += pull;
            }
        }
        Ok(())
    }

    fn accelerations(&mut self, kick: &Kick<'_>, a: &mut [f64]) {
        a.copy_from_slice(kick.force);
        if self.path.is_some() {
            a[0] = 0.0;
        }
    }

    fn rates(&mut self, _t: f64, _u: &[f64], _v: &[f64]) -> Rates {
        let frequency = self.claim * self.frequency(self.masses);
        Rates { frequency, decay: self.damping.abs() * frequency * frequency / self.claim }
    }

    fn integrals(&self) -> usize {
        2
    }

    fn powers(&self, v: &[f64], powers: &mut [f64]) {
        (powers[0], powers[1]) = (self.heat(v), 0.0);
    }

    fn balance(&self, _t: f64, u: &[f64], v: &[f64], integrals: &[f64]) -> Option<EnergyBalance> {
        let stored = self.stored(u, v);
        let energy = stored + integrals[0] - integrals[1];
        self.watches_energy.then_some(EnergyBalance { energy, scale: stored + integrals[0] })
    }

    fn aim_at_mean_rates(&mut self, t: f64, h: f64) -> Result<bool, Failure> {
        if let Some(path) = self.path {
            self.aim = (path(t + h)[0] - path(t)[0]) / h;
        }
        Ok(false)
    }

    fn prescribe(&mut self, t: f64, u: &mut [f64], v: &mut [f64]) -> Result<(), Failure> {
        if let Some(path) = self.path {
            [u[0], v[0]] = path(t);
            self.aim = v[0];
        }
        Ok(())
    }

    fn lead(&mut self, kick: &Kick<'_>, after: &mut [f64], work: &mut [f64]) {
        if self.path.is_some() {
            let momentum = self.aim - kick.before[0] - kick.duration * kick.force[0];
            work[1] += 0.5 * momentum * (kick.before[0] + self.aim);
            after[0] = self.aim;
        }
    }
}

/// Equal steps of size `h`, whatever the error.
fn equal_steps(h: f64) -> Options {
    Options::new(0.5, 1e300).max_step(h)
}

/// At rest in the shape of the k-th vibration.
fn displaced(chain: &Chain, k: usize) -> Vec<f64> {
    let angle = |i: usize| PI * (k * (i + 1)) as f64 / (chain.masses + 1) as f64;
    let mut start: Vec<f64> = (0..chain.masses).map(|i| angle(i).sin()).collect();
    start.resize(2 * chain.masses + 2, 0.0);
    start
}

/// One vibration u'' + r u' + omega^2 u = 0 of a chain against its closed form, with heat and work.
#[test]
fn vibrations_are_followed_with_order_two() {
    for damping in [0.0, 0.2] {
        let chain = chain(3, damping);
        let (start, omega, end) = (displaced(&chain, 1), chain.frequency(1), 20.0);
        let half = 0.5 * damping * omega * omega;
        let slow = (omega * omega - half * half).sqrt();
        let exact = (-half * end).exp() * ((slow * end).cos() + half / slow * (slow * end).sin());
        let errors = [200, 400, 800].map(|steps: u32| {
            let options = equal_steps(end / f64::from(steps));
            let mut solver = CentralDifference::new(chain.clone(), 0.0, &start, &options).unwrap();
            solver.set_stop_time(Some(end)).unwrap();
            assert_eq!(solver.solve_to(end).unwrap(), Reached::StopTime);
            assert_eq!(solver.statistics().steps, u64::from(steps));
            let y = solver.y();
            let balance =
                chain.stored(&y[..3], &y[3..6]) + y[6] - chain.stored(&start[..3], &[0.0; 3]);
            [(y[1] - exact).abs(), balance.abs()]
        });
        println!("damping {damping}: errors of u and of the energy {errors:?}");
        for pair in errors.windows(2) {
            for (long, short) in pair[0].iter().zip(pair[1]) {
                // the next terms are (omega h)^2 or less, relative
                assert!((long / short - 4.0).abs() < 0.1, "{damping}: {errors:?}");
            }
        }
    }
}

/// Largest displacement in 4000 steps that are 0.98/claim of the longest stable one, or the first one
/// of more than a million.
fn tremor(masses: usize, damping: f64, claim: f64) -> f64 {
    let chain = Chain { claim, ..chain(masses, damping) };
    let mut start = vec![0.0; 2 * masses + 2];
    (0..masses).for_each(|i| start[i] = (3.7 * (i + 1) as f64).sin());
    let options = Options::new(0.5, 1e300);
    let mut solver = CentralDifference::new(chain, 0.0, &start, &options).unwrap();
    let mut largest = 0.0_f64;
    for _ in 0..4000 {
        solver.step(f64::MAX).unwrap();
        largest = solver.y()[..masses].iter().fold(largest, |most, u| most.max(u.abs()));
        if largest > 1e6 {
            break;
        }
    }
    largest
}

/// The bound is 2/omega without damping, and sharp with it, too.
#[test]
fn stability_ends_where_it_should() {
    for masses in [1, 4, 20] {
        let undamped = chain(masses, 0.0);
        let limit = 2.0 / undamped.frequency(masses);
        assert!((undamped.longest_step() / limit - 1.0).abs() < 1e-15);
        for damping in [0.0, 0.02, 0.5] {
            let [below, above] = [1.0, 0.95].map(|claim| tremor(masses, damping, claim));
            println!("{masses} masses, damping {damping}: {below:.1} below, {above:.1e} above");
            // the start is of size 1; the highest vibration is amplified by 1/sqrt(1 - 0.98^2) = 5
            assert!(below < 6.0 && above > 1e6, "{masses}, {damping}: {below} {above:e}");
        }
    }
}

/// Energy less h^2 a.M a/8 is constant to round-off, whatever the step.
#[test]
fn the_energy_of_the_scheme_is_constant() {
    let mut chain = chain(10, 0.0);
    let h = 0.9 * chain.longest_step();
    let mut start = vec![0.0; 22];
    (0..10).for_each(|i| start[i] = (3.7 * (i + 1) as f64).sin());
    let options = Options::new(0.5, 1e300).max_step(h);
    let mut solver = CentralDifference::new(chain.clone(), 0.0, &start, &options).unwrap();
    let (mut first, mut worst, mut force) = (None, 0.0_f64, [0.0; 10]);
    for _ in 0..20_000 {
        solver.step(f64::MAX).unwrap();
        let (u, v) = (&solver.y()[..10], &solver.y()[10..20]);
        chain.forces(0.0, u, v, &mut force).unwrap();
        let correction = h * h / 8.0 * force.iter().map(|f| f * f).sum::<f64>();
        let energy = chain.stored(u, v) - correction;
        worst = worst.max((energy / *first.get_or_insert(energy) - 1.0).abs());
    }
    println!("{worst:.1e}");
    // steps differ by the round-off of times, 2e-12 s at their end
    assert!(worst < 5e-10, "{worst:e}");
}

/// A mass that is led along 1 - cos t, and another between it and the wall, u'' + 2 u = 1 - cos t:
/// u = 1/2 - cos t + cos(sqrt(2) t)/2. Its spring does the work that the path supplies.
#[test]
fn known_motion_drives_what_is_tied_to_it() {
    let path = |t: f64| [1.0 - t.cos(), t.sin()];
    let chain = Chain { path: Some(path), ..chain(2, 0.0) };
    let end = 10.0_f64;
    let exact = 0.5 - end.cos() + 0.5 * (2.0_f64.sqrt() * end).cos();
    let errors = [200, 400, 800].map(|steps| {
        let options = equal_steps(end / f64::from(steps));
        let mut solver = CentralDifference::new(chain.clone(), 0.0, &[0.0; 6], &options).unwrap();
        solver.set_stop_time(Some(end)).unwrap();
        let mut within = [0.0; 6];
        while solver.last_step().1 < end {
            solver.step(end).unwrap();
            let (start, stop) = solver.last_step();
            let t = start + 0.3 * (stop - start);
            solver.interpolate(t, 0, &mut within).unwrap();
            assert_eq!([within[0], within[2]], path(t));
        }
        let y = solver.y();
        assert_eq!([y[0], y[2]], path(end));
        [(y[1] - exact).abs(), (chain.stored(&y[..2], &y[2..4]) - y[5]).abs()]
    });
    println!("errors of u and of the energy {errors:?}");
    for pair in errors.windows(2) {
        for (long, short) in pair[0].iter().zip(pair[1]) {
            assert!((long / short - 4.0).abs() < 0.1, "{errors:?}");
        }
    }
}

#[test]
fn errors_follow_the_tolerance() {
    let chain = chain(3, 0.1);
    let run = |rtol: f64| {
        let options = Options::new(rtol, rtol);
        let mut solver =
            CentralDifference::new(chain.clone(), 0.0, &displaced(&chain, 1), &options).unwrap();
        solver.solve_to(10.0).unwrap();
        solver.y()[1]
    };
    let exact = run(1e-11);
    let errors = [1e-4, 1e-6, 1e-8].map(|rtol| (run(rtol) - exact).abs());
    println!("{errors:?}");
    for pair in errors.windows(2) {
        // local errors of h^3: global ones go with rtol^(2/3), by 22 for each factor of 100
        assert!((10.0..50.0).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

/// Dampers that push, in no account.
#[test]
fn energy_that_grows_by_itself_is_noticed() {
    let chain = Chain { watches_energy: true, ..chain(4, -0.01) };
    let (start, frequency) = (displaced(&chain, 1), chain.frequency(4));
    let options = Options::new(0.5, 1e300);
    let mut solver = CentralDifference::new(chain, 0.0, &start, &options).unwrap();
    // beyond the second look at the energy, after 258 steps, but not the third one
    solver.solve_to(300.0).unwrap();
    assert!(solver.notice().is_some_and(|notice| notice.contains("energy grew")));
    let longest = longest_step(&Rates { frequency, decay: 0.01 * frequency * frequency });
    let part = solver.statistics().last_step / longest;
    assert!((part - 0.98 * 0.7).abs() < 2e-13, "{part}");
}

#[test]
fn outputs_do_not_change_steps_and_a_restart_repeats_them() {
    let chain = chain(3, 0.1);
    let (start, options) = (displaced(&chain, 1), Options::new(1e-5, 1e-9));
    let mut solver = CentralDifference::new(chain, 0.0, &start, &options).unwrap();
    let mut run = |outputs: u32| {
        solver.reinit(0.0, &start).unwrap();
        solver.set_stop_time(Some(7.0)).unwrap();
        for k in 1..=outputs {
            let t = 7.0 * f64::from(k) / f64::from(outputs);
            let reached = solver.solve_to(t).unwrap();
            assert_eq!(reached, if k < outputs { Reached::Time } else { Reached::StopTime });
            assert_eq!(solver.t(), t);
        }
        (solver.y().to_vec(), solver.statistics())
    };
    assert_eq!(run(1), run(1000));
    // the stop time held once
    assert_eq!(solver.solve_to(8.0).unwrap(), Reached::Time);
}

#[test]
fn only_the_last_step_is_interpolated() {
    let chain = Chain { ends: 3.0, ..chain(3, 0.1) };
    let options = Options::new(1e-5, 1e-9);
    let (before, start, mut y) = (displaced(&chain, 1), displaced(&chain, 2), [0.0; 8]);
    let mut solver = CentralDifference::new(chain, 0.0, &before, &options).unwrap();
    for t in [0.0, 0.5] {
        // before the first step the start alone is known, and after a restart none of the run before
        solver.reinit(t, &start).unwrap();
        assert_eq!(solver.last_step(), (t, t));
        solver.interpolate(t, 0, &mut y).unwrap();
        assert_eq!(y[..], start);
        for other in [0.0, 0.25, 0.5, 0.51] {
            assert!(other == t || solver.interpolate(other, 0, &mut y).is_err());
        }
        solver.solve_to(1.0).unwrap();
    }
    // a step that fails leaves the state where the one before ended, and nothing to interpolate in
    let message = solver.solve_to(4.0).unwrap_err().to_string();
    assert!(message.contains("behind the end"), "{message}");
    let end = solver.t();
    assert!((end - 3.0).abs() < 1e-10 && solver.last_step() == (end, end), "{end}");
    solver.interpolate(end, 0, &mut y).unwrap();
    assert_eq!(y[..], *solver.y());
    assert!(solver.interpolate(end - 1e-6, 0, &mut y).is_err());
}

#[test]
fn bad_input_is_named_with_its_value() {
    let start = |y: &[f64], options: Options| {
        CentralDifference::new(chain(1, 0.0), 0.0, y, &options).map(drop)
    };
    let good = Options::default;
    let cases = [
        (start(&[1.0, 0.0, 0.0], good()), "length of y0 = 3"),
        (start(&[0.0, 0.0], good()), "length of y0 = 2"),
        (start(&[f64::NAN, 0.0, 0.0, 0.0], good()), "y0 = NaN in component 0"),
        (start(&[1.0, 0.0, 0.0, 0.0], Options::new(-1.0, 1e-9)), "rtol = -1"),
    ];
    for (result, expected) in cases {
        let message = result.unwrap_err().to_string();
        assert!(message.starts_with(expected), "{message:?} should start with {expected:?}");
    }
    let mut solver =
        CentralDifference::new(chain(1, 0.0), 0.0, &[1.0, 0.0, 0.0, 0.0], &good()).unwrap();
    for result in [solver.step(-1.0).map(drop), solver.solve_to(-1.0).map(drop)] {
        assert!(result.unwrap_err().to_string().contains("forward"));
    }
}
