"""A silicone tentacle on two tendons, measured at rest by others: fits a rod to 8 of its shapes and predicts the others.

Run it beside `examples/data/tentacle`: `python measured_tentacle.py`, some minutes. It writes the chapter "Against a real
tentacle" of `docs/validation.md` with its picture; SciPy does the least squares. What to look for: how far markers are off in
runs that had no part in the fit, beside the rod of those who measured, and how much of that friction of the tendons explains.
"""

import csv
import math
import re
import sys
from collections import namedtuple
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

import pliant

ROOT = Path(__file__).parents[2]
DATA = ROOT / "examples/data/tentacle/runs.csv"
PAGE = ROOT / "docs/validation.md"
PICTURE = "validation/tentacle.svg"
HEADING = "# Against a real tentacle"

#: Length, and where the tendons end (m); radii (m) at the clamp and at the tip of a cone that is straight to 3 um.
LENGTH, TENDONS_END, RADII = 0.36, 0.305, (0.01541, 0.0048)
#: Young's modulus (Pa) and density (kg/m^3) as they were published, Poisson's ratio.
PUBLISHED, DENSITY, POISSON = 315.09e3, 1317.7, 0.45
GRAVITY = 9.81
#: Markers in the undeformed arm: beside the axis, the section with which they move, how far beyond it (m).
MARKERS = [
    ((0.025, 0.0), 0.1291, 0.0),
    ((-0.021, 0.0), 0.2195, 0.0),
    ((0.020, 0.0), 0.28, 0.0),
    ((0.0, 0.0), 0.36, 0.008),
]
#: Angle (rad) of each tendon from y towards x.
TENDONS = [math.radians(30), math.radians(150)]
#: Elements of the rod, and places of each tendon in each of its pieces, of one tension each.
ELEMENTS, PIECES, PLACES = 72, 10, 7
#: Errors (mm) of markers 1 to 4 by the published rod, on the runs of its fit and on the others, and by it with a neural network, over all 22 runs.
OF_AUTHORS = {"fit": [11.3, 16.2, 15.8, 33.2], "predict": [11.8, 8.4, 10.2, 25.0], "network": [8.1, 6.5, 4.9, 6.1]}

#: Unknowns, each with its size: modulus (Pa), coefficient of friction, section of marker 1 (m), turn of the base about z, and its tilts (rad).
UNKNOWNS = {"modulus": 3e5, "friction": 0.5, "marker": 0.05, "turn": 0.5, "tilt_x": 0.5, "tilt_y": 0.5}


#: What they are.
LABELS = {
    "modulus": "Young's modulus",
    "friction": "coefficient of friction of the tendons",
    "marker": "section of marker 1, from the clamp",
    "turn": "turn of the base about z",
    "tilt_x": "gravity from -z towards x",
    "tilt_y": "gravity from -z towards y",
}
#: Where searches begin, and the section of marker 1 where it is not sought (m).
START, OF_BASE, SHIFTED = {"modulus": 3e5, "friction": 0.1}, {"turn": 0.05, "tilt_x": -0.01, "tilt_y": -0.04}, 0.138
#: The model that the page stands on, by its number.
CHOSEN = 2
#: Runs of the picture, with their colours.
SHOWN = ["m1_u005", "m1_u018", "m2_u018", "m12_u001002", "m12_u0020015"]
COLOURS = ["#1b6ca8", "#c0392b", "#2e8b57", "#8e44ad", "#d98200"]

#: Places (m) of the markers and of the axis, and how far (rad) the arm has turned up to each piece of a tendon.
Shape = namedtuple("Shape", ["markers", "axis", "turned"])


class Run:
    """One measured shape: name, split, tensions (N), places of the markers (m)."""

    def __init__(self, row):
        self.name, self.split, self.session = row["name"], row["split"], row["session"]
        self.tensions = [float(row[f"tendon_{k}_N"]) for k in (1, 2)]
        self.markers = np.array([[float(row[f"m{k}_{axis}"]) for axis in "xyz"] for k in range(1, 5)])
        #: Angles (rad) by which the arm has turned up to the middle of each piece of a tendon, where a search begins.
        self.turned = np.zeros(PIECES)


