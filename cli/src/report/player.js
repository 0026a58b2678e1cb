// Plays a run: the column on a canvas, its curves on another, and the controls.
//
// What `#run` holds (lengths N per block or interface, base first; F frames in order of time, an event twice: before, after):
//   blocks [[b, h]] half-sizes m; contact [c] half-widths m; gravity m/s²; fills per link
//   patterns [{signs, text, mode, mirrored, link}]; events [{t, kind, at: interfaces
//   from 0, mode after}]
//   t [F] s; theta [N][F] rad, clockwise positive; omega [N][F] rad/s; pattern [F] index
//   ax, ay, dx, dy [F] ground acceleration m/s² and displacement m, null where there is none
//
// Address: ?t=3.2 starts there, paused; ?play=1 plays; ?speed=, ?angles= choose; ?show=animation leaves the rest out;
// window.rocking.at(t) tells what is shown at t, at true size. On <html>: data-done once something is drawn, data-t the time
// drawn, data-theta its angles, data-ended at the end of playing, data-error where a script failed.
"use strict";
(() => {
const page = document.documentElement;
window.addEventListener("error", event => { page.dataset.error = event.message; });

const run = JSON.parse(document.getElementById("run").textContent);
const N = run.blocks.length, times = run.t, last = times.length - 1;
const start = times[0], end = times[last];
const address = new URLSearchParams(location.search);
const element = id => document.getElementById(id);
const calm = matchMedia("(prefers-reduced-motion: reduce)");

// ---- The state at a time.

// The last index of an ascending list whose entry is not above the value; -1 if there is none.
function lastNotAbove(list, value, time = entry => entry) {
  let low = -1, high = list.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (time(list[middle]) <= value) low = middle; else high = middle - 1;
  }
  return low;
}

// Frame and share of the way to the next. Of two frames of an event the later one counts, so no interval has an event inside.
function placeOf(t) {
  const frame = Math.max(0, lastNotAbove(times, t));
  const step = frame < last ? times[frame + 1] - times[frame] : 0;
  return { frame, step, share: step > 0 ? Math.min(1, Math.max(0, (t - times[frame]) / step)) : 0 };
}

function linear(list, { frame, share }) {
  if (!list) return 0;
  return share > 0 ? list[frame] + share * (list[frame + 1] - list[frame]) : list[frame];
}

// Angles at a place: those of the frame, or the cubic through both frames with their rates. Between coarse frames the cubic may
// cross where the blocks cannot: there they touch.
function anglesAt({ frame, step, share: s }) {
  if (s === 0) return run.theta.map(list => list[frame]);
  const r = 1 - s, signs = run.patterns[run.pattern[frame]].signs;
  let below = 0;
  return run.theta.map((list, block) => {
    const rate = run.omega[block];
    let angle = r * r * (1 + 2 * s) * list[frame] + s * s * (3 - 2 * s) * list[frame + 1]
      + step * s * r * (r * rate[frame] - s * rate[frame + 1]);
    if (signs[block] === 0 && block > 0 || signs[block] * (angle - below) < 0) angle = below;
    return below = angle;
  });
}

function stateAt(t) {
  const place = placeOf(t);
  return {
    t, theta: anglesAt(place), pattern: run.patterns[run.pattern[place.frame]],
    ground: [linear(run.dx, place), linear(run.dy, place)],
    acceleration: [linear(run.ax, place), linear(run.ay, place)],
  };
}

// Corners of the blocks (bottom left, bottom right, top right, top left) and pivots, the origin at the centre of the base on the
// ground. Interface i pivots s_i c_i from the centre of its contact, in the axes of the block below.
function outlines(theta, signs) {
  const turn = (angle, u, v) => [u * Math.cos(angle) + v * Math.sin(angle), v * Math.cos(angle) - u * Math.sin(angle)];
  let centre = [0, 0], below = 0;
  return run.blocks.map(([b, h], i) => {
    const own = theta[i], offset = signs[i] * run.contact[i];
    const from = (point, u, v) => { const [x, y] = turn(own, u, v); return [point[0] + x, point[1] + y]; };
    const [px, py] = turn(below, offset, 0);
    const pivot = [centre[0] + px, centre[1] + py];
    const base = signs[i] === 0 ? centre : from(pivot, -offset, 0);
    const contact = [-1, 1].map(side => { const [x, y] = turn(below, side * run.contact[i], 0); return [centre[0] + x, centre[1] + y]; });
    const corners = [[-b, 0], [b, 0], [b, 2 * h], [-b, 2 * h]].map(([u, v]) => from(base, u, v));
    centre = from(base, 0, 2 * h);
    below = own;
    return { corners, pivot: signs[i] === 0 ? null : pivot, contact };
  });
}

// Each opening enlarged, up to a radian: larger ones stay as they are.
function enlarged(theta, factor) {
  let below = 0, drawn = 0;
  return theta.map(angle => {
    const opening = angle - below, size = Math.abs(opening);
    below = angle;
    drawn += Math.sign(opening) * Math.max(size, Math.min(factor * size, 1));
    return drawn;
  });
}

function nameOf(pattern) {
  if (pattern.mode === null) return "at rest";
  return `mode ${pattern.mode}` + (pattern.mirrored ? ", mirrored" : "");
}

window.rocking = {
  at(t) {
    const state = stateAt(t);
    return {
      t, theta: state.theta, corners: outlines(state.theta, state.pattern.signs).map(block => block.corners),
      pattern: state.pattern.text, mode: state.pattern.mode === null ? "rest" : state.pattern.mode,
      ground: state.ground,
    };
  },
  seek: t => seek(t), play: () => play(), pause: () => pause(),
};

// ---- Pictures.

const ink = {};
function readColours() {
  const style = getComputedStyle(page);
  for (const name of ["ink", "muted", "rule", "accent", "bad", "sky", "card"]) ink[name] = style.getPropertyValue("--" + name).trim();
}
// Curves per block: Okabe and Ito's colours (2008), and dashes for those who do not tell them apart.
const CURVES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3], [12, 4], [4, 4]];

