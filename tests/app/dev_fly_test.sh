#!/usr/bin/env bash
# ./dev fly without a display: frames and contact sheets of both terrains, and the frame-rate table.
set -euo pipefail
root=$1
rm -rf "$root/out"
output=$("$root/dev" fly --size 96x54 2>&1) || { echo "$output"; exit 1; }
for terrain in natural urban; do
    [[ -s $root/out/$terrain.png && -s $root/out/$terrain/0023.png ]] || {
        echo "no frames of $terrain under out/"
        exit 1
    }
done
for technique in texture polygons; do
    grep -q "$technique" <<<"$output" || {
        echo "the table names no $technique: $output"
        exit 1
    }
done
