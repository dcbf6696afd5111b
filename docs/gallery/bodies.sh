#!/bin/sh
# Makes the strips of bodies that move, docs/gallery/{smile,look,nod,shrug,animal}.png: contact sheets of four frames of the scenes in
# docs/gallery/bodies, and every sixth frame of the animal's example; docs/gallery/animal.webp is its whole stride, shrug.webp the shrug at 24 frames a
# second.
#   docs/gallery/bodies.sh
# STRANDLINE_PROGRAM names a program that is built already. Needs ffmpeg with libwebp.
set -eu
cd "$(dirname "$0")/../.."
program=${STRANDLINE_PROGRAM:-}
if [ -z "$program" ]; then
    cargo build --release
    program=target/release/strandline
fi
cargo run -p strandline-body --example animal -- out/animal
for name in smile look nod shrug; do
    "$program" render --scene "docs/gallery/bodies/$name.toml" --out "out/$name"
    cp "out/$name/sheet.png" "docs/gallery/$name.png"
done
"$program" render --scene out/animal/animal.toml --frames 24 --fps 24 --size 320x280 --out out/animal/film
ffmpeg -v error -y -i out/animal/film/frame_%04d.png -vf "select='eq(mod(n,6),5)',tile=4x1" -frames:v 1 docs/gallery/animal.png
ffmpeg -v error -y -framerate 24 -i out/animal/film/frame_%04d.png -c:v libwebp_anim -q:v 90 -compression_level 6 -loop 0 \
    docs/gallery/animal.webp
"$program" render --scene docs/gallery/bodies/shrug.toml --frames 40 --fps 24 --out out/shrug/film
ffmpeg -v error -y -framerate 24 -i out/shrug/film/frame_%04d.png -c:v libwebp_anim -q:v 85 -compression_level 6 -loop 0 \
    docs/gallery/shrug.webp
