// Descriptions of strengths of shaking, and names of entries of the catalog.

// Modified Mercalli intensity of a peak ground velocity (cm/s): Worden, Gerstenberger, Rhoades and
// Wald (2012), Bulletin of the Seismological Society of America 102, 204–221; bilinear in log PGV,
// for California.
function intensityOf(velocity) {
  const log = Math.log10(Math.max(velocity, 0.1));
  return Math.min(Math.max(log <= 0.53 ? 3.78 + 1.47 * log : 2.89 + 3.16 * log, 1), 10);
}

const ROMAN = ["", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X"];

// Perceived shaking by whole intensities from III to X: the scale of Wood and Neumann (1931) in
// plain words.
const FELT = {
  3: [t("weak"), t("a lorry seems to pass; hanging lamps swing")],
  4: [t("light"), t("glasses rattle, walls creak, some sleepers wake")],
  5: [t("moderate"), t("everyone feels it; bottles fall from shelves")],
  6: [t("strong"), t("people run outside; shelves and heavy furniture move")],
  7: [t("very strong"), t("it is hard to stand; chimneys break")],
  8: [t("severe"), t("drivers lose hold of the wheel; solid buildings are damaged")],
  9: [t("violent"), t("people are thrown down; buildings shift off their foundations")],
  10: [t("extreme"), t("few buildings stay whole")],
};

// Peak velocity (cm/s) of the stronger horizontal component of records, as `barrelstack motion
// info` reads them.
const LIKE = [
  [3, t("South Napa 2014 at Concord")],
  [23, t("Northridge 1994 at Arleta")],
  [31, "El Centro 1940"],
  [49, t("Maule 2010 at Curicó")],
  [57, t("South Napa 2014 at Napa College")],
  [101, t("Kaikōura 2016 at Waiau")],
  [125, t("Chi-Chi 1999 at station TCU065")],
  [148, t("Northridge 1994 at Rinaldi")],
];

// Returns a description of a strength: { name, felt, roman, like }.
function feels(velocity) {
  const level = Math.max(3, Math.round(intensityOf(velocity)));
  const [name, felt] = FELT[level];
  const apart = ([other]) => Math.abs(Math.log(other / velocity));
  const near = LIKE.reduce((a, b) => (apart(b) < apart(a) ? b : a));
  return { name, felt, roman: ROMAN[level], like: apart(near) < 0.25 ? near[1] : "" };
}

const NAMES = {
  "bordeaux-225": t("Bordeaux, 225 L"), "burgundy-228": t("Burgundy, 228 L"), "hogshead-300": t("hogshead, 300 L"), "puncheon-500": t("puncheon, 500 L"),
  "two-barrel": t("two barrels"), "two-barrel-feet": t("two barrels, with feet"), "single-bar": t("two barrels, one bar"),
  "two-barrel-inclined": t("two barrels, one end up"),
  "four-barrel": t("four barrels"), "rack-on-rack": t("two barrels, on posts"), "candia-2008": t("two barrels, Chile 2008"),
};
const called = (name) => NAMES[name] || name;

const percentOf = (share) => {
  const percent = 100 * share;
  if (percent > 0 && percent < 1) return "1 %";
  if (percent > 99 && percent < 100) return "99 %";
  return `${percent.toFixed(0)} %`;
};

// Returns a duration (s) in words.
function lasting(seconds) {
  if (seconds < 1.5) return t("a second");
  if (seconds < 90) return t("{1} seconds", Math.round(seconds));
  const minutes = Math.round(seconds / 60);
  return minutes < 90 ? t("{1} minutes", minutes) : t("{1} hours", Math.round(minutes / 60));
}
