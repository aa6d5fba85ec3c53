#!/usr/bin/env bash
# Evaluates scene interpretation: one line below is one row of the table in
# doc/interpretation/results.md. Results go to DIR: a file for each row and list of methods under
# rows/, all of them in scenes.csv (overall) and objects.csv (each object), tables in scenes.txt and
# (what a sensor sees) sensor.txt and the curves' critical.csv and scaling.csv. Rows that are there
# already are not run again, so a run can be interrupted, and other methods can be added to the same
# DIR later.
#
# usage: evaluate_scenes.sh DIR [SCENES]
#   METHODS  what is compared, with commas; default all
#   SEED     seed of the first scene, default 1001 (seeds below 100 are for tuning)
#   ONLY     rows to run, a regular expression, default all
#   PROGRAM  default build/release/bin/pcl_surflet_evaluate
#   YCB      where CrackerBox.obj, MustardBottle.obj, PowerDrill.obj and TomatoSoupCan.obj are; default
#            no such rows
#   MESHES   where the meshes of libcgal-demo are; fetched into data/ by default
set -euo pipefail
export LC_ALL=C.UTF-8 # awk and sort go by the locale
directory=$(realpath -m "${1:?usage: evaluate_scenes.sh DIR [SCENES]}")
scenes=${2:-100}
cd "$(dirname "$0")/.."
methods=${METHODS:-explanation,dissertation,classic_vfh,classic_esf,exclusion_vfh}
seed=${SEED:-1001}
program=${PROGRAM:-build/release/bin/pcl_surflet_evaluate}
M=${MESHES:-$(scripts/fetch_meshes.sh data)}
mkdir -p "$directory/rows"

seven=(bottle carafe cup wine_glass "$M/bunny00.off:0.2:y" "$M/ChineseDragon-10kv.off:0.25:y"
  "$M/camel.off:0.25:y")
others=("$M/cow.off:0.22:y" "$M/elephant.off:0.2:y" "$M/armadillo.off:0.25:y" "$M/pig.off:0.16:y"
  "$M/mushroom.off:0.13:z" "$M/bull.off:0.2:y" "$M/man.off:0.3:z")
unknown=torus,cone,cube

# Everything else of the meshes that is one body: what the database is filled up with.
extra=torus,cone,cube,sphere,cylinder,tetrahedron,box,ellipsoid
sizes=(0.13 0.15 0.17 0.2 0.22 0.25 0.28 0.3)
for name in armadillo bear bear_bis blade blobby bones bull cactus cheese couplingdown cow cross dino \
  diplodocus dragknob eight elephant elk fandisk femur hand handle head helmet holes homer joint knot \
  knot1 knot2 lion-head man mannequin-devil mech-holes-shark mushroom nefertiti oblong part pig pinion \
  retinal rotor spool star triceratops tripod turbine u anchor boeing b9_mesh blob-closed icosahedron \
  octahedron ALSTOM_TEST4; do
  extra+=",$M/$name.off:${sizes[0]}"
  sizes=("${sizes[@]:1}" "${sizes[0]}")
done

# run GROUP NAME OPTION... ITEM...: one call of the program, unless its result is there. A group is a
# table or a curve.
order=()
run() {
  local group=$1 name=$2
  order+=("$group.$name")
  local file="$directory/rows/$group.$name.$methods.csv"
  [[ $name =~ ${ONLY:-.} ]] || return 0
  [ -s "$file" ] && return 0
  echo "$name ($methods)" >&2
  "$program" -threads "${THREADS:-2}" -seed "$seed" -method "$methods" -csv -row "$name" "${@:3}" \
    >"$file.part"
  mv "$file.part" "$file"
}
row() { run scenes "$1" -scenes "$scenes" -peers -memory "${@:2}"; }

row excluded -treatment exclude "${seven[@]}"
row modelled -treatment model "${seven[@]}"
row ignored -treatment ignore "${seven[@]}"
row touching -treatment exclude -spacing pile "${seven[@]}"
row touching_modelled -treatment model -spacing pile "${seven[@]}"
row gap_1cm -treatment exclude -spacing pile -gap 0.01 "${seven[@]}"
row lying_leaning -treatment exclude -posture mixed -size 1.2 "${seven[@]}"
row unknown_three -treatment exclude -clutter $unknown -size 1.3 "${seven[@]}"
row corner -treatment model -background corner -size 1.2 "${seven[@]}"
row box -treatment model -background box -size 1.2 "${seven[@]}"
row box_touching -treatment model -background box -size 1.2 -spacing pile "${seven[@]}"
row bowl -treatment model -background bowl -size 1.4 "${seven[@]}"
row bowl_excluded -treatment exclude -background bowl -size 1.4 "${seven[@]}"
row half_present -treatment exclude -present 3 "${seven[@]}"
row others_excluded -treatment exclude "${others[@]}"
row others_modelled -treatment model "${others[@]}"
row others_touching -treatment exclude -spacing pile "${others[@]}"

