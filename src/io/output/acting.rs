//! Vectors that act everywhere, and directions of magnets in a body, for arrows in pictures.

use std::collections::{BTreeMap, BTreeSet};
use std::mem::take;

use crate::base::input::InputError;
use crate::base::vector::norm;
use crate::elements::mesh::Mesh;
use crate::scene::timeline::{Phase, Scene};

/// Names in pictures of gravity and the magnetic field, which act everywhere.
pub(super) const EVERYWHERE: [&str; 2] = ["g", "B"];
/// Arrows along remanences at most, one after the other and in all.
const IN_A_ROW: usize = 8;
const MOST: usize = 12;
/// Length of the longest arrow where nothing is stretched, in distances between arrows.
const LENGTH: f64 = 0.75;

/// Gravity (m/s^2) and the uniform part of the magnetic field (T) in `phase` at time `t` (s), one component per dimension; 0 where there
/// is none.
pub(super) fn everywhere(scene: &Scene, phase: &Phase, t: f64) -> [Vec<f64>; 2] {
    let d = scene.body().dimension();
    let gravity = scene.gravity_in(phase).map_or_else(|| vec![0.0; d], <[f64]>::to_vec);
    [gravity, phase.magnetic_field_at(t, d)]
}

/// Arrows along the remanence in some of the cells that magnets consist of, in their middles, as long as it is strong and as the cells are turned and stretched:
/// along F b.
pub(super) struct Remanence {
    arrows: Vec<Arrow>,
}

/// The magnetization of a cell.
struct Arrow {
    /// Its nodes.
    cell: Vec<usize>,
    /// Nodes, of rods those of the directors among them, with the factors by which their positions add up to the arrow.
    poles: Vec<(usize, f64)>,
}

impl Remanence {
    /// Few cells of a scene, spread over all magnets.
    ///
    /// # Errors
    /// Cells that the body does not have, or that cannot be magnetized like this.
    pub(super) fn of(scene: &Scene) -> Result<Self, InputError> {
        let mut arrows = Vec::new();
        if scene.magnets().is_empty() {
            return Ok(Self { arrows });
        }
        let (body, mesh) = (scene.body(), scene.body().mesh());
        let magnets = (1..).zip(scene.magnets());
        let magnets = magnets
            .map(|(number, magnet)| Ok((magnet.remanence(), magnet.cells_in(body, number)?)));
        let magnets: Vec<(&[f64], Vec<usize>)> = magnets.collect::<Result<_, InputError>>()?;
        let among: BTreeSet<usize> = magnets.iter().flat_map(|(_, cells)| cells).copied().collect();
        let all: Vec<&[usize]> = mesh.cells().collect();
        let (chosen, apart) = spread(mesh, &all, &among);
        let mut magnetized = body.without_magnets();
        let mut strongest = 0.0_f64;
        for cell in chosen {
            let mut remanence = vec![0.0; mesh.dimension()];
            for (own, _) in magnets.iter().filter(|(_, cells)| cells.contains(&cell)) {
                body.magnetize(&[cell], own, &mut magnetized)?;
                remanence.iter_mut().zip(*own).for_each(|(sum, own)| *sum += own);
            }
            let taken = magnetized.poles.iter_mut().map(take).enumerate();
            let mut poles: Vec<(usize, f64)> = taken.filter(|(_, pole)| *pole != 0.0).collect();
            let moment = norm(&sum(&poles, |node| mesh.position(node).to_vec()));
            let strength = norm(&remanence);
            if moment > 0.0 && strength > 0.0 {
                strongest = strongest.max(strength);
                poles.iter_mut().for_each(|(_, pole)| *pole *= LENGTH * apart * strength / moment);
                arrows.push(Arrow { cell: all[cell].to_vec(), poles });
            }
        }
        let poles = arrows.iter_mut().flat_map(|arrow| &mut arrow.poles);
        poles.for_each(|(_, pole)| *pole /= strongest);
        Ok(Self { arrows })
    }

    pub(super) fn count(&self) -> usize {
        self.arrows.len()
    }

    /// The middle of each arrow, and the arrow (m), under the displacements `u` (m).
    pub(super) fn at(&self, mesh: &Mesh, u: &[f64]) -> Vec<[Vec<f64>; 2]> {
        let d = mesh.dimension();
        let position = |node: usize| -> Vec<f64> {
            mesh.position(node).iter().zip(&u[node * d..]).map(|(x, u)| x + u).collect()
        };
        let middle = |cell: &[usize]| {
            let share = 1.0 / cell.len() as f64;
            let shares: Vec<_> = cell.iter().map(|&node| (node, share)).collect();
            sum(&shares, position)
        };
        let arrows = self.arrows.iter();
        arrows.map(|arrow| [middle(&arrow.cell), sum(&arrow.poles, position)]).collect()
    }
}

/// The sum of the positions of nodes, each times its factor.
fn sum(factors: &[(usize, f64)], position: impl Fn(usize) -> Vec<f64>) -> Vec<f64> {
    let mut sum = Vec::new();
    for &(node, factor) in factors {
        let x = position(node);
        sum.resize(x.len(), 0.0);
        sum.iter_mut().zip(x).for_each(|(sum, x)| *sum += factor * x);
    }
    sum
}

/// Some of the cells numbered `among` of `all`, at most [`MOST`], and how far they are apart (m): those nearest to the middles of equal boxes, as many as there
/// may be.
fn spread(mesh: &Mesh, all: &[&[usize]], among: &BTreeSet<usize>) -> (Vec<usize>, f64) {
    let d = mesh.dimension();
    let nodes = || among.iter().flat_map(|&cell| all[cell]).map(|&node| mesh.position(node));
    let end = |axis: usize, choose: fn(f64, f64) -> f64| nodes().map(|x| x[axis]).reduce(choose);
    let ends = |axis| Some([end(axis, f64::min)?, end(axis, f64::max)?]);
    // without cells there are no ends
    let ranges: Vec<[f64; 2]> = (0..d).filter_map(ends).collect();
    let size = ranges.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    let (mut best, mut apart) = (Vec::new(), size);
    for along in 1..=IN_A_ROW {
        let width = size / along as f64;
        let mut boxes: BTreeMap<Vec<usize>, (f64, usize)> = BTreeMap::new();
        for &cell in among {
            let (mut place, mut off) = (Vec::with_capacity(d), 0.0);
            for (axis, &[low, high]) in ranges.iter().enumerate() {
                let middle = all[cell].iter().map(|&node| mesh.position(node)[axis]).sum::<f64>()
                    / all[cell].len() as f64;
                let count = ((high - low) / width).round().max(1.0);
                // nothing is outside; in a flat magnet all is in the first one
                let at = if high > low { (middle - low) / (high - low) * count } else { 0.5 };
                let own = at.floor().min(count - 1.0);
                place.push(own as usize);
                off += ((at - own - 0.5) * (high - low) / count).powi(2);
            }
            let nearest = boxes.entry(place).or_insert((off, cell));
            // of equally near cells the first, independent of round-off
            if off < 0.999 * nearest.0 {
                *nearest = (off, cell);
            }
        }
        if (best.len() + 1..=MOST).contains(&boxes.len()) {
            best = boxes.into_values().map(|(_, cell)| cell).collect();
            apart = width;
        }
    }
    (best, apart)
}
