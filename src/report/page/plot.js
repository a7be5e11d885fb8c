// Charts as SVG: linear and log axes, error bars, reading by pointer. Drawn again where its width changes.

const DASHES = ["", "7 4", "2 3", "9 3 2 3"];
const colourOf = (k) => `var(--c${k % 7})`;
const dashOf = (series, k) => DASHES[(series.dash ?? Math.floor(k / 7)) % DASHES.length];

// Ticks by the rules of the figures, chart/ticks.rs: a tick is a whole number times a power of ten, so that its label is exact.
const decimal = (digits, power) => Number(`${digits}e${power}`);
const powerOfTen = (power) => `10${raised(power)}`;
const within = (low, high) => (v) => v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9);

/** The whole numbers whose multiples of a step lie on the axis. */
function multiples(low, high, step) {
  const slack = (1e-9 * (high - low)) / step, from = Math.ceil(low / step - slack);
  return Array.from({ length: Math.max(0, Math.floor(high / step + slack) - from + 1) }, (_, k) => from + k);
}

/** Steps of 1, 2 or 5 times a power of ten, the finest with at most so many labels. */
function linearTicks(low, high, most) {
  for (let power = Math.floor(Math.log10((high - low) / most)); ; power++) {
    for (const step of [1, 2, 5]) {
      const on = multiples(low, high, decimal(step, power));
      if (on.length > most) continue;
      const digits = on.map((k) => k * step), labels = decimalLabels(digits, power);
      const parts = step === 2 ? 4 : 5, fine = (step * 10) / parts;
      const between = multiples(low, high, decimal(fine, power - 1)).filter((k) => k % parts);
      return { major: digits.map((d, i) => ({ value: decimal(d, power), label: labels[i] })), minor: between.map((k) => decimal(k * fine, power - 1)) };
    }
  }
}

/** Decimals with the same number of places, or with a power of ten where that keeps them short. */
function decimalLabels(digits, power) {
  const isReadable = String(Math.max(...digits.map(Math.abs))).length + power <= 7 && power >= -5;
  const plain = digits.map((d) => plainDecimal(d, power)), short = digits.map((d) => powerDecimal(d, power));
  const longest = (labels) => Math.max(...labels.map((label) => label.length));
  return isReadable || longest(plain) < longest(short) ? plain : short;
}

function plainDecimal(digits, power) {
  if (digits === 0) return "0";
  const places = Math.max(0, -power);
  const figures = (Math.abs(digits) + "0".repeat(Math.max(0, power))).padStart(places + 1, "0");
  const whole = figures.slice(0, figures.length - places), part = figures.slice(figures.length - places);
  const grouped = whole.length < 5 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, "\u202f");
  return (digits < 0 ? "−" : "") + grouped + (part && `.${part}`);
}

function powerDecimal(digits, power) {
  if (digits === 0) return "0";
  const figures = String(Math.abs(digits)), rest = figures.slice(1).replace(/0+$/, "");
  return `${digits < 0 ? "−" : ""}${figures[0]}${rest && `.${rest}`} × ${powerOfTen(power + figures.length - 1)}`;
}

/** Decades, every second, third, fifth ... where there are many; 1-2-5 where the axis holds fewer than two. */
function logTicks(low, high, most) {
  const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9), inside = within(low, high);
  if (last > first) {
    const count = (stride) => Math.floor(last / stride) - Math.floor((first - 1) / stride);
    const stride = [1, 2, 3, 5, 10, 20, 50, 100, 200, 500].find((stride) => count(stride) <= Math.max(2, most)) ?? 1000;
    const powers = Array.from({ length: last - first + 2 }, (_, k) => first - 1 + k);
    const isMajor = (power) => power >= first && power % stride === 0;
    const between = stride === 1 ? powers.flatMap((power) => [2, 3, 4, 5, 6, 7, 8, 9].map((d) => decimal(d, power))) : [];
    const others = powers.filter((power) => power >= first && !isMajor(power)).map((power) => decimal(1, power));
    return { major: powers.filter(isMajor).map((power) => ({ value: decimal(1, power), label: powerOfTen(power) })), minor: [...others, ...between.filter(inside)] };
  }
  const all = (digits) => [first - 1, first, last, last + 1].filter((p, k, list) => list.indexOf(p) === k).sort((a, b) => a - b).flatMap((power) => digits.map((d) => ({ d, power, value: decimal(d, power) }))).filter(({ value }) => inside(value));
  const named = all([1, 2, 5]), isPlain = named.every(({ value }) => value >= 1e-3 && value < 1e4);
  if (named.length < 3) return linearTicks(low, high, Math.min(most, 8));
  const label = ({ d, power }) => (isPlain ? plainDecimal(d, power) : d === 1 ? powerOfTen(power) : `${d} × ${powerOfTen(power)}`);
  return { major: named.map((tick) => ({ value: tick.value, label: label(tick) })), minor: all([3, 4, 6, 7, 8, 9]).map(({ value }) => value) };
}

