#!/usr/bin/env bash
# Fits the reference tables with R's glm and brglm2 and compares every estimate with `bowling analyse`:
#
#   scripts/check-against-r.sh [BOWLING]
#
# BOWLING is the program [default: target/release/bowling]. Needs R with brglm2 and jsonlite
# (Debian: r-base-core r-cran-brglm2 r-cran-jsonlite). Not part of continuous integration; docs/analysis.md has its last result.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bowling=${1:-target/release/bowling}
if ! command -v Rscript >/dev/null; then
  echo "check-against-r: R is missing: install r-base-core, r-cran-brglm2 and r-cran-jsonlite" >&2
  exit 1
fi
if [ ! -x "$bowling" ]; then
  echo "check-against-r: there is no program at $bowling: build it with cargo build --release, or name it" >&2
  exit 1
fi
reports=$(mktemp -d)
trap 'rm -rf "$reports"' EXIT
data=crates/experiment/tests/data/statistics
for table in "$data"/[01]*.csv; do
  name=$(basename "$table" .csv)
  case $name in
    12_*) model="1 + F" ;;
    13_*) model="1 + NV + PI + EH" ;;
    *) model="change + F + sick + vr + S:change + E:change" ;;
  esac
  "$bowling" analyse "$table" --model "$model" --randomisations 100 --out "$reports/$name" >/dev/null
done
Rscript --vanilla scripts/check-against-r.R "$data" "$reports"
