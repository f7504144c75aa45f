//! Supplied derivatives against differences: right ones pass, each wrong one is named.

use faer::MatMut;
use pliant::{
    ode::{
        BandMut, Dae, Failure, Functional, Ode, Slopes,
        check::{self, CheckError, Storage},
    },
    samples::{Hires, Pollution, Robertson, TransistorAmplifier, VanDerPol},
};

fn sparse(pattern: &pliant::sundials::Pattern) -> Storage<'_> {
    Storage::Sparse {
        column_pointers: pattern.column_pointers(),
        row_indices: pattern.row_indices(),
    }
}

#[test]
fn the_samples_are_right() {
    let y = Hires::REFERENCE.y;
    let (mut hires, pattern) = (Hires::new(), Hires::new().pattern().clone());
    for storage in [Storage::Dense, Storage::Band { lower: 5, upper: 3 }, sparse(&pattern)] {
        check::jacobian(&mut hires, 0.0, y, storage).unwrap();
        check::jacobian(&mut hires, 0.0, &Hires::Y0, storage).unwrap();
    }
    check::jacobian(&mut VanDerPol::new(), 0.0, VanDerPol::REFERENCE.y, Storage::Dense).unwrap();
    let (mut pollution, pattern) = (Pollution::new(), Pollution::new().pattern().clone());
    for storage in [Storage::Dense, sparse(&pattern)] {
        check::jacobian(&mut pollution, 0.0, Pollution::REFERENCE.y, storage).unwrap();
        check::jacobian(&mut pollution, 0.0, &Pollution::Y0, storage).unwrap();
    }
    let y = TransistorAmplifier::REFERENCE.y;
    check::jacobian(&mut TransistorAmplifier, 0.0, y, Storage::Dense).unwrap();
    let pattern = Robertson::new().pattern().clone();
    let (y, yp) = ([0.7, 1e-5, 0.3], [-0.1, 1e-3, 0.2]);
    for cj in [0.0, 3.0, 1e4] {
        for storage in [Storage::Dense, sparse(&pattern)] {
            check::dae_jacobian(&mut Robertson::new(), 0.0, cj, &y, &yp, storage).unwrap();
        }
    }
}

/// y0' = p0 y0 y1, y1' = -p1 exp(y0) with all derivatives, one of which may be wrong.
struct Wrong {
    p: [f64; 2],
    factor: [f64; 6],
}

impl Wrong {
    fn at(place: usize) -> Self {
        let mut factor = [1.0; 6];
        if let Some(factor) = factor.get_mut(place) {
            *factor = 1.001;
        }
        Self { p: [2.0, 0.5], factor }
    }

    fn entries(&self, y: &[f64]) -> [[f64; 2]; 2] {
        [
            [self.p[0] * y[1], self.p[0] * y[0] * self.factor[0]],
            [-self.p[1] * y[0].exp() * self.factor[1], 0.0],
        ]
    }
}

impl Ode for Wrong {
    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&[self.p[0] * y[0] * y[1], -self.p[1] * y[0].exp()]);
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let entries = self.entries(y);
        (0..2).for_each(|i| (0..2).for_each(|j| jacobian[(i, j)] = entries[i][j]));
        Ok(())
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        let entries = self.entries(y);
        (0..2).for_each(|i| jacobian[(i, i)] = entries[i][i]);
        if jacobian.lower() > 0 {
            jacobian[(1, 0)] = entries[1][0];
        }
        if jacobian.upper() > 0 {
            jacobian[(0, 1)] = entries[0][1];
        }
        Ok(())
    }

    fn sensitivity_rhs(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        parameter: usize,
        s: &[f64],
        sdot: &mut [f64],
    ) -> Result<(), Failure> {
        let entries = self.entries(y);
        let own = [[y[0] * y[1] * self.factor[2], 0.0], [0.0, -y[0].exp()]][parameter];
        (0..2).for_each(|i| sdot[i] = entries[i][0] * s[0] + entries[i][1] * s[1] + own[i]);
        Ok(())
    }

    fn adjoint_rhs(
        &mut self,
        _t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let entries = self.entries(y);
        (0..2).for_each(|j| out[j] = entries[0][j] * lambda[0] + entries[1][j] * lambda[1]);
        out[0] *= self.factor[3];
        Ok(())
    }

    fn adjoint_parameters(
        &mut self,
        _t: f64,
        y: &[f64],
        lambda: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let second = -y[0].exp() * lambda[1] * self.factor[4];
        out.copy_from_slice(&[y[0] * y[1] * lambda[0], second]);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

/// y' = f as a residual, with the sensitivities' residual.
impl Dae for Wrong {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        self.rhs(t, y, r)?;
        r.iter_mut().zip(yp).for_each(|(r, yp)| *r = yp - *r);
        Ok(())
    }

    fn sensitivity_residual(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        parameter: usize,
        s: &[f64],
        sp: &[f64],
        r: &mut [f64],
    ) -> Result<(), Failure> {
        self.sensitivity_rhs(t, y, &[], parameter, s, r)?;
        r.iter_mut().zip(sp).for_each(|(r, sp)| *r = sp * self.factor[5] - *r);
        Ok(())
    }

    fn parameters(&self) -> &[f64] {
        &self.p
    }

    fn set_parameters(&mut self, values: &[f64]) {
        self.p.copy_from_slice(values);
    }
}

