//! The lengths sqrt(x^2 - r^2) of the inverse Abel transform, for r at the axis and at every spring. They depend on the row of springs
//! alone: those of one r are computed when they are first asked for, and kept.

/// Nodes from the axis on, and the roots from each.
#[derive(Debug, Clone)]
pub(super) struct Roots {
    /// The axis, then the springs (m).
    node_m: Vec<f64>,
    /// Per node, of itself and all nodes beyond; empty until asked for.
    rows: Vec<Vec<f64>>,
}

impl Roots {
    /// Of springs at these ascending positions (m).
    pub(super) fn new(position_m: &[f64]) -> Self {
        let axis = std::iter::once(0.0);
        Self {
            node_m: axis.chain(position_m.iter().copied()).collect(),
            rows: vec![Vec::new(); position_m.len() + 1],
        }
    }

    /// The radius (m) of a node: 0 of the axis, that of spring k of node k + 1.
    pub(super) fn radius_m(&self, node: usize) -> f64 {
        self.node_m[node]
    }

    /// sqrt(x^2 - r^2) (m) for r at this node, x at it and at every node beyond.
    pub(super) fn of_node(&mut self, node: usize) -> &[f64] {
        let row = &mut self.rows[node];
        if row.is_empty() {
            let r_m = self.node_m[node];
            // No digits lost.
            let root = |x_m: &f64| ((x_m - r_m) * (x_m + r_m)).sqrt();
            row.extend(self.node_m[node..].iter().map(root));
        }
        row
    }
}
