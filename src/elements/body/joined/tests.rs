//! Several bodies as one against each by itself.

use super::*;
use crate::elements::body::tests::noise;
use crate::elements::body::{BodyBuilder, Dilatation, Inertia};
use crate::elements::force::{Force, NodalForces};
use crate::elements::material::{Fibres, Law, Substance};
use crate::elements::mesh::{Cells, SolidCells};
use crate::studies::samples::SQUARE_MATERIAL;

fn square(cells: Cells, material: impl Into<Substance>) -> BodyBuilder {
    let mesh = Mesh::rectangle([0.3, 0.2], [5, 4], cells).unwrap();
    let mesh = mesh.name_cells("corner", [2]).unwrap();
    Body::new(mesh, material).thickness(0.02)
}

/// Bodies of other cells, laws, strains and kinds of damping, one with fibres and a point mass.
fn in_a_plane() -> [Body; 4] {
    let linear = Substance::from(SQUARE_MATERIAL);
    let rubber = Substance::from(SQUARE_MATERIAL).law(Law::NeoHookean).maxwell(0.7, 0.2);
    let fibres = Fibres::along([2.0, 1.0], 3e6);
    let damped = Substance { mass_damping: 3.0, ..SQUARE_MATERIAL.fibres(fibres) };
    let string = Mesh::bar(0.5, 6).unwrap().mapped(|x| [x[0], 1.0]).unwrap();
    [
        square(Cells::Triangles, linear).strain(Strain::Cauchy).named("linear").build(),
        square(Cells::Rectangles9, rubber)
            .dilatation(Dilatation::Linear)
            .region(crate::CellSelection::Numbers(vec![2, 3]), SQUARE_MATERIAL)
            .named("rubber")
            .build(),
        square(Cells::Triangles6, damped)
            .inertia(Inertia::Lumped)
            .point_mass("hub", [0.1, 0.3], 0.2)
            .build(),
        Body::new(string, SQUARE_MATERIAL.maxwell(1.0, 0.1)).area(1e-4).build(),
    ]
    .map(Result::unwrap)
}

/// All forces, with the stiffness and damping, of everything that a body has.
fn all(body: &Body, u: &[f64], v: &[f64]) -> (Vec<f64>, [BlockMatrix; 2], f64) {
    let mut forces = NodalForces::zeros(body.dofs());
    let mut stiffness = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
    let (mut damping, mut energy) = (stiffness.clone(), 0.0);
    if let Some(elastic) = body.elastic() {
        elastic.add_forces(0.0, u, v, &mut forces).unwrap();
        elastic.add_tangents(0.0, u, v, &mut stiffness, &mut damping);
        energy += elastic.potential(0.0, u);
    }
    if let Some(fibres) = body.reinforcement() {
        fibres.add_forces(0.0, u, v, &mut forces).unwrap();
        fibres.add_tangents(0.0, u, v, &mut stiffness, &mut damping);
        energy += fibres.potential(0.0, u);
    }
    if let Some(constant) = body.constant_stiffness() {
        constant.add_product(-1.0, u, &mut forces.conservative);
        stiffness.values.iter_mut().zip(&constant.values).for_each(|(sum, k)| *sum += k);
    }
    if let Some(constant) = body.constant_damping() {
        constant.add_product(-1.0, v, &mut forces.dissipative);
        damping.values.iter_mut().zip(&constant.values).for_each(|(sum, b)| *sum += b);
    }
    let mut rates = Vec::new();
    if let Some(branches) = body.branches() {
        let mut internal = vec![0.0; branches.unknowns()];
        let half: Vec<f64> = u.iter().map(|u| 0.5 * u).collect();
        branches.relax(&half, &mut internal);
        rates = internal.clone();
        branches.add_forces(u, &internal, &mut forces.conservative, &mut rates);
        branches.add_tangents(0.01, u, &internal, &mut stiffness);
        energy += branches.energy(u, &internal);
    }
    let forces = [forces.conservative.to_vec(), forces.dissipative.to_vec(), rates].concat();
    (forces, [stiffness, damping], energy)
}

