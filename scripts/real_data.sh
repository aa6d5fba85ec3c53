#!/usr/bin/env bash
# Runs the programs, as a user would, on scans that this project did not make, and prints what
# doc/interpretation/real_data.md reports. Everything lands in DIR.
#
# usage: real_data.sh DIR DATA
#   DATA has pcl/ (milk.pcd, milk_cartoon_all_small_clorox.pcd, table_scene_mug_stereo_textured.pcd,
#   bun0.pcd of the Point Cloud Library's test data), ycb/ (CrackerBox.obj, MustardBottle.obj,
#   PowerDrill.obj, TomatoSoupCan.obj) and tabletop/ (another generator's scenes: SCENE.pcd,
#   SCENE.csv, models/*.ply)
#   BIN      the programs, default build/release/bin
#   MESHES   where the meshes of libcgal-demo are; fetched into data/ by default
#   THREADS  default 2
set -euo pipefail
export LC_ALL=C.UTF-8 # awk and sort go by the locale
out=$(realpath -m "${1:?usage: real_data.sh DIR DATA}")
data=$(realpath "${2:?usage: real_data.sh DIR DATA}")
cd "$(dirname "$0")/.."
bin=$(realpath "${BIN:-build/release/bin}")
tables=$PWD/scripts/real_data_tables.py
M=$(realpath "${MESHES:-$(scripts/fetch_meshes.sh data)}")
mkdir -p "$out"
cd "$out"
threads=(-threads "${THREADS:-2}")
kinect=0.008 # edge of the cells for scans with millimetres of noise
ours=0.0058  # that of results.md

train() { "$bin/pcl_surflet_train" -bins 7,7,7,7 "${threads[@]}" -database "$@" 2>/dev/null; }
find_in() { "$bin/pcl_surflet_interpret" "${threads[@]}" -csv "$@" 2>/dev/null; }

# The seven things of results.md as meshes in metres, z up.
cp "$M/bunny00.off" bunny.off
cp "$M/ChineseDragon-10kv.off" dragon.off
cp "$M/camel.off" camel.off
"$bin/pcl_surflet_generate" -out generated.pcd -models models -background none bottle carafe cup \
  wine_glass bunny.off:0.2:y dragon.off:0.25:y camel.off:0.25:y >/dev/null 2>&1
[ -s eleven.pcd ] || train eleven.pcd -leaf $kinect -views models/*.off "$data"/ycb/*.obj

echo "== milk: Kinect; the model is a crop of the scene"
cp eleven.pcd milk_database.pcd
train milk_database.pcd -leaf $kinect -k 30 "$data/pcl/milk.pcd"
for confidence in 0 0.1; do
  echo "-- -min_confidence $confidence"
  find_in -database milk_database.pcd -leaf $kinect -background exclude -planes 1 -k 30 \
    -min_confidence $confidence -out milk_labelled.pcd -picture milk.png \
    "$data/pcl/milk_cartoon_all_small_clorox.pcd"
done
python3 "$tables" outline "$data/pcl/milk.pcd" milk_labelled.pcd 12

echo "== mug: stereo; nothing of the scene is in the database"
for treatment in "exclude -planes 1" ignore; do
  echo "-- -background $treatment, all that is named, then by default"
  for confidence in 0 0.1; do
    # shellcheck disable=SC2086
    find_in -database eleven.pcd -leaf $kinect -background $treatment -k 30 \
      -min_confidence $confidence -picture mug.png "$data/pcl/table_scene_mug_stereo_textured.pcd"
  done
done

echo "== bunny: one range scan of the Stanford bunny; the model is another mesh of it"
# Its normals point to the origin of its frame, not to the scanner: they are turned about. The mesh,
# as wide as the original, 0.1557 m, is not turned: z is not up, as the scan has it.
awk 'NR <= 11 { print; next } { print $1, $2, $3, -$4, -$5, -$6, $7 }' "$data/pcl/bun0.pcd" >bun0.pcd
mkdir -p stanford
awk 'NR > 2 && NF == 3 { print $1 * 0.1557, $2 * 0.1557, $3 * 0.1557; next } { print }' bunny.off \
  >stanford/stanford_bunny.off
if [ ! -s bunny_database.pcd ]; then
  train bunny_database.pcd -leaf $kinect -views stanford/stanford_bunny.off \
    models/{bottle,carafe,cup,wine_glass,dragon,camel}.off "$data"/ycb/*.obj
fi
find_in -database bunny_database.pcd -leaf $kinect -pose stanford -viewpoints 0,0.1,1.5 \
  -picture bunny.png bun0.pcd

echo "== tabletop: another generator's scenes"
[ -s tabletop_views.pcd ] || train tabletop_views.pcd -leaf $ours -views "$data"/tabletop/models/*.ply
[ -s tabletop.pcd ] || train tabletop.pcd -leaf $ours "$data"/tabletop/models/*.ply
for truth in "$data"/tabletop/{full,views}*_*.csv; do
  scene=$(basename "$truth" .csv)
  database=tabletop_views.pcd
  [[ $scene == full* ]] && database=tabletop.pcd
  find_in -database $database -leaf $ours -background exclude -planes 1 -pose "$data/tabletop/models" \
    -picture "$scene.png" "$data/tabletop/$scene.pcd" >"$scene.found.csv"
  python3 "$tables" poses "$truth" "$data/tabletop/models.csv" "$scene.found.csv"
done
