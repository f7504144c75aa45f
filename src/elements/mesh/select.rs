//! Selections: how nodes are named.

use std::fmt;

use super::Mesh;
use crate::base::input::{InputError, unknown_among};

/// Nodes, by the name of a set, by number, or by a box around their undeformed positions.
///
/// Strings, arrays and vectors of numbers convert into it:
/// `body.hold("bottom")`, `body.hold([14, 15])`.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(rename_all = "snake_case"))]
pub enum Selection {
    /// A named set of the mesh (`bottom`, `top`, `left`, `right`, `front`, `back`, `inner`, `outer`
    /// where the mesh has them, `boundary`, `all`, or a set that you named).
    Set(String),
    /// Node numbers, counted from 1 as in the literature.
    Numbers(Vec<usize>),
    /// All nodes in the closed box between `min` and `max` (m).
    Box {
        /// Lower corner.
        #[cfg_attr(feature = "checkpoint", serde(with = "lower_corner"))]
        min: Vec<f64>,
        /// Upper corner.
        #[cfg_attr(feature = "checkpoint", serde(with = "upper_corner"))]
        max: Vec<f64>,
    },
}

/// Corners of boxes in files; infinite coordinates, which JSON lacks, are `null` there.
#[cfg(feature = "checkpoint")]
macro_rules! corner {
    ($corner:ident, $infinite:expr) => {
        mod $corner {
            use serde::{Deserialize, Deserializer, Serialize, Serializer};

            pub(super) fn serialize<S: Serializer>(x: &[f64], to: S) -> Result<S::Ok, S::Error> {
                let finite = |x: &f64| Some(*x).filter(|x| x.is_finite());
                x.iter().map(finite).collect::<Vec<_>>().serialize(to)
            }

            pub(super) fn deserialize<'de, D: Deserializer<'de>>(
                from: D,
            ) -> Result<Vec<f64>, D::Error> {
                let corner = Vec::<Option<f64>>::deserialize(from)?;
                Ok(corner.into_iter().map(|x| x.unwrap_or($infinite)).collect())
            }
        }
    };
}
#[cfg(feature = "checkpoint")]
corner!(lower_corner, f64::NEG_INFINITY);
#[cfg(feature = "checkpoint")]
corner!(upper_corner, f64::INFINITY);

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Set(name) => write!(f, "\"{name}\""),
            Self::Numbers(numbers) => write!(f, "{numbers:?}"),
            Self::Box { min, max } => write!(f, "box [{min:?}, {max:?}]"),
        }
    }
}

impl Selection {
    /// Nodes by their numbers, counted from 0.
    pub(crate) fn of_nodes(nodes: impl IntoIterator<Item = usize>) -> Self {
        Self::Numbers(nodes.into_iter().map(|node| node + 1).collect())
    }
}

impl From<&str> for Selection {
    fn from(name: &str) -> Self {
        Self::Set(name.into())
    }
}

impl From<Vec<usize>> for Selection {
    fn from(numbers: Vec<usize>) -> Self {
        Self::Numbers(numbers)
    }
}

impl<const N: usize> From<[usize; N]> for Selection {
    fn from(numbers: [usize; N]) -> Self {
        Self::Numbers(numbers.into())
    }
}

impl Mesh {
    /// The nodes that `selection` names, counted from 0, in the order given (boxes: ascending).
    ///
    /// # Errors
    /// An unknown set, a number out of range or given twice, an empty selection.
    pub fn select(&self, selection: &Selection) -> Result<Vec<usize>, InputError> {
        let nodes = match selection {
            Selection::Set(name) => self.sets.get(name).cloned().ok_or_else(|| {
                let known: Vec<&str> = self.sets.keys().map(String::as_str).collect();
                InputError::new(
                    "node set",
                    format!("\"{name}\""),
                    unknown_among(name, &known, "mesh", "node sets"),
                )
            })?,
            Selection::Numbers(numbers) => self.by_number(numbers)?,
            Selection::Box { min, max } => self.in_box(min, max)?,
        };
        if nodes.is_empty() {
            return Err(InputError::new(
                "node selection",
                selection,
                "it contains no node of the mesh; name at least one",
            ));
        }
        Ok(nodes)
    }

