// The strip below the stages: events of every pane, ground motion histories, and the cursor.

const LANE = 44, LABEL = 14, EVENT_LANE = 18, SIDE = 8;

// `panes` have a mark and events. Histories and marks are drawn once per size; only the cursor
// moves.
function makeTimeline(canvas, panes, ground, start, end) {
  const still = document.createElement("canvas");
  const several = panes.length > 1;
  const lanes = panes.filter((pane) => pane.events.length > 0);
  const head = lanes.length > 0 ? EVENT_LANE * lanes.length : 4;
  let width = 0, height = 0, dpr = 1, tint = "", drawn = "";
  // The marks of the panes are to the left of their events.
  let left = SIDE;
  const toX = (t) => left + ((t - start) / (end - start || 1)) * (width - left - SIDE);

  function resize() {
    width = Math.max(200, Math.floor(canvas.parentElement.clientWidth));
    height = head + LANE * ground.length;
    dpr = Math.min(window.devicePixelRatio || 1, 3);
    tint = color("accent");
    const look = [width, dpr, tint].join();
    if (look === drawn) return;
    drawn = look;
    for (const one of [canvas, still]) {
      one.width = Math.round(width * dpr);
      one.height = Math.round(height * dpr);
    }
    canvas.style.height = height + "px";
    const context = still.getContext("2d");
    context.setTransform(dpr, 0, 0, dpr, 0, 0);
    context.fillStyle = color("panel");
    context.fillRect(0, 0, width, height);
    context.font = "11px system-ui, sans-serif";
    left = SIDE;
    if (several) {
      const widest = Math.max(0, ...lanes.map((pane) => context.measureText(pane.mark).width));
      left = SIDE + Math.min(widest, 0.22 * width) + 8;
    }
    ground.forEach((history, at) => drawHistory(context, history, head + at * LANE));
    lanes.forEach((pane, at) => drawEvents(context, pane, at));
  }

  function drawEvents(context, pane, lane) {
    const middle = (lane + 0.5) * EVENT_LANE;
    if (several) {
      context.font = "11px system-ui, sans-serif";
      context.textBaseline = "middle";
      context.textAlign = "left";
      context.fillStyle = color("soft");
      context.fillText(pane.mark, SIDE, middle, left - SIDE - 8);
    }
    for (const event of pane.events) {
      if (event.t < start || event.t > end) continue;
      context.fillStyle = context.strokeStyle = color(event.kind === "fall" ? "accent" : "ink");
      eventShape(context, event.kind, toX(event.t), middle);
      if (event.kind === "fall" && !several) {
        context.globalAlpha = 0.4;
        context.fillRect(toX(event.t) - 0.5, EVENT_LANE - 2, 1, height);
        context.globalAlpha = 1;
      }
    }
  }

  // A line of text, then the curve.
  function laneAt(top) {
    const reach = 0.5 * (LANE - LABEL) - 2;
    return { middle: top + LABEL + reach, reach };
  }

  function drawHistory(context, history, top) {
    let peak = 0, when = 0;
    for (let k = 0; k < history.v.length; k++) {
      if (Math.abs(history.v[k]) > Math.abs(peak)) [peak, when] = [history.v[k], history.t[k]];
    }
    history.peak = Math.abs(peak);
    const { middle, reach } = laneAt(top);
    context.strokeStyle = color("rule");
    context.lineWidth = 1;
    context.strokeRect(left, middle, width - left - SIDE, 0);
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
    const label = (text, x, align, most) => {
      context.textAlign = align;
      context.lineWidth = 4;
      context.strokeStyle = color("panel");
      context.strokeText(text, x, top + 1, most);
      context.fillStyle = color("soft");
      context.fillText(text, x, top + 1, most);
    };
    label(history.label, SIDE, "left", 0.55 * width);
    label(t("peak {1} at {2}", withUnit(Math.abs(peak), 3, history.unit), `${when.toFixed(2)}\u00a0s`), width - SIDE, "right", 0.45 * width);
  }

  function cursor(time) {
    if (canvas.hidden) return;
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(still, 0, 0);
    context.setTransform(dpr, 0, 0, dpr, 0, 0);
    context.fillStyle = tint;
    context.fillRect(toX(time) - 1, 0, 2, height);
    ground.forEach((history, at) => {
      if (history.v.length === 0) return;
      const value = history.v[nearest(history.t, time)];
      if (!isFinite(value) || !(history.peak > 0)) return;
      const { middle, reach } = laneAt(head + at * LANE);
      context.beginPath();
      context.arc(toX(time), middle - (value / history.peak) * reach, 3.5, 0, 7);
      context.fill();
    });
  }

  // Returns the time under a pointer.
  function timeAt(clientX) {
    const box = canvas.getBoundingClientRect();
    const share = (clientX - box.left - left) / (box.width - left - SIDE);
    return start + share * (end - start);
  }

  // Distances (px) from the left and the right edge between which time runs.
  const ends = () => [left, SIDE];

  canvas.hidden = ground.length === 0 && lanes.length === 0;
  resize();
  return { resize, cursor, timeAt, ends };
}

// One shape per kind of event, the same in the strip and (by style) in the list.
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
