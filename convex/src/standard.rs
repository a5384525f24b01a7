//! The standard form (P, q, A, b, K) of a [`Program`], and its update with new numbers in the same pattern.

use std::ops::Range;
use std::sync::Arc;

use crate::program::Program;
use crate::sparse::{SparseColumns, magnitude};
use crate::{Cone, ProblemError, check};

/// min ½xᵀPx + qᵀx subject to b − Ax ∈ K. There are n variables and m rows; the rows of the blocks are stacked in order.
#[derive(Debug, Clone)]
pub(crate) struct StandardForm {
    /// Upper triangle of P, n × n.
    pub(crate) p: SparseColumns,
    /// q, n numbers.
    pub(crate) q: Vec<f64>,
    /// A, m × n.
    pub(crate) a: SparseColumns,
    /// b, m numbers.
    pub(crate) b: Vec<f64>,
    /// K as a product of cones, each with the range of its rows.
    pub(crate) cones: Vec<(Cone, Range<usize>)>,
    pub(crate) blocks: Arc<[Range<usize>]>,
    /// The program of which this is the standard form. Only its pattern and names are used: its numbers are not updated.
    source: Program,
}

impl StandardForm {
    /// Checks `program` and writes it in standard form.
    pub(crate) fn new(program: &Program) -> Result<Self, ProblemError> {
        check::shape(program)?;
        let variables = program.variable_count();
        let mut blocks = Vec::with_capacity(program.blocks.len());
        let mut cones = Vec::new();
        let mut rows = 0;
        for block in &program.blocks {
            let count = block.right_hand_side.len();
            let range = rows..rows + count;
            rows = range.end;
            if count > 0 {
                let step = block.cone.rows_of_one(count);
                let starts = range.clone().step_by(step);
                cones.extend(starts.map(|start| (block.cone, start..start + step)));
            }
            blocks.push(range);
        }
        let entries = program.blocks.iter().zip(&blocks).flat_map(|(block, range)| {
            block.entries.position.iter().map(|&(row, variable)| (range.start + row, variable))
        });
        let a = SparseColumns::with_pattern(rows, variables, entries);
        let p = SparseColumns::with_pattern(variables, variables, program.quadratic.position.iter().copied());
        let mut form = Self {
            p,
            q: vec![0.0; variables],
            a,
            b: vec![0.0; rows],
            cones,
            blocks: blocks.into(),
            source: program.clone(),
        };
        form.fill(program)?;
        Ok(form)
    }

    /// Replaces the numbers by those of a program with the same pattern. On an error nothing is changed.
    pub(crate) fn refill(&mut self, program: &Program) -> Result<(), ProblemError> {
        check::same_pattern(program, &self.source)?;
        self.fill(program)
    }

    fn fill(&mut self, program: &Program) -> Result<(), ProblemError> {
        check::values(program)?;
        self.p.fill(program.quadratic.value.iter().copied());
        self.q.fill(0.0);
        for &(i, value) in &program.linear {
            self.q[i] += value;
        }
        let coefficients = program.blocks.iter().flat_map(|block| &block.entries.value);
        self.a.fill(coefficients.copied());
        let right_hand_sides = program.blocks.iter().flat_map(|block| &block.right_hand_side);
        for (b, value) in self.b.iter_mut().zip(right_hand_sides) {
            *b = *value;
        }
        Ok(())
    }

    /// Names of the blocks that contribute notably to the certificate `dual` (m numbers). The weight of a row is |zᵢ| times
    /// its largest coefficient; a block is named if one of its weights is above a thousandth of the largest weight.
    pub(crate) fn blocks_in(&self, dual: &[f64]) -> Vec<String> {
        let mut weights: Vec<f64> = self.b.iter().map(|b| b.abs()).collect();
        for (row, _, value) in self.a.entries() {
            weights[row] = weights[row].max(value.abs());
        }
        for (weight, z) in weights.iter_mut().zip(dual) {
            *weight *= z.abs();
        }
        let blocks = self.source.blocks.iter().zip(self.blocks.iter());
        carriers(&weights, blocks.map(|(block, range)| (block.name.as_ref(), range.clone())))
    }

    /// Names of the groups of variables with an entry of `direction` (n numbers) above a thousandth of the largest.
    pub(crate) fn groups_in(&self, direction: &[f64]) -> Vec<String> {
        let groups = self.source.groups.iter();
        carriers(direction, groups.map(|group| (group.name.as_ref(), group.variables.range())))
    }
}

/// Names of the parts of `weights` with an entry above a thousandth of the largest.
fn carriers<'a>(weights: &[f64], parts: impl Iterator<Item = (&'a str, Range<usize>)>) -> Vec<String> {
    let negligible = 1e-3 * magnitude(weights);
    parts
        .filter(|(_, range)| magnitude(&weights[range.clone()]) > negligible)
        .map(|(name, _)| name.to_owned())
        .collect()
}
