//! The arm's shape: a half of it, on one side of the plane through its axis and the inflated chamber, as a grid of hexahedra.
//!
//! The grid runs from the duct outwards, around the axis from the inflated chamber (0 degrees) past a second one (90) to the
//! third (180), and from the base to the tip. Cells inside the chambers are left out.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4};

use pliant::{InputError, Mesh, SolidCells};

/// Dimensions of the section (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    pub radius: f64,
    /// Thickness of the wall between chambers and outside.
    pub outer_wall: f64,
    /// Half of the width of the square duct.
    pub duct: f64,
    /// Thickness of the wall between duct and chambers.
    pub inner_wall: f64,
    /// Thickness of the walls between chambers.
    pub web: f64,
    /// From the clamp to the face of the tip.
    pub length: f64,
    /// Thickness of the bottom that closes the chambers at the tip.
    pub bottom: f64,
}

/// As the data's notes have it; what is guessed there is guessed here.
pub const SHAPE: Shape = Shape {
    radius: 0.0222,
    outer_wall: 0.00203,
    duct: 0.01011 * FRAC_1_SQRT_2,
    inner_wall: 0.00227,
    web: 0.0044,
    length: 0.1,
    bottom: 0.00693,
};

/// How many cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Division {
    /// Along a half of a chamber's breadth.
    pub chamber: usize,
    /// Across a half of a wall between chambers.
    pub web: usize,
    /// Along the height of the chambers.
    pub height: usize,
    /// Along the chambers' length.
    pub along: usize,
}

/// Names of the groups of cells around each chamber.
pub const AROUND: [&str; 3] = ["around 0", "around 1", "around 2"];
/// Their middles, by the angle around the axis.
const ANGLES: [f64; 3] = [0.0, FRAC_PI_2, 2.0 * FRAC_PI_2];

/// The mesh: with the sets `base`, `tip`, `mirror` (the plane of symmetry) and `chamber` (the inner faces of that which is
/// inflated), and a group of cells around each chamber.
pub fn mesh(shape: &Shape, division: Division, kind: SolidCells) -> Result<Mesh, InputError> {
    let counts = [2 + division.height, 4 * division.octant(), division.along + 1];
    let grid = Mesh::cuboid(counts.map(|n| n as f64), counts.map(|n| n + 1), kind)?;
    let at = |node: usize| -> [f64; 3] { std::array::from_fn(|axis| grid.position(node)[axis]) };
    let middle = |cell: &[usize]| -> [f64; 3] {
        let sum = |axis: usize| cell.iter().map(|&node| at(node)[axis]).sum::<f64>();
        std::array::from_fn(|axis| sum(axis) / cell.len() as f64)
    };
    let solid = || grid.cells().filter(|cell| !division.is_hollow(middle(cell)));
    let mut number = vec![None; grid.node_count()];
    let mut places = Vec::new();
    let mut connectivity = Vec::new();
    for &node in solid().flatten() {
        let new = *number[node].get_or_insert_with(|| {
            places.push(at(node));
            places.len() - 1
        });
        connectivity.push(new);
    }
    let positions = places.iter().flat_map(|&place| shape.position(division, place)).collect();
    let mut mesh = Mesh::new(3, positions, grid.kind(), connectivity)?;
    let nodes = |is_in: &dyn Fn([f64; 3]) -> bool| -> Vec<usize> {
        (1..).zip(&places).filter(|(_, place)| is_in(**place)).map(|(node, _)| node).collect()
    };
    let [_, around, along] = counts.map(|n| n as f64);
    mesh = mesh.name_nodes("base", nodes(&|[_, _, z]| z == 0.0))?;
    mesh = mesh.name_nodes("tip", nodes(&|[_, _, z]| z == along))?;
    mesh = mesh.name_nodes("mirror", nodes(&|[_, y, _]| y == 0.0 || y == around))?;
    let is_inside = |[r, y, z]: [f64; 3]| {
        let [height, breadth, length] =
            [division.height, division.chamber, division.along].map(|n| n as f64);
        (1.0..=1.0 + height).contains(&r) && y <= breadth && z <= length
    };
    mesh = mesh.name_nodes("chamber", nodes(&is_inside))?;
    for (chamber, name) in AROUND.iter().enumerate() {
        let cells = (1..).zip(solid()).filter(|(_, cell)| {
            let [_, y, z] = middle(cell);
            z < division.along as f64 && division.octant_at(y).div_ceil(2) == chamber
        });
        mesh = mesh.name_cells(*name, cells.map(|(cell, _)| cell).collect::<Vec<usize>>())?;
    }
    Ok(mesh)
}