let factor = 1, speed = 1, now = start, playing = false;
let view = { scale: 1, left: 0, top: 0, follow: 0 };

// Nice factors of enlargement; automatic: the largest that keeps the lean of the column below a quarter of a radian.
const FACTORS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
function automatic() {
  let peak = 0;
  for (const list of run.theta) for (const angle of list) peak = Math.max(peak, Math.abs(angle));
  return peak > 0 ? FACTORS.filter(one => one * peak <= 0.25).pop() || 1 : 1;
}

function sharp(canvas) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { context, width, height };
}

// Places looked at to frame the view.
const LOOKED_AT = 500;
const MARGIN = 18, GROUND_DEPTH = 34;

// All of the motion in the picture, as far as that leaves the column large; where the ground goes far, the view goes with it.
function frameView() {
  const { width, height } = sharp(stage);
  const tall = 2 * run.blocks.reduce((sum, [, h]) => sum + h, 0), wide = Math.max(...run.blocks.map(([b]) => b));
  let [low, high, up] = [-1.6 * wide, 1.6 * wide, tall], ground = [0, 0];
  const step = Math.max(1, Math.floor(last / LOOKED_AT));
  for (let frame = 0; frame <= last; frame += step) {
    const theta = enlarged(run.theta.map(list => list[frame]), factor);
    for (const { corners } of outlines(theta, run.patterns[run.pattern[frame]].signs)) {
      for (const [x, y] of corners) { low = Math.min(low, x); high = Math.max(high, x); up = Math.max(up, y); }
    }
    if (run.dx) ground = [Math.min(ground[0], run.dx[frame]), Math.max(ground[1], run.dx[frame])];
  }
  const span = ground[1] - ground[0], free = 0.5 * tall;
  const follow = span > free ? 1 - free / span : 0;
  low += (1 - follow) * ground[0];
  high += (1 - follow) * ground[1];
  const room = height - GROUND_DEPTH - MARGIN;
  const fitting = Math.min(room / up, (width - 2 * MARGIN) / (high - low));
  const scale = Math.max(fitting, 0.62 * Math.min(room / tall, (width - 2 * MARGIN) / (3.2 * wide)));
  // A column that falls beyond the picture falls to one side: the other side keeps its base.
  let centre = 0.5 * (low + high);
  const half = 0.5 * width / scale - 2 * wide;
  centre = Math.max(-half, Math.min(half, centre));
  view = { scale, left: 0.5 * width - scale * centre, bottom: height - GROUND_DEPTH, follow };
}

