//! Two elastic blocks in plane strain, the lower side of the upper one a parabola, and the closed form of their contact
//! (Johnson, *Contact Mechanics*, 1985, chapter 4).

use std::f64::consts::PI;

use pliant::{
    Axis, Body, Cells, Equilibrium, Error, Material, Mesh, Phase, Sample, Scene, Statics, Strain,
    Touch, Trajectory,
};

/// Radius R of the parabola (m).
pub const RADIUS: f64 = 0.25;
/// About half the width of the contact (m); 0.02 R, so that strains are small.
pub const ABOUT: f64 = 5e-3;
/// Height of the blocks and half of their width (m).
const SIZE: f64 = 12.0 * ABOUT;
/// Their material; light, so that slow motions are near equilibrium.
const SOFT: Material = Material { density: 1.0, young: 1e6, poisson: 0.3, viscosity: 20.0 };
/// 1/E* = 2 (1 - nu^2)/E
const E_STAR: f64 = 0.5 * SOFT.young / (1.0 - SOFT.poisson * SOFT.poisson);

/// Height of the parabola where the contact ends, about a^2/(2 R) (m).
pub const HEIGHT: f64 = ABOUT * ABOUT / (2.0 * RADIUS);
/// How the blocks are divided, and what their contact is.
#[derive(Clone, Copy)]
pub struct Pressing {
    pub cells: Cells,
    /// Distances of nodes of the upper block across `ABOUT`, and those of the lower one over them.
    pub across: f64,
    pub ratio: f64,
    /// Contact distance D over `HEIGHT`.
    pub distance: f64,
    /// Approach over that at which the contact is about `ABOUT` wide to both sides.
    pub approach: f64,
}

/// Coordinate (m) on a graded grid: even with `first` per unit up to 1, from there on growing by exp(1.5) per unit.
pub fn graded(s: f64, first: f64) -> f64 {
    let beyond = (s.abs() - 1.0).max(0.0);
    s.signum() * first * (s.abs().min(1.0) + ((1.5 * beyond).exp() - 1.0) / 1.5)
}

/// Where such a grid reaches `far` (m).
pub fn graded_end(far: f64, first: f64) -> f64 {
    1.0 + (1.0 + 1.5 * (far / first - 1.0)).ln() / 1.5
}

impl Pressing {
    fn block(&self, lower: bool) -> Result<Body, Error> {
        let (wide, high) = (1.6 * ABOUT, 0.5 * ABOUT);
        let per_cell =
            if matches!(self.cells, Cells::Triangles6 | Cells::Rectangles9) { 2.0 } else { 1.0 };
        let side = per_cell * ABOUT / self.across * if lower { self.ratio } else { 1.0 };
        let [ex, ey] = [wide, high].map(|first| graded_end(SIZE, first));
        let columns = 2 * (ex * wide / side).round() as usize;
        let rows = (ey * high / side).round() as usize;
        let mesh = Mesh::rectangle([2.0 * ex, ey], [columns + 1, rows + 1], self.cells)?;
        let gap = self.distance * HEIGHT;
        let mesh = mesh.mapped(|s| {
            let x = graded(s[0] - ex, wide);
            if lower {
                return [x, -graded(ey - s[1], high)];
            }
            let bottom = x * x / (2.0 * RADIUS);
            let y = graded(s[1], high);
            [x, gap + y + bottom * (1.0 - y / SIZE)]
        })?;
        let body = Body::new(mesh, SOFT).thickness(1.0).strain(Strain::Cauchy);
        Ok(body.named(if lower { "lower" } else { "upper" }).build()?)
    }

    /// Scene of both blocks in a `phase`, in which the lower one is held.
    pub fn scene(&self, touch: Touch, phase: Phase) -> Result<Scene, Error> {
        let body = Body::join([self.block(true)?, self.block(false)?])?;
        Ok(Scene::new(body).touch(touch).phase(phase.hold("lower/bottom")))
    }

    /// Their contact, without friction.
    pub fn touch(&self) -> Touch {
        Touch::between(["lower", "upper"]).distance(self.distance * HEIGHT)
    }

