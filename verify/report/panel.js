// The panel's reading of the instant that is shown, and the table of worst instants.
const WORDS = {holds: 'sampled: holds', fails: 'fails', undecided: 'undecided'};

export function metres(value) {
  if (!Number.isFinite(value)) return 'n/a';
  if (Math.abs(value) < 0.0995) {
    const mm = 1000 * value;
    return (Math.abs(mm) < 0.1 && mm !== 0 ? mm.toPrecision(2) : mm.toFixed(1)) + ' mm';
  }
  return value.toFixed(3) + ' m';
}

export class Panel {
  constructor(data, onSeek) {
    this.data = data;
    this.rows = Array.from(document.querySelectorAll('#worst tbody tr[data-frame]'));
    for (const row of this.rows) {
      const go = () => onSeek(Number(row.dataset.frame));
      row.addEventListener('click', go);
      row.addEventListener('keydown', (event) => { if (event.key === 'Enter') go(); });
    }
  }

  show(frame) {
    const {frames} = this.data;
    const verdict = frames.verdictName(frame);
    const set = (id, text) => { document.getElementById(id).textContent = text; };
    document.getElementById('now').dataset.now = verdict;
    set('now-verdict', WORDS[verdict]);
    set('now-where', `${frames.edge[frame]} \u00b7 ${Number(frames.s[frame].toFixed(4))}`);
    set('now-margin', metres(frames.comMargin[frame]));
    set('now-clearance', metres(frames.clearance[frame]));
    set('now-contacts', this.contactText(frame));
    set('now-note', frames.notes[frame]);
    set('where', `t ${frames.t[frame].toFixed(3)} \u2002 instant ${frame + 1} of ${frames.count}`);
    for (const row of this.rows) row.classList.toggle('current', Number(row.dataset.frame) === frame);
  }

  // "2 on floor (LFOOT, RFOOT)": grouped by object, each body once.
  contactText(frame) {
    const groups = new Map();
    for (const {body, object} of this.data.frames.contacts(frame)) {
      if (!groups.has(object)) groups.set(object, {count: 0, bodies: new Set()});
      const group = groups.get(object);
      group.count += 1;
      group.bodies.add(this.data.bodies[body].name);
    }
    const texts = Array.from(groups, ([object, {count, bodies}]) =>
      `${count} on ${this.data.objects[object].name} (${Array.from(bodies).join(', ')})`);
    return texts.join('; ') || 'none';
  }

  nextWorst(frame) {
    const stops = Array.from(new Set(this.rows.map((row) => Number(row.dataset.frame)))).sort((a, b) => a - b);
    if (stops.length === 0) return frame;
    const later = stops.find((stop) => stop > frame);
    return later === undefined ? stops[0] : later;
  }
}