const stage = element("stage"), strip = element("strip");

function drawStage(state) {
  const { context: c, width, height } = sharp(stage);
  const [gx, gy] = state.ground, { scale, left, bottom, follow } = view;
  const shift = gx * (1 - follow);
  const x = value => left + scale * (value + shift), y = value => bottom - scale * (value + gy);
  c.clearRect(0, 0, width, height);
  c.lineJoin = c.lineCap = "round";

  // Where the base stood at first.
  c.strokeStyle = ink.rule;
  c.lineWidth = 1;
  c.setLineDash([2, 5]);
  c.beginPath();
  c.moveTo(left - scale * gx * follow, 6);
  c.lineTo(left - scale * gx * follow, bottom + 16);
  c.stroke();
  c.setLineDash([]);

  // The ground, hatched; the hatching moves with it.
  const level = y(0), gap = 14, offset = ((left + scale * shift) % gap + gap) % gap;
  c.strokeStyle = ink.muted;
  c.lineWidth = 1;
  c.beginPath();
  for (let place = offset - 2 * gap; place < width + 2 * gap; place += gap) {
    c.moveTo(place, level + 1);
    c.lineTo(place - 10, level + 12);
  }
  c.stroke();
  c.strokeStyle = ink.ink;
  c.lineWidth = 1.6;
  c.beginPath();
  c.moveTo(0, level);
  c.lineTo(width, level);
  c.stroke();
  // The mark on the ground under the centre of the base.
  c.fillStyle = ink.ink;
  c.beginPath();
  c.moveTo(x(0), level + 3);
  c.lineTo(x(0) - 5, level + 13);
  c.lineTo(x(0) + 5, level + 13);
  c.fill();

  const { signs, link } = state.pattern;
  const blocks = outlines(enlarged(state.theta, factor), signs);
  blocks.forEach((block, i) => drawDrum(c, block.corners.map(([u, v]) => [x(u), y(v)]), run.fills[link[i]], i + 1));
  // Closed interfaces between blocks: the line between the two gives way to dashes.
  blocks.forEach((block, i) => {
    if (block.pivot || i === 0) return;
    const [from, to] = block.contact.map(([u, v]) => [x(u), y(v)]);
    const line = (style, width, dash) => {
      c.strokeStyle = style;
      c.lineWidth = width;
      c.setLineDash(dash);
      c.beginPath();
      c.moveTo(...from);
      c.lineTo(...to);
      c.stroke();
    };
    c.lineCap = "butt";
    line(run.fills[link[i]], 2.5, []);
    line("#222", 1.2, [4, 4]);
    c.setLineDash([]);
    c.lineCap = "round";
  });
  drawImpact(c, state.t, blocks, x, y);
  for (const { pivot } of blocks) {
    if (!pivot) continue;
    c.beginPath();
    c.arc(x(pivot[0]), y(pivot[1]), 4.5, 0, 2 * Math.PI);
    c.fillStyle = "#111";
    c.fill();
    c.strokeStyle = "#fff";
    c.lineWidth = 1.5;
    c.stroke();
  }
  drawScaleBar(c, width, height);
}

