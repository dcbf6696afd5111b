#!/bin/sh
# Makes docs/gallery/wet.png: long hair dry, wet and sprayed.
#   docs/gallery/wet.sh
# STRANDLINE_PROGRAM names a program that is built already. Needs ffmpeg.
set -eu
cd "$(dirname "$0")/../.."
program=${STRANDLINE_PROGRAM:-}
if [ -z "$program" ]; then
    cargo build --release
    program=target/release/strandline
fi
for hair in medium wet sprayed; do
    "$program" render --style long --hair "$hair" --view three_quarter --frames 1 --size 450x450 --out "out/hair_$hair.png"
done
ffmpeg -v error -y -i out/hair_medium.png -i out/hair_wet.png -i out/hair_sprayed.png -filter_complex hstack=3 docs/gallery/wet.png
