"""Scenes that a program drives."""

import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import pliant
from pliant import _pliant

BEAM = pliant.Scene(
    gravity=[0.0, -9.8],
    body=dict(
        mesh=dict(kind="rectangle", size=[0.1, 0.01], nodes=[11, 3], cells="rectangles"),
        thickness=0.01,
        material=dict(density=1000.0, young=1e6, poisson=0.48, viscosity=2e4),
    ),
    phase=[dict(until=2.0, hold=dict(nodes="left"))],
)


def test_help_tells_all():
    """Whatever the engine can do is a method or a property of the class, with its doc."""
    names = {name for name in dir(_pliant.Simulation) if not name.startswith("_")}
    assert "advance_to" in names and names <= set(dir(pliant.Simulation))
    assert all(getattr(pliant.Simulation, name).__doc__ for name in dir(pliant.Simulation) if not name.startswith("_"))


def test_a_controller_lifts_a_beam():
    """The controller of the README: the end comes to where it is wanted, as in Rust."""
    beam = BEAM.start()
    integral = [0.0]

    def controller(beam):
        error = 0.006 - beam.position("right")[1]
        integral[0] += 1e-3 * error
        beam.load("right", [0.0, 20.0 * integral[0] + 2.0 * error])

    assert beam.control(1e-3, 2.0, controller)
    assert abs(beam.position("right")[1] - 0.006) < 1e-5


def test_moments_and_followers():
    """A moment turns the end of the beam, the same one whether it follows or not; a force that follows pulls along what it is given for."""
    beam = BEAM.start()
    states, heights = [], []
    for command in (beam.moment, beam.follower_moment):
        start = beam.checkpoint()
        command("right", 1e-5)
        beam.advance_to(0.1)
        states.append(beam.positions.copy())
        heights.append(beam.position("right")[1])
        beam.restore(start)
    assert np.abs(states[0] - states[1]).max() < 1e-9
    beam.advance_to(0.1)
    assert heights[0] - beam.position("right")[1] > 1e-6
    stretched = beam.fork()
    stretched.follower_force("right", [0.01, 0.0])
    for simulation in (beam, stretched):
        simulation.advance_to(0.12)
    assert stretched.position("right")[0] > beam.position("right")[0]


def test_wind_is_set():
    """A plate that is held feels C_n rho/2 v^2 times its area on both sides; the air at rest pushes nothing."""
    plate = pliant.Scene(
        body=dict(
            mesh=dict(kind="rectangle", size=[0.01, 0.1], nodes=[2, 5], cells="rectangles"),
            thickness=0.1,
            material=dict(density=1000.0, young=1e7, poisson=0.3, viscosity=1e3),
        ),
        wind=[dict(name="gust", drag=0.6)],
        phase=[dict(until=1.0, hold=dict(nodes="all"))],
    ).start()
    assert np.all(plate.device_output("gust", "force") == 0.0)
    plate.set_input("gust", "velocity", [10.0, 0.0])
    plate.advance_to(0.1)
    force = plate.device_output("gust", "force")
    assert abs(force[0] - 2 * 0.6 * 0.5 * 1.2 * 100.0 * 0.01) < 1e-12 and force[1] == 0.0
    with pytest.raises(pliant.InputError, match="velocity"):
        plate.set_input("gust", "speed", 1.0)


def test_motors_are_commanded():
    """A bar on a pin at its end turns by T t^2/(2 J) under a torque T."""
    bar = pliant.Scene(
        body=dict(
            name="bar",
            mesh=dict(kind="rectangle", size=[0.1, 0.01], nodes=[2, 2], cells="rectangles"),
            thickness=0.01,
            material=dict(density=1000.0, rigid=True),
        ),
        joint=[dict(name="pin", kind="revolute", between=["world", "bar"], at=[0.0, 0.005])],
        phase=[dict(until=1.0)],
    ).start(rtol=1e-8)
    bar.set_input("pin", "torque", 1e-3)
    bar.advance_to(0.1)
    moment_of_inertia = 0.01 * ((0.1**2 + 0.01**2) / 12 + 0.05**2)
    angle = bar.device_output("pin", "angle")
    assert abs(angle[0] / (1e-3 * 0.1**2 / (2 * moment_of_inertia)) - 1.0) < 1e-6
    with pytest.raises(pliant.InputError, match="force"):
        bar.set_input("pin", "force", 1.0)


def test_states_are_returned_to():
    beam = BEAM.start(rtol=1e-8)
    beam.advance_to(0.1)
    kept = beam.checkpoint()
    beam.load("right", [0.0, 0.1])
    beam.advance_to(0.2)
    pulled = beam.positions
    beam.restore(kept)
    assert beam.time == kept.time == 0.1
    beam.load("right", [0.0, 0.1])
    beam.advance_to(0.2)
    assert np.abs(beam.positions - pulled).max() < 1e-8


