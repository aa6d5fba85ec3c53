#!/usr/bin/env bash
# Checks what the pages say against what is there: scripts/check_docs.sh [-update]
#   links     every relative link of a page leads to a file, every #anchor to a heading
#   pictures  every picture of doc/ is shown by a page
#   code      every block of C++ is what a compiled and tested program has between "// NAME: begin" and "// NAME: end",
#             which a comment before the block names: <!-- code: test/pcl/readme_example.cpp README -->
# -update writes the programs' lines into the pages.
set -euo pipefail
export LC_ALL=C.UTF-8 # awk and sort go by the locale
cd "$(dirname "$0")/.."
update=false
[ "${1:-}" = -update ] && update=true
faults=0

fault()
{
  echo "$1" >&2
  faults=$((faults + 1))
}

# Pages without the blocks of code, in which brackets are no links.
prose() { awk '/^ *```/ { fence = !fence; next } !fence && !/^    /' "$1"; }

# Headings as GitHub makes anchors of them.
anchors() { prose "$1" | sed -nE 's/^#+ +//p' | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'; }

check_links()
{
  local page=$1 link path anchor
  while read -r link; do
    case $link in *://* | mailto:*) continue ;; esac
    path=${link%%#*} anchor=${link#"$path"}
    path=$([ -z "$path" ] && echo "$page" || realpath -m --relative-to=. "$(dirname "$page")/$path")
    if [ ! -e "$path" ]; then
      fault "$page: '$link' leads nowhere"
    elif [ -n "$anchor" ] && ! anchors "$path" | grep -qxF -- "${anchor#\#}"; then
      fault "$page: '$path' has no heading for '$anchor'"
    fi
  done < <(prose "$page" | grep -oE '\]\([^) ]+\)' | sed 's/^](//; s/)$//' || true)
}

# The lines of a program between its marks, without their common indentation.
snippet()
{
  awk -v begin="// $2: begin" -v end="// $2: end" '
    index($0, begin) { indent = match($0, /[^ ]/) - 1; inside = 1; next }
    index($0, end) { inside = 0 }
    inside { print substr($0, 1, indent) ~ /^ *$/ ? substr($0, indent + 1) : $0 }' "$1"
}

# The page as it should be: blocks of C++ replaced by what their programs have.
with_snippets()
{
  local line source name
  while IFS= read -r line; do
    printf '%s\n' "$line"
    if [[ $line =~ ^'<!-- code: '([^ ]+)' '([^ ]+)' -->'$ ]]; then
      source=${BASH_REMATCH[1]} name=${BASH_REMATCH[2]}
      [ -n "$(snippet "$source" "$name")" ] || { fault "$1: there is no '$name' in '$source'"; continue; }
      IFS= read -r line # the fence
      printf '%s\n' "$line"
      snippet "$source" "$name"
      while IFS= read -r line && [[ $line != '```' ]]; do :; done
      printf '```\n'
    fi
  done <"$1"
}

check_code()
{
  local page=$1
  if awk '/^```cpp/ && before !~ /^<!-- code: / { bad = 1 } { before = $0 } END { exit !bad }' "$page"; then
    fault "$page: a block of C++ has no '<!-- code: FILE NAME -->' before it"
  fi
  grep -q '^<!-- code: ' "$page" || return 0
  with_snippets "$page" >"$scratch/page"
  cmp -s "$scratch/page" "$page" && return 0
  if $update; then
    cp "$scratch/page" "$page"
    echo "$page: updated"
  else
    diff "$page" "$scratch/page" >&2 || true
    fault "$page: its code is not what is tested; mend it, or run scripts/check_docs.sh -update"
  fi
}

check_pictures()
{
  local picture
  while read -r picture; do
    grep -qE "[(/]$(basename "$picture")\)" "$scratch/shown" || fault "$picture: no page shows it"
  done < <(find doc -name '*.png' -o -name '*.svg')
}

scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
while read -r page; do
  check_links "$page"
  check_code "$page"
  prose "$page" | grep -oE '!\[[^]]*\]\([^)]+\)' >>"$scratch/shown" || true
done < <(find . \( -path './build*' -o -path './out*' -o -path './.git' -o -path './data' \) -prune -o -name '*.md' -print | sed 's#^\./##' | sort)
check_pictures
[ $faults -eq 0 ] || { echo "$faults faults" >&2; exit 1; }
