#!/usr/bin/env bash
# Audits of lists, in shards and in one run: the bytes, the exit codes, what is refused and what is resumed.
# usage: shard_test.sh PROGRAM CHECKER FIXTURES
set -uo pipefail
program=$1
checker=$2
fixtures=$3
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"

# same A B: two folders hold the same files with the same bytes, but for the manifests.
same() { diff -r -x 'shard-*' "$1" "$2" >"$work/diff" || fail "$1 and $2 differ: $(head -3 "$work/diff")"; }

# The list: guides, a foreign path with its problem in a folder with a blank, a refuted one.
room=$fixtures/problems/floor.yaml
mkdir -p "$work/lists" "$work/some paths"
for seed in 1 2 3; do
  "$program" plan -q "$fixtures/problems/chair_and_table.yaml" -o "$work/some paths/chair$seed.json" \
    --seed $seed >/dev/null || fail "no guide to audit"
done
"$program" plan -q "$room" -o "$work/floor.json" >/dev/null || fail "no guide to audit"
node -e '
  const guide = JSON.parse(require("fs").readFileSync(process.argv[1], "utf8")), keys = ["x","y","z","qx","qy","qz","qw"];
  console.log(keys.concat(guide.joint_names).join(","));
  for (const w of guide.waypoints) console.log(keys.map(k => w.root[k]).concat(w.joints).join(","));
' "$work/floor.json" >"$work/floor.csv"
awk -F, -v OFS=, 'NR > 1 { $3 -= 0.03 } { print }' "$work/floor.csv" >"$work/down.csv"
printf '# chair and floor\n../some paths/chair1.json\n../floor.csv\t%s\n../down.csv\t%s\n\n../some paths/chair2.json\n  ../some paths/chair3.json\n' \
  "$room" "$room" >"$work/lists/guides.txt"
list=$work/lists/guides.txt

# One run, started elsewhere; 1 is the worst of its paths.
(cd "$work/lists" && "$program" audit -q --list guides.txt --out ../one --threads 1 >"$work/text") || [ $? = 1 ] ||
  fail "one run over all ends in another code"
