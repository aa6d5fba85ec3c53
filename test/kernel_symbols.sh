#!/bin/sh
# Kernels built for an instruction set must not define weak symbols (inline functions of a header,
# say): the linker keeps one copy of those for the whole library, and if it is the one with AVX-512
# the library crashes on processors without. Arguments: object files.
status=0
checked=0
for object in "$@"; do
  case $object in
  *kernels/*avx*) ;;
  *) continue ;;
  esac
  checked=$((checked + 1))
  weak=$(nm -C "$object" | grep -E ' [WVu] ')
  if [ -n "$weak" ]; then
    echo "$object defines weak symbols:"
    echo "$weak"
    status=1
  fi
done
echo "$checked kernel objects checked"
exit $status
