"""Meshes from arrays, from meshio and from Gmsh."""

import os
import tempfile
import warnings

import numpy as np

from . import _pliant

#: The word for cells, and its name in meshio. Nodes are in the order of VTK in both.
_MESHIO = {
    "segments": "line",
    "triangles": "triangle",
    "triangles6": "triangle6",
    "triangles7": "triangle7",
    "quadrilaterals": "quad",
    "quadrilaterals9": "quad9",
    "tetrahedra": "tetra",
    "tetrahedra10": "tetra10",
    # meshio has none of 15 nodes: see `to_meshio`
    "tetrahedra15": None,
    "hexahedra": "hexahedron",
    "hexahedra20": "hexahedron20",
    "hexahedra27": "hexahedron27",
}


class Mesh:
    """Nodes and cells of a body.

    Parameters
    ----------
    nodes : array [node, axis]
        Positions (m).
    cells : array [cell, node]
        Nodes of the cells, counted from 0, in the order of VTK.
    kind : str
        What the cells are: ``segments``, ``triangles``, ``triangles6``, ``triangles7``, ``quadrilaterals``,
        ``quadrilaterals9``, ``tetrahedra``, ``tetrahedra10``, ``tetrahedra15``, ``hexahedra``, ``hexahedra20`` or ``hexahedra27``.
    sets : dict, optional
        Nodes (from 0) by the names of node sets.
    groups : dict, optional
        Cells (from 0) by the names of groups, for regions.
    """

    def __init__(self, nodes, cells, kind, sets=None, groups=None):
        self.nodes = np.asarray(nodes, dtype=float)
        self.cells = np.asarray(cells, dtype=np.int64)
        if self.nodes.ndim != 2 or self.cells.ndim != 2:
            raise ValueError("nodes are an array [node, axis], cells an array [cell, node]")
        self.kind = kind
        self.sets = {name: np.asarray(nodes, dtype=np.int64) for name, nodes in (sets or {}).items()}
        self.groups = {name: np.asarray(cells, dtype=np.int64) for name, cells in (groups or {}).items()}

    def __repr__(self):
        return f"Mesh({len(self.nodes)} nodes, {len(self.cells)} {self.kind}, sets {sorted(self.sets)})"

    @classmethod
    def read_gmsh(cls, path, dimension=None):
        """The mesh in a file of Gmsh (4.1 or 2.2); its physical groups are node sets, and groups of cells.

        Faces alone in space are a membrane with ``dimension=3`` only. What was changed is a :class:`ModelWarning`: cells that were turned
        over, for one.
        """
        from .errors import ModelWarning  # which imports this

        *mesh, notes = _pliant.read_gmsh(os.fspath(path), dimension)
        for note in notes:
            warnings.warn(f"{os.fspath(path)}: {note}", ModelWarning, stacklevel=2)
        return cls(*mesh)

    @classmethod
    def from_gmsh(cls, gmsh, dimension=None):
        """The mesh of the present model of the module `gmsh`; see :meth:`read_gmsh`."""
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, "mesh.msh")
            gmsh.write(path)
            return cls.read_gmsh(path, dimension)

    @classmethod
    def from_meshio(cls, mesh, dimension=None):
        """A mesh of meshio: its cells of the highest dimension, its sets of points and of cells.

        Sets of cells of any dimension, and the physical groups of files of Gmsh, are node sets; those of the cells themselves are
        groups, too. Coordinates along axes in which nothing extends, but for round-off (1e-6 of the size), are left out.

        Parameters
        ----------
        mesh : meshio.Mesh
        dimension : int, optional
            3 for faces in space that are meant to be a membrane.

        Raises
        ------
        ValueError
            Cells of unknown or several kinds; faces alone in space without ``dimension=3``; coordinates that extend along more axes than
            ``dimension`` has.
        """
        known = {name: word for word, name in _MESHIO.items() if name}
        blocks = [block for block in mesh.cells if block.type in known]
        if not blocks:
            raise ValueError(f"cells are none of {', '.join(known)}: {[block.type for block in mesh.cells]}")
        highest = max(block.dim for block in blocks)
        kinds = {block.type for block in blocks if block.dim == highest}
        if len(kinds) > 1:
            raise ValueError(f"all cells must be of one kind, and these are {sorted(kinds)}")
        kind = kinds.pop()
        cells = np.concatenate([block.data for block in blocks if block.type == kind])
        used = np.unique(cells)
        number = np.full(len(mesh.points), -1)
        number[used] = np.arange(len(used))
        nodes = np.asarray(mesh.points, dtype=float)[used]
        nodes = _in_own_space(nodes, highest, dimension)
        sets = {}

        def add(name, points):
            kept = number[np.asarray(points, dtype=int).ravel()]
            sets[name] = np.union1d(sets.get(name, []), kept[kept >= 0]).astype(int)

        for name, points in (mesh.point_sets or {}).items():
            add(name, points)
        groups, first = {}, 0
        for place, block in enumerate(mesh.cells):
            for name, members in _named_cells(mesh, place, block):
                add(name, block.data[members])
                if block.type == kind:
                    groups[name] = np.union1d(groups.get(name, []), first + members).astype(int)
            if block.type == kind:
                first += len(block.data)
        sets = {name: nodes for name, nodes in sets.items() if len(nodes)}
        return cls(nodes, number[cells], known[kind], sets, groups)

    def to_meshio(self):
        """As a mesh of meshio; of tetrahedra of 15 nodes the first 10."""
        import meshio

        nodes = np.zeros((len(self.nodes), 3))
        nodes[:, : self.nodes.shape[1]] = self.nodes
        cells = (_MESHIO[self.kind], self.cells)
        if self.kind == "tetrahedra15":
            cells = ("tetra10", self.cells[:, :10])
        return meshio.Mesh(nodes, [cells], point_sets=self.sets)

    def to_dict(self):
        """As `mesh` of a scene."""
        mesh = {"kind": "listed", "positions": self.nodes, "cells": self.kind, "connectivity": self.cells + 1}
        own = [{"name": name, "nodes": nodes + 1} for name, nodes in self.sets.items() if name not in ("all", "boundary")]
        groups = [{"name": name, "cells": cells + 1} for name, cells in self.groups.items()]
        if own:
            mesh["sets"] = own
        if groups:
            mesh["groups"] = groups
        return mesh


