#!/bin/bash
# Read in by scripts/install and scripts/uninstall, which have set `name` and usage(): the PREFIX of
# their command line, and the list of what is installed there.
name=${name:?}

say() {
  echo "$name: $*" >&2
}

fail() {
  say "$@"
  exit 1
}

refuse() {
  say "$@"
  exit 2
}

# Sets `prefix`: a whole path without an end of '/', not resolved, so that it stays as it was typed.
# shellcheck disable=SC2034  # it is for those who read this file in
take_prefix() {
  case ${1:-} in
    -h | --help) usage; exit 0 ;;
    -*) refuse "unknown option '$1'; scripts/$name --help shows which there are" ;;
  esac
  [ $# -le 1 ] || refuse "expected one PREFIX at most; got $# words (a path with spaces wants quotes)"
  if [ $# -eq 1 ]; then
    prefix=$1
  elif [ "$(id -u)" -eq 0 ]; then
    prefix=/usr/local
  else
    prefix=${HOME:-}/.local
  fi
  case $prefix in
    *[:$'\n']*) refuse "PREFIX '$prefix': expected a path without ':' and line ends, which PATH could not name" ;;
    /*) ;;
    *) refuse "PREFIX '$prefix': expected a whole path, such as /usr/local" ;;
  esac
  prefix=$(realpath --canonicalize-missing --no-symlinks -- "$prefix")
  [ "$prefix" != / ] || refuse "PREFIX '/': expected a folder below it, such as /usr/local"
  list=$prefix/share/roio/installed
}

# Prints the entries of one kind in the list of a former installation; nothing when there is none.
#   file    a path below the prefix
#   folder  one that the installation made, "." for the prefix itself
#   above   a whole path: one that it made above the prefix
listed() {
  [ ! -f "$list" ] || sed -n "s/^$1 //p" "$list"
}

check_list() {
  [ ! -f "$list" ] || ! grep -qE '^(file|folder) (/|(.*/)?\.\.(/|$))' "$list" ||
    fail "$list names what is not below $prefix; expected the list that scripts/install wrote"
}
