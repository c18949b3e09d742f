// What the reader chose: a scenario, bundled or opened, and the changes made to it. A request to
// the engine, a command line and a link express the same choice.

// Quotes a word for a shell.
const shellWord = (word) => (/^[\w\-./=:,+]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

// `base` is { name, text, own }, where `own` is true if the scenario was opened and is not bundled.
function makeCellar(base) {
  return { base, changes: {}, records: [] };
}

// Returns a copy to which changes may be made.
const copied = ({ base, changes, records }) => ({ base, changes: { ...changes }, records });

const setOf = ({ changes }) => Object.entries(changes).map(([path, value]) => `${path}=${value}`);

// Returns a key of a cellar; it contains everything except the bytes of the records.
const keyOf = (cellar) => JSON.stringify([cellar.base.name, cellar.base.text, cellar.changes, cellar.records.map(({ path }) => path)]);

// Returns the head of a request for a cellar.
function headOf(cellar, ask, more) {
  const { base } = cellar;
  return { ask, scenario: base.text, name: base.own ? base.name : `${base.name}.toml`, set: setOf(cellar), ...more };
}

// Returns the command that gives bit-identical results, preceded by a command that joins the files
// of a record, if there are several.
function commandOf(cellar) {
  const made = cellar.records.filter(({ of }) => of).map(({ path, of, reading }) => {
    const told = [...(reading.unit ? ["--unit", reading.unit] : []), ...(reading.time_step ? ["--time-step", `${reading.time_step} s`] : [])];
    return `barrelstack motion convert ${[...of, ...told, "-o", path].map(shellWord).join(" ")}\n`;
  });
  const set = setOf(cellar).filter((change) => !change.startsWith("motion.record="));
  const own = cellar.records.map(({ path }) => ` --record ${shellWord(path)}`);
  const words = set.map((change) => ` --set ${shellWord(change)}`);
  const tongue = language === "en" ? "" : ` --language ${language}`;
  return `${made.join("")}barrelstack run ${shellWord(cellar.base.name)}${own.join("")}${words.join("")}${tongue}`;
}

async function through(stream, bytes) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

// Returns the whole scenario as the end of an address; a record of the reader is included by name
// only.
async function linkOf({ base, changes, records }) {
  const told = { base: base.own ? { name: base.name, text: base.text } : { name: base.name }, changes, records: records.map(({ path }) => path) };
  const packed = await through(new CompressionStream("gzip"), new TextEncoder().encode(JSON.stringify(told)));
  let raw = "";
  for (const byte of packed) raw += String.fromCharCode(byte);
  return "#s=" + btoa(raw).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

// Reads a link: returns { base, changes, missing }, where `missing` lists the records that must be
// given again; none if the end of the address is not a link.
async function linked(hash, scenarios) {
  const found = /^#s=([\w-]+)$/.exec(hash);
  if (!found) return null;
  const packed = bytesOf(found[1].replaceAll("-", "+").replaceAll("_", "/"));
  const told = JSON.parse(new TextDecoder().decode(await through(new DecompressionStream("gzip"), packed)));
  const base = told.base.text === undefined ? scenarios.find(({ name }) => name === told.base.name) : { ...told.base, own: true };
  if (!base) throw new Error(t("this program has no scenario {1}", `"${told.base.name}"`));
  const missing = told.records || [];
  const changes = { ...told.changes };
  if (missing.length > 0) delete changes["motion.record"];
  return { cellar: { base, changes, records: [] }, missing };
}
