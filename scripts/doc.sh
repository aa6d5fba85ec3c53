#!/usr/bin/env bash
# Makes the documentation of the API and the pages of doc/ as HTML: scripts/doc.sh [DIR], default out/doc.
# Fails if anything that is public lacks its description, or if the pages have what scripts/check_docs.sh does not like.
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/../out/doc}")
cd "$(dirname "$0")/.."
version=$(sed -n 's/^project(pcl_surflet VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
mkdir -p "$out"
{ cat doc/Doxyfile
  printf '%s\n' "PROJECT_NUMBER=$version" "OUTPUT_DIRECTORY=$out" "WARN_LOGFILE=$out/warnings.txt"
} | doxygen -
if [ -s "$out/warnings.txt" ]; then
  echo "Mend these, see doc/Doxyfile:" >&2
  cat "$out/warnings.txt" >&2
  exit 1
fi
scripts/check_docs.sh
echo "$out/html/index.html"
