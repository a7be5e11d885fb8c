//! What the library computes: contact, cycles, histories, error bars, against closed forms, the other engine and refinement.

#[macro_use]
#[path = "../common/near.rs"]
mod near;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/table.rs"]
mod table;

mod adhesion;
mod attracted;
mod bulk_modulus;
mod contact_shape;
mod direct_cycle;
mod elastic_contact;
mod energy_balance;
mod error_bars;
mod force_curves;
mod fractional;
mod half_space_work;
mod history_work;
mod identification;
mod identified;
mod identified_bodies;
mod identified_histories;
mod identified_laws;
mod instant_tolerance;
mod intermittent;
mod layer;
mod lift_off;
mod measured_loops;
mod no_false_result;
mod numbered_cycles;
mod periodic;
mod pmma_baseline;
mod prelude;
mod pressure_profiles;
mod punch_on_cells;
mod quarter;
mod random_solids;
mod recontact;
mod shapes;
mod simulate_errors;
mod steady_cycle;
mod transient_contact;
mod two_bodies;
mod two_engines;
mod units;
mod work_density;
mod work_of_cases;
