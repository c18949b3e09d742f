// Keys of a player, and the panel that lists them.

const KEYS = [
  [t("Space"), t("play and pause")],
  ["← →", t("one frame back or forward; with Shift, ten frames")],
  ["Home End", t("first frame, last frame")],
  ["< >", t("slower, faster")],
  ["M", t("slow loop around the decisive moment")],
  ["C", t("next camera")],
  ["N P F", t("names, paths, forces")],
  ["T G", t("color by line load; other runs drawn over this run")],
  ["+ − 0", t("zoom in, zoom out, whole picture")],
  ["W A S D", t("move the picture (in 3D, turn it); dragging does the same")],
  ["V", t("switch between 3D and the flat picture, if there are both")],
  ["1 2 3 4", t("in 3D, view from the corner, across the barrels, along them, from above")],
  ["Shift W A S D", t("in 3D, move the picture")],
  ["Shift F", t("full screen and back")],
  ["?", t("these keys")],
];

// Fills the panel of keys and returns the function that opens it.
function makePanel(dialog) {
  const list = make("dl");
  for (const [keys, words] of KEYS) {
    const caps = keys.split(" ").flatMap((key) => [make("kbd", {}, key), " "]);
    list.append(make("dt", {}, ...caps), make("dd", {}, words));
  }
  const hint = make("p", {}, t("Zoom with Ctrl and the wheel, or with two fingers; a double click shows the whole picture again. In 3D, one finger turns the picture and a tap names a body. Hold the pointer over an arrow to see its force."));
  dialog.querySelector("form").before(list, hint);
  return () => (dialog.open ? dialog.close() : dialog.showModal());
}

// `actions` maps keys to functions, which receive whether Shift is held.
function listen(screen, actions) {
  screen.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("dialog")) return;
    const tag = event.target.tagName;
    // A focused control keeps the keys that operate it.
    if (tag === "SELECT" || (tag === "BUTTON" && event.key === " ")) return;
    if (tag === "INPUT" && event.target.type === "checkbox" && event.key === " ") return;
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action(event.shiftKey);
  });
}

// Until an element has the focus, Space operates the visible player, which then receives the other
// keys.
function listenEverywhere(players) {
  document.addEventListener("keydown", (event) => {
    const free = document.activeElement === null || document.activeElement === document.body;
    if (event.key !== " " || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey || !free) return;
    const inSight = players.find(({ screen }) => {
      const { top, bottom } = screen.getBoundingClientRect();
      const middle = 0.5 * (top + bottom);
      return middle > 0 && top < window.innerHeight;
    });
    if (!inSight) return;
    event.preventDefault();
    inSight.screen.focus({ preventScroll: true });
    inSight.toggle();
  });
}
