// Numbers with units, CSV, files, theme: what every page uses.
"use strict";

const $ = (id) => document.getElementById(id);
const escapes = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;" };
const esc = (text) => String(text).replace(/[&<>"']/g, (c) => escapes[c]);
const raised = (n) => String(n).replace(/-/g, "⁻").replace(/\d/g, (d) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]);
const minus = (text) => text.replace("-", "−");

// Units that take a prefix; others stand as they are.
const PREFIXED = new Set(["J", "N", "m", "Pa", "J/m²"]);
const PREFIXES = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P"];

/** The factor that brings values up to `largest` to everyday size, and the unit they then have. */
function scaleFor(largest, unit) {
  if (!PREFIXED.has(unit) || !(largest > 0)) return { factor: 1, unit };
  const step = Math.max(-5, Math.min(5, Math.floor(Math.log10(largest) / 3 + 1e-9)));
  return { factor: 10 ** (-3 * step), unit: PREFIXES[step + 5] + unit };
}

/** A number to so many significant digits, with a power of ten where it is small or large. */
function significant(value, digits = 4) {
  if (value === 0) return "0";
  const [mantissa, power] = value.toExponential(digits - 1).split("e");
  const exponent = Number(power);
  if (exponent >= -2 && exponent < 5) return minus(value.toFixed(Math.max(0, digits - 1 - exponent)));
  return Number(mantissa) === 1 ? `10${raised(exponent)}` : `${minus(mantissa)} × 10${raised(exponent)}`;
}

/** Without zeros at the end of the decimals. */
const trimmed = (text) => text.replace(/(\.\d*?)0+(?=$| )/, "$1").replace(/\.(?=$| )/, "");

/** One digit, never less than the number itself. */
function roundedUp(error) {
  const unit = 10 ** Math.floor(Math.log10(error));
  return Math.ceil((error / unit) * (1 - 1e-9)) * unit;
}

/** A value and its error with as many decimals, in one unit: ["3.5090 µJ", "± 0.0003 µJ"]. */
function measured(value, error, unit) {
  if (!value || !(error > 0)) return [withUnit(value, unit, 5), ""];
  const scale = scaleFor(Math.abs(value), unit);
  const exponent = Number((value * scale.factor).toExponential(15).split("e")[1]);
  const power = exponent >= -2 && exponent < 5 ? 0 : exponent;
  const factor = scale.factor * 10 ** -power;
  // Beyond six decimals an error is not followed.
  const shown = roundedUp(Math.max(error * factor, 1e-6));
  const decimals = Math.max(0, -Math.floor(Math.log10(shown) + 1e-9));
  const joint = scale.unit === "" || scale.unit === "°" ? "" : " ";
  const text = (v) => minus(v.toFixed(decimals)) + (power ? ` × 10${raised(power)}` : "") + joint + scale.unit;
  return [text(value * factor), `± ${text(shown)}`];
}

/** A value with its unit: "3.509 µJ". */
function withUnit(value, unit, digits = 4) {
  if (value === null || value === undefined) return "none";
  const scale = scaleFor(Math.abs(value), unit);
  const joint = scale.unit === "" || scale.unit === "°" ? "" : " ";
  return significant(value * scale.factor, digits) + joint + scale.unit;
}

/** Rows of a CSV text as objects: numbers where a cell is one, null where it is empty; in columns of names always text. */
function parseCsv(text, named = new Set()) {
  const lines = [[]];
  const pattern = /("(?:[^"]|"")*"|[^,\n]*)(,|\n|$)/g;
  for (let match; (match = pattern.exec(text)) && match.index < text.length; ) {
    const raw = match[1];
    lines[lines.length - 1].push(raw.startsWith('"') ? raw.slice(1, -1).replace(/""/g, '"') : raw);
    if (match[2] === "\n") lines.push([]);
  }
  const rows = lines.filter((line) => line.length > 1);
  const columns = rows.shift() || [];
  const value = (cell) => (cell === "" ? null : /^-?\d/.test(cell) && isFinite(cell) ? Number(cell) : cell);
  const inColumn = (c, cell) => (named.has(c) ? cell : value(cell));
  return { columns, rows: rows.map((cells) => ({ cells, ...Object.fromEntries(columns.map((c, i) => [c, inColumn(c, cells[i])])) })) };
}

function toCsv(columns, rows) {
  const cell = (text) => (/[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
  return [columns, ...rows].map((cells) => cells.map(cell).join(",")).join("\n") + "\n";
}

function download(name, text, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // Where the clipboard is closed to pages, the selection is still copied.
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
}

function startTheme() {
  const root = document.documentElement;
  const button = $("theme");
  const system = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () => (root.dataset.theme || (system.matches ? "dark" : "light")) === "dark";
  const show = () => button.setAttribute("aria-pressed", String(isDark()));
  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    show();
  });
  system.addEventListener("change", show);
  show();
}
