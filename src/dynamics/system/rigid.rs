//! Rigid motions of a body, in some shape, that constraints leave free.

use nalgebra::{DMatrix, DVector};

use crate::base::sparse::{NodeMatrix, NodePattern};
use crate::base::vector::{dot, norm};
use crate::elements::body::Body;
use crate::scene::constraint::ConstraintRow;

/// Squares of velocities below this, relative to the largest, are round-off.
const NOTHING: f64 = 1e-12;

/// Resultants of loads below this, relative to the sum of their absolute values, are round-off.
const BALANCED: f64 = 1e-12;

/// The shape of a body.
#[derive(Clone, Copy)]
pub(crate) struct Shape<'a> {
    pub(crate) dimension: usize,
    /// Its size (m).
    pub(crate) size: f64,
    /// Positions (m), dimension components per node.
    pub(crate) positions: &'a [f64],
    /// Whether it is a section of a body of revolution, which is free along its axis alone.
    pub(crate) is_turned: bool,
}

impl<'a> Shape<'a> {
    /// The undeformed body.
    pub(crate) fn natural(body: &'a Body) -> Self {
        let mesh = body.mesh();
        Self {
            dimension: mesh.dimension(),
            size: mesh.size(),
            positions: mesh.positions(),
            is_turned: body.is_axisymmetric(),
        }
    }

    fn position(&self, node: usize) -> &'a [f64] {
        &self.positions[node * self.dimension..][..self.dimension]
    }
}

/// A rigid motion.
pub(crate) struct RigidMotion {
    pub(crate) words: String,
    /// Displacements (m): of a unit along a direction, or of a unit angle about a point.
    pub(crate) values: Vec<f64>,
    pub(crate) is_turn: bool,
    /// The nodes that move.
    nodes: Vec<usize>,
    /// W and t of the displacements W x + t of a node at x, as [W, t; 0, 0].
    generator: DMatrix<f64>,
}

impl RigidMotion {
    /// Moves nodes, with undeformed positions `natural`, by `size` (rad or m) of this motion, turns along
    /// circles, and adds that to the displacements `u`.
    pub(crate) fn carry(&self, size: f64, natural: &[f64], u: &mut [f64]) {
        let order = self.generator.nrows();
        let motion = (&self.generator * size).exp() - DMatrix::identity(order, order);
        for &node in &self.nodes {
            let dofs = node * (order - 1)..(node + 1) * (order - 1);
            let x = at(&natural[dofs.clone()], &u[dofs.clone()]);
            u[dofs].iter_mut().zip((&motion * x).iter()).for_each(|(u, x)| *u += x);
        }
    }

    /// Updates this motion to that of the body with displacements `u`.
    pub(crate) fn move_to(&mut self, natural: &[f64], u: &[f64]) {
        let order = self.generator.nrows();
        for &node in &self.nodes {
            let dofs = node * (order - 1)..(node + 1) * (order - 1);
            let moved = &self.generator * at(&natural[dofs.clone()], &u[dofs.clone()]);
            self.values[dofs].copy_from_slice(&moved.as_slice()[..order - 1]);
        }
    }

    /// Work (J) of nodal forces `f` (N) as the displacements `x` (m) turn by a unit angle of this motion: f . W x.
    pub(crate) fn turned_work(&self, f: &[f64], x: &[f64]) -> f64 {
        let dimension = self.generator.nrows() - 1;
        let work = |&node: &usize| {
            let [f, x] = [f, x].map(|values| &values[node * dimension..][..dimension]);
            let turned =
                |i: usize| (0..dimension).map(|j| self.generator[(i, j)] * x[j]).sum::<f64>();
            (0..dimension).map(|i| f[i] * turned(i)).sum::<f64>()
        };
        self.nodes.iter().map(work).sum()
    }

