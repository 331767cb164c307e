#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# Prints the machines of a Slurm job as a hosts file, for "fexp cluster run DECK --discover discover-slurm.sh" inside
# the job. Nodes that are down or drained are left out, so a run goes on without them, and nodes that the job gains
# join.
set -eu

job=${SLURM_JOB_ID:?not inside a job of Slurm}
# A job may have gained or lost nodes since it began, so the controller is asked, not the environment.
list=$(scontrol show job "$job" 2>/dev/null | sed -n 's/^ *NodeList=\([^ ]*\).*/\1/p' | head -n 1)
list=${list:-${SLURM_JOB_NODELIST:?}}

# "16(x3),8": 16 processors on each of the first three nodes, 8 on the fourth; taken only when it fits the list.
cpus=$(echo "${SLURM_JOB_CPUS_PER_NODE:-}" | tr ',' '\n' |
  sed -n 's/^\([0-9]*\)(x\([0-9]*\))$/\1 \2/p; s/^\([0-9]*\)$/\1 1/p' |
  while read -r count times; do
    while [ "$times" -gt 0 ]; do
      echo "$count"
      times=$((times - 1))
    done
  done)

nodes=$(scontrol show hostnames "$list")
if [ "$(echo "$nodes" | wc -l)" != "$(echo "$cpus" | wc -l)" ]; then
  cpus=
fi
number=0
for node in $nodes; do
  number=$((number + 1))
  state=$(scontrol show node "$node" 2>/dev/null | sed -n 's/^ *State=\([^ ]*\).*/\1/p')
  case $state in
    *DOWN* | *DRAIN* | *FAIL* | *NOT_RESPONDING* | *'*'*) continue ;;
  esac
  count=$(echo "$cpus" | sed -n "${number}p")
  echo "$node${count:+ slots=$count}"
done
