// What is asked for: a scenario that comes with the program or was opened, and the changes made to it. The same in a
// request to the engine, on a command line, and in a link.

// As a shell takes it for one word.
const shellWord = (word) => (/^[\w\-./=:,+]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

// `base` is { name, text, own }, where `own` says that it was opened and is none of the program's.
function makeCellar(base) {
  return { base, changes: {}, records: [] };
}

// A copy to which changes may be made.
const copied = ({ base, changes, records }) => ({ base, changes: { ...changes }, records });

const setOf = ({ changes }) => Object.entries(changes).map(([path, value]) => `${path}=${value}`);

// What two cellars of the same have in common, but for the bytes of their records.
const keyOf = (cellar) => JSON.stringify([cellar.base.name, cellar.base.text, cellar.changes, cellar.records.map(({ path }) => path)]);

// The request for it.
function headOf(cellar, ask, more) {
  const { base } = cellar;
  return { ask, scenario: base.text, name: base.own ? base.name : `${base.name}.toml`, set: setOf(cellar), ...more };
}

// The command that gives the same bits; that which makes one file of several goes before it.
function commandOf(cellar) {
  const made = cellar.records.filter(({ of }) => of).map(({ path, of, reading }) => {
    const told = [...(reading.unit ? ["--unit", reading.unit] : []), ...(reading.time_step ? ["--time-step", `${reading.time_step} s`] : [])];
    return `barrelstack motion convert ${[...of, ...told, "-o", path].map(shellWord).join(" ")}\n`;
  });
  const set = setOf(cellar).filter((change) => !change.startsWith("motion.record="));
  const own = cellar.records.map(({ path }) => ` --record ${shellWord(path)}`);
  const words = set.map((change) => ` --set ${shellWord(change)}`);
  return `${made.join("")}barrelstack run ${shellWord(cellar.base.name)}${own.join("")}${words.join("")}`;
}

async function through(stream, bytes) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

// The whole scenario as the end of an address; a record of one's own goes by its name only.
async function linkOf({ base, changes, records }) {
  const told = { base: base.own ? { name: base.name, text: base.text } : { name: base.name }, changes, records: records.map(({ path }) => path) };
  const packed = await through(new CompressionStream("gzip"), new TextEncoder().encode(JSON.stringify(told)));
  let raw = "";
  for (const byte of packed) raw += String.fromCharCode(byte);
  return "#s=" + btoa(raw).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

// What a link holds: { base, changes, missing }, where `missing` names the records that are to be given again; none for
// the end of an address that is no link.
async function linked(hash, scenarios) {
  const found = /^#s=([\w-]+)$/.exec(hash);
  if (!found) return null;
  const packed = bytesOf(found[1].replaceAll("-", "+").replaceAll("_", "/"));
  const told = JSON.parse(new TextDecoder().decode(await through(new DecompressionStream("gzip"), packed)));
  const base = told.base.text === undefined ? scenarios.find(({ name }) => name === told.base.name) : { ...told.base, own: true };
  if (!base) throw new Error(`this program has no scenario "${told.base.name}"`);
  const missing = told.records || [];
  const changes = { ...told.changes };
  if (missing.length > 0) delete changes["motion.record"];
  return { cellar: { base, changes, records: [] }, missing };
}