// A drum: outline, shade of a cylinder, flutes, number.
function drawDrum(c, corners, fill, number) {
  const [a, b, d, e] = corners;
  const outline = () => {
    c.beginPath();
    corners.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y));
    c.closePath();
  };
  outline();
  c.fillStyle = fill;
  c.fill();
  const shade = c.createLinearGradient(a[0], a[1], b[0], b[1]);
  [[0, .26], [.18, .06], [.42, 0], [.7, .05], [1, .3]].forEach(([at, dark]) => shade.addColorStop(at, `rgba(20,20,30,${dark})`));
  c.fillStyle = shade;
  c.fill();
  const width = Math.hypot(b[0] - a[0], b[1] - a[1]), height = Math.hypot(e[0] - a[0], e[1] - a[1]);
  if (width > 36) {
    c.strokeStyle = "rgba(20,20,30,.14)";
    c.lineWidth = 1;
    c.beginPath();
    for (let flute = 1; flute < 8; flute++) {
      const share = 0.5 - 0.5 * Math.cos(Math.PI * flute / 8);
      c.moveTo(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]));
      c.lineTo(e[0] + share * (d[0] - e[0]), e[1] + share * (d[1] - e[1]));
    }
    c.stroke();
  }
  outline();
  c.strokeStyle = "#222";
  c.lineWidth = 1.5;
  c.stroke();
  if (height > 18 && width > 18) {
    const [mx, my] = [(a[0] + d[0]) / 2, (a[1] + d[1]) / 2];
    c.font = "600 13px system-ui, sans-serif";
    c.textAlign = "center";
    c.textBaseline = "middle";
    c.fillStyle = "rgba(255,255,255,.75)";
    c.beginPath();
    c.arc(mx, my, 10, 0, 2 * Math.PI);
    c.fill();
    c.fillStyle = "#222";
    c.fillText(number, mx, my + .5);
  }
}

// How long an impact is seen, in seconds of the viewer.
const FLASH = 0.2;

function drawImpact(c, t, blocks, x, y) {
  const reach = FLASH * speed, seen = new Set();
  for (let i = eventAt(t); i >= 0 && t - run.events[i].t < reach; i--) {
    const { kind, at, t: when } = run.events[i];
    if (kind !== "impact") continue;
    const age = (t - when) / reach;
    for (const joint of at) {
      // Of a joint that chatters, the last impact.
      if (seen.has(joint)) continue;
      seen.add(joint);
      const [from, to] = blocks[joint].contact.map(([u, v]) => [x(u), y(v)]);
      c.globalAlpha = calm.matches ? 1 : 1 - age;
      c.strokeStyle = "#e8462a";
      c.lineWidth = calm.matches ? 4 : 6 - 4 * age;
      c.beginPath();
      c.moveTo(...from);
      c.lineTo(...to);
      c.stroke();
      if (!calm.matches) {
        c.lineWidth = 2;
        for (const [px, py] of [from, to]) {
          c.beginPath();
          c.arc(px, py, 5 + 16 * age, 0, 2 * Math.PI);
          c.stroke();
        }
      }
      c.globalAlpha = 1;
    }
  }
}

