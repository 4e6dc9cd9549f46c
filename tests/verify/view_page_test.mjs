// node view_page_test.mjs BROWSER VIEW_DEMO FOLDER
// Loads the demonstration page in a headless browser and checks what it draws and how it answers.
import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

import {readPng} from './png.mjs';

const [browser, viewDemo, folder] = process.argv.slice(2);
const FLAGS = ['--headless', '--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-quic',
  '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--host-resolver-rules=MAP * ~NOTFOUND', '--enable-logging=stderr', '--window-size=1000,600'];

function browse(flags, file, fragment) {
  const profile = mkdtempSync(join(tmpdir(), 'cguide-view-'));
  try {
    const run = spawnSync(browser, [...FLAGS, `--user-data-dir=${profile}`, ...flags, `file://${file}${fragment}`],
        {encoding: 'utf8', maxBuffer: 1 << 28, timeout: 120000});
    assert.equal(run.status, 0, `the browser ended with ${run.status ?? run.signal}: ${run.stderr}`);
    // Notes of the graphics driver about its own speed are no errors of the page.
    const complaints = run.stderr.split('\n').filter((line) => line.includes(':CONSOLE') && !line.includes('GL Driver Message'));
    assert.deepEqual(complaints, [], 'the console stays silent');
    return run.stdout;
  } finally {
    rmSync(profile, {recursive: true, force: true, maxRetries: 5, retryDelay: 200});
  }
}

function state(dom) {
  const out = {};
  for (const [, name, value] of dom.match(/<html[^>]*>/)[0].matchAll(/data-(\w+)="([^"]*)"/g)) out[name] = value;
  return out;
}
const load = (file, fragment = '', flags = [], budget = 4000) =>
  browse(['--dump-dom', `--virtual-time-budget=${budget}`, ...flags], file, fragment);

// A copy of the page whose clock and frames are the page's own: the browser's frames come late, or not at all,
// on a loaded machine, while timers keep to the virtual time. Each frame takes 50 ms by decree.
function withDecreedFrames(page, name, script = '') {
  const file = join(folder, name);
  const decree = () => {
    let now = 0;
    performance.now = () => now;
    window.requestAnimationFrame = (call) => setTimeout(() => call(now += 50), 0);
  };
  const html = readFileSync(page, 'utf8')
      .replace('</head>', () => `<script nonce="page">(${decree})()</script></head>`)
      .replace('</body>', () => `<script nonce="page">${script}</script></body>`);
  writeFileSync(file, html);
  return file;
}

// The frame that should be shown at t, worked out from the page's own numbers.
function nearestFrame(file, t) {
  const html = readFileSync(file, 'utf8');
  const part = (id) => html.split(`id="${id}">`)[1].split('</script>')[0];
  const [first, count] = JSON.parse(part('page-data')).frames.t;
  const bytes = Buffer.from(part('page-blob'), 'base64');
  const times = Array.from({length: count}, (_, i) => bytes.readFloatLE(4 * (first + i)));
  const gaps = times.map((time) => Math.abs(time - t));
  return {frame: gaps.indexOf(Math.min(...gaps)), times};
}

