"""Scenes as functions of PyTorch, which it differentiates: :meth:`pliant.Scene.as_torch`."""

import torch

from .jacobian import Quantities


def function(scene, of, by, *, static=False):
    """A function from a tensor of the numbers `by` to one of the quantities `of`; see :meth:`pliant.Scene.as_torch`."""
    quantities = Quantities(scene, of, by, static)

    class Run(torch.autograd.Function):
        @staticmethod
        def forward(ctx, numbers):
            values, slopes = (numbers.new_tensor(array) for array in quantities(numbers.detach().cpu().numpy()))
            ctx.save_for_backward(slopes)
            return values

        @staticmethod
        @torch.autograd.function.once_differentiable
        def backward(ctx, cotangent):
            (slopes,) = ctx.saved_tensors
            return cotangent @ slopes

    return Run.apply
