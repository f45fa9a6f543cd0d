#!/usr/bin/env bash
# Everything that must hold before a change lands: format, lints, tests, docs. Continuous integration runs this.
# A missing driver is installed; a graphics test that finds none fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/system-packages.sh

require_cargo
require_packages "${build_packages[@]}" "${graphics_packages[@]}" "${window_packages[@]}" "${test_packages[@]}"

provide_runtime_folder
in_ci=${CI:-}
# Tests that need a graphics driver fail without one instead of naming themselves as skipped.
export CI="${CI:-true}"
# A checkout that is built once gains nothing from the compiler's notes for the next time, which take as much disk as the rest.
if [ -n "$in_ci" ]; then export CARGO_INCREMENTAL=0; fi

step() { printf '\n== %s\n' "$*"; }

step "format"
cargo fmt --all --check

step "lints"
cargo clippy --workspace --all-targets --locked -- -D warnings
# Benches against other engines, which nothing else builds.
cargo clippy -p physics --features peers --benches --locked -- -D warnings

step "OpenXR runtime"
# Where a machine can have none (exit 3) the headset's tests name themselves as skipped; in continuous integration they fail.
if xr_runtime=$(scripts/xr-runtime.sh); then
  # The runtime opens a port to every network, so that all tests run where there is none.
  alone=(scripts/in-own-network.sh)
elif [ $? -eq 3 ] && [ -z "$in_ci" ]; then
  xr_runtime=none
  alone=()
else
  exit 1
fi
export BOWLING_XR_RUNTIME=$xr_runtime
[ "${BOWLING_XR_SHARED_NET:-}" = 1 ] && alone=()

step "BIDS validator"
# Made ready while there is a network. Where there is no npm (exit 3) its test names itself as skipped; in continuous integration
# it fails.
scripts/bids-validate.sh --install || { [ $? -eq 3 ] && [ -z "$in_ci" ] && export BOWLING_NO_BIDS=1; }

step "tests"
cargo test --workspace --locked --no-run
"${alone[@]}" cargo test --workspace --locked --offline

step "the same bits in an optimised build"
cargo test -p physics --release --locked --test pinned

step "tables"
# A made-up study and its copies, which building the tests has built too. Where there is no npm (exit 3) they are not validated;
# in continuous integration that fails.
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
"${CARGO_TARGET_DIR:-target}/debug/examples/study_folder" "$made/all"
for dataset in study/data bids still; do
  scripts/bids-validate.sh "$made/all/$dataset" || { [ $? -eq 3 ] && [ -z "$in_ci" ]; }
done

step "a whole study"
# Eighteen participants, both games of ten frames each, answers included; then the validator and the analysis read what it left.
bowling=${CARGO_TARGET_DIR:-target}/debug/bowling
time "$bowling" study simulate "$made/eighteen" --subjects 18 --seed 1997
scripts/bids-validate.sh "$made/eighteen/data" || { [ $? -eq 3 ] && [ -z "$in_ci" ]; }
"$bowling" analyse "$made/eighteen" --out "$made/report" >/dev/null

step "docs"
RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked

step "all passed"
