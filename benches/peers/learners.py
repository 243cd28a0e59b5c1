"""PyTorch and Stable-Baselines3, as functions that take so many updates and return the seconds these took: the networks,
batches and optimiser of our workloads, on one thread.

Each peer is written in the form that was the fastest here of those that are named beside it. Frames are bytes outside the
update and become numbers inside it, on both sides.

Run by measure.py inside the environment that it makes; nothing here is needed by a test.
"""

import copy
import json
import os
import subprocess
import tempfile
import time

# Before torch is imported, or it starts more threads.
os.environ["OMP_NUM_THREADS"] = "1"

import gymnasium
import numpy
import torch
from stable_baselines3 import TD3
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.noise import NormalActionNoise
from torch import nn
from torch.nn.functional import huber_loss, mse_loss

from timing import clock

torch.set_num_threads(1)
torch.manual_seed(0)
random = numpy.random.default_rng(0)

RATE = 1e-4
DISCOUNT = 0.99
# Steps before TD3's first update.
WARM_UP = 256
# Steps of the short training.
STEPS = 8000
# Our command.
INROADS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "target", "release", "inroads")


def adam(*modules):
    """Fused: one pass over each parameter, as ours; the default takes 1.05 to 1.25 times as long."""
    return torch.optim.Adam([p for m in modules for p in m.parameters()], lr=RATE, fused=True)


def repeated(update):
    """`update` as what measure.py times."""

    def run(times):
        began = clock()
        for _ in range(times):
            update()
        return clock() - began

    return run


def layers(*widths):
    """Linear layers with rectified units between them, none behind the last."""
    stack = []
    for before, after in zip(widths, widths[1:]):
        stack += [nn.Linear(before, after), nn.ReLU()]
    return nn.Sequential(*stack[:-1])


def rows(n, width):
    return torch.from_numpy(random.uniform(-1, 1, (n, width)).astype(numpy.float32))


# Encoders of frames.


class Patches(nn.Module):
    """Our default: patches embedded, and two by two places merged, twice. As products of rows (NHWC), which are faster here
    than convolutions whose stride is their size."""

    def __init__(self, pixels, channels, side, embedding=32, merges=(64, 64), hidden=128):
        super().__init__()
        self.side, self.places, self.channels = side, pixels // side, channels
        self.embed = nn.Linear(side * side * channels, embedding)
        places, width, merge = self.places, embedding, []
        for features in merges:
            merge.append(nn.Linear(4 * width, features))
            places, width = (places + 1) // 2, features
        self.merge = nn.ModuleList(merge)
        self.top = nn.Linear(places * places * width, hidden)

    def forward(self, frames):
        n, p, s = len(frames), self.places, self.side
        x = frames.view(n, p, s, p, s * self.channels).transpose(2, 3).reshape(n * p * p, -1).float() * (1 / 255)
        x = torch.relu(self.embed(x))
        for layer in self.merge:
            width = x.shape[1]
            if p % 2 == 1:
                x = nn.functional.pad(x.view(n, p, p, width), (0, 0, 0, 1, 0, 1))
            p = (p + 1) // 2
            x = x.view(n * p, 2, p, 2 * width).transpose(1, 2).reshape(n * p * p, 4 * width)
            x = torch.relu(layer(x))
        return torch.relu(self.top(x.view(n, -1)))


class Nature(nn.Module):
    """Mnih 2015, as everybody writes it."""

    def __init__(self, pixels, channels, hidden=512, last=torch.contiguous_format):
        super().__init__()
        self.last = last
        self.convolution = nn.Sequential(
            nn.Conv2d(channels, 32, 8, 4), nn.ReLU(),
            nn.Conv2d(32, 64, 4, 2), nn.ReLU(),
            nn.Conv2d(64, 64, 3, 1), nn.ReLU(), nn.Flatten(),
        )  # fmt: skip
        with torch.no_grad():
            width = self.convolution(torch.zeros(1, channels, pixels, pixels)).shape[1]
        self.top = nn.Linear(width, hidden)

    def forward(self, frames):
        x = frames.permute(0, 3, 1, 2).to(torch.float32, memory_format=self.last) * (1 / 255)
        return torch.relu(self.top(self.convolution(x)))