# What a depth camera sees (Table 5.2): of the seven, each is absent as often as present; models, the
# empty table and the classic's examples come from the same sensor.
for views in one two ring24; do
  sensor=(-treatment model -presence 0.5 -views "$views" -sensor_noise 0.0005 -grazing 80)
  row "sensor_$views" "${sensor[@]}" "${seven[@]}"
  row "sensor_${views}_touching" "${sensor[@]}" -spacing pile "${seven[@]}"
  # Five fixed scenes: two of two objects, two of three, one of four.
  sensor=(-treatment model -views "$views" -sensor_noise 0.0005 -grazing 80)
  for present in 2 3 4; do
    run fixed "fixed_${views}_$present" -scenes $((present < 4 ? 2 : 1)) "${sensor[@]}" \
      -present $present "${seven[@]}"
  done
  # Laser scans of household things. A modelled table and the sides of a box are the same to a
  # histogram, so the table is excluded.
  if [ -n "${YCB:-}" ]; then
    sensor=(-treatment exclude -presence 0.5 -views "$views" -sensor_noise 0.0005 -grazing 80)
    things=("$YCB"/{CrackerBox,MustardBottle,PowerDrill,TomatoSoupCan}.obj)
    row "sensor_ycb_$views" "${sensor[@]}" "${things[@]}"
    row "sensor_ycb_${views}_touching" "${sensor[@]}" -spacing pile "${things[@]}"
  fi
done

# Curves: fewer scenes, as each is several rows.
some=$(((scenes + 1) / 2))
few=$(((scenes + 9) / 10))
run critical free -scenes "$some" -treatment ignore -background none -size 1.2 \
  -critical 0,0.25,0.5,0.75,1,1.25,1.5,1.75,2,2.25,2.5,3 "${seven[@]}"
run critical table -scenes "$some" -treatment exclude -size 1.2 \
  -critical 0,0.25,0.5,0.75,1,1.25,1.5,1.75,2,2.25,2.5,3 "${seven[@]}"
run scaling area -scenes "$few" -treatment exclude -peers -memory -scaling area "${seven[@]}"
run scaling models -scenes "$few" -treatment exclude -peers -memory -scaling models -extra "$extra" \
  "${seven[@]}"

# gathered GROUP: its rows in the order above, one header.
gathered() {
  local name
  for name in "${order[@]}"; do
    if [[ $name == "$1".* ]]; then cat "$directory/rows/$name".*.csv 2>/dev/null || true; fi
  done | awk 'NR == 1 || !/^row,/'
}
overall() { awk -F, 'NR == 1 || $12 == "all"'; }
gathered scenes >"$directory/objects.csv"
for group in scenes fixed critical scaling; do gathered $group | overall >"$directory/$group.csv"; done

awk -F, 'NR == 1 {
    print "| row | method | scenes | class. (5.9) | accuracy (5.10) | strict | recall | precision | recall x precision | false / scene | s / scene | x normals | memory |"
    print "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    next
  }
  function rate(at) { return sprintf("%.1f [%.1f, %.1f]", $at, $(at + 1), $(at + 2)) }
  /^sensor_/ { next }
  { printf "| %s | %s | %d | %s | %.1f | %s | %s | %s | %.1f | %.2f | %.2f | %.2f | %.2f |\n", $1, $2,
      $5, rate(21), $33, rate(24), rate(27), rate(30), $34, $35, $8, $9, $11 }' \
  "$directory/scenes.csv" >"$directory/scenes.txt"
awk -F, 'NR == 1 {
    print "| row | method | scenes | present | class. (5.9) | accuracy (5.10) | recall | precision | centre | false / scene | s / scene |"
    print "|---|---|---|---|---|---|---|---|---|---|---|"
    next
  }
  function rate(at) { return sprintf("%.1f [%.1f, %.1f]", $at, $(at + 1), $(at + 2)) }
  /^sensor_/ { printf "| %s | %s | %d | %d | %s | %.1f | %s | %s | %s | %.2f | %.2f |\n", $1, $2, $5, $13,
      rate(21), $33, rate(27), rate(30), rate(37), $35, $8 }' "$directory/scenes.csv" >"$directory/sensor.txt"
cat "$directory/scenes.txt" "$directory/sensor.txt"
# draw PLOT CSV: if there is anything to draw.
draw() {
  [ "$(wc -l <"$directory/$2.csv")" -gt 1 ] || return 0
  (cd "$directory" && gnuplot "$OLDPWD/doc/interpretation/$1.gnuplot") ||
    echo "gnuplot is missing or failed; install gnuplot-nox" >&2
}
draw table_51 scenes
draw critical critical
draw scaling scaling
