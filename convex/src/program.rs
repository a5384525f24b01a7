//! A convex problem with named groups of variables and named blocks of rows.

use std::borrow::Cow;

use crate::Cone;
use crate::VariablePlace;

/// One scalar variable of a [`Program`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Variable(pub(crate) usize);

/// A named group of consecutive scalar variables of a [`Program`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variables {
    pub(crate) start: usize,
    count: usize,
}

impl Variables {
    /// The `index`-th variable of the group, from zero.
    ///
    /// # Panics
    /// When `index` is not below [`Variables::count`], like a slice.
    #[must_use]
    pub fn at(self, index: usize) -> Variable {
        assert!(index < self.count, "variable {index} of a group of {}", self.count);
        Variable(self.start + index)
    }

    /// The number of variables in the group.
    #[must_use]
    pub fn count(self) -> usize {
        self.count
    }

    /// The variables of the group, in order.
    pub fn iter(self) -> impl ExactSizeIterator<Item = Variable> {
        (self.start..self.start + self.count).map(Variable)
    }

    pub(crate) fn range(self) -> std::ops::Range<usize> {
        self.start..self.start + self.count
    }
}

/// The handle of a named block of rows of a [`Program`], used to add its rows and to read its duals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block(pub(crate) usize);

/// A convex problem, min ½xᵀPx + qᵀx subject to b − Ax ∈ K, with named variables and rows.
///
/// Variables and blocks are declared once. Costs and rows may then be written, removed with [`Program::clear`] and written
/// again without allocation. A [`Solver`](crate::Solver) can be updated cheaply if the same positions are written in the same
/// order. Write zeros too: they keep their position in the pattern.
///
/// Nothing is checked here: [`Solver::new`](crate::Solver::new) and
/// [`Solver::update`](crate::Solver::update) check everything and name what is wrong.
#[derive(Debug, Clone, Default)]
pub struct Program {
    pub(crate) groups: Vec<Group>,
    pub(crate) blocks: Vec<BlockRows>,
    /// Upper-triangle entries of P.
    pub(crate) quadratic: Entries,
    /// Entries of q, as (variable, value).
    pub(crate) linear: Vec<(usize, f64)>,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Group {
    pub(crate) name: Cow<'static, str>,
    pub(crate) variables: Variables,
}

/// The rows of one block: entries of A as (row of the block, variable), and the part of b.
#[derive(Debug, Clone)]
pub(crate) struct BlockRows {
    pub(crate) name: Cow<'static, str>,
    pub(crate) cone: Cone,
    pub(crate) entries: Entries,
    pub(crate) right_hand_side: Vec<f64>,
}

/// Entries with positions and values in separate lists, so that two patterns are compared without their values.
#[derive(Debug, Clone, Default)]
pub(crate) struct Entries {
    pub(crate) position: Vec<(usize, usize)>,
    pub(crate) value: Vec<f64>,
}

impl Entries {
    fn push(&mut self, row: usize, column: usize, value: f64) {
        self.position.push((row, column));
        self.value.push(value);
    }

    fn clear(&mut self) {
        self.position.clear();
        self.value.clear();
    }
}

impl Program {
    /// A problem without variables, cost or rows.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares `count` variables under one name.
    pub fn variables(&mut self, name: impl Into<Cow<'static, str>>, count: usize) -> Variables {
        let start = self.variable_count();
        let variables = Variables { start, count };
        let name = name.into();
        self.groups.push(Group { name, variables });
        variables
    }

    /// Declares a block of equalities: each row is aᵀx = b.
    pub fn equal(&mut self, name: impl Into<Cow<'static, str>>) -> Block {
        self.block(name, Cone::Zero)
    }

    /// Declares a block of inequalities: each row is aᵀx ≤ b.
    pub fn at_most(&mut self, name: impl Into<Cow<'static, str>>) -> Block {
        self.block(name, Cone::Nonnegative)
    }

    /// Declares a block of second-order cones: each group of `dimension` consecutive rows, with
    /// sᵢ = bᵢ − aᵢᵀx, is the constraint ‖(s₁, …)‖₂ ≤ s₀.
    pub fn second_order(&mut self, name: impl Into<Cow<'static, str>>, dimension: usize) -> Block {
        self.block(name, Cone::SecondOrder { dimension })
    }

    /// Declares a block of positive semidefinite matrices: each group of order·(order + 1)/2 consecutive rows is the
    /// [`triangle`](crate::triangle) of the matrix b − Ax.
    pub fn semidefinite(&mut self, name: impl Into<Cow<'static, str>>, order: usize) -> Block {
        self.block(name, Cone::Semidefinite { order })
    }

    /// Declares a block of rows whose slack b − Ax lies in `cone`.
    pub fn block(&mut self, name: impl Into<Cow<'static, str>>, cone: Cone) -> Block {
        self.blocks.push(BlockRows {
            name: name.into(),
            cone,
            entries: Entries::default(),
            right_hand_side: Vec::new(),
        });
        Block(self.blocks.len() - 1)
    }

    /// Adds a row to `block`: its coefficients a as (variable, value) pairs (repeated variables add up), and
    /// its right-hand side b. Rows of several blocks may be added in any order.
    ///
    /// # Panics
    /// When `block` is not of this problem.
    pub fn row(&mut self, block: Block, coefficients: impl IntoIterator<Item = (Variable, f64)>, right_hand_side: f64) {
        let block = &mut self.blocks[block.0];
        let row = block.right_hand_side.len();
        for (variable, value) in coefficients {
            block.entries.push(row, variable.0, value);
        }
        block.right_hand_side.push(right_hand_side);
    }

    /// Adds `value` to the entry of the symmetric P at (i, j) and, with it, at (j, i): the cost ½xᵀPx grows
    /// by ½ value xᵢ² when i = j, and by value xᵢxⱼ otherwise.
    pub fn quadratic(&mut self, i: Variable, j: Variable, value: f64) {
        self.quadratic.push(i.0.min(j.0), i.0.max(j.0), value);
    }

    /// Adds `value` to the entry of q at i: the cost grows by value xᵢ.
    pub fn linear(&mut self, i: Variable, value: f64) {
        self.linear.push((i.0, value));
    }

    /// Removes every cost and every row. Keeps the variables, the blocks, their handles and the allocated memory.
    pub fn clear(&mut self) {
        self.quadratic.clear();
        self.linear.clear();
        for block in &mut self.blocks {
            block.entries.clear();
            block.right_hand_side.clear();
        }
    }

    /// The number of declared scalar variables.
    #[must_use]
    pub(crate) fn variable_count(&self) -> usize {
        self.groups.last().map_or(0, |group| group.variables.range().end)
    }

    /// The total number of rows of all blocks.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.blocks.iter().map(|block| block.right_hand_side.len()).sum()
    }

    /// The group and the position in it of a variable of this problem.
    ///
    /// # Panics
    /// When the problem has no such variable, which [`check::shape`](crate::check::shape) rules out.
    pub(crate) fn variable_place(&self, index: usize) -> VariablePlace {
        let group = self.groups.iter().find(|group| group.variables.range().contains(&index));
        let group = group.expect("the shape of the problem was checked");
        VariablePlace { group: group.name.to_string(), index: index - group.variables.start }
    }
}