class Dueling(nn.Module):
    """Q = V + A - mean A."""

    def __init__(self, features, hidden, choices):
        super().__init__()
        self.hidden, self.value, self.advantage = (
            nn.Linear(features, hidden), nn.Linear(hidden, 1), nn.Linear(hidden, choices)
        )  # fmt: skip

    def forward(self, features):
        x = torch.relu(self.hidden(features))
        advantage = self.advantage(x)
        return self.value(x) + advantage - advantage.mean(-1, keepdim=True)


def bytes_of_frames(n, pixels, channels):
    return torch.from_numpy(random.integers(0, 256, (n, pixels, pixels, channels), dtype=numpy.uint8))


def q_learning(online, seen, choices=5):
    """One update of deep Q-learning: the target network's values of what came next, and the train step."""
    batch = len(seen)
    target, optimizer = copy.deepcopy(online), adam(online)
    following = seen.flip(0)
    choice, reward = torch.from_numpy(random.integers(0, choices, (batch, 1))), rows(batch, 1)

    def update():
        with torch.no_grad():
            wanted = reward + DISCOUNT * target(following).max(1, keepdim=True).values
        loss = huber_loss(online(seen).gather(1, choice), wanted)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()

    return repeated(update)


def dqn(torso, frames, features):
    """From frames, with a dueling head."""
    return q_learning(nn.Sequential(torso, Dueling(features, 128, 5)), frames)


def values_of_vectors():
    """From 256 vectors of 35 numbers, by two layers of 256."""
    return q_learning(layers(35, 256, 256, 5), rows(256, 35))


# R2D2.


class Recurrent(nn.Module):
    """Frames through a torso, its features and the previous choice through an LSTM, and a dueling head."""

    def __init__(self, torso, features, memory, choices):
        super().__init__()
        self.torso, self.lstm = torso, nn.LSTM(features + choices, memory)
        self.head = Dueling(memory, 128, choices)

    def forward(self, frames, previous, state):
        """Frames of all steps of all sequences, step by step."""
        steps, n = previous.shape[:2]
        features = self.torso(frames).view(steps, n, -1)
        return self.head(self.lstm(torch.cat([features, previous], 2), state)[0])


def r2d2(batch=32, steps=40, memory=128, choices=7, returns=5, clip=40.0):
    """One update of R2D2: double Q-learning with returns of 5 steps on all steps of 32 sequences, whose last value is a
    frame more."""
    online = Recurrent(Patches(64, 3, 8), 128, memory, choices)
    target, optimizer = copy.deepcopy(online), adam(online)
    frames = bytes_of_frames((steps + 1) * batch, 64, 3)
    choice = torch.from_numpy(random.integers(0, choices, (steps, batch)))
    previous = torch.zeros(steps + 1, batch, choices)
    previous[1:].scatter_(2, choice.unsqueeze(2), 1.0)
    state = (torch.zeros(1, batch, memory), torch.zeros(1, batch, memory))
    reward = torch.zeros(steps, batch)
    # Where each step's return bootstraps, and what that counts.
    last = torch.clamp(torch.arange(steps) + returns, max=steps)
    discount = (0.997 ** (last - torch.arange(steps))).unsqueeze(1)

    def update():
        values = online(frames, previous, state)
        with torch.no_grad():
            best = values[last].argmax(2, keepdim=True)
            next_values = target(frames, previous, state)[last].gather(2, best).squeeze(2)
            wanted = sum(0.997**i * reward.roll(-i, 0) for i in range(returns)) + discount * next_values
        chosen = values[:-1].gather(2, choice.unsqueeze(2)).squeeze(2)
        loss = (0.5 * (chosen - wanted) ** 2).mean()
        optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(online.parameters(), clip)
        optimizer.step()

    return repeated(update)


