//! Green forces of triangles as cubic polynomials of the nodal displacements (Hirai, section 4.5).
//!
//! With c_u and c_v the displacements of all nodes along x and y, and products of two and three of
//! them in collective vectors c_uu, c_uv, c_vv, c_uuu, c_uvv, c_vuu, c_vvv:
//!
//! ```text
//! dU/dc_u = A_1 c_u + A_2 c_v + A_11 c_uu + A_12 c_uv + A_22 c_vv + C (c_uuu + c_uvv)   (4.5.12)
//! dU/dc_v = B_1 c_u + B_2 c_v + B_11 c_uu + B_12 c_uv + B_22 c_vv + C (c_vuu + c_vvv)   (4.5.13)
//! ```
//!
//! The matrices are built once. Collective vectors hold only products that some triangle has: of
//! n_p nodes, n_e edges and n_t triangles n_p, n_p + 2 n_e and n_p + 6 n_e + 6 n_t. A_1, A_2, B_1
//! and B_2 make up K; C_1 and C_2 of the text are the same matrix C.
//!
//! It is a second way to the forces that `Body::add_elastic_forces` of a body with Green strain sums up cell by cell, and
//! an oracle of its tests; the sum over cells is 5 to 7 times as fast (`docs/notes/costs.md`). Cells that are inverted
//! are not noticed.

use faer::Mat;
use pliant::{Lame, Mesh};

/// Green forces of triangles in the plane by direct computation.
#[derive(Debug, Clone)]
pub struct GreenPolynomial {
    /// c2i and c2j, from 0.
    pairs: Vec<[u32; 2]>,
    /// c3i, and the place of (c3j, c3k) among the pairs.
    triples: Vec<[u32; 2]>,
    /// Rows of [A_1, A_2] and [B_1, B_2] at each pair of nodes that a triangle has.
    linear: Rows<[[f64; 2]; 2]>,
    /// A_11, A_12, A_22, B_11, B_12, B_22 at each entry.
    quadratic: Rows<[f64; 6]>,
    cubic: Rows<f64>,
    /// Collective vectors: c_uu, c_uv, c_vv of each pair; c_uuu + c_uvv and c_vuu + c_vvv of each
    /// triple.
    second: Vec<[f64; 3]>,
    third: Vec<[f64; 2]>,
}

/// A sparse matrix, row by row, of one or more numbers per entry.
#[derive(Debug, Clone)]
struct Rows<V> {
    offsets: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<V>,
}

impl<V: Clone> Rows<V> {
    /// Zeros in the `columns` of each row.
    fn zeros(rows: impl Iterator<Item = Vec<u32>>, zero: V) -> Self {
        let (mut offsets, mut columns) = (vec![0], Vec::new());
        for mut row in rows {
            row.sort_unstable();
            row.dedup();
            columns.append(&mut row);
            offsets.push(columns.len());
        }
        Self { values: vec![zero; columns.len()], offsets, columns }
    }

    fn row(&self, row: usize) -> impl Iterator<Item = (u32, &V)> {
        let range = self.offsets[row]..self.offsets[row + 1];
        self.columns[range.clone()].iter().copied().zip(&self.values[range])
    }

    fn to_dense(&self, columns: usize, number: impl Fn(&V) -> f64) -> Mat<f64> {
        let mut dense = Mat::zeros(self.offsets.len() - 1, columns);
        for row in 0..dense.nrows() {
            self.row(row).for_each(|(column, value)| dense[(row, column as usize)] = number(value));
        }
        dense
    }

    /// The entry in `row` and `column`, if there is one.
    fn entry(&mut self, row: usize, column: u32) -> Option<&mut V> {
        let start = self.offsets[row];
        let columns = &self.columns[start..self.offsets[row + 1]];
        columns.binary_search(&column).ok().map(|at| &mut self.values[start + at])
    }
}

