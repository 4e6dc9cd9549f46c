// Puts the page together: data, drawing, timeline, panel, keys, and the address's fragment.
import {readPageData, surveyMotion} from './data.js';
import {nameOnHover} from './hover.js';
import {Panel} from './panel.js';
import {VIEWS} from './projection.js';
import {SvgView} from './svg_view.js';
import {onThemeChange, readTheme} from './theme.js';
import {Timeline} from './timeline.js';
import {WebglView} from './webgl_view.js';

const root = document.documentElement;
root.dataset.errors = '0';
window.addEventListener('error', () => { root.dataset.errors = String(Number(root.dataset.errors) + 1); });

const SHOWS = {ghosts: false, trail: true, cones: true, xray: false};
const data = readPageData();
const {frames} = data;
const stage = document.getElementById('stage');
const state = {t: 0, frame: 0, playing: false, speed: 1, view: 'iso', ...SHOWS};

// Half a metre (or radian) of the path's metric a second, within reason.
const duration = Math.min(60, Math.max(3, data.length / 0.5));

function openView() {
  const survey = surveyMotion(data);
  try {
    return new WebglView(stage, data, survey, readTheme());
  } catch (error) {
    return new SvgView(stage, data, survey, readTheme());
  }
}
const view = openView();
const panel = new Panel(data, (frame) => goTo(frame));
const timeline = new Timeline(document.getElementById('timeline'), data, readTheme(), (t) => goTo(frames.nearest(t)));

function publish() {
  const {frame} = state;
  Object.assign(root.dataset, {
    t: state.t.toFixed(6), frame, edge: frames.edge[frame], s: frames.s[frame],
    now: frames.verdictName(frame), view: state.view, renderer: view.name, playing: state.playing ? 1 : 0,
  });
}

function show() {
  view.show(state);
  timeline.show(state.t);
  if (state.shownFrame !== state.frame) panel.show(state.shownFrame = state.frame);
  publish();
}

// Shows an instant that was sampled, not something between two.
function goTo(frame) {
  pause();
  state.frame = Math.min(frames.count - 1, Math.max(0, frame));
  state.t = frames.t[state.frame];
  remember();
  show();
}

function setView(name) {
  state.view = name;
  view.setView(name);
  for (const button of document.querySelectorAll('button[data-view]')) {
    button.setAttribute('aria-pressed', String(button.dataset.view === name));
  }
  publish();
}

function toggle(name, on) {
  state[name] = on;
  document.querySelector(`[data-show="${name}"]`).setAttribute('aria-pressed', String(on));
  show();
}

let clock = 0;
function tick(now) {
  if (!state.playing) return;
  // A frame's time stamp may lie before the press of the button; a sleeping tab must not leap ahead.
  state.t += state.speed * Math.min(0.1, Math.max(0, (now - clock) / 1000)) / duration;
  clock = now;
  const end = frames.t[frames.count - 1];
  if (state.t >= end) {
    state.t = end;
    pause();
  }
  state.frame = frames.nearest(state.t);
  show();
  requestAnimationFrame(tick);
}

function play() {
  if (frames.count < 2) return;
  if (state.t >= frames.t[frames.count - 1]) state.t = frames.t[0];
  state.playing = true;
  clock = performance.now();
  drawButton();
  requestAnimationFrame(tick);
}

function pause() {
  state.playing = false;
  drawButton();
}

function drawButton() {
  const button = document.getElementById('play');
  button.textContent = state.playing ? '\u275a\u275a' : '\u25b6';
  button.setAttribute('aria-label', state.playing ? 'Pause' : 'Play');
  publish();
}

// The address names the instant, so that a link to it can be passed on.
let remembering = 0;
function remember() {
  clearTimeout(remembering);
  remembering = setTimeout(() => {
    const parts = [`t=${Number(state.t.toFixed(5))}`];
    if (VIEWS[state.view]) parts.push(`view=${state.view}`);
    for (const name of Object.keys(SHOWS)) if (state[name] !== SHOWS[name]) parts.push(`${name}=${state[name] ? 1 : 0}`);
    try { history.replaceState(null, '', '#' + parts.join('&')); } catch (error) { /* some viewers forbid it */ }
  }, 400);
}

function obeyFragment() {
  const wish = new URLSearchParams(location.hash.slice(1));
  for (const name of Object.keys(SHOWS)) if (wish.has(name)) toggle(name, wish.get(name) !== '0');
  if (Object.prototype.hasOwnProperty.call(VIEWS, wish.get('view'))) setView(wish.get('view'));
  const t = parseFloat(wish.get('t'));
  if (Number.isFinite(t)) {
    pause();
    state.frame = frames.nearest(Math.min(1, Math.max(0, t)));
    state.t = frames.t[state.frame];
  }
  show();
  if (wish.get('play') === '1') play();
}

const KEYS = {
  ' ': () => state.playing ? pause() : play(),
  ArrowLeft: (event) => goTo(state.frame - (event.shiftKey ? 10 : 1)),
  ArrowRight: (event) => goTo(state.frame + (event.shiftKey ? 10 : 1)),
  Home: () => goTo(0),
  End: () => goTo(frames.count - 1),
  n: () => goTo(panel.nextWorst(state.frame)),
  1: () => setView('front'), 2: () => setView('side'), 3: () => setView('top'), 4: () => setView('iso'),
  g: () => toggle('ghosts', !state.ghosts), t: () => toggle('trail', !state.trail),
  c: () => toggle('cones', !state.cones), x: () => toggle('xray', !state.xray),
};

function listen() {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(SELECT|INPUT)$/.test(event.target.tagName)) return;
    const action = KEYS[event.key] || KEYS[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
  const click = (id, call) => document.getElementById(id).addEventListener('click', (event) => {
    call();
    // Or else the space bar would press the button again.
    event.currentTarget.blur();
  });
  click('play', () => state.playing ? pause() : play());
  click('back', () => goTo(state.frame - 1));
  click('forward', () => goTo(state.frame + 1));
  document.getElementById('speed').addEventListener('change', (event) => {
    state.speed = Number(event.target.value);
    event.target.blur();
  });
  for (const button of document.querySelectorAll('button[data-view]')) {
    button.addEventListener('click', () => { setView(button.dataset.view); remember(); button.blur(); });
  }
  for (const button of document.querySelectorAll('[data-show]')) {
    button.addEventListener('click', () => { toggle(button.dataset.show, !state[button.dataset.show]); remember(); button.blur(); });
  }
  window.addEventListener('hashchange', obeyFragment);
  view.onUserMove(() => {
    state.view = 'free';
    for (const button of document.querySelectorAll('button[data-view]')) button.setAttribute('aria-pressed', 'false');
    publish();
  });
  onThemeChange(() => {
    view.setTheme(readTheme());
    timeline.setTheme(readTheme());
  });
  nameOnHover(stage, view);
}

view.onDrawn = () => {
  root.dataset.ready = '1';
  view.onDrawn = () => {};
};
listen();
setView(view.name === 'svg' ? 'side' : 'iso');
for (const name of Object.keys(SHOWS)) toggle(name, SHOWS[name]);
obeyFragment();
