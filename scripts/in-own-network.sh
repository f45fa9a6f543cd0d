#!/usr/bin/env bash
# Runs a command in a network of its own, in which there is this machine's loopback and nothing else:
#
#   scripts/in-own-network.sh COMMAND ARGUMENT ...
#
# The OpenXR runtime of the tests opens a port to every network. Needs no root where user namespaces are allowed.
set -euo pipefail

if [ $# -eq 0 ]; then
  echo "in-own-network: no command given: scripts/in-own-network.sh COMMAND ARGUMENT ..." >&2
  exit 2
fi
# Where `ip` is on Debian and Ubuntu, which leave it out of a user's own path.
PATH=$PATH:/usr/sbin:/sbin
for need in "unshare|util-linux" "ip|iproute2"; do
  if ! command -v "${need%%|*}" >/dev/null; then
    echo "in-own-network: ${need%%|*} is missing: install the package ${need#*|}" >&2
    exit 1
  fi
done

if unshare --net true 2>/dev/null; then
  new_network=(unshare --net)
elif unshare --user --map-root-user --net true 2>/dev/null; then
  new_network=(unshare --user --map-root-user --net)
else
  echo "in-own-network: this system lets neither root nor users make a network of their own (unshare --net);" \
    "allow user namespaces, or set BOWLING_XR_SHARED_NET=1 and run the command as it is where nobody else can reach this machine" >&2
  exit 1
fi
# shellcheck disable=SC2016  # The inner shell expands it.
exec "${new_network[@]}" sh -c 'ip link set lo up && exec "$@"' in-own-network "$@"
