#!/usr/bin/env bash
# The program from outside: exit codes, messages, what is written and what is not.
# usage: cli_test.sh PROGRAM FIXTURES SECTION
set -uo pipefail
program=$1
fixtures=$2
section=$3
source "$(dirname "${BASH_SOURCE[0]}")/expect.sh"
says_not() { ! grep -qiF -- "$1" "$work/out" "$work/err" || fail "said \"$1\""; }

a1=$fixtures/problems/chair_and_table.yaml
room=$fixtures/problems/floor.yaml

section_usage() {
  expect 0 --help
  says plan
  expect 0 --version
  says "cguide 0."
  expect 2
  expect 2 dance
  expect 2 plan "$a1"                      # no output named
  expect 2 plan "$a1" -o "$work/g.json" --planner magic
  expect 2 plan "$a1" -o "$work/g.json" --seed x
  expect 2 plan "$a1" -o "$work/g.json" --time-limit -1
  expect 2 audit "$work/g.json" --dense 0
  expect 2 stability
  # What is not a number, or not a finite one, is outside of every range.
  local number
  for number in nan NaN -nan inf -inf 1e400 "" x; do
    expect 2 plan "$a1" -o "$work/g.json" --time-limit "$number"
    expect 2 plan "$a1" -o "$work/g.json" --iteration-limit "$number"
    expect 2 plan "$a1" -o "$work/g.json" --edge-step "$number"
    expect 2 plan "$a1" -o "$work/g.json" --extension "$number"
    expect 2 plan "$a1" -o "$work/g.json" --shortcuts "$number"
    expect 2 plan "$a1" -o "$work/g.json" --cuts "$number"
    expect 2 plan "$a1" -o "$work/g.json" --seed "$number"
    expect 2 plan "$a1" -o "$work/g.json" --threads "$number"
    expect 2 audit "$work/g.json" --dense "$number"
    expect 2 stability --guide "$work/g.json" --at "$number"
    says "--at"
    expect 2 view "$work/g.json" -o "$work/g.html" --frames "$number"
    expect 2 merge "$work" --expect "$number"
  done
  [ ! -e "$work/g.json" ] || fail "a usage error wrote a file"
}

