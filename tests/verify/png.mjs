// Reads PNG files of 8-bit RGB or RGBA without interlace: what browsers write.
import {inflateSync} from 'node:zlib';

export function readPng(file) {
  const width = file.readUInt32BE(16), height = file.readUInt32BE(20);
  const [depth, type, , , interlace] = file.subarray(24, 29);
  if (depth !== 8 || (type !== 2 && type !== 6) || interlace) throw new Error('not a plain 8-bit RGB image');
  const data = [];
  for (let at = 8; at < file.length;) {
    const length = file.readUInt32BE(at);
    if (file.toString('latin1', at + 4, at + 8) === 'IDAT') data.push(file.subarray(at + 8, at + 8 + length));
    at += 12 + length;
  }
  const channels = type === 2 ? 3 : 4;
  return new Picture(width, height, channels, unfilter(inflateSync(Buffer.concat(data)), width, height, channels));
}

// Undoes the five filters [PNG, section 9].
function unfilter(raw, width, height, channels) {
  const row = width * channels;
  const out = new Uint8Array(row * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (row + 1)];
    for (let i = 0; i < row; ++i) {
      const a = i >= channels ? out[y * row + i - channels] : 0;
      const b = y > 0 ? out[(y - 1) * row + i] : 0;
      const c = y > 0 && i >= channels ? out[(y - 1) * row + i - channels] : 0;
      const guess = [0, a, b, (a + b) >> 1, paeth(a, b, c)][filter];
      out[y * row + i] = raw[y * (row + 1) + 1 + i] + guess;
    }
  }
  return out;
}

function paeth(a, b, c) {
  const [pa, pb, pc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

class Picture {
  constructor(width, height, channels, bytes) { Object.assign(this, {width, height, channels, bytes}); }

  at(x, y) {
    const i = (y * this.width + x) * this.channels;
    return Array.from(this.bytes.subarray(i, i + 3));
  }
  * pixels({left, top, right, bottom}) {
    for (let y = top; y < bottom; ++y) for (let x = left; x < right; ++x) yield this.at(x, y);
  }
  colours(box) {
    const seen = new Set();
    for (const [r, g, b] of this.pixels(box)) seen.add(r << 16 | g << 8 | b);
    return seen.size;
  }
  // Share of the box's pixels that differ by more than a shade.
  difference(other, box) {
    let count = 0, all = 0;
    const theirs = other.pixels(box);
    for (const [r, g, b] of this.pixels(box)) {
      const [r2, g2, b2] = theirs.next().value;
      all += 1;
      if (Math.abs(r - r2) + Math.abs(g - g2) + Math.abs(b - b2) > 24) count += 1;
    }
    return count / all;
  }
}
