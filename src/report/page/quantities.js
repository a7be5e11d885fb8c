// What a sweep's table holds that has a curve.

const DEGREES = 180 / Math.PI;

/** Columns with a curve and a place among the numbers: value, error, name, unit, factor. */
const QUANTITIES = [
  ["energy_loss_j", "energy_loss_error_j", "energy loss per cycle", "J", 1],
  ["phase_lag_rad", "phase_lag_error_rad", "phase lag of the approach", "°", DEGREES],
  ["storage_modulus_pa", "storage_modulus_error_pa", "storage modulus from the loop", "Pa", 1],
  ["loss_modulus_pa", "loss_modulus_error_pa", "loss modulus from the loop", "Pa", 1],
  ["approach_min_m", "approach_min_error_m", "smallest approach", "m", 1],
  ["approach_max_m", "approach_max_error_m", "largest approach", "m", 1],
  ["contact_radius_min_m", "contact_radius_min_error_m", "smallest contact radius", "m", 1],
  ["contact_radius_max_m", "contact_radius_max_error_m", "largest contact radius", "m", 1],
  ["peak_pressure_min_pa", "peak_pressure_min_error_pa", "smallest peak pressure", "Pa", 1],
  ["peak_pressure_max_pa", "peak_pressure_max_error_pa", "largest peak pressure", "Pa", 1],
  ["harmonic_2", "harmonic_2_error", "second harmonic of the approach, relative", "", 1],
  ["harmonic_3", "harmonic_3_error", "third harmonic of the approach, relative", "", 1],
];
const OMEGA = { label: "angular frequency ω", name: "ω", unit: "rad/s" };