def acting(lanes=16, memory=128, choices=7):
    """A step of 16 environments at once."""
    net = Recurrent(Patches(64, 3, 8), 128, memory, choices)
    frames, previous = bytes_of_frames(lanes, 64, 3), torch.zeros(1, lanes, choices)
    state = (torch.zeros(1, lanes, memory), torch.zeros(1, lanes, memory))

    def act():
        with torch.inference_mode():
            net(frames, previous, state).argmax(2)

    return repeated(act)


# TD3.


def td3(inputs=31, actions=8, batch=256, tau=0.005, noise=0.2, most=0.5, delay=2):
    """One update of TD3 as Stable-Baselines3 writes it, without its replay."""
    actor = nn.Sequential(layers(inputs, 256, 256, actions), nn.Tanh())
    critics = nn.ModuleList([layers(inputs + actions, 256, 256, 1) for _ in range(2)])
    slow_actor, slow_critics = copy.deepcopy(actor), copy.deepcopy(critics)
    of_actor, of_critics = adam(actor), adam(critics)
    data = [rows(batch, width) for width in (inputs, actions, 1, inputs)]
    pairs = [*zip(actor.parameters(), slow_actor.parameters()), *zip(critics.parameters(), slow_critics.parameters())]
    done = 0

    def update():
        nonlocal done
        done += 1
        states, acted, rewards, after = data
        with torch.no_grad():
            drawn = acted.clone().normal_(0, noise).clamp_(-most, most)
            pair = torch.cat([after, (slow_actor(after) + drawn).clamp_(-1, 1)], 1)
            wanted = rewards + DISCOUNT * torch.min(*(critic(pair) for critic in slow_critics))
        pair = torch.cat([states, acted], 1)
        loss = sum(mse_loss(critic(pair), wanted) for critic in critics)
        of_critics.zero_grad()
        loss.backward()
        of_critics.step()
        if done % delay == 0:
            loss = -critics[0](torch.cat([states, actor(states)], 1)).mean()
            of_actor.zero_grad()
            loss.backward()
            of_actor.step()
            with torch.no_grad():
                slow, online = [pair[1] for pair in pairs], [pair[0] for pair in pairs]
                torch._foreach_lerp_(slow, online, tau)

    return repeated(update)


# Stable-Baselines3.


def ant():
    """Gymnasium's ant as ours observes it: 27 numbers. Ant-v5's default has 78 more, of contact forces, which would make the
    peer's networks larger."""
    return gymnasium.make("Ant-v5", include_cfrc_ext_in_observation=False)


def stable_baselines(seed=0):
    """Its TD3 with our settings: one update a step of the environment, 256-256, batch 256."""
    env = Monitor(ant())
    noise = NormalActionNoise(numpy.zeros(8), 0.1 * numpy.ones(8))
    return TD3(
        "MlpPolicy", env, learning_rate=3e-4, buffer_size=100_000, learning_starts=WARM_UP, batch_size=256, train_freq=1,
        gradient_steps=1, action_noise=noise, policy_kwargs={"net_arch": [256, 256]}, seed=seed, device="cpu",
    )  # fmt: skip


def training():
    """Steps of it."""
    model = stable_baselines()
    model.learn(WARM_UP + 50)

    def run(steps):
        began = clock()
        model.learn(steps, reset_num_timesteps=False)
        return clock() - began

    return run


