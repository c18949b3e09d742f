// The pages that are checked: what is run for each, and how each is looked at.

import { spawn } from "node:child_process";
import { closeSync, mkdirSync, openSync, rmSync } from "node:fs";
import { join } from "node:path";
import { missing } from "./browser.mjs";

/** The date and the commit that pages state, the same on every day. */
const STAMP = { SOURCE_DATE_EPOCH: "1408875644", BARRELSTACK_COMMIT: "0123456789ab" };
const ROOM = ["--set=run.duration=9 s", "--set=block.1.stacks=1"];

/**
 * Pages by name: the arguments of the program without `--out`, what is run before it (`{folder}` is that of all
 * pages; a document that is printed with `--json` is kept beside that folder), whether several runs or planes share
 * the page, whether it is looked at for readers of screens, for phones and for paper only (`plain`), its file where that
 * is not report.html, and the looks of it that are kept as pictures. Where the arguments name `{out}`, that is its folder.
 * What is run after it may print a document, too.
 */
export const PAGES = {
  demo: {
    several: true,
    args: ["run", "demo-napa", "--variants=24", "--quiet"],
    looks: ["desktop-light", "desktop-dark", "phone-light", "phone-dark", "print"],
  },
  eight: {
    args: ["run", "candia-8-barrels", "--quiet"],
    looks: ["desktop-light", "desktop-dark", "phone-light", "print"],
  },
  half: {
    plain: true,
    args: ["run", "candia-8-barrels-half-scale", "--no-remedy", "--quiet"],
    looks: ["desktop-light", "phone-dark"],
  },
  along: {
    args: ["run", "candia-8-barrels-longitudinal", "--no-remedy", "--quiet"],
    looks: ["desktop-light", "phone-light", "print"],
  },
  levels: {
    several: true,
    args: ["compare", "demo-napa", "--against", "stack.levels=4", "--variants=16", "--quiet", "--json"],
    looks: ["desktop-light", "desktop-dark", "phone-light", "print"],
  },
  // A run in space, which is turned, or shown from three sides.
  space: { plain: true, args: ["run", "demo-napa", "--set", "stack.view=spatial", "--variants=0", "--quiet"], looks: [] },
  // Pages without a player, or with others around it, for readers of screens.
  verify: { plain: true, args: ["run", "candia-8-barrels", "--verify", "--variants=8", "--quiet"], looks: [] },
  heights: { plain: true, file: "index.html", args: ["heights", "--synthetic=0", "--quiet"], looks: [] },
  study: { plain: true, file: "index.html", args: ["study", "napa-four-levels", "--quiet"], looks: [] },
  reproduce: { plain: true, file: "index.html", args: ["reproduce", "--no-studies"], looks: [] },
  select: {
    plain: true,
    file: "index.html",
    before: [1, 2].map((seed) => ["motion", "synth", "boore", "--magnitude", "6", "--distance", "8 km", `--seed=${seed}`, "--output", `{folder}/records/${seed}.at2`, "--overwrite"]),
    args: ["motion", "select", "{folder}/records", "--target", "ec8:ag=0.3,site=B", "--spectrum", "h1", "--count", "2", "--scale", "0.01..100"],
    looks: [],
  },
  protect: {
    plain: true,
    file: "index.html",
    args: ["protect", "demo-napa", "--set", "stack.levels=3", "--count=4", "--rounds=1", "--pgv=50 cm/s", "--quiet"],
    looks: [],
  },
  score: { plain: true, file: "index.html", args: ["score", "demo-napa", "--set", "stack.levels=3", "--one-in=4", "--quiet"], looks: [] },
  motion: {
    plain: true,
    file: "record.html",
    args: ["motion", "process", "napa-college-2014", "--component=H1", "--high-pass=0.2 Hz", "-o", "{out}/record.txt", "--figure", "{out}/record.html", "--overwrite"],
    after: ["motion", "info", "{out}/record.txt", "--json"],
    looks: [],
  },
  // One stack in each of two rows, for nine seconds.
  cellar: { plain: true, args: ["run", "demo-cellar", "--variants=1", ...ROOM, "--quiet"], looks: [] },
  layouts: { plain: true, args: ["compare", "demo-cellar", "--against", "stack.levels=4", "--variants=2", ...ROOM, "--quiet"], looks: [] },
  aftershock: {
    plain: true,
    args: ["aftershock", "demo-cellar", "--variants=2", ...ROOM, "--set=stack.levels=3", "--set=motion.scale.factor=0.8", "--scale=0.75,2", "--quiet"],
    looks: [],
  },
  disc: { args: ["run", "rolling-disc", "--quiet"], looks: [] },
  // A stack that stands for a minute, and one that falls early and goes on, each alone.
  minute: {
    args: ["run", "demo-napa", "--variants=0", "--set", "stack.view=transverse", "--set", "stack.levels=6", "--set", "run.duration=60 s",
      "--set", "motion.scale.factor=0.6", "--quiet"],
    looks: [],
  },
  heap: {
    args: ["run", "demo-napa", "--variants=0", "--set", "stack.view=transverse", "--set", "stack.levels=6", "--set", "run.duration=60 s",
      "--set", "run.stop_after_collapse=60 s", "--set", "motion.scale.factor=1.3", "--quiet"],
    looks: [],
  },
};

/** Where the report of a page is. */
export function reportOf(folder, name) {
  return join(folder, name, PAGES[name].file ?? "report.html");
}

function run(program, args, out) {
  return new Promise((done) => {
    const stdout = out ? openSync(out, "w") : "ignore";
    const child = spawn(program, args, { stdio: ["ignore", stdout, "pipe"], env: { ...process.env, ...STAMP } });
    if (out) closeSync(stdout);
    let said = "";
    child.stderr.on("data", (text) => { said += text; });
    child.on("error", (error) => done(error.message));
    child.on("close", (status) => done(status === 0 ? null : said.trim() || `status ${status}`));
  });
}

/** Makes all pages anew with the program of $BARRELSTACK, two at a time. */
export async function make(folder) {
  const program = process.env.BARRELSTACK;
  if (!program) missing("set BARRELSTACK to the program, or give the folder of pages made before");
  mkdirSync(join(folder, "records"), { recursive: true });
  // The longest runs first.
  const names = Object.keys(PAGES).reverse();
  const work = async () => {
    for (let name = names.shift(); name; name = names.shift()) {
      rmSync(join(folder, name), { recursive: true, force: true });
      const { before = [], args, after } = PAGES[name], own = join(folder, name);
      const placed = args.some((word) => word.includes("{out}"));
      if (placed) mkdirSync(own, { recursive: true });
      const steps = [...before, placed ? args : [...args, "--out", own], ...(after ? [after] : [])];
      let fault = null;
      for (const step of steps) {
        const out = step.includes("--json") ? `${join(folder, name)}.json` : null;
        fault ??= await run(program, step.map((word) => word.replace("{folder}", folder).replace("{out}", own)), out);
      }
      if (fault) throw new Error(`the page ${name} was not made: ${fault}`);
    }
  };
  await Promise.all([work(), work()]);
}
