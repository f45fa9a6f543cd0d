#!/usr/bin/env bash
# Installs what is missing, builds, and starts `bowling play` with the arguments given:
#   scripts/play.sh                      headset, else window, else a scripted game without a screen
#   scripts/play.sh --frames 3 --seed 7  see `bowling play --help`
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
source scripts/system-packages.sh

require_cargo
require_packages "${build_packages[@]}" "${graphics_packages[@]}" "${window_packages[@]}"

provide_runtime_folder

cargo build --release --locked --bin bowling
exec "${CARGO_TARGET_DIR:-$root/target}/release/bowling" play "$@"
