#!/bin/sh
# A user who takes neither CMake nor pkg-config: include directory of the installation $1, compiler
# $2. With -mavx2 alone the program would crash where it frees a cloud; the compiler must say so and
# how to mend it, and the remedy must work.
probe() {
  # shellcheck disable=SC2046,SC2086 # lists of flags
  echo '#include <pcl_surflet/point_types.h>' | "$2" -std=c++17 -fsyntax-only -x c++ -I"$1" \
    $(pkg-config --cflags pcl_common) $3 - 2>&1
}
said=$(probe "$1" "$2" "-mavx2")
case $said in
*"Compile with -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=1"*) ;;
*) echo "-mavx2 was not refused, or without the remedy: $said"; exit 1 ;;
esac
said=$(probe "$1" "$2" "-mavx2 -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MALLOC_ALREADY_ALIGNED=1") &&
  said=$said$(probe "$1" "$2" "") || { echo "refused: $said"; exit 1; }