    /// The resultant along the motion, in words, of the nodal `loads` (N) if they are not in balance, but for this `round_off` (N) of each.
    pub(crate) fn resultant(&self, loads: &[f64], round_off: f64) -> Option<String> {
        let sum = dot(&self.values, loads);
        let terms = self.values.iter().zip(loads);
        let nothing: f64 = terms.map(|(r, f)| r.abs() * (BALANCED * f.abs() + round_off)).sum();
        let what = if self.is_turn { "moment of" } else { "force of" };
        let unit = if self.is_turn { "N m" } else { "N" };
        (sum.abs() > nothing)
            .then(|| format!("loads leave a {what} {sum:.3e} {unit} for {}", self.words))
    }
}

/// (x, 1) of a node.
fn at(natural: &[f64], u: &[f64]) -> DVector<f64> {
    let position = natural.iter().zip(u).map(|(x, u)| x + u);
    DVector::from_iterator(u.len() + 1, position.chain([1.0]))
}

/// Removes the small `motions` from the displacements `u`: R^T M u = 0 after that. `inertia` is M.
pub(crate) fn remove(motions: &[RigidMotion], inertia: &NodeMatrix, u: &mut [f64]) {
    for (motion, part) in motions.iter().zip(parts(motions, inertia, u)) {
        u.iter_mut().zip(&motion.values).for_each(|(u, r)| *u -= part * r);
    }
}

/// The coefficients c of the `motions` R in the displacements `u`: R^T M (u - R c) = 0. `inertia` is M.
pub(crate) fn parts(motions: &[RigidMotion], inertia: &NodeMatrix, u: &[f64]) -> Vec<f64> {
    let Some(first) = motions.first() else { return Vec::new() };
    let dimension = first.values.len() / inertia.pattern().nodes();
    let weigh = |motion: &RigidMotion| {
        let mut product = vec![0.0; motion.values.len()];
        inertia.add_product(dimension, 1.0, &motion.values, &mut product);
        product
    };
    let weighed: Vec<Vec<f64>> = motions.iter().map(weigh).collect();
    let count = motions.len();
    let masses = DMatrix::from_fn(count, count, |i, j| dot(&weighed[i], &motions[j].values));
    let momenta = DVector::from_fn(count, |i, _| dot(&weighed[i], u));
    let parts = masses.cholesky().map(|masses| masses.solve(&momenta));
    parts.map_or(vec![0.0; count], |parts| parts.as_slice().to_vec())
}

/// The rigid motions that `rows` leave free; those of each connected piece of the body.
pub(crate) fn free_motions(
    shape: Shape,
    pattern: &NodePattern,
    rows: &[ConstraintRow],
) -> Vec<RigidMotion> {
    let pieces = pattern.pieces();
    let count = pieces.iter().max().map_or(0, |last| last + 1);
    let mut nodes = vec![Vec::new(); count];
    pieces.iter().enumerate().for_each(|(node, &piece)| nodes[piece].push(node));
    let mut motions = Vec::new();
    for (piece, nodes) in nodes.iter().enumerate() {
        let modes = Modes::new(shape, nodes);
        let inside = |dof: usize| pieces[dof / shape.dimension] == piece;
        for mode in modes.free(shape, rows, inside) {
            let who = match count {
                1 => String::new(),
                _ => format!("the piece with node {} ", nodes[0] + 1),
            };
            motions.push(RigidMotion {
                words: who + &modes.describe(&mode),
                values: modes.displacements(&mode, shape, nodes),
                is_turn: modes.turn(&mode) > 0.0,
                nodes: nodes.clone(),
                generator: modes.generator(&mode),
            });
        }
    }
    motions
}

/// Rigid motions of some nodes: along each axis, then in each plane of two axes about the centre,
/// scaled to displacements of about 1.
struct Modes {
    dimension: usize,
    planes: &'static [[usize; 2]],
    centre: Vec<f64>,
    radius: f64,
    /// Their scalar products with each other.
    products: DMatrix<f64>,
}

