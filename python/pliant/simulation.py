"""A scene that a program drives."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _pliant
from .motion import Motion

#: The name of a node set, the number of a node (from 1), or several numbers.
Nodes = str | int | Sequence[int]
Array = NDArray[np.float64]


def _vector(value: float | Sequence[float]) -> list[float]:
    return [float(part) for part in np.atleast_1d(value)]


class Simulation:
    """A scene in motion under the control of a program: it advances, is commanded, goes back, and is forked.

    Nodes are named by a set (``"right"``), a number from 1, or a list of numbers. Commands take effect at the present time
    and stay in force until another command replaces them or the phase ends: the next phase begins as the scene defines it, and
    commands have to be given again. (What has happened stays: positions, amounts of gas and liquid, states of lags, and where an
    obstacle that :meth:`move_obstacle` moved has come to.) A simulation belongs to one thread at a time: :meth:`fork` one for each.
    """

    def __init__(self, simulation: _pliant.Simulation):
        self._simulation = simulation

    @property
    def time(self) -> float:
        """The present time (s)."""
        return self._simulation.time

    @property
    def end(self) -> float:
        """The end of the scene (s)."""
        return self._simulation.end

    @property
    def phase(self) -> str:
        """The name of the present phase."""
        return self._simulation.phase

    @property
    def steps(self) -> int:
        """Steps of the integrator so far."""
        return self._simulation.steps

    @property
    def displacements(self) -> Array:
        """Displacements (m): [node, axis]."""
        return self._simulation.displacements

    @property
    def velocities(self) -> Array:
        """Velocities (m/s): [node, axis]."""
        return self._simulation.velocities

    @property
    def positions(self) -> Array:
        """Places of the nodes (m): [node, axis]."""
        return self._simulation.positions

    @property
    def energy(self) -> dict[str, float]:
        """Energies (J) by name."""
        return dict(self._simulation.energy)

    @property
    def motion(self) -> Motion:
        """The :class:`Motion` so far, sampled as `[output]` says."""
        return Motion(self._simulation.motion())

    def position(self, nodes: Nodes) -> Array:
        """Mean position (m) of nodes."""
        return self._simulation.position(nodes)

    def velocity(self, nodes: Nodes) -> Array:
        """Mean velocity (m/s) of nodes."""
        return self._simulation.velocity(nodes)

    def centre_of_mass(self) -> Array:
        """Centre of mass (m)."""
        return self._simulation.centre_of_mass()

    def mean_velocity(self) -> Array:
        """Velocity of the centre of mass (m/s)."""
        return self._simulation.mean_velocity()

    def rotation(self) -> float | None:
        """Angle (rad) by which a body in the plane has turned; None for others."""
        return self._simulation.rotation()

    def absolute_pressure(self, chamber: str) -> float:
        """Absolute pressure (Pa) of the gas in a chamber."""
        return self._simulation.absolute_pressure(chamber)

    def gas_amount(self, chamber: str) -> float:
        """Amount of gas (kg) in a chamber."""
        return self._simulation.gas_amount(chamber)

    def gas_flow(self, orifice: str) -> float:
        """Flow of gas (kg/s) through an orifice, from its first end to its second."""
        return self._simulation.gas_flow(orifice)

    def liquid_volume(self, chamber: str) -> float:
        """Volume (m^3) of the liquid in a chamber, as it is without pressure."""
        return self._simulation.liquid_volume(chamber)

    def liquid_level(self, chamber: str) -> float:
        """Height (m) of the surface of the liquid in a chamber above the origin, against gravity."""
        return self._simulation.liquid_level(chamber)

    def pipe_flow(self, pipe: str) -> float:
        """Flow of liquid (m^3/s) through a pipe, from its first end to its second."""
        return self._simulation.pipe_flow(pipe)

    def liquid_flow(self, chamber: str) -> float:
        """Flow of liquid (m^3/s) into a chamber."""
        return self._simulation.liquid_flow(chamber)

    def pressure(self, chamber: str) -> float:
        """Pressure (Pa) in a chamber."""
        return self._simulation.pressure(chamber)

    def chamber_volume(self, chamber: str) -> float:
        """Volume (m^3) of a chamber."""
        return self._simulation.chamber_volume(chamber)

    def muscle_stress(self, muscle: str) -> float:
        """Stress (Pa) by which a muscle pulls; by Hill's law the mean over its volume."""
        return self._simulation.muscle_stress(muscle)

    def muscle_stretch(self, muscle: str) -> float:
        """How much longer the fibres of a muscle are than in the undeformed shape, as a factor."""
        return self._simulation.muscle_stretch(muscle)

    def activation(self, muscle: str) -> float:
        """Activation (0 to 1) of a muscle with Hill's law."""
        return self._simulation.activation(muscle)

    def actuation(self, actuator: str) -> float:
        """What drives a spring, a cable (N), a winch (m), a muscle (Pa) or a growth (1), behind its lag if it has one."""
        return self._simulation.actuation(actuator)

    def temperature(self, actuator: str) -> float:
        """By how much a heated actuator is warmer than what is around it (K)."""
        return self._simulation.temperature(actuator)

    def magnetic_moment(self) -> Array:
        """Magnetic moment (A m^2) of all magnets."""
        return self._simulation.magnetic_moment()

    def dipole_position(self, dipole: str) -> Array:
        """Where a dipole is (m)."""
        return self._simulation.dipole_position(dipole)

    def dipole_force(self, dipole: str) -> Array:
        """Force (N) of a dipole on all magnets; that on the dipole is minus this."""
        return self._simulation.dipole_force(dipole)

    def fluid_force(self, fluid: str) -> Array:
        """Force (N) of a fluid on the bodies, drag and pressure."""
        return self._simulation.fluid_force(fluid)

    def device_output(self, device: str, output: str) -> Array:
        """Output of a device by its word, as the `force` (N) of a wind: one component per dimension, or one."""
        return self._simulation.device_output(device, output)

    def spring_length(self, spring: str) -> float:
        """Length (m) of a spring."""
        return self._simulation.spring_length(spring)

    def spring_pull(self, spring: str) -> float:
        """Pull (N) of a spring."""
        return self._simulation.spring_pull(spring)

    def contact_force(self, obstacle: str) -> Array:
        """Force (N) of an obstacle on the body."""
        return self._simulation.contact_force(obstacle)

    def step(self) -> bool:
        """Takes one step of the integrator. Returns whether the scene goes on."""
        return self._simulation.step()

    def advance_to(self, time: float) -> bool:
        """Advances to a time (s). Returns whether the scene goes on."""
        return self._simulation.advance_to(time)

    def advance_by(self, dt: float) -> bool:
        """Advances by a time (s). Returns whether the scene goes on."""
        return self._simulation.advance_by(dt)

    def advance_until(self, time: float, event: Callable[[float, Array, Array], float]) -> bool:
        """Advances to a time (s), at most until ``event(time, positions, velocities)`` changes its sign.

        Returns whether it did.
        """
        return self._simulation.advance_until(time, event)

    def control(self, period: float, until: float, controller: Callable[[Simulation], object]) -> bool:
        """Calls ``controller(self)`` now and after each `period` (s), until the time `until` (s).

        Returns whether that was reached.
        """
        if not period > 0.0:
            raise ValueError(f"a period above 0 is needed, not {period} s")
        start, tick, advance_to = self.time, 0, self._simulation.advance_to
        while True:
            controller(self)
            tick += 1
            time = min(start + tick * period, until)
            if not advance_to(time) or time >= until:
                return self.time >= until

    def when(self, event: Callable, action: Callable[[Simulation], bool | None], direction: int = 0) -> None:
        """Calls ``action(self)`` wherever ``event(time, positions, velocities)`` changes its sign, as of :meth:`advance_until`:
        upwards (`direction` 1), downwards (-1), or both (0).

        The action reads the motion and gives commands, at exactly that time; if it returns True the advance stops there. While
        it runs nothing is watched. An exception of the event or the action ends the advance. A motion that is turned back
        ever sooner, as by an impact, has to be brought to rest by the action below some speed; otherwise the advance ends
        with an :class:`InputError`. Forks watch nothing.
        """
        self._simulation.when(event, lambda: action(self), direction)

    def set_pressure(self, chamber: str, pressure: float) -> None:
        """Sets the pressure (Pa) in a chamber, until the phase ends."""
        self._simulation.set_pressure(chamber, pressure)

    def open(self, orifice: str, opening: float) -> None:
        """Sets how far an orifice is open, from 0 (shut) to 1."""
        self._simulation.open(orifice, opening)

    def flow(self, chamber: str, flow: float) -> None:
        """Sets the flow of liquid (m^3/s) into a chamber; below 0 it flows out."""
        self._simulation.flow(chamber, flow)

    def actuate(self, spring: str, force: float) -> None:
        """Sets the force (N) of the actuator of a spring, the tension (N) of a cable, the length (m) that a winch has drawn in, or the stress
        (Pa) of a muscle, or the strain of a growth; of what is heated the power (W)."""
        self._simulation.actuate(spring, force)

    def load(self, nodes: Nodes, force: Sequence[float]) -> None:
        """Sets a force (N) on each of the nodes, in place of the load that these nodes have."""
        self._simulation.load(nodes, _vector(force))

    def moment(self, nodes: Nodes, moment: float | Sequence[float]) -> None:
        """Sets a moment (N m) on nodes together, in the plane a number, in place of the one that these nodes have."""
        self._simulation.moment(nodes, _vector(moment))

    def follower_force(self, nodes: Nodes, force: Sequence[float]) -> None:
        """Sets a force (N) on nodes together that turns with them, given for the undeformed shape, in place of the one that these nodes have."""
        self._simulation.follower_force(nodes, _vector(force))

    def follower_moment(self, nodes: Nodes, moment: float | Sequence[float]) -> None:
        """Sets a moment (N m) on nodes together that turns with them, in place of the one that these nodes have."""
        self._simulation.follower_moment(nodes, _vector(moment))

    def set_input(self, device: str, input: str, value: float | Sequence[float]) -> None:
        """Sets an input of a device by its word, as the `velocity` (m/s) of a wind: a number, or one component per dimension."""
        self._simulation.set_input(device, input, float(value) if np.isscalar(value) else _vector(value))

    def set_magnetic_field(self, field: Sequence[float]) -> None:
        """Sets the magnetic field (T) that acts on magnets, one component per dimension; a gradient of it stays."""
        self._simulation.set_magnetic_field(_vector(field))

    def set_dipole_position(self, dipole: str, position: Sequence[float]) -> None:
        """Sets the position (m) of a dipole, one component per dimension."""
        self._simulation.set_dipole_position(dipole, _vector(position))

    def set_dipole_moment(self, dipole: str, moment: Sequence[float]) -> None:
        """Sets the moment (A m^2) of a dipole, one component per dimension."""
        self._simulation.set_dipole_moment(dipole, _vector(moment))

    def hold(self, nodes: Nodes) -> None:
        """Holds nodes where they are."""
        self._simulation.hold(nodes)

    def move_nodes(self, nodes: Nodes, velocity: Sequence[float]) -> None:
        """Moves nodes on from where they are with a constant velocity (m/s)."""
        self._simulation.move_nodes(nodes, [float(part) for part in velocity])

    def release(self, nodes: Nodes) -> None:
        """Frees nodes that are held or moved."""
        self._simulation.release(nodes)

    def contact(self, obstacle: str, acts: bool) -> None:
        """Lets an obstacle act, or not."""
        self._simulation.contact(obstacle, acts)

    def move_obstacle(self, obstacle: str, velocity: Sequence[float]) -> None:
        """Moves an obstacle on from where it is with a constant velocity (m/s)."""
        self._simulation.move_obstacle(obstacle, [float(part) for part in velocity])

    def change_state(self, displacements: ArrayLike | None = None, velocities: ArrayLike | None = None) -> None:
        """Gives the body other displacements (m) or velocities (m/s) at once, as by an impact: arrays [node, axis]."""
        displacements = self.displacements if displacements is None else displacements
        velocities = self.velocities if velocities is None else velocities
        as_array = lambda array: np.ascontiguousarray(array, dtype=float)
        self._simulation.change_state(as_array(displacements), as_array(velocities))

    def checkpoint(self) -> _pliant.Checkpoint:
        """The present state, to return to by :meth:`restore`; its method `write` keeps it in a file."""
        return self._simulation.checkpoint()

    def restore(self, checkpoint: _pliant.Checkpoint) -> None:
        """Returns to a state."""
        self._simulation.restore(checkpoint)

    def read_checkpoint(self, path: str | os.PathLike) -> _pliant.Checkpoint:
        """A state from a file that a checkpoint has written."""
        return self._simulation.read_checkpoint(os.fspath(path))

    def fork(self) -> Simulation:
        """An independent simulation that goes on from here, with the commands in force; for another thread, too."""
        return Simulation(self._simulation.fork())

    def __repr__(self):
        return f"<pliant.Simulation at {self.time:g} of {self.end:g} s, phase {self.phase!r}>"