    /// The upper block pressed down.
    pub fn pressed(&self) -> Result<Equilibrium, Error> {
        let far = (2.0 * SIZE / ABOUT).ln();
        let approach = HEIGHT * (self.approach * far - 0.3 * self.approach + 0.7 * self.distance);
        let phase = Phase::until(1.0).hold_axes("upper/top", [Axis::X]).move_axis(
            "upper/top",
            Axis::Y,
            -approach,
        );
        self.scene(self.touch(), phase)?.equilibrium(&Statics { rtol: 1e-8, ..Statics::default() })
    }
}

/// Hertz's contact of two cylinders under a force P (N/m).
pub struct Hertz {
    pub half_width: f64,
    /// Largest pressure (Pa).
    pub peak: f64,
}

impl Hertz {
    pub fn under(force: f64) -> Self {
        let half_width = (4.0 * force * RADIUS / (PI * E_STAR)).sqrt();
        Self { half_width, peak: 2.0 * force / (PI * half_width) }
    }

    /// Force (N/m) between the middle and `x` (m), of a distribution sqrt(1 - x^2/c^2) of which the largest is 1 Pa.
    pub fn within(x: f64, c: f64) -> f64 {
        let s = (x / c).clamp(-1.0, 1.0);
        0.5 * c * (s * (1.0 - s * s).sqrt() + s.asin())
    }

    /// Mean pressure (Pa) over a length (m).
    pub fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        let a = self.half_width;
        self.peak * (Self::within(to, a) - Self::within(from, a)) / (to - from)
    }
}

/// The nodes of a set from left to right.
pub fn from_left_to_right(mesh: &Mesh, set: &str) -> Result<Vec<usize>, Error> {
    let mut nodes = mesh.select(&set.into())?;
    nodes.sort_by(|&a, &b| mesh.position(a)[0].total_cmp(&mesh.position(b)[0]));
    Ok(nodes)
}

/// One of the surfaces that touch: its nodes from left to right.
pub struct Surface {
    /// Undeformed positions (m).
    pub x: Vec<f64>,
    /// Forces per thickness (N/m) into the body.
    pub presses: Vec<f64>,
    /// Pressure (Pa) by the stress at the nodes.
    stresses: Vec<f64>,
    /// Ends of the cells beside the surface (m), and the pressure (Pa) by their stress.
    cells: Vec<([f64; 2], f64)>,
}

impl Surface {
    pub fn new(motion: &Trajectory, sample: &Sample, lower: bool) -> Result<Self, Error> {
        let (set, sign) = if lower { ("lower/top", -1.0) } else { ("upper/bottom", 1.0) };
        let (body, mesh) = (motion.body(), motion.body().mesh());
        let forces = motion.contact_forces(sample)?;
        let nodes = from_left_to_right(mesh, set)?;
        let fields = body.nodal_fields(&sample.u);
        let of_cells = body.cell_fields(&sample.u);
        let mut cells = Vec::new();
        for (cell, field) in mesh.cells().zip(&of_cells) {
            let on = cell.iter().filter(|node| nodes.contains(node));
            let on: Vec<f64> = on.map(|&node| mesh.position(node)[0]).collect();
            if on.len() > 1 {
                let ends = [
                    on.iter().copied().fold(f64::INFINITY, f64::min),
                    on.iter().copied().fold(f64::NEG_INFINITY, f64::max),
                ];
                cells.push((ends, -field.stress[1][1]));
            }
        }
        Ok(Self {
            x: nodes.iter().map(|&node| mesh.position(node)[0]).collect(),
            presses: nodes.iter().map(|&node| sign * forces[2 * node + 1]).collect(),
            stresses: nodes.iter().map(|&node| -fields[node].stress[1][1]).collect(),
            cells,
        })
    }

    /// Half the width (m) of the contact, by the second moment of the pressure: P a^2/4 is that of Hertz.
    pub fn half_width(&self) -> f64 {
        2.0 * (self.moment(&self.presses) / self.presses.iter().sum::<f64>()).sqrt()
    }