def of_ours(seed, steps, folder):
    """Trains ours; returns of its episodes, and steps in a second of the clock's."""
    out = os.path.join(folder, f"{seed}")
    sets = [f"max_steps={steps}", "episodes=1000000", "checkpoint_every=1000000", "evaluation_episodes=1"]
    sets += [f"memory.warm_up={WARM_UP}", "memory.updates_per_step=1.0"]
    command = [INROADS, "train", "td3", "ant", "--seed", str(seed), "--out", out]
    command += [word for one in sets for word in ("--set", one)]
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    lines = [[json.loads(line) for line in open(os.path.join(out, f"{name}.jsonl"))] for name in ("metrics", "timings")]
    seconds = sum(line["seconds"] for line in lines[1])
    return [(line["env_steps"], line["return"]) for line in lines[0]], lines[0][-1]["env_steps"] / seconds


def of_theirs(seed, steps):
    """The same of the peer."""
    model, began = stable_baselines(seed), time.perf_counter()
    model.learn(steps)
    seconds = time.perf_counter() - began
    returns, lengths = model.env.envs[0].get_episode_rewards(), model.env.envs[0].get_episode_lengths()
    return list(zip(numpy.cumsum(lengths).tolist(), returns)), steps / seconds


def more(options):
    """A short training of either on its own ant: returns of the episodes of the second half, noise included."""
    if not os.path.exists(INROADS):
        print(f"\nno returns: there is no {INROADS}; build it with `cargo build --release --workspace`")
        return {}
    steps = 600 if options.quick else STEPS
    found = []
    print(f"\nTD3 on the ant, {steps} steps, one update each\n")
    print("| who | steps/s of the clock | episodes of the second half | mean return |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="inroads-peers-") as folder:
        for who, train in [("ours", lambda: of_ours(0, steps, folder)), ("Stable-Baselines3", lambda: of_theirs(0, steps))]:
            episodes, rate = train()
            late = [value for at, value in episodes if at > steps / 2]
            mean = sum(late) / len(late) if late else None
            print(f"| {who} | {rate:.0f} | {len(late)} | {mean if mean is None else round(mean, 1)} |", flush=True)
            found.append({
                "who": who, "steps": steps, "a_second_by_the_clock": round(rate, 1), "episodes": len(late),
                "return": mean and round(mean, 1),
            })  # fmt: skip
    return {"trainings": found}


# What there is to measure, by name.
PEERS = {
    "Stable-Baselines3 TD3, Ant-v5": training,
    "PyTorch, TD3 update": td3,
    "PyTorch, two layers of 256": values_of_vectors,
    "PyTorch, patches, 84x84x1": lambda: dqn(Patches(84, 1, 7), bytes_of_frames(32, 84, 1), 128),
    "PyTorch, patches, 64x64x3": lambda: dqn(Patches(64, 3, 8), bytes_of_frames(32, 64, 3), 128),
    "PyTorch, Conv2d of Nature, 84x84x1": lambda: dqn(Nature(84, 1), bytes_of_frames(32, 84, 1), 512),
    "PyTorch, Conv2d of Nature, 64x64x3": lambda: dqn(Nature(64, 3), bytes_of_frames(32, 64, 3), 512),
    "PyTorch, R2D2 update": r2d2,
    "PyTorch, R2D2 acting in 16": acting,
}

# (ours, peer): names of benches/throughput and of PEERS.
PAIRS = [
    ("agents/td3/step and update, ant", "Stable-Baselines3 TD3, Ant-v5"),
    ("agents/td3/update", "PyTorch, TD3 update"),
    ("mlp/train, 256-256 on 256 vectors", "PyTorch, two layers of 256"),
    ("encoder/patches/train, 84x84 grey", "PyTorch, patches, 84x84x1"),
    ("encoder/patches/train, 64x64 colour", "PyTorch, patches, 64x64x3"),
    ("encoder/nature/train, 84x84 grey", "PyTorch, Conv2d of Nature, 84x84x1"),
    ("encoder/nature/train, 64x64 colour", "PyTorch, Conv2d of Nature, 64x64x3"),
    ("agents/r2d2/update", "PyTorch, R2D2 update"),
    ("agents/r2d2/act-16", "PyTorch, R2D2 acting in 16"),
]