const tests = {
  'the fragment chooses instant and view': (page) => {
    const {frame, times} = nearestFrame(page, 0.5);
    const seen = state(load(page, '#t=0.5&view=side'));
    assert.equal(seen.ready, '1');
    assert.equal(seen.errors, '0');
    assert.equal(seen.renderer, 'webgl');
    assert.equal(seen.view, 'side');
    assert.equal(Number(seen.frame), frame);
    assert.ok(Math.abs(Number(seen.t) - times[frame]) < 1e-6);
    assert.ok(frame > 5 && frame < times.length - 5, 'the middle is in the middle');
  },

  'nonsense in the fragment shows the start': (page) => {
    const seen = state(load(page, '#t=soon&view=__proto__&ghosts'));
    assert.deepEqual([seen.ready, seen.frame, seen.view, seen.errors], ['1', '0', 'iso', '0']);
  },

  'playing reaches the end and stops there': (page) => {
    const file = withDecreedFrames(page, 'view_page_played.html');
    const seen = state(load(file, '#play=1', ['--disable-3d-apis'], 30000));
    assert.deepEqual([Number(seen.frame), seen.playing, seen.errors], [Number(seen.frames) - 1, '0', '0']);
    assert.equal(Number(seen.t), Number(nearestFrame(page, 1).times.pop().toFixed(6)));
    const paused = state(load(file, '#t=0.3', ['--disable-3d-apis'], 30000));
    assert.equal(Number(paused.frame), nearestFrame(page, 0.3).frame);
  },

  'keys, table, timeline and links lead to their instants': (page) => {
    const driver = () => {
      const root = document.documentElement, out = {};
      const note = (name) => { out[name] = Number(root.dataset.frame); };
      const press = (key, more) => document.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, ...more}));
      press('ArrowRight'); note('right');
      press('ArrowRight', {shiftKey: true}); note('ten');
      press('ArrowLeft'); note('left');
      press('End'); note('end');
      press('ArrowRight'); note('beyond');
      press('Home'); note('home');
      press('n'); note('worst');
      document.querySelector('#worst tbody tr:last-child').click(); note('row');
      const strip = document.getElementById('timeline'), box = strip.getBoundingClientRect();
      strip.setPointerCapture = () => {};
      strip.dispatchEvent(new PointerEvent('pointerdown', {clientX: box.right - 1, clientY: box.top + 5, bubbles: true})); note('strip');
      press('2'); out.view = root.dataset.view;
      press('x'); out.xray = document.querySelector('[data-show=xray]').getAttribute('aria-pressed');
      document.querySelector('button[data-view=top]').click(); out.button = root.dataset.view;
      out.note = document.getElementById('now-contacts').textContent;
      out.requests = performance.getEntriesByType('resource').length;
      const stage = document.getElementById('stage').getBoundingClientRect();
      const canvas = document.querySelector('#stage > canvas');
      canvas.dispatchEvent(new PointerEvent('pointermove',
          {clientX: stage.left + stage.width / 2, clientY: stage.top + stage.height / 2, bubbles: true}));
      // The name appears with the next frame, after the view chosen above is drawn.
      setTimeout(() => {
        out.hover = document.getElementById('tooltip').textContent;
        root.dataset.driven = btoa(unescape(encodeURIComponent(JSON.stringify(out))));
      }, 500);
    };
    const file = withDecreedFrames(page, 'view_page_driven.html', `setTimeout(${driver}, 500)`);
    const seen = state(load(file, '#t=0', [], 20000));
    const out = JSON.parse(Buffer.from(seen.driven, 'base64').toString());
    const last = Number(seen.frames) - 1;
    assert.deepEqual([out.right, out.ten, out.left, out.end, out.beyond, out.home], [1, 11, 10, last, last, 0]);
    const rows = [...readFileSync(page, 'utf8').matchAll(/<tr data-frame="(\d+)"/g)].map((match) => Number(match[1]));
    assert.equal(out.worst, Math.min(...rows.filter((row) => row > 0)));
    assert.equal(out.row, rows[rows.length - 1]);
    assert.equal(out.strip, last);
    assert.deepEqual([out.view, out.xray, out.button], ['side', 'true', 'top']);
    assert.match(out.note, /8 on floor \(left_foot, right_foot\)/);
    assert.equal(out.requests, 0);
    assert.match(out.hover, /pelvis|chest|head|thigh|arm|floor|chair/);
  },

  'hostile names are shown, not obeyed': () => {
    const file = join(folder, 'view_page_hostile.html');
    execFileSync(viewDemo, [file, '--hostile']);
    const dom = load(file, '#t=0.5');
    const seen = state(dom);
    assert.deepEqual([seen.ready, seen.errors, seen.hacked], ['1', '0', undefined]);
    assert.ok(!dom.includes('<img'));
    assert.match(dom, /id="now-contacts">8 on &lt;\/script&gt;&lt;img src=x/);
  },

  'without WebGL a flat drawing stands in': (page) => {
    const dom = load(page, '#t=0.5&view=front', ['--disable-3d-apis']);
    const seen = state(dom);
    assert.deepEqual([seen.ready, seen.errors, seen.renderer, seen.view], ['1', '0', 'svg', 'front']);
    assert.equal(Number(seen.frame), nearestFrame(page, 0.5).frame);
    const polygons = dom.match(/<polygon points="[^"]{20,}"/g) || [];
    assert.ok(polygons.length > 35, `${polygons.length} outlines`);
    assert.ok(!/NaN/.test(dom.slice(dom.indexOf('<svg'), dom.indexOf('</svg>'))));
    assert.match(dom, /<title>left_foot<\/title>/);
  },

  'the picture has content and follows the time': (page) => {
    const shoot = (name, fragment, flags = []) => {
      const out = join(folder, name);
      browse([`--screenshot=${out}`, '--virtual-time-budget=4000', ...flags], page, fragment);
      return readPng(readFileSync(out));
    };
    // The part of the window that only the drawing fills.
    const stage = {left: 20, top: 110, right: 700, bottom: 440};
    const start = shoot('view_page_start.png', '#t=0&view=side');
    const end = shoot('view_page_end.png', '#t=1&view=side');
    assert.deepEqual([start.width, start.height], [1000, 600]);
    assert.ok(start.colours(stage) > 1500, `${start.colours(stage)} colours`);
    const changed = start.difference(end, stage);
    assert.ok(changed > 0.03 && changed < 0.6, `${changed} of the picture changed`);
    const [r, g, b] = start.at(900, 590);
    const dark = shoot('view_page_dark.png', '#t=0&view=side', ['--blink-settings=preferredColorScheme=0']);
    const [dr, dg, db] = dark.at(900, 590);
    assert.ok(r + g + b > 600 && dr + dg + db < 150, 'the panel follows the colour scheme');
  },
};

const page = join(folder, 'view_page.html');
execFileSync(viewDemo, [page]);
let failures = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    test(page);
    console.log(`ok      ${name}`);
  } catch (error) {
    failures += 1;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
process.exit(failures > 0 ? 1 : 0);
