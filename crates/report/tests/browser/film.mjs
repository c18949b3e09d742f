// The pictures of the README: the demo's page as it opens, and its stack in three dimensions, frame by frame, as a GIF.
//
//   node film.mjs REPORT.html OUT.gif PAGE.png
//
// `cargo xtask film` makes the page and calls this.

import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

import { launch } from "./lib/browser.mjs";

const FROM = 5.5, TO = 12.5; // time (s) of the run that is shown, at its own pace
const RATE = 8; // frames (1/s)
const LAST = 1500; // how long the last frame stays (ms)
const COLORS = 64;
const WIDTH = 640; // of the picture (px)
const CLOSER = 1.15; // than a page shows the stack

const [report, out, opened] = process.argv.slice(2);
const require = createRequire(import.meta.url);
const browser = await launch(["--use-gl=swiftshader", "--enable-unsafe-swiftshader"]);
const page = await browser.newPage({ viewport: { width: 1000, height: 900 }, reducedMotion: "reduce" });
await page.goto(pathToFileURL(report).href);
await page.evaluate(() => window.barrelstack.deep);
await page.screenshot({ path: opened, clip: { x: 0, y: 0, width: 1000, height: 760 } });
const box = await page.evaluate((closer) => {
  window.barrelstack.player.views.eye.factor = closer;
  document.querySelectorAll('[data-act="names"], [data-act="traces"]').forEach((one) => { if (one.checked) one.click(); });
  const boxes = [...document.querySelectorAll("canvas.scene")].filter((one) => one.checkVisibility()).map((one) => one.getBoundingClientRect());
  const x = Math.min(...boxes.map((one) => one.left)), y = Math.min(...boxes.map((one) => one.top));
  return { x, y: y + window.scrollY, width: Math.max(...boxes.map((one) => one.right)) - x, height: Math.max(...boxes.map((one) => one.bottom)) - y };
}, CLOSER);
const pictures = [];
for (let frame = 0; frame <= (TO - FROM) * RATE; frame++) {
  await page.evaluate((time) => new Promise((done) => {
    window.barrelstack.player.seek(time);
    requestAnimationFrame(() => requestAnimationFrame(done));
  }), FROM + frame / RATE);
  pictures.push((await page.screenshot({ clip: box, fullPage: true })).toString("base64"));
}

// The encoder takes pixels, which the browser reads out of its own pictures.
const encoder = await browser.newPage();
await encoder.addScriptTag({ content: `${readFileSync(require.resolve("gifenc"), "utf8").replace(/^/, "var exports={};")};window.gifenc=exports` });
const gif = await encoder.evaluate(async ({ pictures, width, delay, last, colors }) => {
  const { GIFEncoder, quantize, applyPalette } = window.gifenc;
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d", { willReadFrequently: true });
  const pixels = async (picture) => {
    const image = new Image();
    image.src = `data:image/png;base64,${picture}`;
    await image.decode();
    [canvas.width, canvas.height] = [width, Math.round((width * image.height) / image.width)];
    context.imageSmoothingQuality = "high";
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    return context.getImageData(0, 0, canvas.width, canvas.height).data;
  };
  // One palette for all, so that what stands still stays as it is.
  const middle = await pixels(pictures[pictures.length >> 1]), palette = quantize(middle, colors);
  const encoder = GIFEncoder();
  for (const [at, picture] of pictures.entries()) {
    const index = applyPalette(await pixels(picture), palette);
    encoder.writeFrame(index, canvas.width, canvas.height, { palette: at === 0 ? palette : undefined, delay: at + 1 < pictures.length ? delay : last });
  }
  encoder.finish();
  let text = "";
  for (const byte of encoder.bytes()) text += String.fromCharCode(byte);
  return btoa(text);
}, { pictures, width: WIDTH, delay: 1000 / RATE, last: LAST, colors: COLORS });
await browser.close();
writeFileSync(out, Buffer.from(gif, "base64"));
console.log(`${out}: ${pictures.length} frames, ${Math.round((gif.length * 0.75) / 1000)} kB`);
