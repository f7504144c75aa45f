//! Files for ParaView.

use std::io;
use std::path::Path;

use vtkio::model::{
    Attribute, Attributes, ByteOrder, CellType, Cells, DataArray, DataSet, UnstructuredGridPiece,
    Version, VertexNumbers, Vtk,
};

use super::write_file;
use crate::base::input::InputError;
use crate::dynamics::error::Error;
use crate::dynamics::trajectory::{Sample, Trajectory};
use crate::elements::body::{CellField, NodalField};
use crate::elements::mesh::CellKind;
use crate::scene::forces::NodalContact;

/// Writes one VTK XML file per sample, `<name>_0000.vtu`, ..., and `<name>.pvd`, the collection
/// that has their times: open this one.
///
/// The points are the undeformed positions (m). To see the deformed body, apply the filter "Warp By Vector"
/// to `displacement`, which is the active vector field.
///
/// | at | field | meaning |
/// | --- | --- | --- |
/// | points | `displacement`, `velocity` | m, m/s |
/// | points | `contact_force` | of all obstacles, and of bodies that touch, on the node, N |
/// | points | `contact_pressure` | Pa, of all of them together: [`NodalContact`] |
/// | points | `contact_status` | 0 where nothing touches, 1 where it sticks, 2 where it slides |
/// | points | `constraint_force` | of what holds or moves the node, N |
/// | points | `stress`, `von_mises` | Pa, means of the cells around: [`Body::nodal_fields`](crate::Body::nodal_fields) |
/// | cells | `strain` | Cauchy's or Green's, as the body's |
/// | cells | `stress`, `von_mises` | Pa |
/// | cells | `strain_energy_density` | J/m^3 of natural volume |
/// | cells | `pressure` | Pa, the mean normal stress with the other sign |
/// | cells | `largest_stretch`, `least_stretch` | 1, of the principal stretches |
///
/// Vectors have three components and tensors the six XX, YY, ZZ, XY, YZ, XZ, whatever the
/// dimension; [`CellField`] says more of those at the cells.
///
/// # Errors
/// [`Error::Input`] for a `name` with other characters than letters, digits, `.`, `-` and `_`;
/// [`Error::Output`] if a file cannot be written; as [`Trajectory::contact_forces`].
///
/// ```
/// use pliant::output::write_vtk;
/// # use pliant::{Body, Cells, Material, Mesh, Phase, Sampling, Scene, Settings};
/// # let mesh = Mesh::rectangle([0.3, 0.3], [4, 4], Cells::Triangles)?;
/// # let rubber = Material { density: 1000.0, young: 1e6, poisson: 0.48, viscosity: 40.0 };
/// # let scene = Scene::new(Body::new(mesh, rubber).thickness(0.01).build()?)
/// #     .phase(Phase::until(0.01).hold("bottom").move_nodes([14, 15], [0.0, -0.16]));
/// # let directory = tempfile::tempdir().unwrap();
/// let trajectory = scene.simulate(&Settings::default(), &Sampling::every(0.01))?;
/// write_vtk(&trajectory, directory.path(), "body")?;
/// # Ok::<(), pliant::Error>(())
/// ```
pub fn write_vtk(
    trajectory: &Trajectory,
    directory: impl AsRef<Path>,
    name: &str,
) -> Result<(), Error> {
    let plain = |c: char| c.is_ascii_alphanumeric() || ".-_".contains(c);
    if name.is_empty() || !name.chars().all(plain) {
        let help = "file names are made of letters, digits, '.', '-' and '_'";
        return Err(InputError::new("name of the VTK files", format!("\"{name}\""), help).into());
    }
    let directory = directory.as_ref();
    let file_name = |number: usize| format!("{name}_{number:04}.vtu");
    for (number, sample) in trajectory.samples().iter().enumerate() {
        let grid = grid(trajectory, sample)?;
        write_file(&directory.join(file_name(number)), |file| {
            grid.write_xml(file).map_err(io::Error::other)
        })?;
    }
    write_file(&directory.join(format!("{name}.pvd")), |file| {
        writeln!(file, r#"<?xml version="1.0"?>"#)?;
        writeln!(file, r#"<VTKFile type="Collection" version="1.0">"#)?;
        writeln!(file, "  <Collection>")?;
        for (number, sample) in trajectory.samples().iter().enumerate() {
            let (time, vtu) = (sample.time, file_name(number));
            writeln!(file, r#"    <DataSet timestep="{time}" part="0" file="{vtu}"/>"#)?;
        }
        writeln!(file, "  </Collection>\n</VTKFile>")
    })
}

fn grid(trajectory: &Trajectory, sample: &Sample) -> Result<Vtk, Error> {
    let mesh = trajectory.body().mesh();
    let spatial = |components: &[f64]| -> Vec<f64> {
        let nodes = components.chunks_exact(mesh.dimension());
        nodes.flat_map(|x| (0..3).map(|i| x.get(i).copied().unwrap_or(0.0))).collect()
    };
    let vectors = |name: &str, components: &[f64]| {
        Attribute::DataArray(DataArray::vectors(name).with_vec(spatial(components)))
    };
    let contacts = trajectory.nodal_contacts(sample)?;
    let nodal = trajectory.nodal_fields(sample)?;
    let fields = trajectory.cell_fields(sample)?;
    let body = trajectory.body();
    let stretches = fields.iter().enumerate();
    let stretches: Vec<[f64; 3]> =
        stretches.map(|(cell, field)| field.stretches(body.strain_of(cell))).collect();
    let scalars = |name: &str, value: fn(&CellField) -> f64| {
        scalars(name, fields.iter().map(value).collect())
    };
    let tensors = |name: &str, tensor: fn(&CellField) -> [[f64; 3]; 3]| {
        tensors(name, fields.iter().map(tensor))
    };
    let cell_type = |kind: CellKind| match kind {
        CellKind::Segment => CellType::Line,
        CellKind::Triangle => CellType::Triangle,
        CellKind::Triangle6 => CellType::QuadraticTriangle,
        CellKind::Triangle7 => CellType::BiquadraticTriangle,
        CellKind::Quadrilateral => CellType::Quad,
        CellKind::Quadrilateral9 => CellType::BiquadraticQuad,
        CellKind::Tetrahedron => CellType::Tetra,
        // ParaView has none of 15 nodes
        CellKind::Tetrahedron10 | CellKind::Tetrahedron15 => CellType::QuadraticTetra,
        CellKind::Hexahedron => CellType::Hexahedron,
        CellKind::Hexahedron20 => CellType::QuadraticHexahedron,
        CellKind::Hexahedron27 => CellType::TriquadraticHexahedron,
    };
    let shown = |kind: CellKind| match kind {
        CellKind::Tetrahedron15 => 10,
        kind => kind.nodes(),
    };
    let ends = mesh.cells_with_kinds().scan(0, |end, (kind, _)| {
        *end += shown(kind) as u64;
        Some(*end)
    });
    let mut of_cells = vec![
        tensors("strain", |field| field.strain),
        tensors("stress", |field| field.stress),
        scalars("von_mises", CellField::von_mises),
        scalars("strain_energy_density", |field| field.energy_density),
        scalars("pressure", CellField::pressure),
        self::scalars("largest_stretch", stretches.iter().map(|s| s[0]).collect()),
        self::scalars("least_stretch", stretches.iter().map(|s| s[2]).collect()),
    ];
    if !body.is_single() {
        let parts = body.parts().zip(0_u32..);
        let numbers = parts.flat_map(|(part, number)| part.cells.map(move |_| f64::from(number)));
        of_cells.push(self::scalars("body", numbers.collect()));
    }
    Ok(Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        data: DataSet::inline(UnstructuredGridPiece {
            points: spatial(mesh.positions()).into(),
            cells: Cells {
                cell_verts: VertexNumbers::XML {
                    connectivity: mesh
                        .cells_with_kinds()
                        .flat_map(|(kind, cell)| &cell[..shown(kind)])
                        .map(|&node| node as u64)
                        .collect(),
                    offsets: ends.collect(),
                },
                types: mesh.cells_with_kinds().map(|(kind, _)| cell_type(kind)).collect(),
            },
            data: Attributes {
                point: vec![
                    vectors("displacement", &sample.u),
                    vectors("velocity", &sample.v),
                    vectors("contact_force", &trajectory.contact_forces(sample)?),
                    vectors("constraint_force", &trajectory.constraint_forces(sample)?),
                    self::tensors("stress", nodal.iter().map(|field| field.stress)),
                    self::scalars("von_mises", nodal.iter().map(NodalField::von_mises).collect()),
                    self::scalars(
                        "contact_pressure",
                        contacts.iter().map(NodalContact::pressure).collect(),
                    ),
                    self::scalars(
                        "contact_status",
                        contacts.iter().map(|nodal| nodal.status().number().into()).collect(),
                    ),
                ],
                cell: of_cells,
            },
        }),
        file_path: None,
    })
}

fn scalars(name: &str, values: Vec<f64>) -> Attribute {
    Attribute::DataArray(DataArray::scalars(name, 1).with_vec(values))
}

fn tensors(name: &str, tensors: impl Iterator<Item = [[f64; 3]; 3]>) -> Attribute {
    Attribute::generic(name, 6).with_data(tensors.flat_map(six).collect::<Vec<_>>())
}

/// The components of a symmetric tensor in the order of VTK.
fn six(tensor: [[f64; 3]; 3]) -> [f64; 6] {
    [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]].map(|[i, j]| tensor[i][j])
}
