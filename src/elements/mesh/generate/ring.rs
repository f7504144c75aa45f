//! Rings and half-rings.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

use super::check_nodes;
use super::grid::{Cells, Diagonal, Grid};
use crate::base::input::{InputError, positive};
use crate::elements::mesh::Mesh;

impl Mesh {
    /// A ring around the origin with the radii `inner` and `outer` (m) and `nodes` = [around, radial] corner
    /// nodes.
    ///
    /// Stations follow each other counter-clockwise, the first one straight down; the nodes of a station are
    /// numbered from inside out, so that node k (from 0) of station s (from 0) has the number
    /// `s * radial + k + 1`. Node sets are `inner` and `outer`, counter-clockwise from straight down.
    ///
    /// All corner nodes lie on circles, so do mid nodes: edges along the circles of a mesh of
    /// [`Cells::Triangles6`] are curved, and its diagonals a little. So do the nodes of [finer](Mesh::halved)
    /// meshes.
    ///
    /// # Errors
    /// An inner radius that is not above 0 or not below the outer one, fewer than 3 nodes around
    /// or 2 along the radius, an odd number around with [`Cells::Crossed`].
    pub fn ring(
        inner: f64,
        outer: f64,
        nodes: [usize; 2],
        cells: Cells,
    ) -> Result<Self, InputError> {
        let [around, radial] = nodes;
        check_radii("ring", inner, outer)?;
        check_nodes("ring", nodes)?;
        if around < 3 {
            let help = "a ring needs at least 3 nodes around";
            return Err(InputError::new("ring.nodes[0]", around, help));
        }
        if cells == Cells::Crossed && !around.is_multiple_of(2) {
            let help = "crossed diagonals alternate around a ring only if the number is even";
            return Err(InputError::new("ring.nodes[0]", around, help));
        }
        let grid = Grid::new([radial - 1, around], true, cells.mid_nodes());
        let from_below = |step: usize, steps: usize| direction(4 * step + 3 * steps, steps);
        annulus(&grid, [inner, outer], [radial - 1, around], cells, from_below)
    }

    /// The upper half of a ring around the origin, an arch, with the radii `inner` and `outer` (m) and
    /// `nodes` = [around, radial] corner nodes.
    ///
    /// Stations follow each other counter-clockwise from the right end to the left one, numbered as in
    /// [`Mesh::ring`]. Node sets are `inner`, `outer` (from right to left), and the ends `left` and `right`
    /// (from inside out).
    ///
    /// # Errors
    /// An inner radius that is not above 0 or not below the outer one, fewer than 2 nodes around or
    /// along the radius.
    pub fn half_ring(
        inner: f64,
        outer: f64,
        nodes: [usize; 2],
        cells: Cells,
    ) -> Result<Self, InputError> {
        let [around, radial] = nodes;
        check_radii("half_ring", inner, outer)?;
        check_nodes("half_ring", nodes)?;
        let grid = Grid::new([radial - 1, around - 1], false, cells.mid_nodes());
        let from_the_right = |step: usize, steps: usize| direction(2 * step, steps);
        let mesh = annulus(&grid, [inner, outer], [radial - 1, around - 1], cells, from_the_right)?;
        let mesh = grid.name_side(mesh, "right", 1, false)?;
        grid.name_side(mesh, "left", 1, true)
    }
}

/// A mesh of `grid`, wound around the origin: `direction` returns the direction at a step around, given also
/// the number of all steps.
fn annulus(
    grid: &Grid<2>,
    [inner, outer]: [f64; 2],
    cell_counts: [usize; 2],
    cells: Cells,
    direction: impl Fn(usize, usize) -> [f64; 2],
) -> Result<Mesh, InputError> {
    let [across, along] = cell_counts.map(|count| grid.steps * count);
    let position = |[i, j]: [usize; 2]| {
        let share = i as f64 / across as f64;
        let radius = (1.0 - share) * inner + share * outer;
        direction(j, along).map(|x| radius * x)
    };
    let mesh = grid.mesh(cells, Diagonal::Rising, position)?;
    let mesh = grid.name_side(mesh, "inner", 0, false)?;
    Ok(grid.name_side(mesh, "outer", 0, true)?.around_origin())
}

/// Direction at an angle of `count`/`of` quarter turns from x. Whole and half quarter turns are
/// exact, and directions that mirror each other differ in signs and order of their components only.
fn direction(count: usize, of: usize) -> [f64; 2] {
    let nearest = (2 * count + of) / (2 * of);
    let rest = (count as f64 - (nearest * of) as f64) / of as f64;
    let (sin, cos) = match rest.abs() {
        0.5 => (FRAC_1_SQRT_2.copysign(rest), FRAC_1_SQRT_2),
        _ => (rest * FRAC_PI_2).sin_cos(),
    };
    match nearest % 4 {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

fn check_radii(generator: &str, inner: f64, outer: f64) -> Result<(), InputError> {
    positive(&format!("{generator}.inner"), inner, "m")?;
    positive(&format!("{generator}.outer"), outer, "m")?;
    if inner >= outer {
        let help = format!("it must be above the inner radius, {inner} (m)");
        return Err(InputError::new(format!("{generator}.outer"), outer, help));
    }
    Ok(())
}
