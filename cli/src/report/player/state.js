// Plays a run: the column on a canvas, its curves on another, and the controls.
//
// What `#run` holds (lengths N per block or interface, base first; F frames in order of time, two of each event, before and after; where
// there are more than 2000 events, those within a millisecond have two in common, before the first and after the last):
//   blocks [[half-widths of base and top, half-height]] m; round [whether a drum]; contact [[half-length, centre on the lower face, on the upper face]] m; gravity m/s²; fills per link
//   angles rad, the largest that the curves show, null for all
//   patterns [{signs, text, mode, mirrored, link}]; rest, the name of the mode without open interfaces; events [{t, kind, at: interfaces from 0, mode and mirrored after}]
//   t [F] s; theta [N][F] rad, clockwise positive; omega [N][F] rad/s; pattern [F] index
//   joints [N][3][F] m, null where nothing slides or flies: a, c, b; the middle of the face below to that of the block's base is (a, c) in the axes
//   of the block below and then (b, 0) in its own
//   ax, ay, dx, dy [F] ground acceleration m/s² and displacement m, null where there is none
//
// Address: ?t=3.2 starts there, paused; ?play=1 plays; ?speed=, ?angles= choose; ?show=animation leaves the rest out;
// window.rocking.at(t) tells what is shown at t, at true size. On <html>: data-done once something is drawn, data-t the time
// drawn, data-theta its angles, data-ended at the end of playing, data-error where a script failed.
//
// One module of four files: state.js (this one: the run, and its state at a time), stage.js (the column), strip.js (its curves),
// controls.js (words, time, controls, and where all begins).
const page = document.documentElement;
window.addEventListener("error", event => { page.dataset.error = event.message; });

const run = JSON.parse(document.getElementById("run").textContent);
const N = run.blocks.length, times = run.t, last = times.length - 1;
const start = times[0], end = times[last];
const address = new URLSearchParams(location.search);
const element = id => document.getElementById(id);
const calm = matchMedia("(prefers-reduced-motion: reduce)");

// Height of a block above its contact from which on it counts as flying, in m; joints are written to a tenth of it.
const FLIES = 5e-6;

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

// Frame and share of the way to the next. Of two frames of an event the later one counts, so that no interval has an event inside, but for the events of a
// millisecond that have their two frames in common.
function placeOf(t) {
  const frame = Math.max(0, lastNotAbove(times, t));
  const step = frame < last ? times[frame + 1] - times[frame] : 0;
  return { frame, step, share: step > 0 ? Math.min(1, Math.max(0, (t - times[frame]) / step)) : 0 };
}

function linear(list, { frame, share }) {
  if (!list) return 0;
  return share > 0 ? list[frame] + share * (list[frame + 1] - list[frame]) : list[frame];
}

// Whether a block flies above the one below in the interval that begins with a frame.
const isInFlight = (block, frame) => run.joints !== null && [frame, frame + 1].some(at => run.joints[block][1][at] > FLIES);

// Angles at a place: those of the frame, or the cubic through both frames with their rates. Between coarse frames the cubic may
// cross where the blocks cannot: there they touch, unless they fly.
function anglesAt({ frame, step, share: s }) {
  if (s === 0) return run.theta.map(list => list[frame]);
  const r = 1 - s, signs = run.patterns[run.pattern[frame]].signs;
  let below = 0;
  return run.theta.map((list, block) => {
    const rate = run.omega[block];
    let angle = r * r * (1 + 2 * s) * list[frame] + s * s * (3 - 2 * s) * list[frame + 1]
      + step * s * r * (r * rate[frame] - s * rate[frame + 1]);
    if (!isInFlight(block, frame) && (signs[block] === 0 && block > 0 || signs[block] * (angle - below) < 0)) angle = below;
    return below = angle;
  });
}

// Where blocks stand on each other at a place, null where nothing slides or flies. The joints of a flying block are those of the lower of its corners:
// where that changes between two frames, the joint of the later one is that of the earlier corner.
function jointsAt(place) {
  const { frame, share } = place;
  return run.joints && run.joints.map((parts, block) => {
    const [here, there] = [frame, frame + 1].map(at => at <= last ? run.patterns[run.pattern[at]].signs[block] : 0);
    if (share === 0 || here === there || !isInFlight(block, frame)) return parts.map(list => linear(list, place));
    const angle = run.theta[block][frame + 1] - (block > 0 ? run.theta[block - 1][frame + 1] : 0);
    const [from, to] = [frame, frame + 1].map(at => parts.map(list => list[at]));
    const moved = to[2] - from[2], next = [to[0] + moved * Math.cos(angle), to[1] - moved * Math.sin(angle), from[2]];
    return from.map((value, part) => value + share * (next[part] - value));
  });
}

function stateAt(t) {
  const place = placeOf(t);
  return {
    t, theta: anglesAt(place), pattern: run.patterns[run.pattern[place.frame]],
    joints: jointsAt(place), ground: [linear(run.dx, place), linear(run.dy, place)],
    acceleration: [linear(run.ax, place), linear(run.ay, place)],
  };
}

// Corners of the blocks (bottom left, bottom right, top right, top left), and per interface its contact, its state (closed, on a pivot, or apart) and
// its pivot, the origin at the centre of the base on the ground. Interface i pivots s_i c_i from the centre of its contact, in the axes of the block below; where there are joints, at (a, c).
function outlines(theta, signs, joints) {
  const turn = (angle, u, v) => [u * Math.cos(angle) + v * Math.sin(angle), v * Math.cos(angle) - u * Math.sin(angle)];
  // Middle of the face below, and its angle.
  let face = [0, 0], below = 0;
  return run.blocks.map(([bottom, top, h], i) => {
    const own = theta[i];
    let [half, onLower, onUpper] = run.contact[i], offset = signs[i] * half, rise = 0, way = -offset - onUpper;
    if (joints) {
      const [a, c, b] = joints[i], reach = i > 0 ? run.blocks[i - 1][1] : Infinity, slide = a + b;
      const [left, right] = [Math.max(-reach, slide - bottom), Math.min(reach, slide + bottom)];
      [half, onLower, rise, way] = [(right - left) / 2, (left + right) / 2, c, b];
      offset = a - onLower;
    }
    const from = (point, u, v) => { const [x, y] = turn(own, u, v); return [point[0] + x, point[1] + y]; };
    const onFace = (u, v = 0) => { const [x, y] = turn(below, u, v); return [face[0] + x, face[1] + y]; };
    const pivot = onFace(onLower + offset, rise);
    const contact = [-1, 1].map(side => onFace(onLower + side * half));
    const base = from(pivot, way, 0);
    const corners = [[-bottom, 0], [bottom, 0], [top, 2 * h], [-top, 2 * h]].map(([u, v]) => from(base, u, v));
    face = from(base, 0, 2 * h);
    below = own;
    const state = signs[i] === 0 ? "closed" : rise > FLIES ? "apart" : "pivot";
    return { corners, pivot: state === "pivot" ? pivot : null, contact, state };
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
  if (pattern.mode === null || pattern.mode === "rest") return run.rest;
  return `mode ${pattern.mode}` + (pattern.mirrored ? ", mirrored" : "");
}

window.rocking = {
  at(t) {
    const state = stateAt(t), blocks = outlines(state.theta, state.pattern.signs, state.joints);
    return {
      t, theta: state.theta, corners: blocks.map(block => block.corners), interfaces: blocks.map(block => block.state),
      pattern: state.pattern.text, mode: state.pattern.mode === null ? "rest" : state.pattern.mode,
      ground: state.ground,
    };
  },
  seek: t => seek(t), play: () => play(), pause: () => pause(),
};
