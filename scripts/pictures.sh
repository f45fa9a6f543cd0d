#!/usr/bin/env bash
# Draws the pictures of the README and of docs/graphics.md anew: contact sheets of every scene from six places, both eyes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/system-packages.sh

require_cargo
require_packages "${build_packages[@]}" "${graphics_packages[@]}"

provide_runtime_folder

cargo build --release --locked --bin bowling
program="${CARGO_TARGET_DIR:-target}/release/bowling"
mkdir -p docs/graphics
for scene in alley plain-1996 test; do
  "$program" look --scene "$scene" --width 200 --out "docs/graphics/$scene.png"
done
