#!/usr/bin/env bash
# The main job: trains a database of twenty real meshes, classifies fresh, turned, noisy and cut
# samples of them, prints the table and draws objects and histograms. Results land in out/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh release -DPCL_SURFLET_BUILD_TESTS=OFF
meshes=$(scripts/fetch_meshes.sh data)
build/release/bin/pcl_surflet_experiment classification -meshes "$meshes" -out out/demo -tests "${TESTS:-20}" "$@"
