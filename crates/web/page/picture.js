// The picture of the stack: standing, or in motion with the run before it as a ghost.

// `box` is where it goes; `players` is the list that keys work on.
function makePicture(box, players) {
  let player = null, moved = null, ghostly = null, turn = 0; // what is shown, and the panes that moved last and before that

  // `ghost` says that what moved before stays, as dashed lines over what comes; `goesOn` that this is more of what is
  // in motion.
  async function put({ markup, data }, { still = false, ghost = false, goesOn = false }) {
    const own = (turn += 1);
    // A worker has read it, or it came with the page.
    const { players: [read], dashes } = typeof data === "string" ? JSON.parse(data) : data;
    const raw = { ...read };
    // What comes is made in pieces, a frame apart, under what is shown, which goes on meanwhile.
    const shot = make("div", { class: still ? "still" : "" });
    const isLate = async () => {
      if (player) await frame();
      if (own !== turn) shot.remove();
      return own !== turn;
    };
    if (await isLate()) return;
    // The opening of a run is no ghost of it.
    const last = goesOn ? ghostly : moved;
    const before = ghost && !still && last && last.length === raw.panes.length ? last : null;
    if (before) {
      raw.overlay = "as before";
      // A ghost has none of its own.
      for (const { data: pane } of before) pane.overlay = null;
    }
    shot.innerHTML = markup;
    shot.classList.toggle("coming", Boolean(player));
    box.append(shot);
    const figure = shot.querySelector("figure");
    figure.querySelector("figcaption b").remove();
    if (await isLate()) return;
    const next = makePlayer(raw, figure, dashes, before);
    // Where motion is unwanted it stays on the still that it opens with.
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
    // What is shown as a ghost later are numbers alone, since panes hold on to their player.
    if (!still) [ghostly, moved] = [last, player.panes.map((pane) => ({ data: pane.data }))];
    if (moves && (time === null || playing || ended)) player.play();
  }

  // After the next frame; a page that is not in sight has none.
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
