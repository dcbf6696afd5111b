#!/usr/bin/env bash
# Fuzzes readers in one process with overflow checks, without coverage or sanitizer: SECONDS each, all or some, with
# files that no earlier run had. Prints how many were given and how many of them read.
set -eu
cd "$(dirname "$0")/.."
seconds=${1:?usage: in_process.sh SECONDS [TARGET...]}
shift
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
    for file in fuzz/fuzz_targets/*.rs; do
        targets+=("$(basename "$file" .rs)")
    done
fi
for target in "${targets[@]}"; do
    STRANDLINE_FUZZ_SECONDS=$seconds STRANDLINE_FUZZ_TARGET=$target STRANDLINE_FUZZ_SEED=${SEED:-$(date +%s)} \
        cargo test --quiet --workspace --test it corpora -- --nocapture
done
