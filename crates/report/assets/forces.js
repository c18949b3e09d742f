// Contact forces as arrows on a stage, and the value of the arrow under the pointer.

const FORCE_SHARE = 0.3; // length of a strong force as a share of the height of the view
const UNDER = 9; // distance (px) from an arrow within which its value is shown

function forcesAt(data, frame) {
  const list = [];
  if (!data.forces) return list;
  const { x, z, fx, fz } = data.forces;
  for (let slot = 0; slot < x.length; slot++) {
    if (isFinite(fx[slot][frame] + fz[slot][frame] + x[slot][frame] + z[slot][frame])) {
      list.push({ x: x[slot][frame], z: z[slot][frame], fx: fx[slot][frame], fz: fz[slot][frame] });
    }
  }
  return list;
}

// Returns a high quantile of the values: rare larger values exceed the scale, so that the others
// are legible.
function shareBelow(values, share) {
  values.sort((a, b) => a - b);
  return values.length > 0 ? values[Math.floor(share * (values.length - 1))] : 0;
}

function strongForce(data) {
  const sizes = [];
  const stride = Math.max(1, Math.floor(data.count / 300));
  for (let k = 0; k < data.count; k += stride) {
    for (const force of forcesAt(data, k)) sizes.push(Math.hypot(force.fx, force.fz));
  }
  return shareBelow(sizes, 0.95);
}

const inNewtons = (force) => (force >= 1000 ? withUnit(force / 1000, 2, "kN") : withUnit(force, 2, "N"));

// Draws the arrows of a frame and their scale; returns their positions.
function drawForces(pen, data, strong) {
  const { context, width, height, paint } = pen;
  const perNewton = strong > 0 ? (FORCE_SHARE * height) / strong : 0;
  context.strokeStyle = context.fillStyle = paint.s1;
  context.lineWidth = 2;
  context.lineCap = "butt";
  const arrows = forcesAt(data, pen.frame).map((force) => {
    const x = pen.toX(force.x), y = pen.toY(force.z);
    return { x, y, tipX: x + force.fx * perNewton, tipY: y - force.fz * perNewton, size: Math.hypot(force.fx, force.fz) };
  });
  for (const one of arrows) arrow(context, one.x, one.y, one.tipX, one.tipY);
  const bar = roundLength(0.7 * strong);
  if (bar > 0) {
    const length = bar * perNewton, y = height - 12;
    arrow(context, width - 14 - length, y, width - 14, y);
    context.fillStyle = paint.ink;
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "right";
    context.textBaseline = "middle";
    halo(pen, bar >= 1000 ? withUnit(bar / 1000, 1, "kN") : withUnit(bar, 1, "N"), width - 20 - length, y);
  }
  return arrows;
}

function arrow(context, x0, y0, x1, y1) {
  const length = Math.hypot(x1 - x0, y1 - y0);
  if (!(length > 1.5)) return;
  const head = Math.min(8, 0.6 * length);
  const ux = (x1 - x0) / length, uy = (y1 - y0) / length;
  const bx = x1 - ux * head, by = y1 - uy * head;
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(bx, by);
  context.stroke();
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(bx - uy * head * 0.45, by + ux * head * 0.45);
  context.lineTo(bx + uy * head * 0.45, by - ux * head * 0.45);
  context.fill();
}

function halo({ context, paint }, text, x, y) {
  context.save();
  context.lineWidth = 4;
  context.lineJoin = "round";
  context.strokeStyle = paint.paper;
  context.strokeText(text, x, y);
  context.restore();
  context.fillText(text, x, y);
}

// Returns the distance (px) of a point from an arrow.
function distanceTo({ x, y, tipX, tipY }, [px, py]) {
  const dx = tipX - x, dy = tipY - y, square = dx * dx + dy * dy;
  const share = square > 0 ? Math.min(Math.max(((px - x) * dx + (py - y) * dy) / square, 0), 1) : 0;
  return Math.hypot(px - x - share * dx, py - y - share * dy);
}

const overlaps = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

// Writes the value of the arrow under the pointer beside its tip, clear of all names; returns its
// position.
function drawForceValue(pen, arrows, hover, names) {
  const near = arrows.filter((one) => distanceTo(one, hover) < UNDER);
  if (near.length === 0) return null;
  const one = near.reduce((best, other) => (distanceTo(other, hover) < distanceTo(best, hover) ? other : best));
  const { context, width, height, paint } = pen;
  const text = inNewtons(one.size);
  context.font = "600 12px system-ui, sans-serif";
  const wide = context.measureText(text).width + 12, high = 20;
  let box = null;
  for (let reach = 16; !box && reach < 200; reach += 8) {
    for (let turn = 0; !box && turn < 12; turn++) {
      const angle = -0.5 * Math.PI + (turn % 2 ? 1 : -1) * Math.ceil(turn / 2) * (Math.PI / 6);
      const x = one.tipX + Math.cos(angle) * (reach + 0.5 * wide), y = one.tipY + Math.sin(angle) * (reach + 0.5 * high);
      const wish = [x - 0.5 * wide, y - 0.5 * high, x + 0.5 * wide, y + 0.5 * high];
      const inside = wish[0] > 2 && wish[1] > 2 && wish[2] < width - 2 && wish[3] < height - 2;
      if (inside && !names.some((name) => overlaps(name, wish))) box = wish;
    }
  }
  if (!box) return null;
  context.fillStyle = paint.paper;
  context.strokeStyle = paint.s1;
  context.lineWidth = 1;
  context.beginPath();
  context.roundRect(box[0], box[1], wide, high, 4);
  context.fill();
  context.stroke();
  context.fillStyle = paint.ink;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(text, 0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3]));
  return { text, box, names };
}
