// A field over the surface as coloured cells, read by pointer.

// Dark to light, in a direction that colour-blind readers see.
const RAMP = [[0x2b, 0x1b, 0x6b], [0x0f, 0x6a, 0xb0], [0x1f, 0xa0, 0x8a], [0xf0, 0xa2, 0x1e], [0xff, 0xf0, 0xb8]];

function rampColour(part) {
  const place = Math.max(0, Math.min(1, part)) * (RAMP.length - 1);
  const k = Math.min(RAMP.length - 2, Math.floor(place));
  return RAMP[k].map((c, i) => Math.round(c + (RAMP[k + 1][i] - c) * (place - k)));
}

/** Draws `field` {first_x_m, first_y_m, spacing_x_m, spacing_y_m, cells_x, values} with `range` [low, high] where it is fixed. */
function heat(host, field, { label, name, unit, range }) {
  const nx = field.cells_x, ny = Math.round(field.values.length / nx);
  const seen = field.values.filter((v) => v !== null);
  const [low, high] = range || [Math.min(0, ...seen), Math.max(...seen)];
  const canvas = document.createElement("canvas");
  canvas.width = nx;
  canvas.height = ny;
  canvas.style.aspectRatio = `${nx * field.spacing_x_m} / ${ny * field.spacing_y_m}`;
  canvas.style.maxWidth = "26rem";
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${label}, from ${withUnit(low, unit)} to ${withUnit(high, unit)}`);
  const context = canvas.getContext("2d"), image = context.createImageData(nx, ny);
  field.values.forEach((v, c) => {
    // Rows of a picture go down, those of the field up.
    const at = 4 * ((ny - 1 - Math.floor(c / nx)) * nx + (c % nx));
    if (v === null) return;
    const [r, g, b] = rampColour(high > low ? (v - low) / (high - low) : 0);
    image.data.set([r, g, b, 255], at);
  });
  context.putImageData(image, 0, 0);
  const scale = document.createElement("p");
  scale.className = "hint";
  const bar = RAMP.map((c) => `rgb(${c.join(" ")})`).join(", ");
  scale.innerHTML = `${esc(withUnit(low, unit))} <span style="display:inline-block;width:8rem;height:.8em;background:linear-gradient(to right, ${bar})"></span> ${esc(withUnit(high, unit))}; ${esc(withUnit(nx * field.spacing_x_m, "m"))} × ${esc(withUnit(ny * field.spacing_y_m, "m"))}`;
  const readout = document.createElement("p");
  readout.className = "readout";
  readout.setAttribute("aria-hidden", "true");
  canvas.addEventListener("pointermove", (event) => {
    const frame = canvas.getBoundingClientRect();
    const i = Math.min(nx - 1, Math.max(0, Math.floor(((event.clientX - frame.left) / frame.width) * nx)));
    const j = ny - 1 - Math.min(ny - 1, Math.max(0, Math.floor(((event.clientY - frame.top) / frame.height) * ny)));
    const x = field.first_x_m + i * field.spacing_x_m, y = field.first_y_m + j * field.spacing_y_m;
    readout.textContent = `x = ${withUnit(x, "m", 3)}, y = ${withUnit(y, "m", 3)}: ${name} = ${withUnit(field.values[j * nx + i], unit)}`;
  });
  host.replaceChildren(canvas, scale, readout);
  // A chart may come here again.
  host.drawing = null;
}
