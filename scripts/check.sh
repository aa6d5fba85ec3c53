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
#   thread    tests under the thread sanitizer
#   memory    readers, files, space and features under valgrind: no error, no leak of ours. It knows no
#             AVX-512, so this is also a run of the AVX2 kernels
set -uo pipefail
cd "$(dirname "$0")/.."
stages=("${@:-}")
[ -n "${stages[0]}" ] || stages=(format tidy headers doc packages address thread memory)
jobs=$(nproc)
log=$(mktemp -d)
trap 'rm -rf "$log"' EXIT

format() {
  git ls-files -z '*.h' '*.hpp' '*.cpp' | xargs -0 clang-format --dry-run --Werror
}

tidy() {
  cmake --preset ci >/dev/null || return
  # Generated headers must be there; nothing else needs to be built.
  git ls-files -z 'src/*.cpp' 'apps/*.cpp' |
    xargs -0 -P"$jobs" -n2 clang-tidy -p build/ci --quiet --warnings-as-errors='*' \
      --extra-arg=-Wno-unknown-warning-option 2>"$log/tidy.noise"
}

headers() { scripts/check_headers.sh; }
doc() { scripts/doc.sh; }
packages() { scripts/package.sh; }

# The library and its tests without the apps, which it would take ten minutes to build.
sanitized() {
  cmake --preset "$1" -DPCL_SURFLET_BUILD_APPS=OFF >/dev/null && cmake --build --preset "$1" >"$log/build" ||
    { tail -n 40 "$log/build"; return 1; }
  "${@:2}" ctest --preset "$1" -j"$jobs" -LE slow
}
address() { sanitized asan; }
# Without random addresses: the thread sanitizer's memory map collides with some of them.
thread() { sanitized tsan setarch "$(uname -m)" -R; }

memory() {
  local programs=(surflet_pair geometry mesh_file triangle_mesh shapes surface_file database_file model_database
    model_search model_bank classifier object_centre training pair_counting cell_reduction octree_region_search
    mean_surflet_grid dynamic_space estimation pose_estimator compat)
  cmake --preset ci >/dev/null && cmake --build --preset ci --target "${programs[@]/#/test_}" >"$log/build" ||
    { tail -n 40 "$log/build"; return 1; }
  printf '%s\n' "${programs[@]}" |
    xargs -P"$jobs" -I{} sh -c 'valgrind -q --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite \
      --show-leak-kinds=definite "build/ci/bin/test_$1" --gtest_brief=1 >"$2/memory_$1" 2>&1 ||
      { cat "$2/memory_$1"; exit 1; }' - {} "$log"
}

scripts/install_dependencies.sh --with-checks || exit 1
failed=()
times=()
for stage in "${stages[@]}"; do
  case $stage in
    format | tidy | headers | doc | packages | address | thread | memory) ;;
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
