#!/usr/bin/env bash
# run_commands.sh PAGE.md DIRECTORY_OF_THE_APPS: runs the blocks behind <!-- run -->, one after the other in one empty
# directory. Each must succeed and print what follows in <!-- prints: REGEX --> (extended, in one line).
set -euo pipefail
page=$(realpath "$1")
export PATH=$(realpath "$2"):$PATH
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
cd "$scratch"
blocks=0 state='' script=''
while IFS= read -r line; do
  case $state:$line in
    :'<!-- run -->') state=fence ;;
    fence:'```sh') state=block script='' ;;
    block:'```')
      state=
      echo "$script"
      bash -euo pipefail -c "$script" 2>&1 | tee printed
      blocks=$((blocks + 1))
      ;;
    block:*) script+=$line$'\n' ;;
    :'<!-- prints: '*)
      wanted=${line#'<!-- prints: '} wanted=${wanted%' -->'}
      grep -qE -- "$wanted" printed || { echo "$page: block $blocks did not print '$wanted'" >&2; exit 1; }
      ;;
  esac
done <"$page"
[ "$blocks" -gt 0 ] || { echo "$page has no block to run" >&2; exit 1; }
