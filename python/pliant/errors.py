"""What can go wrong. Every exception says what to change."""

from .motion import Motion


class Error(Exception):
    """Any error of pliant."""


class InputError(Error, ValueError):
    """An input that cannot be used.

    Attributes: ``key`` (which input), ``value`` (its value, as text), ``help`` (what is allowed).
    """

    def __init__(self, text, key, value, help):
        super().__init__(text)
        self.key, self.value, self.help = key, value, help


class SceneError(InputError):
    """A scene that holds something that cannot be used.

    Attributes: ``key`` as in ``body.material.young`` (empty: no single key), ``help`` (what is wrong, what is allowed),
    ``path`` and ``line`` (from 1) of the file, or None if the scene comes from none; the path ``--set`` stands for values
    that replace those of a scene.
    """

    def __init__(self, text, key, help, path, line):
        super().__init__(text, key, None, help)
        self.path, self.line = path, line


class IntegrationError(Error, RuntimeError):
    """The integrator gave up.

    Attributes: ``motion`` (what was computed until then), ``phase``, ``method``, ``time`` (s), ``step`` (s).
    """

    def __init__(self, text, motion, phase, method, time, step):
        super().__init__(text)
        self.motion = Motion(motion)
        self.phase, self.method, self.time, self.step = phase, method, time, step


class NoEquilibrium(Error, RuntimeError):
    """No equilibrium was found.

    Attributes: ``motion`` (the last equilibrium found for a part of the load), ``phase``, ``fraction`` (of the load).
    """

    def __init__(self, text, motion, phase, fraction):
        super().__init__(text)
        self.motion = Motion(motion)
        self.phase, self.fraction = phase, fraction


class FileError(Error, OSError):
    """A file that cannot be read or written."""

    def __init__(self, text, errno):
        super().__init__(text)
        self.errno = errno

    def __str__(self):
        return self.args[0]


class ModelWarning(UserWarning):
    """What makes a result doubtful, and what to change."""
