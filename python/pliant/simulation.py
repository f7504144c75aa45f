"""A scene that a program drives."""

import os

import numpy as np

from .motion import Motion


class Simulation:
    """A scene in motion under the control of a program: it advances, is commanded, goes back, and is forked.

    Nodes are named by a set (``"right"``), a number from 1, or a list of numbers. Commands take effect at the present time
    and stay in force until the phase ends. A simulation belongs to one thread at a time: :meth:`fork` one for each.
    """

    def __init__(self, simulation):
        self._simulation = simulation
        inner = ("step", "advance_to", "advance_by", "advance_until", "position", "velocity", "centre_of_mass", "mean_velocity")
        inner += ("rotation", "pressure", "chamber_volume", "spring_length", "spring_pull", "contact_force", "set_pressure")
        inner += ("actuate", "hold", "release", "contact", "checkpoint", "restore")
        # without a step in between: a tick of a controller calls many of them
        for name in inner:
            setattr(self, name, getattr(simulation, name))

    time = property(lambda self: self._simulation.time, doc="The present time (s).")
    end = property(lambda self: self._simulation.end, doc="The end of the scene (s).")
    phase = property(lambda self: self._simulation.phase, doc="The name of the present phase.")
    steps = property(lambda self: self._simulation.steps, doc="Steps of the integrator so far.")
    displacements = property(lambda self: self._simulation.displacements, doc="Displacements (m): [node, axis].")
    velocities = property(lambda self: self._simulation.velocities, doc="Velocities (m/s): [node, axis].")
    positions = property(lambda self: self._simulation.positions, doc="Places of the nodes (m): [node, axis].")
    energy = property(lambda self: dict(self._simulation.energy), doc="Energies (J) by name.")

    def load(self, nodes, force):
        """Sets a force (N) on each of the nodes, in place of the load that these nodes have."""
        self._simulation.load(nodes, [float(part) for part in force])

    def move_nodes(self, nodes, velocity):
        """Moves nodes on from where they are with a constant velocity (m/s)."""
        self._simulation.move_nodes(nodes, [float(part) for part in velocity])

    def move_obstacle(self, obstacle, velocity):
        """Moves an obstacle on from where it is with a constant velocity (m/s)."""
        self._simulation.move_obstacle(obstacle, [float(part) for part in velocity])

    def change_state(self, displacements=None, velocities=None):
        """Gives the body other displacements (m) or velocities (m/s) at once, as by an impact: arrays [node, axis]."""
        displacements = self.displacements if displacements is None else displacements
        velocities = self.velocities if velocities is None else velocities
        as_array = lambda array: np.ascontiguousarray(array, dtype=float)
        self._simulation.change_state(as_array(displacements), as_array(velocities))

    def control(self, period, until, controller):
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

    def when(self, event, action, direction=0):
        """Calls ``action(self)`` wherever ``event(time, positions, velocities)`` changes its sign, as of :meth:`advance_until`:
        upwards (`direction` 1), downwards (-1), or both (0).

        The action reads the motion and gives commands, at exactly that time; if it returns True the advance stops there. While
        it runs nothing is watched. An exception of the event or the action ends the advance. A motion that is turned back
        ever sooner, as by an impact, has to be brought to rest by the action below some speed; otherwise the advance ends
        with an :class:`InputError`. Forks watch nothing.
        """
        self._simulation.when(event, lambda: action(self), direction)

    def read_checkpoint(self, path):
        """A state from a file that a checkpoint has written."""
        return self._simulation.read_checkpoint(os.fspath(path))

    def fork(self):
        """An independent simulation that goes on from here, with the commands in force; for another thread, too."""
        return Simulation(self._simulation.fork())

    @property
    def motion(self):
        """The :class:`Motion` so far, sampled as `[output]` says."""
        return Motion(self._simulation.motion())

    def __repr__(self):
        return f"<pliant.Simulation at {self.time:g} of {self.end:g} s, phase {self.phase!r}>"
