# What the tests of the programs from outside share; sourced with $program set.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

fail() {
  echo "FAILED: $*" >&2
  failures=$((failures + 1))
}

# expect CODE ARGUMENTS...: runs the program; its stdout and stderr are kept in $work/out and $work/err.
expect() {
  local wanted=$1 code=0
  shift
  "$program" "$@" >"$work/out" 2>"$work/err" || code=$?
  [ "$code" = "$wanted" ] || {
    fail "exit code $code instead of $wanted: $(basename "$program") $*"
    sed 's/^/    /' "$work/out" "$work/err" | head -8 >&2
  }
}

says() { grep -qF -- "$1" "$work/out" "$work/err" || fail "nothing said of \"$1\""; }
