// The strip under the drawing: verdict, CoM margin and clearance over the path's time.
const STRIP = 12;

export class Timeline {
  constructor(canvas, data, theme, onSeek) {
    this.canvas = canvas;
    this.data = data;
    this.theme = theme;
    this.t = 0;
    const {frames} = data;
    // Margin and clearance have scales of their own, left and right, and one common zero.
    this.margin = new Scale(frames.comMargin);
    this.clearance = new Scale(frames.clearance);
    this.below = Math.max(this.margin.below, this.clearance.below);
    const seek = (event) => {
      const box = canvas.getBoundingClientRect();
      onSeek(Math.min(1, Math.max(0, (event.clientX - box.left - this.left) / (box.width - this.left - this.right))));
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    canvas.addEventListener('pointermove', (event) => { if (event.buttons & 1) seek(event); });
    new ResizeObserver(() => this.paint()).observe(canvas);
  }

  get left() { return 52; }
  get right() { return 52; }

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
    this.drawHeld(pen);
    this.drawMarkers(pen);
    this.drawCursor();
  }

  // On whole device pixels, so that neighbours in the strip leave no seam.
  snap(x) { return Math.round(x * this.size.ratio) / this.size.ratio; }
  x(t) { return this.left + t * (this.size.width - this.left - this.right); }
  // Height of a value divided by its scale's top.
  y(share) {
    const up = (Math.min(1, share) + this.below) / (1 + this.below);
    return this.size.bottom - Math.max(0, up) * (this.size.bottom - 12);
  }

  drawAxis(pen) {
    const {theme, size} = this;
    pen.font = '10.5px system-ui, sans-serif';
    pen.textBaseline = 'middle';
    for (const share of [0, this.below > 0 ? -this.below : 0.5, 1]) {
      const y = Math.round(this.y(share)) + 0.5;
      pen.strokeStyle = share === 0 && this.below > 0 ? theme.muted : theme.line;
      pen.beginPath();
      pen.moveTo(this.left, y);
      pen.lineTo(size.width - this.right, y);
      pen.stroke();
      pen.textAlign = 'right';
      pen.fillStyle = theme.margin;
      pen.fillText(this.margin.label(share), this.left - 6, y);
      pen.textAlign = 'left';
      pen.fillStyle = theme.clearance;
      pen.fillText(this.clearance.label(share), size.width - this.right + 6, y);
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
    const trace = (values, top, finish) => {
      let first = -1;
      for (let f = 0; f <= frames.count; ++f) {
        const known = f < frames.count && !Number.isNaN(values[f]);
        if (known && first < 0) {
          first = f;
          pen.beginPath();
          pen.moveTo(this.x(frames.t[f]), this.y(values[f] / top));
        } else if (known) {
          pen.lineTo(this.x(frames.t[f]), this.y(values[f] / top));
        } else if (first >= 0) {
          finish(first, f - 1);
          first = -1;
        }
      }
    };
    pen.lineJoin = 'round';
    pen.lineWidth = 1.5;
    trace(frames.comMargin, this.margin.top, (first, last) => {
      pen.strokeStyle = pen.fillStyle = theme.margin;
      pen.stroke();
      pen.lineTo(this.x(frames.t[last]), this.y(0));
      pen.lineTo(this.x(frames.t[first]), this.y(0));
      pen.globalAlpha = 0.2;
      pen.fill();
      pen.globalAlpha = 1;
    });
    pen.strokeStyle = theme.clearance;
    trace(frames.clearance, this.clearance.top, () => pen.stroke());
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

  // A line over the strip along the edges that hold as a whole.
  drawHeld(pen) {
    const {held, waypoints} = this.data;
    pen.fillStyle = this.theme.ink;
    held.forEach((holds, edge) => {
      if (!holds) return;
      const from = this.snap(this.x(waypoints[edge])), to = this.snap(this.x(waypoints[edge + 1] ?? 1));
      pen.fillRect(from, this.size.height - STRIP - 2, Math.max(2.5, to - from), 2);
    });
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

// A round top that most values stay below, and the room below zero as a share of it.
class Scale {
  constructor(run) {
    const values = Array.from(run).filter(Number.isFinite).sort((a, b) => a - b);
    const negative = values.filter((value) => value < 0);
    const positive = values.filter((value) => value > 0);
    this.known = values.length > 0;
    const goal = positive.length ? positive[Math.floor(0.98 * (positive.length - 1))] : 0.1;
    const power = 10 ** Math.floor(Math.log10(goal));
    this.top = power * [1, 2, 4, 6, 8, 10].find((k) => k * power >= goal * 0.999);
    // Enough to read a label, at most as much as above zero.
    this.below = negative.length ? Math.min(1, Math.max(0.3, -negative[0] / this.top)) : 0;
  }

  label(share) {
    if (!this.known) return '';
    const value = share * this.top;
    if (value === 0) return '0';
    return this.top < 0.0995 ? Number((1000 * value).toPrecision(2)) + ' mm' : Number(value.toPrecision(2)) + ' m';
  }
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