impl Modes {
    fn new(shape: Shape, nodes: &[usize]) -> Self {
        let dimension = shape.dimension;
        let mean = |axis| nodes.iter().map(|&n| shape.position(n)[axis]).sum::<f64>();
        let centre: Vec<f64> = (0..dimension).map(|i| mean(i) / nodes.len() as f64).collect();
        let planes: &[[usize; 2]] = match dimension {
            1 => &[],
            2 => &[[0, 1]],
            _ => &[[1, 2], [2, 0], [0, 1]],
        };
        let count = dimension + planes.len();
        let products = DMatrix::zeros(count, count);
        let mut modes = Self { dimension, planes, centre, radius: shape.size, products };
        for &node in nodes {
            for axis in 0..dimension {
                let values: Vec<f64> =
                    (0..count).map(|mode| modes.value(mode, shape.position(node), axis)).collect();
                add_square(&mut modes.products, &values);
            }
        }
        modes
    }

    /// Displacement of a mode at `position` along `axis`.
    fn value(&self, mode: usize, position: &[f64], axis: usize) -> f64 {
        let arm = |i: usize| (position[i] - self.centre[i]) / self.radius;
        match mode.checked_sub(self.dimension).map(|turn| self.planes[turn]) {
            None => f64::from(mode == axis),
            Some([i, j]) if axis == i => -arm(j),
            Some([i, j]) if axis == j => arm(i),
            Some(_) => 0.0,
        }
    }

    /// Coefficients of the modes that `rows` leave free, reduced to echelon form.
    fn free(
        &self,
        shape: Shape,
        rows: &[ConstraintRow],
        inside: impl Fn(usize) -> bool,
    ) -> Vec<Vec<f64>> {
        let count = self.products.nrows();
        let mut hold = DMatrix::zeros(count, count);
        if shape.is_turned {
            // along r circles get longer, and around the plane cones of discs
            for mode in [0, 2] {
                hold[(mode, mode)] = 1.0;
            }
        }
        for row in rows {
            let largest = row.terms.iter().fold(0.0_f64, |most, (_, c)| most.max(c.abs()));
            let mut values = vec![0.0; count];
            for &(dof, c) in row.terms.iter().filter(|(dof, _)| inside(*dof)) {
                let (position, axis) = (shape.position(dof / self.dimension), dof % self.dimension);
                for (mode, value) in values.iter_mut().enumerate() {
                    *value += c / largest * self.value(mode, position, axis);
                }
            }
            add_square(&mut hold, &values);
        }
        // some modes move nothing: the turn of a single node, or of a straight line about its own axis
        let moving = eigenvectors(&self.products, |value, largest| value > NOTHING * largest);
        let held = moving.transpose() * hold * &moving;
        let free = &moving * eigenvectors(&held, |value, largest| value <= NOTHING * largest);
        echelon(free.transpose())
    }

    /// Size of the turn in a mode (rad).
    fn turn(&self, mode: &[f64]) -> f64 {
        norm(&mode[self.dimension..]) / self.radius
    }

    /// Size of a mode (rad, or m without a turn).
    fn size(&self, mode: &[f64]) -> f64 {
        let turn = self.turn(mode);
        if turn > 0.0 { turn } else { norm(mode) }
    }

    /// Displacement in a mode at `position` along `axis`.
    fn displacement(&self, mode: &[f64], position: &[f64], axis: usize) -> f64 {
        let value = |(number, c): (usize, &f64)| c * self.value(number, position, axis);
        mode.iter().enumerate().map(value).sum()
    }

    /// Displacements of the `nodes` in a mode, of unit angle or length; of the other nodes 0.
    fn displacements(&self, mode: &[f64], shape: Shape, nodes: &[usize]) -> Vec<f64> {
        let size = self.size(mode);
        let mut values = vec![0.0; shape.positions.len()];
        for &node in nodes {
            for axis in 0..self.dimension {
                values[node * self.dimension + axis] =
                    self.displacement(mode, shape.position(node), axis) / size;
            }
        }
        values
    }

