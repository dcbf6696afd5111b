#!/bin/sh
# Makes the strips of bodies that move, docs/gallery/{smile,look,nod,shrug,animal}.png: contact sheets of four frames of the scenes in
# docs/gallery/bodies and of the animal's example.
#   docs/gallery/bodies.sh
# STRANDLINE_PROGRAM names a program that is built already.
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
"$program" render --scene out/animal/animal.toml --frames 4 --fps 4 --size 320x280 --out out/animal/film
cp out/animal/film/sheet.png docs/gallery/animal.png
