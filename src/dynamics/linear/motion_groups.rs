//! Degrees of freedom that move together, and the blocks of matrices between them, for systems in [rigid motions](super::rigid_motions).

use std::collections::HashMap;

use faer::sparse::SymbolicSparseColMat;

use super::edges::Edges;
use super::simplex::{Simplex, edge_between};

/// Entry of a block that X does not have.
const NONE: u32 = u32::MAX;

/// Degrees of freedom that move together: those of a frame, or of another node.
pub(super) struct Group {
    /// Positions among the free ones.
    pub(super) dofs: Vec<usize>,
    /// First unknown, and the number of unknowns.
    pub(super) start: usize,
    pub(super) count: usize,
    /// T' and T, unknown by unknown for each degree of freedom.
    pub(super) test: Vec<f64>,
    pub(super) trial: Vec<f64>,
}

/// A frame, with its group.
pub(super) struct Frame {
    pub(super) group: usize,
    /// Its edges in the list of all.
    pub(super) edges: [usize; 6],
    /// The shapes with the rows G, and with R over the factor of x in it, so that they are nearly the same.
    pub(super) test: Simplex,
    pub(super) trial: Simplex,
}

/// The block of X, and of B, of two groups, the row not before the column.
pub(super) struct Block {
    pub(super) row: usize,
    pub(super) column: usize,
    /// Entries of X, row by row.
    pub(super) entries: Vec<u32>,
    /// First row of the block below the diagonal one in the columns of B.
    pub(super) below: usize,
}

/// y += factor x, for a few numbers.
#[inline]
pub(super) fn add_multiple(factor: f64, x: &[f64], y: &mut [f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x);
}

/// The group of a free degree of freedom, and its number there.
#[derive(Clone, Copy)]
pub(super) struct GroupMember {
    pub(super) group: usize,
    pub(super) dof: usize,
}

impl GroupMember {
    /// The group, and how this degree of freedom moves in each of its motions.
    pub(super) fn of<'a>(
        self,
        groups: &'a [Group],
        basis: impl Fn(&'a Group) -> &'a [f64],
    ) -> (&'a Group, &'a [f64]) {
        let group = &groups[self.group];
        (group, &basis(group)[self.dof * group.count..][..group.count])
    }
}

impl Block {
    /// Writes T'^T X T' to the `values` of B, whose columns begin at the `offsets`.
    pub(super) fn assemble(
        &self,
        x: &[f64],
        groups: &[Group],
        offsets: &[usize],
        values: &mut [f64],
    ) {
        let (row, column) = (&groups[self.row], &groups[self.column]);
        let is_diagonal = self.row == self.column;
        let mut product = [0.0; MOST_DOFS * MOST_DOFS];
        for (entries, product) in
            self.entries.chunks_exact(column.dofs.len()).zip(product.chunks_exact_mut(column.count))
        {
            for (&entry, motions) in entries.iter().zip(column.test.chunks_exact(column.count)) {
                if entry != NONE {
                    add_multiple(x[entry as usize], motions, product);
                }
            }
        }
        for k in 0..column.count {
            let first = if is_diagonal { k } else { 0 };
            let below = if is_diagonal { 0 } else { column.count - k + self.below };
            let target = &mut values[offsets[column.start + k] + below..][..row.count - first];
            target.fill(0.0);
            let products = product.chunks_exact(column.count);
            for (motions, product) in row.test.chunks_exact(row.count).zip(products) {
                add_multiple(product[k], &motions[first..], target);
            }
        }
    }
}

/// Most degrees of freedom of a group: those of a frame in space.
const MOST_DOFS: usize = 12;

