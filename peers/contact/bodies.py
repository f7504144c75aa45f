"""Meshes, poses and scenes that all programs of this folder share, and how pliant's command is called."""

import csv
import itertools
import os
import pathlib
import resource
import subprocess
import tempfile
import time

import ipctk
import numpy as np

ipctk.set_num_threads(1)
PLIANT = os.environ.get("PLIANT", "pliant")


class Mesh:
    """Nodes (count x 2 or 3, m) and triangles or tetrahedra of positive content."""

    def __init__(self, nodes, cells):
        self.nodes, self.cells = np.asarray(nodes, float), np.asarray(cells)
        corners = self.nodes[self.cells]
        flipped = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
        self.cells[flipped] = self.cells[flipped][:, [1, 0, *range(2, self.cells.shape[1])]]
        # facets of one cell alone, the outer side to the right of an edge, and outwards by the right hand of a triangle
        owners = {}
        for cell in self.cells:
            for left_out in range(len(cell)):
                facet = np.delete(cell, left_out)
                owners.setdefault(tuple(sorted(facet)), []).append((facet, cell[left_out]))
        outer = [of[0] for of in owners.values() if len(of) == 1]
        facets = []
        for facet, inner in outer:
            a = self.nodes[facet]
            inwards = np.linalg.det(np.vstack([a[1:] - a[0], self.nodes[inner] - a[0]])) > 0
            facets.append(facet[::-1] if inwards else facet)
        self.facets = np.array(facets)

    def moved(self, turn, way):
        return Mesh(self.nodes @ turn.T + way, self.cells)

    def masses(self, density):
        """Lumped masses (kg)."""
        corners = self.nodes[self.cells]
        size = self.cells.shape[1]
        content = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / (2 if size == 3 else 6)
        return np.bincount(self.cells.ravel(), np.repeat(density * content / size, size), len(self.nodes))


def grid(size, count):
    """A rectangle of triangles or a cuboid of tetrahedra (six to a cell of the grid), `count` nodes along each axis, around the origin."""
    axes = [np.linspace(-0.5 * length, 0.5 * length, n) for length, n in zip(size, count)]
    nodes = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, len(size))
    number = np.arange(len(nodes)).reshape(count)
    cells = []
    for corner in itertools.product(*(range(n - 1) for n in count)):
        for order in itertools.permutations(range(len(size))):
            at, path = list(corner), [number[corner]]
            for axis in order:
                at[axis] += 1
                path.append(number[tuple(at)])
            cells.append(path)
    return Mesh(nodes, cells)


def random_turn(random, dimension):
    """A rotation, each as likely as any other."""
    q, r = np.linalg.qr(random.normal(size=(dimension, dimension)))
    q *= np.sign(np.diag(r))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return q


def body(name, mesh, material, extra=""):
    """A body of a scene file."""
    plane = mesh.nodes.shape[1] == 2
    cells = "triangles" if plane else "tetrahedra"
    thickness = "thickness = 0.01\n" if plane else ""
    return (
        f'[[body]]\nname = "{name}"\n{thickness}{extra}material = {material}\n'
        f'mesh = {{ kind = "listed", cells = "{cells}", positions = {mesh.nodes.tolist()}, '
        f"connectivity = {(mesh.cells + 1).tolist()} }}\n"
    )


class Run:
    """A run of `pliant run`: columns of its table by name, `processor` time (s, of the whole command), its messages."""

    def __init__(self, scene, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "scene.toml")
            file.write_text(scene)
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run(
                [PLIANT, "run", file, "--out", folder + "/out", "--quiet", *arguments], capture_output=True, text=True
            )
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            self.processor = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            self.failed, self.messages = done.returncode != 0, done.stderr + done.stdout
            self.report = pathlib.Path(folder, "out", "report.json").read_text() if not self.failed else ""
            if self.failed:
                return
            with open(folder + "/out/trajectory.csv") as table:
                rows = list(csv.reader(table))
        self.columns = dict(zip(rows[0], np.array(rows[1:], float).T))

    def positions(self, nodes, numbers=None):
        """Of tracked nodes, which were at `nodes` and have these `numbers` (all, from 1): times x nodes x axes (m)."""
        numbers = numbers or range(1, len(nodes) + 1)
        moved = [[self.columns[f"u{n}_{axis}"] for axis in "xyz"[: nodes.shape[1]]] for n in numbers]
        return nodes + np.moveaxis(np.array(moved), -1, 0)


