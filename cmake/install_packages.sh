#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# Installs the packages of the named sections of debian-packages.txt that are missing; silent when none is.
#
# usage: cmake/install_packages.sh SECTION...
set -eu

list=$(dirname -- "$(readlink -f -- "$0")")/debian-packages.txt

wanted=
for section in "$@"; do
  wanted="$wanted $(awk -v section="[$section]" '/^\[/ { inside = $0 == section; next } inside && /^[^#]/' "$list")"
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  # Another distribution: the build itself says what it does not find.
  exit 0
fi

missing=
for package in $wanted; do
  if [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
    missing="$missing $package"
  fi
done
if [ -z "$missing" ]; then
  exit 0
fi

if [ "$(id -u)" = 0 ]; then
  as_root=
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
  as_root='sudo -n'
else
  {
    echo "fexp: these packages are missing and need an administrator to install them. Run"
    echo "    sudo apt-get install --no-install-recommends$missing"
    echo "and call again."
  } >&2
  exit 1
fi

echo "fexp: installing packages:$missing" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt="$as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600"
# An outdated list may still name files that the mirror has, so a failing update alone ends nothing.
$apt update >"$log" 2>&1 </dev/null || echo "fexp: apt-get update failed, trying with the present lists" >&2
# shellcheck disable=SC2086
if ! $apt install --yes --no-install-recommends $missing >>"$log" 2>&1 </dev/null; then
  tail -n 25 "$log" >&2
  echo "fexp: apt-get could not install:$missing" >&2
  exit 1
fi
