#!/usr/bin/env bash
# Fuzzes readers with libFuzzer and the address sanitizer on the stable toolchain: SECONDS each, all or some.
set -eu
cd "$(dirname "$0")"
seconds=${1:?usage: sanitized.sh SECONDS [TARGET...]}
shift
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
    for file in fuzz_targets/*.rs; do
        targets+=("$(basename "$file" .rs)")
    done
fi
# The flags are for the targets alone: a target triple keeps them away from build scripts.
triple=$(rustc -vV | sed -n 's/^host: //p')
export RUSTC_BOOTSTRAP=1
export RUSTFLAGS="--cfg fuzzing -Zsanitizer=address -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
  -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
  -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1"
for target in "${targets[@]}"; do
    cargo build --release --target "$triple" --bin "$target"
done
for target in "${targets[@]}"; do
    mkdir -p "corpus/$target" "artifacts/$target"
    "target/$triple/release/$target" "corpus/$target" "seeds/$target" -max_total_time="$seconds" \
        -rss_limit_mb=2048 -timeout=10 -max_len=65536 -artifact_prefix="artifacts/$target/" -print_final_stats=1
done
