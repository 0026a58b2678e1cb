// ---- The strip: angles above, ground acceleration below; drawn once, the cursor every time.

let drawnStrip = null;
const LEFT = 12, RIGHT = 12, TOP = 18, AXIS = 18;
const stripX = (t, width) => LEFT + (width - LEFT - RIGHT) * (end > start ? (t - start) / (end - start) : 0);

function largest(lists) {
  let size = 0;
  for (const list of lists) if (list) for (const value of list) size = Math.max(size, Math.abs(value));
  return size;
}

function short(value) { return String(Number(value.toPrecision(3))); }

function drawStripOnce() {
  const { width, height } = sharp(strip);
  const canvas = document.createElement("canvas");
  canvas.width = strip.width;
  canvas.height = strip.height;
  const c = canvas.getContext("2d"), ratio = window.devicePixelRatio || 1;
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  const shaken = run.ax || run.ay, floor = height - AXIS;
  const split = shaken ? TOP + 0.58 * (floor - TOP) : floor;
  // Angles of a fall leave the strip.
  const curve = (list, middle, reach, size) => {
    if (!list || !(size > 0)) return;
    c.save();
    c.beginPath();
    c.rect(0, middle - reach - 1, width, 2 * reach + 2);
    c.clip();
    c.beginPath();
    for (let frame = 0; frame <= last; frame++) {
      const share = Math.max(-2, Math.min(2, list[frame] / size));
      const [px, py] = [stripX(times[frame], width), middle - reach * share];
      frame ? c.lineTo(px, py) : c.moveTo(px, py);
    }
    c.stroke();
    c.restore();
  };
  const words = (text, x, y, align = "left") => {
    c.font = "12px system-ui, sans-serif";
    c.textAlign = align;
    c.textBaseline = "alphabetic";
    c.lineWidth = 3;
    c.strokeStyle = ink.sky;
    c.strokeText(text, x, y);
    c.fillStyle = ink.muted;
    c.fillText(text, x, y);
  };
  // Impacts, ticks at the top edge.
  c.strokeStyle = "#e8462a";
  c.globalAlpha = .7;
  c.lineWidth = 1;
  c.beginPath();
  for (const { t, kind } of run.events) {
    if (!strikes(kind)) continue;
    c.moveTo(stripX(t, width), 0);
    c.lineTo(stripX(t, width), 5);
  }
  c.stroke();
  c.globalAlpha = 1;
  const middle = (TOP + split) / 2, reach = (split - TOP) / 2 - 2, size = Math.min(largest(run.theta), run.angles ?? Infinity);
  c.strokeStyle = ink.rule;
  c.lineWidth = 1;
  c.beginPath();
  c.moveTo(LEFT, middle);
  c.lineTo(width - RIGHT, middle);
  c.stroke();
  c.lineJoin = "round";
  for (let block = 0; block < N; block++) {
    const { colour, dashes } = curveOf(block);
    c.strokeStyle = colour;
    c.setLineDash(dashes);
    c.lineWidth = 1.6;
    curve(run.theta[block], middle, reach, size);
  }
  c.setLineDash([]);
  if (shaken) {
    const centre = (split + floor) / 2 + 2, half = (floor - split) / 2 - 4, peak = largest([run.ax, run.ay]);
    c.strokeStyle = ink.rule;
    c.beginPath();
    c.moveTo(LEFT, centre);
    c.lineTo(width - RIGHT, centre);
    c.stroke();
    c.lineWidth = 1.1;
    c.strokeStyle = ink.muted;
    c.setLineDash([3, 3]);
    curve(run.ay, centre, half, peak);
    c.setLineDash([]);
    c.strokeStyle = ink.ink;
    curve(run.ax, centre, half, peak);
    const vertical = run.ay ? " (vertical dashed)" : "";
    words(`ground ±${short(peak / run.gravity)} g${vertical}`, width - RIGHT, split + 10, "right");
  }
  words(size > 0 ? `angles ±${short(size)} rad` : "angles: all zero", width - RIGHT, TOP - 4, "right");
  // Time.
  const span = end - start, steps = Math.max(2, Math.floor(width / 90));
  const raw = span / steps, power = 10 ** Math.floor(Math.log10(raw > 0 ? raw : 1));
  const step = [1, 2, 5, 10].map(one => one * power).find(one => one >= raw) || 1;
  for (let count = Math.ceil(start / step); count * step <= end + 1e-9 * step; count++) {
    const px = stripX(count * step, width), label = short(count * step);
    const align = px < 20 ? "left" : px > width - 30 ? "right" : "center";
    words(count * step + step > end ? `${label} s` : label, px, height - 5, align);
    if (span === 0) break;
  }
  drawnStrip = canvas;
}

function drawStrip(state) {
  const { context: c, width, height } = sharp(strip);
  // A page that is hidden has no room; it is drawn when it is shown.
  if (!strip.width || !strip.height) return;
  if (!drawnStrip) drawStripOnce();
  c.clearRect(0, 0, width, height);
  c.drawImage(drawnStrip, 0, 0, width, height);
  const px = stripX(state.t, width);
  c.strokeStyle = ink.accent;
  c.lineWidth = 2;
  c.beginPath();
  c.moveTo(px, 0);
  c.lineTo(px, height - AXIS);
  c.stroke();
  c.fillStyle = ink.accent;
  c.beginPath();
  c.arc(px, height - AXIS, 4, 0, 2 * Math.PI);
  c.fill();
}
