//! The coefficients of the methods, in the form without products of the Jacobian with vectors.
//!
//! With J = df/dy at the start (t, y) of a step of size h, stage i solves
//!
//! ```text
//! (I - gamma h J) u_i = gamma h f(t + alpha_i h, y + sum_j a_ij u_j) + gamma sum_j c_ij u_j + gamma gamma_i h^2 df/dt
//! ```
//!
//! with j < i (E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", 2nd ed. (HNW II), section
//! IV.7).

/// Most stages of a method.
pub(super) const MOST_STAGES: usize = 6;

/// The coefficients of one method.
#[derive(Debug)]
pub(super) struct Tableau {
    pub(super) name: &'static str,
    pub(super) order: u32,
    pub(super) gamma: f64,
    /// Abscissae of the stages, as fractions of the step.
    pub(super) alpha: &'static [f64],
    /// gamma_i, the weights of df/dt.
    pub(super) gamma_sums: &'static [f64],
    /// Row i holds a_ij.
    pub(super) a: &'static [&'static [f64]],
    /// Row i holds c_ij.
    pub(super) c: &'static [&'static [f64]],
    /// The new solution is y + sum m_i u_i.
    pub(super) m: &'static [f64],
    /// The new solution minus the embedded one, whose order is one less.
    pub(super) e: &'static [f64],
    /// Dense output: y(theta) = (1 - theta) y_0 + theta y_1 + theta (1 - theta) (p + theta q), with p and q
    /// these sums of the u_i.
    pub(super) p: &'static [f64],
    pub(super) q: &'static [f64],
}

/// RODASP2 of order 4(3): L-stable and stiffly accurate, as is the embedded method; of order 2 with any
/// matrix in place of the Jacobian; dense output of order 3 (G. Steinebach, "Improvement of Rosenbrock-Wanner
/// method RODASP", Progress in Differential-Algebraic Equations II, Springer 2020, 165-184).
pub(super) const RODASP2: Tableau = Tableau {
    name: "RODASP2",
    order: 4,
    gamma: 0.25,
    alpha: &[0.0, 0.75, 0.321_448_134_013_046, 0.519_745_732_277_726, 1.0, 1.0],
    gamma_sums: &[0.25, -0.5, -0.189_532_918_363_016, 0.085_612_108_792_769, 0.0, 0.0],
    a: &[
        &[],
        &[3.0],
        &[0.906_377_755_268_814, -0.189_707_390_391_685],
        &[3.758_617_027_739_064, 1.161_741_776_019_525, -0.849_258_085_312_803],
        &[
            7.089_566_927_282_776,
            4.573_591_406_461_604,
            -8.423_496_976_860_259,
            -0.959_280_113_459_775,
        ],
        &[
            7.089_566_927_282_776,
            4.573_591_406_461_604,
            -8.423_496_976_860_259,
            -0.959_280_113_459_775,
            1.0,
        ],
    ],
    c: &[
        &[],
        &[-12.0],
        &[-6.354_581_592_719_008, 0.338_972_550_544_623],
        &[-8.575_016_317_114_033, -7.606_483_992_117_508, 12.224_997_650_124_82],
        &[
            -5.888_975_457_523_102,
            -8.157_396_617_841_82,
            24.805_546_872_612_922,
            12.790_401_512_796_98,
        ],
        &[
            -4.408_651_676_063_871,
            -6.692_003_137_674_639,
            24.625_568_527_593_117,
            16.627_521_966_636_085,
            -5.714_285_714_285_718,
        ],
    ],
    m: &[
        7.089_566_927_282_776,
        4.573_591_406_461_604,
        -8.423_496_976_860_259,
        -0.959_280_113_459_775,
        1.0,
        1.0,
    ],
    e: &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
    p: &[
        -5.323_528_268_423_303,
        -10.042_123_754_867_493,
        17.175_254_928_256_965,
        -5.079_931_171_878_093,
        -0.016_185_991_706_112,
        0.0,
    ],
    q: &[
        6.984_505_741_529_879,
        6.914_061_169_603_662,
        -0.849_178_943_070_653,
        18.104_410_789_349_338,
        -3.516_963_011_559_032,
        0.0,
    ],
};