def test_checkpoints_are_files(tmp_path):
    beam = BEAM.start()
    beam.advance_to(0.1)
    beam.checkpoint().write(tmp_path / "c.json")
    beam.advance_to(0.2)
    other = BEAM.start()
    other.restore(other.read_checkpoint(tmp_path / "c.json"))
    other.advance_to(0.2)
    assert np.abs(other.positions - beam.positions).max() < 1e-6


def test_forks_on_threads():
    beam = BEAM.start()
    beam.advance_to(0.05)

    def end(force):
        fork = beam.fork()
        fork.load("right", [0.0, force])
        fork.advance_to(0.3)
        return fork.position("right")[1]

    forces = np.linspace(0.0, 0.1, 6)
    with ThreadPoolExecutor(2) as pool:
        ends = list(pool.map(end, forces))
    assert np.all(np.diff(ends) > 0) and ends == [end(force) for force in forces]


def test_events_are_met():
    beam = BEAM.start(rtol=1e-8)
    right = BEAM.mesh.sets["right"]
    met = beam.advance_until(1.0, lambda t, x, v: x[right, 1].mean() - 0.004)
    assert met and abs(beam.position("right")[1] - 0.004) < 1e-12
    with pytest.raises(ZeroDivisionError):
        beam.advance_until(1.0, lambda t, x, v: 1 / 0)


def test_an_impact():
    beam = BEAM.start()
    beam.change_state(velocities=np.full_like(beam.velocities, 0.5))
    assert np.allclose(beam.velocity("right"), 0.5)
    with pytest.raises(pliant.InputError, match="numbers"):
        beam.change_state(velocities=np.zeros((2, 2)))


def test_bad_commands_name_what_there_is():
    beam = BEAM.start()
    with pytest.raises(pliant.InputError, match="right"):
        beam.load("rigth", [0.0, 1.0])
    with pytest.raises(pliant.InputError):
        beam.advance_to(3.0)
    with pytest.raises(pliant.InputError, match="chamber"):
        beam.set_pressure("air", 1.0)
    with pytest.raises(ValueError, match="period"):
        beam.control(0.0, 1.0, lambda beam: None)


def test_what_acts_within_the_material_is_driven():
    strip = pliant.Scene(
        body=dict(
            mesh=dict(kind="rectangle", size=[0.1, 0.01], nodes=[11, 3], cells="rectangles"),
            thickness=0.01,
            plane="stress",
            material=dict(density=1000.0, young=1e5, poisson=0.3, viscosity=2e3),
        ),
        muscle=dict(name="upper", along=[1.0, 0.0], box=[[0.0, 0.005], [0.1, 0.01]]),
        growth=dict(name="lower", box=[[0.0, 0.0], [0.1, 0.005]]),
        magnet=dict(remanence=[0.1, 0.0]),
        phase=[dict(until=0.1, hold=dict(nodes="left"))],
    ).start()
    strip.actuate("upper", 2e3)
    strip.actuate("lower", 0.01)
    strip.set_magnetic_field([0.0, 1e-3])
    strip.advance_to(0.1)
    assert strip.position("right")[1] > 0.006
    assert strip.muscle_stretch("upper") < 1.0
    moment = strip.magnetic_moment()
    assert moment[1] > 0.01 * moment[0] > 0.0


def test_actuators_lag():
    strip = pliant.Scene(
        body=dict(
            mesh=dict(kind="bar", length=0.1, nodes=3),
            area=1e-4,
            material=dict(density=1000.0, young=1e5, poisson=0.3, viscosity=2e3),
        ),
        muscle=dict(name="biceps", along=[1.0], hill=dict(largest=1e4)),
        spring=dict(name="coil", ends=["right", dict(point=[0.2])], stiffness=5.0),
        lag=[
            dict(actuators="biceps", rise=0.015, fall=0.05, activation=True),
            dict(actuators="coil", capacity=0.2, loss=0.1, per_kelvin=-0.01),
        ],
        sensor=[
            dict(name="a", kind="activation", muscle="biceps"),
            dict(name="warmth", kind="temperature", actuator="coil"),
        ],
        phase=[dict(until=0.2, hold=dict(nodes="left"))],
    ).start()
    strip.actuate("biceps", 5e3)
    strip.actuate("coil", 1.0)
    strip.advance_to(0.1)
    assert 0.45 < strip.activation("biceps") < 0.5
    warmth = 10.0 * (1.0 - np.exp(-0.05))
    assert abs(strip.temperature("coil") - warmth) < 1e-4
    assert abs(strip.actuation("coil") + 0.01 * warmth) < 1e-6