/// The part of the damping by mass, on the pattern of the body.
fn by_mass(body: &Body) -> Vec<f64> {
    let mut matrix = BlockMatrix::zeros(body.inertia().pattern(), body.dimension());
    body.mass_damping().iter().for_each(|own| matrix.add_on_all_axes(own));
    matrix.values
}

/// Checks that forces, tangents, masses and fields of joined bodies are those of each single body, to the last bit
/// (energies: to the round-off of a sum).
fn are_those_of_each(bodies: &[Body]) {
    let joined = Body::join(bodies.to_vec()).unwrap();
    let (u, v) = (noise(joined.dofs(), 1e-3, 1.0), noise(joined.dofs(), 0.1, 2.0));
    let parts: Vec<Part> = joined.parts().collect();
    assert_eq!(parts.len(), bodies.len());
    let own: Vec<_> = parts.iter().map(|p| all(p.body, &u[p.dofs()], &v[p.dofs()])).collect();
    let (forces, [stiffness, damping], energy) = all(&joined, &u, &v);
    let dofs: Vec<usize> = bodies.iter().map(Body::dofs).collect();
    let [mut at, mut rates] = [[0, joined.dofs()], [2 * joined.dofs(), 0]];
    for ((of_body, ..), dofs) in own.iter().zip(dofs) {
        for (k, own) in of_body[..2 * dofs].chunks(dofs).enumerate() {
            assert_eq!(&forces[at[k]..][..dofs], own);
            at[k] += dofs;
        }
        let own = &of_body[2 * dofs..];
        assert_eq!(&forces[rates[0]..][..own.len()], own);
        rates[0] += own.len();
    }
    rates[1] = forces.len();
    assert_eq!(rates[0], rates[1]);
    assert!(forces.iter().filter(|force| **force != 0.0).count() > joined.dofs());
    let both = |k: usize| own.iter().flat_map(move |(_, tangents, _)| &tangents[k].values);
    assert!(both(0).eq(&stiffness.values) && both(1).eq(&damping.values));
    let sum: f64 = own.iter().map(|(.., energy)| energy).sum();
    assert!((sum - energy).abs() < 1e-14 * sum && sum > 0.0, "{sum} {energy}");
    for k in [0, 1] {
        let own = bodies.iter().flat_map(|body| body.connection_matrices()[k].values.clone());
        assert_eq!(joined.connection_matrices()[k].values, own.collect::<Vec<_>>());
    }
    assert_eq!(by_mass(&joined), bodies.iter().flat_map(by_mass).collect::<Vec<_>>());
    let masses: Vec<f64> = bodies.iter().flat_map(Body::nodal_masses).collect();
    assert_eq!(joined.nodal_masses(), masses);
    let fields: Vec<_> = parts.iter().flat_map(|p| p.body.cell_fields(&u[p.dofs()])).collect();
    assert_eq!(joined.cell_fields(&u), fields);
    let fields: Vec<_> = parts.iter().flat_map(|p| p.body.nodal_fields(&u[p.dofs()])).collect();
    assert_eq!(joined.nodal_fields(&u), fields);
    let folded = noise(joined.dofs(), 0.2, 3.0);
    let inverted = parts.iter().flat_map(|p| {
        let own = p.body.inverted_cells(&folded[p.dofs()]);
        own.into_iter().map(|cell| p.cells.start + cell)
    });
    let inverted: Vec<usize> = inverted.collect();
    assert!(inverted.last().is_some_and(|last| *last > parts[0].cells.end), "{inverted:?}");
    assert_eq!(joined.inverted_cells(&folded), inverted);
    let faces: usize = parts.iter().map(|p| p.body.mesh().boundary_faces().len()).sum();
    assert_eq!(joined.mesh().boundary_faces().len(), faces);
    let again = joined.to_builder().build().unwrap();
    assert_eq!(all(&again, &u, &v).0, forces);
    assert!(again.parts().map(|part| part.name).eq(parts.iter().map(|part| part.name)));
}