const Y: [f64; 2] = [1.2, -0.7];
const S: [f64; 2] = [0.3, 0.8];

/// The method and the entry that are off.
fn named(outcome: Result<(), CheckError>) -> Option<(&'static str, (usize, usize))> {
    match outcome {
        Ok(()) => None,
        Err(CheckError::Mismatch { method, entry, .. }) => Some((method, entry)),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn each_wrong_number_is_named() {
    // Wrong by a thousandth: in df0/dy1, df1/dy0, df0/dp0, (df/dy)^T lambda, (df/dp)^T lambda, dF/dy'.
    let jacobian = |place, storage| named(check::jacobian(&mut Wrong::at(place), 0.0, &Y, storage));
    let band = Storage::Band { lower: 1, upper: 1 };
    for (storage, method) in [(Storage::Dense, "dense_jacobian"), (band, "banded_jacobian")] {
        assert_eq!(jacobian(9, storage), None);
        assert_eq!(jacobian(0, storage), Some((method, (0, 1))));
        assert_eq!(jacobian(1, storage), Some((method, (1, 0))));
    }
    // An entry beyond the band has to be zero.
    let narrow = Storage::Band { lower: 1, upper: 0 };
    assert_eq!(jacobian(9, narrow), Some(("banded_jacobian", (0, 1))));

    let rhs = |place| named(check::sensitivity_rhs(&mut Wrong::at(place), 0.0, &Y, &S));
    assert_eq!((rhs(9), rhs(2)), (None, Some(("sensitivity_rhs", (0, 0)))));
    let adjoint = |place| named(check::adjoint_rhs(&mut Wrong::at(place), 0.0, &Y, &S));
    assert_eq!((adjoint(9), adjoint(3)), (None, Some(("adjoint_rhs", (0, 0)))));
    let by_p = |place| named(check::adjoint_parameters(&mut Wrong::at(place), 0.0, &Y, &S));
    assert_eq!((by_p(9), by_p(4)), (None, Some(("adjoint_parameters", (0, 1)))));
    let residual = |place| {
        let (state, sensitivity) = ((&Y[..], &[0.1, 0.4][..]), (&S[..], &[0.6, -0.9][..]));
        named(check::sensitivity_residual(&mut Wrong::at(place), 0.0, state, sensitivity))
    };
    assert_eq!((residual(9), residual(5)), (None, Some(("sensitivity_residual", (0, 0)))));
    // Parameters are put back.
    let mut system = Wrong::at(4);
    check::adjoint_parameters(&mut system, 0.0, &Y, &S).unwrap_err();
    assert_eq!(system.p, Wrong::at(9).p);
}

/// p0 sin y0 + y1 with a slope that may be wrong.
struct Sine(f64, f64);

impl Functional for Sine {
    fn running(
        &mut self,
        _t: f64,
        y: &[f64],
        p: &[f64],
        slopes: Option<Slopes<'_>>,
    ) -> Result<f64, Failure> {
        if let Some(slopes) = slopes {
            slopes.y.copy_from_slice(&[p[0] * y[0].cos() * self.0, 1.0]);
            slopes.p[0] = y[0].sin() * self.1;
        }
        Ok(p[0] * y[0].sin() + y[1])
    }
}

#[test]
fn functionals_and_messages() {
    let functional = |a, b| named(check::functional(&mut Sine(a, b), 0.0, &Y, &[3.0]));
    assert_eq!(functional(1.0, 1.0), None);
    assert_eq!(functional(1.001, 1.0), Some(("running", (0, 0))));
    assert_eq!(functional(1.0, 0.999), Some(("running", (0, 2))));

    let error = check::jacobian(&mut Wrong::at(0), 0.0, &Y, Storage::Dense).unwrap_err();
    println!("{error}");
    assert!(error.to_string().starts_with("dense_jacobian: entry (0, 1) is 2.402"), "{error}");
    // What can not be compared is an error, too.
    let refused = |storage| {
        let error = check::jacobian(&mut Wrong::at(9), 0.0, &Y, storage).unwrap_err();
        assert!(matches!(error, CheckError::Input(_)), "{error}");
    };
    refused(Storage::Band { lower: 2, upper: 0 });
    refused(Storage::Sparse { column_pointers: &[0, 1], row_indices: &[0] });
    refused(Storage::Sparse { column_pointers: &[0, 1, 2], row_indices: &[0, 7] });
    assert!(check::adjoint_rhs(&mut Wrong::at(9), 0.0, &Y, &[1.0]).is_err());
    let mut plain = |_t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot.fill(f64::NAN);
        Ok(())
    };
    let error = check::jacobian(&mut plain, 0.0, &Y, Storage::Dense).unwrap_err();
    assert!(matches!(error, CheckError::Failed(Failure::Fatal(_))), "no Jacobian: {error}");
}
