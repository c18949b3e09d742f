// The picture of the stack: at rest, or in motion with the previous run as a ghost.

// `box` is the container of the picture; `players` is the list of players that keys operate.
function makePicture(box, players) {
  let player = null, moved = null, ghostly = null, turn = 0; // the player shown, and the panes of the last motion and of the one before

  // `ghost` keeps the previous motion as dashed lines over the new one; `goesOn` says that this
  // continues the current motion.
  async function put({ markup, data }, { still = false, ghost = false, goesOn = false }) {
    const own = (turn += 1);
    // A worker has parsed the data, or they came with the page.
    const { players: [read], dashes } = typeof data === "string" ? JSON.parse(data) : data;
    const raw = { ...read };
    // The new picture is built in pieces, one per frame, below the current one, which continues
    // meanwhile.
    const shot = make("div", { class: still ? "still" : "" });
    const isLate = async () => {
      if (player) await frame();
      if (own !== turn) shot.remove();
      return own !== turn;
    };
    if (await isLate()) return;
    // The opening of a run is not a ghost of the same run.
    const last = goesOn ? ghostly : moved;
    const before = ghost && !still && last && last.length === raw.panes.length ? last : null;
    if (before) {
      raw.overlay = t("as before");
      // A ghost has no ghost of its own.
      for (const { data: pane } of before) pane.overlay = null;
    }
    shot.innerHTML = markup;
    shot.classList.toggle("coming", Boolean(player));
    box.append(shot);
    const figure = shot.querySelector("figure");
    figure.querySelector("figcaption b").remove();
    if (await isLate()) return;
    const next = makePlayer(raw, figure, dashes, before);
    // For readers who prefer reduced motion, the picture stays on its opening still.
    const moves = !still && ((goesOn && player) || !window.matchMedia("(prefers-reduced-motion: reduce)").matches);
    if (moves) next.take();
    if (before) {
      for (const { stage } of next.panes) stage.ghosts = true;
      figure.querySelector('[data-act="ghosts"]').checked = true;
    }
    const now = () => (goesOn && player ? player.time() : null);
    if (await isLate()) return;
    if (moves) next.stand(now() ?? next.begins);
    next.refresh();
    if (await isLate()) return;
    const time = now(), playing = Boolean(player && player.isPlaying());
    const ended = time !== null && !playing && time >= player.times().at(-1);
    if (player) {
      player.take();
      player.pause();
    }
    if (time !== null) next.stand(time);
    shot.classList.remove("coming");
    box.replaceChildren(shot);
    player = next;
    players.splice(0, players.length, player);
    // Ghosts keep only numbers, because panes hold on to their player.
    if (!still) [ghostly, moved] = [last, player.panes.map((pane) => ({ data: pane.data }))];
    if (moves && (time === null || playing || ended)) player.play();
  }

  // Waits for the next frame; a page out of sight has none.
  const frame = () => new Promise((next) => {
    requestAnimationFrame(() => setTimeout(next));
    setTimeout(next, 200);
  });

  return {
    put,
    refresh: () => { if (player) player.refresh(); },
    isMoving: () => Boolean(player && player.isPlaying()),
    player: () => player,
  };
}
