#!/bin/sh
# find_package must refuse another minor version of PCL, naming both: source $1, build directory $2,
# installation $3. The other PCL is a package file that only has a version.
rm -rf "$2"
mkdir -p "$2/pcl"
echo 'set(PCL_FOUND TRUE)' >"$2/pcl/PCLConfig.cmake"
echo 'set(PACKAGE_VERSION 1.99.2)
set(PACKAGE_VERSION_COMPATIBLE TRUE)' >"$2/pcl/PCLConfigVersion.cmake"
if said=$(cmake -S "$1" -B "$2/build" -DCMAKE_PREFIX_PATH="$3" -DPCL_DIR="$2/pcl" 2>&1); then
  echo "PCL 1.99 was taken"
  exit 1
fi
said=$(echo "$said" | tr -s ' \n' ' ')
case $said in
*"was built with PCL 1."*", but PCL 1.99.2 was found in"*"build pcl_surflet with that PCL, or set"*) ;;
*) echo "another message was expected: $said"; exit 1 ;;
esac