class Surfaces:
    """The surfaces of two or more meshes, as the IPC toolkit takes them."""

    def __init__(self, meshes):
        starts = np.cumsum([0] + [len(mesh.nodes) for mesh in meshes])
        self.nodes = np.concatenate([mesh.nodes for mesh in meshes])
        self.facets = np.concatenate([mesh.facets + start for mesh, start in zip(meshes, starts)])
        self.body = np.repeat(np.arange(len(meshes)), [len(mesh.nodes) for mesh in meshes])
        self.solid = self.nodes.shape[1] == 3
        self.edges = ipctk.edges(self.facets) if self.solid else self.facets
        self.used = np.unique(self.facets)
        place = np.zeros(len(self.nodes), int)
        place[self.used] = np.arange(len(self.used))
        faces = place[self.facets] if self.solid else np.zeros((0, 3), int)
        self.toolkit = ipctk.CollisionMesh(self.nodes[self.used], place[self.edges], faces)
        # the same without contact of a body with itself
        self.apart = ipctk.CollisionMesh(self.nodes[self.used], place[self.edges], faces)
        self.apart.can_collide = ipctk.make_vertex_patches_filter(self.body[self.used])

    def intersect(self, x):
        return ipctk.has_intersections(self.toolkit, x[self.used])

    def distance(self, x):
        """The least distance (m) of different bodies by the toolkit: points to facets, and in space edges to edges."""
        collisions = ipctk.NormalCollisions()
        collisions.build(self.apart, x[self.used], 10.0)
        return np.sqrt(collisions.compute_minimum_distance(self.apart, x[self.used]))

    def depth(self, x):
        """How deep (m) an edge of one body lies in another, at most, at 17 points of each: their distance from that one's surface."""
        deepest = 0.0
        measure = ipctk.point_triangle_distance if self.solid else ipctk.point_edge_distance
        shares = np.linspace(0, 1, 17)[:, None, None]
        for other in range(self.body.max() + 1):
            facets = x[self.facets[self.body[self.facets[:, 0]] == other]]
            ends = x[self.edges[self.body[self.edges[:, 0]] != other]]
            points = ((1 - shares) * ends[:, 0] + shares * ends[:, 1]).reshape(-1, x.shape[1])
            points = points[((points > facets.min((0, 1))) & (points < facets.max((0, 1)))).all(1)]
            for point in points[windings(points, facets) > 0.5]:
                deepest = max(deepest, min(measure(point, *facet) for facet in facets) ** 0.5)
        return deepest


def windings(points, facets):
    """How often a closed surface goes around points (van Oosterom and Strackee's solid angles; angles in the plane)."""
    r = facets - points[:, None, None]
    if r.shape[-1] == 2:
        cross = r[..., 0, 0] * r[..., 1, 1] - r[..., 0, 1] * r[..., 1, 0]
        return abs(np.arctan2(cross, (r[..., 0, :] * r[..., 1, :]).sum(-1)).sum(1)) / (2 * np.pi)
    a, b, c = (np.linalg.norm(r[..., k, :], axis=-1) for k in range(3))
    dot = lambda i, j: (r[..., i, :] * r[..., j, :]).sum(-1)
    below = a * b * c + dot(0, 1) * c + dot(1, 2) * a + dot(2, 0) * b
    return abs(2 * np.arctan2(np.linalg.det(r), below).sum(1)) / (4 * np.pi)


def stopwatch(work):
    """What some work returns, and its processor time (s)."""
    start = time.process_time()
    done = work()
    return done, time.process_time() - start
