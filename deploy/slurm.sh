#!/usr/bin/env bash
# A figure's runs as a Slurm job array, a shard a task; then one job that draws.
#
#   FIGURE=4.6 sbatch --array=0-7 deploy/slurm.sh
#   FIGURE=4.6 sbatch --dependency=afterok:JOB deploy/slurm.sh     # no array: draws what is done
#
# Submit it from the repository's folder (experiments/ and runs/ are looked for there), which all nodes must see. What is
# done is kept, so the same lines again go on with what is left. A minute before its time is out a task is told to stop,
# writes its checkpoint, and is queued again.
#SBATCH --job-name=inroads
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --mem=4G
#SBATCH --time=04:00:00
#SBATCH --signal=INT@60
#SBATCH --requeue
#SBATCH --output=runs/slurm-%x-%A-%a.log
set -euo pipefail

figure=${FIGURE:?set it to the figure, such as 4.6}
inroads=${INROADS:-target/release/inroads}
export RAYON_NUM_THREADS=1

if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    # Tasks are numbered from the array's first index, which need not be 0.
    shard=$((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN))/$SLURM_ARRAY_TASK_COUNT
    log=$(srun "$inroads" reproduce "$figure" --shard "$shard" 2>&1 | tee /dev/stderr | tail -n 1)
    case $log in
        "stopped and saved"*) scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID" ;;
    esac
else
    srun "$inroads" reproduce "$figure" --draw
fi