def arm(model, run, angles, elements):
    """The arm under the tensions of a run, as a scene; `angles` tell how far it has turned up to each piece of a tendon."""
    sections = [model["marker"]] + [section for _, section, _ in MARKERS[1:]]
    stops = [0.0, *sections[:3], TENDONS_END, LENGTH]
    along = np.linspace(0.0, TENDONS_END, PIECES * (PLACES - 1) + 1)
    cables, actuate = [], []
    for number, (angle, tension) in enumerate(zip(TENDONS, run.tensions), 1):
        places = [
            {"inside": [d * math.sin(angle), d * math.cos(angle), -s]} for s, d in zip(along, 0.0114 - 0.0295 * along)
        ]
        for piece in range(PIECES if tension > 0.0 else 0):
            name, first = f"{number}-{piece}", piece * (PLACES - 1)
            cables.append({"name": name, "path": places[first : first + PLACES]})
            # what slides towards the drive pulls by less beyond each turn (capstan)
            left = tension * math.exp(-model["friction"] * angles[piece])
            actuate.append({"springs": name, "force": left})
    sensors = []
    for number, (((x, y), _, beyond), s) in enumerate(zip(MARKERS, sections), 1):
        box = [[-1.0, -1.0, -s - 1e-6], [1.0, 1.0, -s + 1e-6]]
        marker = {"nodes": {"box": box}, "at": [x, y, -s - beyond]}
        sensors.append({"name": f"m{number}", "kind": "position", "marker": marker})
    tilt = [math.sin(model["tilt_x"]), math.sin(model["tilt_y"])]
    down = -math.sqrt(1.0 - tilt[0] ** 2 - tilt[1] ** 2)
    return pliant.Scene(
        dimension=3,
        gravity=[GRAVITY * tilt[0], GRAVITY * tilt[1], GRAVITY * down],
        rod={
            "name": "arm",
            "path": [[0.0, 0.0, -s] for s in stops],
            "elements": elements,
            "section": {"kind": "circle", "radius": RADII[0], "end_radius": RADII[1]},
            "material": {"density": DENSITY, "young": model["modulus"], "poisson": POISSON, "viscosity": 0.0},
        },
        cable=cables,
        phase={"until": 1.0, "hold": {"nodes": "arm/start", "rotation": True}, "actuate": actuate},
        sensor=sensors,
    )


def turned(axis):
    """Angles by which a line through points has turned up to the middle of each piece of a tendon."""
    directions = np.diff(axis, axis=0)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    directions = np.vstack([[0.0, 0.0, -1.0], directions])
    angles = np.arccos(np.clip((directions[1:] * directions[:-1]).sum(axis=1), -1.0, 1.0)).cumsum()
    lengths = np.linalg.norm(np.diff(axis, axis=0), axis=1)
    middles = lengths.cumsum() - 0.5 * lengths
    scale = LENGTH / lengths.sum()
    return np.interp((np.arange(PIECES) + 0.5) * TENDONS_END / PIECES, middles * scale, angles)


def shape(model, run, elements=ELEMENTS, rounds=2):
    """Places of the markers, and of the axis, in equilibrium. Tensions follow from how the arm has turned, in so many rounds from what is known of it."""
    angles = run.turned
    for _ in range(rounds):
        rest = arm(model, run, angles, elements).static()
        axis = rest.positions[-1][: elements + 1]
        angles = turned(axis)
    markers = np.array([[rest.sensors[f"m{k}.{axis}"][-1] for axis in "xyz"] for k in range(1, 5)])
    c, s = math.cos(model["turn"]), math.sin(model["turn"])
    base = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Shape(markers @ base.T, axis @ base.T, angles)


def shapes(model, runs, **how):
    with ThreadPoolExecutor() as pool:
        return list(pool.map(lambda run: shape(model, run, **how), runs))


