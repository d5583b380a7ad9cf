#!/usr/bin/env bash
# Runs my_file as an array of my_shards tasks of Slurm, and puts their trials together when all have ended:
#
#     bash my_name.slurm.sh
#
# Each task runs its part of the trials; all of them keep finished trials in one folder, which every node must see. A task that is killed or
# requeued goes on where it stopped. Where trials are missing at the end, the log of the last job names them, and the part of the array that
# would run them: `bash my_name.slurm.sh 2,4` runs tasks 2 and 4 again. How far all are: `desim status results/my_name`.
set -euo pipefail

desim=${DESIM:-desim}       # the command, as every node finds it
out=${OUT:-results/my_name} # the folder for trials and results
array=${1:-1-my_shards}     # the tasks to run
mkdir -p "$out"

# What your cluster wants to know: add --partition, --account, --mem and so on. Trials run side by side on the processors of a task.
tasks=$(
    sbatch --parsable --job-name=my_name --array="$array" --cpus-per-task=1 --time=1-00:00 --requeue --open-mode=append \
        --output="my_name-%a.log" <<EOF
#!/bin/sh
exec "$desim" my_command "my_file" --shard auto/my_shards --out "$out" --quiet
EOF
)
merge=$(
    sbatch --parsable --job-name=my_name-merge --dependency=afterany:"$tasks" --time=1:00:00 --output=my_name-merge.log <<EOF
#!/bin/sh
exec "$desim" merge "$out"
EOF
)
echo "tasks $tasks of array $array, then job $merge: results in $out, report in my_name-merge.log"
