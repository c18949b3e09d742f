// Checks of what is laid over a player: all variants of its run, or another run of a comparison.

import { demand } from "./suite.mjs";

const pictures = (page) => page.evaluate(() => [...document.querySelectorAll(".player canvas.scene")].map((canvas) => canvas.toDataURL()));

/** The switch draws and takes away again what it promises, in the panes that have it; gives the panes that changed. */
async function switched(page) {
  await page.evaluate(() => window.barrelstack.player.seek(0.6 * window.barrelstack.player.times().at(-1)));
  const before = await pictures(page);
  const box = page.locator('.player [data-act="ghosts"]').first();
  demand(await box.isVisible(), "there is no switch for other runs");
  await box.check();
  const with_ = await pictures(page);
  await box.uncheck();
  const after = await pictures(page);
  demand(before.every((picture, at) => picture === after[at]), "something stays when the switch is off again");
  return before.map((picture, at) => picture !== with_[at]);
}

/** All variants: paths and ends of every one, among them those of the run that is shown. */
export async function variants(page) {
  const changed = await switched(page);
  demand(changed.every(Boolean), `the switch changes the panes ${changed}`);
  const found = await page.evaluate(() => window.barrelstack.player.panes.map(({ data }) => {
    const { count, paths: [xs], ends, bodies } = data.ghosts;
    const ground = data.bodies.findIndex((body) => body.role === "ground");
    const barrels = data.bodies.filter((body) => body.role === "barrel").length;
    const along = (series, at) => {
      const frame = Math.min(Math.floor(at), data.count - 2);
      return series[frame] + (at - frame) * (series[frame + 1] - series[frame]);
    };
    const pose = (body, c, at) => along(data.poses[3 * body + c], at) - (c < 2 ? along(data.poses[3 * ground + c], at) : 0);
    // How far the barrels of the variant that is nearest ended from where those that are shown are at some moment: a
    // variant ends with its verdict, and the run that is shown goes on.
    let nearest = Infinity;
    for (let first = 0; first < bodies.length; first += barrels) {
      for (let at = 0; at <= data.count - 1; at += 0.25) {
        let apart = 0;
        for (let k = first; k < first + barrels && apart < nearest; k++) {
          apart = Math.max(apart, Math.hypot(pose(bodies[k], 0, at) - ends[0][k], pose(bodies[k], 1, at) - ends[1][k]));
        }
        nearest = Math.min(nearest, apart);
      }
    }
    return { count, lines: Array.from(xs).filter((x) => isNaN(x)).length, barrels, ends: bodies.length, nearest };
  }));
  for (const { count, lines, barrels, ends, nearest } of found) {
    demand(count >= 20 && ends === count * barrels, `${ends} ends of ${barrels} barrels in ${count} variants`);
    demand(lines > 0 && lines % count === 0, `${lines} lines of ${count} variants`);
    demand(nearest < 0.02, `no variant ends where the run that is shown comes by: the nearest is ${nearest} m away`);
  }
  return `${found.map(({ count, nearest }) => `${count} variants, the one shown within ${(1000 * nearest).toFixed(0)} mm`).join("; ")}`;
}

/** In a comparison the first run is drawn over all others and not over itself. */
export async function overlay(page) {
  const changed = await switched(page);
  demand(!changed[0] && changed.slice(1).every(Boolean), `the switch changes the panes ${changed}`);
}
