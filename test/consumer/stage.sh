#!/bin/sh
# Installs the build directory $1 with $2 (cmake) and moves the installation to $3: whatever knows
# where it was installed to no longer works.
set -e
staged=$3.staged
rm -rf "$staged" "$3"
"$2" --install "$1" --prefix "$staged" >/dev/null
mv "$staged" "$3"
