//! Files for ParaView.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

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
        write_file(&directory.join(file_name(number)), |file| file.write_all(grid.as_bytes()))?;
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

/// XML file of a sample, with all numbers as base64 of their bytes
/// (<https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>).
fn grid(trajectory: &Trajectory, sample: &Sample) -> Result<String, Error> {
    let body = trajectory.body();
    let mesh = body.mesh();
    let contacts = trajectory.nodal_contacts(sample)?;
    let nodal = trajectory.nodal_fields(sample)?;
    let fields = trajectory.cell_fields(sample)?;
    // with 0 for the components that they lack in space
    let vectors = |name: &str, components: &[f64]| {
        let vectors = components.chunks_exact(mesh.dimension());
        reals(name, 3, vectors.flat_map(|x| (0..3).map(|i| x.get(i).copied().unwrap_or(0.0))))
    };
    let of_points = [
        vectors("displacement", &sample.u),
        vectors("velocity", &sample.v),
        vectors("contact_force", &trajectory.contact_forces(sample)?),
        vectors("constraint_force", &trajectory.constraint_forces(sample)?),
        tensors("stress", nodal.iter().map(|field| field.stress)),
        reals("von_mises", 1, nodal.iter().map(NodalField::von_mises)),
        reals("contact_pressure", 1, contacts.iter().map(NodalContact::pressure)),
        reals("contact_status", 1, contacts.iter().map(|nodal| nodal.status().number().into())),
    ];

    let stretches = fields.iter().enumerate();
    let stretches: Vec<[f64; 3]> =
        stretches.map(|(cell, field)| field.stretches(body.strain_of(cell))).collect();
    let mut of_cells = vec![
        tensors("strain", fields.iter().map(|field| field.strain)),
        tensors("stress", fields.iter().map(|field| field.stress)),
        reals("von_mises", 1, fields.iter().map(CellField::von_mises)),
        reals("strain_energy_density", 1, fields.iter().map(|field| field.energy_density)),
        reals("pressure", 1, fields.iter().map(CellField::pressure)),
        reals("largest_stretch", 1, stretches.iter().map(|s| s[0])),
        reals("least_stretch", 1, stretches.iter().map(|s| s[2])),
    ];
    if !body.is_single() {
        let parts = body.parts().zip(0_u32..);
        let numbers = parts.flat_map(|(part, number)| part.cells.map(move |_| f64::from(number)));
        of_cells.push(reals("body", 1, numbers));
    }

    let cells = || mesh.cells_with_kinds();
    let nodes = cells().flat_map(|(kind, cell)| &cell[..vtk_type(kind).1]);
    let ends = cells().scan(0, |end, (kind, _)| {
        *end += vtk_type(kind).1;
        Some(*end)
    });
    let types = cells().map(|(kind, _)| vtk_type(kind).0);
    let index = |index: usize| (index as u64).to_le_bytes();
    let of_mesh = [
        array("UInt64", "connectivity", 1, nodes.map(|&node| (node as f64, index(node)))),
        array("UInt64", "offsets", 1, ends.map(|end| (end as f64, index(end)))),
        array("UInt8", "types", 1, types.map(|number| (number.into(), [number]))),
    ];
    Ok(format!(
        concat!(
            r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#,
            r#"<UnstructuredGrid><Piece NumberOfPoints="{}" NumberOfCells="{}">"#,
            r#"<PointData Scalars="von_mises" Vectors="displacement">{}</PointData>"#,
            r#"<CellData Scalars="von_mises">{}</CellData><Points>{}</Points><Cells>{}</Cells>"#,
            "</Piece></UnstructuredGrid></VTKFile>",
        ),
        mesh.node_count(),
        mesh.cell_count(),
        of_points.concat(),
        of_cells.concat(),
        vectors("Points", mesh.positions()),
        of_mesh.concat(),
    ))
}

/// Type of a cell in VTK, and how many of its nodes such a cell has.
fn vtk_type(kind: CellKind) -> (u8, usize) {
    let number = match kind {
        CellKind::Segment => 3,
        CellKind::Triangle => 5,
        CellKind::Triangle6 => 22,
        CellKind::Triangle7 => 34,
        CellKind::Quadrilateral => 9,
        CellKind::Quadrilateral9 => 28,
        CellKind::Tetrahedron => 10,
        CellKind::Tetrahedron10 => 24,
        // VTK has none of 15 nodes: its first ten
        CellKind::Tetrahedron15 => return (24, 10),
        CellKind::Hexahedron => 12,
        CellKind::Hexahedron20 => 25,
        CellKind::Hexahedron27 => 29,
    };
    (number, kind.nodes())
}

/// Symmetric tensors, with their components in the order of VTK.
fn tensors(name: &str, tensors: impl Iterator<Item = [[f64; 3]; 3]>) -> String {
    let order = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];
    reals(name, 6, tensors.flat_map(|tensor| order.map(|[i, j]| tensor[i][j])))
}

fn reals(name: &str, components: usize, values: impl Iterator<Item = f64>) -> String {
    array("Float64", name, components, values.map(|x| (x, x.to_le_bytes())))
}

/// XML element of an array of numbers, each of which is given with its bytes. Their length (bytes) precedes them.
fn array<const N: usize>(
    number_type: &str,
    name: &str,
    components: usize,
    numbers: impl Iterator<Item = (f64, [u8; N])>,
) -> String {
    let mut bytes = Vec::new();
    // a range excludes NaN, such as strains of rigid cells
    let (mut least, mut greatest) = (f64::NAN, f64::NAN);
    for (number, its_bytes) in numbers {
        least = least.min(number);
        greatest = greatest.max(number);
        bytes.extend(its_bytes);
    }
    let length = (bytes.len() as u64).to_le_bytes();
    let numbers = STANDARD.encode([&length, &*bytes].concat());
    let several = (components > 1).then(|| format!(r#" NumberOfComponents="{components}""#));
    let components = several.unwrap_or_default();
    format!(
        r#"<DataArray type="{number_type}" Name="{name}"{components} format="binary" RangeMin="{least}" RangeMax="{greatest}">{numbers}</DataArray>"#
    )
}
