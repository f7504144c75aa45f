"""pliant as a solver of cosseratbench: a scenario of it as a scene, a motion of the scene as a trajectory."""

import warnings

import numpy as np
import pliant
from cosseratbench import Capability, Scenario, Trajectory
from cosseratbench.scenario import Cylinder, End, EndCondition, Motion, Rod
from cosseratbench.solver import Diverged

#: Node sets of both ends of a rod.
ENDS = {End.START: "start", End.END: "end"}
#: Largest Poisson's ratio of a rod: scenarios have G = E/3, of which 0.5 is the limit.
POISSON = 0.4999999
#: Stiffness (N/m^3) and damping (N s/m) of obstacles, distance of touching rods in radii, sticking speed in lengths per second.
STIFFNESS, DAMPING, DISTANCE, STICKING = 1e8, 1.0, 0.02, 1e-3
#: Stiffness (N m/rad) and damping (N m s) of the motor that turns a sliding end, its mass (kg) and size (m).
SERVO, SERVO_DAMPING, ROTOR, SIZE = 1e2, 1e-2, 1e-4, 0.01
#: Time (s) by which the stress of a rod lags behind its strain where equilibrium is what counts.
RETARDATION = 0.01


class PliantSolver:
    """Equilibria are found as such where nothing moves and nothing rubs; all else runs, undamped unless equilibrium is what counts."""

    name = "pliant"
    capabilities = frozenset(Capability)

    def __init__(self, rtol: float = 1e-4) -> None:
        self.rtol = rtol

    def settings(self, scenario: Scenario, *, n_elements: int, n_frames: int) -> dict:
        return {"method": "static" if is_at_rest(scenario) else "auto", "rtol": self.rtol}

    def run(self, scenario: Scenario, *, n_elements: int, n_frames: int) -> Trajectory:
        times = np.linspace(0.0, scenario.duration, n_frames)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", pliant.ModelWarning)
            scene = scene_of(scenario, n_elements)
            try:
                if is_at_rest(scenario):
                    # at first as it is drawn, then in equilibrium
                    drawn, rest = (np.asarray(scene.static().positions)[k] for k in (0, -1))
                    positions = np.stack([drawn] + [rest] * (n_frames - 1))
                else:
                    motion = scene.run(rtol=self.rtol, sampling=times.tolist())
                    positions = np.asarray(motion.positions)
            except pliant.IntegrationError as error:
                raise Diverged(str(error)) from error
        nodes, directors, first = [], [], 0
        for rod in scenario.rods:
            # nodes of the axis, then of the ends of the first directors, then of the second ones
            axis = positions[:, first : first + n_elements + 1]
            tips = positions[:, first + n_elements + 1 : first + 2 * (n_elements + 1)]
            first += 3 * (n_elements + 1)
            nodes.append(axis)
            directors.append(of_elements(axis, tips - axis))
        return Trajectory(times, tuple(nodes), tuple(directors))


def of_elements(axis: np.ndarray, directors: np.ndarray) -> np.ndarray:
    """The unit directors of elements across these, from those at their ends."""
    along = np.diff(axis, axis=1)
    along /= np.linalg.norm(along, axis=2, keepdims=True)
    mean = directors[:, 1:] + directors[:, :-1]
    mean -= (mean * along).sum(axis=2, keepdims=True) * along
    return mean / np.linalg.norm(mean, axis=2, keepdims=True)


def is_at_rest(scenario: Scenario) -> bool:
    """Whether the result is one equilibrium, without friction and driven ends."""
    driven = any(rod.motion(end) for rod in scenario.rods for end in End)
    rubs = any(part.friction for part in (*scenario.rods, *scenario.obstacles))
    return scenario.quasi_static and not driven and not rubs


def scene_of(scenario: Scenario, n_elements: int) -> pliant.Scene:
    tables = {"rod": [], "joint": [], "body": []}
    phase = {"until": scenario.duration, "hold": [], "load": [], "path": [], "motor": []}
    for number, rod in enumerate(scenario.rods):
        name = f"rod{number}"
        tables["rod"].append(rod_of(rod, name, n_elements, scenario.quasi_static))
        for end, word in ENDS.items():
            nodes, motion = f"{name}/{word}", rod.motion(end)
            if motion is not None and motion.slides_along is not None:
                add_sliding(tables, phase, rod, nodes, end, motion)
            elif rod.condition(end) is not EndCondition.FREE:
                held = {"nodes": nodes, "rotation": rod.condition(end) is EndCondition.CLAMPED}
                add_held(phase, held, motion)
        for load in rod.loads:
            phase["load"].append({"nodes": f"{name}/{ENDS[load.at]}", "total": list(load.force)})
    friction = max(rod.friction for rod in scenario.rods)
    names = [rod["name"] for rod in tables["rod"]]
    # one body alone touches itself
    touching = ([names] if len(names) > 1 else []) + ([[name] for name in names] if scenario.self_contact else [])
    tables["touch"] = [touch_of(scenario, bodies, friction) for bodies in touching]
    tables["obstacle"] = [obstacle_of(scenario, own, friction) for own in scenario.obstacles]
    used = {key: value for key, value in tables.items() if value}
    phase = {key: value for key, value in phase.items() if value}
    return pliant.Scene(dimension=3, gravity=list(scenario.gravity), phase=phase, **used)