    /// [W, t; 0, 0] with the displacements W x + t in a mode, of unit angle or length.
    fn generator(&self, mode: &[f64]) -> DMatrix<f64> {
        let (d, size) = (self.dimension, self.size(mode));
        let at = |position: &[f64], axis: usize| self.displacement(mode, position, axis) / size;
        let zero = vec![0.0; d];
        DMatrix::from_fn(d + 1, d + 1, |i, j| match (i < d, j < d) {
            (true, true) => {
                let mut unit = zero.clone();
                unit[j] = 1.0;
                at(&unit, i) - at(&zero, i)
            }
            (true, false) => at(&zero, i),
            (false, _) => 0.0,
        })
    }

    fn describe(&self, mode: &[f64]) -> String {
        let (along, turn) = mode.split_at(self.dimension);
        if turn.iter().all(|&w| w == 0.0) {
            return format!("moving along {}", tuple(along));
        }
        match self.dimension {
            2 => {
                // where the velocity vanishes
                let x = self.centre[0] - along[1] * self.radius / turn[0];
                let y = self.centre[1] + along[0] * self.radius / turn[0];
                let round_off = 1e-9 * self.radius;
                let clean = |x: f64| if x.abs() < round_off { 0.0 } else { x };
                format!("turning about the point {}", tuple(&[clean(x), clean(y)]))
            }
            _ => format!("turning about the direction {}", tuple(turn)),
        }
    }
}

fn add_square(matrix: &mut DMatrix<f64>, values: &[f64]) {
    for i in 0..values.len() {
        for j in 0..values.len() {
            matrix[(i, j)] += values[i] * values[j];
        }
    }
}

/// The eigenvectors whose value, compared to the largest (1 at least), is `wanted`.
fn eigenvectors(matrix: &DMatrix<f64>, wanted: impl Fn(f64, f64) -> bool) -> DMatrix<f64> {
    let eigen = matrix.clone().symmetric_eigen();
    let largest = eigen.eigenvalues.iter().fold(1.0_f64, |most, value| most.max(value.abs()));
    let chosen: Vec<_> = (0..matrix.nrows())
        .filter(|&k| wanted(eigen.eigenvalues[k], largest))
        .map(|k| eigen.eigenvectors.column(k))
        .collect();
    match chosen.is_empty() {
        true => DMatrix::zeros(matrix.nrows(), 0),
        false => DMatrix::from_columns(&chosen),
    }
}

/// The rows of `matrix` reduced so that each has a 1 where the others have 0, from the last column
/// to the first: turns before translations.
fn echelon(mut matrix: DMatrix<f64>) -> Vec<Vec<f64>> {
    let mut done = 0;
    for column in (0..matrix.ncols()).rev() {
        let largest = (done..matrix.nrows())
            .max_by(|&a, &b| matrix[(a, column)].abs().total_cmp(&matrix[(b, column)].abs()));
        let Some(pivot) = largest.filter(|&row| matrix[(row, column)].abs() > 1e-6) else {
            continue;
        };
        matrix.swap_rows(done, pivot);
        let scaled = matrix.row(done) / matrix[(done, column)];
        matrix.set_row(done, &scaled);
        for row in (0..matrix.nrows()).filter(|&row| row != done) {
            let factor = matrix[(row, column)];
            let reduced = matrix.row(row) - &scaled * factor;
            matrix.set_row(row, &reduced);
        }
        done += 1;
    }
    let clean = |x: &f64| if x.abs() < 1e-6 { 0.0 } else { *x };
    matrix.row_iter().map(|row| row.iter().map(clean).collect()).collect()
}

/// Numbers of three digits, without trailing zeros.
fn tuple(numbers: &[f64]) -> String {
    let short = |x: &f64| format!("{x:.2e}").parse().unwrap_or(*x).to_string();
    format!("({})", numbers.iter().map(short).collect::<Vec<_>>().join(", "))
}
