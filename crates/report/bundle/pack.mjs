// Packs three.js for pages and writes it to the standard output; `cargo xtask bundle` calls this file.

import { gzipSync } from "node:zlib";
import { buildSync } from "esbuild";

/** Largest size (bytes) in gzip, as pages hold it. */
const MOST = 150_000;

const { outputFiles } = buildSync({
  entryPoints: ["three.js"], bundle: true, minify: true, write: false,
  format: "iife", globalName: "barrelstackThree", target: "es2022", charset: "ascii", legalComments: "none",
});
const [{ contents }] = outputFiles;
const packed = gzipSync(contents, { level: 9 }).length;
console.error(`${packed} bytes in gzip, at most ${MOST}`);
if (packed > MOST) process.exit(1);
process.stdout.write(contents);
