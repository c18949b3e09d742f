// The player: one clock, one set of controls, and a stage for every pane.

function readPane(raw, dashes) {
  const forces = raw.forces && Object.fromEntries(
    ["x", "z", "fx", "fz"].map((name) => [name, unpack(raw.forces[name])]));
  const times = unpack(raw.times)[0];
  return { ...raw, dashes, forces, times, count: times.length, poses: unpack(raw.poses) };
}

function makePlayer(raw, figure, dashes) {
  const find = (selector) => figure.querySelector(selector);
  const act = (name) => find(`[data-act="${name}"]`);
  const ground = raw.ground.map((h) => ({ ...h, t: columnOf(h.t), v: columnOf(h.v) }));
  const boxes = [...figure.querySelectorAll(".screen .stage")];
  const panes = raw.panes.map((one, at) => makePane(readPane(one, dashes), boxes[at]));
  // Arrows of all panes have one scale.
  const strong = Math.max(0, ...panes.map(({ stage }) => stage.strong));
  for (const { stage } of panes) stage.strong = strong;
  const any = (test) => panes.some(({ data }) => test(data));
  // The pane that lasts longest beats time; the others show their frame nearest to it.
  const last = (pane) => (pane.data.count > 0 ? pane.data.times[pane.data.count - 1] : -Infinity);
  const lead = panes.reduce((a, b) => (last(b) > last(a) ? b : a), panes[0]);
  const { times, count } = lead ? lead.data : { times: [], count: 0 };
  const start = count > 0 ? times[0] : 0, end = count > 0 ? times[count - 1] : 0;
  const scrub = find("input.scrub");
  const timeline = makeTimeline(find("canvas.timeline"), panes.map((p) => p.data), ground, start, end);
  let frame = 0, head = start, playing = false, speed = 1, before = 0, request = 0;
  const listeners = [];
  const rate = { frames: 0, since: 0, fps: 0 };

  scrub.max = Math.max(0, count - 1);
  for (const name of ["forces", "traces"]) {
    const has = any((data) => (name === "forces" ? data.forces : data.traces.length > 0));
    if (!has) act(name).closest("label").hidden = true;
  }
  if (!any((data) => data.bodies.some((body) => body.role === "ground"))) act("camera").options[1].remove();

  function show(k) {
    frame = Math.min(Math.max(k, 0), Math.max(0, count - 1));
    const time = count > 0 ? times[frame] : 0;
    for (const pane of panes) pane.show(pane === lead ? frame : nearest(pane.data.times, time), time);
    timeline.cursor(time);
    scrub.value = frame;
    scrub.setAttribute("aria-valuetext", `${time.toFixed(2)} seconds`);
    for (const listener of listeners) listener(time);
  }

  function seek(time) {
    head = Math.min(Math.max(Number(time) || 0, start), end);
    show(nearest(times, head));
    return frame;
  }

  function tick(now) {
    if (!playing) return;
    // A tab in the background returns with a long pause, which is not play time.
    head += Math.min((now - before) / 1000, 0.25) * speed;
    before = now;
    rate.frames += 1;
    if (now - rate.since > 1000) {
      rate.fps = (1000 * rate.frames) / (now - rate.since);
      rate.frames = 0;
      rate.since = now;
    }
    show(nearest(times, Math.min(head, end)));
    if (head >= end) pause();
    else request = requestAnimationFrame(tick);
  }

  function play() {
    if (playing || count < 2) return;
    if (head >= end) head = start;
    playing = true;
    before = rate.since = performance.now();
    rate.frames = 0;
    mark();
    request = requestAnimationFrame(tick);
  }

  function pause() {
    playing = false;
    cancelAnimationFrame(request);
    mark();
  }

  function mark() {
    act("play").classList.toggle("playing", playing);
    act("play").setAttribute("aria-label", playing ? "Pause" : "Play");
  }

  function stepTo(k) {
    pause();
    show(k);
    if (count > 0) head = times[frame];
  }

  const actions = {
    play: () => (playing ? pause() : play()),
    first: () => stepTo(0),
    back: () => stepTo(frame - 1),
    forward: () => stepTo(frame + 1),
  };
  for (const [name, action] of Object.entries(actions)) act(name).addEventListener("click", action);
  const onStages = (change) => {
    for (const pane of panes) change(pane.stage);
    show(frame);
  };
  act("speed").addEventListener("change", () => { speed = Number(act("speed").value); });
  act("camera").addEventListener("change", () => onStages((stage) => { stage.camera = act("camera").value; }));
  const follow = panes.length > 0 && panes.every(({ stage }) => stage.camera === "stack");
  for (const { stage } of panes) stage.camera = follow ? "stack" : "fixed";
  act("camera").value = follow ? "stack" : "fixed";
  for (const name of ["names", "forces", "traces"]) {
    if (panes.length === 0) break;
    act(name).checked = panes[0].stage[name];
    act(name).addEventListener("change", () => onStages((stage) => { stage[name] = act(name).checked; }));
  }
  scrub.addEventListener("input", () => stepTo(Number(scrub.value)));
  for (const button of figure.querySelectorAll(".events button")) {
    button.addEventListener("click", () => {
      pause();
      seek(Number(button.dataset.time));
      const box = find(".screen").getBoundingClientRect();
      if (box.top < 0) find(".screen").scrollIntoView({ block: "start" });
    });
  }

  function cycle(select, by) {
    const to = select.selectedIndex + by;
    if (to < 0 || to >= select.length) return;
    select.selectedIndex = to;
    select.dispatchEvent(new Event("change"));
  }
  const keys = {
    " ": actions.play,
    ArrowLeft: (shift) => stepTo(frame - (shift ? 10 : 1)),
    ArrowRight: (shift) => stepTo(frame + (shift ? 10 : 1)),
    Home: () => stepTo(0),
    End: () => stepTo(count - 1),
    "<": () => cycle(act("speed"), -1),
    ">": () => cycle(act("speed"), 1),
    c: () => {
      const final = act("camera").selectedIndex === act("camera").length - 1;
      cycle(act("camera"), final ? -act("camera").selectedIndex : 1);
    },
    f: () => act("forces").click(),
    n: () => act("names").click(),
    p: () => act("traces").click(),
  };
  find(".screen").addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const tag = event.target.tagName;
    // A focused control keeps the keys that work it.
    if (tag === "SELECT" || (tag === "BUTTON" && event.key === " ")) return;
    if (tag === "INPUT" && event.target.type === "checkbox" && event.key === " ") return;
    const action = keys[event.key];
    if (!action) return;
    event.preventDefault();
    action(event.shiftKey);
  });
  let dragging = false;
  const toPointer = (event) => {
    pause();
    seek(timeline.timeAt(event.clientX));
  };
  const strip = find("canvas.timeline");
  strip.addEventListener("pointerdown", (event) => {
    dragging = true;
    strip.setPointerCapture(event.pointerId);
    toPointer(event);
  });
  strip.addEventListener("pointermove", (event) => { if (dragging) toPointer(event); });
  for (const name of ["pointerup", "pointercancel"]) {
    strip.addEventListener(name, () => { dragging = false; });
  }

  function refresh() {
    fitStages(panes, figure);
    timeline.resize();
    show(frame);
  }

  refresh();
  return {
    seek, play, pause, refresh,
    onTime: (listener) => { listeners.push(listener); listener(times[frame] ?? 0); },
    time: () => times[frame] ?? 0,
    frame: () => frame,
    times: () => Array.from(times),
    poses: () => (lead ? lead.poses() : []),
    forces: () => (lead ? lead.forces() : []),
    panes, isPlaying: () => playing,
    rate: () => rate.fps,
    id: raw.id,
  };
}

