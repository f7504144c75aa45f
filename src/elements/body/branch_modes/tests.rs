//! Forces, rates, power and strains along shapes are those of all cells.

use crate::base::sparse::BlockMatrix;
use crate::base::vector::{largest, noise, norm};
use crate::{Body, Cells, Dilatation, Material, Mesh, Plane, SolidCells, Strain};

const RUBBER: Material = Material { density: 1e3, young: 1e5, poisson: 0.4, viscosity: 0.0 };

/// Cells of several kinds, whose dilatation is projected or not, and strains, with branches of two times, one of them twice.
fn bodies() -> Vec<(&'static str, Body)> {
    let plane = || Mesh::rectangle([0.3, 0.2], [4, 3], Cells::Rectangles).unwrap();
    let space = |cells| Mesh::cuboid([0.3, 0.2, 0.1], [3, 2, 2], cells).unwrap();
    let substance = || RUBBER.maxwell(0.8, 0.02).maxwell(0.5, 0.3).maxwell(0.3, 0.02);
    let of_strain = |name: &str, strain| {
        let body = Body::new(plane(), substance()).thickness(0.02).strain(strain);
        body.named(name).build().unwrap()
    };
    let stiff = || Material { young: 3e5, poisson: 0.1, ..RUBBER }.maxwell(0.7, 0.3);
    let left = || crate::CellSelection::inside([0.0, 0.0], [0.15, 0.2]);
    vec![
        (
            "plane stress, two materials",
            Body::new(plane(), substance())
                .thickness(0.02)
                .plane(Plane::Stress)
                .strain(Strain::Green)
                .region(left(), stiff())
                .build()
                .unwrap(),
        ),
        (
            "mean dilatation",
            Body::new(plane(), substance())
                .thickness(0.02)
                .strain(Strain::Green)
                .dilatation(Dilatation::Mean)
                .build()
                .unwrap(),
        ),
        (
            "linear dilatation",
            Body::new(space(SolidCells::Hexahedra27), substance())
                .strain(Strain::Green)
                .dilatation(Dilatation::Linear)
                .build()
                .unwrap(),
        ),
        (
            "tetrahedra",
            Body::new(space(SolidCells::Tetrahedra10), substance())
                .strain(Strain::Green)
                .build()
                .unwrap(),
        ),
        (
            "linear strain beside another",
            Body::join([of_strain("a", Strain::Cauchy), of_strain("b", Strain::Green)]).unwrap(),
        ),
        (
            "linear strain",
            Body::new(plane(), substance()).thickness(0.02).strain(Strain::Cauchy).build().unwrap(),
        ),
    ]
}

#[test]
fn branches_along_shapes_are_those_of_all_cells() {
    for (name, body) in bodies() {
        let branches = body.branches().unwrap();
        let (dofs, strains) = (body.dofs(), branches.unknowns());
        let scaled = |count, seed, factor: f64| -> Vec<f64> {
            noise(count, seed).into_iter().map(|x| factor * x).collect()
        };
        let (origin, begun) = (scaled(dofs, 1, 5e-3), scaled(strains, 2, 0.1));
        let columns: Vec<Vec<f64>> = (3..6).map(|seed| noise(dofs, seed)).collect();
        let shapes: Vec<&[f64]> = columns.iter().map(|column| &column[..]).collect();
        let mut modes = branches.modes(&origin, &begun, &shapes);

        let start = modes.start();
        let mut lifted = vec![0.0; strains];
        modes.lift(&start, &mut lifted);
        let off = lifted.iter().zip(&begun).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-14, "{name}: {off:e}");

        let z = scaled(shapes.len(), 7, 1e-2);
        let moved = scaled(start.len(), 8, 1e-2);
        let g: Vec<f64> = start.iter().zip(&moved).map(|(start, moved)| start + moved).collect();
        modes.lift(&g, &mut lifted);
        let mut u = origin.clone();
        for (z, column) in z.iter().zip(&columns) {
            u.iter_mut().zip(column).for_each(|(u, x)| *u += z * x);
        }
        let (mut nodal, mut strain_rates) = (vec![0.0; dofs], vec![0.0; strains]);
        let power = branches.add_forces(&u, &lifted, &mut nodal, &mut strain_rates);
        let (mut forces, mut rates) = (vec![0.0; shapes.len()], vec![0.0; g.len()]);
        let own = modes.add_forces(&z, &g, &mut forces, &mut rates);
        assert!((own / power - 1.0).abs() < 1e-12, "{name}: {own} W, {power} W");
        for (force, column) in forces.iter().zip(&columns) {
            let exact: f64 = column.iter().zip(&nodal).map(|(x, f)| x * f).sum();
            assert!((force - exact).abs() < 1e-12 * norm(&nodal), "{name}: {force} N, {exact} N");
        }
        // the rates of the strains are those of the amplitudes, lifted
        let mut ahead = vec![0.0; strains];
        let next: Vec<f64> = g.iter().zip(&rates).map(|(g, rate)| g + rate).collect();
        modes.lift(&next, &mut ahead);
        let off = ahead.iter().zip(&lifted).zip(&strain_rates);
        let off: Vec<f64> = off.map(|((ahead, now), rate)| ahead - now - rate).collect();
        assert!(largest(&off) < 1e-12 * largest(&strain_rates), "{name}: {:e}", largest(&off));

        // the stiffness that is left of a step
        let gamma = 0.03;
        let mut stiffness = vec![0.0; shapes.len() * shapes.len()];
        modes.update_tangents();
        modes.add_stiffness(gamma, &mut stiffness);
        let mut tangents = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
        branches.add_tangents(gamma, &u, &lifted, &mut tangents);
        for (l, column) in columns.iter().enumerate() {
            let mut product = vec![0.0; dofs];
            tangents.add_product(1.0, column, &mut product);
            for (k, row) in columns.iter().enumerate() {
                let exact: f64 = row.iter().zip(&product).map(|(x, f)| x * f).sum();
                let own = stiffness[k * shapes.len() + l];
                assert!((own - exact).abs() < 1e-12 * norm(&product), "{name}: {own}, {exact}");
            }
        }
    }
}
