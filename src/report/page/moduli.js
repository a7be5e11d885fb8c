// A material's moduli over frequency.

function drawMaterial(m) {
  const x = m.frequencies, s = m.symbol;
  const over = { ...m.frequency, log: true };
  plot($("moduli"), {
    label: `Storage modulus ${s}′ and loss modulus ${s}″ over ${m.frequency.quantity}`, height: 230, x: over, y: { label: "modulus", unit: "Pa", log: true },
    series: [{ name: `storage modulus ${s}′`, x, y: m.storage_modulus_pa }, { name: `loss modulus ${s}″`, x, y: m.loss_modulus_pa, dash: 1 }],
  });
  plot($("tangent"), {
    label: `Loss tangent over ${m.frequency.quantity}`, height: 230, legend: true, x: over, y: { label: "tan δ", zero: true },
    series: [{ name: "tan δ", x, y: m.storage_modulus_pa.map((e, i) => (e > 0 ? m.loss_modulus_pa[i] / e : null)), colour: 2 }],
  });
}
