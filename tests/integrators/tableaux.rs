//! Runge-Kutta methods by tableaux of the user.

use pliant::{
    ode::{Failure, Ode, split},
    sundials::{Arkode, ArkodeOptions, ButcherTable, Error, Integrator, Tableau},
};

/// y1' = -y2 (1 + t), y2' = y1 (1 + t): a rotation by t + t^2/2.
fn rotation(t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot.copy_from_slice(&[-y[1] * (1.0 + t), y[0] * (1.0 + t)]);
    Ok(())
}

/// The error after `steps` steps of the same size to t = 1.
fn error<S: Ode>(system: S, options: ArkodeOptions, steps: u32) -> f64 {
    let options = options
        .fixed_step(1.0 / f64::from(steps))
        .convergence_coefficient(1e-4)
        .max_iterations(20)
        .max_steps_between_setups(1)
        .max_steps_between_jacobians(1);
    let mut solver = Arkode::new(system, 0.0, &[1.0, 0.0], &options).unwrap();
    (0..steps).for_each(|_| {
        solver.step(2.0).unwrap();
    });
    (solver.y()[0] - 1.5_f64.cos()).hypot(solver.y()[1] - 1.5_f64.sin())
}

const GAMMA: f64 = 0.788_675_134_594_812_9; // (3 + sqrt 3)/6

fn classical() -> Tableau {
    let a: [&[f64]; 4] = [&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]];
    Tableau::new(4, a, [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0])
}

/// The pair (2, 3, 3) of Ascher, Ruuth and Spiteri (1997), section 2.5.
fn pair() -> [Tableau; 2] {
    let b = [0.0, 0.5, 0.5];
    let implicit: [&[f64]; 3] = [&[], &[0.0, GAMMA], &[0.0, 1.0 - 2.0 * GAMMA, GAMMA]];
    let explicit: [&[f64]; 3] = [&[], &[GAMMA], &[GAMMA - 1.0, 2.0 * (1.0 - GAMMA)]];
    [Tableau::new(3, implicit, b), Tableau::new(3, explicit, b)]
}

/// Orders by steps of half the size: those of the tableaux.
#[test]
fn own_methods_have_their_orders() {
    let base = || ArkodeOptions::new(1e-12, 1e-12);
    // Crouzeix's method of two stages
    let a = [vec![GAMMA], vec![1.0 - 2.0 * GAMMA, GAMMA]];
    let crouzeix = Tableau::new(3, a, [0.5, 0.5]);
    let euler = Tableau::new(1, [[0.0]], [1.0]);
    for (name, tableau, order) in
        [("Runge-Kutta", classical(), 4.0), ("Crouzeix", crouzeix, 3.0), ("Euler", euler, 1.0)]
    {
        let [few, many] =
            [100, 200].map(|steps| error(rotation, base().tableau(tableau.clone()), steps));
        let measured = (few / many).log2();
        println!("{name}: {few:.2e} {many:.2e}, order {measured:.2}");
        assert!((measured - order).abs() < 0.1, "{name}: {measured}");
    }
    let half = |t: f64, y: &[f64], ydot: &mut [f64]| {
        rotation(t, y, ydot)?;
        ydot.iter_mut().for_each(|slope| *slope *= 0.5);
        Ok(())
    };
    let [few, many] = [100, 200].map(|steps| {
        let [implicit, explicit] = pair();
        error(split(half, half), base().imex_tableaux(implicit, explicit), steps)
    });
    let measured = (few / many).log2();
    println!("pair: {few:.2e} {many:.2e}, order {measured:.2}");
    assert!((measured - 3.0).abs() < 0.1, "{measured}");
}

/// Coefficients of Bogacki and Shampine, given as those of ARKODE's table are: the same steps and states but for
/// rounding.
#[test]
fn a_known_table_by_its_coefficients() {
    let a: [&[f64]; 4] = [&[], &[0.5], &[0.0, 0.75], &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0]];
    let own = Tableau::new(3, a, [2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0, 0.0])
        .embedded(2, [7.0 / 24.0, 0.25, 1.0 / 3.0, 0.125]);
    let run = |options: &ArkodeOptions| {
        let mut solver = Arkode::new(rotation, 0.0, &[1.0, 0.0], options).unwrap();
        solver.solve_to(3.0).unwrap();
        (solver.y().to_vec(), solver.statistics())
    };
    let options = ArkodeOptions::new(1e-7, 1e-9);
    let (known, expected) = run(&options.clone().table(ButcherTable::explicit(3).unwrap()));
    let (found, statistics) = run(&options.tableau(own));
    assert_eq!(statistics.steps, expected.steps);
    assert_eq!(statistics.evaluations, expected.evaluations);
    assert!(known.iter().zip(found).all(|(a, b)| (a - b).abs() < 1e-11));
}

#[test]
fn unusable_tableaux_are_named() {
    let refused = |options: ArkodeOptions| match Arkode::new(
        split(rotation, rotation),
        0.0,
        &[1.0, 0.0],
        &options,
    ) {
        Err(Error::Input(error)) => error.to_string(),
        other => panic!("{other:?}"),
    };
    let fixed = || ArkodeOptions::new(1e-6, 1e-9).fixed_step(0.1);
    let heun: [&[f64]; 2] = [&[], &[1.0]];
    let own = |tableau: Tableau| refused(fixed().tableau(tableau));
    for (error, says) in [
        (own(Tableau::new(3, heun, [0.5, 0.5])), "orders 2 and"),
        (own(Tableau::new(2, heun, [0.5, 0.5]).embedded(2, [1.0, 0.0])), "2 and 1"),
        (own(Tableau::new(2, heun, [0.5])), "2 rows of a, 1 weights"),
        (own(Tableau::new(2, heun, [])), "a weight for each stage"),
        (own(Tableau::new(2, [[0.0, 1.0], [1.0, 0.0]], [0.5, 0.5])), "row 0"),
        (own(Tableau::new(2, [[0.0, 0.0], [1.0, f64::NAN]], [0.5, 0.5])), "finite"),
        (own(Tableau::new(2, heun, [0.5, 0.5]).embedded(1, [1.0])), "1 embedded weights"),
        (refused(ArkodeOptions::new(1e-6, 1e-9).tableau(classical())), "error estimate"),
        (own(classical()), "split"),
    ] {
        assert!(error.contains(says), "{error}");
    }
    let [implicit, explicit] = pair();
    let pairs = |i: &Tableau, e: &Tableau| refused(fixed().imex_tableaux(i.clone(), e.clone()));
    assert!(pairs(&explicit, &implicit).contains("an implicit and an explicit"));
    assert!(pairs(&implicit, &classical()).contains("same stages"));
    // each of order 3 by itself, but with other nodes
    let kutta: [&[f64]; 3] = [&[], &[0.5], &[-1.0, 2.0]];
    let kutta = Tableau::new(3, kutta, [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]);
    assert!(pairs(&implicit, &kutta).contains("orders"));
    let options = fixed().imex_tableaux(implicit, explicit);
    let error = Arkode::new(rotation, 0.0, &[1.0, 0.0], &options).unwrap_err().to_string();
    assert!(error.contains("two parts"), "{error}");
}
