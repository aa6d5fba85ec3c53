#!/usr/bin/env bash
# Fetches the meshes of the Debian package libcgal-demo into a directory (first argument) and prints
# where the OFF files lie. The package is unpacked, not installed.
set -euo pipefail

directory=${1:?usage: fetch_meshes.sh DIRECTORY}
meshes=$directory/data/meshes
if [ ! -f "$meshes/armadillo.off" ]; then
  rm -rf "$directory/package"
  mkdir -p "$directory/package"
  (
    cd "$directory/package"
    # apt-get download needs package lists; a fresh machine has none yet.
    apt-get download -qq libcgal-demo 2>/dev/null ||
      { if [ "$(id -u)" -eq 0 ]; then apt-get update -qq; else sudo apt-get update -qq; fi
        apt-get download -qq libcgal-demo; }
    dpkg-deb -x libcgal-demo_*.deb .
  ) >&2
  # Unpacked aside and moved: an interrupted run leaves nothing that looks complete.
  mkdir -p "$directory/package/unpacked"
  tar -xzf "$directory/package/usr/share/doc/libcgal-dev/data.tar.gz" -C "$directory/package/unpacked"
  rm -rf "$directory/data"
  mv "$directory/package/unpacked/data" "$directory/data"
  rm -rf "$directory/package"
fi
[ -f "$meshes/armadillo.off" ] || { echo "libcgal-demo does not hold the expected meshes" >&2; exit 1; }
echo "$meshes"
