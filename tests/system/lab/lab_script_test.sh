#!/bin/bash
# What scripts/lab promises to the command that it runs, and to its caller.
# usage: lab_script_test.sh SCRIPTS_LAB
set -u
lab=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

expect() {  # WHAT EXPECTED ACTUAL
  if [ "$2" != "$3" ]; then
    printf 'FAILED: %s\n  expected: %s\n  actual:   %s\n' "$1" "$2" "$3"
    failures=$((failures + 1))
  fi
}

# --- one lab for all that one command can show ---------------------------------------------------

head -c 300000 /dev/urandom >"$folder/bytes"
(
  cd "$folder" || exit
  export ROIO_LAB_TEST="it's \"here\"" UNRELATED=no
  # shellcheck disable=SC2016  # the lab's shell expands them
  "$lab" sh -c '
    cat bytes
    echo "$# <$1> <$2> <$3>" >seen
    echo "$ROIO_LAB_TEST ${UNRELATED-unset} $HOME $(id -u)" >>seen
    cat >>seen
    ip -o link show up type vcan | wc -l >>seen
    echo complaint >&2
    sleep 1000 &
    exit 42' sh "two words" "" "\$HOME" <"$folder/bytes" >"$folder/out" 2>"$folder/err"
  echo $? >"$folder/status"
)
expect "the exit status is the command's" 42 "$(cat "$folder/status")"
expect "standard output is the command's, byte for byte" same \
  "$(cmp "$folder/bytes" "$folder/out" && echo same)"
expect "standard error is the command's and nothing else" complaint "$(cat "$folder/err")"
expect "arguments, chosen variables, root, no input, two interfaces" \
  "3 <two words> <> <\$HOME>
it's \"here\" unset $HOME 0
2" "$(cat "$folder/seen")"

# --- ends that are not the command's ---------------------------------------------------------------

"$lab" -t 4 sleep 1000 >"$folder/out" 2>&1
expect "a bounded time: status" 124 $?
expect "a bounded time: message" "lab: not finished after 4 s, ended: sleep 1000" \
  "$(tail -n 1 "$folder/out")"

# Only a kernel of the lab's own may be crashed.
ROIO_LAB=uml "$lab" sh -c 'sleep 0.2; echo c >/proc/sysrq-trigger; sleep 10' >"$folder/out" 2>&1
expect "a crash: status" 125 $?
expect "a crash: the kernel's log" 1 "$(grep -c 'Kernel panic - not syncing' "$folder/out")"
expect "a crash: message" "lab: the machine stopped before the command had ended" \
  "$(tail -n 1 "$folder/out")"

# --- several at once --------------------------------------------------------------------------------

jobs=
for number in 1 2; do
  "$lab" sh -c "cansend vcan0 123#0$number && exit 1$number" &
  jobs="$jobs $!"
done
statuses=
for job in $jobs; do
  wait "$job"
  statuses="$statuses $?"
done
expect "two at once" " 11 12" "$statuses"

# --- wrong calls --------------------------------------------------------------------------------------

expect "no arguments: help" "usage: scripts/lab [-t SECONDS] COMMAND [ARG...]" \
  "$("$lab" | head -n 1)"
expect "bad time" "lab: -t wants whole seconds, at least 1; got '1.5'" "$("$lab" -t 1.5 true 2>&1)"
expect "bad kind" "lab: ROIO_LAB is native, uml or unset; got 'qemu'" \
  "$(ROIO_LAB=qemu "$lab" true 2>&1)"

[ $failures -eq 0 ] && echo "all as promised"
exit $((failures > 0))
