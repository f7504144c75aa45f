"""What a run has computed."""

import html
import json
import os
import tempfile
from functools import cached_property

import numpy as np

from .mesh import Mesh


class Motion:
    """The motion of a body, sampled.

    Arrays are made when they are asked for first, and kept; do not write into them.
    """

    def __init__(self, motion):
        self._motion = motion

    title = property(lambda self: self._motion.title, doc="The title of the scene.")
    failure = property(lambda self: self._motion.failure, doc="Why the run ended early; None if it did not.")
    warnings = property(lambda self: self._motion.warnings(), doc="What makes the motion doubtful.")

    @cached_property
    def times(self):
        """Times of the samples (s)."""
        return self._motion.times()

    @cached_property
    def phases(self):
        """Number of the phase of each sample, from 0."""
        return self._motion.phases()

    @cached_property
    def displacements(self):
        """Displacements (m): [sample, node, axis]."""
        return self._motion.displacements()

    @cached_property
    def velocities(self):
        """Velocities (m/s): [sample, node, axis]."""
        return self._motion.velocities()

    @cached_property
    def positions(self):
        """Places of the nodes (m): [sample, node, axis]."""
        return self.displacements + self._motion.nodes()

    @cached_property
    def contact_forces(self):
        """Forces of obstacles, and of bodies that touch, on the nodes (N): [sample, node, axis]."""
        return self._motion.contact_forces()

    @cached_property
    def contact_pressures(self):
        """Contact pressures at the nodes (Pa): [sample, node]."""
        return self._motion.contact_pressures()

    @cached_property
    def contact_status(self):
        """0 at nodes where nothing touches, 1 where it sticks, 2 where it slides: [sample, node]."""
        return self._motion.contact_status()

    @cached_property
    def reactions(self):
        """Forces of constraints on the nodes (N): [sample, node, axis]."""
        return self._motion.constraint_forces()

    @cached_property
    def energies(self):
        """Energies (J) by name: kinetic, strain, gravity, contact, springs, dissipated, supplied, and their balance."""
        return dict(zip(self._motion.energy_names(), self._motion.energies().T))

    @cached_property
    def centre_of_mass(self):
        """Centre of mass (m): [sample, axis]."""
        return self._motion.centre_of_mass()

    @cached_property
    def momentum(self):
        """Momentum (kg m/s): [sample, axis]."""
        return self._motion.momentum()

    @cached_property
    def angular_momentum(self):
        """Angular momentum about the centre of mass (kg m^2/s): [sample, component]."""
        return self._motion.angular_momentum()

    @cached_property
    def sensors(self):
        """Readings of the sensors by name: one array each."""
        names = [name for name, _ in self._motion.sensor_names]
        return dict(zip(names, self._motion.sensors().T))

    @property
    def units(self):
        """Units of the sensors by name."""
        return dict(self._motion.sensor_names)

    @cached_property
    def report(self):
        """How the motion was computed: the report as a dict, with the keys of `report.json`."""
        return json.loads(self._motion.report_json())

    @property
    def mesh(self):
        """The mesh of the body."""
        motion = self._motion
        return Mesh(motion.nodes(), motion.cells(), motion.cell_kind)

    @property
    def bodies(self):
        """Which nodes several bodies have, by name: ``motion.displacements[:, motion.bodies["hand"]]``."""
        return {name: slice(first, end) for name, first, end in self._motion.bodies()}

    def stress(self, sample=-1):
        """Stress (Pa) in each cell of a sample: [cell, axis, axis]."""
        return self._motion.stress(self._number(sample))

    def strain(self, sample=-1):
        """Strain in each cell of a sample: [cell, axis, axis]."""
        return self._motion.strain(self._number(sample))

    def von_mises(self, sample=-1):
        """Von Mises stress (Pa) in each cell of a sample."""
        return self._motion.von_mises(self._number(sample))

    def _number(self, sample):
        return sample + len(self) if sample < 0 else sample

    def __len__(self):
        return len(self.times)

    def __str__(self):
        return str(self._motion)

    def __repr__(self):
        end = f", ended early: {self.failure}" if self.failure else ""
        return f"<pliant.{type(self).__name__} {self.title!r}: {len(self)} samples until {self.times[-1]:g} s{end}>"

    def _repr_html_(self):
        with tempfile.TemporaryDirectory() as directory:
            path = os.path.join(directory, "animation.html")
            self.write_html(path)
            with open(path, encoding="utf-8") as file:
                page = file.read()
        return f'<iframe srcdoc="{html.escape(page)}" style="width:100%;height:640px;border:0"></iframe>'

    def write_csv(self, path):
        """Writes the table that `pliant run` writes."""
        self._motion.write_csv(os.fspath(path))

    def write_report(self, path):
        """Writes the report as JSON."""
        self._motion.write_report(os.fspath(path))

    def write_html(self, path):
        """Writes an animation for a web browser."""
        self._motion.write_html(os.fspath(path))

    def write_vtk(self, directory):
        """Writes files for ParaView."""
        self._motion.write_vtk(os.fspath(directory))

    def write_svg(self, path, times=None):
        """Writes snapshots at the `times` (s); by default at six times."""
        if times is None:
            times = np.linspace(self.times[0], self.times[-1], 6)
        self._motion.write_svg(os.fspath(path), [float(t) for t in times])

    def columns(self):
        """What has one number for each sample, by name: time, centre of mass, energies, sensors."""
        columns = {"time": self.times}
        for axis, name in enumerate("xyz"[: self.centre_of_mass.shape[1]]):
            columns[f"centre of mass {name}"] = self.centre_of_mass[:, axis]
        columns.update({f"energy {name}": values for name, values in self.energies.items()})
        columns.update(self.sensors)
        return columns

    def to_pandas(self):
        """:meth:`columns` as a DataFrame of pandas, by time."""
        import pandas

        return pandas.DataFrame(self.columns()).set_index("time")

    def to_xarray(self):
        """All arrays as a Dataset of xarray, with the coordinates time, node and axis."""
        import xarray

        axes = list("xyz"[: self.positions.shape[2]])
        vectors = {
            "position": (self.positions, "m"),
            "velocity": (self.velocities, "m/s"),
            "reaction": (self.reactions, "N"),
            "contact_force": (self.contact_forces, "N"),
        }
        data = {name: (("time", "node", "axis"), array, {"units": unit}) for name, (array, unit) in vectors.items()}
        data["contact_pressure"] = (("time", "node"), self.contact_pressures, {"units": "Pa"})
        data["contact_status"] = (("time", "node"), self.contact_status)
        data.update({f"energy_{name}": ("time", values, {"units": "J"}) for name, values in self.energies.items()})
        data.update({name: ("time", values, {"units": self.units[name]}) for name, values in self.sensors.items()})
        nodes = np.arange(1, self.positions.shape[1] + 1)
        return xarray.Dataset(data, {"time": self.times, "node": nodes, "axis": axes}, {"title": self.title})

    def to_meshio(self, sample=-1):
        """One sample as a mesh of meshio, deformed, with displacements, velocities and von Mises stress."""
        mesh = self.mesh.to_meshio()
        axes = self.positions.shape[2]
        mesh.points[:, :axes] = self.positions[sample]
        for name, array in (("displacement", self.displacements), ("velocity", self.velocities)):
            mesh.point_data[name] = np.zeros((len(mesh.points), 3))
            mesh.point_data[name][:, :axes] = array[sample]
        mesh.cell_data["von Mises"] = [self.von_mises(sample)]
        return mesh

    def to_pyvista(self, sample=-1):
        """One sample as a grid of PyVista."""
        import pyvista

        return pyvista.from_meshio(self.to_meshio(sample))

    def plot(self, *names, axes=None):
        """Draws columns over time by matplotlib, those of a load curve over its load factor; by default the sensors, or the centre of mass if there are none.

        Each unit has an axis of values of its own: the first one is that of `axes`, which is returned.
        """
        import matplotlib.pyplot as plt

        columns = self.columns()
        along, label = self._along()
        names = names or tuple(name for name in self.sensors if columns[name] is not along) or tuple(name for name in columns if name.startswith("centre"))
        for name in names:
            if name not in columns:
                raise KeyError(f"{name!r} is none of {', '.join(map(repr, columns))}")
        if axes is None:
            axes = plt.subplots(layout="constrained")[1]
        by_unit, lines = {}, []
        for number, name in enumerate(names):
            unit = self._unit(name)
            if unit not in by_unit:
                by_unit[unit] = axes.twinx() if by_unit else axes
                by_unit[unit].set_ylabel(unit)
                # further axes stand beside the second one
                by_unit[unit].spines["right"].set_position(("outward", 55.0 * max(len(by_unit) - 2, 0)))
            lines += by_unit[unit].plot(along, columns[name], f"C{number}", label=name)
        axes.set_xlabel(label)
        axes.legend(handles=lines)
        return axes

    def _along(self):
        """What plots are drawn over, with its name and unit."""
        return self.times, "time (s)"

    def _unit(self, name):
        """The unit of a column."""
        if name in self.units:
            return self.units[name]
        return "J" if name.startswith("energy ") else "s" if name == "time" else "m"


class Equilibrium(Motion):
    """An equilibrium: a motion whose last sample is at rest."""

    def __init__(self, motion, report):
        super().__init__(motion)
        self._report = report

    @cached_property
    def report(self):
        """How the equilibrium was found, as a dict."""
        return json.loads(self._report)

    def _along(self):
        factor = "load factor"
        return (self.sensors[factor], f"{factor} (1)") if factor in self.sensors else super()._along()
