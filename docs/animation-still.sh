#!/usr/bin/env bash
# Draws docs/animation-still.png: the paper's column of three drums at 3 αg, the animation of its report at t = 0.56 s. Needs Chromium.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cargo run --release --quiet --package rocking-cli -- run scenes/paper-3-blocks-3.00.toml --out "$folder" --report --quiet
"${CHROMIUM:-chromium}" --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$folder/profile" \
    --force-device-scale-factor=1.25 --window-size=940,566 --virtual-time-budget=2000 --screenshot="$folder/still.png" \
    "file://$folder/report.html?show=animation&t=${1:-0.56}&angles=${2:-2}" 2> "$folder/said"
mv "$folder/still.png" docs/animation-still.png
