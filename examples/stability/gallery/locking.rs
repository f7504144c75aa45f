//! Poisson's ratio near 1/2: cells that lock.

use pliant::output::Chart;
use pliant::{Body, Cells, Error, InputError, Material, Mesh, Phase, Scene, Statics, Strain};

use super::Outcome;
use super::linear::Linear;
use super::page::{Page, few};

/// Poisson's ratios, by their distance from 1/2.
pub const DISTANCES: [f64; 6] = [0.2, 0.1, 0.05, 0.01, 1e-3, 1e-4];

/// The cells that are compared.
const CELLS: [Cells; 4] = [Cells::Triangles, Cells::Crossed, Cells::Rectangles, Cells::Triangles6];

/// A beam of 10 x 2 cm in plane strain, divided into `grid` cells.
pub fn beam(cells: Cells, [along, across]: [usize; 2], poisson: f64) -> Result<Body, InputError> {
    let mesh = Mesh::rectangle([0.1, 0.02], [along + 1, across + 1], cells)?;
    let material = Material { density: 1000.0, young: 1e5, poisson, viscosity: 0.0 };
    Body::new(mesh, material).strain(Strain::Cauchy).thickness(0.01).build()
}

/// Deflection (m) of the free end of the beam under 0.01 N, the other end clamped.
pub fn deflection(cells: Cells, grid: [usize; 2], poisson: f64) -> Result<f64, Error> {
    let body = beam(cells, grid, poisson)?;
    let end = body.mesh().select(&"right".into())?;
    let bend = Phase::until(1.0).hold("left").load_total("right", [0.0, -0.01]);
    // 1e-10, the default, is out of reach of the finest mesh near nu = 1/2
    let statics = Statics { rtol: 1e-6, ..Statics::default() };
    let equilibrium = Scene::new(body).phase(bend).equilibrium(&statics)?;
    let u = equilibrium.displacements();
    Ok(end.iter().map(|node| -u[2 * node + 1]).sum::<f64>() / end.len() as f64)
}

/// Largest over least eigenvalue of the stiffness matrix of the clamped beam.
pub fn condition(cells: Cells, grid: [usize; 2], poisson: f64) -> Outcome<f64> {
    let body = beam(cells, grid, poisson)?;
    let held = body.mesh().select(&"left".into())?;
    Linear::new(&body, &held).condition()
}

/// Grid with the same nodes for all cells: those of quadratic triangles are twice as dense.
pub fn grid(cells: Cells, [along, across]: [usize; 2]) -> [usize; 2] {
    match cells {
        Cells::Triangles6 => [along / 2, across / 2],
        _ => [along, across],
    }
}

/// The deflection that finer meshes converge to (m): quadratic triangles on 80 x 16.
pub fn converged(poisson: f64) -> Result<f64, Error> {
    deflection(Cells::Triangles6, [80, 16], poisson)
}

/// The section of the page.
pub fn section(page: &mut Page) -> Outcome<()> {
    page.say("## h. Poisson's ratio near 1/2");
    let nodes = [20, 4];
    page.say(format!(
        "A beam of 10 x 2 cm in plane strain, clamped at one end, 0.01 N at the other, Cauchy strain, statics: \
         the deflection of its end over that of quadratic triangles on 80 x 16 grid cells. All meshes have the nodes \
         of a {} x {} grid (quadratic triangles: {} x {} grid cells with mid nodes), 210 unknowns.",
        nodes[0],
        nodes[1],
        nodes[0] / 2,
        nodes[1] / 2
    ));
    let mut rows = Vec::new();
    let (mut lines, mut conditions) = (vec![Vec::new(); 4], vec![Vec::new(); 4]);
    for distance in DISTANCES {
        let poisson = 0.5 - distance;
        let exact = converged(poisson)?;
        let mut row = vec![format!("{poisson}"), few(1e3 * exact)];
        for (k, cells) in CELLS.into_iter().enumerate() {
            let grid = grid(cells, nodes);
            let part = deflection(cells, grid, poisson)? / exact;
            let condition = condition(cells, grid, poisson)?;
            lines[k].push((distance, part));
            conditions[k].push((distance, condition));
            row.push(format!("{part:.3} / {}", few(condition)));
        }
        rows.push(<[String; 6]>::try_from(row).map_err(|row| format!("{} cells", row.len()))?);
    }
    let names = CELLS.map(Cells::name);
    page.say("Deflection over the converged one / condition number of the stiffness matrix:");
    page.table(["nu", "converged (mm)", names[0], names[1], names[2], names[3]], &rows);
    let chart = |title: &str, y: &str, lines: Vec<Vec<(f64, f64)>>| {
        let chart = Chart::new(title).axes("1/2 - nu", y).logarithmic(true, true);
        names.iter().zip(lines).fold(chart, |chart, (name, line)| chart.marked(*name, line))
    };
    let locked = chart("A beam that locks", "deflection / converged one", lines);
    page.chart("locking", "deflection over Poisson's ratio", &locked)?;
    let conditions = chart("Condition of its stiffness matrix", "condition number", conditions);
    page.chart("locking-condition", "condition number over Poisson's ratio", &conditions)?;

    let poisson = 0.48;
    let exact = converged(poisson)?;
    let mut rows = Vec::new();
    for (grid, quadratic) in
        [([10, 2], [5, 1]), ([20, 4], [10, 2]), ([40, 8], [20, 4]), ([80, 16], [40, 8])]
    {
        let part = |cells| -> Result<String, Error> {
            let grid = if cells == Cells::Triangles6 { quadratic } else { grid };
            Ok(format!("{:.4}", deflection(cells, grid, poisson)? / exact))
        };
        let [triangles, crossed, rectangles, quadratic] = CELLS.map(part);
        rows.push([
            format!("{} x {}", grid[0], grid[1]),
            triangles?,
            crossed?,
            rectangles?,
            quadratic?,
        ]);
    }
    page.say("**Refinement** at nu = 0.48, Hirai's rubber: deflection over the converged one.");
    page.table(["nodes of the grid", names[0], names[1], names[2], names[3]], &rows);
    page.say(
        "**Why.** As nu goes to 1/2, lambda = nu E/((1 + nu)(1 - 2 nu)) grows without bound and forbids any \
         change of volume. A linear triangle has one point and one area to keep; in a mesh whose diagonals all run \
         one way the areas leave hardly a motion that bends it. Rectangles, with full integration, lock later and \
         in the end as hard. Alternating diagonals (`crossed`) do not lock, with the same cells: around each node in \
         the middle of four halved grid cells two of the areas follow from the others. Quadratic triangles have \
         freedom to spare.",
    );
    page.say(
        "The condition number grows with lambda, and the meshes that lock have the better one: locking \
         stiffens the softest shape as well. It costs digits: `Statics` balances forces to 1e-10 by default, \
         which at nu = 0.4999 on 80 x 16 quadratic cells is out of reach, and says that it has not converged; here it is \
         asked for 1e-6.",
    );
    page.say(
        "**What works:** quadratic triangles (`Cells::Triangles6`), or `Cells::Crossed` on a finer grid. With \
         `Triangles` or `Rectangles`, nu = 0.45 is the better lie.",
    );
    Ok(())
}
