#!/usr/bin/env bash
# The main job: trains a database of seven things, scans among them, generates a table with these
# and one unknown thing on it, and interprets that scene: labelled cloud, one cloud per object, a
# picture. Then classifies samples of twenty meshes and prints the table. Results land in out/demo.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh release -DPCL_SURFLET_BUILD_TESTS=OFF
meshes=$(scripts/fetch_meshes.sh data)
bin=build/release/bin
out=out/demo/scene
rm -rf "$out"
mkdir -p "$out"
leaf=0.006 # edge of the cells in metres: models are trained for those of the scene

# Names are those of the files; sizes in metres, and which axis of the mesh points up.
cp "$meshes/bunny00.off" "$out/bunny.off"
cp "$meshes/ChineseDragon-10kv.off" "$out/dragon.off"
cp "$meshes/camel.off" "$out/camel.off"
items=(bottle carafe cup wine_glass "$out/bunny.off:0.2:y" "$out/dragon.off:0.3:y"
  "$out/camel.off:0.28:y")

"$bin/pcl_surflet_generate" -seed "${SEED:-1}" -out "$out/scene.pcd" -poses "$out/truth.csv" \
  -models "$out/models" -clutter cone "${items[@]}"
"$bin/pcl_surflet_train" -database "$out/objects.pcd" -bins 7,7,7,7 -leaf "$leaf" "$out"/models/*.off
"$bin/pcl_surflet_interpret" -database "$out/objects.pcd" -leaf "$leaf" -background exclude -planes 1 -verbose \
  -out "$out/labelled.pcd" -objects_dir "$out/objects" -picture "$out/scene.png" "$out/scene.pcd"
echo "Picture, labelled cloud and objects: $out"

"$bin/pcl_surflet_experiment" classification -meshes "$meshes" -out out/demo -tests "${TESTS:-20}" "$@"