section_main_job() {
  expect 0 plan "$a1" -o "$work/sampled.json" --seed 3 --edges sampled
  says "edges: sampled("
  says_not proved
  grep -q '"edges": *"sampled(' "$work/sampled.json" || fail "the guide does not say how its edges were tested"
  ! grep -qi proved "$work/sampled.json" || fail "a guide of samples speaks of proof"
  expect 0 plan "$a1" -o "$work/guide.json" --seed 3 --stats "$work/stats.json" --certificate "$work/planned.cert"
  says "edges: proved"
  grep -q '"edges": *"proved"' "$work/guide.json" || fail "the guide does not say that its edges are proved"
  grep -q '"least_clearance_m": [0-9.e-]*,' "$work/stats.json" || fail "the stats say nothing of the clearance"
  grep -q '"contacts_broken": [1-9]' "$work/stats.json" || fail "nobody gets up without breaking a contact"
  ! grep -q seconds "$work/guide.json" || fail "the guide holds times"
  grep -q search_seconds "$work/stats.json" || fail "the statistics hold no times"
  # At the planner's own samples its edges hold; a finer audit may find more and says so by its code.
  expect 0 audit "$work/guide.json" --dense 0.005
  says "no violation at the samples"
  says "com margin"
  says_not proved
  expect 0 audit "$work/guide.json" --dense 0.005 --format json -o "$work/report.json"
  grep -q '"schema": "cguide-audit/1"' "$work/report.json" || fail "the report has no schema"
  # For machines: the counts of the report are the answers of the exit code.
  expect 0 audit "$work/guide.json" --dense 0.005 --format junit
  says 'failures="0" errors="0"'
  says 'edges_tested" value="sampled(0.005)"'
  expect 0 audit "$work/guide.json" --dense 0.005 --format sarif -o "$work/report.sarif"
  grep -q '"results": \[\]' "$work/report.sarif" || fail "the SARIF report of a clean guide has results"
  # Whole edges, no samples: what holds there holds between samples too.
  expect 0 audit "$work/guide.json" --certificate "$work/audited.cert"
  says "edges proved for every s"
  cmp -s "$work/planned.cert" "$work/audited.cert" || fail "plan and audit write different certificates"
  expect 2 audit "$work/guide.json" --dense 0.005 --certificate "$work/x.cert"
  # Boxes of models: no wider than the guide bears, named in reports and certificates.
  expect 0 audit "$work/guide.json" --robust com_mm=0,mu=0.001 --certificate "$work/box.cert"
  says "friction less by up to 0.001"
  grep -q '"robust": {"friction":0.001,"pose":0,"com":0}' "$work/box.cert" || fail "no box in the certificate"
  expect 4 audit "$work/guide.json" --robust com_mm=500 --format json
  says '"com_m": 0.5'
  expect 3 audit "$work/guide.json" --certificate "$work/box.cert" --resume
  for box in mu mu=x mu=-1 mu=nan mu=1,mu=1 yaw=1 ""; do expect 2 audit "$work/guide.json" --robust "$box"; done
  expect 2 audit "$work/guide.json" --robust mu=0.1 --dense 0.01
  expect 2 audit "$work/guide.json" --robust mu=0.1 --critical mu
  # A partial certificate is completed to the same bytes; one of another path is refused.
  grep -v '^{"edge":1,' "$work/audited.cert" >"$work/partial.cert"
  expect 0 audit "$work/guide.json" --certificate "$work/partial.cert" --resume
  cmp -s "$work/partial.cert" "$work/audited.cert" || fail "a resumed audit writes another certificate"
  expect 0 plan "$a1" -o "$work/other.json" --seed 4
  expect 3 audit "$work/other.json" --certificate "$work/audited.cert" --resume
  says "another model, box of models or path"
  head -c 5000 "$work/audited.cert" >"$work/cut.cert"
  expect 3 audit "$work/guide.json" --certificate "$work/cut.cert" --resume
  says "cut.cert"
  expect 2 audit "$work/guide.json" --resume
  expect 0 stability --guide "$work/guide.json" --at 0.5
  says "statically stable"
  says "support region"
  says "mm, checked exactly"
  says "gradient of the com margin, checked exactly"
  expect 0 stability "$a1" --posture goal --format json
  says '"verdict": "stable"'
  says '"com_margin_enclosure_m"'
  says '"com_margin_gradient"'
  expect 0 stability "$a1" --acceleration 1,0,0
  says "while the centre of mass accelerates by [1 0 0]"
  says "forces can balance it"
  says "largest acceleration along it"
  expect 0 stability "$a1" --acceleration 20,0,0 --format json
  says '"largest_enclosure_m_s2"'
  says '"verdict": "unstable"'
  expect 3 stability "$a1" --acceleration 0,0,0
  says "has no direction"
  expect 3 stability "$a1" --acceleration 0,0,-9.81
  says "free fall"
  expect 2 stability "$a1" --acceleration 1,2
  expect 2 stability "$a1" --acceleration nan,0,0
  expect 2 stability "$a1" --acceleration 1,0,0 --coms "$work/none.csv"
  expect 1 stability "$room" --posture sitting
  says "separating wrench"
  expect 0 view "$work/guide.json" -o "$work/page.html"
  grep -q '<html' "$work/page.html" || fail "the page is no page"
  expect 0 view "$work/guide.json" --certificate "$work/audited.cert" -o "$work/page.html"
  grep -q 'data-verdict="proved"' "$work/page.html" || fail "the page does not show the proof"
  expect 3 view "$work/guide.json" --certificate "$work/guide.json" -o "$work/page.html"
  says "guide.json: "
  expect 0 model "$a1" -o "$work/model.json"
  says "sha256:"
  expect 0 doctor "$a1"
  says "directed rounding works"
  expect 0 doctor
}

