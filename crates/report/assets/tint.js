// Coloring of bodies by a quantity: the share of its scale, the color, and the scale itself.

// Returns a color between two colors.
function between(from, to, share) {
  const part = (color, at) => parseInt(color.slice(1 + 2 * at, 3 + 2 * at), 16);
  const mixed = [0, 1, 2].map((at) => Math.round(part(from, at) + share * (part(to, at) - part(from, at))));
  return `rgb(${mixed.join(" ")})`;
}

// Returns the end of the scale, at which the values are cut off.
function fullTint(data) {
  let most = 0;
  for (const channel of data.tint ? data.tint.values : []) {
    for (const value of channel) if (value > most) most = value;
  }
  return most;
}

// Returns the color of a body; none if the quantity does not apply to it.
function tintOf(data, body, frame, full, paint) {
  const value = data.tint.values[body][frame];
  return isFinite(value) && full > 0 ? between(paint.paper, paint.accent, Math.min(value / full, 1)) : null;
}

function drawTintScale({ context, paint }, tint, full) {
  const [x, y, wide] = [14, 44, 72];
  const shades = context.createLinearGradient(x, 0, x + wide, 0);
  shades.addColorStop(0, paint.paper);
  shades.addColorStop(1, paint.accent);
  context.fillStyle = shades;
  context.strokeStyle = paint.soft;
  context.lineWidth = 1;
  context.fillRect(x, y, wide, 8);
  context.strokeRect(x, y, wide, 8);
  context.fillStyle = paint.soft;
  context.font = "11px system-ui, sans-serif";
  context.textBaseline = "top";
  context.textAlign = "left";
  context.fillText(t("{1}, 0 to {2} and more", tint.label, withUnit(full, 2, tint.unit)), x, y + 12);
}