#[test]
fn bodies_are_together_what_each_is() {
    are_those_of_each(&in_a_plane());
    let block = |cells| {
        let mesh = Mesh::cuboid([0.3, 0.2, 0.1], [4, 3, 3], cells).unwrap();
        Body::new(mesh, SQUARE_MATERIAL)
    };
    let [solid, linear] = [
        block(SolidCells::Hexahedra).dilatation(Dilatation::Mean),
        block(SolidCells::Tetrahedra).strain(Strain::Cauchy),
    ];
    are_those_of_each(&[solid.build().unwrap(), linear.build().unwrap()]);
    // linear forces cell by cell, as all bodies are of triangles
    let plane = || square(Cells::Triangles, SQUARE_MATERIAL).strain(Strain::Cauchy);
    let both = [plane().build().unwrap(), plane().thickness(0.1).build().unwrap()];
    let joined = Body::join(both).unwrap();
    let (u, v) = (noise(joined.dofs(), 1e-3, 1.0), noise(joined.dofs(), 0.1, 2.0));
    let mut forces = NodalForces::zeros(joined.dofs());
    joined.linear_by_cells().unwrap().add_forces(&u, &v, &mut forces).unwrap();
    let (by_matrix, ..) = all(&joined, &u, &v);
    let by_cells = [forces.conservative.to_vec(), forces.dissipative.to_vec()].concat();
    let largest = by_matrix.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
    for (a, b) in by_cells.iter().zip(&by_matrix) {
        assert!((a - b).abs() < 1e-13 * largest, "{a} {b}");
    }
}

#[test]
fn selections_know_the_bodies() {
    let joined = Body::join(in_a_plane()).unwrap();
    let mesh = joined.mesh();
    let first = in_a_plane()[0].mesh().node_count();
    let bottom = in_a_plane()[1].mesh().sets()["bottom"].clone();
    let moved: Vec<usize> = bottom.iter().map(|node| first + node).collect();
    assert_eq!(mesh.select(&"rubber/bottom".into()).unwrap(), moved);
    assert_eq!(mesh.select(&"linear".into()).unwrap(), (0..first).collect::<Vec<_>>());
    assert_eq!(mesh.cell_groups()["body 4"].len(), 5);
    let second = in_a_plane()[0].mesh().cell_count() + 1;
    assert_eq!(mesh.cell_groups()["rubber/corner"], [second]);
    let boundary = joined.parts().flat_map(|part| {
        let own = part.body.mesh().boundary_nodes().iter();
        own.map(move |node| part.nodes.start + node)
    });
    assert_eq!(mesh.boundary_nodes(), boundary.collect::<Vec<_>>());
    assert_eq!(joined.part_of(first).name, "rubber");
    assert_eq!(joined.part_of(first - 1).name, "linear");
    let point = joined.shares_at(&[0.45, 1.0]).unwrap();
    assert!(point.iter().all(|(node, _)| joined.part_of(*node).name == "body 4"));
}

#[test]
fn what_cannot_be_joined_is_named() {
    let plane = |name: &str| square(Cells::Triangles, SQUARE_MATERIAL).named(name).build().unwrap();
    let solid = Mesh::cuboid([1.0; 3], [2; 3], SolidCells::Tetrahedra).unwrap();
    let solid = Body::new(solid, SQUARE_MATERIAL).build().unwrap();
    for (bodies, told) in [
        (vec![], "number of bodies = 0"),
        (vec![plane("a"), plane("a")], "name of a body = \"a\" cannot be used: it is taken"),
        (vec![plane("a"), plane("b/c")], "name of a body = \"b/c\""),
        (vec![plane("all"), plane("b")], "name of a body = \"all\""),
        (
            vec![plane("a"), solid],
            "dimension of body \"body 2\" = 3 cannot be used: that of body \"a\" is 2",
        ),
    ] {
        let error = Body::join(bodies).unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
}
