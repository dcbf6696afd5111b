#!/usr/bin/env bash
# Shakes small hair at 20 g and 5 Hz for HOURS of simulated time, by constraints or as rods, and prints 24 times on
# the way how many points were not finite (none may be), the largest stretch and the memory. The figures of
# docs/reliability.md are from it.
set -eu
cd "$(dirname "$0")/.."
hours=${1:?usage: bench/soak.sh HOURS [hair|rods]}
case ${2:-hair} in
    hair) test=shaken_hair_stays_finite_in_length_and_in_memory ;;
    rods) test=shaken_rods_stay_finite_in_length_and_in_memory ;;
    *) echo "the method is $2, expected hair or rods" >&2; exit 2 ;;
esac
STRANDLINE_SHAKEN_HOURS=$hours cargo test --release --workspace --test soak -- --nocapture --exact "shaken::$test"
