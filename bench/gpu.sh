#!/bin/sh
# Measures on a machine with a GPU everything that is not measured without one, in less than ten minutes, and
# writes the JSON that this folder keeps and the plots.
#   bench/gpu.sh                    the first GPU, hardware before software
#   bench/gpu.sh gpu:1              another one, by its number in `strandline gpus`
#   bench/gpu.sh --quick [gpu:1]    a short run that shows that everything works, into a temporary folder
# In this order, the most telling first, so that what the time cuts off is the least:
#   thesis    tables 1 to 4: one kernel against three, the whole system on each device, one thread a strand
#             against one a point, Jacobi against Chebyshev
#   view      table 5, and 560,000 and 1.5 million segments at 1280x968
#   workers   every pair of devices, two GPUs among them where there are two
#   window    a minute of play
#   scaling   cost against strands and cells until the device refuses
# Not measured, since they are not built: opacity blended into floats, a scatter of whole numbers in place of the
# gather (docs/decisions/0002, 0003).
# STRANDLINE_PROGRAM names a program that is built already; SECONDS_LEFT how long all of it may take, 570.
set -eu
cd "$(dirname "$0")/.."
folder=bench
quick=
backend=gpu
for argument in "$@"; do
    case $argument in
        --quick) quick=--quick ;;
        *) backend=$argument ;;
    esac
done
program=${STRANDLINE_PROGRAM:-}
if [ -z "$program" ]; then
    cargo build --release
    program=target/release/strandline
fi
"$program" gpus
if [ -n "$quick" ]; then
    folder=$(mktemp -d)
elif "$program" gpus | head -n 1 | grep -q software; then
    echo "there is only a software adapter: its figures are not kept"
    folder=$(mktemp -d)
fi
begin=$(date +%s)
end=$((begin + ${SECONDS_LEFT:-570}))
left_out=
measure() {
    what=$1
    shift
    left=$((end - $(date +%s)))
    if [ "$left" -lt 5 ]; then
        left_out="$left_out $what"
        return
    fi
    echo "== $what, $left s left"
    if ! timeout "$left" "$program" bench "$what" --backend "$backend" $quick "$@" --json "$folder/gpu-$what.json"; then
        left_out="$left_out $what"
    fi
}
measure thesis
measure view
measure workers
if [ -n "$quick" ]; then measure window; else measure window --seconds 60; fi
measure scaling
for what in thesis view; do
    if [ -f "$folder/gpu-$what.json" ]; then
        "$program" plot "$folder/gpu-$what.json"
    fi
done
echo "took $(($(date +%s) - begin)) s; the measurements are in $folder: $(ls "$folder" | grep '^gpu-' | tr '\n' ' ')"
if [ -z "$quick" ] && [ -z "${STRANDLINE_PROGRAM:-}" ]; then
    echo "== both backends against each other, not counted in the time"
    STRANDLINE_REQUIRE_GPU=1 cargo test --release --package strandline-checks --test parity
fi
if [ -n "$left_out" ]; then
    echo "failed or left out for want of time:$left_out"
    exit 1
fi