def settled(model, runs, **how):
    """The same, with tensions that no further round changes; the turns are kept with the runs."""
    found = shapes(model, runs, rounds=5, **how)
    for run, own in zip(runs, found):
        run.turned = own.turned
    return found


def fit(runs, names, model):
    """The unknowns with these names by least squares, from a `model`; their intervals of 95 % if what is left over were noise."""
    for _ in range(2 if "friction" in names else 1):
        start = np.array([UNKNOWNS[name] for name in names])
        settled(model, runs)

        def residuals(x, start=start, model=model):
            changed = {**model, **dict(zip(names, x * start))}
            off = [own.markers - run.markers for own, run in zip(shapes(changed, runs), runs)]
            return 1e3 * np.concatenate(off).ravel()

        first = np.array([model[name] for name in names]) / start
        found = least_squares(residuals, first, diff_step=2e-3, xtol=1e-3, ftol=1e-3, x_scale=0.1, max_nfev=6)
        model = {**model, **dict(zip(names, found.x * start))}
    freedom = len(found.fun) - len(names)
    covariance = np.linalg.inv(found.jac.T @ found.jac) * 2.0 * found.cost / freedom
    half = dict(zip(names, 1.99 * np.sqrt(np.diag(covariance)) * start))
    print(f"{math.sqrt(2.0 * found.cost / len(found.fun)):.2f} mm left over", model, half, file=sys.stderr)
    return model, half


def errors(found, runs):
    """How far (mm) each marker of each run is off."""
    return np.array([1e3 * np.linalg.norm(own.markers - run.markers, axis=1) for own, run in zip(found, runs)])


def mean_of(off, runs, split):
    return np.mean([own for own, run in zip(off, runs) if run.split == split], axis=0)


def row(name, numbers, digits=1):
    return f"| {name} | " + " | ".join(f"{number:.{digits}f}" for number in numbers) + " |\n"


def chapter(models, finer, runs):
    """The chapter: `models` with their names, unknowns, half intervals, shapes and errors, and the errors of the chosen one on twice as many elements."""
    before, after = (
        Path(__file__).with_name(f"measured_tentacle_{part}.md").read_text() for part in ("before", "after")
    )
    text = HEADING + "\n\n" + before
    text += "\n| mean distance (mm) of markers 1 to 4, 10 runs that are predicted | 1 | 2 | 3 | 4 |\n| --- | --- | --- | --- | --- |\n"
    text += row("the authors' rod", OF_AUTHORS["predict"])
    for name, _, _, _, off in models:
        text += row(f"this rod, {name}", mean_of(off, runs, "predict"))
    text += row("modulus and friction, on twice as many elements", mean_of(finer, runs, "predict"))
    text += row("the authors' rod with a network, over all 22 runs, 20 of which taught it", OF_AUTHORS["network"])
    text += "\n| the same, 8 runs of the fit | 1 | 2 | 3 | 4 |\n| --- | --- | --- | --- | --- |\n"
    text += row("the authors' rod", OF_AUTHORS["fit"])
    for name, _, _, _, off in models:
        text += row(f"this rod, {name}", mean_of(off, runs, "fit"))
    text += (
        "\n| unknown | "
        + " | ".join(name for name, *_ in models[1:])
        + " |\n| --- |"
        + " --- |" * len(models[1:])
        + "\n"
    )
    units = {"modulus": ("kPa", 1e-3), "friction": ("", 1.0), "marker": ("mm", 1e3)}
    for key in UNKNOWNS:
        unit, scale = units.get(key, ("degrees", 180.0 / math.pi))
        cells = [
            f"{scale * model[key]:.3g} +- {scale * half[key]:.2g} {unit}" if key in half else ""
            for _, model, half, _, _ in models[1:]
        ]
        text += f"| {LABELS[key]} | " + " | ".join(cells) + " |\n"
    text += (
        "\n| each run that is predicted, "
        + models[CHOSEN][0].strip("*")
        + " (mm) | 1 | 2 | 3 | 4 |\n| --- | --- | --- | --- | --- |\n"
    )
    for run, own in zip(runs, models[CHOSEN][4]):
        if run.split == "predict":
            text += row(f"`{run.name}`: {run.tensions[0]:.2f} and {run.tensions[1]:.2f} N", own)
    return text + f"\n![Measured markers and the rod]({PICTURE})\n\n" + after