/** Ticks of an axis from `low` to `high` with room for `room` labels: those with labels, and minor ones. */
const ticksOf = (low, high, log, room) => (log ? logTicks(low, high, Math.min(room, 11)) : linearTicks(low, high, Math.max(2, Math.min(room, 8))));

/** Range of an axis over its values, with air; a log axis sees values above zero alone. */
function rangeOf(values, axis) {
  const seen = values.filter((v) => v !== null && isFinite(v) && (!axis.log || v > 0));
  if (!seen.length) return null;
  let low = Math.min(...seen), high = Math.max(...seen);
  if (axis.zero && !axis.log) [low, high] = [Math.min(0, low), Math.max(0, high)];
  if (axis.log) {
    const air = high > low ? (high / low) ** 0.03 : 2;
    return [low / air, high * air];
  }
  const air = high > low ? 0.04 * (high - low) : Math.abs(high) || 1;
  return [axis.zero && low === 0 ? 0 : low - air, high + air];
}

/** Draws `spec` into `host`, now and whenever the width of the host changes. */
function plot(host, spec) {
  host.spec = spec;
  if (!host.drawing) {
    host.drawing = document.createElement("div");
    host.legend = document.createElement("ul");
    host.legend.className = "legend";
    host.readout = document.createElement("p");
    host.readout.className = "readout tip";
    host.readout.setAttribute("aria-hidden", "true");
    host.drawing.className = "drawing";
    host.append(host.legend, host.drawing, host.readout);
    new ResizeObserver(() => !host.printed && host.clientWidth && host.clientWidth !== host.drawnWidth && drawPlot(host)).observe(host);
    host.drawing.addEventListener("pointermove", (event) => readPlot(host, event));
    host.drawing.addEventListener("pointerleave", () => showCursor(host, null));
    host.drawing.addEventListener("click", (event) => {
      const hit = nearest(host, event);
      if (hit && host.spec.onPick) host.spec.onPick(hit.series, hit.i);
    });
  }
  drawPlot(host);
}

function prepared(spec) {
  const scale = (axis, values) => {
    const largest = Math.max(0, ...values.filter((v) => v !== null && isFinite(v)).map(Math.abs));
    return scaleFor(largest, axis.unit || "");
  };
  const all = (key) => spec.series.flatMap((s) => s[key]);
  const x = scale(spec.x, all("x")), y = scale(spec.y, all("y"));
  const times = (f) => (v) => (v === null || v === undefined ? null : v * f);
  const series = spec.series.map((s) => ({ ...s, px: s.x.map(times(x.factor)), py: s.y.map(times(y.factor)), pe: s.err && s.err.map(times(y.factor)) }));
  return { x, y, series };
}

