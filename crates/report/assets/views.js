// The switch between the three-dimensional stage and the flat one.

// The WebGL canvas, one per page; null if the browser or the page does not support WebGL.
let surface;
function findSurface() {
  if (surface === undefined) {
    const canvas = document.createElement("canvas");
    const context = document.getElementById("three") && canvas.getContext("webgl2", { alpha: true, antialias: true });
    surface = context ? { canvas, context } : null;
  }
  return surface;
}

// The three-dimensional renderer, unpacked when it is first needed; null if it does not start.
let engine = null;
function loadEngine() {
  engine ??= (async () => {
    document.head.append(make("script", {}, new TextDecoder().decode(await held("three"))));
    return makeEngine(window.barrelstackThree, surface.canvas, surface.context);
  })().catch(() => null);
  return engine;
}

// Whether the address requests the flat stage: `?view=flat`.
const asksFlat = () => new URLSearchParams(location.search).get("view") === "flat";

// `changed` redraws; `refit` measures first.
function makeViews(screen, panes, act, changed, refit) {
  const deep = panes.filter(({ data }) => data.depth);
  const shown = () => deep.map((pane) => pane.deep).filter(Boolean);
  const eye = makeEye(screen, deep.map(({ stage }) => ({ canvas: stage.canvas, stage })), shown, changed);
  const group = act("deep").closest(".views"), presets = group.nextElementSibling;
  let isDeep = false;

  function set(on) {
    isDeep = on;
    screen.classList.toggle("deep", on);
    screen.classList.remove("zoomed");
    act("deep").setAttribute("aria-pressed", on);
    act("flat").setAttribute("aria-pressed", !on);
    presets.hidden = !on;
    // In three dimensions, the panes of one run from several sides become one, which can be
    // rotated.
    for (const pane of panes) pane.section.hidden = on && !pane.data.depth;
    screen.classList.toggle("alone", on && deep.length === 1);
    for (const { stage } of panes) Object.assign(stage, { deep: on, hover: null });
    refit();
  }

  async function choose(on) {
    if (on && !deep[0]?.deep) {
      const made = await loadEngine();
      if (!made) {
        group.hidden = true;
        return;
      }
      for (const pane of deep) pane.deep = makeDeepStage(pane.data, pane.stage, made, eye, shown);
      made.onLost(() => {
        group.hidden = true;
        set(false);
      });
    }
    if (on !== isDeep) set(on);
  }

  // Shows the switch, and the three-dimensional stage where it works.
  async function start() {
    if (deep.length === 0 || !findSurface()) return;
    group.hidden = false;
    if (!deep.some(({ data }) => data.depth.bodies.some(({ role }) => role === "rack"))) {
      act("across").textContent = t("front");
      act("along").textContent = t("side");
    }
    if (!asksFlat()) await choose(true);
  }

  act("deep").addEventListener("click", () => choose(true));
  act("flat").addEventListener("click", () => choose(false));
  for (const name of Object.keys(PRESETS)) act(name).addEventListener("click", () => eye.go(name));
  const toggle = () => { if (!group.hidden) choose(!isDeep); };
  return { start, choose, toggle, eye, isDeep: () => isDeep };
}
