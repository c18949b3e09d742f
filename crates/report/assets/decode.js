// Decodes the numbers of the page: base64 to bytes, to differences, to values; missing values are
// NaN.

function bytesOf(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
  return bytes;
}

// Returns one Float64Array per channel. Integers stay below 2^53, so sums and products are exact.
// Data already unpacked by a worker are returned as they are.
function unpack(packed) {
  if (Array.isArray(packed)) return packed;
  const bytes = bytesOf(packed.d);
  const channels = [];
  let at = 0;
  const integer = () => {
    let bits = 0, weight = 1, byte;
    do {
      byte = bytes[at++];
      bits += (byte & 0x7f) * weight;
      weight *= 128;
    } while (byte & 0x80);
    return bits;
  };
  for (let c = 0; c < packed.c; c++) {
    const values = new Float64Array(packed.n);
    let last = 0, step = 0;
    for (let k = 0; k < packed.n; k++) {
      let bits = integer();
      if (bits === 0) {
        // A run of missing values.
        const end = k + integer();
        values.fill(NaN, k, end + 1);
        k = end;
        continue;
      }
      bits -= 1;
      const code = bits % 2 === 0 ? bits / 2 : -(bits + 1) / 2;
      step = packed.o === 2 ? step + code : code;
      last += step;
      values[k] = last * packed.q;
    }
    channels.push(values);
  }
  return channels;
}

function columnOf(column) {
  if (Array.isArray(column) && !ArrayBuffer.isView(column[0])) return Float64Array.from(column, (v) => (v === null ? NaN : v));
  return unpack(column)[0];
}

// Returns the index of the value nearest to `wanted` in a non-decreasing list; the earlier of two
// equally near ones.
function nearest(values, wanted) {
  let low = 0, high = values.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] < wanted) low = middle;
    else high = middle;
  }
  return high > low && Math.abs(values[high] - wanted) < Math.abs(values[low] - wanted) ? high : low;
}

// Returns the largest of 1, 2, 5 × 10ⁿ that does not exceed `most`.
function roundLength(most) {
  if (!(most > 0) || !isFinite(most)) return 0;
  const scale = 10 ** Math.floor(Math.log10(most));
  const share = most / scale;
  return (share >= 5 ? 5 : share >= 2 ? 2 : 1) * scale;
}

function readable(value, digits) {
  if (!isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4
    ? value.toExponential(digits - 1).replace("e+", "e")
    : Number(value.toPrecision(digits)).toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(size))));
  return text.replace("-", "−");
}

function withUnit(value, digits, unit) {
  return unit ? `${readable(value, digits)}\u00a0${unit}` : readable(value, digits);
}

function color(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name === "class") element.className = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}
