#!/usr/bin/env bash
# Builds the fuzzers (clang++ 14 or newer with libFuzzer: Debian's clang and libclang-rt-14-dev) and runs each
# for a while, then the apps with random options. Prints executions, coverage and crashes; inputs
# that crash a reader stay in out/fuzz. What was found before is kept there and built upon.
#
# usage: fuzz.sh SECONDS_PER_TARGET [TARGET...]   default: all; "apps" are the apps' options, which
#        needs the apps of the ci preset
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:?usage: fuzz.sh SECONDS_PER_TARGET [TARGET...]}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(off ply obj stl pcd database bank command_line apps)
out=$PWD/out/fuzz
mkdir -p "$out"
python3 test/fuzz/corpus.py "$out/corpus"
cmake --preset fuzz >/dev/null
failed=0
for target in "${targets[@]}"; do
  if [ "$target" = apps ]; then
    if [ -x build/ci/bin/pcl_surflet_train ]; then
      python3 test/fuzz/app_options.py build/ci/bin "$seconds" || failed=1
    fi
    continue
  fi
  cmake --build build/fuzz --target "fuzz_$target" >/dev/null
  mkdir -p "$out/found/$target"
  log=$out/$target.log
  UBSAN_OPTIONS=print_stacktrace=1 build/fuzz/bin/fuzz_"$target" -max_total_time="$seconds" \
    -timeout=20 -rss_limit_mb=2048 -malloc_limit_mb=512 -max_len=8192 -print_final_stats=1 \
    -artifact_prefix="$out/crash_${target}_" "$out/found/$target" "$out/corpus/$target" \
    >"$log" 2>&1 && crashed=no || { crashed=YES failed=1; }
  echo "$target: $(grep -a -o 'number_of_executed_units: *[0-9]*' "$log" | tr -s ' '), edges" \
    "$(grep -a -o 'cov: [0-9]*' "$log" | tail -n 1 | cut -d' ' -f2), crashed: $crashed"
done
exit $failed
