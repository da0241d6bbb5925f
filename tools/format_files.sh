#!/bin/bash
# Makes the files of tests/data/formats/VERSION, on a machine that is called "host".
#     tools/format_files.sh build/release/hamflow tests/data/formats/1.0
set -euo pipefail
hamflow=$(realpath "$1")
cd "$2"
hostname host
"$hamflow" run scenario.toml --quiet --out run
"$hamflow" reverse scenario.toml --quiet --out reversal
for shard in 0 1; do
  "$hamflow" sweep scenario.toml --quiet --vary run.dt=0.05,0.04,0.02 --set output.formats='["h5"]' --out sweep --shard $shard/2
done
"$hamflow" sweep --quiet --merge sweep
rm -rf run/figures sweep/shard-1-of-2
