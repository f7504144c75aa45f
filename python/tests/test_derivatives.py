"""Derivatives and optima of scenes: against closed forms, and through PyTorch and JAX where these are installed."""

import numpy as np
import pytest

import pliant

# a bar of one element, stretched by F L / (E A)
BAR = dict(
    body=dict(
        mesh=dict(kind="bar", length=0.1, nodes=2),
        area=1e-4,
        strain="cauchy",
        material=dict(density=1e3, young=1e5, poisson=0.0, viscosity=20.0),
    ),
    phase=dict(name="pull", until=0.01, hold=dict(nodes="left"), load=dict(nodes="right", force=[0.1])),
    sensor=dict(name="tip", kind="displacement", nodes="right"),
)
YOUNG, FORCE = "body.material.young", "phase.pull.load.force.1"
BY, AT = [YOUNG, FORCE], [2e5, 0.3]
# the stretch, and its derivatives by E and F
TIP = 0.3 * 0.1 / (2e5 * 1e-4)
SLOPES = np.array([-TIP / 2e5, TIP / 0.3])


def test_an_optimum():
    found = pliant.Scene(BAR).optimize("tip.x", {YOUNG: (1e3, 1e6)}, goals=5e-3, static=True)
    assert found.is_optimum and found.values[YOUNG] == pytest.approx(2e4, rel=1e-6)
    assert found.before == {"tip.x": pytest.approx(1e-3)} and found.after == {"tip.x": pytest.approx(5e-3)}
    assert found.bounds == {} and "before" in str(found)
    stiffest = pliant.Scene(BAR).optimize("tip.x", {YOUNG: (1e4, 1e6)}, static=True)
    assert stiffest.bounds == {YOUNG: "most"} and stiffest.values[YOUNG] == 1e6
    assert pliant.Scene(BAR).with_values(found.values).static().displacements[-1][-1][0] == pytest.approx(5e-3)


def test_bad_input_is_told():
    scene = pliant.Scene(BAR)
    for by, words in [({YOUNG: (1e6, 1e3)}, "first end"), ({YOUNG: (2e5, 1e6)}, "widen the range"), ({}, "name a number")]:
        with pytest.raises(pliant.Error, match=words):
            scene.optimize("tip.x", by, static=True)
    with pytest.raises(ValueError, match="`maximize` or `goals`"):
        scene.optimize("tip.x", {YOUNG: (1e3, 1e6)}, maximize=True, goals=1.0)


def test_pytorch():
    torch = pytest.importorskip("torch")
    tips = pliant.Scene(BAR).as_torch(["tip.x", "right.x"], BY, static=True)
    numbers = torch.tensor(AT, dtype=torch.float64, requires_grad=True)
    found = tips(numbers)
    assert found.shape == (2,) and float(found[0].detach()) == pytest.approx(TIP, rel=1e-9)
    (found[0] ** 2).backward()
    np.testing.assert_allclose(numbers.grad, 2 * TIP * SLOPES, rtol=1e-8)
    # numbers of one size, as differences of `gradcheck` are by one step
    scale = torch.tensor(AT, dtype=torch.float64)
    ones = torch.ones(2, dtype=torch.float64, requires_grad=True)
    assert torch.autograd.gradcheck(lambda x: tips(x * scale) / TIP, ones, eps=1e-4, atol=1e-6)
    with pytest.raises(ValueError, match="ought to be 2"):
        tips(torch.ones(3))


def test_jax():
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    tips = pliant.Scene(BAR).as_jax(["tip.x", "right.x"], BY, static=True)
    found, slopes = jax.value_and_grad(lambda x: tips(x)[0] ** 2)(np.array(AT))
    assert float(found) == pytest.approx(TIP**2, rel=1e-9)
    np.testing.assert_allclose(slopes, 2 * TIP * SLOPES, rtol=1e-8)
    np.testing.assert_allclose(jax.jit(jax.jacrev(tips))(np.array(AT))[0], SLOPES, rtol=1e-8)
