#!/usr/bin/env bash
# Installs what is needed and builds one preset (first argument, default release); further arguments
# go to CMake.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
scripts/install_dependencies.sh
cmake --preset "$preset" "${@:2}" >/dev/null
cmake --build --preset "$preset"
