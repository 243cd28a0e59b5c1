#!/usr/bin/env python3
"""Measures this project side by side with what others use.

    python3 benches/peers/measure.py [bodies|worlds|learners] [--rounds 9] [--seconds 0.4] [--core 0] [--binary PATH]
                                     [--quick] [--out FILE]

Bodies: beside MuJoCo and Gymnasium-Robotics. Worlds: as pictures and as symbols, beside Farama's MiniGrid. Learners: beside
PyTorch and Stable-Baselines3, and returns after a short training.

Makes an environment of its own in a temporary directory (needs network once, or --environment to keep one), builds the
benchmark, and prints a Markdown table. Everything runs on one core: in every round, the peer is measured before
and after ours, and the ratio is ours over the mean of the two. Medians over rounds, [least-greatest]. Seconds are
of processor time, so that what else runs on the machine counts little; the ratio of the clock's time stands in `--out`.
Nothing here is needed by a test.
"""

import argparse
import importlib
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import venv

from timing import speed

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
# What the modules beside this one, which are called the same, need.
PACKAGES = {
    "bodies": ["mujoco==4.0.0", "gymnasium==1.4.0", "gymnasium-robotics==1.4.2"],
    "worlds": ["minigrid==3.2.0", "gymnasium==1.4.0"],
    "learners": ["torch==2.15.0", "stable-baselines3==2.9.2", "gymnasium[mujoco]==1.4.0", "mujoco==4.0.0"],
}
# Set where the environment is made already: what cannot be imported there is an error.
INSIDE = "INROADS_PEERS_INSIDE"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="?", choices=PACKAGES, default="bodies")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--seconds", type=float, default=0.4, help="length of one measurement")
    parser.add_argument("--core", type=int, default=0, help="the core that everything runs on")
    parser.add_argument("--environment", help="directory of the Python environment, made if it is not there")
    parser.add_argument("--binary", help="a built benchmark; without it, it is built")
    parser.add_argument("--peers-only", action="store_true", help="measure the others alone")
    parser.add_argument("--quick", action="store_true", help="one short round, to see that it works")
    parser.add_argument("--out", help="write what was found to this file, as JSON")
    options = parser.parse_args()
    if options.quick:
        options.rounds, options.seconds = 1, 0.1
    try:
        peers = importlib.import_module(options.what)
    except ImportError:
        if INSIDE in os.environ:
            raise
        return again_inside(options)

    binary = None if options.peers_only else options.binary or build()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {options.core})
    made = {name: make() for name, make in peers.PEERS.items()}
    print(f"{platform.processor() or platform.machine()} ({processor()}), load before: {load()}\n")
    if binary is None:
        alone(made, options)
    else:
        found = {"processor": processor(), "load_before": load(), "packages": PACKAGES[options.what]}
        found["pairs"] = table(peers.PAIRS, made, binary, options)
        # What else a module has to show.
        found |= peers.more(options) if hasattr(peers, "more") else {}
        if options.out:
            write(options, {**found, "load_after": load()})
    print(f"\nload after: {load()}; rounds: {options.rounds} of {options.seconds} s; {', '.join(PACKAGES[options.what])}")


def again_inside(options):
    """Makes the environment, and runs this script in it."""
    with tempfile.TemporaryDirectory(prefix="inroads-peers-") as directory:
        directory = options.environment or directory
        python = os.path.join(directory, "bin", "python")
        if not os.path.exists(python):
            venv.create(directory, with_pip=True)
        # Also into an environment that is kept: it may have been made for the other measurement.
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES[options.what]], check=True)
        result = subprocess.run([python, os.path.abspath(__file__), *sys.argv[1:]], env={**os.environ, INSIDE: "1"})
    sys.exit(result.returncode)


def build():
    """The benchmark's executable."""
    command = ["cargo", "bench", "--locked", "--bench", "throughput", "--no-run", "--message-format=json"]
    lines = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    for message in map(json.loads, lines):
        if message.get("executable") and message["target"]["name"] == "throughput":
            return message["executable"]
    sys.exit("cargo built no executable of the benchmark `throughput`")


def ours(binary, name, seconds):
    """Steps of one of our workloads in a second of processor time and of the clock's."""
    command = [binary, "--only", name, "--seconds", str(seconds)]
    # Torch has one thread, so ours has.
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, env=environment)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed")
    return tuple(map(float, done.stdout.split()))


def table(pairs, made, binary, options):
    """Prints a row a pair; what was found, by our names."""
    print("| ours | a second | ms | peer | a second | ms | ours / peer |\n|---|---|---|---|---|---|---|")
    found = []
    for name, peer in pairs:
        mine, theirs, ratios = [], [], []
        for _ in range(options.rounds):
            before = speed(made[peer], options.seconds)
            between = ours(binary, name, options.seconds)
            after = speed(made[peer], options.seconds)
            mine.append(between)
            theirs += [before, after]
            ratios.append([2 * our / (one + other) for our, one, other in zip(between, before, after)])
        (mine, mine_clock), (theirs, theirs_clock), (ratios, clock) = (zip(*numbers) for numbers in (mine, theirs, ratios))
        print(f"| {name} | {rate(mine)} | {peer} | {rate(theirs)} | {spread(ratios)} |", flush=True)
        middle = lambda numbers: short(statistics.median(numbers))
        found.append({
            "ours": name, "peer": peer, "a_second": middle(mine), "peer_a_second": middle(theirs),
            "ratio": [middle(ratios), short(min(ratios)), short(max(ratios))],
            "a_second_by_the_clock": middle(mine_clock), "peer_a_second_by_the_clock": middle(theirs_clock),
            "ratio_by_the_clock": [middle(clock), short(min(clock)), short(max(clock))],
        })  # fmt: skip
    return found


def short(number):
    """More digits than four say more than is known."""
    return float(f"{number:.4g}")


def alone(made, options):
    print("| peer | a second | ms |\n|---|---|---|")
    found = {name: [] for name in made}
    for _ in range(options.rounds):
        for name, run in made.items():
            found[name].append(speed(run, options.seconds)[0])
    for name, speeds in found.items():
        print(f"| {name} | {rate(speeds)} |")


def write(options, found):
    """As JSON, a line a part."""
    parts = []
    for key, part in found.items():
        lines = ",\n".join(f"    {json.dumps(line)}" for line in part) if isinstance(part, list) else json.dumps(part)
        parts.append(f"  {json.dumps(key)}: " + (f"[\n{lines}\n  ]" if isinstance(part, list) else lines))
    with open(options.out, "w") as file:
        file.write("{\n" + ",\n".join(parts) + "\n}\n")
    print(f"wrote {options.out}")


def rate(numbers):
    """How many a second, and how long each takes, in milliseconds."""
    number = statistics.median(numbers)
    return f"{number:.0f} | {1e3 / number:.3g}" if number >= 100 else f"{number:.3g} | {1e3 / number:.3g}"


def spread(ratios):
    return f"{statistics.median(ratios):.2f} [{min(ratios):.2f}-{max(ratios):.2f}]"


def processor():
    try:
        with open("/proc/cpuinfo") as file:
            return next(line.split(":")[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return "unnamed processor"


def load():
    return " ".join(f"{number:.1f}" for number in os.getloadavg()) if hasattr(os, "getloadavg") else "unknown"


if __name__ == "__main__":
    main()
