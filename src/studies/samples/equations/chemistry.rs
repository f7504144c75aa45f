//! Two standard problems of chemical kinetics: the Oregonator and air pollution.

use faer::MatMut;

use super::{Entries, QUADRUPLE, Reference, jacobians_from_entries, of_unknowns};
use crate::integrators::{
    ode::{BandMut, Failure, Ode},
    sundials::Pattern,
};

/// The Oregonator (OREGO): three species of the Belousov-Zhabotinskii reaction, a limit cycle with
/// sudden jumps over four decades; very stiff.
///
/// R. J. Field, R. M. Noyes, "Oscillations in chemical systems IV", J. Chem. Phys. 60 (1974).
#[derive(Clone, Debug)]
pub struct Oregonator {
    pattern: Pattern,
}

impl Oregonator {
    /// Initial state at t = 0.
    pub const Y0: [f64; 3] = [1.0, 2.0, 3.0];

    /// End state.
    pub const REFERENCE: Reference = Reference {
        t: 360.0,
        y: &[1.000_814_870_318_522_7, 1_228.178_521_549_888, 132.055_494_284_650_83],
        digits: 15,
        source: QUADRUPLE,
    };
}

of_unknowns!(Oregonator, 3);

impl Ode for Oregonator {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot[0] = 77.27 * (y[1] + y[0] * (1.0 - 8.375e-6 * y[0] - y[1]));
        ydot[1] = (y[2] - (1.0 + y[0]) * y[1]) / 77.27;
        ydot[2] = 0.161 * (y[0] - y[2]);
        Ok(())
    }

    jacobians_from_entries!();
}

impl Entries for Oregonator {
    fn entries(y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        put(0, 0, 77.27 * (1.0 - 2.0 * 8.375e-6 * y[0] - y[1]));
        put(0, 1, 77.27 * (1.0 - y[0]));
        put(1, 0, -y[1] / 77.27);
        put(1, 1, -(1.0 + y[0]) / 77.27);
        put(1, 2, 1.0 / 77.27);
        put(2, 0, 0.161);
        put(2, 2, -0.161);
    }
}

/// A reaction: its rate constant, the species whose product is its rate, and how much of which
/// species it makes or uses.
struct Reaction {
    constant: f64,
    rate: &'static [usize],
    change: &'static [(usize, f64)],
}

const fn reaction(
    constant: f64,
    rate: &'static [usize],
    change: &'static [(usize, f64)],
) -> Reaction {
    Reaction { constant, rate, change }
}

/// Air pollution (POLLU): 25 reactions of 20 species; stiff.
///
/// J. G. Verwer, "Gauss-Seidel iteration for stiff ODEs from chemical kinetics", SIAM J. Sci.
/// Comput. 15 (1994).
#[derive(Clone, Debug)]
pub struct Pollution {
    pattern: Pattern,
}

