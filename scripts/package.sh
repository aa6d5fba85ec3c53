#!/usr/bin/env bash
# Builds the Debian packages into build/package/packages and has lintian look at them; errors count.
# Compiled as the preset ci does, so that scripts/build.sh has filled the compiler cache.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh --with-checks
build=build/package
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD}
umask 022
rm -rf $build/packages
cmake --preset ci -B $build -DPCL_SURFLET_BUILD_TESTS=OFF -DCMAKE_INSTALL_PREFIX=/usr \
  -DCMAKE_SKIP_INSTALL_RPATH=ON -DCMAKE_SHARED_LINKER_FLAGS=-Wl,-z,relro,-z,now \
  -DCMAKE_EXE_LINKER_FLAGS=-Wl,-z,relro,-z,now,--as-needed >/dev/null
cmake --build $build
(cd $build && cpack >cpack.log) || { cat $build/cpack.log >&2; exit 1; }
ls $build/packages/*.deb
lintian --fail-on error --tag-display-limit 0 $build/packages/*.deb