function drawPlot(host) {
  const { spec } = host;
  const scaled = prepared(spec);
  const width = Math.max(240, host.printed || host.clientWidth || 640);
  host.drawnWidth = host.clientWidth;
  const usual = spec.height || Math.round(Math.min(300, Math.max(210, width * 0.62)));
  const height = host.printed ? Math.min(usual, Math.max(160, 0.42 * width)) : usual;
  const box = { left: 0, right: width - 14, top: 10, bottom: height - 44 };
  const ys = scaled.series.flatMap((s) => s.py.flatMap((v, i) => (v !== null && s.pe && s.pe[i] !== null ? [v, v - s.pe[i], v + s.pe[i]] : [v])));
  const xr = rangeOf(scaled.series.flatMap((s) => s.px), spec.x), yr = rangeOf(ys, spec.y);
  host.points = [];
  if (!xr || !yr) {
    host.legend.innerHTML = "";
    host.drawing.innerHTML = `<p class="none">${esc(spec.none || "nothing to draw")}</p>`;
    return;
  }
  const yt = ticksOf(...yr, spec.y.log, Math.max(3, Math.floor((box.bottom - box.top) / 40)));
  // As much room as the longest label takes.
  box.left = Math.min(width / 3, 30 + 6.6 * Math.max(...yt.major.map(({ label }) => label.length)));
  const along = (range, axis, a, b) => (v) => {
    const part = axis.log ? Math.log(v / range[0]) / Math.log(range[1] / range[0]) : (v - range[0]) / (range[1] - range[0]);
    return a + part * (b - a);
  };
  const X = along(xr, spec.x, box.left, box.right), Y = along(yr, spec.y, box.bottom, box.top);
  const seen = (x, y) => x !== null && y !== null && (!spec.x.log || x > 0) && (!spec.y.log || y > 0);
  const parts = [axes(spec, scaled, box, xr, yt, X, Y, width, height)];
  scaled.series.forEach((s, k) => {
    const colour = colourOf(s.colour ?? k);
    let path = "", pen = "M", marks = "";
    for (let i = 0; i < s.px.length; i++) {
      if (!seen(s.px[i], s.py[i])) { pen = "M"; continue; }
      const x = X(s.px[i]).toFixed(1), y = Y(s.py[i]).toFixed(1);
      path += `${pen}${x} ${y}`;
      pen = "L";
      if (s.stem) marks += `<path d="M${x} ${Y(spec.y.log ? yr[0] : 0).toFixed(1)}V${y}" stroke="${colour}" stroke-width="6"/>`;
      if (s.pe && s.pe[i] !== null) {
        const low = s.py[i] - s.pe[i], top = Y(s.py[i] + s.pe[i]), bottom = spec.y.log && low <= 0 ? box.bottom : Y(low);
        marks += `<path d="M${x} ${top.toFixed(1)}V${bottom.toFixed(1)}M${(+x - 3).toFixed(1)} ${top.toFixed(1)}h6m-6 ${(bottom - top).toFixed(1)}h6" stroke="${colour}"/>`;
      }
      if (s.marker) marks += `<circle cx="${x}" cy="${y}" r="${s.marker}" fill="${colour}"/>`;
      host.points.push({ x: +x, y: +y, series: k, i });
    }
    if (s.line !== false && !s.stem) parts.push(`<path d="${path}" fill="none" stroke="${colour}" stroke-width="${s.faint ? 1 : 1.8}" stroke-linejoin="round" stroke-dasharray="${dashOf(s, k)}"${s.faint ? ' opacity=".55"' : ""}/>`);
    parts.push(marks);
  });
  for (const mark of spec.marks || []) {
    const x = mark.x * scaled.x.factor, y = mark.y * scaled.y.factor;
    if (seen(x, y)) parts.push(`<circle class="peak" cx="${X(x).toFixed(1)}" cy="${Y(y).toFixed(1)}" r="7" fill="none" stroke="var(--ink)" stroke-width="1.3"/>`);
  }
  const chosen = spec.chosen && host.points.find((p) => p.series === spec.chosen.series && p.i === spec.chosen.i);
  if (chosen) parts.push(`<path d="M${chosen.x} ${box.top}V${box.bottom}" stroke="var(--ink)" stroke-dasharray="3 3"/><circle cx="${chosen.x}" cy="${chosen.y}" r="6" fill="var(--paper)" stroke="var(--ink)" stroke-width="2.5"/>`);
  host.box = box;
  host.scaled = scaled;
  const named = spec.slider ? 'aria-hidden="true"' : `role="img" aria-label="${esc(spec.label)}"`;
  host.drawing.innerHTML = `<svg ${named} viewBox="0 0 ${width} ${height}">${parts.join("")}<circle class="cursor" r="5" visibility="hidden"/></svg>`;
  // A series without a name belongs to the one before.
  host.legend.innerHTML = scaled.series.length > 1 || spec.legend
    ? scaled.series.map((s, k) => s.name && `<li><svg viewBox="0 0 26 10" aria-hidden="true"><path d="M0 5H26" stroke="${colourOf(s.colour ?? k)}" stroke-width="2.5" stroke-dasharray="${dashOf(s, k)}"/></svg>${esc(s.name)}</li>`).join("")
    : "";
  host.legend.hidden = !host.legend.innerHTML;
}

