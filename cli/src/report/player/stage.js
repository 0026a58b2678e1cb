// ---- The stage: the column, its pivots and impacts, the ground.

const ink = {};
function readColours() {
  const style = getComputedStyle(page);
  for (const name of ["ink", "muted", "rule", "accent", "bad", "sky", "card"]) ink[name] = style.getPropertyValue("--" + name).trim();
}
// Curves per block as in the figures below (plot/style.rs), black as the ink of the page: Okabe and Ito's colours (2008), and
// dashes for those who do not tell them apart. Beyond the seventh, colours come again with the dashes of their neighbours.
const CURVES = ["#0072b2", "#d55e00", null, "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const DASHES = [[], [8, 5], [1.5, 5], [9, 4.5, 1.5, 4.5], [15, 5], [4.5, 4.5], [9, 4, 1.5, 4, 1.5, 4]];
const curveOf = block => ({
  colour: CURVES[block % CURVES.length] || ink.ink,
  dashes: DASHES[(block + Math.floor(block / CURVES.length)) % DASHES.length],
});

let factor = 1, speed = 1, now = start, playing = false;
// px per m; where the ground's origin is at first [px]; shares of its motion with which the view goes, [x, y].
let view = { scale: 1, left: 0, bottom: 0, follow: [0, 0] };

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
// How far the ground may go in the picture, right and up, in heights of the column; beyond, the view goes with it.
const FREE = [0.5, 0.15];

// All of the motion in the picture, as far as that leaves the column large; where the ground goes far, the view goes with it.
function frameView() {
  const { width, height } = sharp(stage);
  const tall = 2 * run.blocks.reduce((sum, [, , h]) => sum + h, 0), wide = Math.max(...run.blocks.map(([bottom, top]) => Math.max(bottom, top)));
  let [low, high, up] = [-1.6 * wide, 1.6 * wide, tall];
  const ground = [[0, 0], [0, 0]];
  const step = Math.max(1, Math.floor(last / LOOKED_AT));
  for (let frame = 0; frame <= last; frame += step) {
    const theta = enlarged(run.theta.map(list => list[frame]), factor);
    for (const { corners } of outlines(theta, run.patterns[run.pattern[frame]].signs, jointsAt({ frame, share: 0 }))) {
      for (const [x, y] of corners) { low = Math.min(low, x); high = Math.max(high, x); up = Math.max(up, y); }
    }
    [run.dx, run.dy].forEach((list, axis) => {
      if (list) ground[axis] = [Math.min(ground[axis][0], list[frame]), Math.max(ground[axis][1], list[frame])];
    });
  }
  const follow = ground.map(([from, to], axis) => {
    const span = to - from, free = FREE[axis] * tall;
    return span > free ? 1 - free / span : 0;
  });
  low += (1 - follow[0]) * ground[0][0];
  high += (1 - follow[0]) * ground[0][1];
  const [down, rise] = ground[1].map(end => (1 - follow[1]) * end);
  const room = height - GROUND_DEPTH - MARGIN;
  // Blocks that are thrown fit in their flight; a column that falls may leave the picture to the side.
  const above = room / (up + rise - down), beside = (width - 2 * MARGIN) / (high - low);
  const scale = Math.min(above, Math.max(beside, 0.62 * Math.min(room / tall, (width - 2 * MARGIN) / (3.2 * wide))));
  // A column that falls beyond the picture falls to one side: the other side keeps its base.
  let centre = 0.5 * (low + high);
  const half = Math.max(0, 0.5 * width / scale - 2 * wide);
  centre = Math.max(-half, Math.min(half, centre));
  view = { scale, left: 0.5 * width - scale * centre, bottom: height - GROUND_DEPTH + scale * down, follow };
}

const stage = element("stage"), strip = element("strip");

function drawStage(state) {
  const { context: c, width, height } = sharp(stage);
  const [gx, gy] = state.ground, { scale, left, bottom, follow } = view;
  const shift = gx * (1 - follow[0]), lift = gy * (1 - follow[1]);
  const x = value => left + scale * (value + shift), y = value => bottom - scale * (value + lift);
  c.clearRect(0, 0, width, height);
  c.lineJoin = c.lineCap = "round";

  // Where the base stood at first.
  c.strokeStyle = ink.rule;
  c.lineWidth = 1;
  c.setLineDash([2, 5]);
  c.beginPath();
  c.moveTo(left - scale * gx * follow[0], 6);
  c.lineTo(left - scale * gx * follow[0], height - GROUND_DEPTH + 16);
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
  const blocks = outlines(enlarged(state.theta, factor), signs, state.joints);
  blocks.forEach((block, i) => drawBlock(c, block.corners.map(([u, v]) => [x(u), y(v)]), run.fills[link[i]], i + 1, run.round[i]));
  // Closed interfaces between blocks: the line between the two gives way to dashes.
  blocks.forEach((block, i) => {
    if (block.state !== "closed" || i === 0) return;
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

// A block: outline, number; of a drum the shade of a cylinder and flutes, of a prism a flat face with a bevel.
function drawBlock(c, corners, fill, number, round) {
  const [a, b, d, e] = corners;
  const outline = () => {
    c.beginPath();
    corners.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y));
    c.closePath();
  };
  outline();
  c.fillStyle = fill;
  c.fill();
  const width = Math.hypot(b[0] - a[0], b[1] - a[1]), height = Math.hypot(e[0] - a[0], e[1] - a[1]);
  if (round) drawRoundness(c, corners, width);
  else drawBevel(c, corners, Math.min(5, 0.12 * width, 0.12 * height));
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

// The face of a prism: a line within its edge.
function drawBevel(c, corners, depth) {
  const middle = [0, 1].map(axis => corners.reduce((sum, corner) => sum + corner[axis], 0) / corners.length);
  c.strokeStyle = "rgba(20,20,30,.2)";
  c.lineWidth = 1;
  c.beginPath();
  corners.forEach(([x, y], i) => {
    const away = Math.hypot(x - middle[0], y - middle[1]) || 1, share = Math.max(0, 1 - depth * Math.SQRT2 / away);
    const at = [middle[0] + share * (x - middle[0]), middle[1] + share * (y - middle[1])];
    i ? c.lineTo(...at) : c.moveTo(...at);
  });
  c.closePath();
  c.stroke();
}

// Shade of a cylinder, and flutes; within the outline.
function drawRoundness(c, [a, b, d, e], width) {
  const shade = c.createLinearGradient(a[0], a[1], b[0], b[1]);
  [[0, .26], [.18, .06], [.42, 0], [.7, .05], [1, .3]].forEach(([at, dark]) => shade.addColorStop(at, `rgba(20,20,30,${dark})`));
  c.fillStyle = shade;
  c.fill();
  if (width <= 36) return;
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

// How long an impact is seen, in seconds of the viewer.
const FLASH = 0.2;

function drawImpact(c, t, blocks, x, y) {
  const reach = FLASH * speed, seen = new Set();
  for (let i = eventAt(t); i >= 0 && t - run.events[i].t < reach; i--) {
    const { kind, at, t: when } = run.events[i];
    if (!strikes(kind)) continue;
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
