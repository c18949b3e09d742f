// Keys of a player, and the panel that lists them.

const KEYS = [
  ["Space", "plays and pauses"],
  ["← →", "a frame back, a frame on; with Shift ten"],
  ["Home End", "the first frame, the last"],
  ["< >", "slower, faster"],
  ["M", "slow loop around the moment that matters"],
  ["C", "next camera"],
  ["N P F", "names, paths, forces"],
  ["T G", "tint by stress, other runs over this one"],
  ["+ − 0", "closer, farther, the whole picture"],
  ["W A S D", "moves the picture, or turns it in three dimensions; so does dragging it"],
  ["V", "three dimensions or the flat picture, where there are both"],
  ["1 2 3 4", "in three dimensions, from the corner, across the barrels, along them, from above"],
  ["Shift W A S D", "in three dimensions, moves what the other keys turn"],
  ["Shift F", "full screen and back"],
  ["?", "these keys"],
];

// Fills the panel of keys and gives what opens it.
function makePanel(dialog) {
  const list = make("dl");
  for (const [keys, words] of KEYS) {
    const caps = keys.split(" ").flatMap((key) => [make("kbd", {}, key), " "]);
    list.append(make("dt", {}, ...caps), make("dd", {}, words));
  }
  const hint = make("p", {}, "Ctrl and the wheel, or two fingers, zoom; a double click shows the whole picture again. In three dimensions one finger turns, and a tap names a body. Over an arrow the pointer shows its force.");
  dialog.querySelector("form").before(list, hint);
  return () => (dialog.open ? dialog.close() : dialog.showModal());
}

// `actions` hear whether shift is held, by key.
function listen(screen, actions) {
  screen.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("dialog")) return;
    const tag = event.target.tagName;
    // A focused control keeps the keys that work it.
    if (tag === "SELECT" || (tag === "BUTTON" && event.key === " ")) return;
    if (tag === "INPUT" && event.target.type === "checkbox" && event.key === " ") return;
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action(event.shiftKey);
  });
}

// Space works the player in sight before anything has been focused; the other keys follow then.
function listenEverywhere(players) {
  document.addEventListener("keydown", (event) => {
    const free = document.activeElement === null || document.activeElement === document.body;
    if (event.key !== " " || event.ctrlKey || event.metaKey || event.altKey || event.shiftKey || !free) return;
    const inSight = players.find(({ screen }) => {
      const { top, bottom } = screen.getBoundingClientRect();
      const middle = 0.5 * (top + bottom);
      return middle > 0 && middle < window.innerHeight;
    });
    if (!inSight) return;
    event.preventDefault();
    inSight.screen.focus({ preventScroll: true });
    inSight.toggle();
  });
}