def _named_cells(mesh, place, block):
    """Names with the numbers of cells in one block of a mesh of meshio: its sets of cells, and the physical groups of Gmsh."""
    for name, members in (mesh.cell_sets or {}).items():
        # "gmsh:bounding_entities" holds tags of the geometry, not cells
        if not name.startswith("gmsh:") and members[place] is not None and len(members[place]):
            yield name, np.asarray(members[place], dtype=int)
    physical = (mesh.cell_data or {}).get("gmsh:physical")
    for name, (tag, dimension) in (mesh.field_data or {}).items() if physical is not None else ():
        members = np.flatnonzero(np.asarray(physical[place]) == tag)
        if dimension == block.dim and len(members):
            yield name, members


def _in_own_space(nodes, highest, dimension):
    """Positions of the nodes of cells of dimension `highest` along the axes in which they extend."""
    extent = np.ptp(nodes, axis=0)
    axes = [axis for axis in range(nodes.shape[1]) if axis < highest or extent[axis] > 1e-6 * extent.max()]
    if dimension is None and highest == 2 and len(axes) == 3:
        raise ValueError(
            "the mesh is of faces alone that are not in the plane z = constant: mesh the volume for a solid, or pass dimension=3 if a "
            "membrane in space is meant"
        )
    if dimension is not None:
        if not len(axes) <= dimension <= nodes.shape[1]:
            raise ValueError(f"dimension is {dimension}: the nodes have {nodes.shape[1]} coordinates and extend along {len(axes)} axes")
        axes = range(dimension)
    return nodes[:, list(axes)]
