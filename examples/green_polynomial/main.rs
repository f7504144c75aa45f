//! Green forces by direct computation: section 4.5 of Hirai's chapter.
//!
//! `cargo run --release --example green_polynomial`
//!
//! What to look for: with Green strain, forces are polynomials of degree three in the displacements of the nodes. The
//! suffixes of their products and the matrix C^{1,lambda}_{2;1,1} are those that the document prints for six nodes; a
//! quarter turn of the body costs no force; and the forces are those that the library sums up cell by cell.

mod polynomial;

use pliant::force::NodalForces;
use pliant::{Body, Cells, Error, Material, Mesh, Strain};
use polynomial::GreenPolynomial;

fn main() -> Result<(), Error> {
    let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
    let mesh = Mesh::rectangle([2.0, 1.0], [3, 2], Cells::Triangles)?;
    let body = Body::new(mesh, rubber).thickness(0.01).strain(Strain::Green).build()?;
    let lame = vec![rubber.elastic(); body.mesh().cell_count()];
    let mut polynomial = GreenPolynomial::new(body.mesh(), 0.01, &lame);
    let (pairs, triples) = (polynomial.quadratic_suffixes(), polynomial.cubic_suffixes());
    println!("{} products of two, from {:?} to {:?}", pairs.len(), pairs[0], pairs[23]);
    println!("{} products of three, from {:?} to {:?}", triples.len(), triples[0], triples[83]);

    let c = polynomial.cubic_matrix();
    println!("C has {} rows and {} columns", c.nrows(), c.ncols());

    println!("\nthe part of A_11 by lambda, of the first triangle with legs of 1, times 2:");
    let first =
        Mesh::new(2, vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0], body.mesh().kind(), vec![0, 1, 2])?;
    let by_lambda = pliant::Lame { lambda: 1.0, mu: 0.0 };
    let a11 = GreenPolynomial::new(&first, 1.0, &[by_lambda]).quadratic_matrix(0);
    for i in 0..3 {
        // of an area of 1/2, and times 2 as printed
        let row: Vec<f64> = (0..9).map(|j| 4.0 * a11[(i, j)]).collect();
        println!("{row:>4?}");
    }

    let mut compare = |what: &str,
                       displacement: &dyn Fn(&[f64]) -> [f64; 2]|
     -> Result<(), Error> {
        let u: Vec<f64> = body.mesh().positions().chunks(2).flat_map(displacement).collect();
        let (mut sum, mut direct) = (NodalForces::zeros(body.dofs()), vec![0.0; body.dofs()]);
        body.add_elastic_forces(&u, &mut sum).expect("no cell is turned inside out");
        polynomial.forces(&u, &mut direct);
        let largest = direct.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
        let apart = direct.iter().zip(sum.conservative.iter()).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max);
        println!(
            "{what}: largest force {largest:.3e} N, apart from the sum over cells by {apart:.0e} N"
        );
        Ok(())
    };
    println!();
    compare("a quarter turn", &|x| [-x[1] - x[0], x[0] - x[1]])?;
    compare("a shear", &|x| [0.2 * x[1], 0.01 * (20.0 * x[0]).sin()])
}
