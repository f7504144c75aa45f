//! A system in closed form that may misbehave.

use faer::MatMut;
use pliant::ode::{BandMut, Dae, Failure, MassKind, Ode};

use super::bytes::Bytes;

/// What a planned panic says.
pub const PLANNED: &str = "planned";

/// No run needs so many evaluations: it hangs.
const MOST_EVALUATIONS: u32 = 3_000_000;

/// m_i y_i' = -m_i k_i (y_i - c_i): each unknown tends to c_i by itself. As a DAE the last unknown may be algebraic.
#[derive(Clone, Debug)]
pub struct System {
    rates: Vec<f64>,
    limits: Vec<f64>,
    mass: Option<f64>,
    algebraic: bool,
    roots: usize,
    quadratures: usize,
    is_split: bool,
    parameters: Vec<f64>,
    trouble: Trouble,
    /// The evaluation in which it begins, and whether it lasts.
    begins: u32,
    lasts: bool,
    evaluations: u32,
}

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trouble {
    None,
    Recoverable,
    Fatal,
    NotANumber,
    Infinite,
    Panic,
}

impl System {
    /// A system and its start.
    pub fn read(bytes: &mut Bytes<'_>) -> (Self, Vec<f64>) {
        let n = if bytes.is(20) { 0 } else { 1 + bytes.below(5) };
        let rates = (0..n).map(|_| 10_f64.powi(bytes.below(9) as i32 - 3)).collect();
        let limits = (0..n).map(|_| f64::from(bytes.byte()) / 64.0 - 2.0).collect();
        let trouble = match bytes.below(12) {
            0 => Trouble::Recoverable,
            1 => Trouble::Fatal,
            2 => Trouble::NotANumber,
            3 => Trouble::Infinite,
            4 => Trouble::Panic,
            _ => Trouble::None,
        };
        let system = Self {
            rates,
            limits,
            mass: bytes.is(8).then(|| f64::from(bytes.byte()) / 64.0),
            algebraic: bytes.is(3),
            roots: if bytes.is(3) { bytes.below(4) } else { 0 },
            quadratures: if bytes.is(5) { bytes.below(3) } else { 0 },
            is_split: bytes.is(20),
            parameters: vec![1.0; bytes.below(3)],
            trouble,
            begins: u32::from(bytes.byte() / 4),
            lasts: bytes.is(2),
            evaluations: 0,
        };
        let y0 = (0..n).map(|_| if bytes.is(40) { bytes.number() } else { 0.5 });
        let y0 = y0.collect();
        (system, y0)
    }

    /// y' at the start.
    pub fn slope(&self, _t: f64, y: &[f64]) -> Vec<f64> {
        (0..y.len()).map(|i| self.f(i, y)).collect()
    }

    /// Checks a state at time t against the closed form, as far as any tolerance asked for goes: coarsely.
    pub fn check(&self, t0: f64, y0: &[f64], t: f64, y: &[f64]) {
        // the other things that were asked for may change it
        let plain = self.trouble == Trouble::None && !self.algebraic && self.mass.is_none();
        if !plain || self.parameters.iter().any(|p| *p != 1.0) {
            return;
        }
        for (i, y) in y.iter().enumerate() {
            let (rate, limit) = (self.rates[i], self.limits[i]);
            // where it grows, errors do
            if (t - t0) * rate < -1.0 {
                return;
            }
            let exact = limit + (y0[i] - limit) * (-rate * (t - t0)).exp();
            let error = (y - exact).abs();
            let size = exact.abs().max(y0[i].abs()).max(limit.abs());
            assert!(error <= 2.0 * size, "component {i} is {y}, not {exact}, at {t}: {self:?}");
        }
    }

    /// The right-hand side, without trouble.
    fn f(&self, i: usize, y: &[f64]) -> f64 {
        let factor = self.parameters.first().copied().unwrap_or(1.0);
        -factor * self.rates[i] * (y[i] - self.limits[i])
    }

    fn factor(&self) -> f64 {
        self.mass.unwrap_or(1.0)
    }

    fn slope_of_f(&self, i: usize) -> f64 {
        -self.parameters.first().copied().unwrap_or(1.0) * self.rates[i] * self.factor()
    }

    /// dF/dy + cj dF/dy' of the DAE.
    fn slope_of_residual(&self, i: usize, cj: f64) -> f64 {
        match self.algebraic && i + 1 == self.rates.len() {
            true => 1.0,
            false => cj - self.slope_of_f(i) / self.factor(),
        }
    }

    /// Makes trouble, if it is time, in the numbers that were written.
    fn disturb(&mut self, out: &mut [f64]) -> Result<(), Failure> {
        self.evaluations += 1;
        assert!(self.evaluations < MOST_EVALUATIONS, "it hangs: {self:?}");
        let now = self.evaluations.wrapping_sub(self.begins);
        if now != 0 && !(self.lasts && self.evaluations > self.begins) {
            return Ok(());
        }
        match self.trouble {
            Trouble::None => {}
            Trouble::Recoverable => return Err(Failure::Recoverable("recoverable".into())),
            Trouble::Fatal => return Err(Failure::Fatal("fatal".into())),
            Trouble::NotANumber => out.fill(f64::NAN),
            Trouble::Infinite => out.fill(f64::INFINITY),
            Trouble::Panic => std::panic::panic_any(PLANNED),
        }
        Ok(())
    }
}