section_roadmap() {
  expect 2 plan "$room" -o "$work/g.json" --roadmap "$work/map.json"
  says "--planner prm"
  expect 0 plan "$room" -o "$work/g1.json" --planner prm --seed 7 --roadmap "$work/map.json"
  expect 0 plan "$room" -o "$work/g2.json" --planner prm --seed 8 --roadmap "$work/map.json" --stats "$work/stats.json" --shortcuts 0
  says "proved"
  grep -q '"iterations": 0' "$work/stats.json" || fail "the roadmap was not used again"
  cp "$work/map.json" "$work/map0.json"
  expect 0 plan "$room" -o "$work/g3.json" --planner prm --seed 8 --roadmap "$work/map.json"
  cmp -s "$work/map.json" "$work/map0.json" || fail "a query that the roadmap answers changed it"
  expect 3 plan "$room" -o "$work/g.json" --planner prm --roadmap "$work/map.json" --edges sampled
  says "tested otherwise"
  expect 3 plan "$room" -o "$work/g.json" --planner prm --roadmap "$work/map.json" --space free
  says "space"
  expect 3 plan "$a1" -o "$work/g.json" --planner prm --roadmap "$work/map.json"
  says "another model"
  expect 3 plan "$room" -o "$work/g.json" --planner prm --roadmap "$work/g1.json"
  says "cguide-guide/1"
}

section_hold() {
  feet=$fixtures/problems/feet_fixed.yaml
  expect 0 plan "$feet" -o "$work/held.json" --hold RLEG_JOINT5 --hold LLEG_JOINT5 --certificate "$work/held.cert"
  says "edges: proved"
  says "within 1 mm"
  cp "$work/held.json" "$work/first.json"
  expect 0 plan "$feet" -o "$work/held.json" --hold RLEG_JOINT5 --hold LLEG_JOINT5 --threads 2
  cmp -s "$work/held.json" "$work/first.json" || fail "another number of threads gave another guide"
  expect 3 plan "$feet" -o "$work/g.json" --hold LEG
  says "JOINT"
  expect 3 plan "$feet" -o "$work/g.json" --hold RARM_JOINT5
  says "the goal has"
  expect 2 plan "$feet" -o "$work/g.json" --hold RLEG_JOINT5 --planner contacts
  # A roadmap does not say which links its edges hold.
  expect 2 plan "$feet" -o "$work/g.json" --hold RLEG_JOINT5 --planner prm --roadmap "$work/map.json"
  says "--roadmap"
  expect 2 plan "$feet" -o "$work/g.json" --hold RLEG_JOINT5 --space free
  expect 2 plan "$feet" -o "$work/g.json" --hold RLEG_JOINT5 --link flow
  expect 2 plan "$feet" -o "$work/g.json" --hold RLEG_JOINT5 --extension 0.5
  expect 2 plan --hold RLEG_JOINT5   # one link an option: the problem is missing
  expect 0 plan --hold RLEG_JOINT5 "$feet" -o "$work/order.json" --iteration-limit 2000 --quiet
  [ ! -e "$work/g.json" ] || fail "a refused plan wrote a file"
}

# What was asked for and cannot be is refused, not left out; nothing takes the place of an input.
section_plan_rules() {
  free="plan $room -o $work/g.json --space free"
  expect 2 $free --planner contacts
  expect 2 $free --robust mu=0.1
  expect 2 $free --link flow
  expect 2 $free --certificate "$work/c.json"
  expect 2 plan "$room" -o "$work/g.json" --edges sampled --robust mu=0.1
  says "--robust"
  expect 2 plan "$room" -o "$work/g.json" --edges sampled --certificate "$work/c.json"
  expect 2 plan "$room" -o "$work/g.json" --edge-step 0.1
  sed "s#\.\./robots#$fixtures/robots#g; s#epsilon_m:#model: nearest\n  epsilon_m:#; /sites:/,/LLEG/d" "$room" >"$work/nearest.yaml"
  expect 3 plan "$work/nearest.yaml" -o "$work/g.json" --robust mu=0.1
  says "nearest"
  cp "$room" "$work/own.yaml"
  sed -i "s#\.\./robots#$fixtures/robots#g" "$work/own.yaml"
  cp "$work/own.yaml" "$work/kept.yaml"
  expect 3 plan "$work/own.yaml" -o "$work/own.yaml"
  says "twice"
  expect 3 plan "$work/own.yaml" -o "$work/g.json" --certificate "$work/../$(basename "$work")/g.json"
  expect 3 plan "$work/own.yaml" -o "$work/g.json" --stats "$work/own.yaml"
  cmp -s "$work/own.yaml" "$work/kept.yaml" || fail "the problem was written over"
  [ ! -e "$work/g.json" ] || fail "a refused plan wrote a file"
  expect 0 plan "$work/own.yaml" -o "$work/g.json"
  expect 3 audit "$work/g.json" -o "$work/g.json"
  expect 3 view "$work/g.json" -o "$work/g.json"
  expect 0 audit "$work/g.json"
}