// One scene: its stage, its clock and what it announces.
function makePane(data, box) {
  const stage = makeStage(data, box.querySelector("canvas.scene"));
  const clock = box.querySelector(".clock"), news = box.querySelector(".news");
  const end = data.count > 0 ? data.times[data.count - 1] : 0;
  let shown = 0, said = null;
  return {
    data, stage,
    show(k, time) {
      shown = Math.min(Math.max(k, 0), Math.max(0, data.count - 1));
      const own = data.count > 0 ? data.times[shown] : 0;
      stage.draw(shown, own);
      // A run that ended holds its last frame and says so.
      const ended = time > end + 0.02;
      clock.textContent = ended ? `ended at ${end.toFixed(2)}\u00a0s` : `${own.toFixed(2)}\u00a0s`;
      clock.classList.toggle("ended", ended);
      const current = currentEvents(data, time);
      const event = current.length > 0 ? current[current.length - 1] : null;
      if (event !== said) {
        said = event;
        news.textContent = event ? event.text : "";
      }
    },
    frame: () => shown,
    poses: () => data.bodies.map((body, b) => [0, 1, 2].map((c) => data.poses[3 * b + c][shown])),
    forces: () => forcesAt(data, shown),
  };
}

// Sizes all stages of a player alike.
function fitStages(panes, figure) {
  const screen = figure.querySelector(".screen");
  for (const { stage } of panes) stage.retheme();
  const [first] = panes;
  if (!first) return;
  // A player that opens the page fills the first screen, controls included; others take less.
  const above = screen.getBoundingClientRect().top + window.scrollY;
  const canvases = panes.map(({ stage }) => stage.canvas);
  const rows = new Set(canvases.map((canvas) => Math.round(canvas.parentElement.getBoundingClientRect().top))).size || 1;
  const rest = screen.offsetHeight - rows * first.stage.canvas.offsetHeight;
  const opens = above < 0.5 * window.innerHeight;
  const room = (opens ? window.innerHeight - above - rest - 8 : 0.6 * window.innerHeight) / rows;
  const least = rows > 1 ? 210 : 320;
  for (const { stage } of panes) {
    stage.most = Infinity;
    stage.resize(Math.max(room, least));
  }
  // Panes may differ by the width of a border.
  const common = Math.min(...panes.map(({ stage }) => stage.viewAt(0).scale));
  for (const { stage } of panes) stage.most = common;
}
