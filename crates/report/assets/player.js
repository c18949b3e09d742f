// The player: time, controls, keyboard, and the strip of ground motion and events under the stage.

const LANE = 44, LABEL = 14, EVENT_LANE = 18, SIDE = 8;

function makePlayer(raw, figure, dashes) {
  const forces = raw.forces && Object.fromEntries(
    ["x", "z", "fx", "fz"].map((name) => [name, unpack(raw.forces[name])]));
  const times = unpack(raw.times)[0];
  const data = {
    ...raw, dashes, forces, times, count: times.length, poses: unpack(raw.poses),
    ground: raw.ground.map((h) => ({ ...h, t: columnOf(h.t), v: columnOf(h.v) })),
  };
  const find = (selector) => figure.querySelector(selector);
  const act = (name) => find(`[data-act="${name}"]`);
  const stage = makeStage(data, find("canvas.scene"));
  const timeline = find("canvas.timeline");
  const scrub = find("input.scrub");
  const start = data.count > 0 ? times[0] : 0, end = data.count > 0 ? times[data.count - 1] : 0;
  let frame = 0, head = start, playing = false, speed = 1, last = 0, request = 0;
  let said = null;
  const listeners = [];
  const rate = { frames: 0, since: 0, fps: 0 };
  const strip = makeStrip();

  scrub.max = Math.max(0, data.count - 1);
  for (const name of ["forces", "traces"]) {
    const has = name === "forces" ? data.forces : data.traces.length > 0;
    if (!has) act(name).closest("label").hidden = true;
  }
  if (data.ground.length === 0 && data.events.length === 0) timeline.hidden = true;
  if (!data.bodies.some((body) => body.role === "ground")) act("camera").options[1].remove();

  function show(k) {
    frame = Math.min(Math.max(k, 0), Math.max(0, data.count - 1));
    const time = data.count > 0 ? times[frame] : 0;
    stage.draw(frame, time);
    strip.cursor(time);
    scrub.value = frame;
    scrub.setAttribute("aria-valuetext", `${time.toFixed(2)} seconds`);
    find(".clock").textContent = `${time.toFixed(2)} s`;
    const current = currentEvents(data, time);
    const event = current.length > 0 ? current[current.length - 1] : null;
    if (event !== said) {
      said = event;
      find(".news").textContent = event ? event.text : "";
    }
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
    head += Math.min((now - last) / 1000, 0.25) * speed;
    last = now;
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
    if (playing || data.count < 2) return;
    if (head >= end) head = start;
    playing = true;
    last = rate.since = performance.now();
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
    if (data.count > 0) head = times[frame];
  }

  function redraw() {
    show(frame);
  }

  const actions = {
    play: () => (playing ? pause() : play()),
    first: () => stepTo(0),
    back: () => stepTo(frame - 1),
    forward: () => stepTo(frame + 1),
  };
  for (const [name, action] of Object.entries(actions)) act(name).addEventListener("click", action);
  act("speed").addEventListener("change", () => { speed = Number(act("speed").value); });
  act("camera").addEventListener("change", () => { stage.camera = act("camera").value; redraw(); });
  for (const name of ["names", "forces", "traces"]) {
    act(name).checked = stage[name];
    act(name).addEventListener("change", () => { stage[name] = act(name).checked; redraw(); });
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
    End: () => stepTo(data.count - 1),
    "<": () => cycle(act("speed"), -1),
    ">": () => cycle(act("speed"), 1),
    c: () => {
      const last = act("camera").selectedIndex === act("camera").length - 1;
      cycle(act("camera"), last ? -act("camera").selectedIndex : 1);
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
  const toTime = (event) => {
    const box = timeline.getBoundingClientRect();
    const share = (event.clientX - box.left - SIDE) / (box.width - 2 * SIDE);
    pause();
    seek(start + share * (end - start));
  };
  timeline.addEventListener("pointerdown", (event) => {
    dragging = true;
    timeline.setPointerCapture(event.pointerId);
    toTime(event);
  });
  timeline.addEventListener("pointermove", (event) => { if (dragging) toTime(event); });
  for (const name of ["pointerup", "pointercancel"]) {
    timeline.addEventListener(name, () => { dragging = false; });
  }

  // Histories and event marks are drawn once for each size; only the cursor moves.
  function makeStrip() {
    const still = document.createElement("canvas");
    let width = 0, height = 0, dpr = 1;
    const toX = (t) => SIDE + ((t - start) / (end - start || 1)) * (width - 2 * SIDE);

    function resize() {
      width = Math.max(200, Math.floor(timeline.parentElement.clientWidth));
      height = (data.events.length > 0 ? EVENT_LANE : 4) + LANE * data.ground.length;
      dpr = Math.min(window.devicePixelRatio || 1, 3);
      for (const canvas of [timeline, still]) {
        canvas.width = Math.round(width * dpr);
        canvas.height = Math.round(height * dpr);
      }
      timeline.style.height = height + "px";
      const context = still.getContext("2d");
      context.setTransform(dpr, 0, 0, dpr, 0, 0);
      context.fillStyle = color("panel");
      context.fillRect(0, 0, width, height);
      const top = data.events.length > 0 ? EVENT_LANE : 4;
      data.ground.forEach((history, at) => drawHistory(context, history, top + at * LANE));
      for (const event of data.events) {
        if (event.t < start || event.t > end) continue;
        context.fillStyle = context.strokeStyle = color(event.kind === "fall" ? "accent" : "ink");
        eventShape(context, event.kind, toX(event.t), 0.5 * EVENT_LANE);
        if (event.kind === "fall") {
          context.globalAlpha = 0.4;
          context.fillRect(toX(event.t) - 0.5, EVENT_LANE - 2, 1, height);
          context.globalAlpha = 1;
        }
      }
    }

    // A line of words, then the curve.
    function laneAt(top) {
      const reach = 0.5 * (LANE - LABEL) - 2;
      return { middle: top + LABEL + reach, reach };
    }

    function drawHistory(context, history, top) {
      let peak = 0, when = 0;
      for (let k = 0; k < history.v.length; k++) {
        if (Math.abs(history.v[k]) > Math.abs(peak)) [peak, when] = [history.v[k], history.t[k]];
      }
      const { middle, reach } = laneAt(top);
      context.strokeStyle = color("rule");
      context.lineWidth = 1;
      context.strokeRect(SIDE, middle, width - 2 * SIDE, 0);
      context.strokeStyle = color("s0");
      context.lineJoin = "round";
      context.beginPath();
      let pen = false;
      for (let k = 0; k < history.v.length; k++) {
        const inside = history.t[k] >= start && history.t[k] <= end;
        if (!inside || !isFinite(history.v[k])) {
          pen = false;
          continue;
        }
        const x = toX(history.t[k]), y = middle - (peak !== 0 ? (history.v[k] / Math.abs(peak)) * reach : 0);
        if (pen) context.lineTo(x, y);
        else context.moveTo(x, y);
        pen = true;
      }
      context.stroke();
      context.font = "11px system-ui, sans-serif";
      context.textBaseline = "top";
      const label = (text, x, align) => {
        context.textAlign = align;
        context.lineWidth = 4;
        context.strokeStyle = color("panel");
        context.strokeText(text, x, top + 1);
        context.fillStyle = color("soft");
        context.fillText(text, x, top + 1);
      };
      label(history.label, SIDE, "left");
      label(`peak ${withUnit(Math.abs(peak), 3, history.unit)} at ${when.toFixed(2)} s`, width - SIDE, "right");
    }

    function cursor(time) {
      if (timeline.hidden) return;
      const context = timeline.getContext("2d");
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.drawImage(still, 0, 0);
      context.setTransform(dpr, 0, 0, dpr, 0, 0);
      context.fillStyle = strip.tint || (strip.tint = color("accent"));
      context.fillRect(toX(time) - 1, 0, 2, height);
      data.ground.forEach((history, at) => {
        if (history.v.length === 0) return;
        const peak = history.peak ??= history.v.reduce((m, v) => (Math.abs(v) > m ? Math.abs(v) : m), 0);
        const value = history.v[nearest(history.t, time)];
        if (!isFinite(value) || peak === 0) return;
        const top = (data.events.length > 0 ? EVENT_LANE : 4) + at * LANE;
        context.beginPath();
        const { middle, reach } = laneAt(top);
        context.arc(toX(time), middle - (value / peak) * reach, 3.5, 0, 7);
        context.fill();
      });
    }

    resize();
    return { resize, cursor, tint: "" };
  }

  function refresh() {
    stage.retheme();
    stage.resize();
    strip.tint = "";
    strip.resize();
    redraw();
  }

  stage.resize();
  redraw();
  return {
    seek, play, pause, refresh,
    onTime: (listener) => { listeners.push(listener); listener(times[frame] ?? 0); },
    time: () => times[frame] ?? 0,
    frame: () => frame,
    times: () => Array.from(times),
    poses: () => data.bodies.map((body, b) => [0, 1, 2].map((c) => data.poses[3 * b + c][frame])),
    forces: () => forcesAt(data, frame),
    isPlaying: () => playing,
    rate: () => rate.fps,
    id: raw.id,
  };
}

// One shape for each kind of event, the same in the strip and (by style) in the list.
function eventShape(context, kind, x, y) {
  const r = 4.5;
  const corners = {
    uplift: [[0, -r], [r, r], [-r, r]],
    slip: [[0, -r], [r, 0], [0, r], [-r, 0]],
    seat: [[-r + 1, -r + 1], [r - 1, -r + 1], [r - 1, r - 1], [-r + 1, r - 1]],
    fall: [[-r, -r], [r, -r], [0, r]],
  }[kind];
  context.beginPath();
  if (corners) corners.forEach(([dx, dy], k) => context[k ? "lineTo" : "moveTo"](x + dx, y + dy));
  else context.arc(x, y, 2.5, 0, 7);
  context.closePath();
  context.fill();
}
