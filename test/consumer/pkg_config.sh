#!/bin/sh
# Builds and runs the consumer with a Makefile: source $1, build directory $2, library directory of
# the installation $3, compiler $4, flags $5.
set -e
rm -rf "$2"
mkdir -p "$2"
cp "$1"/Makefile "$1"/pipeline.cpp "$2"
cd "$2"
PKG_CONFIG_PATH=$3/pkgconfig make -s CXX="$4" CXXFLAGS="$5"
LD_LIBRARY_PATH=$3 ./pipeline