/// What ODE and DAE have alike.
macro_rules! alike {
    () => {
        fn root_count(&self) -> usize {
            self.roots
        }

        fn quadrature_count(&self) -> usize {
            self.quadratures
        }

        fn parameters(&self) -> &[f64] {
            &self.parameters
        }

        fn set_parameters(&mut self, values: &[f64]) {
            self.parameters.copy_from_slice(values);
        }
    };
}

impl Ode for System {
    alike!();

    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        for (i, ydot) in ydot.iter_mut().enumerate() {
            *ydot = self.factor() * self.f(i, y);
        }
        self.disturb(ydot)
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        (0..y.len()).for_each(|i| jacobian[(i, i)] = self.slope_of_f(i));
        self.disturb(&mut [])
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        y: &[f64],
        _ydot: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        (0..y.len()).for_each(|i| jacobian[(i, i)] = self.slope_of_f(i));
        self.disturb(&mut [])
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        // the pattern may be any: Newton's iteration has to bear it
        values.iter_mut().zip(&self.rates).for_each(|(value, rate)| *value = -rate);
        self.disturb(values)
    }

    fn jacobian_times(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        for (i, jv) in jv.iter_mut().enumerate() {
            *jv = self.slope_of_f(i) * v[i];
        }
        self.disturb(jv)
    }

    fn newton_setup(
        &mut self,
        _t: f64,
        _y: &[f64],
        _ydot: &[f64],
        _gamma: f64,
        reuse: bool,
    ) -> Result<bool, Failure> {
        self.disturb(&mut [])?;
        Ok(!reuse)
    }

    fn newton_solve(&mut self, gamma: f64, r: &mut [f64]) -> Result<(), Failure> {
        for (i, r) in r.iter_mut().enumerate() {
            *r /= 1.0 - gamma * self.slope_of_f(i);
        }
        self.disturb(r)
    }

    fn project(
        &mut self,
        _t: f64,
        _y: &[f64],
        correction: &mut [f64],
        _error: &mut [f64],
    ) -> Result<(), Failure> {
        correction.fill(0.0);
        self.disturb(correction)
    }

    fn is_split(&self) -> bool {
        self.is_split
    }

    fn explicit_rhs(&mut self, _t: f64, _y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.fill(0.0);
        self.disturb(ydot)
    }

    fn mass_kind(&self) -> MassKind {
        if self.mass.is_some() { MassKind::Constant } else { MassKind::Identity }
    }

    fn dense_mass(&mut self, _t: f64, mut mass: MatMut<'_, f64>) -> Result<(), Failure> {
        (0..self.rates.len()).for_each(|i| mass[(i, i)] = self.factor());
        self.disturb(&mut [])
    }

    fn banded_mass(&mut self, _t: f64, mut mass: BandMut<'_>) -> Result<(), Failure> {
        (0..self.rates.len()).for_each(|i| mass[(i, i)] = self.factor());
        self.disturb(&mut [])
    }

    fn sparse_mass(&mut self, _t: f64, values: &mut [f64]) -> Result<(), Failure> {
        values.fill(self.factor());
        self.disturb(values)
    }

    fn roots(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        let y = y.first().copied().unwrap_or(t);
        g.iter_mut().enumerate().for_each(|(i, g)| *g = y - 0.25 * i as f64);
        self.disturb(g)
    }

    fn quadratures(&mut self, t: f64, y: &[f64], qdot: &mut [f64]) -> Result<(), Failure> {
        qdot.fill(y.first().copied().unwrap_or(t));
        self.disturb(qdot)
    }
}

impl Dae for System {
    alike!();

    fn residual(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> Result<(), Failure> {
        for (i, residual) in residual.iter_mut().enumerate() {
            *residual = match self.algebraic && i + 1 == y.len() {
                true => y[i] - y[0],
                false => yp[i] - self.f(i, y),
            };
        }
        self.disturb(residual)
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut jacobian: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        (0..y.len()).for_each(|i| jacobian[(i, i)] = self.slope_of_residual(i, cj));
        self.disturb(&mut [])
    }

    fn banded_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        mut jacobian: BandMut<'_>,
    ) -> Result<(), Failure> {
        (0..y.len()).for_each(|i| jacobian[(i, i)] = self.slope_of_residual(i, cj));
        self.disturb(&mut [])
    }

    fn sparse_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Failure> {
        values.iter_mut().zip(&self.rates).for_each(|(value, rate)| *value = cj + rate);
        self.disturb(values)
    }

    fn jacobian_times(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        v: &[f64],
        jv: &mut [f64],
    ) -> Result<(), Failure> {
        for (i, jv) in jv.iter_mut().enumerate() {
            *jv = self.slope_of_residual(i, cj) * v[i];
        }
        self.disturb(jv)
    }

    fn newton_setup(&mut self, _t: f64, _cj: f64, _y: &[f64], _yp: &[f64]) -> Result<(), Failure> {
        self.disturb(&mut [])
    }

    fn newton_solve(&mut self, r: &mut [f64]) -> Result<(), Failure> {
        self.disturb(r)
    }

    fn roots(&mut self, t: f64, y: &[f64], _yp: &[f64], g: &mut [f64]) -> Result<(), Failure> {
        Ode::roots(self, t, y, g)
    }

    fn quadratures(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        qdot: &mut [f64],
    ) -> Result<(), Failure> {
        Ode::quadratures(self, t, y, qdot)
    }
}
