//! Which nodes are coupled.

/// Which pairs of nodes are coupled: a symmetric pattern with all diagonal entries, row by row,
/// columns ascending.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodePattern {
    pub(super) offsets: Vec<usize>,
    columns: Vec<usize>,
    /// For entry (a, b) the index of (b, a).
    transposed: Vec<usize>,
    /// For each entry of the pattern that this one was widened from, the index of the same pair.
    pub(super) widened: Option<Vec<usize>>,
}

impl NodePattern {
    /// The pattern of `nodes` nodes in which all nodes of one group are coupled to each other.
    pub(crate) fn new<'a>(nodes: usize, groups: impl Iterator<Item = &'a [usize]>) -> Self {
        let mut rows: Vec<Vec<usize>> = (0..nodes).map(|node| vec![node]).collect();
        for group in groups {
            for &node in group {
                rows[node].extend_from_slice(group);
            }
        }
        let mut offsets = vec![0];
        let mut columns = Vec::new();
        for row in &mut rows {
            row.sort_unstable();
            row.dedup();
            columns.append(row);
            offsets.push(columns.len());
        }
        // Going through the rows in order meets the entries (b, a) of each row b in the order of a.
        let mut next = offsets.clone();
        let mut transposed = vec![0; columns.len()];
        for entry in 0..columns.len() {
            let slot = &mut next[columns[entry]];
            transposed[entry] = *slot;
            *slot += 1;
        }
        Self { offsets, columns, transposed, widened: None }
    }

    /// This pattern with some more coupled pairs.
    pub(crate) fn with_pairs(&self, pairs: &[[usize; 2]]) -> Self {
        let rows =
            (0..self.nodes()).map(|row| &self.columns[self.offsets[row]..self.offsets[row + 1]]);
        let own =
            rows.enumerate().flat_map(|(row, columns)| columns.iter().map(move |&c| [row, c]));
        let own: Vec<[usize; 2]> = own.collect();
        let all = own.iter().chain(pairs).map(|pair| pair.as_slice());
        let mut wider = Self::new(self.nodes(), all);
        let entries = own.iter().filter_map(|&[row, column]| wider.find(row, column));
        let entries: Vec<usize> = entries.collect();
        wider.widened = Some(match &self.widened {
            None => entries,
            Some(first) => first.iter().map(|&entry| entries[entry]).collect(),
        });
        wider
    }

    /// The patterns of several bodies as one: their rows and entries one after the other. No pair of two bodies
    /// is coupled.
    pub(crate) fn join<'a>(bodies: impl Iterator<Item = &'a Self>) -> Self {
        let mut joined =
            Self { offsets: vec![0], columns: Vec::new(), transposed: Vec::new(), widened: None };
        for body in bodies {
            let (node, entry) = (joined.nodes(), joined.entries());
            joined.offsets.extend(body.offsets[1..].iter().map(|offset| entry + offset));
            joined.columns.extend(body.columns.iter().map(|column| node + column));
            joined.transposed.extend(body.transposed.iter().map(|other| entry + other));
        }
        joined
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of coupled pairs, counting (a, b) and (b, a) and each (a, a).
    pub fn entries(&self) -> usize {
        self.columns.len()
    }

    /// Index of entry (`row`, `column`), if the two nodes are coupled.
    pub fn find(&self, row: usize, column: usize) -> Option<usize> {
        let start = self.offsets[row];
        let columns = &self.columns[start..self.offsets[row + 1]];
        columns.binary_search(&column).ok().map(|at| start + at)
    }

    /// Index of entry (b, a) for the index of entry (a, b).
    pub(crate) fn transposed(&self, entry: usize) -> usize {
        self.transposed[entry]
    }

    /// For each node the number of the connected piece that it belongs to, in the order of their first nodes.
    pub(crate) fn pieces(&self) -> Vec<usize> {
        let mut pieces = vec![usize::MAX; self.nodes()];
        let mut count = 0;
        for first in 0..self.nodes() {
            if pieces[first] != usize::MAX {
                continue;
            }
            pieces[first] = count;
            let mut open = vec![first];
            while let Some(node) = open.pop() {
                for (_, next) in self.row(node) {
                    if pieces[next] == usize::MAX {
                        pieces[next] = count;
                        open.push(next);
                    }
                }
            }
            count += 1;
        }
        pieces
    }

    /// The entries of one row, as (index, column).
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, usize)> {
        (self.offsets[row]..self.offsets[row + 1]).map(|entry| (entry, self.columns[entry]))
    }
}
