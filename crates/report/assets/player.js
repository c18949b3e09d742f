// The player: one clock, one set of controls, and a stage for every pane.

function readPane(raw, dashes) {
  const forces = raw.forces && Object.fromEntries(
    ["x", "z", "fx", "fz"].map((name) => [name, unpack(raw.forces[name])]));
  const times = unpack(raw.times)[0];
  const tint = raw.tint && { ...raw.tint, values: unpack(raw.tint.v) };
  const ghosts = raw.ghosts && { ...raw.ghosts, paths: unpack(raw.ghosts.paths), ends: unpack(raw.ghosts.ends) };
  const depth = raw.depth && { ...raw.depth, poses: raw.depth.poses && unpack(raw.depth.poses) };
  if (depth?.forces) depth.forces = { at: depth.forces.at.map(unpack), force: depth.forces.force.map(unpack) };
  return { ...raw, dashes, depth, forces, tint, ghosts, times, count: times.length, poses: unpack(raw.poses) };
}

// `earlier` has the panes of an earlier run, to be drawn over these panes under the name
// `raw.overlay`. Nothing is drawn until the player is first refreshed.
function makePlayer(raw, figure, dashes, earlier) {
  const find = (selector) => figure.querySelector(selector);
  const act = (name) => find(`[data-act="${name}"]`);
  const ground = raw.ground.map((h) => ({ ...h, t: columnOf(h.t), v: columnOf(h.v) }));
  const boxes = [...figure.querySelectorAll(".screen .stage")];
  const panes = raw.panes.map((one, at) => makePane(readPane(one, dashes), boxes[at]));
  // The flat panes of a run in space show its forces in their own axes.
  const space = panes.find(({ data }) => data.depth?.forces)?.data.depth;
  for (const [at, [right, up]] of (space?.axes ?? []).entries()) {
    const { at: points, force } = space.forces;
    if (panes[at]) panes[at].data.forces = { x: points[right], z: points[up], fx: force[right], fz: force[up] };
  }
  // Arrows and colors have one scale each for all panes, computed when they are first shown.
  for (const [scale, most] of [["strong", strongForce], ["full", fullTint]]) {
    let common = null;
    const get = () => (common ??= Math.max(0, ...panes.map(({ data }) => most(data))));
    for (const { stage } of panes) Object.defineProperty(stage, scale, { get });
  }
  // The bodies of the first pane, or those of an earlier run, are drawn over the panes.
  if (earlier) panes.forEach(({ data }, at) => { data.overlay = earlier[at].data; });
  else if (raw.overlay) for (const { data } of panes.slice(1)) data.overlay = panes[0].data;
  const any = (test) => panes.some(({ data }) => test(data));
  // The pane that lasts longest sets the time; the others show their frame nearest to it.
  const last = (pane) => (pane.data.count > 0 ? pane.data.times[pane.data.count - 1] : -Infinity);
  const lead = panes.reduce((a, b) => (last(b) > last(a) ? b : a), panes[0]);
  const { times, count } = lead ? lead.data : { times: [], count: 0 };
  const start = count > 0 ? times[0] : 0, end = count > 0 ? times[count - 1] : 0;
  // Playing starts shortly before the ground moves.
  const begins = Math.min(Math.max(raw.begins ?? start, start), end);
  const screen = find(".screen"), scrub = find("input.scrub");
  const timeline = makeTimeline(find("canvas.timeline"), panes.map((p) => p.data), ground, start, end);
  let frame = 0, head = begins, playing = false, speed = 1, before = 0, request = 0;
  const listeners = [], rests = [];
  const rate = { frames: 0, since: 0, fps: 0 };

  scrub.min = start;
  scrub.max = end;
  const shown = { forces: (data) => data.forces, traces: (data) => data.traces.length > 0, tint: (data) => data.tint, ghosts: (data) => data.ghosts || data.overlay };
  for (const [name, has] of Object.entries(shown)) {
    if (!any(has)) act(name).closest("label").hidden = true;
  }
  const known = panes.find(({ data }) => data.ghosts);
  act("ghosts").nextElementSibling.textContent = raw.overlay || (known ? known.data.ghosts.label : "");
  if (!any((data) => data.bodies.some((body) => body.role === "ground"))) act("camera").options[1].remove();

  // `opens` while the player is as the page opened it and the reader has not used it.
  let opens = true;
  const moment = typeof raw.opens === "number" ? panes[raw.opens].data.moment : null;
  const loop = moment && makeLoop(screen, moment.t, [start, end], (time) => show(nearest(times, time)), (looping) => {
    act("moment").setAttribute("aria-pressed", looping);
    mark();
  });
  if (!loop) act("moment").hidden = true;

  function show(k) {
    frame = Math.min(Math.max(k, 0), Math.max(0, count - 1));
    const time = count > 0 ? times[frame] : 0;
    for (const pane of panes) pane.show(pane === lead ? frame : nearest(pane.data.times, time), time, opens);
    timeline.cursor(time);
    scrub.value = time;
    scrub.setAttribute("aria-valuetext", t("{1} seconds", time.toFixed(2)));
    for (const listener of listeners) listener(time);
  }

  // Ends the opening when the reader uses the player.
  function take() {
    if (loop) loop.stop();
    opens = false;
  }

  // Sets the player to its opening state, without drawing.
  function ready() {
    opens = true;
    pause();
    head = begins;
    frame = nearest(times, moment ? moment.t : begins);
  }

  function open() {
    ready();
    show(frame);
  }

  const settled = () => { if (!playing && !opens) for (const listener of rests) listener(times[frame] ?? 0); };

  // Sets the player to a time, without drawing.
  function stand(time) {
    take();
    head = Math.min(Math.max(Number(time) || 0, start), end);
    frame = nearest(times, head);
  }

  function seek(time) {
    stand(time);
    show(frame);
    settled();
    return frame;
  }

  function tick(now) {
    if (!playing) return;
    // After a tab was in the background, the long pause does not count as play time.
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
    take();
    if (head >= end) head = begins;
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
    settled();
  }

  function mark() {
    const moves = playing || Boolean(loop && loop.isLooping());
    act("play").classList.toggle("playing", moves);
    act("play").setAttribute("aria-label", moves ? t("Pause") : t("Play"));
  }

  function stepTo(k) {
    pause();
    take();
    show(k);
    if (count > 0) head = times[frame];
    settled();
  }

  // Whatever moves is paused first; after the loop, the run plays from its beginning.
  function toggle() {
    if (!playing && !(loop && loop.isLooping())) return play();
    take();
    pause();
  }
  const buttons = {
    play: toggle,
    first: () => stepTo(0),
    back: () => stepTo(frame - 1),
    forward: () => stepTo(frame + 1),
    moment: () => {
      if (!loop) return;
      const stops = loop.isLooping();
      loop.stop();
      open();
      if (!stops) loop.run();
    },
    keys: makePanel(find("dialog")),
    fullscreen: () => (document.fullscreenElement ? document.exitFullscreen() : screen.requestFullscreen()),
  };
  act("fullscreen").hidden = !document.fullscreenEnabled;
  screen.addEventListener("fullscreenchange", () => refresh());
  const lens = makeLens(screen, panes.map(({ stage }) => stage), () => show(frame));
  const views = makeViews(screen, panes, act, () => show(frame), () => refresh());
  const step = 40; // px
  // In three dimensions, the keys that move the picture rotate the camera.
  const whole = () => (views.isDeep() ? views.eye.go("corner") : lens.reset());
  const zoom = (by) => (views.isDeep() ? views.eye.zoom(by) : lens.zoom(by));
  const pan = (dx, dy) => (shift) => {
    if (!views.isDeep()) lens.pan(dx, dy);
    else if (shift) views.eye.pan(dx, dy);
    else views.eye.turn((-TURN * dx) / step, (TURN * dy) / step);
  };
  buttons.whole = whole;
  for (const [name, action] of Object.entries(buttons)) act(name).addEventListener("click", action);
  const onStages = (change) => {
    for (const pane of panes) change(pane.stage);
    show(frame);
  };
  act("speed").addEventListener("change", () => { speed = Number(act("speed").value); });
  act("camera").addEventListener("change", () => onStages((stage) => { stage.camera = act("camera").value; }));
  const follow = panes.length > 0 && panes.every(({ stage }) => stage.camera === "stack");
  for (const { stage } of panes) stage.camera = follow ? "stack" : "fixed";
  act("camera").value = follow ? "stack" : "fixed";
  for (const name of ["names", "forces", "traces", "tint", "ghosts"]) {
    if (panes.length === 0) break;
    act(name).checked = panes[0].stage[name];
    act(name).addEventListener("change", () => onStages((stage) => { stage[name] = act(name).checked; }));
  }
  scrub.addEventListener("input", () => {
    pause();
    seek(scrub.value);
  });
  for (const button of figure.querySelectorAll(".events button")) {
    button.addEventListener("click", () => {
      pause();
      seek(button.dataset.time);
      if (screen.getBoundingClientRect().top < 0) screen.scrollIntoView({ block: "start" });
    });
  }

  function cycle(select, by) {
    const to = select.selectedIndex + by;
    if (to < 0 || to >= select.length) return;
    select.selectedIndex = to;
    select.dispatchEvent(new Event("change"));
  }
  const click = (name) => () => { if (!act(name).closest("[hidden]")) act(name).click(); };
  listen(screen, {
    " ": toggle,
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
    m: click("moment"), f: click("forces"), n: click("names"), p: click("traces"), t: click("tint"), g: click("ghosts"),
    F: click("fullscreen"), "?": click("keys"),
    "+": () => zoom(1.25), "=": () => zoom(1.25), "-": () => zoom(0.8), 0: whole, v: views.toggle,
    w: pan(0, step), s: pan(0, -step), a: pan(step, 0), d: pan(-step, 0),
    W: pan(0, step), S: pan(0, -step), A: pan(step, 0), D: pan(-step, 0),
    ...Object.fromEntries(Object.keys(PRESETS).map((name, at) => [at + 1, () => { if (views.isDeep()) views.eye.go(name); }])),
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
    // The thumb, 16 px wide, is centered under the cursor.
    const [left, right] = timeline.ends();
    scrub.style.margin = `0 ${right - 8}px 0 ${left - 8}px`;
    show(frame);
  }

  fitStages(panes, figure);
  ready();
  if (loop && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) loop.run();
  return {
    seek, stand, play, pause, toggle, refresh, screen, take,
    onRest: (listener) => rests.push(listener),
    isLooping: () => Boolean(loop && loop.isLooping()),
    moment, begins, lens: lens.lens,
    onTime: (listener) => { listeners.push(listener); listener(times[frame] ?? 0); },
    time: () => times[frame] ?? 0,
    frame: () => frame,
    times: () => Array.from(times),
    poses: () => (lead ? lead.poses() : []),
    forces: () => (lead ? lead.forces() : []),
    panes, views, isPlaying: () => playing,
    rate: () => rate.fps,
    id: raw.id,
  };
}

// One scene: its stage, its clock and its announcements.
function makePane(data, box) {
  const stage = makeStage(data, box.querySelector("canvas.scene"));
  if (data.moment) stage.canvas.setAttribute("aria-label", t("The bodies at the time shown; {1}, at {2}", data.moment.text, `${data.moment.t.toFixed(2)}\u00a0s`));
  const clock = box.querySelector(".clock"), news = box.querySelector(".news");
  const end = data.count > 0 ? data.times[data.count - 1] : 0;
  let shown = 0, said = null;
  return {
    data, stage, deep: null, section: box.closest(".pane") ?? box,
    // While the player opens, the moment has its callout and events are not announced.
    show(k, time, opens) {
      const drawn = stage.deep && this.deep ? this.deep : stage, told = drawn === stage ? data : data.depth;
      shown = Math.min(Math.max(k, 0), Math.max(0, data.count - 1));
      const own = data.count > 0 ? data.times[shown] : 0;
      const { moment } = told;
      stage.callout = moment && time >= moment.t - (opens ? BEFORE : 1e-6) && time < moment.t + 0.8;
      drawn.draw(shown, own);
      // A run that has ended holds its last frame, and its clock states this.
      const ended = time > end + 0.02;
      clock.textContent = ended ? t("ended at {1}", `${end.toFixed(2)}\u00a0s`) : `${own.toFixed(2)}\u00a0s`;
      clock.classList.toggle("ended", ended);
      const current = currentEvents(told, time);
      const event = current.length > 0 && !opens ? current[current.length - 1] : null;
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

// Gives all stages of a player the same size.
function fitStages(all, figure) {
  const screen = figure.querySelector(".screen");
  const panes = all.filter(({ section }) => !section.hidden);
  for (const { stage, deep } of panes) {
    stage.retheme();
    deep?.retheme();
  }
  const [first] = panes;
  if (!first) return;
  // A player that opens the page fills the first screen, controls included; others are smaller.
  const above = screen.getBoundingClientRect().top + window.scrollY;
  const used = figure.querySelector(".controls").getBoundingClientRect().bottom - screen.getBoundingClientRect().top;
  // Narrow stages have no room beside their bodies.
  for (const { stage } of panes) {
    const slender = stage.canvas.parentElement.clientWidth < 260 && panes.some(({ data }) => data.moment);
    stage.head = HEAD + (slender ? ABOVE : 0);
  }
  const canvases = panes.map(({ stage }) => stage.canvas);
  // The panes of a row begin at the same height; the lower edges of their canvases differ by
  // rounding, so the upper ones are compared.
  const rows = new Set(canvases.map((canvas) => Math.round((canvas.closest(".pane") ?? canvas).getBoundingClientRect().top))).size || 1;
  const rest = used - rows * first.stage.canvas.offsetHeight;
  const opens = above < 0.5 * window.innerHeight;
  const full = document.fullscreenElement === screen;
  const free = full ? window.innerHeight - rest : opens ? window.innerHeight - above - rest - 10 : 0.6 * window.innerHeight;
  const room = free / rows;
  const least = rows > 1 ? 210 : 320;
  for (const { stage } of panes) {
    stage.most = Infinity;
    stage.resize(Math.max(room, least), full);
  }
  // Panes may differ by the width of a border.
  const common = Math.min(...panes.map(({ stage }) => stage.scale()));
  for (const { stage } of panes) stage.most = common;
}
