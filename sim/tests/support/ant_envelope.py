"""Writes ant_envelope.json: what MuJoCo itself does with the ant's open-loop programs when its time step, integrator
or friction cone differs. No test needs this script.

    pip install mujoco==4.0.0 gymnasium numpy
    python sim/tests/support/ant_envelope.py tests/fixtures/ant > sim/tests/support/ant_envelope.json
"""

import json
import os
import re
import sys

import gymnasium
import mujoco
import numpy as np

XML = open(os.path.join(os.path.dirname(gymnasium.__file__), "envs/mujoco/assets/ant.xml")).read()
STARTS = 12
# File, seconds a control step, torque of action 1, coarse and fine time steps.
SETTINGS = {
    "thesis": ("ant_d4rl_settings.json", 0.1, 30, 0.02, 0.004, 0.002),
    "gymnasium": ("ant.json", 0.05, 150, 0.01, 0.002, 0.002),
}


def ant(settings, step, integrator, cone):
    xml = re.sub('integrator="RK4"', f'integrator="{integrator}" cone="{cone}"', XML)
    xml = re.sub('timestep="[^"]*"', f'timestep="{step}"', xml)
    model = mujoco.MjModel.from_xml_string(xml)
    model.actuator_gear[:, 0] = SETTINGS[settings][2]
    if settings == "thesis":  # D4RL's contacts are softer; its joint limits are not.
        model.geom_solref[:] = [0.02, 1]
        model.geom_solimp[:, :3] = [0.8, 0.8, 0.01]
    return model


def run(model, program, seed):
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    data.qpos[:] += rng.uniform(-1, 1, model.nq) * program["init_noise"]
    data.qvel[:] = rng.standard_normal(model.nv) * program["init_noise"]
    dt = program["control_dt"]
    at, heights = [data.qpos[:2].copy()], []
    for i in range(round(program["seconds"] / dt)):
        angle = 2 * np.pi * program["freq_hz"] * dt * i + np.array(program["phase"])
        wave = np.array(program.get("bias", 0.0)) + np.array(program["amp"]) * np.sin(angle)
        data.ctrl[:] = np.clip(wave, -1, 1)
        mujoco.mj_step(model, data, nstep=round(dt / model.opt.timestep))
        at.append(data.qpos[:2].copy())
        heights.append(data.qpos[2])
    moved = at[-1] - at[0]
    path = np.linalg.norm(np.diff(at, axis=0), axis=1).sum()
    return [np.linalg.norm(moved), path, min(heights), max(heights), *moved]


def band(values):
    return {"min": round(min(values), 4), "mean": round(float(np.mean(values)), 4), "max": round(max(values), 4)}


def variant(settings, name, step, integrator, cone, programs):
    model = ant(settings, step, integrator, cone)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, nstep=round(2 / step))
    rows = []
    for program in programs:
        runs = np.array([run(model, program, 1000 + seed) for seed in range(STARTS)])
        columns = ["net_displacement_m", "path_length_m", "min_torso_z", "max_torso_z"]
        row = {key: band(runs[:, i].tolist()) for i, key in enumerate(columns)}
        rows.append(row | {"mean_displacement_m": runs[:, 4:].mean(axis=0).round(4).tolist()})
    ankles = np.abs(data.qpos[[8, 10, 12, 14]])
    return {"variant": name, "settled_z": round(data.qpos[2], 4), "settled_ankle": round(ankles.mean(), 4), "programs": rows}


def main(folder):
    out = {"source": f"MuJoCo {mujoco.__version__}, {STARTS} noisy starts; sim/tests/support/ant_envelope.py"}
    for settings, (file, _, _, coarse, fine, finest) in SETTINGS.items():
        programs = json.load(open(os.path.join(folder, file)))["open_loop_programs"]
        out[settings] = {
            "programs": [{key: program[key] for key in ("freq_hz", "amp", "phase")} for program in programs],
            "variants": [
                variant(settings, f"{name} {step * 1000:g} ms{', elliptic cone' if cone == 'elliptic' else ''}", step, name, cone, programs)
                for name, step, cone in [
                    ("RK4", coarse, "pyramidal"),
                    ("RK4", coarse, "elliptic"),
                    ("RK4", fine, "pyramidal"),
                    ("Euler", coarse, "pyramidal"),
                    ("Euler", finest, "pyramidal"),
                ]
            ],
        }
    print(json.dumps(out, indent=1))


main(sys.argv[1])
