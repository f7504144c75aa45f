"""CalculiX on a block: writes its input, runs it, reads the motion of the tip, or its equilibrium (0 steps).

With NLGEOM its *ELASTIC is Green's strain and the second Piola-Kirchhoff stress: the material of St. Venant and
Kirchhoff. Its direct integration is the alpha method of Hilber, Hughes and Taylor, alpha -0.05 (the default), with fixed steps.
"""

import os
import re
import resource
import subprocess
import sys
import tempfile
from itertools import product
from pathlib import Path

import numpy as np

# corners of a hexahedron, its middles of edges, and six tetrahedra around a diagonal, in half cells
HEXAHEDRON = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
TETRAHEDRA = [(0, 1, 2, 6), (0, 5, 1, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 4, 5, 6), (0, 7, 4, 6)]
TETRAHEDRON_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]


def with_middles(corners, edges):
    return corners + [tuple((a + b) // 2 for a, b in zip(corners[i], corners[j])) for i, j in edges]


CELLS = {
    "C3D8I": [HEXAHEDRON],
    "C3D20R": [with_middles(HEXAHEDRON, EDGES)],
    "C3D10": [with_middles([HEXAHEDRON[k] for k in corners], TETRAHEDRON_EDGES) for corners in TETRAHEDRA],
}


def lines(numbers):
    """Numbers as CalculiX reads them: at most 16 on a line."""
    words = [str(number) for number in numbers]
    return ",\n".join(", ".join(words[k : k + 10]) for k in range(0, len(words), 10))


def deck(element, size, cells, steps, end, density, gravity, young, poisson):
    nodes, elements = {}, []
    for k, j, i in product(*(range(count) for count in reversed(cells))):
        for places in CELLS[element]:
            own = [(2 * i + x, 2 * j + y, 2 * k + z) for x, y, z in places]
            elements.append([nodes.setdefault(place, len(nodes) + 1) for place in own])
    text = ["*NODE, NSET=NALL"]
    for place, number in nodes.items():
        x = [a * length / (2 * count) for a, length, count in zip(place, size, cells)]
        text.append(f"{number}, {x[0]:.15g}, {x[1]:.15g}, {x[2]:.15g}")
    text.append(f"*ELEMENT, TYPE={element}, ELSET=EALL")
    text += [lines([number, *own]) for number, own in enumerate(elements, 1)]
    text.append("*NSET, NSET=CLAMPED")
    text += [f"{number}," for place, number in nodes.items() if place[0] == 0]
    tip = nodes[2 * cells[0], cells[1], cells[2]]
    dynamic = f"*DYNAMIC, DIRECT\n{end / max(steps, 1)!r}, {end!r}"
    text.append(
        f"""*NSET, NSET=TIP
{tip},
*BOUNDARY
CLAMPED, 1, 3
*MATERIAL, NAME=RUBBER
*ELASTIC
{young!r}, {poisson!r}
*DENSITY
{density!r}
*SOLID SECTION, ELSET=EALL, MATERIAL=RUBBER
*STEP, NLGEOM, INC={2 * max(steps, 100)}
{dynamic if steps else "*STATIC"}
*DLOAD
EALL, GRAV, {gravity!r}, 0, 0, -1
*NODE PRINT, NSET=TIP
U, V
*END STEP
"""
    )
    return "\n".join(text)


def motion(text):
    """Times, displacements and velocities of the tip, from the start."""
    number = r"([-+0-9.E]+)"
    line = re.compile(rf"(displacements|velocities) .* time +{number}\s+\d+ +{number} +{number} +{number}")
    rows = {"displacements": [[0.0] * 4], "velocities": [[0.0] * 4]}
    for name, *numbers in line.findall(text):
        rows[name].append([float(number) for number in numbers])
    u, v = (np.array(rows[name]) for name in ("displacements", "velocities"))
    return u[:, 0], u[:, 1:], v[:, 1:]


def sample(times, t, u, v):
    """The cubic through displacements and velocities at both ends of each step."""
    step = np.clip(np.searchsorted(t, times) - 1, 0, len(t) - 2)
    h = (t[step + 1] - t[step])[:, None]
    s = (times - t[step])[:, None] / h
    r = 1 - s
    ends = (1 + 2 * s) * r * r * u[step] + s * s * (3 - 2 * s) * u[step + 1]
    return ends + h * s * r * (r * v[step] - s * v[step + 1])


def main():
    element, *numbers, out = sys.argv[1:]
    numbers = [float(number) for number in numbers]
    cells, steps = [int(number) for number in numbers[:3]], int(numbers[3])
    size, (end, density, gravity, young, poisson) = numbers[4:7], numbers[7:12]
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "block.inp").write_text(
            deck(element, size, cells, steps, end, density, gravity, young, poisson)
        )
        run = subprocess.run(
            [os.environ.get("CCX", "ccx"), "-i", "block"],
            cwd=folder,
            env=os.environ | {"OMP_NUM_THREADS": "1"},
            capture_output=True,
            text=True,
        )
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        printed = (Path(folder) / "block.dat").read_text()
    t, u, v = motion(printed)
    iterations = len(re.findall(r"^ iteration ", run.stdout, re.MULTILINE))
    if steps == 0:
        if run.returncode or t[-1] != 1:
            raise SystemExit("failed: CalculiX found no equilibrium")
        Path(out).write_bytes(u[-1].tobytes())
        print(used.ru_utime + used.ru_stime, 0, iterations, iterations)
        return
    if run.returncode or abs(t[-1] - end) > 1e-6 * end:
        raise SystemExit(f"failed: CalculiX came to {t[-1]} s")
    times = end * np.arange(1, 102) / 101
    Path(out).write_bytes(sample(times, t, u, v).tobytes())
    print(used.ru_utime + used.ru_stime, len(t) - 1, iterations, iterations)


main()
