//! The value under `bulk_modulus`: a modulus that does not depend on time, or a table with the series of one that relaxes.

use serde_json::{Value as Json, json};

use super::diagnostic::{Diagnostic, Diagnostics};
use super::document::kind::{Describe, Kind, Number, Spot, quantity};
use super::document::row::Rows;
use super::document::row::table;
use super::document::tree::{Node, Value};
use super::keys::material::{BRANCH_MODULUS, BULK_BRANCHES, BULK_EQUILIBRIUM, BULK_KEYS};
use super::material_block::branches;
use super::material_temperature::prony;
use crate::material::{MaterialError, Relaxation, RelaxationBranch};
use crate::quantity::Dimension;

const CONSTANT: Number = quantity(Dimension::Stress).above_zero();

static SERIES: Rows = table(
    " K(t) = equilibrium + sum of modulus exp(-t / time).",
    BULK_KEYS,
);

/// A bulk modulus, constant or relaxing.
pub(crate) struct BulkModulus;

impl Describe for BulkModulus {
    fn expected(&self) -> String {
        format!("{}, or a table with a series", CONSTANT.expected())
    }

    fn example(&self) -> String {
        CONSTANT.example()
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [CONSTANT.schema(), SERIES.schema()] })
    }

    fn rows(&self) -> Option<&'static Rows> {
        Some(&SERIES)
    }

    fn number(&self, controlled: Dimension) -> Option<Number> {
        CONSTANT.number(controlled)
    }
}

impl Kind for BulkModulus {
    type Value = Relaxation;

    fn written(&self, bulk: &Relaxation) -> Json {
        let modulus = |value: f64| CONSTANT.written(&value);
        let time = quantity(Dimension::Time);
        let equilibrium = modulus(bulk.equilibrium_modulus());
        if bulk.branches().is_empty() {
            return equilibrium;
        }
        let branch = |b: &RelaxationBranch| json!({ "modulus": modulus(b.modulus_pa), "time": time.written(&b.time_s) });
        let branches: Vec<Json> = bulk.branches().iter().map(branch).collect();
        json!({ "equilibrium": equilibrium, "branches": branches })
    }

    fn convert(&self, node: &Node, spot: &Spot<'_>) -> Result<Relaxation, Diagnostics> {
        let refused = |error: MaterialError| {
            Diagnostics::from(Diagnostic::at(&node.location, error.to_string()))
        };
        let Value::Table(table) = &node.value else {
            let bulk_pa = CONSTANT.convert(node, spot)?;
            return prony(bulk_pa, []).map_err(refused);
        };
        let (equilibrium_pa, branches) = spot.read_table(table, node, |mut table| {
            let equilibrium = table.value(&BULK_EQUILIBRIUM);
            let branches = branches(&mut table, &BULK_BRANCHES, &BRANCH_MODULUS);
            table.finish();
            equilibrium.zip(branches)
        })?;
        prony(equilibrium_pa, branches).map_err(refused)
    }
}