def write_chapter(text):
    """Puts the chapter in place of the one with its heading, or at the end of the page."""
    chapters = re.split(r"(?m)^(?=# )", PAGE.read_text())
    others = [own for own in chapters if own.strip() and not own.startswith(HEADING)]
    PAGE.write_text("\n\n".join(own.rstrip() for own in [*others, text]) + "\n")


def picture(found, runs, names):
    """Some shapes from two sides: the axis of the rod, its markers, and the measured ones."""
    scale, wide, high = 1500.0, 400.0, 640.0
    parts = []
    for panel, (across, label) in enumerate(((0, "x"), (1, "y"))):

        def at(place, panel=panel, across=across):
            return 160.0 + panel * wide + scale * place[across], 40.0 - scale * place[2]

        parts.append(f'<text x="{at([0, 0, 0])[0]:.0f}" y="24" text-anchor="middle">{label} and z</text>')
        for colour, name in zip(COLOURS, names):
            own, run = next((own, run) for own, run in zip(found, runs) if run.name == name)
            line = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(at, own.axis))
            parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
            for ours, seen in zip(map(at, own.markers), map(at, run.markers)):
                parts.append(f'<path d="M{ours[0]:.1f} {ours[1]:.1f}L{seen[0]:.1f} {seen[1]:.1f}" stroke="{colour}"/>')
                parts.append(f'<circle cx="{seen[0]:.1f}" cy="{seen[1]:.1f}" r="4" fill="{colour}"/>')
                parts.append(f'<circle cx="{ours[0]:.1f}" cy="{ours[1]:.1f}" r="4" fill="white" stroke="{colour}"/>')
    for k, (colour, name) in enumerate(zip(COLOURS, names)):
        parts.append(f'<text x="{10 + 160 * k}" y="{high - 12}" fill="{colour}">{name}</text>')
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {2 * wide:.0f} {high:.0f}" font-family="sans-serif" font-size="14">'
    bar = '<path d="M20 60h150" stroke="black" stroke-width="2"/><text x="95" y="52" text-anchor="middle">100 mm</text>'
    note = '<text x="10" y="612">dots: measured; circles: the rod; lines join them and follow its axis</text>'
    back = '<rect width="100%" height="100%" fill="white"/>'
    (PAGE.parent / PICTURE).write_text("\n".join([head, back, *parts, bar, note, "</svg>"]) + "\n")


def main():
    with open(DATA) as file:
        runs = [Run(row) for row in csv.DictReader(file)]
    fitted = [run for run in runs if run.split == "fit"]
    ideal = {"modulus": PUBLISHED, "friction": 0.0, "marker": MARKERS[0][1], "turn": 0.0, "tilt_x": 0.0, "tilt_y": 0.0}
    one, half = fit(fitted, ["modulus"], {**ideal, "marker": SHIFTED, "modulus": 3.6e5})
    two, halves = fit(fitted, ["modulus", "friction"], {**one, **START})
    whole, all_halves = fit(fitted, list(UNKNOWNS), {**two, **OF_BASE})
    models = [
        ("published constants", ideal, {}),
        ("modulus", one, half),
        ("**modulus and friction**", two, halves),
        ("modulus, friction, base, marker 1", whole, all_halves),
    ]
    rows = []
    for name, model, half in models:
        found = settled(model, runs)
        rows.append((name, model, half, found, errors(found, runs)))
    finer = errors(settled(two, runs, elements=2 * ELEMENTS), runs)
    write_chapter(chapter(rows, finer, runs))
    picture(rows[CHOSEN][3], runs, SHOWN)


if __name__ == "__main__":
    main()
