#!/usr/bin/env bash
# Compiles every public header alone, as a user's file that includes nothing else, with g++ and
# clang++ (where it is installed), in C++17 and C++20, warnings as errors. Headers that show PCL
# take seconds each: without --all they are compiled by g++ in C++17 and clang++ in C++20 only.
# Usage: check_headers.sh [--all] [BUILD_DIRECTORY], which holds the generated headers
# (build/ci by default).
set -euo pipefail
cd "$(dirname "$0")/.."
all=false
[ "${1:-}" = --all ] && all=true && shift
build=${1:-build/ci}
[ -f "$build/include/pcl_surflet/config.h" ] ||
  { echo "$build is not configured: run scripts/build.sh ci, or name a build directory" >&2; exit 1; }

read -ra external <<<"$(pkg-config --cflags-only-I pcl_common pcl_search pcl_filters pcl_features)"
flags=(-fsyntax-only -Wall -Wextra -Wpedantic -Werror -Iinclude "-I$build/include")
flags+=("${external[@]/#-I/-isystem}" -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=1)

# One line a job: compiler, standard, header.
jobs() {
  local compiler standard header
  for header in $({ cd include && find pcl_surflet -name '*.h*'; } | sort) pcl_surflet/config.h; do
    for compiler in g++ clang++; do
      command -v "$compiler" >/dev/null || continue
      for standard in c++17 c++20; do
        case $all/$header/$compiler/$standard in
        true/* | */core/* | */recognition/* | */g++/c++17 | */clang++/c++20)
          echo "$compiler $standard $header" ;;
        esac
      done
    done
  done
}

compile_alone() {
  local compiler=$1 standard=$2 header=$3
  shift 3
  "$compiler" "-std=$standard" "$@" -include "$header" -x c++ /dev/null && return
  echo "$header does not compile alone ($compiler -std=$standard)" >&2
  return 1
}
export -f compile_alone

jobs | xargs -P "$(nproc)" -L1 bash -c 'compile_alone "${@: -3}" "${@:1:$#-3}"' _ "${flags[@]}" ||
  { echo "Some headers do not compile alone." >&2; exit 1; }
echo "$(jobs | wc -l) compilations of single headers"
