"""Farama's MiniGrid, as functions that take so many steps and return the seconds these took.

Run by measure.py inside the environment that it makes; nothing here is needed by a test.
"""

import gymnasium
import minigrid  # noqa: F401 (registers its environments)
import numpy
from minigrid.wrappers import FullyObsWrapper, RGBImgObsWrapper

from timing import clock

# Drawn once: drawing is not what is measured.
ACTIONS = 4096

# (ours, peer): names of benches/throughput and of PEERS. Ours makes pictures of 84 × 84 in grey and reads all of each; the
# peer's stay as large as it draws them (8 pixels a cell, in colour) and are not read.
PAIRS = [
    (f"worlds/{ours}, 84x84 {way}", f"{peer}, RGBImgObsWrapper")
    for ours, peer in [
        ("door-key-8x8", "MiniGrid-DoorKey-8x8-v0"),
        ("key-corridor-s3r3", "MiniGrid-KeyCorridorS3R3-v0"),
        ("key-corridor-s4r3", "MiniGrid-KeyCorridorS4R3-v0"),
    ]
    for way in ["grey", "luma"]
] + [
    ("worlds/door-key-8x8, symbols", "MiniGrid-DoorKey-8x8-v0"),
    ("worlds/door-key-8x8, symbols", "MiniGrid-DoorKey-8x8-v0, FullyObsWrapper"),
]


def environment(name, wrapper=None):
    """Step, and reset when an episode is over. Cells in view are highlighted, which is the peer's default. Of the
    choices, half are turns, and half are any, as in benches/throughput/worlds.rs."""
    env = gymnasium.make(name)
    if wrapper is not None:
        env = wrapper(env)
    random = numpy.random.default_rng(0)
    turns = random.random(ACTIONS) < 0.5
    actions = numpy.where(turns, random.integers(0, 2, ACTIONS), random.integers(0, env.action_space.n, ACTIONS)).tolist()
    env.reset(seed=0)
    counter = 0

    def run(steps):
        nonlocal counter
        began = clock()
        for _ in range(steps):
            counter += 1
            _, _, terminated, truncated, _ = env.step(actions[counter % ACTIONS])
            if terminated or truncated:
                env.reset()
        return clock() - began

    return run


def makers():
    names = ["MiniGrid-DoorKey-8x8-v0", "MiniGrid-KeyCorridorS3R3-v0", "MiniGrid-KeyCorridorS4R3-v0"]
    made = {f"{name}, RGBImgObsWrapper": lambda name=name: environment(name, RGBImgObsWrapper) for name in names}
    made[names[0]] = lambda: environment(names[0])
    made[f"{names[0]}, FullyObsWrapper"] = lambda: environment(names[0], FullyObsWrapper)
    return made


# What there is to measure, by name.
PEERS = makers()
