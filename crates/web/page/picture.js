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
    if (player) await frame();
    if (own !== turn) return;
    const time = goesOn && player ? player.time() : null, playing = Boolean(player && player.isPlaying());
    const ended = time !== null && !playing && time >= player.times().at(-1);
    if (player) {
      player.take();
      player.pause();
    }
    // The opening of a run is no ghost of it.
    if (goesOn) moved = ghostly;
    const before = ghost && !still && moved && moved.length === raw.panes.length ? moved : null;
    if (before) {
      raw.overlay = "as before";
      // A ghost has none of its own.
      for (const { data: pane } of before) pane.overlay = null;
    }
    box.classList.toggle("still", still);
    box.innerHTML = markup;
    const figure = box.querySelector("figure");
    figure.querySelector("figcaption b").remove();
    player = makePlayer(raw, figure, dashes, before);
    players.splice(0, players.length, player);
    // What is shown as a ghost later are numbers alone, since panes hold on to their player.
    if (!still) [ghostly, moved] = [moved, player.panes.map((pane) => ({ data: pane.data }))];
    if (before) {
      for (const { stage } of player.panes) stage.ghosts = true;
      const check = figure.querySelector('[data-act="ghosts"]');
      check.checked = true;
    }
    if (time !== null) {
      player.seek(time);
      if (playing || ended) player.play();
    } else if (!still && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) {
      player.take();
      player.seek(player.begins);
      player.play();
    }
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
