"""Dynamics of soft elastic bodies: finite elements and stiff integrators.

>>> import pliant
>>> scene = pliant.Scene.from_toml("scenes/square-press.toml")
>>> motion = scene.run(rtol=1e-5)

A :class:`Scene` is a body, what surrounds it, and what happens; :meth:`Scene.run` gives its :class:`Motion`,
:meth:`Scene.start` a :class:`Simulation` that a program drives. :mod:`pliant.words` has builders for the tables of scenes.
:func:`reduce` learns a model of a scene in a few unknowns, by which it runs faster.
:func:`solve_ivp` integrates any equations, with the signature of SciPy's, :func:`solve_dae` differential-algebraic ones,
:class:`Run` does so step by step, and :func:`gradient` gives derivatives of what comes of them.
"""

from .adjoint import Gradient, gradient
from .dae import solve_dae
from .ensemble import ensemble
from .equations import OdeResult, Progress
from .errors import Error, FileError, InputError, IntegrationError, ModelWarning, NoEquilibrium, SceneError
from .events import Event, Jump
from .ivp import solve_ivp
from .krylov import Krylov
from .mesh import Mesh
from .motion import Equilibrium, Motion
from .reduced import ReducedModel, reduce
from .run import Run
from .scene import Scene
from .simulation import Simulation
from .sweep import Sweep, sweep

__version__ = "0.1.0"

__all__ = [
    "Equilibrium",
    "Error",
    "Event",
    "FileError",
    "Gradient",
    "InputError",
    "IntegrationError",
    "Jump",
    "Krylov",
    "Mesh",
    "ModelWarning",
    "Motion",
    "NoEquilibrium",
    "OdeResult",
    "Progress",
    "ReducedModel",
    "Run",
    "Scene",
    "SceneError",
    "Simulation",
    "Sweep",
    "ensemble",
    "gradient",
    "reduce",
    "solve_dae",
    "solve_ivp",
    "sweep",
]