/// ROS34PW2 of order 3(2): L-stable and stiffly accurate, and of its order with any matrix in place of the
/// Jacobian (J. Rang, L. Angermann, "New Rosenbrock W-methods of order 3 for partial differential algebraic
/// equations of index 1", BIT 45 (2005) 761-787).
///
/// The dense output is of order 2 with any matrix (sum d = 0, sum d alpha = -1/2 and sum d gamma = 0 for its
/// weights d of the stages k_i), and integrates t^2 exactly in the middle of the step.
pub(super) const ROS34PW2: Tableau = Tableau {
    name: "ROS34PW2",
    order: 3,
    gamma: 0.435_866_521_508_459,
    alpha: &[0.0, 0.871_733_043_016_918, 0.731_579_957_788_852_4, 1.0],
    gamma_sums: &[0.435_866_521_508_459, -0.435_866_521_508_459, -0.413_333_376_233_886_5, 0.0],
    a: &[
        &[],
        &[2.0],
        &[1.419_217_317_455_764_7, -0.259_232_211_672_969_7],
        &[4.184_760_482_319_16, -0.285_192_017_355_495_93, 2.294_280_360_279_042],
    ],
    c: &[
        &[],
        &[-4.588_560_720_558_084],
        &[-4.184_760_482_319_16, 0.285_192_017_355_495_93],
        &[-6.368_179_200_128_358, -6.795_620_944_466_836, 2.870_098_604_331_056],
    ],
    m: &[4.184_760_482_319_16, -0.285_192_017_355_495_93, 2.294_280_360_279_042, 1.0],
    e: &[0.277_749_947_647_968_1, -1.403_239_895_175_999, 1.772_630_127_667_550_7, 0.5],
    p: &[
        -2.767_760_088_486_984_4,
        -4.128_621_140_795_745,
        1.435_049_302_165_528_4,
        -2.346_200_217_737_312_2,
    ],
    q: &[0.0; 4],
};

#[cfg(test)]
mod tests {
    use super::{RODASP2, ROS34PW2, Tableau};

    /// The stages k_i with u = Gamma k, in which the conditions of order are written: alpha_ij, gamma_ij, and
    /// weights of sums of the u_i as weights of the k_i.
    struct Stages {
        alpha: Vec<Vec<f64>>,
        gamma: Vec<Vec<f64>>,
    }

    impl Stages {
        /// Gamma^-1 is 1/gamma on the diagonal and -c_ij below it.
        fn of(tableau: &Tableau) -> Self {
            let n = tableau.alpha.len();
            let mut gamma: Vec<Vec<f64>> = Vec::new();
            for (i, c) in tableau.c.iter().enumerate() {
                let entry = |column: usize| {
                    let unit = if i == column { 1.0 } else { 0.0 };
                    let sum: f64 = c.iter().zip(&gamma).map(|(c, row)| c * row[column]).sum();
                    tableau.gamma * (unit + sum)
                };
                let row = (0..n).map(entry).collect();
                gamma.push(row);
            }
            let mut stages = Self { alpha: Vec::new(), gamma };
            stages.alpha = tableau.a.iter().map(|row| stages.weights(row)).collect();
            stages
        }

        fn weights(&self, of_u: &[f64]) -> Vec<f64> {
            let n = self.gamma.len();
            (0..n).map(|j| of_u.iter().zip(&self.gamma).map(|(w, row)| w * row[j]).sum()).collect()
        }

        fn beta(&self) -> Vec<Vec<f64>> {
            let rows = self.alpha.iter().zip(&self.gamma);
            rows.map(|(a, g)| a.iter().zip(g).map(|(a, g)| a + g).collect()).collect()
        }
    }

    fn times(matrix: &[Vec<f64>], x: &[f64]) -> Vec<f64> {
        matrix.iter().map(|row| dot(row, x)).collect()
    }

