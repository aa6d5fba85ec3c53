#!/usr/bin/env bash
# Makes the man pages from what the programs say with -h and -version, and from doc/man/examples.txt:
#   scripts/make_man.sh [DIRECTORY_OF_THE_PROGRAMS]          writes doc/man/*.1
#   scripts/make_man.sh -check DIRECTORY_OF_THE_PROGRAMS     fails if they are not up to date
# Needs help2man; without it -check ends with 77.
set -euo pipefail
export LC_ALL=C.UTF-8 # awk and sort go by the locale
check=false
[ "${1:-}" = -check ] && { check=true; shift; }
programs=$(realpath "${1:-$(dirname "$0")/../build/ci/bin}")
cd "$(dirname "$0")/.."
command -v help2man >/dev/null || { echo "help2man is missing" >&2; exit 77; }
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT

# Sections beside those that -h has.
sections()
{
  echo '[examples]'
  awk -v want="[$1]" '
    /^#/ || /^$/ { next }
    /^\[/ { inside = $1 == want; next }
    !inside { next }
    /^  / { gsub(/\\/, "\\e"); gsub(/-/, "\\-"); print ".PP\n.nf\n.RS\n" substr($0, 3) "\n.RE\n.fi"; next }
    { print ".PP\n" $0 }' doc/man/examples.txt
  printf '%s\n' '[exit status]' \
    '0: all went well. 1: wrong usage. 2: bad data or a file that cannot be read or written; a message names cause and remedy.' \
    '[author]' 'The pcl_surflet authors.'
}

others=()
for program in "$programs"/pcl_surflet_*; do others+=("$(basename "$program")"); done
faults=0
for name in "${others[@]}"; do
  what=$(sed -n "s/^\[$name\] //p" doc/man/examples.txt)
  [ -n "$what" ] || { echo "doc/man/examples.txt has nothing for $name" >&2; faults=1; continue; }
  sections "$name" >"$scratch/sections"
  help2man --no-info --no-discard-stderr --help-option=-h --version-option=-version --section=1 --manual="User Commands" \
    --source="pcl_surflet" --name="$what" --include="$scratch/sections" "$programs/$name" |
    sed -E -e '/^\.\\" DO NOT MODIFY/d' -e '/^Exit codes: /d' -e '1,/^\.TH/s/^(\.TH [^ ]+ "1") "[^"]*"/\1 ""/' \
      -e 's/(exclusion_vfh,) (opencv, opencv_repaired, )?shot/\1 shot, with OpenCV opencv and opencv_repaired/' >"$scratch/$name.1"
  if ! $check; then
    cp "$scratch/$name.1" "doc/man/$name.1"
  elif ! diff -u "doc/man/$name.1" "$scratch/$name.1" >&2; then
    faults=1
  fi
done
for page in doc/man/*.1; do
  [ -e "$programs/$(basename "$page" .1)" ] || { echo "$page is of a program that there is not" >&2; faults=1; }
done
[ $faults -eq 0 ] || { echo "Run scripts/make_man.sh, with the programs built" >&2; exit 1; }
