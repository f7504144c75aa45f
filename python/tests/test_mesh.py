"""Meshes from meshio: sets and groups by name, and what lies in a plane."""

from types import SimpleNamespace

import numpy as np
import pytest

import pliant


def meshio_mesh(points, cells, **kinds):
    """What `meshio.read` returns, as far as it is used."""
    blocks = [SimpleNamespace(type=kind, dim=dim, data=np.asarray(data)) for kind, dim, data in cells]
    empty = {"point_sets": {}, "cell_sets": {}, "cell_data": {}, "field_data": {}}
    return SimpleNamespace(points=np.asarray(points), cells=blocks, **{**empty, **kinds})


SQUARE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
CELLS = [("line", 1, [[3, 0]]), ("triangle", 2, [[0, 1, 2], [0, 2, 3]])]


def test_sets_of_gmsh_41():
    """Names of curves are node sets, those of the cells groups, too; the entities of the geometry are tags and no cells."""
    sets = {
        "left": [np.array([0]), np.array([], dtype=int)],
        "upper": [np.array([], dtype=int), np.array([1])],
        "gmsh:bounding_entities": [np.array([3, -4]), np.array([1, 2, -3])],
    }
    mesh = pliant.Mesh.from_meshio(meshio_mesh(SQUARE, CELLS, cell_sets=sets))
    assert {name: list(nodes) for name, nodes in mesh.sets.items()} == {"left": [0, 3], "upper": [0, 2, 3]}
    assert {name: list(cells) for name, cells in mesh.groups.items()} == {"upper": [1]}


def test_groups_of_gmsh_22():
    """The same from the tags of physical groups."""
    tags = {"gmsh:physical": [np.array([7]), np.array([7, 8])]}
    names = {"left": np.array([7, 1]), "lower": np.array([7, 2]), "upper": np.array([8, 2])}
    mesh = pliant.Mesh.from_meshio(meshio_mesh(SQUARE, CELLS, cell_data=tags, field_data=names))
    assert {name: list(nodes) for name, nodes in mesh.sets.items()} == {"left": [0, 3], "lower": [0, 1, 2], "upper": [0, 2, 3]}
    assert {name: list(cells) for name, cells in mesh.groups.items()} == {"lower": [0], "upper": [1]}


def test_space_of_faces():
    """Round-off across a plane is no third dimension; faces alone in space are a membrane if they are meant to be."""
    flat = np.array(SQUARE) + [0.0, 0.0, 5e-3]
    flat[0, 2] += 1e-9
    assert pliant.Mesh.from_meshio(meshio_mesh(flat, CELLS)).nodes.shape == (4, 2)
    assert pliant.Mesh.from_meshio(meshio_mesh(flat, CELLS), dimension=3).nodes.shape == (4, 3)
    bent = np.array(SQUARE)
    bent[0, 2] = 0.3
    with pytest.raises(ValueError, match="dimension=3 if a membrane"):
        pliant.Mesh.from_meshio(meshio_mesh(bent, CELLS))
    with pytest.raises(ValueError, match="extend along 3 axes"):
        pliant.Mesh.from_meshio(meshio_mesh(bent, CELLS), dimension=2)
    assert pliant.Mesh.from_meshio(meshio_mesh(bent, CELLS), dimension=3).nodes.shape == (4, 3)


def test_files_of_faces_and_of_both_windings(tmp_path):
    """A surface in space is a membrane where that is asked for; cells that run the wrong way round are turned over, and told of."""

    def write(z, second):
        points = f"1 0 0 0\n2 1 0 0\n3 1 1 {z}\n4 0 1 0\n"
        text = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{points}$EndNodes\n$Elements\n2\n1 2 0 1 2 3\n2 2 0 {second}\n$EndElements\n"
        (tmp_path / "faces.msh").write_text(text)

    write(0.5, "1 3 4")
    with pytest.raises(pliant.InputError, match="dimension = 3"):
        pliant.Mesh.read_gmsh(tmp_path / "faces.msh")
    membrane = pliant.Mesh.read_gmsh(tmp_path / "faces.msh", dimension=3)
    assert membrane.nodes.shape == (4, 3) and membrane.nodes[2, 2] == 0.5
    write(0, "1 4 3")
    with pytest.warns(pliant.ModelWarning, match="1 of 2 cells run the other way round"):
        mesh = pliant.Mesh.read_gmsh(tmp_path / "faces.msh")
    assert mesh.nodes.shape == (4, 2)
    a, b, c = (mesh.nodes[mesh.cells[1, k]] for k in range(3))
    assert np.linalg.det([b - a, c - a]) == 1.0
