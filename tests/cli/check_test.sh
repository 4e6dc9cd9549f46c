#!/usr/bin/env bash
# cguide-check from outside: exit codes, what it says, --model and --precise.
# usage: check_test.sh PROGRAM FIXTURES
set -uo pipefail
program=$1
certificates=$2/certificates
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
silent() { [ ! -s "$work/$1" ] || fail "$1 is not empty"; }

# altered FROM TO: block.json with one change, as $work/altered.json.
altered() {
  text=$(<"$certificates/block.json")
  [[ $text == *"$1"* ]] || fail "block.json does not hold $1"
  printf '%s\n' "${text/"$1"/"$2"}" >"$work/altered.json"
}

# 2: usage
expect 2
says usage
silent out
expect 2 "$certificates/block.json" "$certificates/standing.json"
expect 2 "$certificates/block.json" --fast
expect 2 "$certificates/block.json" --model
expect 2 "$certificates/block.json" --precise
for bits in 52 4097 x 80x -80 ""; do expect 2 "$certificates/block.json" --precise "$bits"; done
expect 0 --help
says --precise

# 0: the whole path is proved
for certificate in block standing kinds; do
  expect 0 "$certificates/$certificate.json"
  says "1 of 1 edges proved; the whole path stays in C_guide"
  silent err
  for bits in 53 200; do expect 0 "$certificates/$certificate.json" --precise "$bits"; done
done

# 0 and 1: the model of the certificate, byte for byte
sed -n '2,/^"path": /p' "$certificates/block.json" | sed '$d' | sed '1s/^"model": //; $s/,$//' >"$work/model.json"
expect 0 "$certificates/block.json" --model "$work/model.json"
expect 1 "$certificates/standing.json" --model "$work/model.json"
says "another model"
sed 's/0.04/0.040/' "$work/model.json" >"$work/other.json"
expect 1 "$certificates/block.json" --model "$work/other.json"
expect 3 "$certificates/block.json" --model "$work/none.json"

# 0 and 1: for every model in a box
altered '"tool"' '"robust": {"friction": 0.5, "pose": 0.0099, "com": 1}, "tool"'
expect 0 "$work/altered.json"
says "for every model with friction less by up to 0.5, objects moved by up to 0.0099 m"
altered '"tool"' '"robust": {"friction": 0.5, "pose": 0.0101, "com": 1}, "tool"'
expect 1 "$work/altered.json"
altered '"tool"' '"robust": {"friction": 0, "pose": -1, "com": 0}, "tool"'
expect 3 "$work/altered.json"
says "/robust/pose"
altered '"tool"' '"robust": {"pose": 0}, "tool"'
expect 3 "$work/altered.json"

# 0 and 1: the path of a guide, number for number
guide() { # START-X JOINTS WAYPOINTS-MORE
  printf '{"schema": "cguide-guide/1", "seed": 3, "joint_names": [%s], "waypoints": [
    {"root": {"x": %s, "y": 0, "z": 0.11, "qx": -0.0, "qy": 0, "qz": 0, "qw": 1.0}, "joints": []},
    {"root": {"x": 0.1, "y": 0.1, "z": 0.11, "qx": 0, "qy": 0, "qz": 0, "qw": 1}, "joints": []}%s]}' "$2" "$1" "$3" \
    >"$work/guide.json"
}
guide 0 "" ""
expect 0 "$certificates/block.json" --guide "$work/guide.json"
expect 0 "$certificates/block.json" --guide "$work/guide.json" --model "$work/model.json" --precise 80
guide 1e-300 "" ""
expect 1 "$certificates/block.json" --guide "$work/guide.json"
says "refused: the certificate is about another path than $work/guide.json: waypoint 0 is another"
guide 0 "" ', {"root": {"x": 0, "y": 0, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}, "joints": []}'
expect 1 "$certificates/block.json" --guide "$work/guide.json"
says "it has 2 waypoints, not 3"
guide 0 '"elbow"' ""
expect 3 "$certificates/block.json" --guide "$work/guide.json"
says "$work/guide.json: /waypoints/0/joints: "
expect 3 "$certificates/block.json" --guide "$certificates/block.json"
says "/schema"
expect 3 "$certificates/block.json" --guide "$work/none.json"
says "none.json"
expect 2 "$certificates/block.json" --guide

# 1: refused, with edge and reason
altered '[-1, -1, 0]' '[1, -1, 0]'
expect 1 "$work/altered.json"
says 'edge 0: that "block" (shape 0) and "post" (piece 1) keep apart is not shown for s in [0.0'
says "0 of 1 edges proved"
expect 1 "$work/altered.json" --precise 100
altered '[0.1, 0.1, 0.11,' '[0.1, 0.1, 0.09,'
expect 1 "$work/altered.json"
altered '"edge": 0' '"edge": 1'
expect 1 "$work/altered.json"
says "the path has no such edge"

# 3: no certificate
for text in '' '{' '[]' '{"schema": "cguide-guide/1"}'; do
  printf '%s' "$text" >"$work/bad.json"
  expect 3 "$work/bad.json"
  says "cguide-check: $work/bad.json: "
  silent out
done
expect 3 "$work/none.json"
expect 3 "$work"
altered '"site": 0' '"site": 1'
expect 3 "$work/altered.json"
says "/proofs/0/tree/balance/contacts/0/site"

# 4: what is there holds, but edges have no proof
altered '[0.1, 0.1, 0.11, 0, 0, 0, 1]' '[0.1, 0.1, 0.11, 0, 0, 0, 1], [0, 0, 0.11, 0, 0, 0, 1]'
expect 4 "$work/altered.json"
says "without proof: edges 1"
says "1 of 2 edges proved"

[ "$failures" = 0 ]
