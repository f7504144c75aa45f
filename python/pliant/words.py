"""Builders for the tables of scenes: one function for each, with all keys, their meanings, units and defaults.

Made by make_words.py of the table of keys, as the reference page of scene files is: do not edit. Each function returns a
dict without the keys that are left out; a dict with the same keys does as well.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, Sequence

if TYPE_CHECKING:
    from .mesh import Mesh

#: The name of a node set, the number of a node (from 1), several numbers, or ``{"box": [[x, y], [x, y]]}``.
Nodes = Any
#: One number per dimension of space.
Vector = Sequence[float]
#: A number, or a function of time as a text: ``"2000 * sin(2*pi*3*t)"``.
Formula = Any


def _table(**keys):
    return {key.rstrip("_"): value for key, value in keys.items() if value is not None}


def body(
    *,
    mesh: dict | Mesh,
    material: dict,
    name: str | None = None,
    thickness: float | None = None,
    area: float | None = None,
    strain: Literal["cauchy", "green", "auto"] | None = None,
    viscous: Literal["natural", "objective"] | None = None,
    inertia: Literal["consistent", "lumped"] | None = None,
    plane: Literal["strain", "stress", "axisymmetric"] | None = None,
    dilatation: Literal["points", "mean", "linear"] | None = None,
    region: dict | Sequence[dict] | None = None,
    velocity: Vector | None = None,
    spin: float | Sequence[float] | None = None,
) -> dict:
    r"""What moves: a mesh made of a material. A list of several, `[[body]]`, feel each other where they touch by
    `[[touch]]`; ties, springs and combinations of displacements that are held join them.

    Parameters
    ----------
    mesh
        the mesh. Required.
    material
        the material. Required.
    name
        its name among several bodies. Default: `body 1`, `body 2` and so on. It is a node set and a group of cells,
        and stands before the node sets and groups of the body: `finger/tip`.
    thickness
        the thickness of a body in the plane (m). Default: required in two dimensions; none if axisymmetric.
    area
        the cross section of a string (m^2). Default: required in one dimension.
    strain
        the measure of strain. Default: auto. Cauchy's is linear, right while no cell turns by more than some degrees;
        Green's follows any rotation, with the law of the material; `auto` is Green's, and the report tells whether
        Cauchy's would do.
    viscous
        the law of viscosity. Default: natural with Cauchy strain, objective with Green strain. Natural viscosity, -B
        v, brakes rotations, too; objective viscosity takes the rate of Green's strain.
    inertia
        how inertia is shared out. Default: consistent. Consistent with the shape functions, or lumped at the nodes.
    plane
        the quantity that is 0 across cells of two dimensions, or that they are turned about the axis. Default: strain
        in the plane, stress in space (membranes). Strain: of bodies that are long across the plane. Stress: of
        sheets, whose thickness changes. Axisymmetric: x is the radius r, 0 or above, and y the height z of a body of
        revolution about r = 0; it has no thickness, and forces and masses are those of a whole turn.
    dilatation
        the treatment of volumetric strain, against locking. Default: points, or what goes with `cells = "auto"` and
        `bubbles`. At each point of a cell, a nearly incompressible body locks. `linear`: projected onto linear
        functions of each cell, accurate; for `hexahedra27` and `rectangles9`, for triangles and tetrahedra with
        `bubbles`, and for `hexahedra20`, whose pressures are not reliable then. `mean`: in the mean over each cell,
        for `rectangles`, `hexahedra`, `triangles6` and `tetrahedra10`.
    region
        parts with a material of their own. Default: none.
    velocity
        its velocity at first, in place of that of `[initial]` (m/s). Default: that of `[initial]`.
    spin
        its angular velocity at first about its own centre of mass, on top of that (rad/s). Default: 0. One number in
        the plane, counter-clockwise; three in space.
    """
    return _table(
        mesh=mesh,
        material=material,
        name=name,
        thickness=thickness,
        area=area,
        strain=strain,
        viscous=viscous,
        inertia=inertia,
        plane=plane,
        dilatation=dilatation,
        region=region,
        velocity=velocity,
        spin=spin,
    )


def mesh_bar(
    *,
    length: float,
    nodes: int,
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
) -> dict:
    r"""Mesh of the kind "bar": segments along x.

    Parameters
    ----------
    length
        the length (m). Required.
    nodes
        the number of nodes. Required.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    """
    return _table(
        kind="bar",
        length=length,
        nodes=nodes,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
    )


def mesh_rectangle(
    *,
    size: Sequence[float],
    nodes: Sequence[int],
    cells: Literal["triangles", "crossed", "rectangles", "triangles6", "rectangles9", "auto"],
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
    grading: Sequence[float] | None = None,
) -> dict:
    r"""Mesh of the kind "rectangle": a grid along x and y.

    Parameters
    ----------
    size
        width and height (m). Required.
    nodes
        corner nodes along x and y. Required.
    cells
        how the grid is divided. Required. Linear `triangles` are too stiff in bending, `crossed` ones less so;
        `triangles6`, quadratic, bend well, and `auto` is those; for a Poisson's ratio of 0.45 or more in plane strain
        it is `rectangles9` with `dilatation = "linear"`, as of silicone.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    grading
        the length of the last cell along each axis by that of the first one (no unit). Default: 1 along each axis:
        equal cells. Within 1e-4 and 1e4; each cell is longer than the one before it by the same factor. Put the fine
        end where stress is: a clamp on the left asks for a number above 1.
    """
    return _table(
        kind="rectangle",
        size=size,
        nodes=nodes,
        cells=cells,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
        grading=grading,
    )


def mesh_ring(
    *,
    inner: float,
    outer: float,
    nodes: Sequence[int],
    cells: Literal["triangles", "crossed", "rectangles", "triangles6", "rectangles9", "auto"],
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
) -> dict:
    r"""Mesh of the kind "ring": a grid around a circle.

    Parameters
    ----------
    inner
        the inner radius (m). Required.
    outer
        the outer radius (m). Required.
    nodes
        corner nodes around and along the radius. Required.
    cells
        how the grid is divided. Required. Linear `triangles` are too stiff in bending, `crossed` ones less so;
        `triangles6`, quadratic, bend well, and `auto` is those; for a Poisson's ratio of 0.45 or more in plane strain
        it is `rectangles9` with `dilatation = "linear"`, as of silicone.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    """
    return _table(
        kind="ring",
        inner=inner,
        outer=outer,
        nodes=nodes,
        cells=cells,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
    )


def mesh_half_ring(
    *,
    inner: float,
    outer: float,
    nodes: Sequence[int],
    cells: Literal["triangles", "crossed", "rectangles", "triangles6", "rectangles9", "auto"],
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
) -> dict:
    r"""Mesh of the kind "half-ring": its upper half.

    Parameters
    ----------
    inner
        the inner radius (m). Required.
    outer
        the outer radius (m). Required.
    nodes
        corner nodes around and along the radius. Required.
    cells
        how the grid is divided. Required. Linear `triangles` are too stiff in bending, `crossed` ones less so;
        `triangles6`, quadratic, bend well, and `auto` is those; for a Poisson's ratio of 0.45 or more in plane strain
        it is `rectangles9` with `dilatation = "linear"`, as of silicone.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    """
    return _table(
        kind="half-ring",
        inner=inner,
        outer=outer,
        nodes=nodes,
        cells=cells,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
    )


def mesh_cuboid(
    *,
    size: Sequence[float],
    nodes: Sequence[int],
    cells: Literal["tetrahedra", "hexahedra", "tetrahedra10", "hexahedra20", "hexahedra27", "auto"],
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
    grading: Sequence[float] | None = None,
) -> dict:
    r"""Mesh of the kind "cuboid": a grid along x, y and z.

    Parameters
    ----------
    size
        lengths along x, y and z (m). Required.
    nodes
        corner nodes along x, y and z. Required.
    cells
        how the grid is divided. Required. `auto` is `tetrahedra10`, quadratic; for a Poisson's ratio of 0.45 or more
        it is `hexahedra27` with `dilatation = "linear"`, as of silicone.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    grading
        the length of the last cell along each axis by that of the first one (no unit). Default: 1 along each axis:
        equal cells. Within 1e-4 and 1e4; each cell is longer than the one before it by the same factor. Put the fine
        end where stress is: a clamp on the left asks for a number above 1.
    """
    return _table(
        kind="cuboid",
        size=size,
        nodes=nodes,
        cells=cells,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
        grading=grading,
    )


def mesh_gmsh(
    *,
    file: str,
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
) -> dict:
    r"""Mesh of the kind "gmsh": a file of Gmsh, of version 4.1 or 2.2; coordinates are metres.

    Parameters
    ----------
    file
        the path of a Gmsh mesh, relative to the scene file. Required.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    """
    return _table(
        kind="gmsh",
        file=file,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
    )


def mesh_surface(
    *,
    file: str,
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
    scale: float | None = None,
) -> dict:
    r"""Mesh of the kind "surface": the closed surface of a rigid solid, of triangles: a file STL (text or binary), OBJ or
    Gmsh.

    Parameters
    ----------
    file
        the path of a file .stl, .obj or .msh, relative to the scene file. Required.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    scale
        the length of which the coordinates are multiples (m). Default: 1. 0.001 of a drawing in millimetres.
    """
    return _table(
        kind="surface",
        file=file,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
        scale=scale,
    )


def mesh_listed(
    *,
    positions: Sequence[Vector],
    cells: Literal["segments", "triangles", "triangles6", "triangles7", "quadrilaterals", "quadrilaterals9", "tetrahedra", "tetrahedra10", "tetrahedra15", "hexahedra", "hexahedra20", "hexahedra27"],
    connectivity: Sequence[Sequence[int]],
    origin: Vector | None = None,
    turn: float | Sequence[float] | None = None,
    quadratic: bool | None = None,
    halved: int | None = None,
    halved_in: dict | Sequence[dict] | None = None,
    bubbles: bool | None = None,
    sets: dict | Sequence[dict] | None = None,
    groups: dict | Sequence[dict] | None = None,
) -> dict:
    r"""Mesh of the kind "listed": node by node, as programs hand meshes over.

    Parameters
    ----------
    positions
        where each node is (m). Required.
    cells
        what the cells are. Required.
    connectivity
        the nodes of each cell, by number (from 1). Required. In the order of VTK: corners counter-clockwise, then the
        middles of edges.
    origin
        the place of the lower corner, or of the centre of a ring (m). Default: the origin.
    turn
        the angle by which the mesh is turned about the origin before it is brought to its place (rad). Default: 0.
        One number in the plane, counter-clockwise; in space three, the axis times the angle. It turns nodes alone:
        boxes, and directions of fibres, muscles, growths and remanences, are given in space, as the mesh lies after
        it.
    quadratic
        whether cells get mid nodes. Default: false. Triangles, tetrahedra and hexahedra; quadrilaterals are divided
        into triangles first. Numbers of nodes in the file are those of the mesh without this; new nodes of rings are
        on their circles; where several nodes are held, moved or under tractions, those between them are, too. Forces
        on each node stay at the nodes that there were, and stiffness and damping of obstacles per node are shared
        out.
    halved
        how often each cell is divided at the middles of its edges. Default: 0. After `quadratic`, and like it.
    halved_in
        where triangles and tetrahedra are divided further. Default: nowhere. After `halved`, and like it.
    bubbles
        whether triangles and tetrahedra get mid nodes, and one in the middle of each cell and face. Default: false.
        With `dilatation = "linear"`, which goes with them, they are the cells for nearly incompressible bodies of any
        shape: `triangles7` and `tetrahedra15`. After `halved_in`, and like it.
    sets
        sets of nodes with names. Default: none.
    groups
        groups of cells with names, for regions. Default: none.
    """
    return _table(
        kind="listed",
        positions=positions,
        cells=cells,
        connectivity=connectivity,
        origin=origin,
        turn=turn,
        quadratic=quadratic,
        halved=halved,
        halved_in=halved_in,
        bubbles=bubbles,
        sets=sets,
        groups=groups,
    )


def sets(
    *,
    name: str,
    nodes: Sequence[int],
) -> dict:
    r"""A set of nodes of a listed mesh.

    Parameters
    ----------
    name
        the name of the set. Required.
    nodes
        its nodes, by number (from 1). Required.
    """
    return _table(
        name=name,
        nodes=nodes,
    )


def groups(
    *,
    name: str,
    cells: Sequence[int],
) -> dict:
    r"""A group of cells of a listed mesh.

    Parameters
    ----------
    name
        the name of the group. Required.
    cells
        its cells, by number (from 1). Required.
    """
    return _table(
        name=name,
        cells=cells,
    )


def halved_in(
    *,
    nodes: Nodes | None = None,
    times: int | None = None,
    cells: Sequence[int] | None = None,
) -> dict:
    r"""A place where cells are divided further, as sharp corners and clamps need it: those that have one of the nodes,
    and cells around them as far as it takes for no node to hang on an edge.

    Parameters
    ----------
    nodes
        nodes of the mesh that there is by then. Default: none.
    times
        how often cells that have one of the nodes are divided. Default: 1. Goes with `nodes`.
    cells
        numbers of cells, from 1, of the mesh that there is by then. Default: none. `pliant static --refine` writes
        such lists.
    """
    return _table(
        nodes=nodes,
        times=times,
        cells=cells,
    )


def material(
    *,
    density: float | None = None,
    rigid: bool | None = None,
    mass: float | None = None,
    centre: Vector | None = None,
    inertia: float | Sequence[float] | Sequence[Sequence[float]] | None = None,
    young: float | None = None,
    poisson: float | None = None,
    viscosity: float | None = None,
    mass_damping: float | None = None,
    branch: dict | Sequence[dict] | None = None,
    fibres: dict | Sequence[dict] | None = None,
    law: dict | None = None,
) -> dict:
    r"""An isotropic viscoelastic material: Lamé's parameters follow from `young` and `poisson`, and those of viscosity
    from `viscosity` and `poisson` in the same way.

    Parameters
    ----------
    density
        the density (kg/m^3). Default: required; in a region, that of the body.
    rigid
        whether what is made of it is rigid. Default: false; in a region, as the body. The mesh then gives its shape
        and inertia, and it moves by 3 degrees of freedom (6 in space). Only `density` is needed, or `mass`; in
        equilibria `young`, by default 1e8 Pa, keeps its shape.
    mass
        the mass of a rigid body, in place of `density` (kg). Default: that of `density`. Of a whole body that is one
        piece, without regions.
    centre
        the undeformed position of the centre of mass of a rigid body (m). Default: that of a uniform density. Goes
        with `inertia`.
    inertia
        moments of inertia of a rigid body about its centre of mass (kg m^2). Default: those of a uniform density.
        Goes with `mass`. In the plane one number; in space the three principal moments, where x, y and z are
        principal axes of the undeformed body, or the symmetric matrix, with the products -int x y dm beside its
        diagonal.
    young
        Young's modulus at small strains (Pa). Default: required; in a region, that of the body. It follows from the
        constants of a law that has them.
    poisson
        Poisson's ratio at small strains, below 0.5 (no unit). Default: required; in a region, that of the body. It
        follows from the law's `bulk`, if that is given.
    viscosity
        the viscous modulus (Pa s). Default: 0; in a region, that of the body. Equilibria do not depend on it.
    mass_damping
        damping in proportion to mass: force -a M v (1/s). Default: 0; in a region, that of the body. As of air or
        water around: it brakes motions of the whole body, too. Vibrations of circular frequency omega are damped by
        the ratio a / (2 omega).
    branch
        Maxwell branches, springs that relax. Default: none; in a region, those of the body.
    fibres
        families of fibres that stiffen it along their course. Default: none; in a region, those of the body.
    law
        what becomes of the moduli at large strains. Default: as `strain` says: linear elasticity with Cauchy's, St.
        Venant-Kirchhoff with Green's.
    """
    return _table(
        density=density,
        rigid=rigid,
        mass=mass,
        centre=centre,
        inertia=inertia,
        young=young,
        poisson=poisson,
        viscosity=viscosity,
        mass_damping=mass_damping,
        branch=branch,
        fibres=fibres,
        law=law,
    )


def branch(
    *,
    share: float,
    time: float,
    yield_stress: float | None = None,
) -> dict:
    r"""A spring and a damper in a row, beside the elasticity of the material: what is strained at once and kept so pulls
    by the spring, less and less, as exp(-t / `time`). `young` is what is left when all has relaxed. For BDF, Adams,
    ARKODE and `rk`, and for equilibria. Energies and forces have its part, fields and sensors of stress do not.

    Parameters
    ----------
    share
        Young's modulus of the spring by that of the material (no unit). Required.
    time
        the relaxation time (s). Required.
    yield_stress
        the von Mises stress below which nothing relaxes (Pa). Default: 0. Above it G' = (1 - `yield_stress` / q)
        dev(E - G) / `time`, q being the spring's: what shears relaxes down to it, a change of volume does not, and
        what has flowed stays, as in dough.
    """
    return _table(
        share=share,
        time=time,
        yield_stress=yield_stress,
    )


def fibres(
    *,
    young: float,
    stiffening: float | None = None,
    along: Vector | None = None,
    centre: Vector | None = None,
    axis: Vector | None = None,
    pitch: float | None = None,
) -> dict:
    r"""Fibres that run through the material and take tension: with their stretch l and E = (l^2 - 1)/2 they add the
    energy (`young` / (8 k2)) (exp(4 k2 E^2) - 1) per natural volume where l > 1, k2 being `stiffening`. They lie
    along a vector, or around an axis: threads wound around an actuator. For bodies with Green's strain; stresses in
    results are those of the material between them.

    Parameters
    ----------
    young
        Young's modulus that they add along their course: of a fibre, times its share of the section (Pa). Required.
    stiffening
        how fast they stiffen (no unit). Default: 0.
    along
        a vector along them, of any length. Default: none.
    centre
        a point of the axis that they run around (m). Default: none.
    axis
        direction of the axis, of any length; none in the plane. Default: across the plane.
    pitch
        angle by which they climb along the axis: 0 are rings, others helices (rad). Default: 0.
    """
    return _table(
        young=young,
        stiffening=stiffening,
        along=along,
        centre=centre,
        axis=axis,
        pitch=pitch,
    )


def law_st_venant_kirchhoff(
) -> dict:
    r"""Law of the kind "st-venant-kirchhoff": Hooke's law for Green's strain: for small strains and any rotation; it
    softens under compression, and collapses.
    """
    return _table(
        kind="st-venant-kirchhoff",
    )


def law_neo_hookean(
) -> dict:
    r"""Law of the kind "neo-hookean": W = c1 (I1 - 3) + U, c1 = mu/2: rubber and silicone up to a strain of a half.
    """
    return _table(
        kind="neo-hookean",
    )


def law_mooney_rivlin(
    *,
    c1: float,
    c2: float,
    bulk: float | None = None,
) -> dict:
    r"""Law of the kind "mooney-rivlin": W = c1 (I1 - 3) + c2 (I2 - 3) + U: rubber up to a strain of one; mu = 2 (c1 +
    c2).

    Parameters
    ----------
    c1
        the constant of I1 (Pa). Required.
    c2
        the constant of I2 (Pa). Required.
    bulk
        the bulk modulus kappa (Pa). Default: that of `poisson`.
    """
    return _table(
        kind="mooney-rivlin",
        c1=c1,
        c2=c2,
        bulk=bulk,
    )


def law_yeoh(
    *,
    c1: float,
    c2: float,
    c3: float,
    bulk: float | None = None,
) -> dict:
    r"""Law of the kind "yeoh": W = c1 (I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3 + U: rubber that stiffens before it tears;
    mu = 2 c1.

    Parameters
    ----------
    c1
        the constant of I1 (Pa). Required.
    c2
        the constant of (I1 - 3)^2 (Pa). Required.
    c3
        the constant of (I1 - 3)^3 (Pa). Required.
    bulk
        the bulk modulus kappa (Pa). Default: that of `poisson`.
    """
    return _table(
        kind="yeoh",
        c1=c1,
        c2=c2,
        c3=c3,
        bulk=bulk,
    )


def law_ogden(
    *,
    moduli: Sequence[float],
    exponents: Sequence[float],
    bulk: float | None = None,
) -> dict:
    r"""Law of the kind "ogden": W = sum of mu_p / alpha_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3) + U, with the
    principal stretches l of J^(-2/3) C: rubber over its whole range; 2 mu = sum of mu_p alpha_p.

    Parameters
    ----------
    moduli
        mu_p of one to three terms (Pa). Required.
    exponents
        alpha_p of the same terms (no unit). Required.
    bulk
        the bulk modulus kappa (Pa). Default: that of `poisson`.
    """
    return _table(
        kind="ogden",
        moduli=moduli,
        exponents=exponents,
        bulk=bulk,
    )


def law_corotated(
) -> dict:
    r"""Law of the kind "corotated": W = mu |U - I|^2 + (lambda/2) tr(U - I)^2 with the stretch U of each point: Hooke's
    law in a frame that turns along, for large rotations and small strains; it does not collapse under compression.
    """
    return _table(
        kind="corotated",
    )


def region(
    *,
    material: dict,
    name: str | None = None,
    box: Sequence[Vector] | None = None,
    group: str | None = None,
    cells: Sequence[int] | None = None,
) -> dict:
    r"""A part of the body with a material of its own. A cell of several regions has the keys of all of them: where two
    give the same key, that of the later one in the file counts.

    Parameters
    ----------
    material
        the keys of the material that differ. Required.
    name
        the name of the region, for who reads the file. Default: none.
    box
        the lower and the upper corner (m). Default: none.
    group
        the name of a group of cells. Default: none. A physical group of Gmsh.
    cells
        numbers of cells, from 1. Default: none.
    """
    return _table(
        material=material,
        name=name,
        box=box,
        group=group,
        cells=cells,
    )


def point(
    *,
    name: str,
    position: Vector,
    mass: float,
    body: str | None = None,
) -> dict:
    r"""A point mass: a node that belongs to no cell. Its name is a node set.

    Parameters
    ----------
    name
        the name of the point. Required.
    position
        its undeformed position (m). Required.
    mass
        its mass (kg). Required.
    body
        the name of the body that it is a node of. Default: required with several bodies.
    """
    return _table(
        name=name,
        position=position,
        mass=mass,
        body=body,
    )


def initial(
    *,
    from_: str | None = None,
    velocity: Vector | None = None,
    spin: float | Sequence[float] | None = None,
    nodes: dict | Sequence[dict] | None = None,
) -> dict:
    r"""How the body moves at first. What the first phase holds or moves takes its part of that, as by an impact. In
    statics nothing moves, and the search begins at the displacements of a state `from`.

    Parameters
    ----------
    from_
        the state that `pliant run` or `pliant static` has left of bodies with the same meshes: the directory, or its
        `state.json`, relative to the scene file. Default: undeformed, at rest. It gives all unknowns by the names of
        bodies, chambers, actuators and pipes: displacements, velocities, Maxwell branches, masses of gas and liquid,
        lags, flow rates; what only one of both has is a warning. All else may differ. Time begins anew, and with it
        signals and paths: an obstacle is where the scene has it at t = 0.
    velocity
        the velocity of all nodes (m/s). Default: 0. Not beside a state `from` which they move already.
    spin
        the angular velocity about the centre of mass, on top of that (rad/s). Default: 0. One number in the plane,
        counter-clockwise; three in space.
    nodes
        nodes with velocities of their own instead. Default: none.
    """
    return _table(
        from_=from_,
        velocity=velocity,
        spin=spin,
        nodes=nodes,
    )


def initial_nodes(
    *,
    nodes: Nodes,
    velocity: Vector,
) -> dict:
    r"""Nodes with a velocity of their own at first.

    Parameters
    ----------
    nodes
        nodes. Required.
    velocity
        their velocity (m/s). Required.
    """
    return _table(
        nodes=nodes,
        velocity=velocity,
    )


def tie(
    *,
    nodes: Nodes,
    to: str,
) -> dict:
    r"""Nodes of one body that are glued to another, whose mesh need not match: in all phases each moves with the point at
    which it is. Of two surfaces either may be named: nodes of the finer one follow the coarser one, and those of a
    deformable one a rigid one.

    Parameters
    ----------
    nodes
        the nodes. Required.
    to
        the name of the body that they are glued to. Required.
    """
    return _table(
        nodes=nodes,
        to=to,
    )


def touch(
    *,
    name: str | None = None,
    bodies: Sequence[str] | None = None,
    law: Literal["barrier", "spring"] | None = None,
    stiffness_density: float | None = None,
    distance: float | None = None,
    damping_density: float | None = None,
    friction_coefficient: float | dict | None = None,
    sticking_speed: float | None = None,
) -> dict:
    r"""Contact of bodies with each other and with themselves: surfaces nearer than `distance` D push each other apart, by
    the pressure k (D - d)^2 (D + 2 d)/(3 d^2) of a barrier at the distance d, which nothing passes, or by k (D - d)
    of a spring.

    Parameters
    ----------
    name
        the name of the contact, for sensors. Default: touch.
    bodies
        the bodies that touch each other; a single one touches itself. Default: all, and each of them itself.
    law
        how the pressure grows. Default: barrier.
    stiffness_density
        the stiffness k per area (N/m^3). Default: a tenth of the least Young's modulus over D; all of it for a
        spring.
    distance
        the distance D from which on nothing acts (m). Default: a tenth of the mean edge of the surfaces.
    damping_density
        the damping along the normal, per area (N s/m^3). Default: 0.
    friction_coefficient
        Coulomb's coefficient of friction, or both of them (no unit). Default: 0.
    sticking_speed
        the speed below which friction sticks (m/s). Default: a thousandth of the size of the bodies per second.
    """
    return _table(
        name=name,
        bodies=bodies,
        law=law,
        stiffness_density=stiffness_density,
        distance=distance,
        damping_density=damping_density,
        friction_coefficient=friction_coefficient,
        sticking_speed=sticking_speed,
    )


def friction_coefficient(
    *,
    static: float,
    kinetic: float,
) -> dict:
    r"""Two coefficients of friction.

    Parameters
    ----------
    static
        the friction coefficient at rest (no unit). Required.
    kinetic
        the friction coefficient of what slides (no unit). Required.
    """
    return _table(
        static=static,
        kinetic=kinetic,
    )


def spring(
    *,
    ends: Sequence[Nodes | dict],
    name: str | None = None,
    stiffness: float | None = None,
    length: float | None = None,
    damping: float | None = None,
) -> dict:
    r"""A spring with damper and actuator between two nodes, or a node and a fixed point. It acts in all phases; `actuate`
    in a phase adds a force.

    Parameters
    ----------
    ends
        one node each, by number or name, or a point of space. Required.
    name
        the name of the spring. Default: spring 1, spring 2, ...
    stiffness
        the stiffness (N/m). Default: 0.
    length
        the natural length (m). Default: that at the start.
    damping
        the damping (N s/m). Default: 0.
    """
    return _table(
        ends=ends,
        name=name,
        stiffness=stiffness,
        length=length,
        damping=damping,
    )


def ends(
    *,
    point: Vector,
) -> dict:
    r"""The end of a spring that is a fixed point of space.

    Parameters
    ----------
    point
        where it is (m). Required.
    """
    return _table(
        point=point,
    )


def cable(
    *,
    path: Sequence[Nodes | dict],
    name: str | None = None,
    stiffness: float | None = None,
    length: float | None = None,
    damping: float | None = None,
    winch: bool | None = None,
    friction_coefficient: float | dict | None = None,
    sticking_speed: float | None = None,
) -> dict:
    r"""A cable (tendon) along a path, straight from place to place and free to slide around those between its ends. It
    only pulls, by one tension along all of its path if there is no friction. It acts in all phases; `actuate` in a
    phase drives it, at its first place.

    Parameters
    ----------
    path
        nodes, by number, name or box, places in the body, and points of space, in order. Required. Nodes of a set or
        a box follow each other by their distance from the place before them, or from the first of them.
    name
        the name of the cable. Default: spring 1, spring 2, ...
    stiffness
        the stiffness (N/m). Default: 0. With the modulus E and the section A it is E A / length.
    length
        the natural length (m). Default: that of the path at the start.
    damping
        the damping (N s/m). Default: 0. That of a motor whose tension falls from f at rest to 0 at the speed v is
        f/v.
    winch
        whether `actuate` gives the length that is drawn in, not the tension. Default: false.
    friction_coefficient
        Coulomb's coefficient of friction, or both of them (no unit). Default: 0.
    sticking_speed
        the speed below which it creeps instead of sticking (m/s). Default: 0.001 times its length per second.
    """
    return _table(
        path=path,
        name=name,
        stiffness=stiffness,
        length=length,
        damping=damping,
        winch=winch,
        friction_coefficient=friction_coefficient,
        sticking_speed=sticking_speed,
    )


def inside(
    *,
    inside: Vector,
) -> dict:
    r"""A place in the body by which a cable is led. It moves with the body, and is the same on a finer mesh.

    Parameters
    ----------
    inside
        its undeformed position, within a cell or on the surface (m). Required.
    """
    return _table(
        inside=inside,
    )


def muscle(
    *,
    name: str | None = None,
    along: Vector | None = None,
    centre: Vector | None = None,
    axis: Vector | None = None,
    pitch: float | None = None,
    box: Sequence[Vector] | None = None,
    group: str | None = None,
    cells: Sequence[int] | None = None,
    hill: dict | None = None,
) -> dict:
    r"""Fibres in a body that pull by a stress of their own, which `actuate` in a phase gives: a force per section of the
    undeformed shape, however long they are, in addition to the elasticity of the material. They lie along a vector,
    or around an axis, in all of the body or in the cells of a `box`, a `group` or a list. For bodies with Green's
    strain.

    Parameters
    ----------
    name
        the name of the muscle, which no spring has. Default: muscle 1, muscle 2, ...
    along
        a vector along them, of any length. Default: none.
    centre
        a point of the axis that they run around (m). Default: none.
    axis
        direction of the axis, of any length; none in the plane. Default: across the plane.
    pitch
        angle by which they climb along the axis: 0 are rings, others helices (rad). Default: 0.
    box
        the lower and the upper corner (m). Default: none.
    group
        the name of a group of cells. Default: none. A physical group of Gmsh.
    cells
        numbers of cells, from 1. Default: none.
    hill
        lets it pull less far from its best length and as it shortens. Default: it pulls alike.
    """
    return _table(
        name=name,
        along=along,
        centre=centre,
        axis=axis,
        pitch=pitch,
        box=box,
        group=group,
        cells=cells,
        hill=hill,
    )


def hill(
    *,
    largest: float,
    optimal: float | None = None,
    width: float | None = None,
    rate: float | None = None,
    shape: float | None = None,
    eccentric: float | None = None,
) -> dict:
    r"""Hill's law of a muscle: it pulls by `stress` f_l f_v, the `stress` of `actuate` being activation (0 to 1) times
    `largest`. With the length L of its fibres in best lengths and its rate V by `rate`, f_l = exp(-(L - 1)^2 /
    `width`), and f_v = (1 + V) / (1 - V / `shape`) as they shorten (0 where that is faster than `rate`); as they
    lengthen f_v grows, at first alike, to `eccentric`. The defaults are values of D. G. Thelen (2003) for young
    adults.

    Parameters
    ----------
    largest
        the stress of full activation at the best length, while that does not change (Pa). Required.
    optimal
        the best length, by that in the undeformed shape (no unit). Default: 1.
    width
        the square of the width of f_l (no unit). Default: 0.45.
    rate
        the fastest shortening, in best lengths per second (1/s). Default: 10.
    shape
        Hill's a by the force at rest: the smaller, the more f_v is bent (no unit). Default: 0.25.
    eccentric
        the limit of f_v in fast lengthening (no unit). Default: 1.4.
    """
    return _table(
        largest=largest,
        optimal=optimal,
        width=width,
        rate=rate,
        shape=shape,
        eccentric=eccentric,
    )


def growth(
    *,
    name: str | None = None,
    along: Vector | None = None,
    centre: Vector | None = None,
    axis: Vector | None = None,
    pitch: float | None = None,
    across: float | None = None,
    keeps_volume: bool | None = None,
    box: Sequence[Vector] | None = None,
    group: str | None = None,
    cells: Sequence[int] | None = None,
) -> dict:
    r"""Cells that swell, expand by heat or change their shape as active materials do, by the strain that `actuate` in a
    phase gives: what is free gets 1 + strain times as long, without stress. Alike in all directions, or along a
    vector or around an axis, as fibres run; across that they keep their size, or change it by a share of the strain
    or so that their volume stays. All of the body, or the cells of a `box`, a `group` or a list. For Green's strain
    with any law.

    Parameters
    ----------
    name
        the name of the growth, which no spring and no muscle has. Default: growth 1, growth 2, ...
    along
        a vector along which they grow, of any length. Default: alike in all directions.
    centre
        a point of the axis around which they grow (m). Default: none.
    axis
        direction of the axis, of any length; none in the plane. Default: across the plane.
    pitch
        angle by which the direction of growth climbs along the axis: 0 are rings, others helices (rad). Default: 0.
    across
        growth across the direction, by that along it: 0 is none, 1 is alike (no unit). Default: 0.
    keeps_volume
        whether they get thinner across the direction as they grow along it, and keep their volume. Default: false.
    box
        the lower and the upper corner (m). Default: none.
    group
        the name of a group of cells. Default: none. A physical group of Gmsh.
    cells
        numbers of cells, from 1. Default: none.
    """
    return _table(
        name=name,
        along=along,
        centre=centre,
        axis=axis,
        pitch=pitch,
        across=across,
        keeps_volume=keeps_volume,
        box=box,
        group=group,
        cells=cells,
    )


def lag(
    *,
    actuators: str | Sequence[str],
    time: float | None = None,
    rise: float | None = None,
    fall: float | None = None,
    activation: bool | None = None,
    capacity: float | None = None,
    loss: float | None = None,
    per_kelvin: float | None = None,
) -> dict:
    r"""Actuators that follow their commands with a delay: a' = (s - a)/T, with the command s of `actuate` and the state
    a, 0 at first, which drives the actuator. T is a `time`, or one for rising and one for falling. With `activation`,
    the muscle's a by its largest stress, T is `rise` (0.5 + 1.5 a) and `fall`/(0.5 + 1.5 a) (D. G. Thelen (2003)).
    What is heated is commanded by a power: `capacity` theta' = power - `loss` theta, and `per_kelvin` theta drives
    it.

    Parameters
    ----------
    actuators
        names of springs, cables, muscles and growths, each with a state of its own. Required.
    time
        the time after which 1/e of a step is left (s). Default: none.
    rise
        that for commands above the state (s). Default: none.
    fall
        that for commands below the state (s). Default: none.
    activation
        whether it is the activation of muscles by Hill's law. Default: false.
    capacity
        the heat of a kelvin (J/K). Default: none.
    loss
        the power that a kelvin gives away (W/K). Default: none.
    per_kelvin
        the actuation per kelvin of temperature rise: a force, a tension, a length of a winch, a stress or a strain
        (N, m, Pa or 1 by K). Default: none. Of a spring below 0 if it contracts as it gets warm.
    """
    return _table(
        actuators=actuators,
        time=time,
        rise=rise,
        fall=fall,
        activation=activation,
        capacity=capacity,
        loss=loss,
        per_kelvin=per_kelvin,
    )


def magnet(
    *,
    remanence: Vector,
    box: Sequence[Vector] | None = None,
    group: str | None = None,
    cells: Sequence[int] | None = None,
) -> dict:
    r"""A part of the body that is a hard magnet, on which the `magnetic_field` of a phase acts: its remanence moves along
    with the material. All of the body, or the cells of a `box`, a `group` or a list.

    Parameters
    ----------
    remanence
        the remanence in the undeformed shape (T). Required. Of elastomers filled with powder some 0.1 T, of magnets
        of neodymium 1.3 T.
    box
        the lower and the upper corner (m). Default: none.
    group
        the name of a group of cells. Default: none. A physical group of Gmsh.
    cells
        numbers of cells, from 1. Default: none.
    """
    return _table(
        remanence=remanence,
        box=box,
        group=group,
        cells=cells,
    )


def dipole(
    *,
    moment: Sequence[Formula],
    name: str | None = None,
    position: Sequence[Formula] | None = None,
    times: Sequence[float] | None = None,
    positions: Sequence[Vector] | None = None,
) -> dict:
    r"""An external magnet with prescribed motion: a point dipole of the moment m at p, whose field mu_0/(4 pi) (3 (m . r)
    r/|r|^5 - m/|r|^3), r = x - p, acts on each `[[magnet]]` at its deformed place. In the plane it is that of a
    dipole in space which lies in the plane of the body, as its moment does. It acts in all phases; `drive` in a phase
    moves it and changes its moment.

    Parameters
    ----------
    moment
        the moment m (A m^2). Required. Of a magnet of the remanence b and the volume V it is b V/mu_0: 1.03 for 1
        cm^3 of neodymium of 1.3 T.
    name
        the name of the dipole. Default: dipole 1, dipole 2, ...
    position
        the position p (m). Default: none.
    times
        times in ascending order (s). Default: none.
    positions
        the positions at these times (m). Default: none.
    """
    return _table(
        moment=moment,
        name=name,
        position=position,
        times=times,
        positions=positions,
    )


def chamber(
    *,
    name: str,
    nodes: Nodes | None = None,
    triangles: Sequence[Sequence[int]] | None = None,
    closed_by_line: bool | None = None,
    closed_by_lid: bool | None = None,
    thickness: float | None = None,
    burst: float | None = None,
) -> dict:
    r"""A closed space that `pressure` in a phase blows up, unless it has `[[gas]]` or a `[[liquid]]`.

    Parameters
    ----------
    name
        the name of the chamber. Required.
    nodes
        the nodes of its walls: part of the boundary, or a closed polygon of numbers. Default: none.
    triangles
        the triangles of its walls in space, by the numbers of their nodes. Default: none. A closed surface, all of
        them counter-clockwise as seen from outside, or all clockwise.
    closed_by_line
        whether walls in the plane that are open are closed by the straight line between their ends. Default: false.
        Without it a gap is an error.
    closed_by_lid
        whether walls in space that are open are closed by lids on their rims, from the mean of a rim's nodes to its
        edges. Default: false. Without it a rim is an error. The nodes of the rim feel the pressure on its lid.
    thickness
        the thickness (m). Default: that of the body.
    burst
        the pressure, above that outside, at which it bursts (Pa). Default: none. The first step that ends with more
        ends the run, with an error that says when and how much.
    """
    return _table(
        name=name,
        nodes=nodes,
        triangles=triangles,
        closed_by_line=closed_by_line,
        closed_by_lid=closed_by_lid,
        thickness=thickness,
        burst=burst,
    )


def gas(
    *,
    chamber: str,
    pressure: float | None = None,
    exponent: float | None = None,
) -> dict:
    r"""An amount of gas in a chamber, in place of a `pressure` of phases. Its absolute pressure is p_0 (V_0 m/(V m_0))^n,
    with the volume V and the amount m; the walls are pressed by what it exceeds the `atmosphere` of the file by. The
    amount changes by orifices alone.

    Parameters
    ----------
    chamber
        the name of the chamber. Required.
    pressure
        the absolute pressure p_0 in the undeformed shape (Pa). Default: 101325. There it fills the volume V_0 with
        m_0 = p_0 V_0 1.185e-5 kg of air at 20 C.
    exponent
        the exponent n (no unit). Default: 1. 1 is isothermal, 1.4 adiabatic, and what is between them polytropic.
    """
    return _table(
        chamber=chamber,
        pressure=pressure,
        exponent=exponent,
    )


def supply(
    *,
    name: str,
    pressure: Formula,
) -> dict:
    r"""What orifices draw gas from, or a vacuum into which they let it.

    Parameters
    ----------
    name
        the name of the supply. Required.
    pressure
        its absolute pressure (Pa). Required. A number, or a formula of `t`.
    """
    return _table(
        name=name,
        pressure=pressure,
    )


def orifice(
    *,
    name: str,
    from_: str,
    to: str,
    conductance: float | None = None,
    critical_ratio: float | None = None,
    area: float | None = None,
    discharge: float | None = None,
) -> dict:
    r"""An orifice, a valve or a leak, through which gas flows either way (ISO 6358-1): from the absolute pressure p_1 to
    the lower p_2 q = C rho_0 p_1 sqrt(T_0/T_1) sqrt(1 - ((p_2/p_1 - b)/(1 - b))^2), without the last root if p_2/p_1
    < b, and with a cubic in place of it if p_2/p_1 > 0.999; rho_0 = 1.185 kg/m^3. With an `area` it is a nozzle
    without losses up to its narrowest section, q = C_d A p_1/sqrt(R T_1) sqrt(7 (r^(2/1.4) - r^(2.4/1.4))), r =
    p_2/p_1 but not below 0.528. `open` in a phase says how far it is open; without it, wholly.

    Parameters
    ----------
    name
        the name of the orifice. Required.
    from_
        one end: a supply, a chamber with gas, or `atmosphere`. Required.
    to
        the other end, likewise. Required.
    conductance
        the sonic conductance C (m^3/(s Pa)). Default: none. 1e-8 are 0.6 l/min for each bar; a short nozzle has some
        2e-3 times its area in m^2.
    critical_ratio
        the critical ratio b of pressures, from 0 to below 1 (no unit). Default: 0.5.
    area
        the area A of a nozzle (m^2). Default: none.
    discharge
        its coefficient of discharge C_d, above 0 and up to 1 (no unit). Default: 1. Some 0.95 of one that is round,
        0.6 to 0.85 of a hole with sharp edges.
    """
    return _table(
        name=name,
        from_=from_,
        to=to,
        conductance=conductance,
        critical_ratio=critical_ratio,
        area=area,
        discharge=discharge,
    )


def liquid(
    *,
    chamber: str,
    bulk_modulus: float | None = None,
    density: float | None = None,
    fill: float | None = None,
    surface: bool | None = None,
) -> dict:
    r"""A liquid that fills a chamber, or stands in it with a `surface`, in place of a `pressure` of phases. Above that
    outside it has the pressure p = K (V_m - V)/V_m, with the volume V of the chamber and the volume V_m that it would
    have without pressure, which a `flow` in phases changes. Where there is gravity it has weight: p is the mean, and
    the pressure on the walls grows with depth. Its own motion, its inertia, is left out.

    Parameters
    ----------
    chamber
        the name of the chamber. Required.
    bulk_modulus
        the bulk modulus K (Pa). Default: 2.2e9, water.
    density
        the density without pressure (kg/m^3). Default: 1000.
    fill
        V_m at the start, as a part of the volume of the undeformed chamber (no unit). Default: 1. With 1 there is no
        pressure at first; with a `surface` it has to be below 1.
    surface
        whether it has a level surface under air of the pressure outside, in a chamber that is open or vented and not
        full. Default: false. It is not compressed: walls feel rho g (h - z) below the level h, which follows from the
        volume, and nothing above it. Needs gravity.
    """
    return _table(
        chamber=chamber,
        bulk_modulus=bulk_modulus,
        density=density,
        fill=fill,
        surface=surface,
    )


def pipe(
    *,
    name: str,
    from_: str,
    to: str,
    length: float,
    area: float,
    viscosity: float | None = None,
    loss: float | None = None,
) -> dict:
    r"""A pipe or a tube between two chambers with liquids of the same density, or between one and a `[[supply]]` or the
    atmosphere. Its flow q, from the first end to the second, follows (rho l/A) dq/dt = p_1 - p_2 + rho g (z_1 - z_2)
    - R q - zeta rho q |q|/(2 A^2), R = 8 pi mu l/A^2. Of a chamber that is full p is the mean pressure and z the
    height of its middle, of one with a `surface` p is 0 and z the level; a supply and the atmosphere are at the
    height that the chamber at the other end has in the undeformed shape.

    Parameters
    ----------
    name
        the name of the pipe. Required.
    from_
        one end: a chamber with a liquid, a supply, or `atmosphere`. Required.
    to
        the other end, likewise. Required.
    length
        the length l (m). Required.
    area
        the area A of its section (m^2). Required. A tube 4 mm wide has 1.26e-5.
    viscosity
        the viscosity mu of the liquid (Pa s). Default: 1e-3, water.
    loss
        the coefficient zeta of losses at ends, bends and valves (no unit). Default: 0. Some 0.5 where it begins with
        sharp edges, 1 where it ends in a chamber.
    """
    return _table(
        name=name,
        from_=from_,
        to=to,
        length=length,
        area=area,
        viscosity=viscosity,
        loss=loss,
    )


def fluid(
    *,
    density: float,
    name: str | None = None,
    drag: float | None = None,
    skin_drag: float | None = None,
    added_mass: float | None = None,
    velocity: Sequence[Formula] | None = None,
    level: float | None = None,
    nodes: Nodes | None = None,
) -> dict:
    r"""A fluid around bodies, crudely: what it does to each face of their boundary by itself, without a wake. With the
    velocity w of the body relative to the fluid, w_n along the normal n and w_t along the face, drag is the traction
    -(rho/2) (C_n |w_n| w_n n + C_t |w_t| w_t); `added_mass` moves along with the faces in all directions alike; below
    the `level` there is the pressure rho g times the depth. One of them at least is needed.

    Parameters
    ----------
    density
        the density rho (kg/m^3). Required. Of water 1000, of air 1.2.
    name
        the name of the fluid. Default: fluid 1, fluid 2, ...
    drag
        the coefficient C_n of drag along the normal (no unit). Default: 0. Faces at the front and at the back both
        count: 0.6 to 1 for plates, 0.75 to 0.9 for cylinders across, 0.5 for spheres.
    skin_drag
        the coefficient C_t of drag along the face (no unit). Default: 0. Some 0.003 to 0.01 at Reynolds numbers of
        1e4 to 1e6.
    added_mass
        the mass of fluid that moves along with the undeformed area (kg/m^2). Default: 0. The density times R/6 for a
        sphere of radius R, R/2 for a cylinder across, pi c/8 on both sides of a plate of width c.
    velocity
        the velocity of the fluid, a current (m/s). Default: 0.
    level
        the height of its surface above the origin, against gravity (m). Default: no pressure by depth.
    nodes
        the nodes of the faces that it acts on. Default: all. Those inside of bodies do not matter.
    """
    return _table(
        density=density,
        name=name,
        drag=drag,
        skin_drag=skin_drag,
        added_mass=added_mass,
        velocity=velocity,
        level=level,
        nodes=nodes,
    )


def wind(
    *,
    drag: float,
    name: str | None = None,
    skin_drag: float | None = None,
    density: float | None = None,
    nodes: Nodes | None = None,
) -> dict:
    r"""Air that drags faces along with its velocity relative to theirs, as a `[[fluid]]` does, and whose `velocity`
    phases `set`: 0 where they do not.

    Parameters
    ----------
    drag
        the coefficient C_n of drag along the normal (no unit). Required. Faces at the front and at the back both
        count: 0.6 to 1 for plates, 0.75 to 0.9 for cylinders across, 0.5 for spheres.
    name
        the name of the wind. Default: wind 1, wind 2, ...
    skin_drag
        the coefficient C_t of drag along the face (no unit). Default: 0.
    density
        the density of the air (kg/m^3). Default: 1.2.
    nodes
        the nodes of the faces that it blows on. Default: all. Those inside of bodies do not matter.
    """
    return _table(
        drag=drag,
        name=name,
        skin_drag=skin_drag,
        density=density,
        nodes=nodes,
    )


def obstacle_half_plane(
    *,
    point: Vector,
    normal: Vector,
    name: str | None = None,
    stiffness: float | None = None,
    stiffness_density: float | None = None,
    damping: float | None = None,
    tangential_damping: float | None = None,
    friction_coefficient: float | dict | None = None,
    sticking_speed: float | None = None,
    backward: dict | None = None,
    adhesion: bool | None = None,
    velocity: Vector | None = None,
    path: dict | None = None,
) -> dict:
    r"""Obstacle of the kind "half-plane": all that lies beyond an edge (in space, a face).

    Parameters
    ----------
    point
        a point on its edge (m). Required.
    normal
        the direction out of it (no unit). Required.
    name
        the name of the obstacle. Default: obstacle 1, ...
    stiffness
        the stiffness per node (N/m). Default: none.
    stiffness_density
        the stiffness per area of the body's boundary (N/m^3). Default: none.
    damping
        the damping along the normal (N s/m). Default: 0.
    tangential_damping
        a force against sliding in proportion to its speed (N s/m). Default: 0.
    friction_coefficient
        Coulomb's coefficient of friction, or both of them (no unit). Default: 0.
    sticking_speed
        the speed below which friction sticks (m/s). Default: a thousandth of the size of the body per second.
    backward
        a way in which friction is larger, as by bristles, scales or claws. Default: none.
    adhesion
        whether damping may pull at a body that leaves. Default: false.
    velocity
        the velocity of the obstacle (m/s). Default: 0.
    path
        the path of the obstacle, in place of a velocity. Default: none.
    """
    return _table(
        kind="half-plane",
        point=point,
        normal=normal,
        name=name,
        stiffness=stiffness,
        stiffness_density=stiffness_density,
        damping=damping,
        tangential_damping=tangential_damping,
        friction_coefficient=friction_coefficient,
        sticking_speed=sticking_speed,
        backward=backward,
        adhesion=adhesion,
        velocity=velocity,
        path=path,
    )


def obstacle_disc(
    *,
    centre: Vector,
    radius: float,
    name: str | None = None,
    stiffness: float | None = None,
    stiffness_density: float | None = None,
    damping: float | None = None,
    tangential_damping: float | None = None,
    friction_coefficient: float | dict | None = None,
    sticking_speed: float | None = None,
    backward: dict | None = None,
    adhesion: bool | None = None,
    velocity: Vector | None = None,
    path: dict | None = None,
    cavity: bool | None = None,
) -> dict:
    r"""Obstacle of the kind "disc": a disc (in space, a ball), or all around one.

    Parameters
    ----------
    centre
        the centre (m). Required.
    radius
        the radius (m). Required.
    name
        the name of the obstacle. Default: obstacle 1, ...
    stiffness
        the stiffness per node (N/m). Default: none.
    stiffness_density
        the stiffness per area of the body's boundary (N/m^3). Default: none.
    damping
        the damping along the normal (N s/m). Default: 0.
    tangential_damping
        a force against sliding in proportion to its speed (N s/m). Default: 0.
    friction_coefficient
        Coulomb's coefficient of friction, or both of them (no unit). Default: 0.
    sticking_speed
        the speed below which friction sticks (m/s). Default: a thousandth of the size of the body per second.
    backward
        a way in which friction is larger, as by bristles, scales or claws. Default: none.
    adhesion
        whether damping may pull at a body that leaves. Default: false.
    velocity
        the velocity of the obstacle (m/s). Default: 0.
    path
        the path of the obstacle, in place of a velocity. Default: none.
    cavity
        whether bodies are inside of it. Default: false.
    """
    return _table(
        kind="disc",
        centre=centre,
        radius=radius,
        name=name,
        stiffness=stiffness,
        stiffness_density=stiffness_density,
        damping=damping,
        tangential_damping=tangential_damping,
        friction_coefficient=friction_coefficient,
        sticking_speed=sticking_speed,
        backward=backward,
        adhesion=adhesion,
        velocity=velocity,
        path=path,
        cavity=cavity,
    )


def obstacle_box(
    *,
    min: Vector,
    max: Vector,
    name: str | None = None,
    stiffness: float | None = None,
    stiffness_density: float | None = None,
    damping: float | None = None,
    tangential_damping: float | None = None,
    friction_coefficient: float | dict | None = None,
    sticking_speed: float | None = None,
    backward: dict | None = None,
    adhesion: bool | None = None,
    velocity: Vector | None = None,
    path: dict | None = None,
    turn: float | Sequence[float] | None = None,
) -> dict:
    r"""Obstacle of the kind "box": a box along the axes, unless it is turned.

    Parameters
    ----------
    min
        the lower corner (m). Required.
    max
        the upper corner (m). Required.
    name
        the name of the obstacle. Default: obstacle 1, ...
    stiffness
        the stiffness per node (N/m). Default: none.
    stiffness_density
        the stiffness per area of the body's boundary (N/m^3). Default: none.
    damping
        the damping along the normal (N s/m). Default: 0.
    tangential_damping
        a force against sliding in proportion to its speed (N s/m). Default: 0.
    friction_coefficient
        Coulomb's coefficient of friction, or both of them (no unit). Default: 0.
    sticking_speed
        the speed below which friction sticks (m/s). Default: a thousandth of the size of the body per second.
    backward
        a way in which friction is larger, as by bristles, scales or claws. Default: none.
    adhesion
        whether damping may pull at a body that leaves. Default: false.
    velocity
        the velocity of the obstacle (m/s). Default: 0.
    path
        the path of the obstacle, in place of a velocity. Default: none.
    turn
        the angle by which the box is turned about its middle (rad). Default: 0. One number in the plane,
        counter-clockwise; in space three, the axis times the angle.
    """
    return _table(
        kind="box",
        min=min,
        max=max,
        name=name,
        stiffness=stiffness,
        stiffness_density=stiffness_density,
        damping=damping,
        tangential_damping=tangential_damping,
        friction_coefficient=friction_coefficient,
        sticking_speed=sticking_speed,
        backward=backward,
        adhesion=adhesion,
        velocity=velocity,
        path=path,
        turn=turn,
    )


def obstacle_capsule(
    *,
    from_: Vector,
    to: Vector,
    radius: float,
    name: str | None = None,
    stiffness: float | None = None,
    stiffness_density: float | None = None,
    damping: float | None = None,
    tangential_damping: float | None = None,
    friction_coefficient: float | dict | None = None,
    sticking_speed: float | None = None,
    backward: dict | None = None,
    adhesion: bool | None = None,
    velocity: Vector | None = None,
    path: dict | None = None,
) -> dict:
    r"""Obstacle of the kind "capsule": all that is no farther than `radius` from a straight line.

    Parameters
    ----------
    from_
        one end of its axis (m). Required.
    to
        the other end of its axis (m). Required.
    radius
        the radius (m). Required.
    name
        the name of the obstacle. Default: obstacle 1, ...
    stiffness
        the stiffness per node (N/m). Default: none.
    stiffness_density
        the stiffness per area of the body's boundary (N/m^3). Default: none.
    damping
        the damping along the normal (N s/m). Default: 0.
    tangential_damping
        a force against sliding in proportion to its speed (N s/m). Default: 0.
    friction_coefficient
        Coulomb's coefficient of friction, or both of them (no unit). Default: 0.
    sticking_speed
        the speed below which friction sticks (m/s). Default: a thousandth of the size of the body per second.
    backward
        a way in which friction is larger, as by bristles, scales or claws. Default: none.
    adhesion
        whether damping may pull at a body that leaves. Default: false.
    velocity
        the velocity of the obstacle (m/s). Default: 0.
    path
        the path of the obstacle, in place of a velocity. Default: none.
    """
    return _table(
        kind="capsule",
        from_=from_,
        to=to,
        radius=radius,
        name=name,
        stiffness=stiffness,
        stiffness_density=stiffness_density,
        damping=damping,
        tangential_damping=tangential_damping,
        friction_coefficient=friction_coefficient,
        sticking_speed=sticking_speed,
        backward=backward,
        adhesion=adhesion,
        velocity=velocity,
        path=path,
    )


def obstacle_union(
    *,
    parts: dict | Sequence[dict],
    name: str | None = None,
    stiffness: float | None = None,
    stiffness_density: float | None = None,
    damping: float | None = None,
    tangential_damping: float | None = None,
    friction_coefficient: float | dict | None = None,
    sticking_speed: float | None = None,
    backward: dict | None = None,
    adhesion: bool | None = None,
    velocity: Vector | None = None,
    path: dict | None = None,
) -> dict:
    r"""Obstacle of the kind "union": several shapes as one, which move together.

    Parameters
    ----------
    parts
        the shapes. Required.
    name
        the name of the obstacle. Default: obstacle 1, ...
    stiffness
        the stiffness per node (N/m). Default: none.
    stiffness_density
        the stiffness per area of the body's boundary (N/m^3). Default: none.
    damping
        the damping along the normal (N s/m). Default: 0.
    tangential_damping
        a force against sliding in proportion to its speed (N s/m). Default: 0.
    friction_coefficient
        Coulomb's coefficient of friction, or both of them (no unit). Default: 0.
    sticking_speed
        the speed below which friction sticks (m/s). Default: a thousandth of the size of the body per second.
    backward
        a way in which friction is larger, as by bristles, scales or claws. Default: none.
    adhesion
        whether damping may pull at a body that leaves. Default: false.
    velocity
        the velocity of the obstacle (m/s). Default: 0.
    path
        the path of the obstacle, in place of a velocity. Default: none.
    """
    return _table(
        kind="union",
        parts=parts,
        name=name,
        stiffness=stiffness,
        stiffness_density=stiffness_density,
        damping=damping,
        tangential_damping=tangential_damping,
        friction_coefficient=friction_coefficient,
        sticking_speed=sticking_speed,
        backward=backward,
        adhesion=adhesion,
        velocity=velocity,
        path=path,
    )


def obstacle_parts_half_plane(
    *,
    point: Vector,
    normal: Vector,
) -> dict:
    r"""Obstacle.parts of the kind "half-plane": all that lies beyond an edge (in space, a face).

    Parameters
    ----------
    point
        a point on its edge (m). Required.
    normal
        the direction out of it (no unit). Required.
    """
    return _table(
        kind="half-plane",
        point=point,
        normal=normal,
    )


def obstacle_parts_disc(
    *,
    centre: Vector,
    radius: float,
    cavity: bool | None = None,
) -> dict:
    r"""Obstacle.parts of the kind "disc": a disc (in space, a ball), or all around one.

    Parameters
    ----------
    centre
        the centre (m). Required.
    radius
        the radius (m). Required.
    cavity
        whether bodies are inside of it. Default: false.
    """
    return _table(
        kind="disc",
        centre=centre,
        radius=radius,
        cavity=cavity,
    )


def obstacle_parts_box(
    *,
    min: Vector,
    max: Vector,
    turn: float | Sequence[float] | None = None,
) -> dict:
    r"""Obstacle.parts of the kind "box": a box along the axes, unless it is turned.

    Parameters
    ----------
    min
        the lower corner (m). Required.
    max
        the upper corner (m). Required.
    turn
        the angle by which the box is turned about its middle (rad). Default: 0. One number in the plane,
        counter-clockwise; in space three, the axis times the angle.
    """
    return _table(
        kind="box",
        min=min,
        max=max,
        turn=turn,
    )


def obstacle_parts_capsule(
    *,
    from_: Vector,
    to: Vector,
    radius: float,
) -> dict:
    r"""Obstacle.parts of the kind "capsule": all that is no farther than `radius` from a straight line.

    Parameters
    ----------
    from_
        one end of its axis (m). Required.
    to
        the other end of its axis (m). Required.
    radius
        the radius (m). Required.
    """
    return _table(
        kind="capsule",
        from_=from_,
        to=to,
        radius=radius,
    )


def backward(
    *,
    direction: Vector,
    friction_coefficient: float,
) -> dict:
    r"""Larger friction against sliding one way; what slides at an angle to it has less, and all other ways have
    `friction_coefficient`.

    Parameters
    ----------
    direction
        the way in which friction is larger, in space. Required.
    friction_coefficient
        the static coefficient of friction that way (no unit). Required. The kinetic one is larger in proportion.
    """
    return _table(
        direction=direction,
        friction_coefficient=friction_coefficient,
    )


def obstacle_path(
    *,
    times: Sequence[float] | None = None,
    displacements: Sequence[Vector] | None = None,
    displacement: Sequence[Formula] | None = None,
) -> dict:
    r"""The obstacle runs smoothly (a cubic spline) through points, and begins and ends at rest; before and after it
    stays. Or it follows formulas without `abs`, `min`, `max` and `step`, which have no velocity at their kinks.

    Parameters
    ----------
    times
        times in ascending order (s). Default: none.
    displacements
        displacements, at these times, from where it was said to be (m). Default: none.
    displacement
        the displacement from where it was said to be (m). Default: none.
    """
    return _table(
        times=times,
        displacements=displacements,
        displacement=displacement,
    )


def phase(
    *,
    until: float,
    name: str | None = None,
    end: dict | None = None,
    gravity: Vector | None = None,
    hold: dict | Sequence[dict] | None = None,
    move: dict | Sequence[dict] | None = None,
    path: dict | Sequence[dict] | None = None,
    rotate: dict | Sequence[dict] | None = None,
    symmetry: dict | Sequence[dict] | None = None,
    hold_combination: dict | Sequence[dict] | None = None,
    load: dict | Sequence[dict] | None = None,
    moment: dict | Sequence[dict] | None = None,
    follower: dict | Sequence[dict] | None = None,
    pressure: dict | Sequence[dict] | None = None,
    pressure_on: dict | Sequence[dict] | None = None,
    open: dict | Sequence[dict] | None = None,
    flow: dict | Sequence[dict] | None = None,
    actuate: dict | Sequence[dict] | None = None,
    drive: dict | Sequence[dict] | None = None,
    set: dict | Sequence[dict] | None = None,
    magnetic_field: dict | None = None,
    contact: bool | str | Sequence[str] | None = None,
    project_velocity: bool | None = None,
) -> dict:
    r"""A stretch of time with its own constraints, loads and contacts. Displacements and velocities carry over from phase
    to phase. Times in it are those of the scene.

    Parameters
    ----------
    until
        the end of the phase (s). Required.
    name
        the name of the phase. Default: phase 1, ...
    end
        a sensor that ends the phase before. Default: at `until` alone.
    gravity
        the acceleration of gravity in this phase (m/s^2). Default: that of the file.
    hold
        nodes that stay where they are. Default: none.
    move
        nodes that move on. Default: none.
    path
        nodes that follow a path. Default: none.
    rotate
        nodes that turn. Default: none.
    symmetry
        nodes on planes of symmetry. Default: none.
    hold_combination
        sums of displacements that stay as they are. Default: none.
    load
        forces on nodes, tractions on faces. Default: none.
    moment
        moments on nodes. Default: none.
    follower
        forces and moments that turn with nodes. Default: none.
    pressure
        pressures in chambers. Default: none.
    pressure_on
        pressures on faces. Default: none.
    open
        openings of orifices. Default: none.
    flow
        flows of liquids into chambers. Default: none.
    actuate
        forces in springs and cables, stresses of muscles, strains of growth. Default: none.
    drive
        where dipoles are, and their moments. Default: none.
    set
        inputs of devices, such as winds. Default: none.
    magnetic_field
        the magnetic field. Default: none.
    contact
        the obstacles that act. Default: true. All, none, or those of these names.
    project_velocity
        whether the phase begins with velocities that its constraints allow. Default: false. What is taken away is
        lost, as in a perfectly plastic impact.
    """
    return _table(
        until=until,
        name=name,
        end=end,
        gravity=gravity,
        hold=hold,
        move=move,
        path=path,
        rotate=rotate,
        symmetry=symmetry,
        hold_combination=hold_combination,
        load=load,
        moment=moment,
        follower=follower,
        pressure=pressure,
        pressure_on=pressure_on,
        open=open,
        flow=flow,
        actuate=actuate,
        drive=drive,
        set=set,
        magnetic_field=magnetic_field,
        contact=contact,
        project_velocity=project_velocity,
    )


def end(
    *,
    sensor: str,
    above: float | None = None,
    below: float | None = None,
) -> dict:
    r"""A sensor that ends the phase as its reading passes a level, at `until` at the latest. One that begins beyond the
    level does not count before it has been on the other side. The next phase begins at once, and ends at its own
    `until`; the last phase has no such end.

    Parameters
    ----------
    sensor
        the name of the sensor, of one with several columns that of the column: `tip.y`. Required.
    above
        the level above which it rises, in the unit of the sensor. Default: none.
    below
        the level below which it falls. Default: none.
    """
    return _table(
        sensor=sensor,
        above=above,
        below=below,
    )


def hold(
    *,
    nodes: Nodes,
    axes: str | Sequence[str] | None = None,
) -> dict:
    r"""Nodes stay where they are when the phase begins.

    Parameters
    ----------
    nodes
        nodes. Required.
    axes
        the axes that are prescribed. Default: all of them.
    """
    return _table(
        nodes=nodes,
        axes=axes,
    )


def move(
    *,
    nodes: Nodes,
    velocity: float | Vector,
    axes: str | Sequence[str] | None = None,
) -> dict:
    r"""Nodes move on, with a constant velocity, from where they are when the phase begins.

    Parameters
    ----------
    nodes
        nodes. Required.
    velocity
        the velocity (m/s). Required.
    axes
        the axes that are prescribed. Default: all of them.
    """
    return _table(
        nodes=nodes,
        velocity=velocity,
        axes=axes,
    )


def path(
    *,
    nodes: Nodes,
    axes: str | Sequence[str] | None = None,
    times: Sequence[float] | None = None,
    displacements: Sequence[float | Vector] | None = None,
    displacement: Formula | Sequence[Formula] | None = None,
) -> dict:
    r"""Nodes run smoothly (a cubic spline) through points, and begin and end at rest; before and after they stay. Or they
    follow a formula without `abs`, `min`, `max` and `step`, which have no velocity at their kinks.

    Parameters
    ----------
    nodes
        nodes. Required.
    axes
        the axes that are prescribed. Default: all of them.
    times
        times in ascending order (s). Default: none.
    displacements
        displacements from the undeformed position at these times (m). Default: none. Not from where the nodes are
        when the phase begins: a path that begins elsewhere draws them there at once, which is warned of.
    displacement
        the displacement from the undeformed position, for each of the axes (m). Default: none.
    """
    return _table(
        nodes=nodes,
        axes=axes,
        times=times,
        displacements=displacements,
        displacement=displacement,
    )


def rotate(
    *,
    nodes: Nodes,
    centre: Vector,
    axis: Sequence[float] | None = None,
    rate: float | None = None,
    times: Sequence[float] | None = None,
    angles: Sequence[float] | None = None,
) -> dict:
    r"""Nodes turn about a point (in space, an axis) from where they are when the phase begins: at a constant rate, or
    smoothly (a cubic spline that begins and ends at rest) by what the angle has changed since then.

    Parameters
    ----------
    nodes
        nodes. Required.
    centre
        the point, or one of the axis (m). Required.
    axis
        the direction of the axis (no unit). Default: none. In space only; in the plane nodes turn counter-clockwise.
    rate
        the angular velocity (rad/s). Default: none.
    times
        times in ascending order (s). Default: none.
    angles
        angles at these times (rad). Default: none.
    """
    return _table(
        nodes=nodes,
        centre=centre,
        axis=axis,
        rate=rate,
        times=times,
        angles=angles,
    )


def symmetry(
    *,
    nodes: Nodes,
    normal: Vector,
) -> dict:
    r"""Nodes on a plane of symmetry keep their displacement along its normal, and slide freely in it. What is given node
    by node there has to be halved: loads, point masses, springs, `stiffness` of obstacles.

    Parameters
    ----------
    nodes
        nodes. Required.
    normal
        the normal of the plane, of any length (no unit). Required.
    """
    return _table(
        nodes=nodes,
        normal=normal,
    )


def hold_combination(
    *,
    terms: dict | Sequence[dict],
) -> dict:
    r"""A row of constraints: the sum of displacements, each times a coefficient, keeps the value that it has when the
    phase begins. Two nodes with 1 and -1 move alike along an axis.

    Parameters
    ----------
    terms
        the displacements. Required.
    """
    return _table(
        terms=terms,
    )


def terms(
    *,
    node: int,
    axis: Literal["x", "y", "z"],
    coefficient: float,
) -> dict:
    r"""One displacement of a row.

    Parameters
    ----------
    node
        the number of the node, from 1. Required.
    axis
        the axis. Required.
    coefficient
        the coefficient, other than 0 (no unit). Required.
    """
    return _table(
        node=node,
        axis=axis,
        coefficient=coefficient,
    )


def load(
    *,
    nodes: Nodes,
    force: Sequence[Formula] | None = None,
    total: Sequence[Formula] | None = None,
    traction: Sequence[Formula] | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    forces: Sequence[Vector] | None = None,
    totals: Sequence[Vector] | None = None,
    tractions: Sequence[Vector] | None = None,
) -> dict:
    r"""Forces on nodes, and tractions on the faces of the boundary (edges in the plane) between them. Those of tables are
    interpolated linearly, and constant before and after. Directions stay as the body turns.

    Parameters
    ----------
    nodes
        nodes. Required.
    force
        the force on each node (N). Default: none.
    total
        the force on all nodes together (N). Default: none. Spread evenly over the faces that the nodes make up; nodes
        without faces share it equally.
    traction
        the force per undeformed area of the faces (N/m^2). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    forces
        the force on each node at these times (N). Default: none.
    totals
        the force on all nodes at these times (N). Default: none.
    tractions
        the traction at these times (N/m^2). Default: none.
    """
    return _table(
        nodes=nodes,
        force=force,
        total=total,
        traction=traction,
        times=times,
        period=period,
        forces=forces,
        totals=totals,
        tractions=tractions,
    )


def moment(
    *,
    nodes: Nodes,
    moment: Sequence[Formula] | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    moments: Sequence[Vector] | None = None,
) -> dict:
    r"""Moments on nodes together, whose direction stays: couples of forces on the nodes, which stay free to deform. The
    nodes may be those of a rigid body. Moments of a table are interpolated linearly, and constant before and after.

    Parameters
    ----------
    nodes
        nodes. Required.
    moment
        the moment (N m). Default: none. In the plane a number, counter-clockwise; in space a vector.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    moments
        moments at these times (N m). Default: none.
    """
    return _table(
        nodes=nodes,
        moment=moment,
        times=times,
        period=period,
        moments=moments,
    )


def follower(
    *,
    nodes: Nodes,
    force: Sequence[Formula] | None = None,
    moment: Sequence[Formula] | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    forces: Sequence[Vector] | None = None,
    moments: Sequence[Vector] | None = None,
) -> dict:
    r"""Forces and moments on nodes together that turn with them, as the thrust of a jet at a tip: they are given for the
    undeformed shape. Those of a table are interpolated linearly, and constant before and after.

    Parameters
    ----------
    nodes
        nodes. Required.
    force
        the force on all nodes together (N). Default: none.
    moment
        the moment, in the plane a number (N m). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    forces
        forces at these times (N). Default: none.
    moments
        moments at these times (N m). Default: none.
    """
    return _table(
        nodes=nodes,
        force=force,
        moment=moment,
        times=times,
        period=period,
        forces=forces,
        moments=moments,
    )


def pressure(
    *,
    chamber: str,
    value: Formula | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    values: Sequence[float] | None = None,
) -> dict:
    r"""The pressure in a chamber, positive if it blows it up. That of a table is interpolated linearly, and is constant
    before and after.

    Parameters
    ----------
    chamber
        the name of a chamber. Required.
    value
        the pressure (Pa). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    values
        pressures at these times (Pa). Default: none.
    """
    return _table(
        chamber=chamber,
        value=value,
        times=times,
        period=period,
        values=values,
    )


def pressure_on(
    *,
    nodes: Nodes,
    value: Formula | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    values: Sequence[float] | None = None,
) -> dict:
    r"""A pressure on the faces of the boundary (edges in the plane) between nodes, positive if it presses onto the body.
    It follows the body: it acts on the deformed area, along its normal.

    Parameters
    ----------
    nodes
        nodes. Required.
    value
        the pressure (Pa). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    values
        pressures at these times (Pa). Default: none.
    """
    return _table(
        nodes=nodes,
        value=value,
        times=times,
        period=period,
        values=values,
    )


def open(
    *,
    orifice: str,
    opening: Formula | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    openings: Sequence[float] | None = None,
) -> dict:
    r"""How far an orifice is open, from 0 (shut) to 1. The opening of a table is interpolated linearly, and is constant
    before and after.

    Parameters
    ----------
    orifice
        the name of an orifice. Required.
    opening
        how far it is open (no unit). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    openings
        openings at these times (no unit). Default: none.
    """
    return _table(
        orifice=orifice,
        opening=opening,
        times=times,
        period=period,
        openings=openings,
    )


def flow(
    *,
    chamber: str,
    rate: Formula | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    rates: Sequence[float] | None = None,
) -> dict:
    r"""How much liquid flows into a chamber, as from a syringe or a pump; below 0 it flows out. That of a table is
    interpolated linearly, and is constant before and after.

    Parameters
    ----------
    chamber
        the name of a chamber with a liquid. Required.
    rate
        the volume, without pressure, that flows in per time (m^3/s). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    rates
        rates at these times (m^3/s). Default: none.
    """
    return _table(
        chamber=chamber,
        rate=rate,
        times=times,
        period=period,
        rates=rates,
    )


def actuate(
    *,
    springs: str | Sequence[str] | None = None,
    muscles: str | Sequence[str] | None = None,
    growths: str | Sequence[str] | None = None,
    heated: str | Sequence[str] | None = None,
    force: Formula | None = None,
    length: Formula | None = None,
    stress: Formula | None = None,
    strain: Formula | None = None,
    power: Formula | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    forces: Sequence[float] | None = None,
    lengths: Sequence[float] | None = None,
    strains: Sequence[float] | None = None,
    stresses: Sequence[float] | None = None,
    powers: Sequence[float] | None = None,
) -> dict:
    r"""Forces of the actuators in springs, tensions of cables, lengths that winches have drawn in, stresses of muscles,
    strains of growth, and powers of what is heated. Those of a table are interpolated linearly, and are constant
    before and after.

    Parameters
    ----------
    springs
        names of springs and cables. Default: none.
    muscles
        names of muscles. Default: none.
    growths
        names of growths. Default: none.
    heated
        names of springs, cables, muscles and growths that a `[[lag]]` heats. Default: none.
    force
        the force: of a spring positive if it extends, of a cable if it pulls (N). Default: none.
    length
        of a winch: the length that it has drawn in (m). Default: none.
    stress
        of a muscle: the force per section of the undeformed shape by which it pulls; below 0 it pushes (Pa). Default:
        none.
    strain
        of a growth: by how much what is free gets longer; of heat the coefficient of expansion times the change of
        temperature (no unit). Default: none.
    power
        the power that heats them, each by itself (W). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    forces
        forces at these times (N). Default: none.
    lengths
        lengths at these times (m). Default: none.
    strains
        strains at these times (no unit). Default: none.
    stresses
        stresses at these times (Pa). Default: none.
    powers
        powers at these times (W). Default: none.
    """
    return _table(
        springs=springs,
        muscles=muscles,
        growths=growths,
        heated=heated,
        force=force,
        length=length,
        stress=stress,
        strain=strain,
        power=power,
        times=times,
        period=period,
        forces=forces,
        lengths=lengths,
        strains=strains,
        stresses=stresses,
        powers=powers,
    )


def drive(
    *,
    dipole: str,
    position: Sequence[Formula] | None = None,
    moment: Sequence[Formula] | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    positions: Sequence[Vector] | None = None,
    moments: Sequence[Vector] | None = None,
) -> dict:
    r"""Where a `[[dipole]]` is in this phase, or its moment, in place of what the scene says; a moment of 0 switches it
    off. Those of tables are interpolated linearly, and constant before and after.

    Parameters
    ----------
    dipole
        the name of the dipole. Required.
    position
        its position (m). Default: none.
    moment
        its moment (A m^2). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    positions
        its positions at these times (m). Default: none.
    moments
        its moments at these times (A m^2). Default: none.
    """
    return _table(
        dipole=dipole,
        position=position,
        moment=moment,
        times=times,
        period=period,
        positions=positions,
        moments=moments,
    )


def set(
    *,
    device: str,
    input: str,
    value: Formula | Sequence[Formula] | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    values: Sequence[float] | Sequence[Vector] | None = None,
) -> dict:
    r"""An input of a device by its word: the `velocity` of a `[[wind]]`. A number or a vector, as the input is. Values of
    a table are interpolated linearly, and are constant before and after.

    Parameters
    ----------
    device
        the name of the device. Required.
    input
        the word of the input. Required.
    value
        its value, in the unit of the input. Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    values
        its values at these times. Default: none.
    """
    return _table(
        device=device,
        input=input,
        value=value,
        times=times,
        period=period,
        values=values,
    )


def magnetic_field(
    *,
    field: Sequence[Formula] | None = None,
    times: Sequence[float] | None = None,
    period: float | None = None,
    fields: Sequence[Vector] | None = None,
    gradient: Sequence[Vector] | None = None,
    centre: Vector | None = None,
) -> dict:
    r"""The magnetic field that acts on the magnets: `field` everywhere, and `gradient` (x - `centre`) beside it. That of
    a table is interpolated linearly, and constant before and after.

    Parameters
    ----------
    field
        the field (T). Default: none.
    times
        times in ascending order (s). Default: none.
    period
        the time after which the table is repeated, up to the end of the phase (s). Default: once. From its last time
        a line leads to the first value, a period after the first time.
    fields
        the field at these times (T). Default: none.
    gradient
        rows of dB_i/dx_j, a symmetric matrix, in space without trace (T/m). Default: none.
    centre
        where the gradient adds nothing (m). Default: the origin.
    """
    return _table(
        field=field,
        times=times,
        period=period,
        fields=fields,
        gradient=gradient,
        centre=centre,
    )


def sensor_position(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    inside: Vector | None = None,
    marker: dict | None = None,
) -> dict:
    r"""Sensor of the kind "position": where nodes, a point of a body or a marker are (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes. Default: `inside` or `marker`.
    inside
        the undeformed position of a point of a body, whatever nodes are near (m). Default: `nodes` or `marker`.
    marker
        a point beside the body that moves with nodes of it. Default: `nodes` or `inside`.
    """
    return _table(
        kind="position",
        name=name,
        component=component,
        nodes=nodes,
        inside=inside,
        marker=marker,
    )


def sensor_displacement(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    inside: Vector | None = None,
    marker: dict | None = None,
) -> dict:
    r"""Sensor of the kind "displacement": how far nodes, a point of a body or a marker are from where they are in the
    undeformed shape (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes. Default: `inside` or `marker`.
    inside
        the undeformed position of a point of a body, whatever nodes are near (m). Default: `nodes` or `marker`.
    marker
        a point beside the body that moves with nodes of it. Default: `nodes` or `inside`.
    """
    return _table(
        kind="displacement",
        name=name,
        component=component,
        nodes=nodes,
        inside=inside,
        marker=marker,
    )


def sensor_velocity(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    inside: Vector | None = None,
    marker: dict | None = None,
) -> dict:
    r"""Sensor of the kind "velocity": how fast nodes, a point of a body or a marker move (m/s).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes. Default: `inside` or `marker`.
    inside
        the undeformed position of a point of a body, whatever nodes are near (m). Default: `nodes` or `marker`.
    marker
        a point beside the body that moves with nodes of it. Default: `nodes` or `inside`.
    """
    return _table(
        kind="velocity",
        name=name,
        component=component,
        nodes=nodes,
        inside=inside,
        marker=marker,
    )


def sensor_acceleration(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    inside: Vector | None = None,
    marker: dict | None = None,
) -> dict:
    r"""Sensor of the kind "acceleration": how the velocity of nodes, of a point of a body or of a marker changes (m/s^2).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes. Default: `inside` or `marker`.
    inside
        the undeformed position of a point of a body, whatever nodes are near (m). Default: `nodes` or `marker`.
    marker
        a point beside the body that moves with nodes of it. Default: `nodes` or `inside`.
    """
    return _table(
        kind="acceleration",
        name=name,
        component=component,
        nodes=nodes,
        inside=inside,
        marker=marker,
    )


def sensor_constraint_force(
    *,
    name: str,
    nodes: Nodes,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "constraint-force": the force of what holds or moves nodes, their reaction (N).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    nodes
        the nodes. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="constraint-force",
        name=name,
        nodes=nodes,
        component=component,
    )


def sensor_constraint_moment(
    *,
    name: str,
    nodes: Nodes,
    about: Vector,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    axis: Vector | None = None,
) -> dict:
    r"""Sensor of the kind "constraint-moment": the moment of what holds or moves nodes about a point that stays where it
    is (N m), counter-clockwise in the plane.

    Parameters
    ----------
    name
        the name of the sensor. Required.
    nodes
        the nodes. Required.
    about
        the point (m). Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    axis
        the direction along which it is read, of a body in space. Default: all components, each a column.
    """
    return _table(
        kind="constraint-moment",
        name=name,
        nodes=nodes,
        about=about,
        component=component,
        axis=axis,
    )


def sensor_contact_force(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    obstacle: str | None = None,
    touch: str | None = None,
    nodes: Nodes | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "contact-force": the force of an obstacle, or of bodies that touch, on a body (N).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    obstacle
        the name of the obstacle. Default: `touch`.
    touch
        the name of the contact of bodies. Default: `obstacle`.
    nodes
        the nodes on which it acts. Default: all. Those of one finger, say: the forces on both sides of what is
        gripped cancel each other. A `touch` needs `nodes` or `body`, as it acts on both sides alike: all of its
        forces together are 0.
    body
        the body on which a `touch` acts. Default: `nodes`.
    """
    return _table(
        kind="contact-force",
        name=name,
        component=component,
        obstacle=obstacle,
        touch=touch,
        nodes=nodes,
        body=body,
    )


def sensor_contact_area(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    obstacle: str | None = None,
    touch: str | None = None,
    nodes: Nodes | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "contact-area": the area of the surface of a body that an obstacle, or another body, touches:
    in the plane a length times the thickness (m^2).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    obstacle
        the name of the obstacle. Default: `touch`.
    touch
        the name of the contact of bodies. Default: `obstacle`.
    nodes
        the nodes on which it acts. Default: all. Those of one finger, say: the forces on both sides of what is
        gripped cancel each other. A `touch` needs `nodes` or `body`, as it acts on both sides alike: all of its
        forces together are 0.
    body
        the body on which a `touch` acts. Default: `nodes`.
    """
    return _table(
        kind="contact-area",
        name=name,
        component=component,
        obstacle=obstacle,
        touch=touch,
        nodes=nodes,
        body=body,
    )


def sensor_contact_pressure(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    obstacle: str | None = None,
    touch: str | None = None,
    nodes: Nodes | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "contact-pressure": the largest contact pressure at any of the nodes (Pa).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    obstacle
        the name of the obstacle. Default: `touch`.
    touch
        the name of the contact of bodies. Default: `obstacle`.
    nodes
        the nodes on which it acts. Default: all. Those of one finger, say: the forces on both sides of what is
        gripped cancel each other. A `touch` needs `nodes` or `body`, as it acts on both sides alike: all of its
        forces together are 0.
    body
        the body on which a `touch` acts. Default: `nodes`.
    """
    return _table(
        kind="contact-pressure",
        name=name,
        component=component,
        obstacle=obstacle,
        touch=touch,
        nodes=nodes,
        body=body,
    )


def sensor_gap(
    *,
    name: str,
    touch: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "gap": the least gap between the surfaces of bodies that touch, at most the contact distance
    (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    touch
        the name of the contact. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="gap",
        name=name,
        touch=touch,
        component=component,
    )


def sensor_magnetic_moment(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "magnetic-moment": the magnetic moment of all magnets (A m^2).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="magnetic-moment",
        name=name,
        component=component,
    )


def sensor_fluid_force(
    *,
    name: str,
    fluid: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "fluid-force": the force of a fluid, its drag and pressure, on all nodes, on some of them or on
    those of one body (N).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    fluid
        the name of the fluid. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes on which it acts. Default: all.
    body
        the name of one of several bodies. Default: all together.
    """
    return _table(
        kind="fluid-force",
        name=name,
        fluid=fluid,
        component=component,
        nodes=nodes,
        body=body,
    )


def sensor_device(
    *,
    name: str,
    device: str,
    output: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "device": an output of a device by its word: the `force` of a `[[wind]]` (N).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    device
        the name of the device. Required.
    output
        the word of the output. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="device",
        name=name,
        device=device,
        output=output,
        component=component,
    )


def sensor_stress(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    point: Vector | None = None,
) -> dict:
    r"""Sensor of the kind "stress": the stress of the elastic law and of Maxwell branches, without viscosity, at nodes or
    at a point, extrapolated from the cells around (Pa).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes. Default: `point`.
    point
        the undeformed position of a point of the body (m). Default: `nodes`.
    """
    return _table(
        kind="stress",
        name=name,
        component=component,
        nodes=nodes,
        point=point,
    )


def sensor_strain(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    point: Vector | None = None,
) -> dict:
    r"""Sensor of the kind "strain": the strain at nodes or at a point, extrapolated from the cells around (no unit).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes. Default: `point`.
    point
        the undeformed position of a point of the body (m). Default: `nodes`.
    """
    return _table(
        kind="strain",
        name=name,
        component=component,
        nodes=nodes,
        point=point,
    )


def sensor_distance(
    *,
    name: str,
    from_: Nodes,
    to: Nodes,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "distance": the distance between two nodes, or the middles of sets (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    from_
        where it is measured from. Required.
    to
        where it is measured to. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="distance",
        name=name,
        from_=from_,
        to=to,
        component=component,
    )


def sensor_angle(
    *,
    name: str,
    from_: Sequence[Nodes],
    to: Sequence[Nodes],
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    unit: Literal["rad", "deg"] | None = None,
) -> dict:
    r"""Sensor of the kind "angle": the angle from one line to another, counter-clockwise in the plane, where it goes on
    over whole turns; without sign, from 0 to half a turn, in space.

    Parameters
    ----------
    name
        the name of the sensor. Required.
    from_
        the two ends of the one line. Required.
    to
        the two ends of the other. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    unit
        the unit. Default: rad.
    """
    return _table(
        kind="angle",
        name=name,
        from_=from_,
        to=to,
        component=component,
        unit=unit,
    )


def sensor_centre_of_mass(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "centre-of-mass": where the centre of mass is (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    body
        the name of one of several bodies. Default: all together.
    """
    return _table(
        kind="centre-of-mass",
        name=name,
        component=component,
        body=body,
    )


def sensor_momentum(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "momentum": the momentum (kg m/s).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    body
        the name of one of several bodies. Default: all together.
    """
    return _table(
        kind="momentum",
        name=name,
        component=component,
        body=body,
    )


def sensor_rotation(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    unit: Literal["rad", "deg"] | None = None,
    nodes: Nodes | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "rotation": the rotation of a body, or of nodes, as a whole, the one nearest to its motion: in
    the plane an angle, counter-clockwise, which goes on over whole turns; in space a vector along the axis, of a
    length of at most half a turn.

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    unit
        the unit. Default: rad.
    nodes
        the nodes that turn, all of which count alike. Default: the body.
    body
        the name of one of several bodies. Default: all together.
    """
    return _table(
        kind="rotation",
        name=name,
        component=component,
        unit=unit,
        nodes=nodes,
        body=body,
    )


def sensor_angular_velocity(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "angular-velocity": the rate of that rotation (rad/s): in the plane counter-clockwise, in space
    a vector.

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes that turn, all of which count alike. Default: the body.
    body
        the name of one of several bodies. Default: all together.
    """
    return _table(
        kind="angular-velocity",
        name=name,
        component=component,
        nodes=nodes,
        body=body,
    )


def sensor_angular_acceleration(
    *,
    name: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
    nodes: Nodes | None = None,
    body: str | None = None,
) -> dict:
    r"""Sensor of the kind "angular-acceleration": the rate of that angular velocity (rad/s^2).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    nodes
        the nodes that turn, all of which count alike. Default: the body.
    body
        the name of one of several bodies. Default: all together.
    """
    return _table(
        kind="angular-acceleration",
        name=name,
        component=component,
        nodes=nodes,
        body=body,
    )


def sensor_spring_pull(
    *,
    name: str,
    spring: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "spring-pull": the force with which a spring and its actuator pull its ends together, or the
    tension of a cable at its first place (N).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    spring
        the name of the spring or cable. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="spring-pull",
        name=name,
        spring=spring,
        component=component,
    )


def sensor_tension_at_end(
    *,
    name: str,
    cable: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "tension-at-end": the tension of a cable at its last place, from which friction along its path
    takes its part (N).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    cable
        the name of the cable. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="tension-at-end",
        name=name,
        cable=cable,
        component=component,
    )


def sensor_spring_length(
    *,
    name: str,
    spring: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "spring-length": the length of a spring, or of the path of a cable (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    spring
        the name of the spring or cable. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="spring-length",
        name=name,
        spring=spring,
        component=component,
    )


def sensor_muscle_stress(
    *,
    name: str,
    muscle: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "muscle-stress": the stress by which a muscle pulls (Pa).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    muscle
        the name of the muscle. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="muscle-stress",
        name=name,
        muscle=muscle,
        component=component,
    )


def sensor_muscle_stretch(
    *,
    name: str,
    muscle: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "muscle-stretch": the length of the fibres of a muscle by that in the undeformed shape, the
    mean over their volume (no unit).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    muscle
        the name of the muscle. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="muscle-stretch",
        name=name,
        muscle=muscle,
        component=component,
    )


def sensor_activation(
    *,
    name: str,
    muscle: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "activation": the activation of a muscle with Hill's law, from 0 to 1.

    Parameters
    ----------
    name
        the name of the sensor. Required.
    muscle
        the name of the muscle. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="activation",
        name=name,
        muscle=muscle,
        component=component,
    )


def sensor_temperature(
    *,
    name: str,
    actuator: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "temperature": the temperature rise of a heated actuator above its surroundings (K).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    actuator
        the name of the actuator. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="temperature",
        name=name,
        actuator=actuator,
        component=component,
    )


def sensor_dipole_force(
    *,
    name: str,
    dipole: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "dipole-force": the force of a dipole on all magnets; that on the dipole is minus this (N).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    dipole
        the name of the dipole. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="dipole-force",
        name=name,
        dipole=dipole,
        component=component,
    )


def sensor_dipole_position(
    *,
    name: str,
    dipole: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "dipole-position": the position of a dipole (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    dipole
        the name of the dipole. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="dipole-position",
        name=name,
        dipole=dipole,
        component=component,
    )


def sensor_pressure(
    *,
    name: str,
    chamber: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "pressure": the gauge pressure in a chamber; of a liquid with weight the mean, of one with a
    surface that at the lowest point of the walls (Pa).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    chamber
        the name of the chamber. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="pressure",
        name=name,
        chamber=chamber,
        component=component,
    )


def sensor_absolute_pressure(
    *,
    name: str,
    chamber: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "absolute-pressure": the absolute pressure of the gas in a chamber (Pa).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    chamber
        the name of the chamber. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="absolute-pressure",
        name=name,
        chamber=chamber,
        component=component,
    )


def sensor_gas_amount(
    *,
    name: str,
    chamber: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "gas-amount": the amount of gas in a chamber (kg).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    chamber
        the name of the chamber. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="gas-amount",
        name=name,
        chamber=chamber,
        component=component,
    )


def sensor_gas_flow(
    *,
    name: str,
    orifice: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "gas-flow": the flow of gas through an orifice, from its first end to its second (kg/s).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    orifice
        the name of the orifice. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="gas-flow",
        name=name,
        orifice=orifice,
        component=component,
    )


def sensor_liquid_volume(
    *,
    name: str,
    chamber: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "liquid-volume": the volume of the liquid in a chamber, as it is without pressure (m^3).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    chamber
        the name of the chamber. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="liquid-volume",
        name=name,
        chamber=chamber,
        component=component,
    )


def sensor_liquid_flow(
    *,
    name: str,
    chamber: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "liquid-flow": the flow of liquid into a chamber (m^3/s).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    chamber
        the name of the chamber. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="liquid-flow",
        name=name,
        chamber=chamber,
        component=component,
    )


def sensor_liquid_level(
    *,
    name: str,
    chamber: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "liquid-level": the height of the surface of the liquid in a chamber above the origin, against
    gravity (m).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    chamber
        the name of the chamber. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="liquid-level",
        name=name,
        chamber=chamber,
        component=component,
    )


def sensor_pipe_flow(
    *,
    name: str,
    pipe: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "pipe-flow": the flow of liquid through a pipe, from its first end to its second (m^3/s).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    pipe
        the name of the pipe. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="pipe-flow",
        name=name,
        pipe=pipe,
        component=component,
    )


def sensor_volume(
    *,
    name: str,
    chamber: str,
    component: Literal["x", "y", "z", "norm", "xx", "yy", "zz", "xy", "yz", "xz", "von-mises"] | None = None,
) -> dict:
    r"""Sensor of the kind "volume": the volume that the walls of a chamber enclose (m^3).

    Parameters
    ----------
    name
        the name of the sensor. Required.
    chamber
        the name of the chamber. Required.
    component
        one component alone. Default: all, each a column. Vectors have `x`, `y`, `z` and their length `norm`; tensors
        `xx` and so on; stress has `von-mises` besides.
    """
    return _table(
        kind="volume",
        name=name,
        chamber=chamber,
        component=component,
    )


def marker(
    *,
    nodes: Nodes,
    at: Vector,
) -> dict:
    r"""A point beside the body, as on a post or a plate: it moves with nodes as if both were one rigid body, by the rigid
    motion nearest to theirs.

    Parameters
    ----------
    nodes
        the nodes that it moves with. Required.
    at
        where it is in the undeformed shape (m). Required.
    """
    return _table(
        nodes=nodes,
        at=at,
    )


def solver(
    *,
    accuracy: float | str | None = None,
    method: Literal["auto", "cvode-bdf", "cvode-adams", "ida", "ida-klu", "ida-index-2", "arkode", "rosenbrock", "rk", "central-difference"] | None = None,
    rtol: float | None = None,
    atol_position: float | None = None,
    atol_velocity: float | None = None,
    alpha: float | None = None,
    max_order: int | None = None,
    stability_limit_detection: bool | None = None,
    contact_events: Literal["auto", "step-over", "locate"] | None = None,
    max_step: float | None = None,
    max_steps: int | None = None,
    max_time: float | None = None,
    quantity: str | None = None,
    reduced: str | None = None,
    half: Literal["x", "y", "z", ""] | None = None,
    plane: Literal["x", "y", "z", ""] | None = None,
) -> dict:
    r"""How the equations of motion are integrated.

    Parameters
    ----------
    accuracy
        how accurate the motion has to be, as `"1%"` or `0.01`. Default: one run by `rtol`. The scene is run with a
        tighter and tighter `rtol`, until two runs agree to that: see `pliant run --help`. Not beside `rtol`.
    method
        integration method: see "pliant methods". Default: auto.
    rtol
        relative tolerance (no unit). Default: 1e-5.
    atol_position
        absolute tolerance of displacements (m). Default: `rtol` times a hundredth of the size of the body.
    atol_velocity
        absolute tolerance of velocities (m/s). Default: `rtol` times a hundredth of the speed of waves; with friction
        at most 1/400 of `sticking_speed`.
    alpha
        rate at which errors of constraints decay (1/s). Default: 1e3.
    max_order
        highest order of a multistep method, order of `arkode` and `rosenbrock`. Default: 5; `cvode-adams`: 12,
        `arkode`, `rosenbrock`: 4.
    stability_limit_detection
        whether BDF lowers its order where stability bounds its steps. Default: false.
    contact_events
        how contact events are met: auto, step-over or locate. Default: auto.
    max_step
        longest step (s). Default: none.
    max_steps
        steps that a phase may take. Default: 10000000.
    max_time
        wall-clock time that a run may take, each of them where there are several (s). Default: none.
    quantity
        what `accuracy` is of. Default: the whole motion. `motion`; a sensor or a set of nodes, with a component where
        need be, as `tip.y`; `com`, `rotation`; behind a colon the part that counts, where all times do not: `end`,
        `max`, `min`, `frequency`, `damping`.
    reduced
        the reduced model by which it is run: a file of `pliant reduce`, relative to the scene file. Default: all
        unknowns. `""` is all unknowns. Statics always takes all of them.
    half
        the axis across which the scene is cut at its middle: half of it is run. Default: the whole. The scene has to
        be symmetric. Sensors read what they would read of the whole; forces and energies are those of the half. Of
        both halves it is that below the cut, unless sensors are on the other side. `""` is the whole.
    plane
        the axis of space across which a section of the scene is run in a plane. Default: all of space. The scene has
        to be the same all along it. It is in plane strain where both ends are held along the axis, and else in plane
        stress. `""` is all of space.
    """
    return _table(
        accuracy=accuracy,
        method=method,
        rtol=rtol,
        atol_position=atol_position,
        atol_velocity=atol_velocity,
        alpha=alpha,
        max_order=max_order,
        stability_limit_detection=stability_limit_detection,
        contact_events=contact_events,
        max_step=max_step,
        max_steps=max_steps,
        max_time=max_time,
        quantity=quantity,
        reduced=reduced,
        half=half,
        plane=plane,
    )


def statics(
    *,
    phase: str | None = None,
    load_steps: int | None = None,
    arc_steps: int | None = None,
    rtol: float | None = None,
    max_iterations: int | None = None,
    min_load_step: float | None = None,
) -> dict:
    r"""How `pliant static` seeks an equilibrium: that under the constraints, loads, obstacles and springs of a phase at
    its end. What earlier phases have moved and this one holds stays there. Friction does not act.

    Parameters
    ----------
    phase
        the name of the phase. Default: the first one.
    load_steps
        steps in which constraints and loads are brought on. Default: 1. With more than one, the results have the
        equilibrium of each, with its `load factor`.
    arc_steps
        most steps by arc length. Default: 0: the load is given. With them the load rises and falls as the path of
        equilibria has it, through snap-through and snap-back, until all of it acts. The first step is that of one of
        the `load_steps`, and none is longer.
    rtol
        the largest force left over, relative to the largest force (no unit). Default: 1e-10.
    max_iterations
        Newton iterations of one load step. Default: 100.
    min_load_step
        the smallest load step, as a part of the whole load (no unit). Default: 1e-3.
    """
    return _table(
        phase=phase,
        load_steps=load_steps,
        arc_steps=arc_steps,
        rtol=rtol,
        max_iterations=max_iterations,
        min_load_step=min_load_step,
    )


def output(
    *,
    step: float | None = None,
    times: Sequence[float] | None = None,
    track: Nodes | None = None,
    formats: Literal["csv", "vtk", "svg", "html", "plot", "png"] | Sequence[Literal["csv", "vtk", "svg", "html", "plot", "png"]] | None = None,
) -> dict:
    r"""What `pliant run` writes.

    Parameters
    ----------
    step
        the time between samples (s). Default: the ends of the phases only.
    times
        times of samples, in any order, in place of a step (s). Default: none. The start and the ends of the phases
        are sampled besides.
    track
        nodes whose displacements the table lists. Default: none.
    formats
        what is written: a table, files for ParaView, snapshots, an animation, a plot of sensors and energies as a
        drawing or as pixels. Default: csv, which is always written.
    """
    return _table(
        step=step,
        times=times,
        track=track,
        formats=formats,
    )


def box(
    *,
    box: Sequence[Vector],
) -> dict:
    r"""All nodes within a box.

    Parameters
    ----------
    box
        the lower and the upper corner (m). Required.
    """
    return _table(
        box=box,
    )


__all__ = [
    "actuate",
    "backward",
    "body",
    "box",
    "branch",
    "cable",
    "chamber",
    "dipole",
    "drive",
    "end",
    "ends",
    "fibres",
    "flow",
    "fluid",
    "follower",
    "friction_coefficient",
    "gas",
    "groups",
    "growth",
    "halved_in",
    "hill",
    "hold",
    "hold_combination",
    "initial",
    "initial_nodes",
    "inside",
    "lag",
    "law_corotated",
    "law_mooney_rivlin",
    "law_neo_hookean",
    "law_ogden",
    "law_st_venant_kirchhoff",
    "law_yeoh",
    "liquid",
    "load",
    "magnet",
    "magnetic_field",
    "marker",
    "material",
    "mesh_bar",
    "mesh_cuboid",
    "mesh_gmsh",
    "mesh_half_ring",
    "mesh_listed",
    "mesh_rectangle",
    "mesh_ring",
    "mesh_surface",
    "moment",
    "move",
    "muscle",
    "obstacle_box",
    "obstacle_capsule",
    "obstacle_disc",
    "obstacle_half_plane",
    "obstacle_parts_box",
    "obstacle_parts_capsule",
    "obstacle_parts_disc",
    "obstacle_parts_half_plane",
    "obstacle_path",
    "obstacle_union",
    "open",
    "orifice",
    "output",
    "path",
    "phase",
    "pipe",
    "point",
    "pressure",
    "pressure_on",
    "region",
    "rotate",
    "sensor_absolute_pressure",
    "sensor_acceleration",
    "sensor_activation",
    "sensor_angle",
    "sensor_angular_acceleration",
    "sensor_angular_velocity",
    "sensor_centre_of_mass",
    "sensor_constraint_force",
    "sensor_constraint_moment",
    "sensor_contact_area",
    "sensor_contact_force",
    "sensor_contact_pressure",
    "sensor_device",
    "sensor_dipole_force",
    "sensor_dipole_position",
    "sensor_displacement",
    "sensor_distance",
    "sensor_fluid_force",
    "sensor_gap",
    "sensor_gas_amount",
    "sensor_gas_flow",
    "sensor_liquid_flow",
    "sensor_liquid_level",
    "sensor_liquid_volume",
    "sensor_magnetic_moment",
    "sensor_momentum",
    "sensor_muscle_stress",
    "sensor_muscle_stretch",
    "sensor_pipe_flow",
    "sensor_position",
    "sensor_pressure",
    "sensor_rotation",
    "sensor_spring_length",
    "sensor_spring_pull",
    "sensor_strain",
    "sensor_stress",
    "sensor_temperature",
    "sensor_tension_at_end",
    "sensor_velocity",
    "sensor_volume",
    "set",
    "sets",
    "solver",
    "spring",
    "statics",
    "supply",
    "symmetry",
    "terms",
    "tie",
    "touch",
    "wind",
]
