#!/bin/sh
# Makes the strips of bodies that move, docs/gallery/{smile,look,nod,shrug}_frames.webp and animal.png: four frames of the scenes in
# docs/gallery/bodies, and every sixth frame of the animal's example; {smile,look,nod,shrug,animal}.webp are the same at 24 frames
# a second, smaller.
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
    ffmpeg -v error -y -i "out/$name/frame_%04d.png" -vf tile=2x2 -frames:v 1 -c:v libwebp -q:v 90 "docs/gallery/${name}_frames.webp"
done
"$program" render --scene out/animal/animal.toml --frames 24 --fps 24 --size 320x280 --out out/animal/film
ffmpeg -v error -y -i out/animal/film/frame_%04d.png -vf "select='eq(mod(n,6),5)',tile=4x1" -frames:v 1 docs/gallery/animal.png
ffmpeg -v error -y -framerate 24 -i out/animal/film/frame_%04d.png -c:v libwebp_anim -q:v 90 -compression_level 6 -loop 0 \
    docs/gallery/animal.webp
# Frames of two seconds or a little more: the whole clip.
for film in smile:48 look:64 nod:48 shrug:40; do
    name=${film%:*}
    "$program" render --scene "docs/gallery/bodies/$name.toml" --frames "${film#*:}" --fps 24 --size 280x310 --out "out/$name/film"
    ffmpeg -v error -y -framerate 24 -i "out/$name/film/frame_%04d.png" -c:v libwebp_anim -q:v 92 -compression_level 6 -loop 0 \
        "docs/gallery/$name.webp"
done
