//! Equations with constraints in forms of different index: a pendulum and a pressed square.

use std::f64::consts::PI;

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, MatMut};
use pliant::ode::{Dae, Failure};
use pliant::samples::{Pendulum, SQUARE_MATERIAL};
use pliant::{Body, Cells, InputError, Mesh, Prescribed, Strain};

use super::Outcome;
use super::linear::Linear;

/// How the constraint R = 0 enters the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// R = 0.
    Three,
    /// R' = 0.
    Two,
    /// R = 0 and R' = 0, with a second multiplier in u' = v + A eta (C. W. Gear, G. K. Gupta,
    /// B. Leimkuhler, "Automatic integration of Euler-Lagrange equations with constraints", 1985).
    StabilizedTwo,
    /// R'' = 0.
    One,
    /// R'' + 2 alpha R' + alpha^2 R = 0.
    StabilizedOne,
}

impl Form {
    /// All forms.
    pub const ALL: [Self; 5] =
        [Self::Three, Self::Two, Self::StabilizedTwo, Self::One, Self::StabilizedOne];

    /// Name of the form.
    pub fn name(self) -> &'static str {
        match self {
            Self::Three => "index 3",
            Self::Two => "index 2",
            Self::StabilizedTwo => "index 2, stabilized (GGL)",
            Self::One => "index 1",
            Self::StabilizedOne => "index 1, stabilized",
        }
    }

    /// Equation in place of the constraint, from R, R' and R''.
    fn equation(self, [r, rate, second]: [f64; 3]) -> f64 {
        match self {
            Self::Three => r,
            Self::Two | Self::StabilizedTwo => rate,
            Self::One => second,
            Self::StabilizedOne => second + 2.0 * ALPHA * rate + ALPHA * ALPHA * r,
        }
    }
}

/// Rate of the stabilization of index 1 (1/s).
const ALPHA: f64 = 10.0;

/// A pendulum in Cartesian coordinates: x, y, vx, vy, tension T, and eta in the stabilized form of
/// index 2.
pub struct PendulumForm(pub Form);

impl Dae for PendulumForm {
    fn residual(&mut self, _t: f64, s: &[f64], sp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        let (x, y, vx, vy, tension) = (s[0], s[1], s[2], s[3], s[4]);
        let eta = if self.0 == Form::StabilizedTwo { s[5] } else { 0.0 };
        r[0] = sp[0] - vx + eta * x;
        r[1] = sp[1] - vy + eta * y;
        r[2] = sp[2] + tension * x;
        r[3] = sp[3] + tension * y + Pendulum::GRAVITY;
        let position = 0.5 * (x * x + y * y - 1.0);
        let second = vx * vx + vy * vy - Pendulum::GRAVITY * y - tension * (x * x + y * y);
        r[4] = self.0.equation([position, x * vx + y * vy, second]);
        if self.0 == Form::StabilizedTwo {
            r[5] = position;
        }
        Ok(())
    }

    fn dense_jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        s: &[f64],
        _sp: &[f64],
        mut j: MatMut<'_, f64>,
    ) -> Result<(), Failure> {
        let (x, y, vx, vy, tension) = (s[0], s[1], s[2], s[3], s[4]);
        for (row, other) in [(0, 2), (1, 3)] {
            j[(row, row)] = cj;
            j[(row, other)] = -1.0;
            j[(other, row)] = tension;
            j[(other, other)] = cj;
        }
        (j[(2, 4)], j[(3, 4)]) = (x, y);
        // of R, R' and R'' by x, y, vx, vy, tension
        let gradients = [
            [x, vx, -2.0 * tension * x],
            [y, vy, -Pendulum::GRAVITY - 2.0 * tension * y],
            [0.0, x, 2.0 * vx],
            [0.0, y, 2.0 * vy],
            [0.0, 0.0, -x * x - y * y],
        ];
        for (unknown, gradient) in gradients.into_iter().enumerate() {
            j[(4, unknown)] = self.0.equation(gradient);
        }
        if self.0 == Form::StabilizedTwo {
            let eta = s[5];
            j[(0, 0)] += eta;
            j[(1, 1)] += eta;
            (j[(0, 5)], j[(1, 5)]) = (x, y);
            (j[(5, 0)], j[(5, 1)]) = (x, y);
        }
        Ok(())
    }
}

