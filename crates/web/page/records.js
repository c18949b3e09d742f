// Records of the reader: files that are dropped or chosen become motions, and the page reports the
// use of each file.

const UNITS = [["g", "1 g"], ["m/s2", "1 m/s^2"], ["cm/s2", "1 cm/s^2"], ["mm/s2", "1 mm/s^2"]];

// Returns all dropped files, including those in folders.
async function filesIn(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry && item.webkitGetAsEntry());
  if (!entries.some((entry) => entry && entry.isDirectory)) return [...transfer.files];
  const found = [];
  const walk = async (entry) => {
    if (!entry) return;
    if (entry.isFile) return found.push(await new Promise((done, fail) => entry.file(done, fail)));
    const reader = entry.createReader();
    for (let some = [null]; some.length > 0;) {
      some = await new Promise((done, fail) => reader.readEntries(done, fail));
      for (const one of some) await walk(one);
    }
  };
  for (const entry of entries) await walk(entry);
  return found;
}

// `shake` uses a motion in the current cellar and returns the resolved scenario; none if it is
// refused.
function makeRecords(find, { desk, shake, refuse }) {
  let motions = [], unread = null; // the given motions; the files that lack a unit or a step, with what the reader stated about them

  // Reads the motions of files, and lists the files that cannot be read.
  async function read(files, reading) {
    const { head, rest } = partsOf(await desk.ask({ ask: "records", reading }, { records: files, urgency: 2, group: "look" }));
    let at = 0;
    const found = head.motions.map(({ name, files: of, channels, length }) => {
      at += length;
      if (length > 0) return { path: name, bytes: rest.slice(at - length, at), of, reading, channels };
      return { path: name, bytes: files.find(({ path }) => path === name).bytes, told: reading, channels };
    });
    return { found, refused: head.refused };
  }

  async function take(files, reading = {}) {
    if (files.length === 0) return;
    find("given").replaceChildren();
    find("unsaid").hidden = true;
    try {
      const { found, refused } = await read(files, reading);
      const lines = refused.map(({ file, why }) => t("No record: {1}", why).replace(`${file}: ${file}`, file));
      if (found.length > 0) {
        const look = await shake(found[0]);
        if (!look) return;
        motions = found;
        lines.unshift(...told(found[0], look));
      } else lines.push(t("The stack is shaken as before. A record is a file of accelerations, as published by agencies."));
      say(lines);
      ask(files, refused, reading);
      offer();
    } catch (error) {
      refuse(error);
    }
  }

  const say = (lines) => find("given").replaceChildren(...lines.map((line) => make("li", {}, line)));

  // Describes the use of each file, if one of the motions shakes the stack.
  function told(motion, look) {
    const lines = motions.length > 1
      ? [...motions.map(({ path, of }) => (of ? t("{1} is a separate earthquake, from {2}", path, of.join(", ")) : t("{1} is a separate earthquake", path))), t("{1} shakes the stack; the chart of heights uses all {2} motions.", motion.path, motions.length)]
      : motion.channels;
    const plane = ({ view, motion }) => (view === "longitudinal" ? t("along the barrels by {1}", motion.name) : t("across the barrels by {1}", motion.name));
    const up = look.checked[0].motion.vertical ? t("and up and down") : t("but not up and down");
    return [...lines, t("The stack is shaken {1}, {2}.", look.checked.map(plane).join(", "), up)];
  }

  // Asks the reader for information that a file lacks.
  function ask(files, refused, reading) {
    const missing = refused.map(({ missing }) => missing).filter(Boolean);
    find("unsaid").hidden = missing.length === 0;
    if (missing.length === 0) return;
    unread = { files, reading };
    find("unsaid-unit").closest("label").hidden = !missing.some((what) => what.includes("unit"));
    find("unsaid-step").closest("label").hidden = !missing.includes("step");
  }

  // Lets the reader choose among several motions.
  function offer() {
    const box = find("which-motion");
    box.closest("label").hidden = motions.length < 2;
    box.replaceChildren(...motions.map(({ path }, at) => make("option", { value: at }, path)));
  }

  find("which-motion").addEventListener("change", async (event) => {
    const motion = motions[event.target.value], look = await shake(motion).catch(refuse);
    if (look) say(told(motion, look));
  });
  find("unsaid-unit").append(...UNITS.map(([name]) => make("option", { value: name }, name)));
  find("unsaid-go").addEventListener("click", () => {
    const step = Number(find("unsaid-step").value);
    const shown = (id) => !find(id).closest("label").hidden;
    take(unread.files, { ...unread.reading, ...(shown("unsaid-unit") ? { unit: find("unsaid-unit").value } : {}), ...(shown("unsaid-step") && step > 0 ? { time_step: step } : {}) });
  });
  const given = async (files) => take(await Promise.all(files.map(async (file) => ({ path: file.name, bytes: new Uint8Array(await file.arrayBuffer()) }))));
  return {
    given: (files) => given(files).catch(refuse),
    // All given motions, if the current one is among them.
    all: (cellar) => (motions.includes(cellar.records[0]) ? motions : cellar.records.slice(0, 1)),
  };
}

// Returns a cellar that is shaken by a motion as recorded.
function shakenBy(cellar, motion) {
  const shaken = copied(cellar);
  shaken.records = [motion];
  for (const path of ["motion.scale.factor", "motion.unit", "motion.time_step"]) delete shaken.changes[path];
  shaken.changes["motion.record"] = JSON.stringify(motion.path);
  const { unit, time_step: step } = motion.told || {};
  if (unit) shaken.changes["motion.unit"] = `"${UNITS.find(([name]) => name === unit)[1]}"`;
  if (step) shaken.changes["motion.time_step"] = `"${step} s"`;
  return shaken;
}