section_reproducible() {
  expect 0 plan "$a1" -o "$work/one.json" --seed 7 --threads 1
  expect 0 plan "$a1" -o "$work/two.json" --seed 7 --threads 2
  cmp -s "$work/one.json" "$work/two.json" || fail "another number of threads gave another guide"
  expect 0 plan "$a1" -o "$work/again.json" --seed 7 --threads 2
  cmp -s "$work/two.json" "$work/again.json" || fail "the same call gave another guide"
  expect 0 plan "$room" -o "$work/prm1.json" --planner prm --seed 7 --threads 1
  expect 0 plan "$room" -o "$work/prm2.json" --planner prm --seed 7 --threads 2
  cmp -s "$work/prm1.json" "$work/prm2.json" || fail "another number of threads gave another roadmap guide"
  for threads in 1 2; do
    "$program" audit "$work/one.json" --dense 0.005 --threads "$threads" --format json \
      >"$work/report$threads.json" 2>/dev/null
  done
  cmp -s "$work/report1.json" "$work/report2.json" || fail "another number of threads gave another report"
}

section_same_model() {
  # The canonical model is a function of the files, not of how their paths are spelt.
  local problem count=0
  for problem in chair_and_table jvrc1_chair_and_table talos_chair_and_table hyq_floor; do
    "$program" model -q "$fixtures/problems/$problem.yaml" >"$work/one" 2>/dev/null || continue
    (cd "$fixtures/problems" && "$program" model -q "$problem.yaml" >"$work/two" 2>/dev/null)
    cmp -s "$work/one" "$work/two" || fail "$problem: another spelling of the path, another model"
    count=$((count + 1))
  done
  [ "$count" -ge 1 ] || fail "no model could be written"
  [ "$count" = 4 ] || echo "skipped: $((4 - count)) problems whose robots are not here"
}

section_limits() {
  expect 4 plan "$fixtures/problems/tunnel_80.yaml" -o "$work/none.json" --iteration-limit 4
  says "no guide found: iteration limit"
  [ ! -e "$work/none.json" ] || fail "a guide was written though none was found"
  expect 4 plan "$fixtures/problems/tunnel_80.yaml" -o "$work/none.json" --time-limit 0.3
  says "time limit"
  # Ctrl-C: a shell starts background jobs with SIGINT ignored, so SIGTERM stands for it.
  "$program" plan "$fixtures/problems/tunnel_80.yaml" -o "$work/none.json" --time-limit 60 \
    >/dev/null 2>&1 &
  local pid=$!
  sleep 2
  kill -TERM "$pid"
  local code=0
  wait "$pid" || code=$?
  [ "$code" = 130 ] || fail "interrupted, but exit code $code"
  [ ! -e "$work/none.json" ] || fail "an interrupted plan left a guide"
  ls "$work" | grep -q '\.tmp\|~' && fail "temporary files are left"
  interrupted_audit
}

# An interrupted audit ends with 130, but with 1 where it had refuted the path: that is final.
interrupted_audit() {
  "$program" model -q "$room" | node -e '
    const model = JSON.parse(require("fs").readFileSync(0, "utf8"));
    const joints = model.joints.filter(j => j.type !== "fixed" && !j.mimic).map(j => j.name);
    const rows = [["x", "y", "z", "qx", "qy", "qz", "qw"].concat(joints)];
    for (let i = 0; i < 20000; ++i) rows.push([i * 1e-4, 0, 0.5, 0, 0, 0, 1].concat(joints.map(() => 0)));
    console.log(rows.map(r => r.join(",")).join("\n"));
  ' >"$work/sunk.csv"
  "$program" audit "$work/sunk.csv" --problem "$room" --format json -o "$work/sunk.report" --threads 1 \
    >/dev/null 2>&1 &
  local pid=$! code=0
  sleep 2
  kill -TERM "$pid"
  wait "$pid" || code=$?
  grep -q '"done": false' "$work/sunk.report" || fail "the audit was not interrupted"
  local wanted=130
  grep -q '"verdict": "refuted"' "$work/sunk.report" && wanted=1
  [ "$code" = "$wanted" ] || fail "interrupted audit: exit code $code instead of $wanted"
}

