#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# Takes ssh's part in tests: agent.sh [options] ADDRESS COMMAND runs the command here. Files in $FAKE_HOSTS change that:
# "down-HOST" for a machine that cannot be reached, "cut-HOST" for one that does not answer, "old-HOST" for one with
# another version of fexp.
while :; do
  case ${1:-} in
    -*) shift ;;
    *) break ;;
  esac
done
# cluster.py's addresses of machines that are far away.
case $1 in
  198.51.100.*) host=far${1##*.} ;;
  *) host=$1 ;;
esac
shift
if [ -e "$FAKE_HOSTS/down-$host" ]; then
  echo "ssh: connect to host $host port 22: No route to host" >&2
  exit 255
fi
if [ -e "$FAKE_HOSTS/cut-$host" ]; then
  exec sleep 60
fi
if [ -e "$FAKE_HOSTS/old-$host" ]; then
  echo '{"version": "0.0.1", "machine": "'"$host"'", "alive_age_s": null, "mpi": true}'
  exit 0
fi
# A directory for each host, as each has its own /tmp: two daemons of Open MPI that make the same directory at the same
# moment end without a word.
mkdir -p "$FAKE_HOSTS/tmp-$host"
TMPDIR=$FAKE_HOSTS/tmp-$host exec sh -c "$*"
