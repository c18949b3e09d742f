// Pages as they looked when somebody last looked at them: blocks in their places, and pictures.
//
// Every page is drawn with one font on every machine. Kept are, for each look of a page, the boxes
// of its blocks (layout.json) and a picture shrunk to a quarter. A look fails when blocks come,
// go or change their size by more than LAYOUT, or when in one block, beside GRAIN
// pixels, more than CHANGED of them differ by more than STEP.

import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { DESKTOP, PHONE, open, unroll } from "./browser.mjs";
import { prepare } from "./pixels.mjs";
import { PAGES, reportOf } from "./pages.mjs";
import { demand } from "./suite.mjs";

const SCALE = 4;
/** Share of a color's range by which a shrunk and blurred pixel may differ. */
const STEP = 0.06;
/** Pixels of a block that may differ by more for the grain of the kept picture; a heading on a phone has 600. */
const GRAIN = 20;
/** Share of the pixels of a block that may differ beside them. */
const CHANGED = 0.01;
/** How far (px, or share of the size) a block may be larger or smaller. */
const LAYOUT = { pixels: 6, share: 0.02 };

/** A sheet of A4 without its margins (px). */
const SHEET = { width: 680, height: 960 };

const LOOKS = {
  "desktop-light": { viewport: DESKTOP, colorScheme: "light" },
  "desktop-dark": { viewport: DESKTOP, colorScheme: "dark" },
  "phone-light": { viewport: PHONE, colorScheme: "light" },
  "phone-dark": { viewport: PHONE, colorScheme: "dark" },
  print: { viewport: SHEET, colorScheme: "light", print: true },
};

/** A page as it looks: blocks and the picture of all of it. `change` may spoil it first. */
async function look(browser, path, name, change) {
  const { print, ...options } = LOOKS[name];
  let seen;
  await open(browser, path, { ...options, pinned: true }, async (page) => {
    if (print) {
      await page.emulateMedia({ media: "print" });
      await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    } else {
      await page.evaluate(() => {
        const { player } = window.barrelstack;
        player?.seek(0.66 * player.times().at(-1));
        for (const fold of document.querySelectorAll("details:has(figure)")) fold.open = true;
      });
      await unroll(page);
    }
    if (change) await page.evaluate(change);
    // What a fold holds is looked at by itself: in a block as long as a page nobody sees that a line is gone.
    const places = "body > header, main > :not(details:has(figure)), details:has(figure) > .folded > :not(.on-screen), .folded > .on-screen > *";
    const blocks = await page.evaluate((places) => [...document.querySelectorAll(places)]
      .map((element) => ({ element, box: element.getBoundingClientRect() }))
      .filter(({ box }) => box.width > 0 && box.height > 0)
      .map(({ element, box }) => ({
        what: element.tagName.toLowerCase() + (element.id ? "#" + element.id : element.classList[0] ? "." + element.classList[0] : ""),
        box: [box.x, box.y + window.scrollY, box.width, box.height].map(Math.round),
      })), places);
    const picture = await page.screenshot({ fullPage: true, animations: "disabled", timeout: 120_000 });
    seen = { blocks, picture: "data:image/png;base64," + picture.toString("base64") };
  });
  return seen;
}

const boxOf = ([x, y, width, height]) => ({ x, y, width, height });
const names = () => Object.entries(PAGES).flatMap(([page, { looks }]) => looks.map((one) => [page, one]));

export class Goldens {
  constructor(browser, pages, kept, differences) {
    Object.assign(this, { browser, pages, kept, differences });
    this.layoutPath = join(kept, "layout.json");
    this.layout = existsSync(this.layoutPath) ? JSON.parse(readFileSync(this.layoutPath, "utf8")) : {};
  }

  async tools() {
    if (!this.page) {
      this.page = await this.browser.newPage();
      await prepare(this.page);
    }
    return this.page;
  }

  /** Keeps all looks as they are now. */
  async renew() {
    rmSync(this.kept, { recursive: true, force: true });
    mkdirSync(this.kept, { recursive: true });
    const page = await this.tools();
    const lines = [];
    let bytes = 0;
    for (const [name, variant] of names()) {
      const seen = await look(this.browser, reportOf(this.pages, name), variant);
      const data = Buffer.from(await page.evaluate(([url, scale]) => window.shrink(url, scale), [seen.picture, SCALE]), "base64");
      writeFileSync(join(this.kept, `${name}-${variant}.webp`), data);
      bytes += data.length;
      lines.push(`${JSON.stringify(`${name}-${variant}`)}: [\n${seen.blocks.map((b) => "  " + JSON.stringify(b)).join(",\n")}\n]`);
    }
    writeFileSync(this.layoutPath, `{\n${lines.join(",\n")}\n}\n`);
    console.log(`${lines.length} looks kept in ${this.kept}, ${(bytes / 1e3).toFixed(0)} kB of pictures`);
  }