/// Species are counted from 0 here, from 1 in the paper.
const REACTIONS: [Reaction; 25] = [
    reaction(0.35, &[0], &[(0, -1.0), (1, 1.0), (2, 1.0)]),
    reaction(26.6, &[1, 3], &[(0, 1.0), (1, -1.0), (3, -1.0)]),
    reaction(1.23e4, &[4, 1], &[(0, 1.0), (1, -1.0), (4, -1.0), (5, 1.0)]),
    reaction(8.6e-4, &[6], &[(4, 2.0), (6, -1.0), (7, 1.0)]),
    reaction(8.2e-4, &[6], &[(6, -1.0), (7, 1.0)]),
    reaction(1.5e4, &[6, 5], &[(4, 1.0), (5, -1.0), (6, -1.0), (7, 1.0)]),
    reaction(1.3e-4, &[8], &[(4, 1.0), (7, 1.0), (8, -1.0), (9, 1.0)]),
    reaction(2.4e4, &[8, 5], &[(5, -1.0), (8, -1.0), (10, 1.0)]),
    reaction(1.65e4, &[10, 1], &[(0, 1.0), (1, -1.0), (9, 1.0), (10, -1.0), (11, 1.0)]),
    reaction(9e3, &[10, 0], &[(0, -1.0), (10, -1.0), (12, 1.0)]),
    reaction(0.022, &[12], &[(0, 1.0), (10, 1.0), (12, -1.0)]),
    reaction(1.2e4, &[9, 1], &[(0, 1.0), (1, -1.0), (9, -1.0), (13, 1.0)]),
    reaction(1.88, &[13], &[(4, 1.0), (6, 1.0), (13, -1.0)]),
    reaction(1.63e4, &[0, 5], &[(0, -1.0), (5, -1.0), (14, 1.0)]),
    reaction(4.8e6, &[2], &[(2, -1.0), (3, 1.0)]),
    reaction(3.5e-4, &[3], &[(3, -1.0), (15, 1.0)]),
    reaction(0.0175, &[3], &[(2, 1.0), (3, -1.0)]),
    reaction(1e8, &[15], &[(5, 2.0), (15, -1.0)]),
    reaction(4.44e11, &[15], &[(2, 1.0), (15, -1.0)]),
    reaction(1240.0, &[16, 5], &[(4, 1.0), (5, -1.0), (16, -1.0), (17, 1.0)]),
    reaction(2.1, &[18], &[(1, 1.0), (18, -1.0)]),
    reaction(5.78, &[18], &[(0, 1.0), (2, 1.0), (18, -1.0)]),
    reaction(0.0474, &[0, 3], &[(0, -1.0), (3, -1.0), (18, 1.0)]),
    reaction(1780.0, &[18, 0], &[(0, -1.0), (18, -1.0), (19, 1.0)]),
    reaction(3.12, &[19], &[(0, 1.0), (18, 1.0), (19, -1.0)]),
];

impl Pollution {
    /// Initial state at t = 0.
    pub const Y0: [f64; 20] = [
        0.0, 0.2, 0.0, 0.04, 0.0, 0.0, 0.1, 0.3, 0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.007,
        0.0, 0.0, 0.0,
    ];

    /// End state.
    pub const REFERENCE: Reference = Reference {
        t: 60.0,
        y: &[
            5.646_255_480_022_769_5e-2,
            1.342_484_130_422_338_4e-1,
            4.139_734_331_099_427e-9,
            5.523_140_207_484_36e-3,
            2.018_977_262_302_196e-7,
            1.464_541_863_493_965_7e-7,
            7.784_249_118_997_964e-2,
            3.245_075_353_396_018e-1,
            7.494_013_383_880_406e-3,
            1.622_293_157_301_560_5e-8,
            1.135_863_833_257_074_8e-8,
            2.230_505_975_721_36e-3,
            2.087_162_882_798_63e-4,
            1.396_921_016_840_157_7e-5,
            8.964_884_856_898_295e-3,
            4.352_846_369_330_104e-18,
            6.899_219_696_263_405e-3,
            1.007_803_037_365_946e-4,
            1.772_146_513_969_984_4e-6,
            5.682_943_292_316_393e-5,
        ],
        digits: 14,
        source: QUADRUPLE,
    };
}

of_unknowns!(Pollution, 20);

impl Ode for Pollution {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.fill(0.0);
        for Reaction { constant, rate, change } in &REACTIONS {
            let rate = rate.iter().fold(*constant, |product, &i| product * y[i]);
            change.iter().for_each(|&(i, amount)| ydot[i] += amount * rate);
        }
        Ok(())
    }

    jacobians_from_entries!();
}

impl Entries for Pollution {
    /// Several reactions may contribute to one entry.
    fn entries(y: &[f64], mut put: impl FnMut(usize, usize, f64)) {
        let mut jacobian = [[(0.0, false); 20]; 20];
        for Reaction { constant, rate, change } in &REACTIONS {
            for (k, &j) in rate.iter().enumerate() {
                let others = rate.iter().enumerate().filter(|(other, _)| *other != k);
                let slope = others.fold(*constant, |product, (_, &i)| product * y[i]);
                for &(i, amount) in *change {
                    let (value, used) = &mut jacobian[i][j];
                    (*value, *used) = (*value + amount * slope, true);
                }
            }
        }
        for (i, row) in jacobian.iter().enumerate() {
            for (j, (value, used)) in row.iter().enumerate() {
                if *used {
                    put(i, j, *value);
                }
            }
        }
    }
}
