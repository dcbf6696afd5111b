#!/bin/sh
# Measures everything on a machine with a GPU and writes the JSON that this folder keeps.
#   bench/gpu.sh            the first hardware GPU
#   bench/gpu.sh gpu:1      another one, by its number in `strandline gpus`
#   bench/gpu.sh gpu quick  a short run that shows that everything works, into a temporary folder
set -eu
cd "$(dirname "$0")/.."
backend=${1:-auto}
folder=bench
quick=
if [ "${2:-}" = quick ]; then
    quick=--quick
    folder=$(mktemp -d)
fi
cargo build --release
STRANDLINE_REQUIRE_GPU=1 cargo test --release --package strandline-checks --test parity
for what in thesis scaling; do
    target/release/strandline bench "$what" --backend "$backend" $quick --json "$folder/gpu-$what.json"
done
echo "the measurements are in $folder"
