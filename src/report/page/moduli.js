// A material's moduli over frequency.

function drawMaterial(m) {
  const x = m.angular_frequency_rad_per_s, s = m.symbol;
  const omega = { label: "angular frequency ω", name: "ω", unit: "rad/s", log: true };
  plot($("moduli"), {
    label: `Storage modulus ${s}′ and loss modulus ${s}″ over angular frequency`, height: 230, x: omega, y: { label: "modulus", unit: "Pa", log: true },
    series: [{ name: `storage modulus ${s}′`, x, y: m.storage_modulus_pa }, { name: `loss modulus ${s}″`, x, y: m.loss_modulus_pa, dash: 1 }],
  });
  plot($("tangent"), {
    label: "Loss tangent over angular frequency", height: 230, legend: true, x: omega, y: { label: "tan δ", zero: true },
    series: [{ name: "tan δ", x, y: m.storage_modulus_pa.map((e, i) => (e > 0 ? m.loss_modulus_pa[i] / e : null)), colour: 2 }],
  });
}
