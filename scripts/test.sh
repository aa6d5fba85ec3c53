#!/usr/bin/env bash
# Installs what is needed, builds everything with warnings as errors and runs all tests.
# PCL_SURFLET_VECTORS may name a directory of reference results to compare with as well.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh ci -DPCL_SURFLET_VECTORS="${PCL_SURFLET_VECTORS:-}"
ctest --preset ci -j"$(nproc)" "$@"