  /** How a look differs from the kept one: largest share of changed pixels, and what moved. */
  async difference(name, variant, change) {
    const id = `${name}-${variant}`;
    const path = join(this.kept, `${id}.webp`);
    demand(this.layout[id] && existsSync(path), `${id} is not kept yet: run \`cargo xtask golden\` and look at what it keeps`);
    const seen = await look(this.browser, reportOf(this.pages, name), variant, change);
    const keptUrl = "data:image/webp;base64," + readFileSync(path).toString("base64");
    const was = this.layout[id];
    const faults = [];
    const listed = (blocks) => blocks.map((block) => block.what).join(" ");
    if (listed(was) !== listed(seen.blocks)) {
      faults.push(`the blocks were: ${listed(was)}`, `and are now: ${listed(seen.blocks)}`);
    }
    const pairs = was.flatMap((old) => {
      const now = seen.blocks.find((block) => block.what === old.what && !block.taken);
      if (!now) return [];
      now.taken = true;
      return [{ what: old.what, was: boxOf(old.box), is: boxOf(now.box) }];
    });
    for (const { what, was: old, is } of pairs) {
      for (const side of ["x", "width", "height"]) {
        const most = Math.max(LAYOUT.pixels, LAYOUT.share * old[side]);
        if (Math.abs(is[side] - old[side]) > most) faults.push(`${what}: ${side} ${is[side]} px, was ${old[side]} px`);
      }
    }
    const page = await this.tools();
    const shares = await page.evaluate(([now, kept, scale, pairs, step, grain]) => window.compare(now, kept, scale, pairs, step, grain),
      [seen.picture, keptUrl, SCALE, pairs, STEP, GRAIN]);
    let worst = 0;
    shares.forEach((share, at) => {
      worst = Math.max(worst, share);
      if (share > CHANGED) faults.push(`${pairs[at].what}: ${(100 * share).toFixed(1)} % of it looks different, at most ${100 * CHANGED} % may`);
    });
    return { worst, faults, seen, keptUrl, id };
  }

  /** Compares one look; a failure leaves a picture of the difference. */
  async check(name, variant) {
    const { worst, faults, seen, keptUrl, id } = await this.difference(name, variant);
    if (faults.length > 0) {
      const page = await this.tools();
      const sheet = await page.evaluate(([now, kept, scale]) => window.difference(now, kept, scale), [seen.picture, keptUrl, SCALE]);
      mkdirSync(this.differences, { recursive: true });
      const at = join(this.differences, `${id}.png`);
      writeFileSync(at, Buffer.from(sheet, "base64"));
      faults.push(`kept, now and their difference: ${at}`, "where the change is meant, run `cargo xtask golden` and look at what it keeps");
      throw new Error(faults.join("\n"));
    }
    return `${(100 * worst).toFixed(2)} % of a block at most`;
  }

  /** Pictures that no page has any more would be kept for ever. */
  orphans() {
    const known = new Set(names().map(([name, variant]) => `${name}-${variant}.webp`).concat("layout.json"));
    const there = existsSync(this.kept) ? readdirSync(this.kept) : [];
    const orphans = there.filter((file) => !known.has(file));
    demand(orphans.length === 0, `kept, but of no page: ${orphans.join(", ")}`);
  }

  /** Spoils a page in small ways and demands that each defect is detected. */
  async defects() {
    const spoilers = {
      "the lines of a plot are gone": () => { document.querySelector("#figure-displacements .live .canvas").style.visibility = "hidden"; },
      "the player shows another time": () => window.barrelstack.player.seek(0),
      "a table has lost its numbers": () => { for (const cell of document.querySelectorAll("details:has(figure) td.number")) cell.style.color = "transparent"; },
      "a figure is twice as high": () => { document.querySelectorAll("main figure")[1].style.height = "900px"; },
      "the verdict says something else": () => { document.querySelector(".verdict h1").textContent = "The stack stands."; },
    };
    const seen = [];
    for (const [name, spoil] of Object.entries(spoilers)) {
      const { worst, faults } = await this.difference("demo", "desktop-light", spoil);
      demand(faults.length > 0, `nobody sees that ${name}: ${(100 * worst).toFixed(2)} % of a block changed`);
      seen.push(`${(100 * worst).toFixed(1)} %`);
    }
    return `${seen.length} defects detected (${seen.join(", ")})`;
  }
}

export { names as looks };
