#!/usr/bin/env bash
# Installs what is needed and builds one preset (first argument, default release); further arguments
# go to CMake.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
scripts/install_dependencies.sh
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} # one cache for this build and that of the packages
cmake --preset "$preset" "${@:2}" >/dev/null
cmake --build --preset "$preset"