    /// The cells that have a node of a selection, counted from 0, ascending.
    ///
    /// # Errors
    /// As [`select`](Self::select).
    pub fn cells_at(&self, nodes: impl Into<Selection>) -> Result<Vec<usize>, InputError> {
        let mut is_selected = vec![false; self.node_count()];
        self.select(&nodes.into())?.into_iter().for_each(|node| is_selected[node] = true);
        let cells = self.cells().enumerate();
        let touching = cells.filter(|(_, cell)| cell.iter().any(|&node| is_selected[node]));
        Ok(touching.map(|(number, _)| number).collect())
    }

    /// Gives a name to a set of nodes, to be used in selections. A set of that name is replaced.
    ///
    /// # Errors
    /// A node that does not exist, an empty selection.
    pub fn name_nodes(
        mut self,
        name: impl Into<String>,
        nodes: impl Into<Selection>,
    ) -> Result<Self, InputError> {
        let nodes = self.select(&nodes.into())?;
        self.sets.insert(name.into(), nodes);
        Ok(self)
    }

    /// Gives a name to a group of cells, by their numbers (from 1), for regions of a body. A group of that name is
    /// replaced.
    ///
    /// # Errors
    /// A cell that does not exist, no cell at all.
    pub fn name_cells(
        mut self,
        name: impl Into<String>,
        cells: impl Into<Vec<usize>>,
    ) -> Result<Self, InputError> {
        let (mut cells, count) = (cells.into(), self.cell_count());
        if let Some(bad) = cells.iter().find(|cell| !(1..=count).contains(*cell)) {
            let help = format!("the mesh has the cells 1 to {count} (numbers count from 1)");
            return Err(InputError::new("cell", bad, help));
        }
        if cells.is_empty() {
            return Err(InputError::new("cells of a group", "[]", "name at least one"));
        }
        cells.sort_unstable();
        cells.dedup();
        cells.iter_mut().for_each(|cell| *cell -= 1);
        self.cell_groups.insert(name.into(), cells);
        Ok(self)
    }

    fn by_number(&self, numbers: &[usize]) -> Result<Vec<usize>, InputError> {
        let count = self.node_count();
        let mut seen = vec![false; count];
        for &number in numbers {
            if !(1..=count).contains(&number) {
                let help = format!("the mesh has the nodes 1 to {count} (numbers count from 1)");
                return Err(InputError::new("node", number, help));
            }
            if std::mem::replace(&mut seen[number - 1], true) {
                return Err(InputError::new("node", number, "it is named twice in one selection"));
            }
        }
        Ok(numbers.iter().map(|number| number - 1).collect())
    }

    fn in_box(&self, min: &[f64], max: &[f64]) -> Result<Vec<usize>, InputError> {
        for (name, corner) in [("box min", min), ("box max", max)] {
            if corner.len() != self.dimension || corner.iter().any(|x| x.is_nan()) {
                let help = format!("it needs {} numbers (m)", self.dimension);
                return Err(InputError::new(name, format!("{corner:?}"), help));
            }
        }
        let inside = |node: &usize| {
            self.position(*node)
                .iter()
                .zip(min.iter().zip(max))
                .all(|(x, (low, high))| low <= x && x <= high)
        };
        Ok((0..self.node_count()).filter(inside).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::mesh::Cells;

    #[test]
    fn selections_by_set_number_and_box() {
        let mesh = Mesh::rectangle([3.0, 3.0], [4, 4], Cells::Triangles).unwrap();
        assert_eq!(mesh.select(&"bottom".into()).unwrap(), [0, 1, 2, 3]);
        assert_eq!(mesh.select(&[14, 15].into()).unwrap(), [13, 14]);
        let corner = Selection::Box { min: vec![1.5, 1.5], max: vec![9.0, 2.5] };
        assert_eq!(mesh.select(&corner).unwrap(), [10, 11]);
        for (bad, part) in [
            (Selection::from("botom"), "node set = \"botom\""),
            (Selection::from([17]), "node = 17 cannot be used: the mesh has the nodes 1 to 16"),
            (Selection::from([0]), "node = 0 "),
            (Selection::from([3, 3]), "named twice"),
            (Selection::from(vec![]), "contains no node"),
        ] {
            let message = mesh.select(&bad).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
    }
}
