"""MuJoCo and Gymnasium-Robotics, as functions that take so many steps and return the seconds these took.

Run by measure.py inside the environment that it makes; nothing here is needed by a test.
"""

import os
import xml.etree.ElementTree as xml

import gymnasium
import gymnasium_robotics
import mujoco
import numpy

from timing import clock

# Drawn once: drawing is not what is measured.
ACTIONS = 4096
# The U of D4RL and of the thesis; cells of 4 m, walls as high as D4RL's.
U_MAZE = ["#####", "#   #", "### #", "#   #", "#####"]
CELL = 4.0
WALL_HEIGHT = 2.0


def ant(integrator, walls=False):
    """Raw `mj_step` of Gymnasium's ant with the physics of D4RL and the thesis, five steps of 0.02 s a control step."""
    path = os.path.join(os.path.dirname(gymnasium.__file__), "envs", "mujoco", "assets", "ant.xml")
    root = xml.parse(path).getroot()
    root.find("option").set("timestep", "0.02")
    root.find("option").set("integrator", integrator)
    for motor in root.find("actuator"):
        motor.set("gear", "1")
        motor.set("ctrlrange", "-30 30")
    geom = root.find("default").find("geom")
    geom.set("solref", ".02 1")
    geom.set("solimp", ".8 .8 .01")
    if walls:
        for row, line in enumerate(U_MAZE):
            for column, cell in enumerate(line):
                if cell == "#":
                    # The ant starts where the first free cell is.
                    place = [(column - 1) * CELL, (1 - row) * CELL, WALL_HEIGHT / 2]
                    half = [CELL / 2, CELL / 2, WALL_HEIGHT / 2]
                    box = dict(type="box", conaffinity="1", pos=text(place), size=text(half))
                    xml.SubElement(root.find("worldbody"), "geom", box)
    model = mujoco.MjModel.from_xml_string(xml.tostring(root, encoding="unicode"))
    data = mujoco.MjData(model)
    controls = numpy.random.default_rng(0).uniform(-30, 30, (ACTIONS, model.nu))
    counter = 0

    def run(steps):
        nonlocal counter
        began = clock()
        for _ in range(steps):
            counter += 1
            data.ctrl[:] = controls[counter % ACTIONS]
            mujoco.mj_step(model, data, nstep=5)
        return clock() - began

    return run


def text(numbers):
    return " ".join(f"{number:g}" for number in numbers)


def environment(name):
    """An environment of Gymnasium-Robotics through its API: step, and reset when an episode is over."""
    gymnasium.register_envs(gymnasium_robotics)
    env = gymnasium.make(name)
    low, high = env.action_space.low, env.action_space.high
    actions = numpy.random.default_rng(0).uniform(low, high, (ACTIONS, len(low))).astype(env.action_space.dtype)
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


# What there is to measure, by name.
PEERS = {
    "MuJoCo mj_step, RK4": lambda: ant("RK4"),
    "MuJoCo mj_step, Euler": lambda: ant("Euler"),
    "MuJoCo mj_step, implicitfast": lambda: ant("implicitfast"),
    "MuJoCo mj_step, RK4, U-maze walls": lambda: ant("RK4", walls=True),
    "Gymnasium-Robotics AntMaze_UMaze-v5": lambda: environment("AntMaze_UMaze-v5"),
    "Gymnasium-Robotics PointMaze_UMaze-v3": lambda: environment("PointMaze_UMaze-v3"),
}

# (ours, peer): names of benches/throughput and of PEERS.
PAIRS = [
    ("sim/ant/step, open floor", "MuJoCo mj_step, RK4"),
    ("sim/ant/step, open floor", "MuJoCo mj_step, Euler"),
    ("sim/ant/step, open floor", "MuJoCo mj_step, implicitfast"),
    ("sim/ant/step, u-maze", "MuJoCo mj_step, RK4, U-maze walls"),
    ("envs/ant-u-maze/step and observe", "Gymnasium-Robotics AntMaze_UMaze-v5"),
    ("envs/point-maze/step and observe", "Gymnasium-Robotics PointMaze_UMaze-v3"),
]
