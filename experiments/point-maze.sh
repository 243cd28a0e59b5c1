#!/usr/bin/env bash
# The evidence of docs/results/point-maze.md: about 20 minutes on two cores. Finished runs are kept; an interrupted
# one is taken up where its last checkpoint left it.
#
#   experiments/point-maze.sh [OUT]        runs go to OUT (default: runs/point-maze)
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-runs/point-maze}
cargo build --release
inroads=target/release/inroads
mkdir -p "$out"

# train RUN AGENT SEED [--set KEY=VALUE]...: does nothing when the run is complete.
train() {
    local run=$out/$1 agent=$2 seed=$3
    shift 3
    if [ -f "$run/summary.json" ]; then
        return
    elif compgen -G "$run/checkpoints/*.ckpt" >/dev/null; then
        "$inroads" train "$agent" point-maze --out "$run" --resume
    else
        rm -rf "$run"
        "$inroads" train "$agent" point-maze --seed "$seed" --out "$run" "$@"
    fi
}

# each FUNCTION SEED...: two seeds at a time, one thread each.
each() {
    local f=$1
    shift
    printf '%s\n' "$@" | xargs -P 2 -I{} bash -c "set -euo pipefail; $f {}"
}
export out inroads
export -f train

# 1. Learning: 10 seeds of 300 episodes.
learn() { train "dsc-$1" dsc "$1"; }
export -f learn
each learn 0 1 2 3 4 5 6 7 8 9

# 2. Against the flat agent: both with twice the median steps of the above.
steps() { grep -h '"env_steps"' "$out"/dsc-?/summary.json | tr -dc '0-9\n' | sort -n; }
export twice=$(steps | awk '{a[NR] = $1} END {print a[5] + a[6]}')
longer() {
    train "ddpg-$1" ddpg "$1" --set episodes=100000 --set max_steps="$twice" --set checkpoint_every=500
    train "long-$1" dsc "$1" --set episodes=100000 --set max_steps="$twice" --set checkpoint_every=500
}
export -f longer
each longer 0 1 2 3 4

# 3. What the page shows.
mkdir -p docs/results
"$inroads" plot "$out"/long-? "$out"/ddpg-? --out docs/results/point-maze-curves.png
for run in "$out"/dsc-? "$out"/long-? "$out"/ddpg-?; do
    tr -d '\n' <"$run/summary.json" | sed 's/  */ /g'
    echo
done >docs/results/point-maze.jsonl
