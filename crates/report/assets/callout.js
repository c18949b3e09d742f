// The callout: a sentence beside the stack, with a line to the body that it concerns.

const LINE = 17, WORDS = 150; // height and maximum width of a line of text (px)

function wrapped(context, text, most) {
  const lines = [""];
  for (const word of text.split(" ")) {
    const longer = `${lines.at(-1)} ${word}`.trim();
    if (context.measureText(longer).width > most && lines.at(-1)) lines.push(word);
    else lines[lines.length - 1] = longer;
  }
  return lines;
}

// Finds the free place nearest to the body. It is computed once per picture size, so that the
// callout does not jump.
function calloutPlace(pen, wide, high, body, others) {
  const cost = (x, y) => {
    const box = [x, y, x + wide, y + high];
    const covered = others.reduce((sum, o) => sum + Math.max(0, Math.min(box[2], o[2]) - Math.max(box[0], o[0]))
      * Math.max(0, Math.min(box[3], o[3]) - Math.max(box[1], o[1])), 0);
    return covered + 4 * Math.hypot(x + 0.5 * wide - body[0], y + 0.5 * high - body[1]);
  };
  let best = null;
  for (let y = 38; y < pen.height - high - 40; y += 12) {
    for (let x = 8; x < pen.width - wide - 8; x += 12) {
      const now = cost(x, y);
      if (!best || now < best.cost) best = { x, y, cost: now };
    }
  }
  return best ?? { x: 8, y: 38 };
}

// `circles` are the bodies as [x, y, radius] (px); `at` is the body concerned.
function drawCallout(pen, text, at, circles, cache) {
  const { context, paint } = pen;
  context.font = "600 13px system-ui, sans-serif";
  const lines = wrapped(context, text, Math.min(WORDS, pen.width - 38));
  const wide = Math.max(...lines.map((line) => context.measureText(line).width)) + 20, high = LINE * lines.length + 12;
  const key = [pen.width, pen.height, pen.view.scale].join();
  if (cache.key !== key) {
    const boxes = circles.map(([x, y, r]) => [x - r, y - r, x + r, y + r]);
    Object.assign(cache, { key, ...calloutPlace(pen, wide, high, at, boxes) });
  }
  const { x, y } = cache;
  const from = [Math.min(Math.max(at[0], x), x + wide), Math.min(Math.max(at[1], y), y + high)];
  const far = Math.hypot(at[0] - from[0], at[1] - from[1]);
  context.strokeStyle = paint.accent;
  context.lineWidth = 1.8;
  if (far > at[2]) {
    const share = 1 - (0.72 * at[2]) / far;
    const end = [from[0] + share * (at[0] - from[0]), from[1] + share * (at[1] - from[1])];
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...end);
    context.stroke();
    context.beginPath();
    context.arc(...end, 3, 0, 7);
    context.fillStyle = paint.accent;
    context.fill();
  }
  context.fillStyle = paint.paper;
  context.beginPath();
  context.roundRect(x, y, wide, high, 6);
  context.fill();
  context.stroke();
  context.fillStyle = paint.ink;
  context.textAlign = "left";
  context.textBaseline = "middle";
  lines.forEach((line, k) => context.fillText(line, x + 10, y + 6 + (k + 0.5) * LINE));
}
