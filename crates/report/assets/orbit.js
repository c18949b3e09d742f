// The camera of all three-dimensional stages of a player: rotated, moved and zoomed by pointer,
// fingers and keys.

const LENS = 0.46; // angle of view from top to bottom (rad)
const CLOSEST = 12, WIDEST = 0.3; // limits of the zoom factor: fitted distance over camera distance
const TURN = Math.PI / 24; // rotation per key press
const GLIDE = 450; // duration of the transition to a preset (ms)

// Angles of the camera (rad): around the stack, from the view across the barrels, and above the
// floor.
const PRESETS = { corner: [0.62, 0.3], across: [0, 0], along: [0.5 * Math.PI, 0], above: [0, 0.5 * Math.PI] };

// `stages` returns the visible stages; `changed` redraws them.
function makeEye(screen, canvases, stages, changed) {
  const eye = { around: 0, above: 0, factor: 1, aside: [0, 0, 0] };
  const still = window.matchMedia("(prefers-reduced-motion: reduce)");
  let gliding = 0;
  const isDeep = () => screen.classList.contains("deep");

  function axes() {
    const [c, s] = [Math.cos(eye.around), Math.sin(eye.around)], [up, flat] = [Math.sin(eye.above), Math.cos(eye.above)];
    return { right: [c, s, 0], up: [-s * up, c * up, flat], back: [s * flat, -c * flat, up] };
  }

  // Updates whether the picture is as it opened.
  function settle() {
    const [around, above] = PRESETS.corner;
    const whole = eye.factor === 1 && eye.aside.every((v) => v === 0) && eye.around === around && eye.above === above;
    if (isDeep()) screen.classList.toggle("zoomed", !whole);
    changed();
  }

  function turn(around, above) {
    cancelAnimationFrame(gliding);
    eye.around = (eye.around + around) % (2 * Math.PI);
    eye.above = Math.min(Math.max(eye.above + above, 0), 0.5 * Math.PI);
    eye.turned = true;
    settle();
  }

  // Pans by pixels of a stage.
  function pan(dx, dy) {
    const { right, up } = axes(), perPixel = stages()[0]?.perPixel() ?? 0;
    eye.aside = plus(plus(eye.aside, right, -dx * perPixel), up, dy * perPixel);
    settle();
  }

  function zoom(by) {
    eye.factor = Math.min(Math.max(eye.factor * by, WIDEST), CLOSEST);
    settle();
  }

  // Moves to a preset, the shorter way around.
  function go(name) {
    cancelAnimationFrame(gliding);
    const from = [eye.around, eye.above], [around, above] = PRESETS[name];
    const away = ((((around - from[0]) % (2 * Math.PI)) + 3 * Math.PI) % (2 * Math.PI)) - Math.PI;
    const begin = { factor: eye.factor, aside: eye.aside };
    const at = (share) => {
      const soft = share * share * (3 - 2 * share);
      eye.around = share >= 1 ? around : from[0] + soft * away;
      eye.above = from[1] + soft * (above - from[1]);
      eye.factor = share >= 1 ? 1 : begin.factor ** (1 - soft);
      eye.aside = begin.aside.map((v) => (share >= 1 ? 0 : v * (1 - soft)));
      settle();
    };
    if (still.matches) return at(1);
    const since = performance.now();
    const step = (now) => {
      const share = Math.min(Math.max((now - since) / GLIDE, 0), 1);
      at(share);
      if (share < 1) gliding = requestAnimationFrame(step);
    };
    gliding = requestAnimationFrame(step);
  }

  for (const { canvas, stage } of canvases) {
    const { held, place, spread } = pointers(canvas);
    let moved = 0;
    const on = (name, action) => canvas.addEventListener(name, (event) => { if (isDeep()) action(event); }, { passive: false });
    on("wheel", (event) => {
      // The wheel alone scrolls the page; with Ctrl, which touchpads send for a pinch, it zooms.
      if (!(event.ctrlKey || event.metaKey || document.fullscreenElement)) return;
      event.preventDefault();
      zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.002)));
    });
    on("pointerdown", (event) => {
      held.set(event.pointerId, place(event));
      moved = 0;
      canvas.setPointerCapture(event.pointerId);
    });
    on("pointermove", (event) => {
      const was = held.get(event.pointerId), now = place(event);
      if (!was) {
        stage.hover = now;
        return changed();
      }
      const before = held.size === 2 ? spread() : null;
      held.set(event.pointerId, now);
      const [dx, dy] = [now[0] - was[0], now[1] - was[1]];
      moved += Math.abs(dx) + Math.abs(dy);
      stage.hover = null;
      if (before) {
        const { wide, at } = spread();
        zoom(wide / before.wide);
        pan(at[0] - before.at[0], at[1] - before.at[1]);
      } else if (event.shiftKey || event.buttons > 1) pan(dx, dy);
      else turn(-0.008 * dx, 0.006 * dy);
    });
    for (const name of ["pointerup", "pointercancel"]) {
      on(name, (event) => {
        held.delete(event.pointerId);
        // A tap shows the name of the body that it hits.
        if (moved < 8) {
          stage.hover = place(event);
          changed();
        }
      });
    }
    on("pointerleave", (event) => {
      if (event.pointerType === "touch") return;
      stage.hover = null;
      changed();
    });
    on("dblclick", () => go("corner"));
    on("contextmenu", (event) => event.preventDefault());
  }
  [eye.around, eye.above] = PRESETS.corner;
  return Object.assign(eye, { axes, turn, pan, zoom, go });
}
