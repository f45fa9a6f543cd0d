#!/usr/bin/env bash
# Everything that must hold before a change lands: format, lints, tests, docs. Continuous integration runs this.
# A missing driver is installed; a graphics test that finds none fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/system-packages.sh

require_cargo
require_packages "${build_packages[@]}" "${graphics_packages[@]}" "${window_packages[@]}" "${test_packages[@]}"

provide_runtime_folder
# Tests that need a graphics driver fail without one instead of naming themselves as skipped.
export CI="${CI:-true}"

step() { printf '\n== %s\n' "$*"; }

step "format"
cargo fmt --all --check

step "lints"
cargo clippy --workspace --all-targets --locked -- -D warnings
# Benches against other engines, which nothing else builds.
cargo clippy -p physics --features peers --benches --locked -- -D warnings

step "tests"
cargo test --workspace --locked

step "docs"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

step "all passed"
