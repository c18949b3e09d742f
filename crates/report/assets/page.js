// The page: builds players and plots, follows size and theme, offers figures and data as files.

const page = JSON.parse(document.getElementById("barrelstack-data").textContent);
const read = new Map();
const columns = (at) => {
  if (!read.has(at)) read.set(at, columnOf(page.columns[at]));
  return read.get(at);
};
const root = document.documentElement;
root.classList.add("js");

const players = [...document.querySelectorAll("[data-player]")].map((figure) =>
  makePlayer(page.players[Number(figure.dataset.player)], figure, page.dashes));
for (const player of players) player.refresh();
const board = { player: players[0] || null, plots: [] };
for (const figure of document.querySelectorAll("[data-plot]")) {
  board.plots.push(makePlot(page.plots[Number(figure.dataset.plot)], columns, figure, board));
}
// Plots are built when they come near the screen, so that the page opens without delay.
const nearby = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) {
    const plot = isIntersecting && board.plots.find((one) => one.figure === target);
    if (plot && !plot.plot) plot.build();
  }
}, { rootMargin: "800px 0px" });
for (const plot of board.plots) nearby.observe(plot.figure);
if (board.player) {
  board.player.onTime((time) => {
    for (const plot of board.plots) if (plot.timeline) plot.onTime(time);
  });
}

listenEverywhere(players);
const deep = Promise.all(players.map((player) => player.views.start()));
if (board.player) {
  const linked = linkedTime();
  if (linked !== null) board.player.seek(linked);
  board.player.onRest(makeLink(board.player.seek));
}

function refresh() {
  for (const player of players) player.refresh();
  for (const plot of board.plots) if (plot.plot) plot.build();
}
let width = window.innerWidth, waiting = 0;
window.addEventListener("resize", () => {
  // Phones fire this event when the address bar hides; only a change of the width matters.
  if (window.innerWidth === width) return;
  width = window.innerWidth;
  clearTimeout(waiting);
  waiting = setTimeout(refresh, 120);
});
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", refresh);
// The explanation of a term can be closed without moving the pointer.
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape" && document.activeElement?.matches(".term")) document.activeElement.blur();
});
window.addEventListener("beforeprint", () => {
  for (const fold of document.querySelectorAll("details:not([open])")) {
    fold.open = true;
    fold.dataset.printed = "";
  }
});
window.addEventListener("afterprint", () => {
  for (const fold of document.querySelectorAll("details[data-printed]")) {
    fold.open = false;
    delete fold.dataset.printed;
  }
});

function save(name, type, text) {
  const link = make("a", { download: name, href: URL.createObjectURL(new Blob([text], { type })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function standalone(drawing) {
  const copy = drawing.cloneNode(true);
  const style = svg("style", {});
  style.textContent = page.figureStyle;
  const box = copy.viewBox.baseVal;
  const paper = svg("rect", { width: box.width, height: box.height, fill: "#ffffff" });
  copy.prepend(style, paper);
  return new XMLSerializer().serializeToString(copy);
}

function csvOf(plot) {
  const quote = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const named = (label) => quote(plot.unit ? `${label} (${plot.unit})` : label);
  const head = plot.series.flatMap((s) => [quote(plot.title), named(s.label)]);
  const rows = [head.join(",")];
  const count = Math.max(...plot.series.map((s) => s.xs.length));
  const cell = (values, k) => (k < values.length && isFinite(values[k]) ? String(Number(values[k].toPrecision(8))) : "");
  for (let k = 0; k < count; k++) rows.push(plot.series.flatMap((s) => [cell(s.xs, k), cell(s.ys, k)]).join(","));
  return rows.join("\n") + "\n";
}

function button(text, label, action) {
  const element = make("button", { type: "button", "aria-label": label }, text);
  element.addEventListener("click", () => action(element));
  return element;
}

for (const figure of document.querySelectorAll("figure.plot, figure.envelope")) {
  const name = figure.id.replace("figure-", "");
  const number = figure.querySelector("figcaption b").textContent.replace(/\.$/, "");
  const files = make("span", { class: "files" }, button("SVG", t("Save {1} as SVG", number), () =>
    save(`${name}.svg`, "image/svg+xml", standalone(figure.querySelector(".drawing > svg")))));
  const plot = board.plots.find((p) => p.id === name);
  if (plot) files.append(button("CSV", t("Save the data of {1} as CSV", number), () => save(`${name}.csv`, "text/csv", csvOf(plot))));
  figure.querySelector("figcaption").append(" ", files);
}

// Returns a table for a spreadsheet: one line per row, tabs between cells, plain minus signs.
function tabbed(table) {
  const cell = (of) => of.textContent.trim().replace(/\s+/g, " ").replace(/^–$/, "").replace(/^−(?=\d)/, "-");
  // A row with a single cell is text, and its heading is not part of the table.
  const rows = [...table.rows].filter((row) => row.cells.length > 1 || !row.parentElement.matches("thead"));
  return rows.map((row) => [...row.cells].map(cell).join("\t")).join("\n") + "\n";
}

// Browsers offer the clipboard only to pages from a secure origin; the old method works everywhere
// else.
async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const box = make("textarea", { "aria-hidden": "true", style: "position:fixed;opacity:0" });
    box.value = text;
    document.body.append(box);
    box.select();
    const done = document.execCommand("copy");
    box.remove();
    return done;
  }
}

for (const table of document.querySelectorAll(".table > table")) {
  const words = table.querySelector("caption > span");
  const number = words.querySelector("b").textContent.replace(/\.$/, "");
  words.append(" ", make("span", { class: "files" }, button(t("Copy"), t("Copy {1}", number), async (element) => {
    const had = document.activeElement;
    element.textContent = (await copy(tabbed(table))) ? t("Copied") : t("Not copied");
    if (had) had.focus();
    setTimeout(() => { element.textContent = t("Copy"); }, 1500);
  })));
}

window.barrelstack = { player: board.player, players, plots: board.plots, opened: null, deep };
// Time (ms) from the start of loading to the first picture on the screen.
requestAnimationFrame(() => setTimeout(() => { window.barrelstack.opened = performance.now(); }));