def test_a_dipole_is_led():
    strip = pliant.Scene(
        body=dict(
            mesh=dict(kind="rectangle", size=[0.02, 0.001], nodes=[21, 3], cells="rectangles9"),
            thickness=0.005,
            material=dict(density=2000.0, young=1e6, poisson=0.3, viscosity=5e3),
        ),
        magnet=dict(remanence=[0.1, 0.0]),
        dipole=dict(name="lead", moment=[0.0, 0.3], position=[0.02, 1.0]),
        phase=[dict(until=0.1, hold=dict(nodes="left"))],
    ).start()
    strip.set_dipole_position("lead", [0.02, 0.03])
    strip.advance_to(0.05)
    assert strip.position("right")[1] > 0.001
    assert strip.dipole_position("lead")[1] == 0.03
    assert strip.dipole_force("lead")[1] > 0.0
    strip.set_dipole_moment("lead", [0.0, 0.0])
    assert (strip.dipole_force("lead") == 0.0).all()


def test_one_thread_at_a_time():
    beam = BEAM.start()

    def inside(t, x, v):
        beam.step()
        return 1.0

    with pytest.raises(RuntimeError, match="fork"):
        beam.advance_until(0.1, inside)


def test_a_syringe():
    scene = pliant.Scene(
        body={
            "mesh": {"kind": "ring", "inner": 0.02, "outer": 0.03, "nodes": [16, 3], "cells": "rectangles"},
            "thickness": 0.02,
            "material": {"density": 1000.0, "young": 2e5, "poisson": 0.4, "viscosity": 200.0},
        },
        chamber={"name": "bag", "nodes": "inner", "burst": 1e5},
        liquid={"chamber": "bag"},
        phase={"until": 0.1, "hold": [{"nodes": [1]}]},
    )
    ring = scene.start()
    before = ring.liquid_volume("bag")
    assert ring.liquid_flow("bag") == 0.0
    ring.flow("bag", 2e-5)
    ring.advance_to(0.05)
    assert ring.liquid_flow("bag") == 2e-5
    assert ring.liquid_volume("bag") - before == pytest.approx(1e-6, rel=1e-6)
    assert ring.chamber_volume("bag") - before == pytest.approx(1e-6, rel=1e-3) and ring.pressure("bag") > 0.0
    with pytest.raises(pliant.InputError, match="bag"):
        ring.flow("bog", 1e-5)


def test_a_level_and_a_pipe():
    scene = pliant.Scene(
        gravity=[0.0, -9.8],
        body={
            "mesh": {"kind": "ring", "inner": 0.02, "outer": 0.03, "nodes": [16, 3], "cells": "rectangles"},
            "thickness": 0.02,
            "material": {"density": 1000.0, "young": 1e6, "poisson": 0.4, "viscosity": 2e3},
        },
        chamber={"name": "cup", "nodes": "inner"},
        liquid={"chamber": "cup", "fill": 0.5, "surface": True},
        supply={"name": "basin", "pressure": 101325.0 + 50.0},
        pipe={"name": "tube", "from": "basin", "to": "cup", "length": 0.1, "area": 1e-5},
        phase={"until": 0.1, "hold": [{"nodes": "all"}]},
    )
    cup = scene.start()
    before = cup.liquid_level("cup")
    assert before == pytest.approx(0.0, abs=1e-6) and cup.pipe_flow("tube") == 0.0
    cup.advance_to(0.1)
    assert cup.pipe_flow("tube") > 0.0 and cup.liquid_level("cup") > before


def test_a_valve():
    scene = pliant.Scene(
        body={
            "mesh": {"kind": "ring", "inner": 0.02, "outer": 0.03, "nodes": [16, 3], "cells": "rectangles"},
            "thickness": 0.02,
            "material": {"density": 1000.0, "young": 2e5, "poisson": 0.4, "viscosity": 200.0},
        },
        chamber={"name": "air", "nodes": "inner"},
        gas={"chamber": "air"},
        supply={"name": "pump", "pressure": 1.05e5},
        orifice={"name": "valve", "from": "pump", "to": "air", "conductance": 1e-8},
        phase={"until": 1.0, "hold": [{"nodes": [1]}], "open": [{"orifice": "valve", "opening": 0.0}]},
    )
    ring = scene.start()
    ring.advance_to(0.01)
    before = ring.gas_amount("air")
    assert ring.gas_flow("valve") == 0.0 and abs(ring.pressure("air")) < 1.0
    ring.open("valve", 1.0)
    assert ring.gas_flow("valve") > 0.0
    ring.advance_to(0.05)
    assert ring.gas_amount("air") > before
    assert ring.absolute_pressure("air") == pytest.approx(101325.0 + ring.pressure("air"))
    with pytest.raises(pliant.InputError, match="valve"):
        ring.open("valv", 1.0)