# One path as CSV, OMPL's matrix and MoveIt's messages: one report, but for the file's name.
same_path_in_other_forms() {
  node -e '
    const fs = require("fs"), [, guideFile, out] = process.argv;
    const guide = JSON.parse(fs.readFileSync(guideFile, "utf8"));
    const root = w => ["x", "y", "z", "qx", "qy", "qz", "qw"].map(k => w.root[k]);
    const rows = guide.waypoints.map(w => root(w).concat(w.joints));
    fs.writeFileSync(out + "/path.txt", rows.map(r => r.join(" ") + " \n").join("") + "\n");
    const reversed = guide.waypoints.map(w => root(w).concat([...w.joints].reverse()));
    fs.writeFileSync(out + "/reversed.txt", reversed.map(r => r.join(" ") + " \n").join("") + "\n");
    fs.writeFileSync(out + "/order", [...guide.joint_names].reverse().join(","));
    const robot = {
      joint_trajectory: {joint_names: guide.joint_names, points: guide.waypoints.map(w => ({positions: w.joints}))},
      multi_dof_joint_trajectory: {joint_names: ["world_joint"], points: guide.waypoints.map(w => ({transforms: [{
        translation: {x: w.root.x, y: w.root.y, z: w.root.z},
        rotation: {x: w.root.qx, y: w.root.qy, z: w.root.qz, w: w.root.qw}}]}))}};
    fs.writeFileSync(out + "/trajectory.json", JSON.stringify(robot, null, 1));
    const parts = ["trans_x", "trans_y", "trans_z", "rot_x", "rot_y", "rot_z", "rot_w"].map(p => "floating/" + p);
    fs.writeFileSync(out + "/trajectory.yaml", "joint_names: [" + parts.concat(guide.joint_names).join(", ") +
      "]\npoints:\n" + rows.map(r => "  - positions: [" + r.join(", ") + "]\n").join("") + "---\n");
  ' "$work/guide.json" "$work"
  local file
  report() { "$program" audit "$@" --problem "$room" --format json 2>"$work/err" | grep -v '"path"'; }
  report "$work/path.csv" >"$work/report.csv"
  grep -q '"holds"' "$work/report.csv" || fail "the CSV path has no report"
  for file in path.txt trajectory.json trajectory.yaml; do
    report "$work/$file" >"$work/report"
    cmp -s "$work/report.csv" "$work/report" || fail "$file gives another report than the CSV path"
  done
  grep -q "time stamps" "$work/err" || fail "nothing was said of the time stamps"
  report "$work/reversed.txt" --path-format ompl --joint-order "$(cat "$work/order")" >"$work/report"
  cmp -s "$work/report.csv" "$work/report" || fail "the order of the joints was not followed"
  expect 3 audit "$work/path.txt" --problem "$room" --path-format moveit
  expect 3 audit "$work/path.csv" --problem "$room" --joint-order a
  says "--joint-order"
  expect 3 audit "$work/path.txt" --problem "$room" --root 0,0,1
  says "3 numbers"
  expect 2 audit "$work/path.txt" --problem "$room" --path-format magic
}