impl GreenPolynomial {
    /// Coefficient matrices of a `mesh` of triangles in the plane of one `thickness` (m), with the Lamé coefficients of each
    /// triangle.
    ///
    /// # Panics
    /// Other cells than triangles, or more than 2,097,150 nodes, of which three numbers do not fit into 64 bits.
    pub fn new(mesh: &Mesh, thickness: f64, lame: &[Lame]) -> Self {
        assert!(mesh.dimension() == 2 && mesh.cells().all(|cell| cell.len() == 3));
        let nodes = mesh.node_count();
        assert!(nodes < (1 << 21) - 1);
        let cells: Vec<[usize; 3]> = mesh.cells().map(|cell| [cell[0], cell[1], cell[2]]).collect();

        // the suffixes as a number to the base n_p + 1; the order of these is the lexicographic one
        let base = nodes as u64 + 1;
        let number = |suffixes: &[usize]| {
            suffixes.iter().fold(0, |number, &node| base * number + node as u64 + 1)
        };
        let unique = |mut numbers: Vec<u64>| {
            numbers.sort_unstable();
            numbers.dedup();
            numbers
        };
        let id2 = unique(cells.iter().flat_map(pairs_of).map(|pair| number(&pair)).collect());
        let id3 = unique(cells.iter().flat_map(triples_of).map(|triple| number(&triple)).collect());
        let place = |numbers: &[u64], suffixes: &[usize]| {
            numbers.partition_point(|&other| other < number(suffixes)) as u32
        };
        let digit = |number: u64, power: u32| (number / base.pow(power) % base) as usize - 1;
        let pairs: Vec<_> = id2.iter().map(|&n| [digit(n, 1) as u32, digit(n, 0) as u32]).collect();
        let triple = |&n: &u64| [digit(n, 2) as u32, place(&id2, &[digit(n, 1), digit(n, 0)])];
        let triples: Vec<_> = id3.iter().map(triple).collect();

        let mut cells_of = vec![Vec::new(); nodes];
        for cell in &cells {
            cell.iter().for_each(|&node| cells_of[node].push(*cell));
        }
        let columns2 = |here: &Vec<[usize; 3]>| {
            here.iter().flat_map(pairs_of).map(|pair| place(&id2, &pair)).collect()
        };
        let columns3 = |here: &Vec<[usize; 3]>| {
            here.iter().flat_map(triples_of).map(|triple| place(&id3, &triple)).collect()
        };
        let mut quadratic = Rows::zeros(cells_of.iter().map(columns2), [0.0; 6]);
        let mut cubic = Rows::zeros(cells_of.iter().map(columns3), 0.0);

        let columns1 = |here: &Vec<[usize; 3]>| here.iter().flatten().map(|&q| q as u32).collect();
        let mut linear = Rows::zeros(cells_of.iter().map(columns1), [[0.0; 2]; 2]);

        for (cell, lame) in cells.iter().zip(lame) {
            let triangle = Triangle::new(cell.map(|node| mesh.position(node)));
            let volume = thickness * triangle.area;
            let weights = [lame.lambda * volume, lame.mu * volume];
            for (p, &row) in cell.iter().enumerate() {
                for (q, &column) in cell.iter().enumerate() {
                    let Some(entry) = linear.entry(row, column as u32) else { continue };
                    let new = triangle.linear(weights, [p, q]);
                    entry.iter_mut().zip(new).for_each(|(entry, new)| {
                        *entry = [entry[0] + new[0], entry[1] + new[1]];
                    });
                }
                for ([q, r], pair) in local_pairs().zip(pairs_of(cell)) {
                    let Some(entry) = quadratic.entry(row, place(&id2, &pair)) else { continue };
                    let new = triangle.quadratic(weights, [p, q, r]);
                    entry.iter_mut().zip(new).for_each(|(entry, new)| *entry += new);
                }
                for ([q, r, s], triple) in local_triples().zip(triples_of(cell)) {
                    let Some(entry) = cubic.entry(row, place(&id3, &triple)) else { continue };
                    *entry += triangle.cubic(weights, [p, q, r, s]);
                }
            }
        }
        Self {
            linear,
            second: vec![[0.0; 3]; pairs.len()],
            third: vec![[0.0; 2]; triples.len()],
            pairs,
            triples,
            quadratic,
            cubic,
        }
    }

    /// Writes the nodal forces -dU/du (N) at the displacements `u` (m), both with two components per node.
    pub fn forces(&mut self, u: &[f64], forces: &mut [f64]) {
        let at = u.as_chunks::<2>().0;
        for (second, &[i, j]) in self.second.iter_mut().zip(&self.pairs) {
            let ([ui, vi], [uj, vj]) = (at[i as usize], at[j as usize]);
            *second = [ui * uj, ui * vj, vi * vj];
        }
        for (third, &[i, jk]) in self.third.iter_mut().zip(&self.triples) {
            let ([ui, vi], [uu, _, vv]) = (at[i as usize], self.second[jk as usize]);
            *third = [ui * (uu + vv), vi * (uu + vv)];
        }
        for (node, force) in forces.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            let mut sum = [0.0; 2];
            for (column, coefficients) in self.linear.row(node) {
                let [u, v] = at[column as usize];
                sum = std::array::from_fn(|i| {
                    sum[i] + coefficients[i][0] * u + coefficients[i][1] * v
                });
            }
            for (column, &[a11, a12, a22, b11, b12, b22]) in self.quadratic.row(node) {
                let [uu, uv, vv] = self.second[column as usize];
                sum[0] += a11 * uu + a12 * uv + a22 * vv;
                sum[1] += b11 * uu + b12 * uv + b22 * vv;
            }
            for (column, &c) in self.cubic.row(node) {
                let [along_x, along_y] = self.third[column as usize];
                sum[0] += c * along_x;
                sum[1] += c * along_y;
            }
            *force = sum.map(|sum| -sum);
        }
    }

    /// Suffixes (i, j) of the products in c_uu, c_uv and c_vv, in their order: c2i and c2j of the
    /// text. Nodes count from 1.
    pub fn quadratic_suffixes(&self) -> Vec<[usize; 2]> {
        self.pairs.iter().map(|pair| pair.map(|node| node as usize + 1)).collect()
    }

    /// Suffixes (i, j, k) of the products in c_uuu, c_uvv, c_vuu and c_vvv: c3i, c3j and c3k of the
    /// text. Nodes count from 1.
    pub fn cubic_suffixes(&self) -> Vec<[usize; 3]> {
        let all = |&[i, jk]: &[u32; 2]| {
            let [j, k] = self.pairs[jk as usize];
            [i, j, k].map(|node| node as usize + 1)
        };
        self.triples.iter().map(all).collect()
    }

    /// A_11, A_12, A_22, B_11, B_12 or B_22 (`which` from 0, N/m^2) as a dense matrix, for small bodies: a row per node, a column per product.
    pub fn quadratic_matrix(&self, which: usize) -> Mat<f64> {
        self.quadratic.to_dense(self.pairs.len(), |entry| entry[which])
    }

    /// C (N/m^3), likewise.
    pub fn cubic_matrix(&self) -> Mat<f64> {
        self.cubic.to_dense(self.triples.len(), |c| *c)
    }
}

