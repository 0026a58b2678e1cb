// ---- Words.

const readouts = [...document.querySelectorAll(".readout output")];
function markReadouts() {
  for (const output of readouts) {
    const path = output.closest("li").querySelector("path"), { colour, dashes } = curveOf(output.dataset.block - 1);
    path.style.stroke = colour;
    path.setAttribute("stroke-dasharray", dashes.join(" "));
  }
}
const signed = (value, digits) => (value < 0 ? "\u2212" : "+") + Math.abs(value).toFixed(digits);
const WORDS = {
  start: "starts to move", opening: "opening", impact: "impact", jump: "the ground jumps", slip: "begins to slide", stick: "stops sliding",
  flight: "lifts off", landing: "lands", edge: "a corner passes an edge", collapsed: "loses its support",
};
const strikes = kind => kind === "impact" || kind === "landing";
const text = (target, value) => { if (target.textContent !== value) target.textContent = value; };
const eventAt = t => lastNotAbove(run.events, t, event => event.t);

function tell(state) {
  text(element("clock"), `t = ${state.t.toFixed(3)} s`);
  text(element("mode"), nameOf(state.pattern));
  text(element("pattern"), state.pattern.text.replaceAll("-", "\u2212"));
  text(element("scale"), factor === 1 ? "angles as they are" : `angles drawn ×${factor}`);
  const index = eventAt(state.t), event = run.events[index];
  const where = event && event.at.length ? `, interface${event.at.length > 1 ? "s" : ""}\u00a0${event.at.map(one => one + 1).join(", ")}` : "";
  text(element("event"), event
    ? `${index + 1} of ${run.events.length}: ${WORDS[event.kind]} at ${event.t.toFixed(4)} s${where}, then ${nameOf(event)}`
    : run.events.length ? `${run.events.length} event${run.events.length > 1 ? "s" : ""} to come` : "No events in this run");
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

function choose(list, value) {
  if (value !== null && [...list.options].some(option => option.value === value)) list.value = value;
}
choose(speeds, address.get("speed"));
choose(factors, address.get("angles"));
if (address.get("show") === "animation") page.classList.add("still");
function layOut() {
  readColours();
  markReadouts();
  drawnStrip = null;
  frameView();
  draw();
}
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
