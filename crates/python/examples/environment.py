"""A Gymnasium environment: a brake on the isolator under a stack of barrels, set every 20 ms.

Needs ``pip install gymnasium`` besides barrelstack. Trains a policy of five numbers by random search, for 60 s or for the
seconds given as an argument.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from barrelstack import Scenario

Array = NDArray[np.float64]
STACK = {
    "stack": {"levels": 3, "columns": 2, "isolator": {"path": "dish", "friction": 0.01}},
    "motion": {"bundled": "napa-college-2014", "scale": {"pgv": "90 cm/s"}},
    "run": {"until": "duration", "duration": "15 s"},
}


class BrakedIsolator(gym.Env[Array, Array]):
    """Keeps a stack on its isolator: neither against the stops nor shaken as on the ground."""

    #: Largest force of the brake (N), and time (s) between two settings.
    MOST, EVERY = 3e3, 0.02

    def __init__(self, variants: int = 8) -> None:
        self.starts = [Scenario(STACK).simulation(variant=number) for number in range(1, variants + 1)]
        self.simulation = self.starts[0].copy()
        self.platform = next(name for name in self.simulation.bodies if "platform" in name)
        # Displacement (m) and velocity (m/s) of the platform and of the top barrel, relative to the ground.
        self.observation_space = gym.spaces.Box(-np.inf, np.inf, (4,), np.float64)
        self.action_space = gym.spaces.Box(0.0, 1.0, (1,), np.float64)

    def observe(self) -> Array:
        state = self.simulation.state
        moved = [state.pose(self.platform)[0], state.twist(self.platform)[0], state.pose("B3.1")[0], state.twist("B3.1")[0]]
        ground = [state.pose("ground")[0], state.twist("ground")[0]]
        return np.asarray(np.array(moved) - np.array(2 * ground) - self.rest)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Array, dict[str, Any]]:
        super().reset(seed=seed)
        self.simulation = self.starts[int(self.np_random.integers(len(self.starts)))].copy()
        self.rest = np.zeros(4)
        self.rest = self.observe()
        return self.observe(), {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        before = self.observe()
        self.simulation.apply_force(self.platform, (-float(action[0]) * self.MOST * np.tanh(before[1] / 0.02), 0.0))
        self.simulation.step_until(self.simulation.time + self.EVERY)
        observed = self.observe()
        sway = observed[2] - observed[0]
        lost = self.simulation.collapse is not None
        reward = -(observed[0] ** 2) - 25.0 * sway**2 - 100.0 * lost
        return observed, float(reward), lost, self.simulation.ending is not None, {}


def total(env: BrakedIsolator, weights: Array, seed: int) -> float:
    """Returns the sum of the rewards of an episode under the policy 1 / (1 + exp(-weights · (1, |observation|)))."""
    observed, _ = env.reset(seed=seed)
    rewards, over = 0.0, False
    while not over:
        action = 1.0 / (1.0 + np.exp(-weights @ np.concatenate([[1.0], np.abs(observed)])))
        observed, reward, lost, ended, _ = env.step(np.array([action]))
        rewards, over = rewards + reward, lost or ended
    return rewards


def main(seconds: float) -> None:
    env, random = BrakedIsolator(), np.random.default_rng(1)
    free, held = (total(env, np.array([bias, 0.0, 0.0, 0.0, 0.0]), 0) for bias in (-50.0, 50.0))
    best, most, tried, end = np.zeros(5), total(env, np.zeros(5), 0), 1, time.monotonic() + seconds
    while time.monotonic() < end:
        weights = best + random.normal(0.0, 3.0, 5)
        found, tried = total(env, weights, 0), tried + 1
        if found > most:
            best, most = weights, found
    print(f"reward without a brake {free:.2f}, always braked {held:.2f}, best of {tried} policies {most:.2f}")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0)
