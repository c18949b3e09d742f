// The lens: zoom and pan of all stages of a player, by wheel, pinch, drag and keys.

const NEAREST = 20, FARTHEST = 0.4; // limits of the scale relative to that of the whole picture

// Tracks the pointers that are down on a canvas: the position of one (px), and the distance and the
// midpoint of two (px).
function pointers(canvas) {
  const held = new Map();
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const spread = () => {
    const [a, b] = [...held.values()];
    return { wide: Math.hypot(a[0] - b[0], a[1] - b[1]) || 1, at: [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])] };
  };
  return { held, place, spread };
}

// `screen` is the frame of the player; `changed` redraws it.
function makeLens(screen, stages, changed) {
  const lens = { factor: 1, x: 0, z: 0 };
  for (const stage of stages) stage.lens = lens;

  function set(factor, x, z) {
    // The picture cannot be lost: its center stays within its own size.
    const most = Math.max(0, ...stages.map((stage) => Math.max(...stage.size())));
    const within = (value) => Math.min(Math.max(value, -most), most);
    Object.assign(lens, { factor, x: within(x), z: within(z) });
    const whole = lens.factor === 1 && lens.x === 0 && lens.z === 0;
    screen.classList.toggle("zoomed", !whole);
    changed();
  }
  const reset = () => set(1, 0, 0);
  const scale = (stage) => stage.viewAt(0).scale;
  const pan = (stage, dx, dy) => set(lens.factor, lens.x - dx / scale(stage), lens.z + dy / scale(stage));

  // Zooms such that the point at (px, py) of a stage stays in place.
  function zoom(stage, by, px, py) {
    const factor = Math.min(Math.max(lens.factor * by, FARTHEST), NEAREST);
    const shift = (1 - lens.factor / factor) / scale(stage);
    const [middle, foot] = stage.origin();
    set(factor, lens.x + (px - middle) * shift, lens.z + (foot - py) * shift);
  }

  for (const stage of stages) {
    const { canvas } = stage;
    const { held, place, spread } = pointers(canvas);
    // In three dimensions the camera handles the pointers.
    const on = (name, action) => canvas.addEventListener(name, (event) => {
      if (!screen.classList.contains("deep")) action(event);
    }, { passive: false });
    on("wheel", (event) => {
      // The wheel alone scrolls the page; with Ctrl, which touchpads send for a pinch, it zooms.
      if (!(event.ctrlKey || event.metaKey || document.fullscreenElement)) return;
      event.preventDefault();
      zoom(stage, Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.002)), ...place(event));
    });
    on("pointerdown", (event) => {
      held.set(event.pointerId, place(event));
      stage.hover = place(event);
      changed();
      if (event.pointerType !== "touch" || screen.classList.contains("zoomed")) canvas.setPointerCapture(event.pointerId);
    });
    on("pointermove", (event) => {
      const was = held.get(event.pointerId), now = place(event);
      stage.hover = now;
      if (!was) return changed();
      const before = held.size === 2 ? spread() : null;
      held.set(event.pointerId, now);
      if (before) {
        const { wide, at } = spread();
        zoom(stage, wide / before.wide, ...at);
        pan(stage, at[0] - before.at[0], at[1] - before.at[1]);
      } else if (event.pointerType !== "touch" || screen.classList.contains("zoomed")) {
        // One finger scrolls the page unless the picture is zoomed.
        pan(stage, now[0] - was[0], now[1] - was[1]);
      }
    });
    for (const name of ["pointerup", "pointercancel"]) on(name, (event) => held.delete(event.pointerId));
    on("pointerleave", () => {
      stage.hover = null;
      changed();
    });
    on("dblclick", reset);
  }

  return {
    lens, reset,
    // Zooms about the center of the first stage.
    zoom: (by) => stages[0] && zoom(stages[0], by, stages[0].origin()[0], 0.5 * stages[0].origin()[1]),
    pan: (dx, dy) => stages[0] && pan(stages[0], dx, dy),
  };
}
