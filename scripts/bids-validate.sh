#!/usr/bin/env bash
# Passes a folder through the BIDS validator: scripts/bids-validate.sh STUDY/data; with --install only makes it ready.
# The validator is the npm package bids-validator, installed once into a cache folder. Exit 3 where there is no npm.
set -euo pipefail

version=1.15.0

if [ $# -ne 1 ] || { [ "$1" != --install ] && [ ! -f "$1/dataset_description.json" ]; }; then
  echo "say which dataset: scripts/bids-validate.sh FOLDER, with a dataset_description.json in it" >&2
  exit 2
fi
if ! command -v npm >/dev/null || ! command -v node >/dev/null; then
  echo "there is no npm on this machine, so the dataset was not validated: install Node.js with npm" >&2
  exit 3
fi

cache=${XDG_CACHE_HOME:-$HOME/.cache}/bowling/bids-validator-$version
program=$cache/node_modules/bids-validator/bin/bids-validator
if [ ! -e "$cache/complete" ]; then
  mkdir -p "$cache"
  # Scripts of packages are not needed, and not run.
  npm install --prefix "$cache" --ignore-scripts --no-audit --no-fund --loglevel=error "bids-validator@$version" >&2
  touch "$cache/complete"
fi
# Of its warnings the loudest says that a motion table has no heading, which is how BIDS wants it.
[ "$1" = --install ] || exec node "$program" "$1" --ignoreWarnings --no-color
