#!/usr/bin/env bash
# run_tutorial.sh PROGRAM PAGE.md: the program must succeed, which it does if what it finds is right, and print what the
# page shows behind <!-- output -->. Numbers may differ in their digits: processors and versions of PCL do.
set -euo pipefail
program=$1 page=$2
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
without_numbers() { sed -E 's/[0-9]+(\.[0-9]+)?/N/g; s/-N/N/g'; }

cd "$scratch"
"$program" | tee printed
awk '/^<!-- output -->/ { wanted = 1; next }
     wanted && /^```/ { inside = !inside; if (!inside) exit; next }
     inside' "$page" >shown
[ -s shown ] || { echo "$page shows no output" >&2; exit 1; }
diff <(without_numbers <shown) <(without_numbers <printed) >&2 || {
  echo "$page shows other output than $(basename "$program") prints" >&2
  exit 1
}
