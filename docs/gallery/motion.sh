#!/bin/sh
# Makes docs/gallery/motion.webp, the moving picture of the README: docs/gallery/motion.toml as a film.
#   docs/gallery/motion.sh
# STRANDLINE_PROGRAM names a program that is built already. Needs ffmpeg with libwebp.
set -eu
cd "$(dirname "$0")/../.."
program=${STRANDLINE_PROGRAM:-}
if [ -z "$program" ]; then
    cargo build --release
    program=target/release/strandline
fi
"$program" render --scene docs/gallery/motion.toml --out out/motion
ffmpeg -v error -y -framerate 20 -i out/motion/frame_%04d.png -c:v libwebp_anim -q:v 94 -compression_level 6 -loop 0 \
    docs/gallery/motion.webp
