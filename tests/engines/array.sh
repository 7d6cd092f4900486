#!/bin/bash
#SBATCH --array=0-15
#SBATCH --cpus-per-task=4
#SBATCH --requeue
ist sweep job.toml -o out --share "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --threads "$SLURM_CPUS_PER_TASK"
