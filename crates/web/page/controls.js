// The five choices and the strength of the shaking, read from the scenario as resolved by the
// engine, and written as changes to the scenario.

const STRENGTHS = [3, 160]; // limits of the slider (cm/s)
const STEPS = 200;

const velocityAt = (step) => STRENGTHS[0] * (STRENGTHS[1] / STRENGTHS[0]) ** (step / STEPS);
const stepAt = (velocity) => Math.round((STEPS * Math.log(velocity / STRENGTHS[0])) / Math.log(STRENGTHS[1] / STRENGTHS[0]));

// Returns the values of a scenario by path; fields without a value are left out.
const valuesOf = (look) => Object.fromEntries(look.settings.filter(({ value }) => value !== "").map(({ path, value }) => [path, value]));

// `changed` is called when the reader has changed something, with a function that writes the change
// into a cellar.
function makeControls(find, catalog, changed) {
  const [barrel, rack, levels, view, fill, strength] = ["barrel", "rack", "levels", "view", "fill", "strength"].map(find);
  let stated = null, shown = null; // the resolved scenario without changes, and with them
  let own = 0; // peak velocity (cm/s) of the motion as recorded; 0 without a motion
  const offer = (select, names) => select.replaceChildren(...names.map((name) => make("option", { value: name }, called(name))));
  offer(barrel, catalog.barrels.map(({ name }) => name));
  offer(rack, catalog.racks.map(({ name }) => name));

  // Writes a value unless it equals the stated one.
  const write = (cellar, path, value, same) => {
    if (same) delete cellar.changes[path];
    else cellar.changes[path] = value;
  };
  const is = (path, value) => String(stated[path]) === String(value);

  const writers = {
    barrel(cellar) {
      const text = fill.value === "empty" ? `{ base = "${barrel.value}", fill = "empty" }` : `"${barrel.value}"`;
      write(cellar, "stack.barrel", text, is("stack.barrel.base", barrel.value) && is("stack.barrel.fill", fill.value));
    },
    rack: (cellar) => write(cellar, "stack.rack", `"${rack.value}"`, is("stack.rack.base", rack.value)),
    // `now` is the resolved scenario with all its changes.
    levels(cellar, count = Number(levels.value), now = shown) {
      const most = Math.min(Math.max(Math.round(count) || 1, 1), 12), values = valuesOf(now);
      const had = Number(values["stack.levels"]);
      write(cellar, "stack.levels", String(most), is("stack.levels", most));
      // A device on all levels stays on all levels, and no device is on more levels than there are.
      for (const [path, value] of Object.entries(values)) {
        if (!/^stack\.\w+\.levels$/.test(path) || Number(value) === 0) continue;
        const on = Number(value) >= Math.min(had, most) ? most : Number(value);
        if (on !== Number(value)) write(cellar, path, String(on), is(path, on));
      }
      if (most === 1 && values["stack.strap.ties"] === "levels-together") cellar.changes["stack.strap.ties"] = '"barrels-to-racks"';
    },
    view(cellar) {
      write(cellar, "stack.view", `"${view.value}"`, is("stack.view", view.value));
      // With both planes, the one along the barrels has its own number of columns.
      const along = stated["stack.columns_along"];
      if (along !== undefined) write(cellar, "stack.columns", along, view.value !== "longitudinal");
    },
    // Replaces any setting of the same device.
    device(cellar, table, settings) {
      for (const path of Object.keys(cellar.changes)) if (path === `stack.${table}` || path.startsWith(`stack.${table}.`)) delete cellar.changes[path];
      for (const setting of settings) {
        const at = setting.indexOf("=");
        cellar.changes[setting.slice(0, at)] = setting.slice(at + 1);
      }
    },
    strength(cellar, velocity = velocityAt(Number(strength.value))) {
      if (stated["motion.scale.pgv"] !== undefined) {
        cellar.changes["motion.scale.pgv"] = `"${velocity.toPrecision(3)} cm/s"`;
        return;
      }
      const factor = Number((velocity / own).toPrecision(3));
      const near = Math.abs(stepAt(velocity) - stepAt(own)) < 1;
      write(cellar, "motion.scale.factor", String(factor), near && Number(stated["motion.scale.factor"] ?? 1) === 1);
    },
  };
  const edit = (name) => changed((cellar) => writers[name](cellar));
  for (const [element, name] of [[barrel, "barrel"], [fill, "barrel"], [rack, "rack"], [view, "view"], [levels, "levels"]]) {
    element.addEventListener("change", () => edit(name));
  }
  for (const button of document.querySelectorAll("[data-step]")) {
    button.addEventListener("click", () => changed((cellar) => writers.levels(cellar, Number(levels.value) + Number(button.dataset.step))));
  }
  strength.addEventListener("input", () => {
    feel(velocityAt(Number(strength.value)));
    edit("strength");
  });

  function feel(velocity) {
    const { name, felt, roman, like } = feels(velocity);
    find("feels").replaceChildren(make("b", {}, `${name[0].toUpperCase()}${name.slice(1)}`), `: ${felt}.`,
      make("span", { class: "soft" }, t("peak velocity {1} cm/s, intensity {2}", velocity < 1 ? t("below 1") : velocity.toFixed(0), roman) + (like ? t("; like {1}", like) : "")));
    strength.setAttribute("aria-valuetext", t("{1}, {2} centimeters per second", name, velocity.toFixed(0)));
  }

  return {
    writers,
    // Sets the scenario as stated, without changes.
    state(look) {
      stated = valuesOf(look);
    },
    states: (path) => stated[path],
    // Shows a resolved scenario.
    show(look) {
      shown = look;
      const values = valuesOf(look), motion = look.checked[0].motion;
      const stack = values["stack.levels"] !== undefined;
      for (const element of [barrel, rack, levels, view, fill]) element.disabled = !stack;
      if (stack) {
        barrel.value = values["stack.barrel.base"];
        fill.value = values["stack.barrel.fill"] === "empty" ? "empty" : "full-fluid";
        rack.value = values["stack.rack.base"];
        levels.value = values["stack.levels"];
        view.value = values["stack.view"];
      }
      strength.disabled = !motion;
      if (motion) {
        const velocity = 100 * motion.pgv;
        own = velocity / Math.abs(Number(values["motion.scale.factor"] ?? 1));
        // Not while the reader is moving it.
        if (document.activeElement !== strength) strength.value = stepAt(velocity);
        feel(velocity);
        // Each plane has its own component of the motion.
        const shaken = look.checked.filter((plane) => plane.motion), several = shaken.length > 1;
        const place = ({ view }) => (several ? `${view === "longitudinal" ? t("along the barrels") : t("across the barrels")} ` : "");
        const planes = shaken.map((plane) => t("{1}, peak acceleration {2} g", place(plane) + plane.motion.name, (plane.motion.pga / 9.80665).toPrecision(2)));
        find("motion").textContent = `${planes.join("; ")}; ${motion.duration.toFixed(0)} s`;
      } else {
        find("feels").textContent = t("There is no ground motion.");
        find("motion").textContent = t("Drop a record here.");
      }
    },
  };
}

// Returns a short description of a stack: its main properties, and what is unusual.
function labelOf(look) {
  const values = valuesOf(look), motion = look.checked[0].motion;
  if (values["stack.levels"] === undefined) return look.title;
  const levels = values["stack.levels"];
  const words = [Number(levels) === 1 ? t("1 level") : t("{1} levels", levels)];
  if (values["stack.rack.base"] !== "two-barrel") words.push(called(values["stack.rack.base"]));
  if (values["stack.barrel.base"] !== "bordeaux-225") words.push(called(values["stack.barrel.base"]));
  if (values["stack.barrel.fill"] === "empty") words.push(t("empty"));
  words.push(...look.devices);
  if (values["stack.view"] !== "both") words.push(values["stack.view"] === "transverse" ? t("across") : t("along"));
  if (motion) words.push(`${(100 * motion.pgv).toFixed(0)} cm/s`);
  return words.join(", ");
}
