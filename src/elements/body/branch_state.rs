//! The state of the Maxwell branches of a body, as it is stored outside of a run.

/// Internal variables of the [Maxwell branches](crate::MaxwellBranch) of a body.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(deny_unknown_fields))]
pub struct BranchState {
    /// Runs of cells with branches of the same kind, in the order of the cells.
    pub cells: Vec<BranchCells>,
    /// Components of the internal variables (1): by cell, then by point of the cell, then by branch.
    pub components: Vec<f64>,
}

/// Cells in a row whose branches have the same internal variables.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "checkpoint", serde(deny_unknown_fields))]
pub struct BranchCells {
    /// Number of cells.
    pub count: usize,
    /// The internal variable of each branch, by its name, in the order of the branches; none without branches.
    pub variables: Vec<String>,
    /// Number of components per cell, those of all points and branches.
    pub components: usize,
}

/// The runs of `cells`, each given by the variables of its branches and the number of its components.
pub(super) fn runs<'a>(cells: impl Iterator<Item = (Vec<&'a str>, usize)>) -> Vec<BranchCells> {
    let mut runs: Vec<BranchCells> = Vec::new();
    for (variables, components) in cells {
        match runs.last_mut() {
            Some(last) if last.components == components && last.variables == variables => {
                last.count += 1;
            }
            _ => {
                let variables = variables.into_iter().map(String::from).collect();
                runs.push(BranchCells { count: 1, variables, components });
            }
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::{BranchCells, runs};

    #[test]
    fn cells_in_a_row_are_one_run() {
        let cells = [(vec!["a"], 3), (vec!["a"], 3), (vec![], 0), (vec!["a"], 3), (vec!["b"], 3)];
        let run = |count, variables: &[&str], components| BranchCells {
            count,
            variables: variables.iter().map(|name| (*name).to_owned()).collect(),
            components,
        };
        let expected = [run(2, &["a"], 3), run(1, &[], 0), run(1, &["a"], 3), run(1, &["b"], 3)];
        assert_eq!(runs(cells.into_iter()), expected);
    }
}
