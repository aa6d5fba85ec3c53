#!/bin/sh
# The library offers names of pcl_surflet and nothing else: what others put into it (templates of
# std, pcl, flann) would replace a program's own, or be replaced by it. Argument: the library.
# By mangled names: functions, virtual tables and types, guards of statics, thunks.
own='(N[KVRO]*|T[VTIS]N|GVN|Th[0-9n]+_N[K]?|Tv[0-9n]+_[0-9n]+_N[K]?)11pcl_surflet'
foreign=$(nm -D --defined-only "$1" | cut -d' ' -f2- | grep -vE "^[A-Za-z] _Z$own" | c++filt)
if [ -n "$foreign" ]; then
  echo "symbols outside pcl_surflet::"
  echo "$foreign"
  exit 1
fi
number=$(nm -D --defined-only "$1" | grep -cE " _Z$own")
echo "$number symbols of pcl_surflet"
[ "$number" -gt 300 ]
