// Opens report pages in a browser and checks what no other test can: that they run, and how they look.
//
//     BARRELSTACK=<the program> node check.mjs [--renew] [FOLDER]
//
// Pages are made in FOLDER (target/browser) by the program; without BARRELSTACK those that are
// there are taken. `--renew` keeps the looks of all pages as they are now, for the next time.
// `cargo xtask test` and `cargo xtask golden` call this file; $CHROMIUM names the browser.
//
// Exit status: 0 when all checks pass, 1 when one fails, 2 when node, a module, the browser or a
// page is missing, so that a caller can tell "broken" from "not here".

import { existsSync, readFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { accessible, spoiled } from "./lib/access.mjs";
import { PHONE, launch, missing, open } from "./lib/browser.mjs";
import { addressed, arrows, fingers, inDepth, pace, presets, shows, switches, turns, without } from "./lib/deep.mjs";
import { overlay, variants } from "./lib/ghosts.mjs";
import { Goldens, looks } from "./lib/golden.mjs";
import { cards, darkness, linkedZoom, opening, paper, phone } from "./lib/layout.mjs";
import {
  ofAftershocks, ofCellar, ofComparison, ofHeights, ofLayouts, ofMotion, ofProtection, ofReproduction, ofRun, ofScore, ofStudy,
} from "./lib/numbers.mjs";
import { PAGES, make, reportOf } from "./lib/pages.mjs";
import { links, loops, still } from "./lib/opening.mjs";
import { cameras, drawing, frameRate, keyboard, scrubbing, together } from "./lib/player.mjs";
import { Suite, demand } from "./lib/suite.mjs";
import { agreement, panels, tints, values, zooming } from "./lib/view.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const words = process.argv.slice(2);
const renew = words.includes("--renew");
const folder = resolve(words.find((word) => !word.startsWith("--")) ?? join(here, "../../../../target/browser"));
const pages = join(folder, "pages");

const browser = await launch();
if (process.env.BARRELSTACK) await make(pages);
for (const name of Object.keys(PAGES)) {
  if (!existsSync(reportOf(pages, name))) missing(`${reportOf(pages, name)} is not there; set BARRELSTACK to the program`);
}
const goldens = new Goldens(browser, pages, join(here, "golden"), join(folder, "differences"));
if (renew) {
  await goldens.renew();
  await browser.close();
  process.exit(0);
}

const suite = new Suite();
const on = (name, options, use) => open(browser, reportOf(pages, name), options, use);
const checkOn = (text, name, check) => suite.check(`${name}: ${text}`, async () => {
  let note;
  await on(name, {}, async (page) => { note = await check(page, reportOf(pages, name)); });
  return note;
});

// First what is measured, while nothing else runs.
await checkOn("plays at 30 frames a second with everything drawn", "eight", frameRate);
for (const name of ["minute", "heap"]) {
  await suite.check(`${name}: a minute of twelve barrels is small and opens at once`, () =>
    opening((use) => on(name, {}, use), reportOf(pages, name)));
}
// Two pages at a time: most checks wait for a frame or a file.
const twoAtATime = async (queue, use) => {
  const next = async () => { for (let one = queue.shift(); one; one = queue.shift()) await use(one); };
  await Promise.all([next(), next()]);
};
const used = async ([name, { several, plain }]) => {
  const long = ["minute", "heap"].includes(name);
  const moved = name !== "disc";
  const checks = plain ? [["has no finding of axe", accessible], ["is cut nowhere on a phone", cards], ["prints all its sections", paper]] : [
    ...(several ? [["all panes keep one time and one scale", together]] : [["shows the recording at ten random times", scrubbing]]),
    ["draws what it shows", drawing],
    ["heeds the keyboard, and every control has a name", keyboard],
    ...(["demo", "eight"].includes(name) ? [["has cameras that stand, ride and follow", cameras]] : []),
    ...(["demo", "eight", "levels"].includes(name) ? [["zooms its histories together", linkedZoom]] : []),
    ["zooms and pans by wheel, drag and keys", zooming],
    ...(moved ? [["shows the value of a force beside its arrow", values], ["tints barrels by their stress", tints]] : []),
    ...(name === "demo" || name === "eight" ? [["lays all variants over the run", variants]] : []),
    ...(name === "levels" ? [["lays the first run over the others", overlay]] : []),
    ["keeps cursor and slider together", agreement],
    ["lists its keys and fills the screen", panels],
    ["has no finding of axe", accessible],
    ["is dark where that is asked for", darkness],
    ["has no sideways scroll on a phone", phone],
    ["is cut nowhere on a phone", cards],
    ["prints all its sections", paper],
  ];
  let faults = [];
  try {
    faults = await open(browser, reportOf(pages, name), { strict: false }, async (page) => {
      for (const [text, check] of long ? checks.slice(0, 1) : checks) {
        await suite.check(`${name}: ${text}`, () => check(page, reportOf(pages, name)));
      }
    });
  } catch (error) {
    faults = [error.message];
  }
  await suite.check(`${name}: writes no error and asks for nothing but itself`, () => demand(faults.length === 0, faults.join("\n")));
};
await twoAtATime(Object.entries(PAGES), used);
for (const name of ["demo", "eight", "levels", "space"]) {
  const checks = {
    "shows wood where barrels are, in three dimensions": shows,
    "turns and zooms by pointer, wheel and keys": turns,
    "has the silhouettes of the flat picture": name === "space" ? null : presets,
    "shows contact forces as arrows": arrows,
    "leads to the flat picture and back": switches,
    "states its pace in three dimensions": pace,
    "has no finding of axe in three dimensions": accessible,
  };
  for (const [text, check] of Object.entries(checks).filter(([, check]) => check)) {
    await suite.check(`${name}: ${text}`, async () => {
      let note;
      await inDepth(browser, reportOf(pages, name), async (page) => { note = await check(page); });
      return note;
    });
  }
}
await suite.check("demo: is turned by a finger", () => inDepth(browser, reportOf(pages, "demo"), fingers, { viewport: PHONE, touch: true }));
await suite.check("demo: is flat where the address asks for it", () => addressed(browser, reportOf(pages, "demo")));
await suite.check("demo: is flat without WebGL", () => without(reportOf(pages, "demo")));
for (const name of ["demo", "eight", "half", "along", "levels"]) {
  await checkOn("opens on a still of what matters, where motion is unwanted", name, still);
}
for (const name of ["demo", "eight", "levels"]) {
  await suite.check(`${name}: loops slowly around what matters until somebody takes over`, () => loops(browser, reportOf(pages, name)));
}
await suite.check("demo: an instant has an address", () => links(browser, reportOf(pages, "demo")));
await twoAtATime([
  ["demo", "demo/summary.json", ofRun],
  ["eight", "eight/summary.json", ofRun],
  ["along", "along/summary.json", ofRun],
  ["space", "space/summary.json", ofRun],
  ["verify", "verify/summary.json", ofRun],
  ["levels", "levels.json", ofComparison],
  ["heights", "heights/heights.json", ofHeights],
  ["study", "study/decision.json", ofStudy],
  ["protect", "protect/protect.json", ofProtection],
  ["score", "score/rockscore.json", ofScore],
  ["motion", "motion.json", ofMotion],
  ["cellar", "cellar/cellar.json", ofCellar],
  ["layouts", "layouts/comparison.json", ofLayouts],
  ["aftershock", "aftershock/aftershocks.json", ofAftershocks],
  ["reproduce", null, ofReproduction],
], ([name, file, compared]) =>
  checkOn(file ? "states the numbers of its JSON" : "its headline counts the rows of its table", name, (page) =>
    compared(page, file && JSON.parse(readFileSync(join(pages, file))))));
await checkOn("wrong numbers are detected", "demo", async (page) => {
  const spoil = (change) => {
    const summary = JSON.parse(readFileSync(join(pages, "demo/summary.json")));
    change(summary);
    return ofRun(page, summary).then(() => false, () => true);
  };
  demand(await spoil(({ ensemble }) => { ensemble.collapsed += 1; }), "one collapse more is not detected");
  demand(await spoil(({ ensemble }) => { ensemble.range[0] += 0.02; }), "another range is not detected");
  demand(await spoil(({ bodies }) => { bodies.at(-2).peak_slip += 0.01; }), "another slip is not detected");
  demand(await spoil(({ remedy }) => { remedy.tried[0].failed += 1; }), "another count of a change is not detected");
});
await twoAtATime([
  ["protect", "protect/protect.json", ofProtection, ({ protections }) => { protections[0].motions += 1; }],
  ["score", "score/rockscore.json", ofScore, ({ states }) => { states[0].collapsed[3] += 0.02; }],
  ["motion", "motion.json", ofMotion, ({ records }) => { records[0].channels[0].measures.pgv.value *= 1.001; }],
  ["cellar", "cellar/cellar.json", ofCellar, ({ stacks }) => { stacks[0].falls.share -= 0.02; }],
  ["layouts", "layouts/comparison.json", ofLayouts, ({ layouts }) => { layouts[1].barrels_fallen.mean += 1; }],
  ["aftershock", "aftershock/aftershocks.json", ofAftershocks, ({ inspection }) => { inspection.at(-1).falls[0].share += 0.02; }],
], ([name, file, compared, change]) =>
  checkOn("a wrong number is detected", name, async (page) => {
    const document = JSON.parse(readFileSync(join(pages, file)));
    change(document);
    demand(await compared(page, document).then(() => false, () => true), "it is not");
  }));
await suite.check("axe finds what is wrong with a spoiled page", () => on("eight", {}, spoiled));
// Pictures.
await goldens.tools();
await twoAtATime(looks(), ([name, variant]) =>
  suite.check(`${name}: looks as kept, ${variant}`, () => goldens.check(name, variant)));
await suite.check("every kept picture belongs to a page", async () => goldens.orphans());
await suite.check("small defects of a page are detected", () => goldens.defects());
await browser.close();
process.exit(suite.close() ? 0 : 1);
