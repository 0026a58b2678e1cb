#!/usr/bin/env bash
# What the largest number of blocks costs a build: prints CSV for N = 1 to 8, or for the N given as arguments.
# Compile seconds are those of the library and the command line with its dependencies already built, from nothing else.
set -euo pipefail
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-target/build-cost}"
cargo build --release --quiet -p rocking-cli
cargo build --release --quiet -p rocking-codegen --example cost
echo "blocks,modes,linkages,step_programs,force_programs,generation_seconds,bytes,lines,compile_seconds,binary_bytes"
for blocks in "${@:-1 2 3 4 5 6 7 8}"; do
    for n in $blocks; do
        cost=$("$CARGO_TARGET_DIR/release/examples/cost" "$n")
        cargo clean --release --quiet -p rocking -p rocking-cli
        start=$(date +%s.%N)
        ROCKING_MAX_BLOCKS=$n cargo build --release --quiet -p rocking-cli
        seconds=$(awk "BEGIN { print $(date +%s.%N) - $start }")
        size=$(stat -c %s "$CARGO_TARGET_DIR/release/rocking")
        echo "$cost,$(printf '%.1f' "$seconds"),$size"
    done
done
