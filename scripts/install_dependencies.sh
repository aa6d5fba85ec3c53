#!/usr/bin/env bash
# Installs everything pcl_surflet is built, tested and demonstrated with on Debian 12.
set -euo pipefail

packages=(
  build-essential ca-certificates cmake ninja-build ccache git
  libpcl-dev libflann-dev libeigen3-dev libboost-all-dev
  libboost-mpi-dev openmpi-bin  # several processes; without them one process does it all
  libgtest-dev libbenchmark-dev libnanoflann-dev
  locales  # numbers are read alike in all of them
  python3  # seeds of the fuzzers
  pkg-config  # consumers are tested with it
  gnuplot-nox fonts-dejavu-core
  xvfb libgl1-mesa-dri  # pictures where there is no display
)
# Optional: --with-opencv adds the peer of pcl_surflet_evaluate_peers (large), --with-checks what
# check.sh needs.
for option in "$@"; do
  case $option in
    --with-opencv) packages+=(libopencv-contrib-dev) ;;
    --with-checks)
      packages+=(clang clang-format clang-tidy doxygen graphviz dpkg-dev fakeroot file lintian
        help2man valgrind)
      ;;
    *) echo "Unknown option $option" >&2; exit 1 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' ||
    missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "Run as root, or install sudo, to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
