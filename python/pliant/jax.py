"""Scenes as functions of JAX, which it differentiates backward: :meth:`pliant.Scene.as_jax`."""

import jax
import numpy as np

from .jacobian import Quantities


def function(scene, of, by, *, static=False):
    """A function from an array of the numbers `by` to one of the quantities `of`; see :meth:`pliant.Scene.as_jax`."""
    quantities = Quantities(scene, of, by, static)
    shapes = (len(quantities.of),), (len(quantities.of), len(quantities.by))

    def both(numbers):
        """Values and derivatives, from outside of what JAX compiles."""
        types = tuple(jax.ShapeDtypeStruct(shape, numbers.dtype) for shape in shapes)
        found = jax.pure_callback(
            lambda x: tuple(np.asarray(array, dtype=x.dtype) for array in quantities(x)), types, numbers, vmap_method="sequential"
        )
        return found

    @jax.custom_vjp
    def run(numbers):
        return both(numbers)[0]

    run.defvjp(both, lambda slopes, cotangent: (cotangent @ slopes,))
    return run
