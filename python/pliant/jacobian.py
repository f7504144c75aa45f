"""Quantities of a scene as a function of some of its numbers, with its derivatives: what :mod:`pliant.torch` and :mod:`pliant.jax` wrap."""

import numpy as np


class Quantities:
    """The quantities `of` a scene by the numbers `by` of it: ``quantities(x)`` is their values and their derivatives, of shapes (len(of),) and
    (len(of), len(by)).
    """

    def __init__(self, scene, of, by, static=False):
        self.scene, self.static = scene, bool(static)
        self.of, self.by = ([names] if isinstance(names, str) else list(names) for names in (of, by))
        if not self.of or not self.by:
            raise ValueError("name a quantity at least, as of=['tip.y'], and a number, as by=['body.material.young']")

    def __call__(self, x):
        x = np.asarray(x, dtype=float)
        if x.shape != (len(self.by),):
            raise ValueError(f"the numbers have the shape {x.shape}, and ought to be {len(self.by)}: {', '.join(self.by)}")
        scene = self.scene.with_values(dict(zip(self.by, x.tolist())))
        gradients = [scene.gradient(of, by=self.by, static=self.static) for of in self.of]
        return np.array([one.value for one in gradients]), np.array([one.derivatives for one in gradients])