function drawScaleBar(c, width, height) {
  const metres = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].filter(one => one * view.scale <= 110).pop();
  if (!metres) return;
  const length = metres * view.scale, y = height - 9, x = width - 14 - length;
  c.strokeStyle = c.fillStyle = ink.muted;
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(x, y - 4); c.lineTo(x, y); c.lineTo(x + length, y); c.lineTo(x + length, y - 4);
  c.stroke();
  c.font = "12px system-ui, sans-serif";
  c.textAlign = "right";
  c.textBaseline = "alphabetic";
  c.fillText(`${metres} m`, x - 6, y + 1);
}

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
  const curve = (list, middle, reach, size) => {
    if (!list || !(size > 0)) return;
    c.beginPath();
    for (let frame = 0; frame <= last; frame++) {
      const [px, py] = [stripX(times[frame], width), middle - reach * list[frame] / size];
      frame ? c.lineTo(px, py) : c.moveTo(px, py);
    }
    c.stroke();
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
    if (kind !== "impact") continue;
    c.moveTo(stripX(t, width), 0);
    c.lineTo(stripX(t, width), 5);
  }
  c.stroke();
  c.globalAlpha = 1;
  const middle = (TOP + split) / 2, reach = (split - TOP) / 2 - 2, size = largest(run.theta);
  c.strokeStyle = ink.rule;
  c.lineWidth = 1;
  c.beginPath();
  c.moveTo(LEFT, middle);
  c.lineTo(width - RIGHT, middle);
  c.stroke();
  c.lineJoin = "round";
  for (let block = 0; block < N; block++) {
    c.strokeStyle = CURVES[block % CURVES.length];
    c.setLineDash(DASHES[block % DASHES.length]);
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

// ---- Words.

const readouts = [...document.querySelectorAll(".readout output")];
const signed = (value, digits) => (value < 0 ? "\u2212" : "+") + Math.abs(value).toFixed(digits);
const WORDS = { start: "starts to move", opening: "opening", impact: "impact", jump: "the ground jumps" };
const text = (target, value) => { if (target.textContent !== value) target.textContent = value; };
const eventAt = t => lastNotAbove(run.events, t, event => event.t);

function tell(state) {
  text(element("clock"), `t = ${state.t.toFixed(3)} s`);
  text(element("mode"), nameOf(state.pattern));
  text(element("pattern"), state.pattern.text.replaceAll("-", "\u2212"));
  text(element("scale"), factor === 1 ? "angles as they are" : `angles drawn ×${factor}`);
  const index = eventAt(state.t), event = run.events[index];
  const where = event && event.at.length ? `, interface\u00a0${event.at.map(one => one + 1).join(", ")}` : "";
  text(element("event"), event
    ? `${index + 1} of ${run.events.length}: ${WORDS[event.kind]} at ${event.t.toFixed(4)} s${where}, then ${event.mode === "rest" ? "rest" : "mode\u00a0" + event.mode}`
    : run.events.length ? `${run.events.length} events to come` : "No events in this run");
  for (const output of readouts) {
    const angle = state.theta[output.dataset.block - 1];
    text(output, `${signed(angle, 5)} rad = ${signed(angle * 180 / Math.PI, 3)}°`);
  }
}

function draw() {
  const state = stateAt(now);
  drawStage(state);
  drawStrip(state);
  tell(state);
  scrub.value = now;
  scrub.setAttribute("aria-valuetext", `${now.toFixed(2)} seconds, ${nameOf(state.pattern)}`);
  page.dataset.t = now;
  page.dataset.theta = JSON.stringify(state.theta);
}

// ---- Time.

let before = null;

function seek(t) {
  now = Math.min(end, Math.max(start, Number.isFinite(t) ? t : start));
  delete page.dataset.ended;
  draw();
}

// A tab that was hidden goes on where it was.
const LONGEST_STEP = 0.1;

function tick(stamp) {
  if (!playing) return;
  const elapsed = before === null ? 0 : Math.min(LONGEST_STEP, (stamp - before) / 1000);
  before = stamp;
  now = Math.min(end, now + speed * elapsed);
  draw();
  if (now >= end) {
    pause();
    page.dataset.ended = "true";
    return;
  }
  requestAnimationFrame(tick);
}

function play() {
  if (playing) return;
  if (now >= end) seek(start);
  playing = true;
  before = null;
  showPlaying();
  requestAnimationFrame(tick);
}

function pause() {
  playing = false;
  showPlaying();
}

function showPlaying() {
  element("player").classList.toggle("playing", playing);
  element("play").setAttribute("aria-label", playing ? "Pause" : "Play");
}

// Another time than now among the frames or the events, before or after.
function stepFrame(direction) {
  pause();
  let frame = lastNotAbove(times, now);
  if (direction < 0) {
    while (frame > 0 && times[frame] >= now) frame--;
  } else {
    while (frame < last && times[frame] <= now) frame++;
  }
  seek(times[Math.max(0, frame)]);
}

function stepEvent(direction) {
  pause();
  let index = eventAt(now);
  if (direction < 0) {
    while (index >= 0 && run.events[index].t >= now) index--;
    seek(index < 0 ? start : run.events[index].t);
  } else {
    seek(index + 1 < run.events.length ? run.events[index + 1].t : end);
  }
}

// ---- Controls.

const scrub = element("scrub"), speeds = element("speed"), factors = element("exaggeration");
scrub.min = start;
scrub.max = end > start ? end : start + 1;
scrub.disabled = !(end > start);

function setSpeed() { speed = Number(speeds.value); }
function setFactor() {
  factor = factors.value === "auto" ? automatic() : Number(factors.value);
  frameView();
}
function changeSpeed(direction) {
  speeds.selectedIndex = Math.min(speeds.length - 1, Math.max(0, speeds.selectedIndex + direction));
  setSpeed();
}

element("play").addEventListener("click", () => playing ? pause() : play());
element("less").addEventListener("click", () => stepFrame(-1));
element("more").addEventListener("click", () => stepFrame(1));
element("back").addEventListener("click", () => stepEvent(-1));
element("next").addEventListener("click", () => stepEvent(1));
speeds.addEventListener("change", setSpeed);
factors.addEventListener("change", () => { setFactor(); draw(); });
scrub.addEventListener("input", () => { pause(); seek(scrub.valueAsNumber); });

let dragged = false;
const pointed = event => {
  const box = strip.getBoundingClientRect();
  seek(start + (end - start) * (event.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT));
};
strip.addEventListener("pointerdown", event => {
  dragged = true;
  strip.setPointerCapture(event.pointerId);
  pause();
  pointed(event);
});
strip.addEventListener("pointermove", event => { if (dragged) pointed(event); });
for (const kind of ["pointerup", "pointercancel"]) strip.addEventListener(kind, () => { dragged = false; });

// Keys work in the player, and on the page while the player is in sight and nothing else has the focus.
let inSight = false;
new IntersectionObserver(entries => { inSight = entries[entries.length - 1].isIntersecting; }, { threshold: .4 })
  .observe(element("player"));
document.addEventListener("keydown", event => {
  const target = event.target, inPlayer = element("player").contains(target);
  if (event.ctrlKey || event.metaKey || event.altKey || target.tagName === "SELECT") return;
  if (!inPlayer && !(inSight && target === document.body)) return;
  const actions = {
    " ": () => playing ? pause() : play(),
    ArrowLeft: () => event.shiftKey ? stepEvent(-1) : stepFrame(-1),
    ArrowRight: () => event.shiftKey ? stepEvent(1) : stepFrame(1),
    "+": () => changeSpeed(1), "=": () => changeSpeed(1), "-": () => changeSpeed(-1),
  };
  // Home and End go to the ends of the page unless the player has the focus.
  if (inPlayer) Object.assign(actions, { Home: () => { pause(); seek(start); }, End: () => { pause(); seek(end); } });
  const action = actions[event.key];
  // A button has its own way with the space bar.
  if (!action || event.key === " " && target.tagName === "BUTTON") return;
  event.preventDefault();
  action();
});

// ---- Beginning.

document.querySelectorAll(".readout li").forEach(item => {
  const block = item.querySelector("output").dataset.block - 1, path = item.querySelector("path");
  path.style.stroke = CURVES[block % CURVES.length];
  path.setAttribute("stroke-dasharray", DASHES[block % DASHES.length].join(" "));
});
function choose(list, value) {
  if (value !== null && [...list.options].some(option => option.value === value)) list.value = value;
}
choose(speeds, address.get("speed"));
choose(factors, address.get("angles"));
if (address.get("show") === "animation") page.classList.add("still");
function layOut() {
  readColours();
  drawnStrip = null;
  frameView();
  draw();
}
readColours();
setSpeed();
setFactor();
if (address.has("t")) now = Math.min(end, Math.max(start, Number(address.get("t")) || start));
layOut();
const sizes = new ResizeObserver(layOut);
sizes.observe(stage);
sizes.observe(strip);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", layOut);
window.addEventListener("beforeprint", () => {
  document.querySelectorAll("details").forEach(one => { one.open = true; });
  page.classList.add("printing");
  layOut();
});
window.addEventListener("afterprint", () => {
  page.classList.remove("printing");
  layOut();
});
page.dataset.done = "true";
if (address.get("play") === "1") play();
})();
