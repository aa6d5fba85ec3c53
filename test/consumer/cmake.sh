#!/bin/sh
# Configures, builds and runs the CMake consumer: source $1, build directory $2, installation $3,
# compiler $4, flags $5.
set -e
rm -rf "$2"
cmake -S "$1" -B "$2" -G Ninja -DCMAKE_PREFIX_PATH="$3" -DCMAKE_CXX_COMPILER="$4" \
  -DCMAKE_CXX_FLAGS="$5" >"$2.log" 2>&1 || { cat "$2.log"; exit 1; }
cmake --build "$2"
"$2/own_point_type"