fn local_pairs() -> impl Iterator<Item = [usize; 2]> {
    (0..3).flat_map(|i| (0..3).map(move |j| [i, j]))
}

fn local_triples() -> impl Iterator<Item = [usize; 3]> {
    (0..3).flat_map(|i| local_pairs().map(move |[j, k]| [i, j, k]))
}

fn pairs_of(cell: &[usize; 3]) -> impl Iterator<Item = [usize; 2]> {
    local_pairs().map(|pair| pair.map(|local| cell[local]))
}

fn triples_of(cell: &[usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    local_triples().map(|triple| triple.map(|local| cell[local]))
}

/// Geometry of one triangle: u_x = a . gamma_u, u_y = b . gamma_u, likewise v.
struct Triangle {
    a: [f64; 3],
    b: [f64; 3],
    /// Area (m^2).
    area: f64,
}

impl Triangle {
    fn new(corners: [&[f64]; 3]) -> Self {
        let across = |i: usize, j: usize, k: usize| corners[j][i] - corners[k][i];
        let twice = across(0, 1, 0) * across(1, 2, 0) - across(1, 1, 0) * across(0, 2, 0);
        let others = [[1, 2], [2, 0], [0, 1]];
        Self {
            a: others.map(|[j, k]| across(1, j, k) / twice),
            b: others.map(|[j, k]| -across(0, j, k) / twice),
            area: 0.5 * twice,
        }
    }

    /// Coefficients of the displacements of node q in the forces on node p along x and y: those of K.
    fn linear(&self, [lambda, mu]: [f64; 2], [p, q]: [usize; 2]) -> [[f64; 2]; 2] {
        let (a, b) = (&self.a, &self.b);
        let (aa, ab, ba, bb) = (a[p] * a[q], a[p] * b[q], b[p] * a[q], b[p] * b[q]);
        let along_x = [lambda * aa + mu * (2.0 * aa + bb), lambda * ab + mu * ba];
        let along_y = [lambda * ba + mu * ab, lambda * bb + mu * (2.0 * bb + aa)];
        [along_x, along_y]
    }

    /// Coefficients (4.5.8) of the products with local suffixes q and r in the force on node p, for
    /// `weights` = [lambda, mu] x volume: A_11, A_12, A_22, B_11, B_12, B_22.
    fn quadratic(&self, [lambda, mu]: [f64; 2], [p, q, r]: [usize; 3]) -> [f64; 6] {
        let (a, b) = (&self.a, &self.b);
        let (aa, ab, ba, bb) = (a[q] * a[r], a[q] * b[r], b[q] * a[r], b[q] * b[r]);
        let (a, b) = (a[p], b[p]);
        let of_lambda = [
            1.5 * a * aa + 0.5 * a * bb + b * ab,
            a * ab + b * bb,
            0.5 * a * (aa + bb),
            0.5 * b * (aa + bb),
            a * aa + b * ab,
            1.5 * b * bb + 0.5 * b * aa + a * ba,
        ];
        let of_mu = [
            3.0 * a * aa + a * bb + 2.0 * b * ab,
            b * aa + a * ba + 2.0 * b * bb,
            a * aa + b * ab,
            b * bb + a * ba,
            a * bb + b * ba + 2.0 * a * aa,
            3.0 * b * bb + b * aa + 2.0 * a * ba,
        ];
        std::array::from_fn(|k| lambda * of_lambda[k] + mu * of_mu[k])
    }

    /// Coefficient (4.5.9) of the products with local suffixes q, r and s in the force on node p.
    fn cubic(&self, [lambda, mu]: [f64; 2], [p, q, r, s]: [usize; 4]) -> f64 {
        let (a, b) = (&self.a, &self.b);
        let stretch = a[p] * a[q] + b[p] * b[q];
        let of_lambda = 0.5 * stretch * (a[r] * a[s] + b[r] * b[s]);
        let along_a = a[q] * a[r] * a[s] + b[q] * b[r] * a[s];
        let along_b = b[q] * b[r] * b[s] + a[q] * a[r] * b[s];
        lambda * of_lambda + mu * (a[p] * along_a + b[p] * along_b)
    }
}
