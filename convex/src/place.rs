//! The place of an error in a [`Program`](crate::Program).

use std::fmt;

/// A part of a problem, by the names that the problem gives it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ProblemPlace {
    /// The variables of the problem as a whole.
    Variables,
    /// The blocks of the problem as a whole.
    Blocks,
    /// A block of rows.
    Block {
        /// Name of the block.
        name: String,
    },
    /// A row of a block.
    Row(RowPlace),
    /// The quadratic cost as a whole.
    QuadraticCost,
    /// The quadratic cost of the product of two variables.
    QuadraticCostOf(VariablePlace, VariablePlace),
    /// The linear cost as a whole.
    LinearCost,
    /// The linear cost of a variable.
    LinearCostOf(VariablePlace),
    /// The coefficient of a variable in a row.
    Coefficient {
        /// The variable to which the coefficient belongs.
        variable: VariablePlace,
        /// The row in which the coefficient stands.
        row: RowPlace,
    },
    /// The right-hand side of a row.
    RightHandSide(RowPlace),
}

/// A variable: a group and a position in it. Shown as `group[index]`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VariablePlace {
    /// The name of the group.
    pub group: String,
    /// The position in the group, from zero.
    pub index: usize,
}

/// A row: a block and a position in it. Shown as ``row 1 of block `limit` ``.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowPlace {
    /// The name of the block.
    pub block: String,
    /// The position in the block, from zero.
    pub row: usize,
}

impl fmt::Display for ProblemPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Variables => write!(f, "the list of variables"),
            Self::Blocks => write!(f, "the list of blocks"),
            Self::Block { name } => write!(f, "block `{name}`"),
            Self::Row(row) => write!(f, "{row}"),
            Self::QuadraticCost => write!(f, "the quadratic cost"),
            Self::QuadraticCostOf(one, other) => write!(f, "the quadratic cost of {one} and {other}"),
            Self::LinearCost => write!(f, "the linear cost"),
            Self::LinearCostOf(variable) => write!(f, "the linear cost of {variable}"),
            Self::Coefficient { variable, row } => write!(f, "the coefficient of {variable} in {row}"),
            Self::RightHandSide(row) => write!(f, "the right-hand side of {row}"),
        }
    }
}

impl fmt::Display for VariablePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}[{}]", self.group, self.index)
    }
}

impl fmt::Display for RowPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "row {} of block `{}`", self.row, self.block)
    }
}
