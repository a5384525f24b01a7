//! Checks of a [`Program`] before it is solved. Every error names the variable, row or block that is wrong.

use crate::program::{BlockRows, Program};
use crate::{Cone, ProblemError, ProblemPlace, RowPlace};

/// Refuses a problem whose shape is malformed: no variables, names used twice, variables of another problem,
/// rows that do not divide into cones.
pub(crate) fn shape(program: &Program) -> Result<(), ProblemError> {
    let count = program.variable_count();
    if count == 0 {
        return Err(ProblemError::Empty);
    }
    distinct_names(program.groups.iter().map(|group| group.name.as_ref()))?;
    distinct_names(program.blocks.iter().map(|block| block.name.as_ref()))?;
    for &(i, j) in &program.quadratic.position {
        known(i.max(j), count, || ProblemPlace::QuadraticCost)?;
    }
    for block in &program.blocks {
        for &(row, variable) in &block.entries.position {
            known(variable, count, || ProblemPlace::Row(row_place(block, row)))?;
        }
        let rows = block.right_hand_side.len();
        let dimension = block.cone.rows_of_one(rows);
        if matches!(block.cone, Cone::SecondOrder { .. } | Cone::Semidefinite { .. })
            && (dimension == 0 || !rows.is_multiple_of(dimension))
        {
            let block = block.name.to_string();
            return Err(ProblemError::ConeSize { block, rows, dimension });
        }
    }
    Ok(())
}

/// Refuses numbers that are not finite, linear costs of variables of another problem, and a quadratic cost
/// with a negative diagonal entry. (That the diagonal is not negative is necessary for convexity; that P as a
/// whole is positive semidefinite is not checked, because that costs a factorisation: the caller must ensure it.)
pub(crate) fn values(program: &Program) -> Result<(), ProblemError> {
    let count = program.variable_count();
    for (&(i, j), &value) in program.quadratic.position.iter().zip(&program.quadratic.value) {
        finite(value, || ProblemPlace::QuadraticCostOf(program.variable_place(i), program.variable_place(j)))?;
    }
    for &(i, value) in &program.linear {
        known(i, count, || ProblemPlace::LinearCost)?;
        finite(value, || ProblemPlace::LinearCostOf(program.variable_place(i)))?;
    }
    for block in &program.blocks {
        for (&(row, variable), &value) in block.entries.position.iter().zip(&block.entries.value) {
            finite(value, || {
                let variable = program.variable_place(variable);
                ProblemPlace::Coefficient { variable, row: row_place(block, row) }
            })?;
        }
        for (row, &value) in block.right_hand_side.iter().enumerate() {
            finite(value, || ProblemPlace::RightHandSide(row_place(block, row)))?;
        }
    }
    nonnegative_diagonal(program)
}

/// Refuses a diagonal entry of P below −1e-12 times the largest entry; a smaller negative value is a rounding error.
fn nonnegative_diagonal(program: &Program) -> Result<(), ProblemError> {
    let mut diagonal = vec![0.0; program.variable_count()];
    let mut largest = 0.0_f64;
    for (&(i, j), &value) in program.quadratic.position.iter().zip(&program.quadratic.value) {
        if i == j {
            diagonal[i] += value;
        }
        largest = largest.max(value.abs());
    }
    match diagonal.iter().position(|&value| value < -1e-12 * largest) {
        Some(i) => Err(ProblemError::NegativeCurvature { variable: program.variable_place(i), value: diagonal[i] }),
        None => Ok(()),
    }
}

/// Refuses `program` when its variables, blocks or entries are not those of `other`.
pub(crate) fn same_pattern(program: &Program, other: &Program) -> Result<(), ProblemError> {
    let changed = |place: ProblemPlace| Err(ProblemError::PatternChanged { place });
    if program.groups != other.groups {
        return changed(ProblemPlace::Variables);
    }
    if program.blocks.len() != other.blocks.len() {
        return changed(ProblemPlace::Blocks);
    }
    if program.quadratic.position != other.quadratic.position {
        return changed(ProblemPlace::QuadraticCost);
    }
    for (block, other) in program.blocks.iter().zip(&other.blocks) {
        let same = block.name == other.name
            && block.cone == other.cone
            && block.right_hand_side.len() == other.right_hand_side.len()
            && block.entries.position == other.entries.position;
        if !same {
            return changed(ProblemPlace::Block { name: block.name.to_string() });
        }
    }
    Ok(())
}

fn distinct_names<'a>(names: impl Iterator<Item = &'a str>) -> Result<(), ProblemError> {
    let mut names: Vec<&str> = names.collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(ProblemError::DuplicateName { name: pair[0].to_owned() }),
        None => Ok(()),
    }
}

fn known(index: usize, count: usize, place: impl Fn() -> ProblemPlace) -> Result<(), ProblemError> {
    if index < count {
        Ok(())
    } else {
        let place = place();
        Err(ProblemError::NoSuchVariable { place, index, count })
    }
}

fn finite(value: f64, place: impl Fn() -> ProblemPlace) -> Result<(), ProblemError> {
    if value.is_finite() {
        Ok(())
    } else {
        let place = place();
        Err(ProblemError::NotFinite { place, value })
    }
}

fn row_place(block: &BlockRows, row: usize) -> RowPlace {
    RowPlace { block: block.name.to_string(), row }
}
