// The page in Spanish: what its reader sees is Spanish, and its numbers are those of the program.

import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { accessible } from "../../report/tests/browser/lib/access.mjs";
import { DESKTOP, PHONE } from "../../report/tests/browser/lib/browser.mjs";
import { demand } from "../../report/tests/browser/lib/suite.mjs";
import { PATIENCE, drop, idle, last, look, opened, sameSpreads, type } from "./using.mjs";

/** English words that are no Spanish words and no part of a command, a key or a name. */
const ENGLISH = /(?<!\p{L})(the|and|with|without|this|that|which|of|from|falls?|stands?|stack|barrels?|levels?|shaken|shaking|variants?|strength|fields?|file|run|report|device|given|default|warnings?|seconds?|largest|across|along)(?!\p{L})/iu;

/** The lines of text that a reader sees, and the texts that a screen reader says. */
const texts = (frame) => frame.evaluate(() => {
  for (const fold of document.querySelectorAll("details")) fold.open = true;
  // Commands, keys and values of the scenario, names of files and of organizations are the same in all languages.
  const kept = "script, style, code, pre, kbd, textarea, [translate=no], #files, #field-rows td:first-child, [data-name=valor]";
  const found = [];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const { parentElement: element, textContent } = walk.currentNode;
    if (textContent.trim() && !element.closest(kept)) found.push(textContent.trim());
  }
  for (const name of ["aria-label", "title", "placeholder", "aria-valuetext"]) {
    for (const element of document.querySelectorAll(`[${name}]`)) {
      if (!element.closest(kept) && !element.closest("#field-rows")) found.push(element.getAttribute(name));
    }
  }
  return found;
});

/** What is quoted, a key, or a name is no English text. */
const plain = (text) => text.replace(/"[^"]*"|`[^`]*`|“[^”]*”|\b[\w-]+[-._=][\w.=-]+|Dimensions of a Bordeaux Barrel|California Geological Survey/g, "");

export async function checkSpanish(browser, suite, { file, english, native }) {
  const { page, faults, context } = await opened(browser, file);
  const spanish = async (frame, least) => {
    const found = await texts(frame);
    const wrong = [...new Set(found.filter((text) => ENGLISH.test(plain(text))))];
    demand(found.length >= least, `only ${found.length} texts`);
    demand(wrong.length === 0, `${wrong.length} texts are English:\n${wrong.join("\n")}`);
    return `${found.length} texts`;
  };
  await suite.check("the page in Spanish is Spanish, with all its fields", async () => {
    demand((await page.getAttribute("html", "lang")) === "es", "another language");
    demand(!readFileSync(english, "utf8").includes('id="language"'), "the page in English holds translations");
    await type(page, { "imperfections.variants": "3", "run.duration": '"9 s"' });
    await page.waitForFunction(() => document.querySelectorAll("#field-rows tr").length > 50);
    return spanish(page, 300);
  });
  await suite.check("its verdict is Spanish, with the numbers of the program", async () => {
    await page.click("#go");
    await idle(page, 1);
    const { verdict } = await last(page);
    const sets = ["--set", "imperfections.variants=3", "--set", "run.duration=9 s"];
    sameSpreads(verdict, JSON.parse(native("run", "demo-napa", ...sets, "--json", "--quiet", "--no-remedy")));
    demand(/variantes|permanece|cae/i.test(verdict.headline), verdict.headline);
    demand((await page.textContent("#command")).trim().endsWith(" --language es"), await page.textContent("#command"));
    await page.click("#changes button >> nth=0");
    await idle(page, 2);
    await page.locator("#devices-box").waitFor();
    await page.click("#devices-go");
    await page.waitForFunction(() => document.getElementById("devices-go").checkVisibility());
    await page.click("#heights-go");
    await page.waitForFunction(() => window.barrelstack.heights?.filter(({ run }) => run > 0).length >= 3);
    await page.click("#heights-stop");
    await drop(page, [["foto.png", Buffer.from("\x89PNG\r\n")]]);
    await page.waitForFunction(() => document.getElementById("given").textContent.includes("foto.png"));
    await spanish(page, 500);
    return verdict.headline;
  });
  await suite.check("its report and the files of the report are Spanish", async () => {
    await page.click("#report-go");
    await page.waitForFunction(() => !document.getElementById("report").hidden);
    const frame = page.frames().find((one) => one !== page.mainFrame());
    await frame.waitForFunction(() => window.barrelstack?.opened > 0);
    demand((await frame.getAttribute("html", "lang")) === "es", "another language");
    return spanish(frame, 500);
  });
  await suite.check("a mistake is told in Spanish, at its line", async () => {
    await page.fill("#text", (await page.inputValue("#text")).replace("levels = ", "levles = "));
    await page.waitForFunction(() => document.getElementById("text-said").textContent.includes("quiso decir `levels`"));
    demand(/mine\.toml:\d+:\d+/.test(await page.textContent("#text-said")), await page.textContent("#text-said"));
  });
  await suite.check("it has asked for nothing and written nothing on the console", () => demand(faults.length === 0, faults.join("\n")));
  await suite.check("its link opens the same stack in English, and back", async () => {
    const resolved = (await look(page)).resolved;
    for (const [name, lang] of [["English", "en"], ["Español", "es"]]) {
      const link = page.locator(".languages a:visible");
      demand((await link.allTextContents()).join() === name, (await link.allTextContents()).join());
      await Promise.all([page.waitForNavigation(), link.click()]);
      await page.waitForFunction((lang) => document.documentElement.lang === lang && window.barrelstack?.started > 0, lang);
      await page.waitForFunction((resolved) => window.barrelstack.state().look.resolved === resolved, resolved);
    }
  });
  await suite.check("nothing for axe to find in it, and on a phone nothing scrolls sideways", async () => {
    await accessible(page);
    await page.setViewportSize(PHONE);
    await page.waitForTimeout(300);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    demand(wide <= PHONE.width, `${wide} px wide`);
  });
  await context.close();
  await suite.check("a report in Spanish answers with it, without a link to a file that is not there", async () => {
    const folder = mkdtempSync(join(tmpdir(), "barrelstack-page-"));
    const out = join(folder, "out");
    native("run", "demo-napa", "--set", "stack.levels=2", "--set", "run.duration=5 s", "--variants", "2", "--out", out, "--quiet", "--no-remedy", "--language", "es", "--with-engine", file);
    const context = await browser.newContext({ viewport: DESKTOP });
    const report = await context.newPage();
    await report.goto(pathToFileURL(join(out, "report.html")).href);
    await report.click("#try");
    await report.locator("#trial iframe").waitFor();
    const frame = report.frames().find((one) => one !== report.mainFrame());
    await frame.waitForFunction(() => window.barrelstack?.started > 0, null, { timeout: PATIENCE });
    demand(!(await frame.isVisible(".languages a")), "there is a link");
    const note = await spanish(frame, 100);
    await context.close();
    rmSync(folder, { recursive: true });
    return note;
  });
}