/// Time for which the square is pressed (s), and depth (m).
pub const PRESS: [f64; 2] = [0.25, 0.04];

/// The path of the pressed nodes: smooth, but for a jump of b'' at the start.
pub fn path(t: f64) -> Prescribed {
    let [time, depth] = PRESS;
    let (omega, half) = (PI / time, 0.5 * depth);
    Prescribed {
        displacement: -half * (1.0 - (omega * t).cos()),
        velocity: -half * omega * (omega * t).sin(),
        acceleration: -half * omega * omega * (omega * t).cos(),
    }
}

/// Hirai's square.
pub fn square_body() -> Result<Body, InputError> {
    let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
    Body::new(mesh, SQUARE_MATERIAL).strain(Strain::Cauchy).thickness(0.01).build()
}

/// The same square as a DAE in one of the forms: u, v, lambda and, for one of them, eta.
pub struct SquareForm {
    form: Form,
    /// Its matrices.
    pub body: Linear,
    /// Degrees of freedom that are held or led.
    pub rows: Vec<usize>,
}

impl SquareForm {
    /// # Errors
    /// None.
    pub fn new(form: Form) -> Outcome<Self> {
        let nodes = [0, 1, 2, 3, 13, 14];
        let rows = nodes.into_iter().flat_map(|node| [2 * node, 2 * node + 1]).collect();
        Ok(Self { form, body: Linear::new(&square_body()?, &[]), rows })
    }

    /// Prescribed motion of row `row` at time `t`.
    pub fn prescribed(&self, row: usize, t: f64) -> Prescribed {
        let is_led = self.rows[row] >= 26 && self.rows[row] % 2 == 1;
        let rest = Prescribed { displacement: 0.0, velocity: 0.0, acceleration: 0.0 };
        if is_led { path(t) } else { rest }
    }

    fn has_eta(&self) -> bool {
        self.form == Form::StabilizedTwo
    }

    /// Consistent y and y' at t = 0, from M v' - A lambda = 0 and A^T v' = b''.
    pub fn start(&self) -> (Vec<f64>, Vec<f64>) {
        let (n, m) = (self.body.size(), self.rows.len());
        let saddle = Mat::from_fn(n + m, n + m, |i, j| match (i < n, j < n) {
            (true, true) => self.body.inertia[(i, j)],
            (true, false) => -f64::from(self.rows[j - n] == i),
            (false, true) => f64::from(self.rows[i - n] == j),
            (false, false) => 0.0,
        });
        let right = Mat::from_fn(n + m, 1, |i, _| match i.checked_sub(n) {
            Some(row) => self.prescribed(row, 0.0).acceleration,
            None => 0.0,
        });
        let found = PartialPivLu::new(saddle.as_ref()).solve(right);
        let size = 2 * n + m + if self.has_eta() { m } else { 0 };
        let (mut y, mut yp) = (vec![0.0; size], vec![0.0; size]);
        (0..n).for_each(|i| yp[n + i] = found[(i, 0)]);
        (0..m).for_each(|row| y[2 * n + row] = found[(n + row, 0)]);
        (y, yp)
    }
}

impl Dae for SquareForm {
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], r: &mut [f64]) -> Result<(), Failure> {
        let (n, m) = (self.body.size(), self.rows.len());
        let (u, v, lambda) = (&y[..n], &y[n..2 * n], &y[2 * n..2 * n + m]);
        let Linear { inertia, stiffness, damping } = &self.body;
        for i in 0..n {
            r[i] = yp[i] - v[i];
            let row = |j: usize| {
                inertia[(i, j)] * yp[n + j] + damping[(i, j)] * v[j] + stiffness[(i, j)] * u[j]
            };
            r[n + i] = (0..n).map(row).sum();
        }
        for (k, &dof) in self.rows.iter().enumerate() {
            let b = self.prescribed(k, t);
            r[n + dof] -= lambda[k];
            let constraint =
                [u[dof] - b.displacement, v[dof] - b.velocity, yp[n + dof] - b.acceleration];
            r[2 * n + k] = self.form.equation(constraint);
            if self.has_eta() {
                r[dof] -= y[2 * n + m + k];
                r[2 * n + m + k] = constraint[0];
            }
        }
        Ok(())
    }
}
