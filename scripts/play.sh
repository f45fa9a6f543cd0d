#!/usr/bin/env bash
# Installs what is missing, builds, and starts `bowling play` with the arguments given:
#   scripts/play.sh                      headset, else window, else a scripted game without a screen
#   scripts/play.sh --frames 3 --seed 7  see `scripts/play.sh --help`
# Paths among the arguments, and the recording's folder, are where you stand.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/scripts/system-packages.sh"

require_cargo
require_packages "${build_packages[@]}" "${graphics_packages[@]}" "${window_packages[@]}"

provide_runtime_folder

cargo build --release --locked --bin bowling --manifest-path "$root/Cargo.toml"
export BOWLING_ROOT="${BOWLING_ROOT:-$root}"
exec "${CARGO_TARGET_DIR:-$root/target}/release/bowling" play "$@"