section_foreign_path() {
  expect 0 plan "$room" -o "$work/guide.json"
  # The waypoints of a guide, as another program would list them.
  node -e '
    const guide = JSON.parse(require("fs").readFileSync(process.argv[1], "utf8"));
    console.log(["x","y","z","qx","qy","qz","qw"].concat(guide.joint_names).join(","));
    for (const w of guide.waypoints)
      console.log(["x","y","z","qx","qy","qz","qw"].map(k => w.root[k]).concat(w.joints).join(","));
  ' "$work/guide.json" >"$work/path.csv"
  expect 0 audit "$work/path.csv" --problem "$room" --dense 0.005
  expect 3 audit "$work/path.csv" --dense 0.005
  says "--problem"
  same_path_in_other_forms
  # The same path half a metre up: no contact and no balance at any sample.
  awk -F, -v OFS=, 'NR > 1 { $3 += 0.5 } { print }' "$work/path.csv" >"$work/up.csv"
  expect 1 audit "$work/up.csv" --problem "$room" --dense 0.005
  says "balance lost"
  expect 1 audit "$work/up.csv" --problem "$room"
  says "balance is lost"
  expect 1 audit "$work/up.csv" --problem "$room" --format junit
  says 'balance is lost" type="balance">'
  expect 1 audit "$work/up.csv" --problem "$room" --format sarif
  says '"ruleId": "CG004"'
  # And 3 cm down: the feet are in the floor.
  awk -F, -v OFS=, 'NR > 1 { $3 -= 0.03 } { print }' "$work/path.csv" >"$work/down.csv"
  expect 1 audit "$work/down.csv" --problem "$room" --dense 0.005
  says "overlap by about"
  says "floor"
}

section_recorded_motion() {
  # Feet at z = 0, as recordings have them: proved with a skin, and without the report says what to do.
  local recorded=$fixtures/problems/recorded.yaml motion
  sed -e 's/skin_m: 0.001/skin_m: 0/' -e "s|\.\./robots|$fixtures/robots|g" "$recorded" >"$work/bare.yaml"
  for motion in standing squatting; do
    expect 0 audit "$fixtures/paths/$motion.csv" --problem "$recorded"
    says "edges proved for every s"
    says "below the skin of 1 mm"
    expect 1 audit "$fixtures/paths/$motion.csv" --problem "$work/bare.yaml"
    says '"LLEG_JOINT5" and "floor"'
    says "if they are meant to touch, give a contact.skin_m"
    expect 1 audit "$fixtures/paths/$motion.csv" --problem "$work/bare.yaml" --dense 0.05
    says "if they are meant to touch, give a contact.skin_m"
  done
}

# A box of which the centre of mass is exactly over an edge of its support, or over its only point.
box_on_edge() {
  cat >"$work/box.urdf" <<'XML'
<robot name="box"><link name="box">
  <inertial><origin xyz="0.125 0 0.25"/><mass value="2"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  <collision><origin xyz="0 0 0.25"/><geometry><box size="0.25 0.125 0.5"/></geometry></collision>
</link></robot>
XML
  cat >"$work/box.yaml" <<YAML
schema: cguide-problem/1
robot: {urdf: box.urdf}
scene:
  - {name: floor, halfspace: {normal: [0, 0, 1], offset_m: 0}}
contact: {epsilon_m: 0.0625, friction: 0.5, sites: {box: $1}}
sampling:
  position: {box_m: [[-1, -1, 0], [1, 1, 1]]}
  orientation: [{mean_rpy: [0, 0, 0], kappa: 50, weight: 1}]
postures: {upright: {}}
start: {posture: upright, root: {xyz_m: [0, 0, 0.03125], rpy: [0, 0, 0]}}
goal: {posture: upright, root: {xyz_m: [0, 0, 0.03125], rpy: [0, 0, 0]}}
YAML
}

section_boundary() {
  box_on_edge "[[-0.125, -0.0625, 0], [-0.125, 0.0625, 0], [0.125, -0.0625, 0], [0.125, 0.0625, 0]]"
  expect 4 stability "$work/box.yaml" --posture upright
  says "undecided: boundary (rank 6)"
  says "forces that balance it"
  says "supporting wrench"
  says_not "separating wrench"
  expect 4 stability "$work/box.yaml" --posture upright --format json
  says '"reason": "boundary (rank 6)"'
  says '"rank": 6'
  says '"separating_wrench": null'
  says_not '"supporting_wrench": null'
  says_not '"forces": []'
  box_on_edge "[[0.125, 0, 0]]"
  expect 4 stability "$work/box.yaml" --posture upright --format json
  says '"reason": "boundary (rank 3)"'
  says '"rank": 3'
  says '"supporting_wrench": null'
  says_not '"forces": []'
}

