//! The equations in which each unknown occurs, by changes of many unknowns at once.
//!
//! Groups of unknowns with neighbouring numbers are split in halves, again and again. Halves of groups that no equation has in common change
//! in one evaluation, as it is known from which of the groups each change comes: for equations on a grid that is a few evaluations for each
//! splitting (A. Griewank, C. Mitev, "Detecting Jacobian sparsity patterns by Bayesian probing", Mathematical Programming 93 (2002) 1-25,
//! bisect likewise).

use std::ops::Range;

/// Initial number of groups.
const FIRST: usize = 16;

/// Unknowns of neighbouring numbers, and the equations that they occur in.
struct Group {
    columns: Range<usize>,
    rows: Vec<usize>,
}

/// The entries (row, column) of a matrix of `n` columns, from `probe(columns)`: the rows in which a change of some columns, all at once,
/// shows.
pub(super) fn columns_by_groups<E>(
    n: usize,
    mut probe: impl FnMut(&[usize]) -> Result<Vec<usize>, E>,
) -> Result<Vec<(usize, usize)>, E> {
    let mut alone = |columns: Range<usize>| {
        let all: Vec<usize> = columns.clone().collect();
        probe(&all).map(|rows| Group { columns, rows })
    };
    let size = n.div_ceil(FIRST).max(1);
    let mut groups = Vec::new();
    for start in (0..n).step_by(size) {
        groups.push(alone(start..(start + size).min(n))?);
    }
    while groups.iter().any(|group| group.columns.len() > 1) {
        let colours = colours(n, &groups);
        let halved = match 4 * colours.len() < 3 * groups.len() {
            true => halved(n, &groups, &colours, &mut probe)?,
            false => None,
        };
        let Some(halved) = halved else {
            let mut alone = |j: usize| probe(&[j]).map(|rows| Group { columns: j..j + 1, rows });
            groups = (0..n).map(&mut alone).collect::<Result<_, E>>()?;
            break;
        };
        groups = halved;
    }
    let entries = |group: Group| group.rows.into_iter().map(move |i| (i, group.columns.start));
    Ok(groups.into_iter().flat_map(entries).collect())
}

/// Numbers of groups by colour: no row belongs to two groups of one colour.
fn colours(n: usize, groups: &[Group]) -> Vec<Vec<usize>> {
    let mut colours: Vec<(Vec<usize>, Vec<bool>)> = Vec::new();
    for (k, group) in groups.iter().enumerate() {
        let is_free =
            |(_, taken): &(Vec<usize>, Vec<bool>)| group.rows.iter().all(|&row| !taken[row]);
        let colour = colours.iter().position(is_free).unwrap_or_else(|| {
            colours.push((Vec::new(), vec![false; n]));
            colours.len() - 1
        });
        let (members, taken) = &mut colours[colour];
        members.push(k);
        group.rows.iter().for_each(|&row| taken[row] = true);
    }
    colours.into_iter().map(|(members, _)| members).collect()
}

/// The halves of all groups; `None` where a half shows in a row in which its group did not.
fn halved<E>(
    n: usize,
    groups: &[Group],
    colours: &[Vec<usize>],
    probe: &mut impl FnMut(&[usize]) -> Result<Vec<usize>, E>,
) -> Result<Option<Vec<Group>>, E> {
    let mut halves: Vec<Group> = Vec::new();
    let mut owner = vec![usize::MAX; n];
    for members in colours {
        for half in [0, 1] {
            owner.fill(usize::MAX);
            let first = halves.len();
            for &k in members {
                let Range { start, end } = groups[k].columns;
                let middle = start + (end - start).div_ceil(2);
                let columns = if half == 0 { start..middle } else { middle..end };
                if !columns.is_empty() {
                    groups[k].rows.iter().for_each(|&row| owner[row] = halves.len());
                    halves.push(Group { columns, rows: Vec::new() });
                }
            }
            let columns: Vec<usize> =
                halves[first..].iter().flat_map(|half| half.columns.clone()).collect();
            if columns.is_empty() {
                continue;
            }
            for row in probe(&columns)? {
                match halves.get_mut(owner[row]) {
                    Some(half) => half.rows.push(row),
                    None => return Ok(None),
                }
            }
        }
    }
    halves.sort_by_key(|half| half.columns.start);
    Ok(Some(halves))
}

#[cfg(test)]
mod tests {
    use super::columns_by_groups;

    /// The number of columns, and the entries.
    type Matrix = (usize, Vec<(usize, usize)>);

    /// The entries that are found of a matrix, and how many evaluations that takes.
    fn found(n: usize, entries: &[(usize, usize)]) -> (Vec<(usize, usize)>, usize) {
        let mut columns = vec![Vec::new(); n];
        entries.iter().for_each(|&(i, j)| columns[j].push(i));
        let mut count = 0;
        let mut found = columns_by_groups(n, |changed: &[usize]| {
            count += 1;
            let mut rows: Vec<usize> =
                changed.iter().flat_map(|&j| columns[j].iter().copied()).collect();
            rows.sort_unstable();
            rows.dedup();
            Ok::<_, ()>(rows)
        })
        .unwrap();
        found.sort_unstable();
        (found, count)
    }

    #[test]
    fn all_entries_are_found_and_no_others() {
        let grid = |side: usize| {
            let place = move |k: usize| (k / side, k % side);
            let near = move |&(i, j): &(usize, usize)| {
                let ((a, b), (c, d)) = (place(i), place(j));
                a.abs_diff(c) + b.abs_diff(d) <= 1
            };
            let n = side * side;
            (n, (0..n * n).map(|k| (k / n, k % n)).filter(near).collect::<Vec<_>>())
        };
        let line = |n: usize| (n, (0..n).flat_map(|i| [(i, i), (i, (i + 1) % n)]).collect());
        let full = |n: usize| (n, (0..n * n).map(|k| (k / n, k % n)).collect());
        let scattered = |n: usize| (n, (0..3 * n).map(|k| (k * k % n, 7 * k % n)).collect());
        // with a full row, a full column, and columns that no row has
        let arrow = |n: usize| (n, (0..n).flat_map(|k| [(0, k), (k, 0)]).collect());
        let empty = |n: usize| (n, vec![(n - 1, 0)]);
        // a few evaluations for each of log2(n / 16) splittings, or all columns by themselves
        let cases: [(Matrix, usize); 9] = [
            (grid(30), 200),
            (line(2000), 70),
            (line(1), 1),
            (line(17), 17 + 16),
            (full(100), 100 + 16),
            (full(3), 3),
            (scattered(211), 211 + 16),
            (arrow(80), 80 + 16),
            (empty(1000), 40),
        ];
        for ((n, mut entries), most) in cases {
            entries.sort_unstable();
            entries.dedup();
            let (found, count) = found(n, &entries);
            println!("{n}: {count}");
            assert_eq!(found, entries, "{n}");
            assert!(count <= most, "{n}: {count} evaluations");
        }
    }
}