grep -q '^5 paths audited: 4 proved, 1 refuted$' "$work/text" || fail "the summary has other counts"
grep -qF '  2  refuted      ../down.csv: ' "$work/text" || fail "the refuted path is not named as in the list"
[ "$(ls "$work/one" | wc -l)" = 12 ] || fail "not two files a path, manifest and summary"
for certificate in "$work"/one/*[0-9].certificate.json "$work"/one/0001*.certificate.json; do
  "$checker" "$certificate" >/dev/null || fail "$certificate is refused"
done
"$checker" "$work/one/0000_chair1.certificate.json" --guide "$work/some paths/chair1.json" >/dev/null ||
  fail "a certificate is not about the guide it was made for"
"$checker" "$work/one/0000_chair1.certificate.json" --guide "$work/some paths/chair2.json" >/dev/null &&
  fail "a certificate is about another guide"
grep -rq "$work" "$work/one"/00*.report.json && fail "a report holds the folder it was made in"

# Shards: the same bytes, whatever their number and the threads, and the answer of one run.
for shards in 1 2 3 7; do
  out=$work/cut$shards
  for ((i = shards; i >= 1; --i)); do
    "$program" audit -q --list "$list" --shard "$i/$shards" --out "$out" --threads $((1 + i % 2)) >"$work/shard" 2>&1
    case $? in 0 | 1) ;; *) fail "shard $i/$shards: another code" ;; esac
  done
  rm -f "$out/summary.json"
  expect 1 merge "$out" --expect "$shards"
  cmp -s "$work/out" "$work/text" || fail "$shards shards print another summary than one run"
  same "$work/one" "$out"
done
expect 1 merge "$work/cut3" --expect 3 --format json
cmp -s "$work/out" "$work/one/summary.json" || fail "--format json does not print the summary"

# Refused: missing, foreign, copied, damaged. With the file, and what to do.
refused() {
  expect 3 merge "$work/bad" --expect 3
  says "$1"
  says "$2"
  [ ! -e "$work/bad/summary.json" ] || fail "a summary of refused shards"
  rm -r "$work/bad"
  cp -r "$work/cut3" "$work/bad"
  rm "$work/bad/summary.json"
}
cp -r "$work/cut3" "$work/bad" && rm "$work/bad/summary.json"
rm "$work/bad/shard-2-of-3.json"
refused shard-2-of-3.json "--shard 2/3"
cp "$work/cut2/shard-1-of-2.json" "$work/bad"
refused shard-1-of-2.json "remove it"
cp "$work/bad/shard-1-of-3.json" "$work/bad/shard-2-of-3.json"
refused shard-2-of-3.json "it holds shard 1/3"
printf x >>"$work/bad/0003_chair2.certificate.json"
refused 0003_chair2.certificate.json "digest"
sed -i 's/"verdict": "refuted"/"verdict": "proved"/' "$work/bad/shard-3-of-3.json"
refused 0002_down.report.json "the manifest says"
sed -i 's/"listed": 5/"listed": 6/' "$work/bad/shard-3-of-3.json"
refused shard-3-of-3.json "another content"
head -c 300 "$work/cut3/shard-3-of-3.json" >"$work/bad/shard-3-of-3.json"
refused shard-3-of-3.json damaged
expect 3 merge "$work/nowhere" --expect 1
expect 3 audit --list "$list" --shard 1/2 --out "$work/bad"
says "another division"

# A path that cannot be read is recorded, and does not stop the others; mended, only it is audited again.
cp "$work/floor.csv" "$work/good.csv"
head -c 300 "$work/good.csv" >"$work/floor.csv"
expect 3 audit --list "$list" --shard 2/2 --out "$work/mended"
says "bad input"
says "floor.csv"
grep -q '"verdict": "proved"' "$work/mended/shard-2-of-2.json" || fail "a bad path stopped the others"
expect 1 audit --list "$list" --shard 1/2 --out "$work/mended"
expect 3 merge "$work/mended" --expect 2
says "3 proved, 1 refuted, 1 bad input"
cp "$work/good.csv" "$work/floor.csv"
for i in 1 2; do "$program" audit -q --list "$list" --shard $i/2 --out "$work/mended" --resume >/dev/null; done
[ ! -e "$work/mended/summary.json" ] || fail "the summary of other files was left"
expect 1 merge "$work/mended" --expect 2
same "$work/one" "$work/mended"

# --resume keeps what is finished and intact: files that are not written again keep their inode.
inode() { stat -c %i "$1"; }
kept=$(inode "$work/one/0000_chair1.report.json") hurt=$(inode "$work/one/0003_chair2.report.json")
printf x >>"$work/one/0003_chair2.certificate.json"
expect 1 audit --list "$list" --out "$work/one" --resume
[ "$(inode "$work/one/0000_chair1.report.json")" = "$kept" ] || fail "a finished path was audited again"
[ "$(inode "$work/one/0003_chair2.report.json")" != "$hurt" ] || fail "a damaged result was kept"
same "$work/cut2" "$work/one"
expect 1 audit --list "$list" --out "$work/one"
[ "$(inode "$work/one/0000_chair1.report.json")" != "$kept" ] || fail "without --resume a result was kept"
# A partial certificate: its proofs are checked again, the others looked for; the bytes are those of one run.
sed -i 's/"verdict": "proved"/"verdict": "interrupted"/; s/"finished": true/"finished": false/' "$work/one/shard-1-of-1.json"
sed -i '/^{"edge":1,/d' "$work/one/0000_chair1.certificate.json"
expect 1 audit --list "$list" --out "$work/one" --resume
same "$work/cut2" "$work/one"

# Damaged: the manifest of a run is not guessed at.
cp -r "$work/cut2" "$work/damaged"
head -c 200 "$work/cut2/shard-1-of-2.json" >"$work/damaged/shard-1-of-2.json"
expect 3 audit --list "$list" --shard 1/2 --out "$work/damaged" --resume
says "remove it"

# Interrupted: a valid manifest, no summary; the rest follows.
for i in $(seq 100); do echo "../some paths/chair$((i % 3 + 1)).json"; done >"$work/lists/long.txt"
"$program" audit -q --list "$work/lists/long.txt" --out "$work/long" --threads 1 >"$work/out" 2>"$work/err" &
pid=$!
for ((i = 0; i < 200; ++i)); do
  [ -e "$work/long/0002_chair1.report.json" ] && break
  sleep 0.05
done
kill -TERM "$pid"
code=0
wait "$pid" || code=$?
[ "$code" = 130 ] || fail "interrupted, but exit code $code"
grep -q '"complete": false' "$work/long/shard-1-of-1.json" || fail "the manifest of a part says it is all"
[ ! -e "$work/long/summary.json" ] || fail "a summary of a part"
expect 3 merge "$work/long" --expect 1
says "--resume"
expect 0 audit --list "$work/lists/long.txt" --out "$work/long" --resume
says "100 paths audited: 100 proved"
ls -a "$work/long" | grep -q '^\.[0-9s]' && fail "temporary files are left"

# Options of the call are part of the work.
"$program" audit -q --list "$list" --shard 1/2 --out "$work/options" >/dev/null
"$program" audit -q --list "$list" --shard 2/2 --out "$work/options" --path-format csv >/dev/null
expect 3 merge "$work/options" --expect 2
says "options"
"$program" audit -q --list "$list" --shard 2/2 --out "$work/options" --robust mu=0.01 >/dev/null
expect 3 merge "$work/options" --expect 2
says "options"
"$program" audit -q --list "$list" --shard 1/2 --out "$work/options" --resume --robust mu=0.010,pose_mm=0 >/dev/null
expect 1 merge "$work/options" --expect 2
"$checker" "$work/options/0001_floor.certificate.json" | grep -q "friction less by up to 0.01" || fail "the box was not proved"

# What is doubtful of a problem is said once, not for each of its paths.
sed -e "s|\.\./robots/hrp2.srdf|$work/odd.srdf|; s|\.\./robots|$fixtures/robots|" "$room" >"$work/odd.yaml"
sed 's|<group_state name="standing" group="all">|&<joint name="TAIL" value="0"/>|' "$fixtures/robots/hrp2.srdf" >"$work/odd.srdf"
printf 'floor.csv\todd.yaml\ndown.csv\todd.yaml\n' >"$work/odd.txt"
expect 1 audit --list "$work/odd.txt" --out "$work/odd"
[ "$(grep -c TAIL "$work/err")" = 1 ] || fail "the warning about the posture came $(grep -c TAIL "$work/err") times"

# More shards than paths: some have nothing to do.
printf 'floor.json\n' >"$work/lists/../short.txt"
expect 0 audit --list "$work/short.txt" --shard 2/2 --out "$work/short"
expect 0 audit --list "$work/short.txt" --shard 1/2 --out "$work/short"
expect 0 merge "$work/short" --expect 2
says "1 path audited: 1 proved"

# Usage, and lists that are none.
expect 2 audit --list "$list"
expect 2 audit "$work/floor.json" --list "$list" --out "$work/x"
for shard in 0/2 3/2 1 1/ /2 1/2/3 x/2 -1/2 1/9999999; do
  expect 2 audit --list "$list" --out "$work/x" --shard "$shard"
done
expect 2 audit "$work/floor.json" --shard 1/2
expect 2 audit --list "$list" --out "$work/x" --dense 0.1
expect 2 audit --list "$list" --out "$work/x" --certificate "$work/c"
expect 2 audit --list "$list" --out "$work/x" --format junit
expect 2 merge "$work/one"
expect 2 merge "$work/one" --expect 0
[ ! -e "$work/x" ] || fail "a usage error made a folder"
expect 3 audit --list "$work/none.txt" --out "$work/x"
printf '#\n' >"$work/empty.txt"
expect 3 audit --list "$work/empty.txt" --out "$work/x"
says "names no path"
expect 3 audit --list "$list" --out "$work/floor.json"

if [ "$failures" -gt 0 ]; then
  echo "$failures failures" >&2
  exit 1
fi
echo "shards: as expected"
