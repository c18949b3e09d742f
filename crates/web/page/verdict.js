// The results of the variants: a card with the verdict in words and, for each plane, the share with
// its interval.

const SVG = "http://www.w3.org/2000/svg";

function drawn(tag, attributes) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

// Returns the share that falls, as a dot on a line from none to all, within its interval.
function shareOf({ words, spread }, several) {
  const { variants, collapsed, share, interval: [low, high] } = spread;
  const line = drawn("svg", { viewBox: "0 0 100 14", preserveAspectRatio: "none", "aria-hidden": "true" });
  line.append(drawn("rect", { class: "rail", x: 0, y: 5, width: 100, height: 4 }));
  if (share !== null) {
    line.append(drawn("rect", { class: "span", x: 100 * low, y: 2, width: Math.max(100 * (high - low), 0.5), height: 10 }));
    line.append(drawn("rect", { class: "dot", x: Math.min(100 * share, 99.2), y: 0, width: 0.8, height: 14 }));
  }
  const sure = t("{1} to {2}", (100 * low).toFixed(0), `${(100 * high).toFixed(0)}\u00a0%`);
  const said = share === null ? t("no verdict") : t("{1} of {2} fall; {3} interval: {4}", collapsed, variants, "95\u00a0%", sure);
  return make("div", { class: "share" }, make("span", {}, several ? words : t("share that falls")), line, make("span", { class: "soft" }, said));
}

// `when` identifies the run.
function cardOf(verdict, when, before) {
  const card = make("div", { class: `card ${verdict.tone}${before ? " before" : ""}` });
  card.innerHTML = verdict.badge;
  const shares = make("div", { class: "shares" }, ...verdict.planes.map((plane) => shareOf(plane, verdict.planes.length > 1)));
  card.append(make("p", { class: "when" }, when), make("p", { class: "headline" }, verdict.headline), shares);
  return card;
}

// Returns the share of the worse plane in a few words, for a list.
function briefly(verdict) {
  const [worst] = [...verdict.planes].sort((a, b) => (b.spread.share ?? -1) - (a.spread.share ?? -1));
  return worst ? worst.fate : t("has no verdict");
}