/// Ribs across the chambers: nodes (from 1) of their inner and their outer walls, opposite to each other, and the area (m^2) of
/// the inner wall that each pair stands for.
pub fn ribs(
    mesh: &Mesh,
    shape: &Shape,
    division: Division,
    kind: SolidCells,
) -> Result<Vec<(usize, usize, f64)>, InputError> {
    let counts = [1, 4 * division.octant(), division.along];
    let walls = Mesh::cuboid(counts.map(|n| n as f64), counts.map(|n| n + 1), kind)?;
    let mut shares = vec![0.0; walls.node_count()];
    for cell in walls.cells() {
        let on_wall: Vec<usize> =
            cell.iter().copied().filter(|&node| walls.position(node)[0] == 0.0).collect();
        let mean = |axis: usize| {
            let sum: f64 = on_wall.iter().map(|&node| walls.position(node)[axis]).sum();
            sum / on_wall.len() as f64
        };
        let (y, z) = (mean(1), mean(2));
        if division.near_chamber(y).1.abs() < 1.0 {
            let at = |y, z| shape.position(division, [1.0, y, z]);
            let area =
                distance(at(y - 0.5, z), at(y + 0.5, z)) * distance(at(y, z - 0.5), at(y, z + 0.5));
            on_wall.iter().for_each(|&node| shares[node] += area / on_wall.len() as f64);
        }
    }
    let place = |node: usize| [0, 1, 2].map(|axis| mesh.position(node)[axis]);
    let find = |wanted: [f64; 3]| {
        (0..mesh.node_count()).find(|&node| distance(place(node), wanted) < 1e-9)
    };
    let height = division.height as f64;
    let pairs = shares.iter().enumerate().filter(|(_, area)| **area > 0.0);
    let pairs = pairs.filter_map(|(node, &area)| {
        let [y, z] = [1, 2].map(|axis| walls.position(node)[axis]);
        let [inner, outer] = [1.0, 1.0 + height].map(|r| find(shape.position(division, [r, y, z])));
        Some((inner? + 1, outer? + 1, area))
    });
    Ok(pairs.collect())
}

/// The distance of two places (m).
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

impl Division {
    /// Cells from the middle of a chamber to that of a wall beside it: an eighth of the circle.
    fn octant(self) -> usize {
        self.chamber + self.web
    }

    fn octant_at(self, y: f64) -> usize {
        ((y / self.octant() as f64) as usize).min(3)
    }

    /// The angle of the chamber's middle next to `y`, and where it is to that: -1 to 1 along the breadth of the chamber, beyond it
    /// up to 2 in half of the wall.
    fn near_chamber(self, y: f64) -> (f64, f64) {
        let (octant, cells) = (self.octant_at(y), self.octant() as f64);
        let within = y - cells * octant as f64;
        let (from_middle, side) =
            if octant.is_multiple_of(2) { (within, 1.0) } else { (cells - within, -1.0) };
        let chamber = self.chamber as f64;
        let part = match from_middle <= chamber {
            true => from_middle / chamber,
            false => 1.0 + (from_middle - chamber) / self.web as f64,
        };
        (ANGLES[octant.div_ceil(2)], side * part)
    }

    fn is_hollow(self, [r, y, z]: [f64; 3]) -> bool {
        let (_, part) = self.near_chamber(y);
        r > 1.0 && r < 1.0 + self.height as f64 && part.abs() < 1.0 && z < self.along as f64
    }
}

impl Shape {
    /// Where (m) a place of the grid is.
    fn position(&self, division: Division, [r, y, z]: [f64; 3]) -> [f64; 3] {
        let (angle, part) = division.near_chamber(y);
        let height = division.height as f64;
        let (level, within) = match r {
            inner if inner <= 1.0 => (0, inner),
            chamber if chamber <= 1.0 + height => (1, (chamber - 1.0) / height),
            outer => (2, outer - 1.0 - height),
        };
        let [from, to] = [level, level + 1].map(|level| self.level(level, part.abs()));
        let [x, side] = [0, 1].map(|axis| from[axis] + within * (to[axis] - from[axis]));
        let side = part.signum() * side;
        let (sine, cosine) = angle.sin_cos();
        let (along, chambers) = (division.along as f64, self.length - self.bottom);
        let height = match z <= along {
            true => z / along * chambers,
            false => chambers + (z - along) * self.bottom,
        };
        // round-off must not move nodes off the plane of symmetry
        let across = x * sine + side * cosine;
        [x * cosine - side * sine, if across.abs() < 1e-12 { 0.0 } else { across }, height]
    }

    /// A point of the lines that are the surface of the duct (0), of the chamber towards it (1), of the chamber outwards (2), and of the
    /// arm (3): along and across the direction to the middle of the chamber. `part` is 0 there, 1 at the corner of the chamber and 2 in the
    /// middle of the wall beside it.
    fn level(&self, level: usize, part: f64) -> [f64; 2] {
        let flat = self.duct + self.inner_wall;
        let corner = flat - self.web * FRAC_1_SQRT_2;
        let outside = self.radius - self.outer_wall;
        let edge = FRAC_PI_4 - (0.5 * self.web / outside).asin();
        let (breadth, beyond) = (part.min(1.0), (part - 1.0).max(0.0));
        let turned = |radius: f64| {
            let angle = edge * breadth + (FRAC_PI_4 - edge) * beyond;
            [radius * angle.cos(), radius * angle.sin()]
        };
        match level {
            0 => {
                // the corner of the duct is round, from where the chamber ends
                let straight = self.duct * corner / flat;
                let angle = beyond * FRAC_PI_4;
                let round = self.duct - straight;
                [straight + round * angle.cos(), straight * breadth + round * angle.sin()]
            }
            1 => {
                let middle = 0.5 * (flat + corner);
                let side = corner * breadth + (middle - corner) * beyond;
                [flat + (middle - flat) * beyond, side]
            }
            2 => turned(outside),
            _ => turned(self.radius),
        }
    }
}
