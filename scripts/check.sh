#!/usr/bin/env bash
# What a change must pass beside the tests, in stages. Each prints what it found; the last lines say
# which stages failed and how long each took.
#
# usage: check.sh [STAGE...]     default: all, in this order
#   format    clang-format over all of our C++
#   tidy      clang-tidy (.clang-tidy: bugprone, performance, readability) over src/ and apps/
#   headers   every public header compiles alone, C++17 and C++20, g++ and clang++
#   doc       the reference, without a warning; links of the pages; pages of the manual
#   packages  Debian packages, and lintian over them
#   address   tests under the address and undefined-behaviour sanitizers (debug build)
#   programs  the apps under them; without those experiments that only train and measure
#   races     the quicker of the test programs that start threads, under the thread sanitizer
#   thread    all of them
#   memory    readers, files, space and features under valgrind: no error, no leak of ours. It knows no
#             AVX-512, so this is also a run of the AVX2 kernels
set -uo pipefail
cd "$(dirname "$0")/.."
stages=("${@:-}")
[ -n "${stages[0]}" ] || stages=(format tidy headers doc packages address programs thread memory)
jobs=$(nproc)
log=$(mktemp -d)
trap 'rm -rf "$log"' EXIT

format() {
  git ls-files -z '*.h' '*.hpp' '*.cpp' | xargs -0 clang-format --dry-run --Werror
}

# What a build folder compiles of src/ and apps/: without OpenCV, for one, not its peer.
compiled() {
  python3 -c 'import json, os, sys
for entry in json.load(open(sys.argv[1] + "/compile_commands.json")):
  if os.path.relpath(entry["file"].replace("/" + sys.argv[1] + "/", "/")).startswith(("src/", "apps/")):
    print(entry["file"])' "$1"
}

# Most of its time goes into headers, so sources are looked at several at a time ("unity" builds): in a
# third of the time. Names without linkage therefore differ within a target. Generated headers are made
# by the configuration; nothing needs to be built.
tidy() {
  cmake --preset tidy >/dev/null || return
  compiled build/tidy | xargs -P"$jobs" -n1 clang-tidy -p build/tidy --quiet --warnings-as-errors='*' \
    --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wreserved-identifier 2>"$log/tidy.noise"
}

headers() { scripts/check_headers.sh; }
doc() { scripts/doc.sh; }
packages() { scripts/package.sh; }

# Builds test programs of a preset and runs each under a command; shows the output of those that fail.
each() {
  local preset=$1 under=$2 programs=("${@:3}")
  cmake --preset "$preset" -DPCL_SURFLET_BUILD_APPS="$([ "$preset" = ci ] && echo ON || echo OFF)" >/dev/null &&
    cmake --build --preset "$preset" --target "${programs[@]/#/test_}" >"$log/build" ||
    { tail -n 40 "$log/build"; return 1; }
  printf '%s\n' "${programs[@]}" | xargs -P"$jobs" -I{} sh -c '$1 "build/$2/bin/test_$4" --gtest_brief=1 >"$3/$4" 2>&1 &&
    echo "passed $4" || { cat "$3/$4"; echo "FAILED $4"; exit 1; }' - "$under" "$preset" "$log" {}
}

# The library and its tests without the apps, which it would take ten minutes to build. Programs run as
# wholes: one process for each of their tests would train the same models again and again.
address() {
  cmake --preset asan -DPCL_SURFLET_BUILD_APPS=OFF >/dev/null && cmake --build --preset asan >"$log/build" ||
    { tail -n 40 "$log/build"; return 1; }
  local programs=(build/asan/bin/test_*)
  each asan "" "${programs[@]##*/test_}" && ctest --preset asan -j"$jobs" -E '[.]'
}

quick=(pair_counting training model_search cell_reduction octree_region_search depth_sensor estimation
  floating_seeds accumulation model_bank_trainer classifier)
long=(linear_octree dynamic_space explanation explanation_parts interpretation scene_interpreter online_interpretation
  online_scene_interpreter sensed_scene pose pose_estimator hostile_scenes hostile_models interruptions)

# Without random addresses: the thread sanitizer's memory map collides with some of them.
raced() {
  TSAN_OPTIONS="suppressions=$PWD/test/tsan.supp" each tsan "setarch $(uname -m) -R" "$@"
}
races() { raced "${quick[@]}"; }
thread() { raced "${long[@]}" "${quick[@]}"; }

memory() {
  each ci "valgrind -q --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite --show-leak-kinds=definite" \
    surflet_pair geometry mesh_file triangle_mesh shapes surface_file database_file model_database \
    model_search model_bank classifier object_centre training pair_counting cell_reduction \
    octree_region_search mean_surflet_grid dynamic_space estimation pose_estimator compat
}

# Open MPI does not free what it has, so leaks of ranks are not looked for.
programs() {
  cmake --preset asan -DPCL_SURFLET_BUILD_APPS=ON >/dev/null && cmake --build --preset asan >"$log/build" ||
    { tail -n 40 "$log/build"; return 1; }
  build/asan/bin/test_apps --gtest_brief=1 --gtest_filter='-Evaluate*:Experiment*' &&
    ASAN_OPTIONS=detect_leaks=0 build/asan/bin/test_ranks --gtest_brief=1
}

scripts/install_dependencies.sh --with-checks || exit 1
failed=()
times=()
for stage in "${stages[@]}"; do
  case $stage in
    format | tidy | headers | doc | packages | address | programs | races | thread | memory) ;;
    *) echo "Unknown stage $stage; see the first lines of $0" >&2; exit 1 ;;
  esac
  echo "=== $stage"
  SECONDS=0
  "$stage" || failed+=("$stage")
  times+=("$stage ${SECONDS} s")
done
echo "=== stages:$(printf ' %s,' "${times[@]}")"
[ ${#failed[@]} -eq 0 ] && { echo "=== all passed"; exit 0; }
echo "=== FAILED: ${failed[*]}"
exit 1
