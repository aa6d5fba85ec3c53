#!/usr/bin/env bash
# check_completion.sh COMPLETION DIRECTORY_OF_THE_APPS: what bash offers at the end of some lines.
set -uo pipefail
export LC_ALL=C.UTF-8
source "$1"
programs=$(realpath "$2")
export PATH=$programs:$PATH
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
cd "$scratch"
touch scene.pcd mesh.off
faults=0

# expect WORDS LINE...: the offers for the last word of the line, sorted.
expect()
{
  local wanted=$1 got
  shift
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _pcl_surflet "$1"
  got=$(printf '%s\n' "${COMPREPLY[@]}" | sort | tr '\n' ' ')
  [ "${got% }" = "$wanted" ] || { echo "'$*' offers '${got% }', not '$wanted'" >&2; faults=$((faults + 1)); }
}

expect '-database' pcl_surflet_train -da
expect '--help --version' pcl_surflet_info --
expect '--help --version -csv -h -version' pcl_surflet_info -
expect 'all24 one pass ring24 two' pcl_surflet_generate -views ''
expect 'ring24' pcl_surflet_generate -views r
expect 'exclude ignore model' pcl_surflet_interpret -background ''
expect 'ignore model' pcl_surflet_replay -background ''
expect 'dissertation explanation' pcl_surflet_interpret -method ''
expect 'mesh.off scene.pcd' pcl_surflet_interpret -database ''
expect 'mesh.off' pcl_surflet_train m
expect '' pcl_surflet_train nothing_here
for program in "$programs"/pcl_surflet_*; do
  complete -p "$(basename "$program")" >/dev/null || { echo "no completion of $program" >&2; faults=$((faults + 1)); }
done
exit $((faults > 0))