    fn sums(matrix: &[Vec<f64>]) -> Vec<f64> {
        matrix.iter().map(|row| row.iter().sum()).collect()
    }

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| a * b).collect()
    }

    /// Defects of the conditions for the solution at the part `theta` of a step, by order (HNW II, table
    /// IV.7.1).
    fn defects(stages: &Stages, b: &[f64], theta: f64) -> [Vec<f64>; 4] {
        let (alpha, beta) = (sums(&stages.alpha), stages.beta());
        let rates = sums(&beta);
        let squares = product(&alpha, &alpha);
        let exact = |power: i32, density: f64| theta.powi(power) / density;
        [
            vec![b.iter().sum::<f64>() - theta],
            vec![dot(b, &rates) - exact(2, 2.0)],
            vec![dot(b, &squares) - exact(3, 3.0), dot(b, &times(&beta, &rates)) - exact(3, 6.0)],
            vec![
                dot(b, &product(&squares, &alpha)) - exact(4, 4.0),
                dot(b, &product(&alpha, &times(&stages.alpha, &rates))) - exact(4, 8.0),
                dot(b, &times(&beta, &squares)) - exact(4, 12.0),
                dot(b, &times(&beta, &times(&beta, &rates))) - exact(4, 24.0),
            ],
        ]
    }

    /// The additional ones for a matrix that is not the Jacobian (HNW II, section IV.7, "W-methods").
    fn defects_with_any_matrix(stages: &Stages, b: &[f64], theta: f64) -> [Vec<f64>; 2] {
        let (alpha, gamma) = (sums(&stages.alpha), sums(&stages.gamma));
        [
            vec![dot(b, &alpha) - theta.powi(2) / 2.0, dot(b, &gamma)],
            vec![
                dot(b, &times(&stages.alpha, &alpha)) - theta.powi(3) / 6.0,
                dot(b, &times(&stages.alpha, &gamma)),
                dot(b, &times(&stages.gamma, &alpha)),
                dot(b, &times(&stages.gamma, &gamma)),
            ],
        ]
    }

    fn largest(defects: &[Vec<f64>]) -> f64 {
        defects.iter().flatten().fold(0.0, |most, defect| defect.abs().max(most))
    }

    // Sums of numbers up to 30 that are written with 15 digits after the decimal point.
    const ROUNDING: f64 = 2e-14;

    #[test]
    fn solutions_satisfy_the_conditions_of_their_orders() {
        for tableau in [RODASP2, ROS34PW2] {
            let (stages, order) = (Stages::of(&tableau), tableau.order as usize);
            let b = stages.weights(tableau.m);
            assert!(largest(&defects(&stages, &b, 1.0)[..order]) < ROUNDING, "{}", tableau.name);
            let embedded: Vec<f64> = tableau.m.iter().zip(tableau.e).map(|(m, e)| m - e).collect();
            let defects = defects(&stages, &stages.weights(&embedded), 1.0);
            assert!(largest(&defects[..order - 1]) < ROUNDING, "{}", tableau.name);
            // it must not be of higher order, or its difference would not estimate the error
            assert!(largest(&defects[order - 1..order]) > 1e-3, "{}", tableau.name);
        }
    }

    #[test]
    fn orders_with_any_matrix() {
        for (tableau, order) in [(RODASP2, 2), (ROS34PW2, 3)] {
            let stages = Stages::of(&tableau);
            let defects = defects_with_any_matrix(&stages, &stages.weights(tableau.m), 1.0);
            assert!(largest(&defects[..order - 1]) < ROUNDING, "{}", tableau.name);
        }
    }

    #[test]
    fn dense_output_is_of_one_order_less() {
        for tableau in [RODASP2, ROS34PW2] {
            let stages = Stages::of(&tableau);
            for theta in [0.1, 0.37, 0.5, 0.93] {
                let weight = |i: usize| {
                    let bend = tableau.p[i] + theta * tableau.q[i];
                    theta * (tableau.m[i] + (1.0 - theta) * bend)
                };
                let of_u: Vec<f64> = (0..tableau.m.len()).map(weight).collect();
                let b = stages.weights(&of_u);
                let order = tableau.order as usize - 1;
                let defects = defects(&stages, &b, theta);
                assert!(largest(&defects[..order]) < ROUNDING, "{} {theta}", tableau.name);
                if tableau.order == 3 {
                    let defects = defects_with_any_matrix(&stages, &b, theta);
                    assert!(largest(&defects[..1]) < ROUNDING, "{} {theta}", tableau.name);
                }
            }
        }
    }

    #[test]
    fn sums_of_rows_and_stiff_accuracy() {
        for tableau in [RODASP2, ROS34PW2] {
            let stages = Stages::of(&tableau);
            for (sums, written) in
                [(sums(&stages.alpha), tableau.alpha), (sums(&stages.gamma), tableau.gamma_sums)]
            {
                for (sum, written) in sums.iter().zip(written) {
                    assert!((sum - written).abs() < ROUNDING, "{} {sum} {written}", tableau.name);
                }
            }
            let last = tableau.a.len() - 1;
            assert_eq!(tableau.m[..last], *tableau.a[last], "{}", tableau.name);
            assert_eq!((tableau.m[last], tableau.alpha[last]), (1.0, 1.0), "{}", tableau.name);
        }
    }
}
