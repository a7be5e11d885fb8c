// Charts as SVG: linear and log axes, error bars, reading by pointer. Drawn again where its width changes.

const DASHES = ["", "7 4", "2 3", "9 3 2 3"];
const colourOf = (k) => `var(--c${k % 7})`;
const dashOf = (series, k) => DASHES[(series.dash ?? Math.floor(k / 7)) % DASHES.length];

/** Ticks of an axis from `low` to `high`: those with labels, and minor ones. */
function ticksOf(low, high, log, room) {
  const major = [], minor = [];
  if (log) {
    const from = Math.floor(Math.log10(low)), to = Math.ceil(Math.log10(high));
    const decades = Math.log10(high / low);
    const every = Math.max(1, Math.ceil(decades / room));
    const inside = (v) => v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9);
    for (let d = from; d <= to; d++) {
      for (let m = 1; m < 10; m++) {
        const v = m * 10 ** d;
        if (!inside(v)) continue;
        const labelled = m === 1 ? (d - from) % every === 0 : decades < 1.5 && (m === 2 || m === 5);
        (labelled ? major : minor).push(v);
      }
    }
    if (major.length >= 2) return { major, minor: decades < 9 ? minor : [] };
    major.length = minor.length = 0;
  }
  const raw = (high - low) / Math.max(2, room);
  const power = 10 ** Math.floor(Math.log10(raw));
  const steps = [0.2, 0.5, 1, 2, 5, 10].map((m) => m * power);
  const first = (step) => Math.ceil(low / step - 1e-9), last = (step) => Math.floor(high / step + 1e-9);
  let at = steps.findIndex((step) => step >= raw * (1 - 1e-9));
  // A wide step may leave a single tick, which tells no scale.
  if (last(steps[at]) - first(steps[at]) < 1) at--;
  for (let k = first(steps[at]); k <= last(steps[at]); k++) major.push(k * steps[at]);
  return { major, minor };
}

function tickText(value, ticks, log) {
  if (value === 0) return "0";
  if (log) return trimmed(significant(value, 3));
  const size = Math.max(...ticks.map(Math.abs));
  const gap = ticks.length > 1 ? Math.min(...ticks.slice(1).map((t, i) => Math.abs(t - ticks[i]))) : Math.abs(value);
  // As many digits as tell one tick from the next.
  const digits = Math.max(2, 1 + Math.ceil(Math.log10(size / gap) - 1e-9));
  if (size >= 1e5 || size < 1e-2) return significant(value, digits).replace(/\.?0*(?= ×)/, "");
  return minus(value.toFixed(Math.max(0, -Math.floor(Math.log10(gap) + 1e-9))));
}

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
    host.readout.className = "readout";
    host.readout.setAttribute("aria-hidden", "true");
    host.append(host.legend, host.drawing, host.readout);
    new ResizeObserver(() => host.clientWidth && host.clientWidth !== host.drawnWidth && drawPlot(host)).observe(host);
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
  const width = Math.max(240, host.clientWidth || 640);
  host.drawnWidth = host.clientWidth;
  const height = spec.height || Math.round(Math.min(300, Math.max(210, width * 0.62)));
  const box = { left: 66, right: width - 14, top: 10, bottom: height - 44 };
  const ys = scaled.series.flatMap((s) => s.py.flatMap((v, i) => (v !== null && s.pe && s.pe[i] !== null ? [v, v - s.pe[i], v + s.pe[i]] : [v])));
  const xr = rangeOf(scaled.series.flatMap((s) => s.px), spec.x), yr = rangeOf(ys, spec.y);
  host.points = [];
  if (!xr || !yr) {
    host.legend.innerHTML = "";
    host.drawing.innerHTML = `<p class="none">${esc(spec.none || "nothing to draw")}</p>`;
    return;
  }
  const along = (range, axis, a, b) => (v) => {
    const part = axis.log ? Math.log(v / range[0]) / Math.log(range[1] / range[0]) : (v - range[0]) / (range[1] - range[0]);
    return a + part * (b - a);
  };
  const X = along(xr, spec.x, box.left, box.right), Y = along(yr, spec.y, box.bottom, box.top);
  const seen = (x, y) => x !== null && y !== null && (!spec.x.log || x > 0) && (!spec.y.log || y > 0);
  const parts = [axes(spec, scaled, box, xr, yr, X, Y, width, height)];
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

function axes(spec, scaled, box, xr, yr, X, Y, width, height) {
  const line = (kind, d) => `<path class="${kind}" d="${d}"/>`;
  const xt = ticksOf(...xr, spec.x.log, Math.max(spec.x.log ? 2 : 4, Math.floor((box.right - box.left) / 75)));
  const yt = ticksOf(...yr, spec.y.log, Math.max(3, Math.floor((box.bottom - box.top) / 40)));
  const title = (axis, unit) => esc(axis.label + (unit ? ` / ${unit}` : ""));
  return [
    line("grid-minor", xt.minor.map((v) => `M${X(v).toFixed(1)} ${box.top}V${box.bottom}`).join("") + yt.minor.map((v) => `M${box.left} ${Y(v).toFixed(1)}H${box.right}`).join("")),
    line("grid-line", xt.major.map((v) => `M${X(v).toFixed(1)} ${box.top}V${box.bottom}`).join("") + yt.major.map((v) => `M${box.left} ${Y(v).toFixed(1)}H${box.right}`).join("")),
    line("frame", `M${box.left} ${box.top}V${box.bottom}H${box.right}`),
    ...xt.major.map((v) => `<text class="tick" x="${X(v).toFixed(1)}" y="${box.bottom + 16}" text-anchor="middle">${tickText(v, xt.major, spec.x.log)}</text>`),
    ...yt.major.map((v) => `<text class="tick" x="${box.left - 6}" y="${(Y(v) + 4).toFixed(1)}" text-anchor="end">${tickText(v, yt.major, spec.y.log)}</text>`),
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
  host.readout.textContent = `${name}${short(spec.x, series.x[point.i])}, ${spec.y.name || spec.y.label} = ${y.join(" ").trim()}`;
}