    /// Second moment (N m) of forces per thickness on its nodes.
    pub fn moment(&self, forces: &[f64]) -> f64 {
        forces.iter().zip(&self.x).map(|(force, x)| force * x * x).sum()
    }

    /// How far the forces on single nodes that lie within 0.85 a are off at most, over the length that a node stands for: the
    /// integral of its shape function N_i. Exact is the integral of N_i p.
    fn off_at_nodes(&self, hertz: &Hertz) -> f64 {
        let near = (0..self.x.len()).filter(|&i| self.x[i].abs() < 0.85 * hertz.half_width);
        let off = near.map(|i| {
            let [length, exact] = self.integrals(i, hertz);
            (self.presses[i] - exact).abs() / length
        });
        off.fold(0.0, f64::max)
    }

    /// The integrals of the shape function of a node, and of that times the exact pressure.
    fn integrals(&self, node: usize, hertz: &Hertz) -> [f64; 2] {
        const PARTS: usize = 64;
        let at = self.x[node];
        let mut sums = [0.0; 2];
        for &([from, to], _) in
            self.cells.iter().filter(|([from, to], _)| (*from..=*to).contains(&at))
        {
            let inside: Vec<f64> =
                self.x.iter().copied().filter(|x| (from..=to).contains(x)).collect();
            let edge = |part: usize| from + (to - from) * part as f64 / PARTS as f64;
            for part in 0..PARTS {
                let ends = [edge(part), edge(part + 1)];
                let x = 0.5 * (ends[0] + ends[1]);
                let others = inside.iter().filter(|other| **other != at);
                let shape: f64 = others.map(|other| (x - other) / (at - other)).product();
                sums[0] += shape * (ends[1] - ends[0]);
                sums[1] += shape * hertz.mean(ends) * (ends[1] - ends[0]);
            }
        }
        sums
    }

    /// Means over some lengths by the forces on three nodes in a row, those at the ends with half of them, for nodes that lie
    /// within 0.85 a.
    pub fn by_threes(&self, forces: &[f64], a: f64) -> Vec<([f64; 2], f64)> {
        let x = &self.x;
        let of = |i: usize| {
            let force = 0.5 * (forces[i - 1] + forces[i + 1]) + forces[i];
            ([x[i - 1], x[i + 1]], force / (x[i + 1] - x[i - 1]))
        };
        (1..x.len() - 1).filter(|&i| x[i].abs() < 0.85 * a).map(of).collect()
    }

    /// How far the pressure is off at most, as a part of the largest: by nodes, by three nodes in a row, by the stress in the
    /// cells beside the surface and by that at its nodes.
    pub fn pressures_off(&self, hertz: &Hertz) -> [f64; 4] {
        let a = hertz.half_width;
        let is_within = |ends: [f64; 2]| ends[0].abs().max(ends[1].abs()) < 0.85 * a;
        let cells: Vec<([f64; 2], f64)> =
            self.cells.iter().filter(|(ends, _)| is_within(*ends)).copied().collect();
        [
            self.off_at_nodes(hertz),
            off(&self.by_threes(&self.presses, a), |ends| hertz.mean(ends)),
            off(&cells, |ends| hertz.mean(ends)),
            off(&self.stresses_within(a), |ends| hertz.mean(ends)),
        ]
        .map(|off| off / hertz.peak)
    }

    /// Stresses at nodes, for the halves of the distances to the next ones.
    fn stresses_within(&self, a: f64) -> Vec<([f64; 2], f64)> {
        let x = &self.x;
        let near = (1..x.len() - 1).filter(|&i| x[i].abs() < 0.85 * a);
        let of = |i: usize| ([0.5 * (x[i - 1] + x[i]), 0.5 * (x[i] + x[i + 1])], self.stresses[i]);
        near.map(of).collect()
    }
}

/// The largest difference from what is exact.
pub fn off(found: &[([f64; 2], f64)], exact: impl Fn([f64; 2]) -> f64) -> f64 {
    found.iter().map(|&(ends, value)| (value - exact(ends)).abs()).fold(0.0, f64::max)
}
