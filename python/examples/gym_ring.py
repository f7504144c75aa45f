"""The ring of eight springs as an environment of gymnasium, and a random search that makes it roll.

Run it beside `scenes/`: `python gym_ring.py`. What to look for: gymnasium's own check finds nothing, and the best policy
moves the ring farther in 3 s than the first one; episodes run on all cores, as forks of one simulation that has settled.
"""

import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import gymnasium
import numpy as np

import pliant

SCENE = Path(__file__).parents[2] / "scenes/ring-springs.toml"
#: Opposite springs, which pull together.
PAIRS = [("A1", "A5"), ("A2", "A6"), ("A3", "A7"), ("A4", "A8")]
#: Nodes at the outer ends of the springs.
FEET = [1, 13, 25, 37, 49, 61, 73, 85]
SETTLED, PERIOD, DECISIONS = 0.2, 0.25, 12


class Ring(gymnasium.Env):
    """Each action is the pull (N) of four pairs of springs for a quarter of a second; the reward is the way to the right (cm)."""

    metadata = {"render_modes": []}
    action_space = gymnasium.spaces.Box(0.0, 1.0, (len(PAIRS),), np.float64)
    observation_space = gymnasium.spaces.Box(-20.0, 20.0, (4 * len(FEET),), np.float64)

    def __init__(self):
        scene = pliant.Scene.from_toml(SCENE).with_values({"phase": [{"until": SETTLED + DECISIONS * PERIOD}]})
        self.rest = scene.start(rtol=1e-4)
        self.rest.advance_to(SETTLED)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.ring = self.rest.fork()
        self.decisions = 0
        return self._seen(), {}

    def step(self, action):
        before = self.ring.centre_of_mass()[0]
        for pair, pull in zip(PAIRS, np.clip(action, 0.0, 1.0)):
            for spring in pair:
                self.ring.actuate(spring, -float(pull))
        self.decisions += 1
        self.ring.advance_to(min(SETTLED + self.decisions * PERIOD, self.ring.end))
        way = 100.0 * (self.ring.centre_of_mass()[0] - before)
        return self._seen(), way, False, self.decisions == DECISIONS, {}

    def _seen(self):
        """Where the feet are about the centre (in 5 cm), and how fast (in m/s)."""
        ring, feet = self.ring, np.array(FEET) - 1
        places = (ring.positions[feet] - ring.centre_of_mass()) / 0.05
        return np.concatenate([places.ravel(), ring.velocities[feet].ravel()])


def episode(environment, weights):
    """The way (cm) under a linear policy."""
    seen, _ = environment.reset()
    total, over = 0.0, False
    while not over:
        seen, way, _, over, _ = environment.step(1.0 / (1.0 + np.exp(-weights @ np.append(seen, 1.0))))
        total += way
    return total


def search(rounds=4, candidates=8, seed=1):
    """A plain random search: the best of some changes of the best policy so far."""
    random = np.random.default_rng(seed)
    environments = [Ring() for _ in range(candidates)]
    shape = (len(PAIRS), 4 * len(FEET) + 1)
    best, way, ways = np.zeros(shape), -np.inf, []
    with ThreadPoolExecutor() as pool:
        for _ in range(rounds):
            trials = [best] + [best + random.normal(0.0, 2.0, shape) for _ in range(candidates - 1)]
            found = list(pool.map(episode, environments, trials))
            best, way = trials[int(np.argmax(found))], max(found)
            ways.append(way)
            print(f"{way:.2f} cm")
    return ways


if __name__ == "__main__":
    warnings.simplefilter("ignore", pliant.ModelWarning)
    from gymnasium.utils.env_checker import check_env

    check_env(Ring(), skip_render_check=True)
    ways = search(*map(int, sys.argv[1:]))
    assert ways[-1] > ways[0], "the search has found nothing better"