def rod_of(rod: Rod, name: str, n_elements: int, is_damped: bool) -> dict:
    """Its path is as it starts; it is free of stress along a straight line of its own length."""
    nodes = rod.nodes(n_elements)
    along = (nodes[1] - nodes[0]) / np.linalg.norm(nodes[1] - nodes[0])
    young, shear = rod.material.youngs_modulus, rod.material.shear_modulus
    return {
        "name": name,
        "path": nodes.tolist(),
        "natural": [nodes[0].tolist(), (nodes[0] + rod.length * along).tolist()],
        "normal": list(rod.normal),
        "elements": n_elements,
        "section": {"kind": "circle", "radius": rod.radius},
        "material": {
            "density": rod.material.density,
            "young": young,
            "poisson": min(young / (2.0 * shear) - 1.0, POISSON),
            "viscosity": RETARDATION * young if is_damped else 0.0,
        },
    }


def add_held(phase: dict, held: dict, motion: Motion | None) -> None:
    """An end that is held, or moved without being turned."""
    if motion is None:
        phase["hold"].append(held)
        return
    if np.any(motion.rotation):
        raise NotImplementedError("an end that is turned and does not slide")
    sections = {"nodes": f"{held['nodes']}-section"}
    for axis, along in zip("xyz", np.transpose(motion.displacement)):
        if np.any(along):
            table = {"times": list(motion.times), "displacements": along.tolist()}
            phase["path"].append({**sections, "axes": axis, **table})
        else:
            phase["hold"].append({**sections, "axes": axis})


def add_sliding(tables: dict, phase: dict, rod: Rod, nodes: str, end: End, motion: Motion) -> None:
    """An end on a rotor in a slider, both of them rigid: a guide along the axis, a motor about it."""
    if np.any(motion.displacement):
        raise NotImplementedError("an end that slides and is moved across")
    at = np.asarray(rod.centerline[0 if end is End.START else -1], float)
    axis, name = motion.axis, nodes.replace("/", "-")
    angles = (np.asarray(motion.rotation) @ axis).tolist()
    mesh = {"kind": "cuboid", "size": [SIZE] * 3, "nodes": [2, 2, 2], "cells": "hexahedra"}
    material = {"rigid": True, "density": ROTOR / SIZE**3}
    for part, beyond in (("rotor", 1.0), ("slider", 3.0)):
        origin = (at + axis * beyond * SIZE - 0.5 * SIZE).tolist()
        tables["body"].append({"name": f"{name}-{part}", "mesh": {**mesh, "origin": origin}, "material": material})
    common = {"at": at.tolist()}
    tables["joint"] += [
        {
            "name": f"{name}-guide",
            "kind": "prismatic",
            "between": ["world", f"{name}-slider"],
            "axis": axis.tolist(),
            **common,
        },
        {
            "name": f"{name}-motor",
            "kind": "revolute",
            "between": [f"{name}-slider", f"{name}-rotor"],
            "axis": axis.tolist(),
            "servo_stiffness": SERVO,
            "servo_damping": SERVO_DAMPING,
            **common,
        },
        {"name": f"{name}-clamp", "kind": "fixed", "between": [f"{name}-rotor", nodes], **common},
    ]
    phase["motor"].append({"joint": f"{name}-motor", "times": list(motion.times), "angles": angles})


def touch_of(scenario: Scenario, bodies: list[str], friction: float) -> dict:
    return {
        "name": "-".join(bodies),
        "bodies": bodies,
        "distance": DISTANCE * min(rod.radius for rod in scenario.rods),
        "friction_coefficient": friction,
        "sticking_speed": STICKING * scenario.rods[0].length,
    }


def obstacle_of(scenario: Scenario, obstacle, friction: float) -> dict:
    common = {
        "stiffness_density": STIFFNESS,
        "damping": DAMPING,
        "friction_coefficient": max(obstacle.friction, friction),
        "sticking_speed": STICKING * scenario.rods[0].length,
    }
    if isinstance(obstacle, Cylinder):
        half = 0.5 * obstacle.length * obstacle.unit_axis
        ends = {"from": np.asarray(obstacle.center) - half, "to": np.asarray(obstacle.center) + half}
        shape = {"kind": "capsule", "radius": obstacle.radius, **{key: end.tolist() for key, end in ends.items()}}
    else:
        shape = {"kind": "half-plane", "point": list(obstacle.point), "normal": list(obstacle.normal)}
    return {**shape, **common}
