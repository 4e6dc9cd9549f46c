// The strip under the drawing: verdict, CoM margin and clearance over the path's time.
const STRIP = 12;

export class Timeline {
  constructor(canvas, data, theme, onSeek) {
    this.canvas = canvas;
    this.data = data;
    this.theme = theme;
    this.t = 0;
    const {frames} = data;
    const values = [...frames.comMargin, ...frames.clearance].filter(Number.isFinite);
    this.top = scaleOf(values.filter((value) => value > 0));
    const below = values.filter((value) => value < 0).map((value) => -value);
    // Room below zero where something is violated: enough to read its label, at most as much as above.
    this.low = below.length ? -Math.min(this.top, Math.max(this.top / 4, scaleOf(below))) : 0;
    const seek = (event) => {
      const box = canvas.getBoundingClientRect();
      onSeek(Math.min(1, Math.max(0, (event.clientX - box.left - this.left) / (box.width - this.left - 1))));
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    canvas.addEventListener('pointermove', (event) => { if (event.buttons & 1) seek(event); });
    new ResizeObserver(() => this.paint()).observe(canvas);
  }

  get left() { return 52; }

  setTheme(theme) {
    this.theme = theme;
    this.paint();
  }

  show(t) {
    this.t = t;
    this.canvas.setAttribute('aria-valuenow', t.toFixed(3));
    this.drawCursor();
  }

  // The chart is painted once and kept; the cursor is drawn over a copy of it.
  paint() {
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (width === 0) return;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.chart = document.createElement('canvas');
    this.chart.width = this.canvas.width;
    this.chart.height = this.canvas.height;
    const pen = this.chart.getContext('2d');
    pen.scale(ratio, ratio);
    this.size = {width, height, ratio, bottom: height - STRIP - 4};
    this.drawAxis(pen);
    this.drawCurves(pen);
    this.drawStrip(pen);
    this.drawMarkers(pen);
    this.drawCursor();
  }

  // On whole device pixels, so that neighbours in the strip leave no seam.
  snap(x) { return Math.round(x * this.size.ratio) / this.size.ratio; }
  x(t) { return this.left + t * (this.size.width - this.left - 1); }
  y(value) {
    const share = (value - this.low) / (this.top - this.low);
    return this.size.bottom - Math.min(1, Math.max(0, share)) * (this.size.bottom - 12);
  }

  drawAxis(pen) {
    const {theme, size} = this;
    pen.font = '10.5px system-ui, sans-serif';
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    for (const value of [0, this.low < 0 ? this.low : this.top / 2, this.top]) {
      const y = Math.round(this.y(value)) + 0.5;
      pen.strokeStyle = value === 0 && this.low < 0 ? theme.muted : theme.line;
      pen.beginPath();
      pen.moveTo(this.left, y);
      pen.lineTo(size.width, y);
      pen.stroke();
      pen.fillStyle = theme.muted;
      const text = value === 0 ? '0' : Math.max(this.top, -this.low) < 0.0995 ? Number((1000 * value).toPrecision(3)) + ' mm' : Number(value.toPrecision(3)) + ' m';
      pen.fillText(text, this.left - 6, y);
    }
    pen.strokeStyle = theme.line;
    for (const t of this.data.waypoints) {
      const x = Math.round(this.x(t)) - 0.5;
      pen.beginPath();
      pen.moveTo(x, size.bottom);
      pen.lineTo(x, size.bottom - 4);
      pen.stroke();
    }
  }

  drawCurves(pen) {
    const {frames} = this.data;
    const {theme} = this;
    const trace = (values, finish) => {
      let first = -1;
      for (let f = 0; f <= frames.count; ++f) {
        const known = f < frames.count && !Number.isNaN(values[f]);
        if (known && first < 0) {
          first = f;
          pen.beginPath();
          pen.moveTo(this.x(frames.t[f]), this.y(values[f]));
        } else if (known) {
          pen.lineTo(this.x(frames.t[f]), this.y(values[f]));
        } else if (first >= 0) {
          finish(first, f - 1);
          first = -1;
        }
      }
    };
    pen.lineJoin = 'round';
    pen.lineWidth = 1.5;
    trace(frames.comMargin, (first, last) => {
      pen.strokeStyle = pen.fillStyle = theme.margin;
      pen.stroke();
      pen.lineTo(this.x(frames.t[last]), this.y(0));
      pen.lineTo(this.x(frames.t[first]), this.y(0));
      pen.globalAlpha = 0.2;
      pen.fill();
      pen.globalAlpha = 1;
    });
    pen.strokeStyle = theme.clearance;
    trace(frames.clearance, () => pen.stroke());
  }

  // Each frame colours the strip half-way to its neighbours, and nothing beyond the first and last.
  drawStrip(pen) {
    const {frames} = this.data;
    const y = this.size.height - STRIP;
    const edge = (f) => (frames.t[Math.max(0, f - 1)] + frames.t[Math.min(f, frames.count - 1)]) / 2;
    for (const name of ['holds', 'undecided', 'fails']) {
      for (let f = 0; f < frames.count; ++f) {
        if (frames.verdictName(f) !== name) continue;
        let end = f;
        while (end + 1 < frames.count && frames.verdict[end + 1] === frames.verdict[f] && name !== 'holds') ++end;
        const from = this.snap(this.x(edge(f)));
        // A single failing instant stays visible however long the path is.
        const wide = Math.max(name === 'holds' && frames.count > 1 ? 0 : 2.5, this.snap(this.x(edge(end + 1))) - from);
        this.fillStrip(pen, name, f, from, y, wide);
        f = end;
      }
    }
  }

  fillStrip(pen, name, frame, x, y, wide) {
    const {theme} = this;
    pen.fillStyle = theme[name];
    if (name === 'undecided') {
      pen.fillStyle = theme.panel;
      pen.fillRect(x, y, wide, STRIP);
      pen.fillStyle = hatch(pen, theme.undecided);
    }
    // A thinner margin gives a paler green.
    const margin = this.data.frames.comMargin[frame];
    if (name === 'holds') {
      pen.fillStyle = theme.panel;
      pen.fillRect(x, y, wide, STRIP);
      pen.fillStyle = theme.holds;
      pen.globalAlpha = Number.isNaN(margin) ? 0.8 : 0.38 + 0.62 * Math.min(1, Math.max(0, margin / 0.05));
    }
    pen.fillRect(x, y, wide, STRIP);
    pen.globalAlpha = 1;
  }

  drawMarkers(pen) {
    pen.fillStyle = this.theme.ink;
    for (const instant of this.data.worst) {
      const x = this.x(instant.t);
      pen.beginPath();
      pen.moveTo(x - 4, 1);
      pen.lineTo(x + 4, 1);
      pen.lineTo(x, 8);
      pen.fill();
    }
  }

  drawCursor() {
    if (!this.chart) return;
    const pen = this.canvas.getContext('2d');
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.chart, 0, 0);
    pen.scale(this.size.ratio, this.size.ratio);
    const x = this.x(this.t);
    pen.fillStyle = this.theme.ink;
    pen.fillRect(x - 0.75, 0, 1.5, this.size.height);
    pen.beginPath();
    pen.arc(x, this.size.bottom + 2, 4, 0, 2 * Math.PI);
    pen.fill();
  }
}

// The smallest round number that most of the values, all positive, stay below.
function scaleOf(values) {
  const sorted = values.slice().sort((a, b) => a - b);
  const goal = sorted.length ? sorted[Math.floor(0.98 * (sorted.length - 1))] : 0.1;
  const power = 10 ** Math.floor(Math.log10(goal));
  return power * [1, 2, 4, 6, 8, 10].find((k) => k * power >= goal * 0.999);
}

function hatch(pen, colour) {
  const tile = document.createElement('canvas');
  tile.width = tile.height = 6;
  const ink = tile.getContext('2d');
  ink.strokeStyle = colour;
  ink.lineWidth = 1.8;
  for (const shift of [-6, 0, 6]) {
    ink.moveTo(shift - 1, 7);
    ink.lineTo(shift + 7, -1);
  }
  ink.stroke();
  return pen.createPattern(tile, 'repeat');
}