/// The groups of the `free` degrees of freedom, and those of them that are frames.
pub(super) fn grouped(
    free: &[usize],
    nodes: &[Vec<usize>],
    edges: &Edges,
    dimension: usize,
) -> (Vec<Group>, Vec<Frame>) {
    let numbers: HashMap<[usize; 2], usize> =
        edges.all().enumerate().map(|(number, edge)| (edge.nodes, number)).collect();
    let place = |dof: usize| free.binary_search(&dof).ok();
    let of_node =
        |node: usize| (0..dimension).filter_map(move |axis| place(node * dimension + axis));
    let (mut groups, mut frames) = (Vec::new(), Vec::new());
    let mut is_framed = vec![false; free.len()];
    for nodes in nodes {
        let dofs: Vec<usize> = nodes.iter().flat_map(|&node| of_node(node)).collect();
        dofs.iter().for_each(|&at| is_framed[at] = true);
        let mut of_frame = [usize::MAX; 6];
        for a in 1..nodes.len() {
            for b in 0..a {
                let number = numbers.get(&[nodes[a], nodes[b]]);
                of_frame[edge_between(a, b)] = number.copied().unwrap_or(usize::MAX);
            }
        }
        let rigid = Simplex::motions(dimension);
        let implied = of_frame[..rigid].iter().filter(|&&edge| edge >= edges.list.len()).count();
        frames.push(Frame {
            group: groups.len(),
            edges: of_frame,
            test: Simplex::default(),
            trial: Simplex::default(),
        });
        let basis = vec![0.0; dofs.len() * (rigid + implied)];
        groups.push(Group {
            dofs,
            start: 0,
            count: rigid + implied,
            test: basis.clone(),
            trial: basis,
        });
    }
    let others: Vec<usize> = (0..free.len()).filter(|&at| !is_framed[at]).collect();
    for dofs in others.chunk_by(|&a, &b| free[a] / dimension == free[b] / dimension) {
        let count = dofs.len();
        let unit = |k: usize| if k / count == k % count { 1.0 } else { 0.0 };
        let basis: Vec<f64> = (0..count * count).map(unit).collect();
        groups.push(Group {
            dofs: dofs.to_vec(),
            start: 0,
            count,
            test: basis.clone(),
            trial: basis,
        });
    }
    for k in 1..groups.len() {
        groups[k].start = groups[k - 1].start + groups[k - 1].count;
    }
    (groups, frames)
}

/// The blocks of X, whose lower triangle has the `pattern`, and the lower triangle of B.
pub(super) fn blocks(
    groups: &[Group],
    places: &[GroupMember],
    pattern: &SymbolicSparseColMat<usize>,
) -> (Vec<Block>, SymbolicSparseColMat<usize>) {
    let mut numbers: HashMap<[usize; 2], usize> = HashMap::new();
    let mut blocks: Vec<Block> = Vec::new();
    let (offsets, rows) = (pattern.col_ptr(), pattern.row_idx());
    for column in 0..places.len() {
        for entry in offsets[column]..offsets[column + 1] {
            let ends = [places[rows[entry]], places[column]];
            let [a, b] = if ends[0].group >= ends[1].group { ends } else { [ends[1], ends[0]] };
            let key = [b.group, a.group];
            let number = *numbers.entry(key).or_insert_with(|| {
                let size = groups[a.group].dofs.len() * groups[b.group].dofs.len();
                let entries = vec![NONE; size];
                blocks.push(Block { row: a.group, column: b.group, entries, below: 0 });
                blocks.len() - 1
            });
            let count = groups[b.group].dofs.len();
            let entries = &mut blocks[number].entries;
            entries[a.dof * count + b.dof] = entry as u32;
            if a.group == b.group {
                entries[b.dof * count + a.dof] = entry as u32;
            }
        }
    }
    blocks.sort_unstable_by_key(|block| [block.column, block.row]);
    let (mut starts, mut indices) = (vec![0], Vec::new());
    for of_column in blocks.chunk_by_mut(|a, b| a.column == b.column) {
        let group = &groups[of_column[0].column];
        let mut below = 0;
        // the diagonal block comes first, as X has a full diagonal
        for block in &mut of_column[1..] {
            block.below = below;
            below += groups[block.row].count;
        }
        for k in 0..group.count {
            indices.extend(group.start + k..group.start + group.count);
            for block in &of_column[1..] {
                let rows = &groups[block.row];
                indices.extend(rows.start..rows.start + rows.count);
            }
            starts.push(indices.len());
        }
    }
    let count = starts.len() - 1;
    (blocks, SymbolicSparseColMat::new_checked(count, count, starts, None, indices))
}
