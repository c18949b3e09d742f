// The pages that are checked: what is run for each, and how each is looked at.

import { spawn } from "node:child_process";
import { join } from "node:path";
import { missing } from "./browser.mjs";

const FRICTION = "interface.rack-ground.friction.coefficient";

/**
 * Pages by name: the arguments of the program without `--out`, whether several runs or planes share
 * the page, and the looks of it that are kept as pictures.
 */
export const PAGES = {
  demo: {
    several: true,
    args: ["run", "demo-napa", "--quiet"],
    looks: ["desktop-light", "desktop-dark", "phone-light", "phone-dark", "print"],
  },
  eight: {
    args: ["run", "candia-8-barrels", "--quiet"],
    looks: ["desktop-light", "desktop-dark", "phone-light", "print"],
  },
  half: {
    args: ["run", "candia-8-barrels-half-scale", "--no-remedy", "--quiet"],
    looks: ["desktop-light", "phone-dark"],
  },
  along: {
    args: ["run", "candia-8-barrels-longitudinal", "--no-remedy", "--quiet"],
    looks: ["desktop-light", "phone-light", "print"],
  },
  levels: {
    several: true,
    args: ["compare", "demo-napa", "--against", "stack.levels=4", "--quiet"],
    looks: ["desktop-light", "desktop-dark", "phone-light", "print"],
  },
  friction: {
    several: true,
    args: ["compare", "demo-napa", "--set", `${FRICTION}=0.4`, "--against", `${FRICTION}=0.1`, "--quiet"],
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
  return join(folder, name, "report.html");
}

function run(program, args) {
  return new Promise((done) => {
    const child = spawn(program, args, { stdio: ["ignore", "ignore", "pipe"] });
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
  // The longest runs first.
  const names = Object.keys(PAGES).reverse();
  const work = async () => {
    for (let name = names.shift(); name; name = names.shift()) {
      const fault = await run(program, [...PAGES[name].args, "--out", join(folder, name), "--overwrite"]);
      if (fault) throw new Error(`the page ${name} was not made: ${fault}`);
    }
  };
  await Promise.all([work(), work()]);
}