function axes(spec, scaled, box, xr, yt, X, Y, width, height) {
  const line = (kind, d) => `<path class="${kind}" d="${d}"/>`;
  const xt = ticksOf(...xr, spec.x.log, Math.max(spec.x.log ? 2 : 4, Math.floor((box.right - box.left) / 75)));
  const title = (axis, unit) => esc(axis.label + (unit ? ` / ${unit}` : ""));
  return [
    line("grid-minor", xt.minor.map((v) => `M${X(v).toFixed(1)} ${box.top}V${box.bottom}`).join("") + yt.minor.map((v) => `M${box.left} ${Y(v).toFixed(1)}H${box.right}`).join("")),
    line("grid-line", xt.major.map(({ value }) => `M${X(value).toFixed(1)} ${box.top}V${box.bottom}`).join("") + yt.major.map(({ value }) => `M${box.left} ${Y(value).toFixed(1)}H${box.right}`).join("")),
    line("frame", `M${box.left} ${box.top}V${box.bottom}H${box.right}`),
    ...xt.major.map(({ value, label }) => `<text class="tick" x="${X(value).toFixed(1)}" y="${box.bottom + 16}" text-anchor="middle">${label}</text>`),
    ...yt.major.map(({ value, label }) => `<text class="tick" x="${box.left - 6}" y="${(Y(value) + 4).toFixed(1)}" text-anchor="end">${label}</text>`),
    `<text x="${(box.left + box.right) / 2}" y="${height - 8}" text-anchor="middle">${title(spec.x, scaled.x.unit)}</text>`,
    `<text transform="translate(13 ${(box.top + box.bottom) / 2}) rotate(-90)" text-anchor="middle">${title(spec.y, scaled.y.unit)}</text>`,
  ].join("");
}

/** The point nearest to the pointer, by the abscissa alone where the chart is read along it. */
function nearest(host, event) {
  const svg = host.drawing.querySelector("svg");
  if (!svg || !host.points.length) return null;
  const frame = svg.getBoundingClientRect();
  const factor = svg.viewBox.baseVal.width / frame.width;
  const x = (event.clientX - frame.left) * factor, y = (event.clientY - frame.top) * factor;
  const weight = host.spec.byArea ? 1 : 0.02;
  let best = null, least = Infinity;
  for (const point of host.points) {
    const distance = (point.x - x) ** 2 + weight * (point.y - y) ** 2;
    if (distance < least) [best, least] = [point, distance];
  }
  return best;
}

function readPlot(host, event) {
  showCursor(host, nearest(host, event));
}

function showCursor(host, point) {
  const cursor = host.drawing.querySelector(".cursor");
  if (!cursor) return;
  cursor.setAttribute("visibility", point ? "visible" : "hidden");
  host.readout.textContent = "";
  if (!point) return;
  cursor.setAttribute("cx", point.x);
  cursor.setAttribute("cy", point.y);
  const { spec } = host, series = spec.series[point.series];
  const short = (axis, value) => `${axis.name || axis.label} = ${withUnit(value, axis.unit || "")}`;
  const y = measured(series.y[point.i], series.err && series.err[point.i], spec.y.unit || "");
  const name = spec.series.length > 1 ? `${series.name}: ` : "";
  // Beside the point, on the side that has room.
  const svg = host.drawing.querySelector("svg"), factor = svg.clientWidth / svg.viewBox.baseVal.width;
  const isLeft = point.x > svg.viewBox.baseVal.width / 2, x = factor * point.x;
  host.readout.style.top = `${host.drawing.offsetTop + Math.max(0, factor * point.y - 44)}px`;
  host.readout.style.left = isLeft ? "" : `${x + 12}px`;
  host.readout.style.right = isLeft ? `${host.clientWidth - x + 12}px` : "";
  host.readout.textContent = `${name}${short(spec.x, series.x[point.i])}, ${spec.y.name || spec.y.label} = ${y.join(" ").trim()}`;
}

// On paper a chart is drawn as wide as it stands there, so that its letters keep their size.
function drawForPaper(isPaper) {
  for (const host of document.querySelectorAll(".plot")) {
    if (!host.spec || !host.drawing) continue;
    host.printed = isPaper && (host.closest(".grid") ? 320 : 680);
    drawPlot(host);
  }
}
addEventListener("beforeprint", () => drawForPaper(true));
addEventListener("afterprint", () => drawForPaper(false));
