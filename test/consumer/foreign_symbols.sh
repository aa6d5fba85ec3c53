#!/bin/sh
# The library offers names of pcl_surflet and nothing else: what others put into it (templates of
# std, pcl, flann) would replace a program's own, or be replaced by it. Argument: the library.
foreign=$(nm -DC --defined-only "$1" | cut -d' ' -f2- |
  grep -vE "^[A-Za-z] (.* )?(pcl_surflet::|(vtable|VTT|typeinfo|typeinfo name|guard variable) for pcl_surflet::|(non-virtual|virtual) thunk to pcl_surflet::)")
if [ -n "$foreign" ]; then
  echo "symbols outside pcl_surflet::"
  echo "$foreign"
  exit 1
fi
own=$(nm -DC --defined-only "$1" | grep -c " pcl_surflet::")
echo "$own symbols of pcl_surflet"
[ "$own" -gt 300 ]