section_coms() {
  # The box stands on a rectangle of 250 by 125 mm.
  box_on_edge "[[-0.125, -0.0625, 0], [-0.125, 0.0625, 0], [0.125, -0.0625, 0], [0.125, 0.0625, 0]]"
  printf '0.01,0.02,0.5\n\n 0.02, 0.02,0.5\r\n' >"$work/inside.csv"
  expect 0 stability "$work/box.yaml" --posture upright --coms "$work/inside.csv"
  says "2 centres of mass, 2 statically stable, 0 not, 0 undecided"
  says "[0.02 0.02 0.5] stable"
  printf 'x,y,z\n0.01,0,0.5\n0.125,0,0.5\n' >"$work/coms.csv"
  expect 4 stability "$work/box.yaml" --posture upright --coms "$work/coms.csv"
  says "undecided: "
  printf '0.2,0,0.5\n' >>"$work/coms.csv"
  expect 1 stability "$work/box.yaml" --posture upright --coms "$work/coms.csv" --format json
  says '"schema": "cguide-stability-coms/1"'
  says '"stable": 1'
  says '"unstable": 1'
  says '"undecided": 1'
  says '"verdict": "unstable"'
  expect 3 stability "$work/box.yaml" --coms "$work/absent.csv"
  says absent.csv
  local line
  for line in 1,2 1,2,3,4 1,2,x 1,2,nan 1,2,1e7 "1;2;3" z,y,x; do
    printf '0,0,0.5\n%s\n' "$line" >"$work/bad.csv"
    expect 3 stability "$work/box.yaml" --posture upright --coms "$work/bad.csv"
    says "bad.csv:2: "
    says "write x,y,z in metres, one a line"
  done
  printf 'x,y,z\n' >"$work/bad.csv"
  expect 3 stability "$work/box.yaml" --posture upright --coms "$work/bad.csv"
  says "there is no centre of mass"
}

section_bad_input() {
  # A file name of any bytes is no reason to fail; what is not UTF-8 is replaced in the reports for programs.
  local odd=$work/$'odd\xff.json'
  expect 0 plan "$room" -o "$odd"
  expect 0 audit "$odd" --format json
  says $'odd\xEF\xBF\xBD.json'
  expect 0 audit "$odd" --dense 0.1 --format json
  says $'odd\xEF\xBF\xBD.json'
  expect 0 stability --guide "$odd" --at 0 --format json
  expect 3 plan "$work/absent.yaml" -o "$work/out.json"
  says absent.yaml
  expect 3 plan "$a1" -o "$work/no/such/folder/out.json"
  says "create the folder"
  expect 3 audit "$work/absent.json" --dense 0.1
  expect 3 view "$work/absent.json" -o "$work/page.html"
  local file count=0
  for file in "$fixtures"/bad/problems/*; do
    [ -f "$file" ] || continue
    rm -f "$work/out.json"
    expect 3 plan "$file" -o "$work/out.json" --time-limit 20
    says "$(basename "$file")"
    [ ! -e "$work/out.json" ] || fail "$file: an output was written"
    count=$((count + 1))
  done
  for file in "$fixtures"/bad/guides/*; do
    [ -f "$file" ] || continue
    expect 3 audit "$file" --problem "$a1" --dense 0.1
    says "$(basename "$file")"
    count=$((count + 1))
  done
  for file in "$fixtures"/bad/paths/*.csv "$fixtures"/bad/matrices/*.txt "$fixtures"/bad/trajectories/*.yaml; do
    [ -f "$file" ] || continue
    expect 3 audit "$file" --problem "$a1" --dense 0.1
    says "$(basename "$file")"
    count=$((count + 1))
  done
  [ "$count" -ge 40 ] || fail "only $count bad files were tried"
  # A start deep inside the floor is bad input, and the message says what overlaps.
  sed -e 's/xyz_m: \[0, 0, 0.412\]/xyz_m: [0, 0, 0.2]/' -e "s|\.\./robots|$fixtures/robots|g" "$a1" \
    >"$work/deep.yaml"
  expect 3 plan "$work/deep.yaml" -o "$work/out.json"
  says start
  says overlap
  [ ! -e "$work/out.json" ] || fail "an output was written"
}

"section_$section"
if [ "$failures" -gt 0 ]; then
  echo "$failures failures in $section" >&2
  exit 1
fi
echo "$section: as expected"
