#!/bin/sh
# Measures everything on a machine with a GPU and writes the JSON that this folder keeps.
#   bench/gpu.sh            the first GPU, hardware before software
#   bench/gpu.sh gpu:1      another one, by its number in `strandline gpus`
#   bench/gpu.sh gpu quick  a short run that shows that everything works, into a temporary folder
set -eu
cd "$(dirname "$0")/.."
backend=${1:-gpu}
folder=bench
quick=
if [ "${2:-}" = quick ]; then
    quick=--quick
    folder=$(mktemp -d)
fi
cargo build --release
if target/release/strandline gpus | head -n 1 | grep -q software; then
    echo "there is only a software adapter: its figures are not kept"
    folder=$(mktemp -d)
fi
STRANDLINE_REQUIRE_GPU=1 cargo test --release --package strandline-checks --test parity
for what in thesis scaling view workers window; do
    target/release/strandline bench "$what" --backend "$backend" $quick --json "$folder/gpu-$what.json"
done
echo "the measurements are in $folder"
